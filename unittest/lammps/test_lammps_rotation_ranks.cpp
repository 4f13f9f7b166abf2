// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Orientations and angular velocities do not depend on the number of ranks.  Run under mpirun -np
// 4, which takes the first 1, 2, 3 and 4 ranks in turn.

#include "lammps/lammps_ranks.h"

using bdh_test::LammpsSession;

namespace {

/// 120 interacting dipoles in a field; they change ranks, also within a step.
const std::string magnets = R"(
units lj
atom_style hybrid sphere dipole
atom_modify map array
boundary p p p
newton on
region box block 0 10 0 12 0 8
create_box 1 box
lattice sc 0.125 origin 0.5 0.5 0.5
create_atoms 1 box
displace_atoms all random 0.3 0.3 0.3 5 units box
set group all diameter 1.0
set group all charge 0.0
set group all dipole/random 345 1.5
pair_style lj/cut/dipole/cut 1.122462048309373 3.0
pair_coeff 1 1 1.0 1.0
fix field all efield 0.5 1.0 -0.7
neighbor 0.1 bin
neigh_modify every 1 delay 0 check yes
timestep 0.01
)";

/// mu and omega by atom id, on every rank.
std::vector<double> turned(LammpsSession &lmp)
{
  const LAMMPS_NS::Atom &atom = lmp.host_atoms();
  std::vector<double> mine(6 * atom.natoms, 0.0), all(mine.size());
  for (int i = 0; i < atom.nlocal; ++i)
    for (int d = 0; d < 3; ++d) {
      mine[6 * (atom.tag[i] - 1) + d] = atom.mu[i][d];
      mine[6 * (atom.tag[i] - 1) + 3 + d] = atom.omega[i][d];
    }
  MPI_Allreduce(mine.data(), all.data(), mine.size(), MPI_DOUBLE, MPI_SUM, lmp->world);
  return all;
}

void expect_same_turns(const std::string &fix, const std::string &walls = "")
{
  std::vector<double> alone;
  const std::string settings = "pair_style lj/cut/dipole/cut 1.122462048309373 3.0\n"
                               "pair_coeff 1 1 1.0 1.0\nfix field all efield 0.5 1.0 -0.7\n"
                               "neighbor 0.1 bin\nneigh_modify every 1 delay 0 check yes\n"
                               "timestep 0.01\n";
  for (int ranks = 1; ranks <= bdh_test::all_ranks(); ++ranks)
    bdh_test::on_ranks(ranks, magnets + walls, "", [&](LammpsSession &lmp) {
      lmp.script(settings + fix + "\nrun 25");
      const std::vector<double> now = turned(lmp);
      if (ranks == 1) alone = now;
      if (bdh_test::my_rank()) return;
      EXPECT_LT(bdh_test::largest_difference(now, alone), 1e-8) << ranks << " ranks, " << fix;
    });
}

}    // namespace

TEST(LammpsRotationRanks, Midpoint)
{
  expect_same_turns("fix move all bd/fib 0.7 0.9 4711 grid 20 24 16");
}
TEST(LammpsRotationRanks, Improved)
{
  expect_same_turns("fix move all bd/fib 0.7 0.9 4711 grid 20 24 16 scheme improved kernel bkp6");
}
TEST(LammpsRotationRanks, ThinGrid)
{
  expect_same_turns(
      "fix move all bd/fib 0.7 0.9 4711 grid 10 12 8 scheme trapezoidal kernel roma3");
}
TEST(LammpsRotationRanks, WithoutHydrodynamics)
{
  expect_same_turns("fix move all bd/fib 0.7 0.9 4711 grid 20 24 16 hydrodynamics no");
}
TEST(LammpsRotationRanks, Slit)
{
  expect_same_turns("fix move all bd/fib 0.7 0.9 4711 grid 20 24 16 wall xlo noslip wall xhi slip "
                    "crossing reflect",
                    "change_box all boundary f p p\n");
}
TEST(LammpsRotationRanks, AboveOneWall)
{
  // The open face follows the atoms, and the grid has only the rows up to the highest one.
  expect_same_turns("fix move all bd/fib 0.7 0.9 4711 radius 0.6 wall xlo noslip wall xhi open "
                    "crossing reflect scheme improved",
                    "change_box all boundary fm p p\n");
}
