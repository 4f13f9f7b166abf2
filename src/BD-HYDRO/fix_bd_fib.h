/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(bd/fib,FixBDFib);
FixStyle(brownian/fib,FixBDFib);
// clang-format on
#else

#ifndef LMP_FIX_BD_FIB_H
#define LMP_FIX_BD_FIB_H

#include "fib/moving_walls.h"
#include "fib/step.h"
#include "fix_bd.h"

namespace LAMMPS_NS {

/// fix bd/fib: the fluctuating immersed boundary method of Delong et al., J. Chem. Phys. 140,
/// 134110 (2014).
class FixBDFib : public FixBD {
 public:
  FixBDFib(class LAMMPS *, int, char **);

 protected:
  void check_box() const override;
  void build() override;
  std::string plan_text() const override;
  void step(bdh::Particles &particles) override;
  /// Collective.  The fluid for grid().
  virtual std::unique_ptr<bdh::FibEngine> make_engine() const;
  /// Does one step, and keeps what the solver has to say.
  template <class Backend>
  void take_with(bdh::ParticlesOf<typename Backend::ParticleVector> &particles)
  {
    try {
      static_cast<bdh::FibEngineOn<Backend> &>(*engine_).take(particles, plan_step());
    } catch (const bdh::NotConverged &e) {
      throw bdh::NotConverged(std::string(e.what()) +
                              ": use a looser tolerance, or a box that is less long and narrow");
    }
    const bdh::SolveReport report = engine_->report();
    figures_.solver_iterations = report.iterations;
    figures_.error_estimate = report.residual;
  }
  double longest_move() const override;
  const char *longest_move_name() const override { return "the grid spacing"; }
  double mobility_memory() const override;
  bool uses_midpoint_forces() const override { return options_.scheme == bdh::Scheme::improved; }
  bool uses_unwrapped_positions() const override { return options_.shear_rate != 0.0; }
  const bdh::Grid &grid() const { return grid_; }
  const bdh::FibOptions &options() const { return options_; }

 public:
  double compute_vector(int) override;

 private:
  bdh::StepPlan plan_step() const;
  bool body_force_has_effect() const;
  void warn_about_cells() const;
  void warn_about_radii();
  std::string solver_text() const;
  std::string wall_text(int axis, int side) const;

  bdh::FibOptions options_;
  bdh::Grid grid_;
  bdh::WallMotion walls_;
  std::unique_ptr<bdh::FibEngine> engine_;
  bool warned_radii_ = false;
};

}    // namespace LAMMPS_NS
#endif
#endif
