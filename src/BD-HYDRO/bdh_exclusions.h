/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Pairs that neigh_modify exclude leaves out of the neighbor lists.
#ifndef LMP_BDH_EXCLUSIONS_H
#define LMP_BDH_EXCLUSIONS_H

#include "pointers.h"

#include <string>

namespace LAMMPS_NS {

/// Tells which exclusions affect pairs of particles of one group, as its atoms are now.  Not every
/// exclusion does: LAMMPS' Monte Carlo fixes, for instance, exclude a group of their own, which has
/// atoms only during a trial.
class Exclusions : protected Pointers {
 public:
  Exclusions(LAMMPS *lmp, int groupbit) : Pointers(lmp), groupbit_(groupbit) {}

  /// Collective.  The first exclusion that hides a pair of the group, in the words of neigh_modify
  /// exclude, such as "group a b"; empty if there is none.
  std::string of_the_group() const;

 private:
  bool any(int group_a, int group_b) const;
  bool any_of_types(int a, int b) const;
  bool any_in_molecules(int groupbit, bool same) const;
  bool somewhere(bool here) const;

  int groupbit_;
};

}    // namespace LAMMPS_NS
#endif
