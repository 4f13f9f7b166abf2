/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The plan of fix bd/pse in use, with the pairs, the grid and the check that belong to it.
#ifndef LMP_BDH_PLAN_IN_USE_H
#define LMP_BDH_PLAN_IN_USE_H

#include "bdh_move_judge.h"
#include "bdh_neighbor_settings.h"
#include "bdh_pairs.h"
#include "bdh_pse_engine.h"
#include "bdh_pse_planning.h"
#include "bdh_tolerance_check.h"
#include "pointers.h"

#include <memory>
#include <string>

namespace LAMMPS_NS {

/// Passes every new plan to the parts that depend on it: the source of pairs, the engine, the check
/// of the tolerance, the judge of moves.  During a run it keeps them consistent with the box and
/// the particles.  With hydrodynamics no there are neither pairs nor a check.
class PlanInUse : protected Pointers {
 public:
  /// name: of the fix, for messages; scene: will be set to that of the plan.
  PlanInUse(LAMMPS *lmp, const class Fix &fix, const std::string &name,
            const bdh::PseOptions &options, const Solvent &solvent,
            const Orientations &orientations, GivenMotions &given, Scene &scene, MoveJudge &judge);

  /// Before the first run.  The engine may refer to the pairs.  Both replace those given earlier.
  void work_with(std::unique_ptr<PairSource> pairs, std::unique_ptr<PseEngine> engine);
  PairSource &pairs() const { return *pairs_; }
  PseEngine &engine() const { return *engine_; }
  PsePlanning &planning() { return planning_; }

  /// Collective, at init.  instance: the instance number that LAMMPS gave the fix.
  void begin_run(int instance);
  /// Collective, at the beginning of a step.  Follows changes of the box, and makes a plan if there
  /// was none. False if there is still no particle, and therefore no plan.
  bool follow();
  /// Collective, after follow().  One step of the engine.  Makes another plan first if the
  /// particles no longer match the scene.
  bdh::PseReport step(bdh::PieceChoice &choice);
  /// Collective, instead.  See bdh::StepInPieces.
  bdh::StepAgainstHalves compare_with_halves(double limit);
  /// Collective.  Carries out keyword check.
  void check_tolerance(AtomGroup &group);

  void describe(PlanText &text) const;

 private:
  bool has_plan() const { return planning_.is_made(); }
  template <class Body> auto in_scene(const Body &body);
  void request_pairs(bool is_new, int instance);
  void use_plan(bool is_new);
  void follow_scene();
  void follow_box();
  bdh::PseStepPlan step_plan() const;

  const class Fix &fix_;
  const std::string name_;
  const bdh::PseOptions &options_;
  const Solvent &solvent_;
  const Orientations &orientations_;
  GivenMotions &given_;
  MoveJudge &judge_;
  NeighborSettings settings_;
  PsePlanning planning_;
  ToleranceCheck check_;
  std::unique_ptr<PairSource> pairs_;
  std::unique_ptr<PseEngine> engine_;
  bdh::Cell cell_;              // the one that the engine was given last
  double grid_memory_ = 0.0;    // bytes on this processor, from when the grid was made
};

}    // namespace LAMMPS_NS
#endif
