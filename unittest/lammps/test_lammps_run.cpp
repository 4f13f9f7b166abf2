// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/fib from the point of view of a LAMMPS user: restarts, groups, units, variables, output,
// midpoint forces, equilibrium.

#include "lammps/lammps_scenes.h"

#include "force.h"
#include "update.h"

#include <cmath>
#include <gtest/gtest.h>

using bdh_test::LammpsSession;
using bdh_test::run_twice_through_restart;

namespace {

/// Positions after a few steps with a neighbor skin.  With a small one the lists are rebuilt at
/// midpoints.
std::vector<double> positions_with_skin(const std::string &skin, LammpsSession &lmp)
{
  lmp.script(bdh_test::lattice_suspension);
  lmp.command("neighbor " + skin + " bin");
  lmp.command("fix move all bd/fib 1.0 0.2 8 grid 16 16 16 scheme improved");
  lmp.command("run 30");
  return lmp.unwrapped_positions();
}

}    // namespace

// Exact apart from the order of summation in the forces, 1e-16, which collisions amplify over 25
// steps.
TEST(LammpsRun, RestartContinuesTheTrajectory)
{
  for (const std::string scheme : {"midpoint", "improved"}) {
    const std::string fix = "fix move all bd/fib 1.0 1.0 321 grid 16 16 16 scheme " + scheme;
    EXPECT_LT(bdh_test::largest_difference(run_twice_through_restart(fix, true),
                                           run_twice_through_restart(fix, false)),
              1e-10)
        << scheme;
  }
}

TEST(LammpsRun, MidpointForcesDoNotDependOnTheNeighborLists)
{
  LammpsSession a, b;
  const auto few = positions_with_skin("1.0", a), many = positions_with_skin("0.02", b);
  EXPECT_LT(bdh_test::largest_difference(few, many), 1e-9);
}

// Another integrator, here for atom 2, must find the forces from the beginning of the step,
// whatever its position in the list of fixes.
TEST(LammpsRun, ImprovedLeavesTheForcesOfOthersAlone)
{
  std::vector<double> x[2];
  for (const bool before : {false, true}) {
    LammpsSession lmp;
    lmp.script("units lj\natom_style atomic\natom_modify map array\nregion box block 0 8 0 8 0 "
               "8\ncreate_box 1 box\n"
               "mass 1 1.0\ncreate_atoms 1 single 4.0 4 4\ncreate_atoms 1 single 5.0 4 "
               "4\npair_style lj/cut 2.5\n"
               "pair_coeff 1 1 1.0 1.0\nneigh_modify every 1 delay 0 check yes\ngroup a id "
               "1\ngroup b id 2\ntimestep 0.01");
    const std::string moving = "fix move a bd/fib 0.0 0.1 5 grid 16 16 16 scheme improved\n",
                      other = "fix other b nve\n";
    lmp.script(before ? other + moving : moving + other);
    lmp.command("run 1");
    x[before] = lmp.unwrapped_positions();
  }
  for (const auto &positions : x)
    EXPECT_NEAR(positions[3], 5.0 + 0.5 * 24.0 * 0.01 * 0.01, 1e-12);    // F(r = 1) = 24
}

TEST(LammpsRun, WarnsOfCellsRadiusAndCompanions)
{
  LammpsSession cells, radius, companion;
  cells.script(bdh_test::lattice_suspension);
  cells.script("fix move all bd/fib 1.0 1.0 5 grid 16 16 15\nrun 0");
  EXPECT_NE(cells.log().find("the cells are not cubic: spacings 0.5 0.5 0.533333 differ by 6.7 %"),
            std::string::npos);
  radius.script(bdh_test::lattice_suspension);
  radius.script(
      "fix move all bd/fib 1.0 1.0 5 radius 0.9\nrun 0");    // 11.15 cells become 12, radius 0.836
  EXPECT_NE(radius.log().find("radius 0.9 was requested, but the nearest that a grid of this box "
                              "gives is 0.836267 (-7.1 %)"),
            std::string::npos);
  companion.script(bdh_test::lattice_suspension);
  companion.script("fix drag all viscous 1.0\nfix bath all langevin 1.0 1.0 1.0 9\n"
                   "fix move all bd/fib 1.0 1.0 5 grid 16 16 16 scheme improved\nrun 0");
  EXPECT_NE(companion.log().find("fix bath langevin is meant to act once a step"),
            std::string::npos);
  EXPECT_NE(companion.log().find("fix drag viscous acts on velocities"), std::string::npos);
}

TEST(LammpsRun, WarnsWhenStepsAreTakenTwice)
{
  LammpsSession lmp;
  lmp.script(bdh_test::lattice_suspension);
  lmp.script("fix move all bd/fib 1.0 1.0 5 grid 16 16 16\nrun 2\nrun 2");
  EXPECT_EQ(lmp.log().find("the same noise is drawn again"), std::string::npos);
  lmp.script("reset_timestep 0\nrun 2");
  EXPECT_NE(lmp.log().find("step 1 was taken before"), std::string::npos);
  LammpsSession last;    // the last step alone is taken again
  last.script(bdh_test::lattice_suspension);
  last.script("fix move all bd/fib 1.0 1.0 5 grid 16 16 16\nrun 2\nreset_timestep 1\nrun 1");
  EXPECT_NE(last.log().find("step 2 was taken before"), std::string::npos);
}

