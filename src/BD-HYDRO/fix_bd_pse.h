/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(bd/pse,FixBDPse);
FixStyle(brownian/pse,FixBDPse);
FixStyle(temp/bd/pse,FixBDPse);
// clang-format on
#else

#ifndef LMP_FIX_BD_PSE_H
#define LMP_FIX_BD_PSE_H

#include "bdh_pairs.h"
#include "bdh_pse_engine.h"
#include "bdh_pse_planning.h"
#include "bdh_tolerance_check.h"
#include "fix_bd.h"

namespace LAMMPS_NS {

/// fix bd/pse: positively split Ewald, Fiore et al., J. Chem. Phys. 146, 124116 (2017).
class FixBDPse : public FixBD {
 public:
  FixBDPse(class LAMMPS *, int, char **);

  void post_constructor() override;
  void init() override;
  int setmask() override;
  void write_restart(FILE *) override;
  void restart(char *) override;
  void init_list(int, class NeighList *list) override { pairs_->set_list(list); }
  void setup(int) override;
  void setup_post_neighbor() override { post_neighbor(); }
  void post_neighbor() override { pairs_->list_was_built(); }
  int pack_forward_comm(int, int *, double *, int, int *) override;
  void unpack_forward_comm(int, int, double *) override;

 protected:
  void check_box() const override;
  void build() override;
  std::string plan_text() const override;
  void step() override;
  double mobility_memory() const override { return engine_->memory(); }
  std::string describe(long index) const override { return engine_->describe(index); }
  PseFixParts engine_parts() { return {options_, group_, columns_, kept_}; }

  bdh::PseOptions options_;
  PseColumns kept_;    // of scheme split
  std::unique_ptr<PairSource> pairs_;
  std::unique_ptr<PseEngine> engine_;    // a derived class may put another one here

 private:
  bdh::PseStepPlan step_plan() const;
  void use_plan(bool is_new);
  void follow_scene();
  void follow_box();

  AtomColumns::Column parts_;    // of keyword parts: both displacements of the step
  PsePlanning planning_;
  ToleranceCheck check_;
  bdh::Cell cell_;              // that the engine knows
  double grid_memory_ = 0.0;    // bytes on this processor when the grid was made
};

}    // namespace LAMMPS_NS
#endif
#endif
