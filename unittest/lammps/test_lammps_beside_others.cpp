// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Fixes bd/fib and bd/pse together with other fixes and computes: which fix the numbers in a
// restart file belong to, and quantities that are computed at steps without output.

#include "lammps/lammps_mobility.h"
#include "lammps/lammps_scenes.h"

#include "variable.h"

using bdh_test::LammpsSession;
using bdh_test::largest_difference;

// Fix spring/self also stores per-atom numbers in the restart file, before or after those of the
// last noise of the near part.
TEST(LammpsBesideOthers, RestartWithNumbersOfAnotherFix)
{
  const std::string other = "fix spring all spring/self 3.0\n",
                    own = "fix move all bd/pse 1.0 1.0 321 radius 0.5 xi 1.0 fft estimate "
                          "precision double scheme split substeps 3\n";
  for (const std::string &fixes : {other + own, own + other}) {
    const auto unbroken = bdh_test::run_twice_through_restart(fixes, false);
    EXPECT_LT(largest_difference(bdh_test::run_twice_through_restart(fixes, true), unbroken), 1e-10)
        << fixes;
  }
}

// A temperature that depends on the energy needs it at every step, whether or not LAMMPS prints it.
TEST(LammpsBesideOthers, TemperatureByAVariableOfACompute)
{
  for (const std::string rest : {"bd/fib v_T 1.0 5 grid 16 16 16 fft estimate",
                                 "bd/pse v_T 1.0 5 radius 0.5 fft estimate precision double"}) {
    const auto positions = [&](const std::string &thermo) {
      LammpsSession lmp;
      EXPECT_EQ(
          lmp.error_of(
              bdh_test::lattice_suspension +
              ("compute energy all pe\nvariable T equal 0.5+0.001*c_energy^2\nthermo " + thermo) +
              "\nfix move all " + rest + "\nrun 10"),
          "")
          << rest << ", thermo " << thermo;
      return lmp.unwrapped_positions();
    };
    EXPECT_EQ(largest_difference(positions("100"), positions("1")), 0.0) << rest;
  }
}

// The temperature of a step is the one at its beginning.  The output makes LAMMPS compute the
// energy at the end of the step.
TEST(LammpsBesideOthers, TemperatureFollowsTheVariable)
{
  for (const std::string rest : {"bd/fib v_T 1.0 5 grid 16 16 16 fft estimate",
                                 "bd/pse v_T 1.0 5 radius 0.5 fft estimate"}) {
    LammpsSession lmp;
    lmp.script(bdh_test::lattice_suspension);
    lmp.script("compute energy all pe\nvariable T equal 0.5+0.001*c_energy^2\nthermo "
               "1\nthermo_style custom step c_energy\nfix move all " +
               rest + "\nrun 4");
    LAMMPS_NS::Variable &variables = *lmp->input->variable;
    for (int step = 0; step < 3; ++step) {
      const double T = variables.compute_equal(variables.find("T"));
      lmp.command("run 1 pre no post no");
      EXPECT_EQ(lmp.fix("move")->compute_vector(5), T) << rest;
    }
  }
}

// The noise continues where the last run ended.  Round-off grows through 12 steps, since a run
// begins with new lists.
TEST(LammpsBesideOthers, TwoRunsAreOne)
{
  for (const std::string rest : {"bd/fib 1.0 1.0 5 grid 16 16 16 fft estimate",
                                 "bd/fib 1.0 1.0 5 grid 16 16 16 fft estimate scheme improved",
                                 "bd/pse 1.0 1.0 5 radius 0.5 fft estimate precision double",
                                 "bd/pse 1.0 1.0 5 radius 0.5 xi 1.0 fft estimate precision double "
                                 "scheme split substeps 2"}) {
    const auto positions = [&](const std::string &runs) {
      LammpsSession lmp;
      lmp.script(bdh_test::lattice_suspension + ("fix move all " + rest) + "\n" + runs);
      return lmp.unwrapped_positions();
    };
    EXPECT_LT(largest_difference(positions("run 6\nrun 6"), positions("run 12")), 1e-10) << rest;
  }
}

// Two seeds give unrelated noise in both parts of scheme split.  The correlation of 192 independent
// numbers has a standard deviation of 0.07, and less than 0.13 for particles in one fluid.  The
// bound is 5 of these.
TEST(LammpsBesideOthers, PartsOfTheNoiseHaveTheSeed)
{
  // A large xi puts nearly all of the mobility into wave space, a small one into real space.
  for (const std::string xi : {"3.0", "0.3"}) {
    std::vector<std::vector<double>> v;
    for (const std::string seed : {"1", "2"}) {
      LammpsSession lmp;
      lmp.script(bdh_test::lattice_suspension);
      lmp.script("pair_style none\nfix move all bd/pse 1.0 1.0 " + seed + " radius 0.5 xi " + xi +
                 " tolerance 0.01 fft estimate scheme split substeps 1\nrun 1");
      v.push_back(lmp.velocities());
    }
    double product = 0.0;
    for (size_t i = 0; i < v[0].size(); ++i) product += v[0][i] * v[1][i];
    EXPECT_LT(std::fabs(product) / (bdh_test::length_of(v[0]) * bdh_test::length_of(v[1])), 0.65)
        << xi;
  }
}

// If the second fix has the same cutoff as the first, LAMMPS makes its list a copy of the first
// one's.
TEST(LammpsBesideOthers, TwoFixesWithListsOfOneCutoff)
{
  const std::string rest = " bd/pse 0.0 1.0 321 radius 0.5 xi 1.0 fft estimate precision double\n";
  const auto positions = [&](const std::string &fixes) {
    LammpsSession lmp;
    EXPECT_EQ(lmp.error_of(bdh_test::lattice_suspension +
                           ("group a id 1:32\ngroup b id 33:64\n" + fixes) + "run 3\nrun 2"),
              "");
    return lmp.unwrapped_positions();
  };
  const auto both = positions("fix one a" + rest +
                              "fix two b bd/pse 0.0 1.0 5 radius 0.5 xi 1.0 "
                              "fft estimate precision double\n");
  const auto swapped = positions("fix two b bd/pse 0.0 1.0 5 radius 0.5 xi 1.0 fft estimate "
                                 "precision double\nfix one a" +
                                 rest);
  EXPECT_LT(largest_difference(both, swapped), 1e-10);
}
