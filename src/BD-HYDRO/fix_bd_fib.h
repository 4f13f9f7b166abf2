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
FixStyle(temp/bd/fib,FixBDFib);
// clang-format on
#else

#ifndef LMP_FIX_BD_FIB_H
#define LMP_FIX_BD_FIB_H

#include "bdh_constraint_output.h"
#include "bdh_fib_engine.h"
#include "bdh_given_motions.h"
#include "fib/moving_walls.h"
#include "fix_bd.h"

namespace LAMMPS_NS {

/// fix bd/fib: the fluctuating immersed boundary method of Delong et al., J. Chem. Phys. 140,
/// 134110 (2014).
class FixBDFib : public FixBD {
 public:
  FixBDFib(class LAMMPS *, int, char **);
  void post_constructor() override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  void init() override;
  void setup(int) override;
  double compute_vector(int) override;

 protected:
  void check_box() const override;
  void build() override;
  std::string plan_text() const override;
  std::string state_text() const override;
  void step() override;
  bdh::StepAgainstHalves compare_with_halves(double limit) override;
  double mobility_memory() const override { return engine_->memory(); }
  std::string describe(long index) const override { return engine_->describe(index); }

  bdh::FibOptions options_;
  GivenMotions given_;
  std::unique_ptr<FibEngine> engine_;    // a derived class may replace it

 private:
  bdh::StepPlan plan_step() const;
  bool body_force_has_effect() const;
  bool may_follow_atoms(int axis, int side) const;
  bdh::Grid grid_of_box() const;
  void check_same_box() const;
  void check_flow() const;
  void check_stresslets() const;
  bdh::Symmetric<double> strain_of_flow() const;
  std::string free_particles_text() const;
  std::string rotation_text() const;
  std::string stresslet_text() const;
  void warn_about_cells() const;
  void warn_about_radii();
  std::string solver_text() const;
  std::string wall_text(int axis, int side) const;

  std::unique_ptr<ConstraintOutput> constraint_output_;    // null without constraints
  bdh::Grid grid_;
  std::array<std::array<double, 2>, 3> box_{};    // faces that the grid was made for
  bdh::WallMotion walls_;
  bool warned_radii_ = false;
};

}    // namespace LAMMPS_NS
#endif
#endif
