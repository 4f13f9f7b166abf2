// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/pse: trajectory and mobility do not depend on the number and arrangement of ranks.  Run
// under mpirun -np 4.

#include "lammps/lammps_mobility.h"
#include "lammps/lammps_ranks.h"

#include "bdh_conditions.h"
#include "bdh_scene.h"

using bdh_test::all_ranks;
using bdh_test::expect_same_on_all_rank_counts;
using bdh_test::GivenForces;
using bdh_test::LammpsSession;
using bdh_test::largest_difference;
using bdh_test::my_rank;
using bdh_test::on_ranks;
using bdh_test::trajectory;

namespace {

const std::string start = "fix move all bd/pse 0.7 0.9 4711 radius 0.5 xi 1.0 fft estimate ";

/// A third of the edge of the boxes above, so that pairs extend over the domains of several
/// processes and back to their own.
const char *const small_box = R"(
units lj
atom_style atomic
atom_modify map array
boundary p p p
region box block 0 4 0 5 0 3.5
create_box 1 box
create_atoms 1 random 30 77 NULL
mass 1 1.0
pair_style zero 0.5
pair_coeff * *
timestep 0.004
)";

/// The same atoms in a tilted cell, with chains through its faces and bonds about as long as the
/// cell.
const char *const leaning_chains = R"(
units lj
atom_style bond
atom_modify map array
boundary p p p
region box prism 0 4 0 5 0 3.5 1.7 -1.2 2.1
create_box 1 box bond/types 1 extra/bond/per/atom 3 extra/special/per/atom 20
create_atoms 1 random 24 77 NULL
mass 1 1.0
pair_style zero 0.5
pair_coeff * *
bond_style harmonic
bond_coeff 1 0.0 1.0
comm_modify cutoff 5.0
create_bonds single/bond 1 1 2
create_bonds single/bond 1 2 3
create_bonds single/bond 1 3 4
create_bonds single/bond 1 4 5
create_bonds single/bond 1 10 11
create_bonds single/bond 1 12 20
create_bonds single/bond 1 1 24
timestep 1e-12
)";

}    // namespace

TEST(LammpsPseRanks, DoublePrecision)
{
  expect_same_on_all_rank_counts(start + "precision double", 40);
}

TEST(LammpsPseRanks, Parts)
{
  expect_same_on_all_rank_counts(start + "precision double parts yes", 20);
}

// Atoms migrate to another process at the end of the step that displaced them.
TEST(LammpsPseRanks, PartsTravelWithTheirAtoms)
{
  on_ranks(all_ranks(), bdh_test::bonded_suspension, "", [](LammpsSession &lmp) {
    lmp.command("pair_style none");
    lmp.script(start + "parts yes\ntimestep 0.02\nneigh_modify check no");
    for (int run = 0; run < 10; ++run) {
      lmp.command("run 3");
      double worst = 0.0;
      for (int i = 0; i < lmp->atom->nlocal; ++i)
        for (int d = 0; d < 3; ++d) {
          const double *parts = lmp.fix("move")->array_atom[i];
          worst = std::max(worst, std::fabs(parts[d] + parts[3 + d] - 0.02 * lmp->atom->v[i][d]));
        }
      EXPECT_LT(worst, 1e-13);    // displacements are of order 0.1
    }
  });
}

// Velocities of about 10 are accurate to 1e-6, so positions are accurate to 4e-8 per step.  40
// steps and collisions between stiff particles amplify this to 1e-5.  A pair missed once displaces
// its particles by at least 1e-3.
TEST(LammpsPseRanks, SinglePrecision)
{
  expect_same_on_all_rank_counts(start + "precision single", 40, bdh_test::bonded_suspension, 1e-4);
}

TEST(LammpsPseRanks, TightToleranceAndChosenSplitting)
{
  expect_same_on_all_rank_counts("fix move all bd/pse 0.7 0.9 4711 radius 0.5 tolerance 1e-7", 10);
}

TEST(LammpsPseRanks, WithCheck)
{
  expect_same_on_all_rank_counts(start + "check yes precision double", 3);
}

// The grid has 8 planes across the box, the fewest that any plan takes, which makes uneven slabs on
// 3 ranks.  With mpirun -np 9 some ranks own none.
TEST(LammpsPseRanks, FewPlanes)
{
  const std::string flat = R"(
units lj
atom_style atomic
boundary p p p
region box block 0 16 0 16 0 1.6
create_box 1 box
lattice sc 1.0
create_atoms 1 box
mass 1 1.0
pair_style zero 1.2
pair_coeff * *
timestep 0.001
)";
  expect_same_on_all_rank_counts("fix move all bd/pse 1.0 1.0 99 radius 0.5 tolerance 0.3 xi 0.5 "
                                 "precision double fft estimate",
                                 10, flat);
}

