// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// The trajectory does not depend on the number of ranks.  Run under mpirun -np 4, which takes the
// first 1, 2, 3 and 4 ranks in turn.

#include "lammps/lammps_ranks.h"

using bdh_test::expect_same_on_all_rank_counts;
using bdh_test::trajectory;

namespace {

const std::string start = "fix move all bd/fib 0.7 0.9 4711 grid 20 24 16 ";

}    // namespace

TEST(LammpsRanks, Midpoint) { expect_same_on_all_rank_counts(start, 40); }
TEST(LammpsRanks, Improved) { expect_same_on_all_rank_counts(start + "scheme improved", 40); }
TEST(LammpsRanks, FiniteDifference)
{
  expect_same_on_all_rank_counts(start + "drift rfd scheme improved", 40);
}
TEST(LammpsRanks, Trapezoidal)
{
  expect_same_on_all_rank_counts(start + "scheme trapezoidal shear 0.3", 40);
}

TEST(LammpsRanks, MoreRanksThanSlabs)
{
  // With 3 planes along z one rank of four owns none.
  const std::string flat = R"(
units lj
atom_style atomic
boundary p p p
region box block 0 16 0 16 0 3
create_box 1 box
lattice sc 1.5
create_atoms 1 box
mass 1 1.0
pair_style zero 1.2
pair_coeff * *
neigh_modify every 1 delay 0 check yes
timestep 0.01
)";
  expect_same_on_all_rank_counts("fix move all bd/fib 1.0 1.0 99 grid 16 16 3 kernel roma3", 30,
                                 flat);
}

TEST(LammpsRanks, TwoDimensions)
{
  const std::string flat = R"(
units lj
dimension 2
atom_style atomic
boundary p p p
region box block 0 15 0 12 -0.5 0.5
create_box 1 box
lattice sq 1.0
create_atoms 1 box
mass 1 1.0
pair_style lj/cut 1.122462048309373
pair_coeff 1 1 0.1 0.8
neigh_modify every 1 delay 0 check yes
fix flat all enforce2d
timestep 0.004
)";
  expect_same_on_all_rank_counts("fix move all bd/fib 1.0 1.0 99 grid 30 24 1 scheme improved", 30,
                                 flat);
}

/// A suspension that is kept away from the faces of its box.
static std::string walled(const std::string &boundary)
{
  return "units lj\natom_style atomic\natom_modify map array\nboundary " + boundary + R"(
region box block 0 10 0 12 0 8
create_box 1 box
region inner block 0.5 9.5 0.5 11.5 0.5 7.5
lattice sc 0.125 origin 0.3 0.3 0.3
create_atoms 1 region inner
mass 1 1.0
pair_style lj/cut 1.122462048309373
pair_coeff 1 1 1.0 1.0
)";
}

TEST(LammpsRanks, Slit)
{
  for (const char *axis : {"x", "z"}) {
    const std::string slit = walled(*axis == 'x' ? "f p p" : "p p f");
    const std::string lo = std::string(" wall ") + axis + "lo noslip",
                      hi = std::string(" wall ") + axis + "hi slip";
    expect_same_on_all_rank_counts(start + "crossing reflect force 0.1 0.1 0.1" + lo + hi, 40,
                                   slit);
    expect_same_on_all_rank_counts(start + "crossing reflect scheme improved" + lo + hi, 40, slit);
  }
}

// Walls in two directions.  Conjugate gradients go to 1e-12, so that their stopping does not show.
TEST(LammpsRanks, Duct)
{
  expect_same_on_all_rank_counts(
      start + "crossing reflect force 0 0.1 0 tolerance 1e-12 wall xlo noslip wall xhi noslip "
              "wall zlo noslip wall zhi slip",
      20, walled("f p f"));
}

TEST(LammpsRanks, SeedsAreUnrelated)
{
  const auto a = trajectory(1, "fix move all bd/fib 0.7 0.9 1 grid 20 24 16", 5);
  const auto b = trajectory(1, "fix move all bd/fib 0.7 0.9 2 grid 20 24 16", 5);
  if (bdh_test::my_rank() == 0) {
    EXPECT_GT(bdh_test::largest_difference(a, b), 1e-2);
  }
}
