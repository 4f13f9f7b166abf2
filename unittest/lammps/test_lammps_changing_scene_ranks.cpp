// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// A scene that changes during a run changes for all processors alike: the trajectories are the same
// on 1 to 4 of them, and any number of them can continue from a restart file.

#include "lammps/lammps_ranks.h"
#include "lammps/lammps_scenes.h"

using bdh_test::all_ranks;
using bdh_test::expect_same_on_all_rank_counts;
using bdh_test::LammpsSession;
using bdh_test::my_rank;

namespace {

const char *const growing_spheres = R"(
units lj
atom_style sphere 1
atom_modify map array
region box block 0 10 0 12 0 8
create_box 1 box
lattice sc 0.02
create_atoms 1 box
displace_atoms all random 0.3 0.3 0.3 5 units box
set group all diameter 1.0
neighbor 0.5 bin
neigh_modify every 1 delay 0 check yes
)";

const std::string move = "bd/pse 0.7 0.9 4711 fft estimate precision double tolerance 1e-4\n";

}    // namespace

TEST(ChangingSceneRanks, FirstParticlesOfADynamicGroup)
{
  expect_same_on_all_rank_counts("variable low atom (step>4)*(x<1.0+0.1*step)\n"
                                 "group low dynamic all var low every 1\nneighbor 1.0 bin\n"
                                 "fix move low " +
                                     move,
                                 20, growing_spheres);
}

TEST(ChangingSceneRanks, RadiiGrow)
{
  expect_same_on_all_rank_counts("variable D equal ramp(1.0,1.6)\n"
                                 "fix swell all adapt 1 atom diameter v_D\nneighbor 1.0 bin\n"
                                 "fix move all " +
                                     move,
                                 12, growing_spheres);
}

TEST(ChangingSceneRanks, ParticlesAreDeposited)
{
  expect_same_on_all_rank_counts(
      "region r block 1 9 1 11 1 7\nneighbor 1.0 bin\n"
      "fix dep all deposit 60 1 1 4567 region r near 0.3\nfix move all " +
          move,
      70, growing_spheres);
}

TEST(ChangingSceneRanks, TheBoxShrinks)
{
  expect_same_on_all_rank_counts("fix move all " + move +
                                     "fix shrink all deform 1 x final 0 6 y final 0 6 z final 0 6 "
                                     "remap x\n",
                                 40, growing_spheres);
}

// All ranks take the new plan at the same step, although only one of them sees the change.
TEST(ChangingSceneRanks, TheRadiusOfOneRankChanges)
{
  for (int ranks = 1; ranks <= all_ranks(); ranks += 3)
    bdh_test::on_ranks(ranks, growing_spheres, "", [&](LammpsSession &lmp) {
      lmp.script("fix move all " + move +
                 "group one id 5\nvariable D equal 1+0.1*(step>3)\n"
                 "fix swell one adapt 1 atom diameter v_D\n");
      lmp.command("run 10");
      if (bdh_test::my_rank()) return;    // the first rank writes the log
      EXPECT_NE(lmp.log().find("step 5: the plan is made again, since the radii have changed"),
                std::string::npos);
    });
}

TEST(ChangingSceneRanks, TheRestartFileHasThePlanForAnyNumberOfRanks)
{
  const std::string fix =
      "fix move all bd/pse 0.7 0.9 4711 radius 0.5 fft estimate precision double "
      "scheme split substeps 2\n";
  const std::string expanded = std::string(bdh_test::bonded_suspension) + fix +
                               "run 5\nchange_box all x scale 1.1 y scale 1.1 remap\n";
  expect_same_on_all_rank_counts(fix, 8, expanded, 1e-9);
}
