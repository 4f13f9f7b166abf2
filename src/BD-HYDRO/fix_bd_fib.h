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
#include "bdh_fib_box.h"
#include "bdh_fib_engine.h"
#include "bdh_fib_plan_report.h"
#include "bdh_given_motions.h"
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
  double memory_usage() override;

 protected:
  void check_box() const override { box_.check(); }
  void build() override;
  PlanText plan_text() const override;
  void step() override;
  bdh::StepAgainstHalves compare_with_halves(double limit) override;
  std::string describe(long index) const override { return engine_->describe(index); }

  bdh::FibOptions options_;
  GivenMotions given_;
  std::unique_ptr<FibEngine> engine_;    // a derived class may replace it

 private:
  bdh::StepPlan plan_step() const;

  FibBox box_;
  FibPlanReport report_;
  std::unique_ptr<ConstraintOutput> constraint_output_;    // null without constraints
};

}    // namespace LAMMPS_NS
#endif
#endif
