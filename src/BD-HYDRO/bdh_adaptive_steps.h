/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Keyword adapt of a fix: steps in pieces whose length follows the forces.
#ifndef LMP_BDH_ADAPTIVE_STEPS_H
#define LMP_BDH_ADAPTIVE_STEPS_H

#include "base/piece_choice.h"
#include "bdh_group.h"
#include "bdh_plan_text.h"
#include "bdh_stiffness.h"
#include "pointers.h"

#include <string>

namespace LAMMPS_NS {

/// Steps in pieces, or the near steps of scheme split: chooses them, and reports what was chosen.
class AdaptiveSteps : protected Pointers {
 public:
  /// name: of the fix, for messages.
  AdaptiveSteps(LAMMPS *lmp, const std::string &name) : Pointers(lmp), name_(name) {}
  ~AdaptiveSteps() noexcept override {}    // newer releases let that of Pointers throw

  /// tolerance: in radii; 0: nothing is adapted.  near: only the near part of a step is taken in
  /// pieces.  Call it before the columns of the group are attached.
  void set(double tolerance, bool near, AtomGroup &group, StiffnessMonitor &stiffness);
  /// Steps as a whole are taken in pieces.
  bool take_pieces() const { return choice_.acts() && !near_; }
  bdh::PieceChoice &choice() { return choice_; }

  void begin_run() { choice_.clear(); }
  /// At the beginning of a step.
  void begin_step(const bdh::PieceScene &scene)
  {
    if (choice_.acts()) choice_.set_scene(scene);
  }
  /// For the forces at the end of a step: the time since those that they are compared with, and in
  /// how many parts of it forces have acted.  near_steps: to a step, where none are chosen.
  double time_of_forces() const;
  int parts_of_time(int near_steps) const { return near_ ? choice_.pieces() : near_steps; }
  /// Collective, at the end of a step, with the largest change of the force on a particle of this
  /// rank.
  void end_step(double change);

  void describe(PlanText &text) const;
  /// At the end of a run; nothing if steps are taken as a whole.
  void show();
  double pieces() const { return choice_.acts() ? choice_.pieces() : 1.0; }    ///< of the last step
  double retries() const { return choice_.seen().retries; }                    ///< in this run

 private:
  const std::string name_;
  bdh::PieceChoice choice_;
  bool near_ = false;
};

}    // namespace LAMMPS_NS
#endif
