// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/pse, scheme split: the trajectory does not depend on the number of ranks.  Run under
// mpirun -np 4.

#include "lammps/lammps_mobility.h"
#include "lammps/lammps_ranks.h"

// Atoms migrate between substeps and take their noise and displacement with them.
TEST(LammpsPseSplitRanks, SameTrajectory)
{
  bdh_test::expect_same_on_all_rank_counts("fix move all bd/pse 0.7 0.9 4711 radius 0.5 xi 1.0 fft "
                                           "estimate precision double scheme split substeps 3",
                                           15);
}

// In a tilted cell the rank of an atom depends on its position along the cell's edges.
TEST(LammpsPseSplitRanks, SameTrajectoryInATiltedCell)
{
  std::string tilted = bdh_test::bonded_suspension;
  const std::string block = "block 0 10 0 12 0 8";
  tilted.replace(tilted.find(block), block.size(), "prism 0 10 0 12 0 8 2 -4 4");
  bdh_test::expect_same_on_all_rank_counts("fix move all bd/pse 0.7 0.9 4711 radius 0.5 xi 1.0 fft "
                                           "estimate precision double scheme split substeps 3",
                                           15, tilted);
}

// Ranks without particles take part in all collective operations.
TEST(LammpsPseSplitRanks, SameTrajectoryOfOneParticle)
{
  bdh_test::expect_same_on_all_rank_counts(
      "group one id 60\nfix move one bd/pse 0.7 0.9 4711 radius 0.5 xi 1.0 fft estimate precision "
      "double scheme split substeps 3",
      5);
}
