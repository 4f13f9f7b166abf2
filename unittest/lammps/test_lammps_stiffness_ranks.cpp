// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// The stiffness that fixes report does not depend on the number of ranks.

#include "lammps/lammps_ranks.h"
#include "lammps/lammps_stiffness.h"

namespace {

/// p of the last step, on average and at most, and the line of the run.
struct Report {
  double mean = 0.0, most = 0.0;
  bdh_test::StiffnessLine line;
};

Report report(int ranks, const std::string &fix)
{
  Report r;
  bdh_test::on_ranks(ranks, bdh_test::bonded_suspension, "", [&](bdh_test::LammpsSession &lmp) {
    lmp.script(fix + "\nrun 12");
    LAMMPS_NS::Fix &f = *lmp.fix("move");
    r = {f.compute_vector(f.size_vector - 4), f.compute_vector(f.size_vector - 3), {}};
    r.line = bdh_test::stiffness_line(lmp.log());
  });
  return r;
}

}    // namespace

TEST(StiffnessOnRanks, IsTheSame)
{
  for (const char *fix : {"fix move all bd/fib 1.0 1.0 5 radius 0.9 scheme improved",
                          "fix move all bd/pse 1.0 1.0 5 radius 0.9 scheme split substeps 3"}) {
    Report one;
    for (int ranks = 1; ranks <= bdh_test::all_ranks(); ++ranks) {
      const Report r = report(ranks, fix);
      if (ranks == 1) one = r;
      if (bdh_test::my_rank()) continue;
      EXPECT_GT(r.line.mean, 0.0) << fix;
      EXPECT_NEAR(r.mean, one.mean, 1e-6 * one.mean) << fix << ": " << ranks;
      EXPECT_NEAR(r.most, one.most, 1e-6 * one.most) << fix << ": " << ranks;
      EXPECT_EQ(r.line.text, one.line.text) << fix << ": " << ranks;
    }
  }
}
