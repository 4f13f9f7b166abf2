// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Companions in the input script are found on any number of ranks, wherever the atoms are, and are
// mentioned once.

#include "lammps/lammps_mobility.h"
#include "lammps/lammps_ranks.h"

#include "comm.h"

using bdh_test::LammpsSession;

namespace {

/// How often a text occurs in the log of rank 0; the same number on all ranks of the session.
int mentions(LammpsSession &lmp, const std::string &text)
{
  int n = 0;
  if (lmp->comm->me == 0) {
    const std::string log = lmp.log();
    for (size_t at = log.find(text); at != std::string::npos; at = log.find(text, at + 1)) ++n;
  }
  MPI_Bcast(&n, 1, MPI_INT, 0, lmp->world);
  return n;
}

const char fluid[] =
    "thermo_style custom step\nfix move all bd/pse 1.0 1.0 5 radius 0.5 fft estimate\n";

}    // namespace

TEST(CompanionsOnRanks, WhatConcernsAtomsOfOneRank)
{
  for (int ranks = 1; ranks <= bdh_test::all_ranks(); ++ranks)
    bdh_test::on_ranks(ranks, bdh_test::bonded_suspension, "", [&](LammpsSession &lmp) {
      lmp.script(
          "group one id 17\ngroup others subtract all one\ngroup nobody empty\n"
          "neigh_modify exclude group nobody all\nfix 2 one viscous 1.0\nfix 3 one setforce 0 "
          "0 0\n" +
          std::string(fluid) + "run 2\nrun 2");
      EXPECT_EQ(mentions(lmp, "fix 2 viscous acts on velocities"), 1) << ranks;
      EXPECT_EQ(mentions(lmp, "fix 3 setforce removes forces"), 1) << ranks;
      EXPECT_EQ(mentions(lmp, "WARNING: fix bd/pse"), 2) << ranks;
    });
}

// A change of one atom's velocity is detected, but not round-off from another order of summation.
TEST(CompanionsOnRanks, VelocitiesThatAreChanged)
{
  for (int ranks = 1; ranks <= bdh_test::all_ranks(); ++ranks)
    for (const bool changes : {false, true})
      bdh_test::on_ranks(ranks, bdh_test::bonded_suspension, "", [&](LammpsSession &lmp) {
        bdh_test::AtForces nudge(lmp, [&](const bdh_test::AtForces::Call &call) {
          for (int i = 0; i < call.atoms; ++i)
            if (changes && call.id[i] == 17) lmp->atom->v[i][1] += 1e-3;
        });
        lmp.script(fluid);
        // The weights belong to atom ids, and atoms may move to another rank within the step.
        lmp.script("neigh_modify every 1 delay 0 check no\nfix 2 all print 7 x\nrun 20");
        EXPECT_EQ(mentions(lmp, "changed velocities at step"), changes ? 1 : 0) << ranks;
        EXPECT_EQ(mentions(lmp, "WARNING: fix bd/pse"), changes ? 1 : 0) << ranks;
      });
}