TEST(LammpsPseRanks, TriclinicCellUnderShear)
{
  std::string leaning = bdh_test::bonded_suspension;
  const std::string block = "block 0 10 0 12 0 8";
  leaning.replace(leaning.find(block), block.size(), "prism 0 10 0 12 0 8 4.9 -2.5 3.1");
  // 40 steps at this rate include a flip of the cell.
  expect_same_on_all_rank_counts(
      "fix shear all deform 1 xy erate 0.5 remap x\n" + start + "precision double", 40, leaning);
}

TEST(LammpsPseRanks, ArrangementsOfProcesses)
{
  if (all_ranks() < 4) GTEST_SKIP() << "needs 4 ranks";
  for (const std::string keywords : {"precision double", "precision single"}) {
    const auto reference = trajectory(1, start + keywords, 20, small_box);
    for (const std::string processors : {"2 2 1", "4 1 1", "1 4 1", "1 1 4", "1 2 2"}) {
      const auto x = trajectory(4, start + keywords, 20, small_box, processors);
      if (my_rank() == 0) {
        EXPECT_LT(largest_difference(x, reference), keywords == "precision double" ? 1e-10 : 1e-5)
            << processors << ", " << keywords;
      }
    }
  }
}

// Ranks without particles still take part in sums and transforms.
TEST(LammpsPseRanks, FewerParticlesThanRanks)
{
  const std::string pair = R"(
units lj
atom_style atomic
boundary p p p
region box block 0 6 0 6 0 9
create_box 1 box
create_atoms 1 single 1.0 2.0 1.1
create_atoms 1 single 2.0 3.0 8.7
mass 1 1.0
pair_style zero 1.0
pair_coeff * *
)";
  for (const std::string keywords : {"precision double", "precision double parts yes"})
    for (const std::string forces : {"", "fix pull all addforce 1.0 -0.3 0.2\n"})
      expect_same_on_all_rank_counts(forces + start + keywords, 10, pair);
}

TEST(LammpsPseRanks, TiledDecomposition)
{
  expect_same_on_all_rank_counts("comm_style tiled\nbalance 1.0 rcb\n" + start + "precision double",
                                 20);
}

// LAMMPS' lists leave out pairs with special_bonds 0, mark those between 0 and 1, and contain each
// pair once.  All of them interact through the fluid.
TEST(LammpsPseRanks, BondedPairsInteractThroughTheFluid)
{
  const auto force = bdh_test::random_vector(72, 11);
  for (const int ranks : {1, 2, 4})
    for (const std::string special :
         {"lj/coul 1 1 1", "lj/coul 0.5 0.5 0.5", "lj/coul 0 0 0", "lj/coul 0 1 0.5"}) {
      if (ranks > all_ranks()) continue;
      on_ranks(ranks, leaning_chains, ranks == 4 ? "4 1 1" : "", [&](LammpsSession &lmp) {
        lmp.command("special_bonds " + special);
        GivenForces forces(lmp, force);
        lmp.script("timestep 1e-12\nfix move all bd/pse 0.0 0.9 1 radius 0.6 xi 0.9 fft estimate "
                   "tolerance 1e-8");
        const auto exact = bdh_test::exact_velocities(lmp, 0.6, 0.9, force);
        lmp.command("run 1");
        EXPECT_LE(bdh_test::relative_error(lmp.velocities(), exact), 1e-8)
            << ranks << " ranks, special_bonds " << special;
        lmp.command("unfix move");
      });
    }
}

// A group changes between two steps on one rank only, without a new neighbor list.
TEST(LammpsPseRanks, DynamicGroup)
{
  expect_same_on_all_rank_counts(
      "variable low atom \"x < 1.0+0.05*step\"\n"
      "group low dynamic all var low every 1\nneighbor 1.0 bin\n"
      "fix move low bd/pse 0.7 0.9 4711 radius 0.5 xi 1.0 fft estimate precision double",
      20);
}

// Ranks share the memory of their machine, and see the same crowd.
TEST(LammpsPseRanks, ConditionsOfThePlan)
{
  bdh::PseConditions alone;
  for (int ranks = 1; ranks <= all_ranks(); ++ranks)
    on_ranks(ranks, small_box, "", [&](LammpsSession &lmp) {
      const bdh::PseConditions now =
          LAMMPS_NS::conditions_now(lmp.operator->(), 1, 0.5, LAMMPS_NS::cell_now(*lmp->domain));
      if (ranks == 1) alone = now;
      if (my_rank()) return;
      EXPECT_NEAR(now.memory, alone.memory, 1e-9 * alone.memory) << ranks;
      EXPECT_EQ(now.counts.mean, alone.counts.mean) << ranks;
      EXPECT_GT(now.memory, 0.0);
      EXPECT_FALSE(now.counts.empty());
    });
}
