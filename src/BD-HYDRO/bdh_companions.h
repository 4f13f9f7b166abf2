/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Other fixes and settings in the input script that matter to Brownian dynamics.
#ifndef LMP_BDH_COMPANIONS_H
#define LMP_BDH_COMPANIONS_H

#include "bdh_neighbor_builds.h"
#include "bdh_velocity_watch.h"
#include "pointers.h"

#include <cstdint>
#include <set>
#include <string>

namespace LAMMPS_NS {

/// Refuses, or warns about, other fixes and settings that conflict with a fix of this package, and
/// watches rotations, velocities, neighbor lists and step numbers during the run.  Each warning
/// about another fix is given once in the lifetime of this one.
class Companions : protected Pointers {
 public:
  /// name: of the fix, for messages.
  Companions(LAMMPS *lmp, class Fix *fix, const std::string &name) :
      Pointers(lmp), fix_(fix), name_(name), velocities_(lmp, fix, name),
      neighbor_builds_(lmp, name)
  {}

  /// Collective, at init.  needs_list: whether the fix has a neighbor list of its own.  Returns the
  /// group bits of all other fixes that integrate.
  int check(bool needs_list);
  /// At init: whether this fix turns its particles, which it does without being asked if rotation
  /// is `auto`.
  void set_rotation(bool turns) { turns_ = turns; }
  /// Collective, once forces are known.  Warns about torques and orientations that this fix does
  /// not turn.
  void look_for_rotations();
  /// Collective, at the beginning of each step.
  void begin_step();
  /// Collective, after the step has written the velocities.
  void end_step() { velocities_.after_step(); }
  void set_seed(uint32_t seed) { seed_ = seed; }

 private:
  int refuse_second_integrators() const;
  void refuse_integrator(const class Fix &other) const;
  void check_other_fluid(const class Fix &other) const;
  void check_fixes();
  void check_held_atoms(const class Fix &other);
  void check_carried_atoms(const class Fix &other);
  void check_pairs();
  void note_old_velocities();
  void watch_step_number();
  bool shares_atoms(const class Fix &other) const;
  bool first_mention(const std::string &what);

  class Fix *fix_;
  const std::string name_;
  VelocityWatch velocities_;
  NeighborBuilds neighbor_builds_;
  std::set<std::string> mentioned_;
  uint32_t seed_ = 0;
  bool warned_replay_ = false;
  bool turns_ = false, warned_rotations_ = false, noted_velocities_ = false;
  bigint last_step_ = -1;
};

}    // namespace LAMMPS_NS
#endif