TEST(LammpsRun, EstimatedPlansRepeatBitForBit)
{
  std::vector<double> x[2];
  for (auto &result : x) {
    LammpsSession lmp;
    lmp.script(bdh_test::lattice_suspension);
    lmp.script("fix move all bd/fib 1.0 1.0 5 grid 18 18 18 fft estimate\nrun 20");
    result = lmp.unwrapped_positions();
  }
  EXPECT_EQ(bdh_test::largest_difference(x[0], x[1]), 0.0);
}

TEST(LammpsRun, OnlyTheGroupMovesAndPushes)
{
  LammpsSession lmp;
  lmp.script(bdh_test::lattice_suspension);
  lmp.script("group moving id 1:10\nfix move moving bd/fib 0.0 1.0 5 grid 16 16 16\nfix push all "
             "addforce 1.0 0 0");
  const auto before = lmp.unwrapped_positions();
  lmp.command("run 3");
  const auto after = lmp.unwrapped_positions();
  for (size_t i = 0; i < after.size(); ++i) {
    if (i >= 30) {
      EXPECT_EQ(after[i], before[i]);
    } else if (i % 3 == 0) {
      EXPECT_GT(after[i], before[i]);
    }
  }
}

// The same suspension in every units style moves by the same number of diameters.  The scales are
// the length l, the energy e and the time t in the units of the style; forces scale with e/l and
// the viscosity with e t/l^3, using LAMMPS' constants.
TEST(LammpsRun, UnitsStyles)
{
  struct Style {
    const char *name;
    double length, temperature, time;
  };
  const Style styles[] = {{"lj", 1.0, 1.0, 1.0},       {"real", 10.0, 300.0, 1e5},
                          {"metal", 10.0, 300.0, 1e2}, {"si", 1e-6, 300.0, 1e-3},
                          {"cgs", 1e-4, 300.0, 1e-3},  {"electron", 20.0, 300.0, 1e5},
                          {"micro", 1.0, 300.0, 1e2},  {"nano", 10.0, 300.0, 1e1}};
  std::vector<double> reference;
  for (const Style &s : styles) {
    LammpsSession lmp;
    lmp.command(std::string("units ") + s.name);
    lmp.script("atom_style atomic\nboundary p p p");
    const double L = 12.0 * s.length, kT = lmp->force->boltz * s.temperature;
    // The scaled system has kT = 1, l = 1, t = 1 and viscosity 0.5, which is 0.5 kT t/l^3 in energy
    // units.  In LAMMPS, force = viscosity * velocity * length * vxmu2f and force = energy/length.
    const double viscosity =
        0.5 * kT * s.time / (s.length * s.length * s.length) / lmp->force->vxmu2f;
    char line[300];
    std::snprintf(line, sizeof line, "region box block 0 %.17g 0 %.17g 0 %.17g units box", L, L, L);
    lmp.commands({line, "create_box 1 box", "mass 1 1.0"});
    for (int i = 0; i < 8; ++i) {
      const double x[3] = {s.length * (1.3 * i + 0.1), s.length * (0.7 * i + 2.3),
                           s.length * (11.0 - 1.1 * i)};
      lmp.create_atom(x);
    }
    std::snprintf(line, sizeof line, "fix move all bd/fib %.17g %.17g 5 grid 12 12 12",
                  s.temperature, viscosity);
    lmp.command(line);
    std::snprintf(line, sizeof line, "fix push all addforce %.17g 0 0", 2.0 * kT / s.length);
    lmp.command(line);
    std::snprintf(line, sizeof line, "timestep %.17g", 0.01 * s.time);
    lmp.commands({line, "run 5"});
    auto x = lmp.unwrapped_positions();
    for (double &c : x) c /= s.length;
    if (reference.empty()) reference = x;
    // LAMMPS' constants are consistent to some 1e-7 (real, electron); the displacement is 1e-1.
    EXPECT_LT(bdh_test::largest_difference(x, reference), 1e-6) << s.name;
  }
}

TEST(LammpsRun, TemperatureAndViscosityAsVariables)
{
  std::vector<double> x[2];
  for (const bool variable : {false, true}) {
    LammpsSession lmp;
    lmp.script(bdh_test::lattice_suspension);
    lmp.script("variable T equal 0.5+0.01*step\nvariable eta equal 1.0");
    if (variable) {
      lmp.script("fix move all bd/fib v_T v_eta 5 grid 16 16 16\nrun 3");
    } else {
      for (int step = 1; step <= 3; ++step) {
        char line[200];
        std::snprintf(line, sizeof line,
                      "fix move all bd/fib %.17g 1.0 5 grid 16 16 16\nrun 1\nunfix move",
                      0.5 + 0.01 * step);
        lmp.script(line);
      }
    }
    x[variable] = lmp.unwrapped_positions();
  }
  EXPECT_LT(bdh_test::largest_difference(x[0], x[1]), 1e-12);
}

