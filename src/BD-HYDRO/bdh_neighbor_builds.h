/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Watches how often LAMMPS builds neighbor lists.
#ifndef LMP_BDH_NEIGHBOR_BUILDS_H
#define LMP_BDH_NEIGHBOR_BUILDS_H

#include "pointers.h"

#include <string>

namespace LAMMPS_NS {

/// Warns if lists may be built too late for the long moves of Brownian steps.
class NeighborBuilds : protected Pointers {
 public:
  /// name: of the fix, for messages.
  NeighborBuilds(LAMMPS *lmp, const std::string &name) : Pointers(lmp), name_(name) {}
  /// At init.  needs_list: whether the fix has a neighbor list of its own.
  void begin_run(bool needs_list);
  /// At the beginning of each step.
  void begin_step();

 private:
  bool uses_lists() const;

  const std::string name_;
  bool needs_list_ = false, warned_ = false;
  bigint known_danger_ = 0;
};

}    // namespace LAMMPS_NS
#endif
