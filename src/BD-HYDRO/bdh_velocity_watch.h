/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Finds fixes that change velocities by what they do.
#ifndef LMP_BDH_VELOCITY_WATCH_H
#define LMP_BDH_VELOCITY_WATCH_H

#include "pointers.h"

#include <map>
#include <string>

namespace LAMMPS_NS {

/// Watches whether anything changes the velocities of the group between the end of a step and the
/// beginning of the next, where this package has put displacement/dt.
///
/// It compares sums over the group with weights that depend on the atom's id, which come out the
/// same in any order of the atoms and on any number of processes.  Each fix in question is watched
/// when it has acted for the first few times; after that the watch costs nothing.
class VelocityWatch : protected Pointers {
 public:
  VelocityWatch(LAMMPS *lmp, class Fix *fix, const std::string &name) :
      Pointers(lmp), fix_(fix), name_(name)
  {}

  /// At init.  Fixes of which the user has been told already are not watched.
  void begin_run();
  /// Collective, at the beginning of each step.
  void before_step();
  /// Collective, when the velocities of a step have been written.
  void after_step();

 private:
  /// Sums over the atoms of the group on all processes.
  struct Sums {
    double velocity = 0.0, size = 0.0;    // with weights, and of absolute values
    double members = 0.0, count = 0.0;    // of whole numbers
  };
  Sums sums() const;
  bool due();
  bool is_in_question(int f) const;

  class Fix *fix_;
  const std::string name_;
  std::map<std::string, int> looks_;    // how often each fix has been watched
  std::string suspects_;                // those that are watched in this step, for the message
  Sums before_;
  bool warned_ = false;
};

}    // namespace LAMMPS_NS
#endif
