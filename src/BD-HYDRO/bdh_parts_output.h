/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Keyword parts of fix bd/pse: displacements by forces and by noise, of each atom.
#ifndef LMP_BDH_PARTS_OUTPUT_H
#define LMP_BDH_PARTS_OUTPUT_H

#include "bdh_columns.h"
#include "bdh_group.h"
#include "bdh_pse_engine.h"

namespace LAMMPS_NS {

/// Columns of the fix that hold both parts of the last displacement, and where particles turn both
/// parts of the last rotation.  They are the fix's array by atom.
class PartsOutput {
 public:
  /// Adds the columns.  Call it before they are attached.
  PartsOutput(class Fix &fix, AtomColumns &columns, bool turn);
  /// Keeps the parts of the engine's last step, which took this time.
  void keep(const AtomGroup &group, const PseEngine &engine, double dt);

 private:
  AtomColumns &columns_;
  AtomColumns::Column parts_;
};

}    // namespace LAMMPS_NS
#endif
