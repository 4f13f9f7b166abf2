/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_FIX_BD_H
#define LMP_FIX_BD_H

#include "base/pieces.h"
#include "bdh_adaptive_steps.h"
#include "bdh_columns.h"
#include "bdh_companions.h"
#include "bdh_group.h"
#include "bdh_lammps.h"
#include "bdh_move_judge.h"
#include "bdh_plan_text.h"
#include "bdh_pressure_check.h"
#include "bdh_scene.h"
#include "bdh_solvent.h"
#include "bdh_stiffness.h"
#include "bdh_timestep_check.h"
#include "bdh_timing.h"

#include <memory>
#include <string>

namespace LAMMPS_NS {

/// Figures from the last step, in the order in which FixBD::compute_vector() returns them.
struct StepFigures {
  double solver_iterations = 0.0, lanczos_iterations = 0.0, error_estimate = 0.0;
  double radius = 0.0, spacing = 0.0;
  /// Of one particle alone, times the viscosity; times its radius where that is the atom's.
  double mobility = 0.0;
  double least_radius = 0.0;    // of any particle
};

/// What all integrators for Brownian dynamics with hydrodynamic interactions share.
///
/// The work is done by parts: the solvent, the atoms of the group, the per-atom columns, the judge
/// of moves, the companions in the input script, the timing table.  A derived class makes its
/// mobility in build() and takes one step in step().
class FixBD : public FixWithColumns {
 public:
  FixBD(class LAMMPS *, int, char **);

  int setmask() override;
  void init() override;
  void setup(int) override;
  void initial_integrate(int) override;
  void final_integrate() override;
  void post_run() override;
  double compute_scalar() override;
  double compute_vector(int) override;
  void *extract(const char *, int &) override;
  void reset_target(double temperature) override;
  /// Without the mobility, whose bytes a derived class adds.
  double memory_usage() override;

  const Solvent &solvent() const { return solvent_; }

 protected:
  static constexpr int figure_count = 8;    // including temperature, viscosity and long moves
  static constexpr int last_figures = 4;    // stiffness and pieces, behind those of derived classes

  /// How a method uses LAMMPS; set by the derived class's constructor.
  struct Method {
    bool needs_neighbor_list = false;
    const char *midpoint_scheme =
        "";    ///< "scheme ...", the one that evaluates forces within the step
    const char *other_scheme = "";    ///< a scheme that does not
    bool radii_of_atoms = false;      ///< radii are those of the atoms
  };

  /// At init: refuses boxes, and changes of the box during the run, that the method cannot handle.
  virtual void check_box() const = 0;
  /// Collective, at init of a run, once the box is known.  Makes the mobility.
  virtual void build() = 0;
  /// What was chosen, and why.  Printed whenever it differs from the last text printed.
  virtual PlanText plan_text() const = 0;
  /// Collective.  One step from the present state of the atoms.
  virtual void step() = 0;
  /// Collective, before step(): see bdh::StepInPieces.
  virtual bdh::StepAgainstHalves compare_with_halves(double limit) = 0;
  /// Names the particle at an index of the core's arrays, and the step, for messages.
  virtual std::string describe(long index) const = 0;

  const std::string name_;    // for messages, with the style as the user wrote it: "fix bd/fib"
  const CoreGuard guard_;
  Method method_;
  StepFigures figures_;
  Solvent solvent_;
  Scene scene_;
  MoveJudge judge_;
  AtomGroup group_;
  Companions companions_;
  StiffnessMonitor stiffness_;
  AdaptiveSteps adaptive_;
  TimestepCheck timestep_check_;
  std::unique_ptr<ForceWatch> force_watch_;    // made by the derived class after all other columns

 private:
  bdh::PieceScene piece_scene() const;

  PressureCheck pressures_;
  TimingTable timing_;
  std::string plan_;
  bool built_ = false;    // build() has been called
};

}    // namespace LAMMPS_NS
#endif
