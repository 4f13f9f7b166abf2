/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// LAMMPS classes whose headers are not installed with its library.  With the LAMMPS source, this
/// file includes those headers; for an installed library it declares what the package needs of
/// them.
#ifndef LMP_BDH_LAMMPS_CLASSES_H
#define LMP_BDH_LAMMPS_CLASSES_H

#if __has_include("fix_deform.h")

#include "atom_masks.h"
#include "atom_vec.h"
#include "compute_pressure.h"
#include "fix_adapt.h"
#include "fix_deform.h"
#include "fix_nh.h"
#include "fix_press_berendsen.h"
#include "fix_setforce.h"
#include "neigh_request.h"

#else

#define BDH_INSTALLED_LAMMPS

#include "compute.h"
#include "fix.h"
#include "pointers.h"

// Only the KOKKOS package reads the masks of per-atom arrays, and installed libraries lack it.
enum : unsigned int {
  EMPTY_MASK = 0,
  X_MASK = 1u << 0,
  V_MASK = 1u << 1,
  F_MASK = 1u << 2,
  TAG_MASK = 1u << 3,
  TYPE_MASK = 1u << 4,
  MASK_MASK = 1u << 5,
  IMAGE_MASK = 1u << 6,
  MOLECULE_MASK = 1u << 7,
  RMASS_MASK = 1u << 8,
  RADIUS_MASK = 1u << 9,
  TORQUE_MASK = 1u << 10,
  ALL_MASK = ~0u
};

namespace LAMMPS_NS {
#include "bdh_lammps_declarations.h"
}    // namespace LAMMPS_NS

#endif
#endif
