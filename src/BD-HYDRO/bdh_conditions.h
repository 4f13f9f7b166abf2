/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Limits that LAMMPS, its atoms and the machine set to plans of fix bd/pse.
#ifndef LMP_BDH_CONDITIONS_H
#define LMP_BDH_CONDITIONS_H

#include "grid/cell_kernel.h"
#include "pse/plan.h"

namespace LAMMPS_NS {

/// Collective.  How crowded the particles of a group are at present, and what limits a plan.
/// radius: of the particles [distance].
bdh::PseConditions conditions_now(class LAMMPS *lmp, int groupbit, double radius,
                                  const bdh::Cell &cell);

/// The longest cutoff for which LAMMPS keeps ghosts and pairs in a cell [distance]; 0: no limit.
double longest_cutoff(class LAMMPS *lmp, const bdh::Cell &cell);

}    // namespace LAMMPS_NS
#endif
