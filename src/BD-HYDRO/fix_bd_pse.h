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

#include "bdh_constraint_output.h"
#include "bdh_given_motions.h"
#include "bdh_parts_output.h"
#include "bdh_plan_in_use.h"
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
  void init_list(int, class NeighList *list) override { in_use_.pairs().set_list(list); }
  void setup(int) override;
  void setup_pre_neighbor() override { in_use_.pairs().keep_pairs_of_others(); }
  void setup_post_neighbor() override { post_neighbor(); }
  void post_neighbor() override { in_use_.pairs().list_was_built(); }
  int pack_forward_comm(int, int *, double *, int, int *) override;
  void unpack_forward_comm(int, int, double *) override;
  double compute_vector(int) override;
  double memory_usage() override;

 protected:
  void check_box() const override;
  void build() override;
  PlanText plan_text() const override;
  void step() override;
  bdh::StepAgainstHalves compare_with_halves(double limit) override;
  std::string describe(long index) const override { return in_use_.engine().describe(index); }

  bdh::PseOptions options_;
  PseColumns kept_;    // of scheme split
  GivenMotions given_;
  const PseFixParts engine_parts_{options_, group_, columns_, kept_, given_};
  PlanInUse in_use_;    // a derived class may give it other pairs and another engine

 private:
  std::unique_ptr<PartsOutput> parts_;                     // null without keyword parts
  std::unique_ptr<ConstraintOutput> constraint_output_;    // null without constraints
};

}    // namespace LAMMPS_NS
#endif
#endif
