// One trajectory whatever the number of ranks: run under mpirun -np 4, the first 1, 2, 3 and 4 ranks in turn.

#include "lammps_session.h"

#include <gtest/gtest.h>

using bdh_test::LammpsSession;

namespace {

/// 120 WCA particles and 3 bonds in a box that is neither cubic nor a multiple of anything.
const char *const suspension = R"(
units lj
atom_style bond
atom_modify map array
boundary p p p
newton on
region box block 0 10 0 12 0 8
create_box 1 box bond/types 1 extra/bond/per/atom 2
lattice sc 0.125
create_atoms 1 box
displace_atoms all random 0.3 0.3 0.3 5 units box
mass 1 1.0
pair_style lj/cut 1.122462048309373
pair_coeff 1 1 1.0 1.0
bond_style harmonic
bond_coeff 1 50.0 1.8
create_bonds single/bond 1 1 2
create_bonds single/bond 1 2 3
create_bonds single/bond 1 21 22
special_bonds lj 1 1 1
comm_modify cutoff 3.0
neighbor 0.1 bin
neigh_modify every 1 delay 0 check yes
timestep 0.004
)";

/// What a restart file does not hold.
const char *const after_restart = R"(
comm_modify cutoff 3.0
neighbor 0.1 bin
neigh_modify every 1 delay 0 check yes
timestep 0.004
)";

/// Positions after some steps on the first `ranks` ranks of the world; empty on the others.  The atoms are created by
/// one rank, since create_atoms numbers them by rank.
std::vector<double> trajectory(int ranks, const std::string &fix, int steps, const std::string &before = suspension)
{
  int me;
  MPI_Comm_rank(MPI_COMM_WORLD, &me);
  const std::string restart = "test_ranks.restart";
  if (me == 0) {
    LammpsSession lmp;
    lmp.script(before);
    lmp.script("run 0\nwrite_restart " + restart);
  }
  MPI_Barrier(MPI_COMM_WORLD);
  MPI_Comm comm;
  MPI_Comm_split(MPI_COMM_WORLD, me < ranks ? 0 : MPI_UNDEFINED, me, &comm);
  std::vector<double> x;
  if (comm != MPI_COMM_NULL) {
    // An error of one rank would leave the others waiting.
    try {
      LammpsSession lmp(comm);
      lmp.command("read_restart " + restart);
      lmp.script(after_restart);
      lmp.script(fix);
      lmp.command("run " + std::to_string(steps));
      x = lmp.unwrapped_positions();
    } catch (LAMMPS_NS::LAMMPSException &e) {
      fprintf(stderr, "%s", e.what());
      MPI_Abort(MPI_COMM_WORLD, 1);
    }
    MPI_Comm_free(&comm);
  }
  MPI_Barrier(MPI_COMM_WORLD);
  return x;
}

// Round-off (1e-16) grows through 40 steps of colliding particles; a wrong or missing contribution is 1e-2 and larger.
void expect_same_on_all_rank_counts(const std::string &fix, int steps, const std::string &before = suspension)
{
  int me, size;
  MPI_Comm_rank(MPI_COMM_WORLD, &me);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  std::vector<double> reference;
  for (int ranks = 1; ranks <= size; ++ranks) {
    const std::vector<double> x = trajectory(ranks, fix, steps, before);
    if (me) continue;
    if (ranks == 1) reference = x;
    EXPECT_FALSE(x.empty());
    EXPECT_LT(bdh_test::largest_difference(x, reference), 1e-9) << ranks << " ranks";
  }
}

const std::string start = "fix move all bd/fib 0.7 0.9 4711 grid 20 24 16 ";

}    // namespace

TEST(LammpsRanks, Midpoint) { expect_same_on_all_rank_counts(start, 40); }
TEST(LammpsRanks, Improved) { expect_same_on_all_rank_counts(start + "scheme improved", 40); }
TEST(LammpsRanks, FiniteDifference) { expect_same_on_all_rank_counts(start + "drift rfd scheme improved", 40); }
TEST(LammpsRanks, Trapezoidal) { expect_same_on_all_rank_counts(start + "scheme trapezoidal shear 0.3", 40); }

TEST(LammpsRanks, MoreRanksThanSlabs)
{
  // 3 planes along z: one rank of four owns none.
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
  expect_same_on_all_rank_counts("fix move all bd/fib 1.0 1.0 99 grid 16 16 3 kernel roma3", 30, flat);
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
  expect_same_on_all_rank_counts("fix move all bd/fib 1.0 1.0 99 grid 30 24 1 scheme improved", 30, flat);
}

TEST(LammpsRanks, SeedsAreUnrelated)
{
  const auto a = trajectory(1, "fix move all bd/fib 0.7 0.9 1 grid 20 24 16", 5);
  const auto b = trajectory(1, "fix move all bd/fib 0.7 0.9 2 grid 20 24 16", 5);
  int me;
  MPI_Comm_rank(MPI_COMM_WORLD, &me);
  if (me == 0) {
    EXPECT_GT(bdh_test::largest_difference(a, b), 1e-2);
  }
}
