// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// LAMMPS' command temper exchanges temperatures between partitions.

#include "lammps/lammps_ranks.h"

#include "command.h"
#include "universe.h"

using bdh_test::LammpsSession;

namespace {

/// Two partitions of two ranks at temperatures 1 and 1.2; their pair energies differ little, so
/// that they swap often.
const char replicas[] = R"(
variable T world 1.0 1.2
variable s world 11 12
units lj
atom_style atomic
atom_modify map array
region box block 0 8 0 8 0 8
create_box 1 box
lattice sc 0.125
create_atoms 1 box
mass 1 1
pair_style lj/cut 1.122462048309373
pair_coeff 1 1 1.0 1.0
neighbor 0.4 bin
neigh_modify every 1 delay 0 check yes
timestep 0.001
)";

}    // namespace

TEST(LammpsTemper, ExchangesTemperatures)
{
  for (const std::string style : {"temp/bd/fib ${T} 1 ${s} grid 12 12 12 fft estimate",
                                  "temp/bd/pse ${T} 1 ${s} radius 0.5 fft estimate"}) {
    LammpsSession lmp(MPI_COMM_WORLD, "-partition 2x2 -in /dev/null -plog none");
    if (!lmp->input->command_map->count("temper")) GTEST_SKIP() << "needs package REPLICA";
    lmp.script(replicas);
    lmp.script("fix move all " + style);
    int swaps = 0;
    double last = lmp->universe->iworld ? 1.2 : 1.0;
    for (int k = 0; k < 8; ++k) {
      lmp.command("temper 10 10 ${T} move 0 " + std::to_string(100 + k) + " " +
                  (last == 1.0 ? "0" : "1"));
      const double now = *static_cast<double *>([&] {
        int dim;
        return lmp.fix("move")->extract("t_target", dim);
      }());
      EXPECT_TRUE(now == 1.0 || now == 1.2) << now;
      if (now != last) ++swaps;
      last = now;
    }
    EXPECT_GT(swaps, 0);
    // Both partitions are never at the same temperature.
    double mine = last, sum = 0.0;
    MPI_Allreduce(&mine, &sum, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    EXPECT_NEAR(sum, 4.4, 1e-12);
  }
}