TEST(LammpsRun, ExtractReachesTemperatureAndViscosity)
{
  LammpsSession a, b;
  a.script(bdh_test::lattice_suspension);
  b.script(bdh_test::lattice_suspension);
  a.script("fix move all bd/fib 1.0 1.0 5 grid 16 16 16");
  b.script("fix move all bd/fib 0.3 4.0 5 grid 16 16 16");
  int dim = -1;
  *static_cast<double *>(a.fix("move")->extract("temperature", dim)) = 0.3;
  EXPECT_EQ(dim, 0);
  *static_cast<double *>(a.fix("move")->extract("viscosity", dim)) = 4.0;
  EXPECT_EQ(a.fix("move")->extract("nonsense", dim), nullptr);
  a.command("run 5");
  b.command("run 5");
  EXPECT_EQ(bdh_test::largest_difference(a.unwrapped_positions(), b.unwrapped_positions()), 0.0);
}

TEST(LammpsRun, OutputAndPlan)
{
  LammpsSession lmp;
  lmp.script(bdh_test::lattice_suspension);
  lmp.script("fix move all bd/fib 1.0 2.0 5 radius 0.63\nthermo_style custom step f_move f_move[4] "
             "f_move[8]\nrun 4");
  LAMMPS_NS::Fix *fix = lmp.fix("move");
  const auto v = lmp.velocities();
  double longest = 0.0;
  for (size_t i = 0; i < v.size(); i += 3)
    longest = std::max(longest, std::sqrt(v[i] * v[i] + v[i + 1] * v[i + 1] + v[i + 2] * v[i + 2]));
  const double h = fix->compute_vector(4);
  EXPECT_NEAR(fix->compute_scalar(), longest * lmp->update->dt / h, 1e-12);
  EXPECT_EQ(h, 0.5);    // 8/(0.63/1.2544) = 15.93 cells, rounded to 16
  EXPECT_NEAR(fix->compute_vector(3), 0.6272, 1e-12);
  EXPECT_EQ(fix->compute_vector(5), 1.0);
  EXPECT_EQ(fix->compute_vector(6), 2.0);
  const std::string log = lmp.log();
  for (const char *words :
       {"fix bd/fib: plan", "16 x 16 x 16 cells", "peskin4: hydrodynamic radius 0.6272",
        "midpoint: 1 solve", "exact derivative of the kernel", "MB for the grid"})
    EXPECT_NE(log.find(words), std::string::npos) << words;
  EXPECT_GT(fix->memory_usage(), 3 * 8 * 16 * 16 * 18);
}

TEST(LammpsRun, WarnsOfLongMovesAndOfNeighborDelay)
{
  LammpsSession lmp;
  lmp.script(bdh_test::lattice_suspension);
  lmp.script("pair_style zero 1.0\npair_coeff * *\nneigh_modify delay 10\nfix move all bd/fib 1.0 "
             "1.0 5 grid 16 16 16\n"
             "timestep 1.0\nrun 12");
  const std::string log = lmp.log();
  EXPECT_NE(log.find("more than the grid spacing"), std::string::npos);
  EXPECT_NE(log.find("use neigh_modify every 1 delay 0 check yes"), std::string::npos);
  EXPECT_NE(log.find("dangerous neighbor list build before step 11"), std::string::npos);
  EXPECT_GT(lmp.fix("move")->compute_vector(7), 0.0);
}

// 64 particles in harmonic traps (fix spring/self) have <(x - x0)^2> = kT/k for any mobility.  The
// slowest mode relaxes in tau = 1/(k mu) <= 0.15 and samples are 0.24 apart, so 192 x 1200
// coordinates count as at least 0.75 of that many, with a relative standard error of 0.34 %.  The
// bound is 5 of these (false-alarm rate 6e-7) plus 0.3 % for the time step.  For dt/tau < 0.2 of
// the fastest mode, the bias of the improved scheme (its exact discrete expectation) is smaller.
TEST(LammpsRun, HarmonicTrapsKeepTheBoltzmannDistribution)
{
  LammpsSession lmp;
  lmp.script(bdh_test::lattice_suspension);
  lmp.script("pair_style none\nfix trap all spring/self 20.0\ntimestep 0.01");
  lmp.script("fix move all bd/fib 1.0 0.2 6 grid 16 16 16 scheme improved\nrun 200");
  const auto home = [] {
    std::vector<double> x;
    LammpsSession start;
    start.script(bdh_test::lattice_suspension);
    return start.unwrapped_positions();
  }();
  double sum = 0.0;
  long count = 0;
  for (int sample = 0; sample < 1200; ++sample) {
    lmp.command("run 24 pre no post no");
    const auto x = lmp.unwrapped_positions();
    for (size_t i = 0; i < x.size(); ++i) sum += (x[i] - home[i]) * (x[i] - home[i]);
    count += x.size();
  }
  const double mean = sum / count / (1.0 / 20.0);
  EXPECT_NEAR(mean, 1.0, 5.0 * std::sqrt(2.0 / (0.75 * count)) + 0.003);
}
