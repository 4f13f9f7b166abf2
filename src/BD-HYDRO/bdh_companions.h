/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// What else is in the input script, as far as it concerns Brownian dynamics.
#ifndef LMP_BDH_COMPANIONS_H
#define LMP_BDH_COMPANIONS_H

#include "pointers.h"

#include <cstdint>
#include <string>

namespace LAMMPS_NS {

/// Refuses, or warns about, other fixes and settings that do not go together with a fix of this
/// package, and watches neighbor lists and step numbers during the run.
class Companions : protected Pointers {
 public:
  /// name: of the fix, for messages.
  Companions(LAMMPS *lmp, class Fix *fix, const std::string &name) :
      Pointers(lmp), fix_(fix), name_(name)
  {}

  /// Collective, at init.  needs_list: the fix has a neighbor list of its own.
  void check(bool needs_list);
  /// At the beginning of each step.
  void watch();
  void set_seed(uint32_t seed) { seed_ = seed; }

 private:
  void refuse_second_integrator() const;
  void check_fixes() const;
  void check_neighbor_settings() const;
  void watch_neighbor_builds();
  void watch_step_number();
  bool uses_lists() const;

  class Fix *fix_;
  const std::string name_;
  uint32_t seed_ = 0;
  bool needs_list_ = false, warned_danger_ = false, warned_replay_ = false;
  bigint known_danger_ = 0, last_step_ = -1;
};

}    // namespace LAMMPS_NS
#endif
