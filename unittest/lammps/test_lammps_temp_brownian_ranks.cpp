// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// compute temp/brownian on 1, 2, 3 and 4 ranks: pressures, stresses of atoms, and warnings.

#include "lammps/lammps_ranks.h"

#include "compute.h"

#include <algorithm>

using bdh_test::LammpsSession;

namespace {

LAMMPS_NS::Compute &compute(LammpsSession &lmp, const std::string &id)
{
  return *lmp->modify->compute[lmp->modify->find_compute(id)];
}

const std::string move = "fix 1 all bd/fib 1.5 1.0 5 grid 10 12 8 fft estimate\n";

}    // namespace

// The signs of the shear stress depend on atom ids.  Round-off grows through 5 steps.
TEST(LammpsTempBrownianRanks, PressureAndStressOfAtoms)
{
  std::vector<double> reference;
  for (int ranks = 1; ranks <= bdh_test::all_ranks(); ++ranks)
    bdh_test::on_ranks(ranks, bdh_test::bonded_suspension, "", [&](LammpsSession &lmp) {
      lmp.script("group some id 1:100\n" + move +
                 "compute T some temp/brownian 1\ncompute P all pressure T\n"
                 "compute S all stress/atom T\nfix S all ave/atom 1 1 1 c_S[*]\n"
                 "thermo 1\nthermo_style custom step c_P c_P[1]\nrun 5");
      std::vector<double> now = lmp.per_atom("S", 6);
      now.push_back(compute(lmp, "P").scalar);
      now.push_back(compute(lmp, "T").dof);
      now.insert(now.end(), compute(lmp, "P").vector, compute(lmp, "P").vector + 6);
      if (bdh_test::my_rank()) return;
      if (ranks == 1) reference = now;
      EXPECT_EQ(compute(lmp, "T").dof, 300);
      EXPECT_LT(bdh_test::largest_difference(now, reference), 1e-8) << ranks << " ranks";
    });
}

TEST(LammpsTempBrownianRanks, OneWarning)
{
  for (int ranks = 1; ranks <= bdh_test::all_ranks(); ++ranks)
    bdh_test::on_ranks(ranks, bdh_test::bonded_suspension, "", [&](LammpsSession &lmp) {
      lmp.script(move + "thermo_style one\nrun 2");
      const std::string log = lmp.log(), warning = "WARNING: fix bd/fib: the kinetic part";
      if (bdh_test::my_rank()) return;
      const size_t first = log.find(warning);
      EXPECT_NE(first, std::string::npos) << ranks << " ranks";
      EXPECT_EQ(log.find(warning, first + 1), std::string::npos) << ranks << " ranks";
    });
}
