// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/fib between walls on several ranks: crossings and forces on walls.  Run under mpirun
// -np 4.

#include "lammps/lammps_ranks.h"

using bdh_test::all_ranks;
using bdh_test::LammpsSession;
using bdh_test::my_rank;
using bdh_test::on_ranks;

namespace {

/// 200 atoms without forces, for steps so long that some of them cross a wall.
const std::string crowd = R"(
units lj
atom_style atomic
atom_modify map array
boundary p p f
comm_modify cutoff 3.0
region box block 0 12 0 12 -3 9
create_box 1 box
create_atoms 1 random 200 5 box
mass 1 1.0
)";

struct Outcome {
  std::vector<double> x;
  double crossings = 0.0;
};

void expect_same_crossings(const std::string &keywords)
{
  Outcome reference;
  for (int ranks = 1; ranks <= all_ranks(); ++ranks) {
    Outcome here;
    on_ranks(ranks, crowd, "", [&](LammpsSession &lmp) {
      lmp.script(
          "timestep 4.0\nfix move all bd/fib 1.0 1.0 7 grid 12 12 12 kernel roma3 fft estimate "
          "wall zlo noslip wall zhi slip " +
          keywords + "\nrun 20");
      here = {lmp.unwrapped_positions(), lmp.fix("move")->compute_vector(8)};
    });
    if (my_rank()) continue;
    if (ranks == 1) {
      reference = here;
      EXPECT_GT(here.crossings, 0.0) << keywords;
    }
    EXPECT_EQ(here.crossings, reference.crossings) << keywords << ", " << ranks << " ranks";
    EXPECT_LT(bdh_test::largest_difference(here.x, reference.x), 1e-9)
        << keywords << ", " << ranks << " ranks";
  }
}

}    // namespace

// All ranks draw a step again if an atom on any of them crosses a wall.  A rank that did so by
// itself would wait forever.
TEST(LammpsWallsRanks, RedrawIsDecidedTogether)
{
  for (const char *scheme : {"euler", "trapezoidal", "midpoint"})
    expect_same_crossings(std::string("crossing redraw scheme ") + scheme);
}

TEST(LammpsWallsRanks, Reflect)
{
  for (const char *scheme : {"euler", "midpoint", "improved"})
    expect_same_crossings(std::string("crossing reflect scheme ") + scheme);
}

// The force is eta dv/dz times the area on moving walls, and b times the volume on both together.
TEST(LammpsWallsRanks, ForcesOnWalls)
{
  for (int ranks = 1; ranks <= all_ranks(); ++ranks) {
    double moving[2] = {0.0, 0.0}, driven[2] = {0.0, 0.0};
    on_ranks(ranks, crowd, "", [&](LammpsSession &lmp) {
      const std::string start =
          "fix move all bd/fib 0.0 2.0 7 grid 12 12 12 kernel roma3 fft estimate ";
      const auto forces = [&](double *x) {
        for (int side = 0; side < 2; ++side)
          x[side] = lmp.fix("move")->compute_vector(9 + 12 + 3 * side);
      };
      lmp.script(start + "wall zlo noslip -0.5 0 0 wall zhi noslip 1.5 0 0\nrun 1");
      forces(moving);
      lmp.script("unfix move\n" + start + "force 0.3 0 0 wall zlo noslip wall zhi noslip\nrun 1");
      forces(driven);
    });
    if (my_rank()) continue;
    EXPECT_NEAR(moving[0], 2.0 * 2.0 / 12.0 * 144.0, 1e-11) << ranks;
    EXPECT_NEAR(moving[1], -2.0 * 2.0 / 12.0 * 144.0, 1e-11) << ranks;
    EXPECT_NEAR(driven[0] + driven[1], 0.3 * 1728.0, 1e-10) << ranks;
  }
}
