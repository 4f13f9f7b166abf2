// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Steps in pieces do not depend on the number of ranks: the same choices, the same trajectory.

#include "lammps/lammps_ranks.h"

namespace {

struct Result {
  std::vector<double> x, v;
  double pieces = 0.0;
};

Result result(int ranks, const std::string &fix)
{
  Result r;
  bdh_test::on_ranks(ranks, bdh_test::bonded_suspension, "", [&](bdh_test::LammpsSession &lmp) {
    lmp.script(fix + "\ntimestep 0.05\nrun 4");
    LAMMPS_NS::Fix &f = *lmp.fix("move");
    r = {lmp.unwrapped_positions(), lmp.velocities(), f.compute_vector(f.size_vector - 2)};
  });
  return r;
}

}    // namespace

// Atoms change rank within these steps, which take them up to 0.3 of a subdomain.
TEST(AdaptOnRanks, IsTheSame)
{
  for (const char *words :
       {"bd/fib 1.0 0.1 5 radius 0.9 adapt 0.03",
        "bd/pse 1.0 0.1 5 radius 0.9 precision double adapt 0.03",
        "bd/pse 1.0 0.1 5 radius 0.9 precision double scheme split substeps 1 adapt 0.05",
        "bd/pse 1.0 0.1 5 radius 0.9 precision double scheme split substeps auto adapt 0.05"}) {
    const std::string fix = "fix move all " + std::string(words);
    Result one;
    for (int ranks = 1; ranks <= bdh_test::all_ranks(); ++ranks) {
      const Result r = result(ranks, fix);
      if (ranks == 1) one = r;
      if (bdh_test::my_rank()) continue;
      EXPECT_GE(r.pieces, 4.0) << fix;
      EXPECT_EQ(r.pieces, one.pieces) << fix << ": " << ranks;
      EXPECT_LT(bdh_test::largest_difference(r.x, one.x), 1e-8) << fix << ": " << ranks;
      EXPECT_LT(bdh_test::largest_difference(r.v, one.v), 1e-7) << fix << ": " << ranks;
    }
  }
}
