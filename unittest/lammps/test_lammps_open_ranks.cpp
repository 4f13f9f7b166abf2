// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/fib with open faces on several ranks.  Run under mpirun -np 4.

#include "lammps/lammps_ranks.h"

using bdh_test::expect_same_on_all_rank_counts;

namespace {

/// A suspension that stays away from the faces of its box.
std::string suspension(const std::string &boundary)
{
  return "units lj\natom_style atomic\natom_modify map array\nboundary " + boundary + R"(
region box block 0 10 0 12 0 14
create_box 1 box
region inner block 0.5 9.5 2.5 9.5 0.5 7.5
lattice sc 0.125 origin 0.3 0.3 0.3
create_atoms 1 region inner
mass 1 1.0
pair_style lj/cut 1.122462048309373
pair_coeff 1 1 1.0 1.0
)";
}

const std::string start = "fix move all bd/fib 0.7 0.9 4711 grid 20 24 28 fft estimate ";

}    // namespace

TEST(LammpsOpenRanks, AboveAWall)
{
  for (const char *scheme : {"midpoint", "improved", "trapezoidal drift rfd"})
    expect_same_on_all_rank_counts(
        start + "crossing reflect wall zlo noslip wall zhi open scheme " + scheme, 40,
        suspension("p p f"));
}

// The grid is as high as the highest atom on any rank, and the face of the box goes along.
TEST(LammpsOpenRanks, AFaceThatFollowsTheAtoms)
{
  expect_same_on_all_rank_counts("fix lift all addforce 0 0 3\nfix move all bd/fib 0.7 0.9 4711 "
                                 "radius 0.6 fft estimate wall zlo noslip wall zhi open",
                                 60, suspension("p p fs"));
}

TEST(LammpsOpenRanks, OtherFacesAndShear)
{
  const std::string along_y = suspension("p f p");
  for (const char *walls : {"wall ylo open wall yhi noslip 0.2 0 0 shear 0.1",
                            "wall ylo open wall yhi open", "wall ylo slip wall yhi open"})
    expect_same_on_all_rank_counts(start + walls, 20, along_y);
}
