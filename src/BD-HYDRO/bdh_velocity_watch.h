/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Finds fixes that change velocities by observing their effect.
#ifndef LMP_BDH_VELOCITY_WATCH_H
#define LMP_BDH_VELOCITY_WATCH_H

#include "pointers.h"

#include <map>
#include <string>

namespace LAMMPS_NS {

/// Watches whether anything changes the velocities of the group, which this package sets to
/// displacement/dt, between the end of one step and the beginning of the next.
///
/// It compares sums over the group.  Their weights depend on atom ids, so the sums are the same for
/// any order of the atoms and any number of processes.  Each fix in question is watched the first
/// few times it acts; after that the watch costs nothing.
class VelocityWatch : protected Pointers {
 public:
  VelocityWatch(LAMMPS *lmp, class Fix *fix, const std::string &name) :
      Pointers(lmp), fix_(fix), name_(name)
  {}

  /// At init.  Fixes that the user has already been warned about are not watched.
  void begin_run();
  /// Collective, at the beginning of each step.
  void before_step();
  /// Collective, after the velocities of a step have been written.
  void after_step();

 private:
  /// Sums over the atoms of the group on all processes.
  struct Sums {
    double velocity = 0.0, size = 0.0;    // weighted sum, and sum of absolute values
    double members = 0.0, count = 0.0;    // sums of integers, hence exact
  };
  Sums sums() const;
  bool due();
  bool is_in_question(int f) const;

  class Fix *fix_;
  const std::string name_;
  std::map<std::string, int> looks_;    // number of times that each fix has been watched
  std::string suspects_;                // fixes watched in this step, for the message
  Sums before_;
  bool warned_ = false;
};

}    // namespace LAMMPS_NS
#endif
