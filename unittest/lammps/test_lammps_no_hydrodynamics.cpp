// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Keyword hydrodynamics no: each particle moves with its self-mobility alone.  Expected values come
// from Stokes' law, and in two dimensions from a run with a single particle.

#include "lammps/lammps_mobility.h"
#include "lammps/lammps_scenes.h"

#include "neighbor.h"

#include <cmath>

using bdh_test::GivenForces;
using bdh_test::LammpsSession;

namespace {

const char *const box = R"(
units lj
atom_style atomic
atom_modify map array
boundary p p p
region box block -3 9 -6 10 -7 7
create_box 1 box
mass 1 1.0
timestep 0.01
neigh_modify every 1 delay 0 check yes
comm_modify cutoff 3.0
thermo_style custom step
)";
constexpr double viscosity = 1.3;

/// A fix with 16 cells along y.  The word is the fix's name for its radius.
std::string fix_line(const std::string &style, double T, const std::string &more = "")
{
  return "fix 1 all bd/" + style + " " + std::to_string(T) + " 1.3 77 " +
         (style == "fib" ? "grid 12 16 14" : "radius 1.25") + " fft estimate hydrodynamics no " +
         more + "\n";
}

double radius_of(LammpsSession &lmp) { return lmp.fix("1")->compute_vector(3); }

/// Two spheres in contact and a third one.
void create_three(LammpsSession &lmp)
{
  const double x[3][3] = {{0.0, 0.1, 0.2}, {2.0, 0.1, 0.2}, {5.0, 3.0, -4.0}};
  for (const double *at : x) lmp.create_atom(at);
}
const std::vector<double> three_forces = {1.0, 0.0, 0.0, -0.5, 2.0, 0.0, 0.3, -0.2, 0.7};

/// Positions after some steps with noise and forces.
std::vector<double> trajectory(const std::string &fix, int steps = 20)
{
  LammpsSession lmp;
  lmp.script(box);
  create_three(lmp);
  lmp.script(fix);
  const GivenForces push(lmp, three_forces);
  lmp.command("run " + std::to_string(steps));
  return lmp.unwrapped_positions();
}

void expect_close(const std::vector<double> &a, const std::vector<double> &b, double bound)
{
  ASSERT_EQ(a.size(), b.size());
  for (size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], bound) << k;
}

class NoHydrodynamics : public testing::TestWithParam<const char *> {};
INSTANTIATE_TEST_SUITE_P(Schemes, NoHydrodynamics,
                         testing::Values("fib", "fib scheme improved", "fib scheme trapezoidal",
                                         "fib scheme euler", "pse", "pse parts yes",
                                         "pse scheme split substeps 3"));

/// Turns "fib scheme euler" into the style and the remaining words.
std::string given(const std::string &words, double T)
{
  return fix_line(words.substr(0, 3), T, words.substr(3));
}

}    // namespace

TEST_P(NoHydrodynamics, VelocitiesAreThoseOfStokesLaw)
{
  LammpsSession lmp;
  lmp.script(box);
  create_three(lmp);
  lmp.script(given(GetParam(), 0.0));
  const GivenForces push(lmp, three_forces);
  lmp.command("run 1");
  const double mobility = 1.0 / (6.0 * M_PI * viscosity * radius_of(lmp));
  EXPECT_NEAR(radius_of(lmp), 1.25, 0.01);
  const std::vector<double> u = lmp.velocities();
  for (size_t k = 0; k < u.size(); ++k)
    EXPECT_NEAR(u[k], mobility * three_forces[k], 1e-12 * mobility) << k;
}

/// 4000 free particles for 25 steps: their mean squared displacement is 6 kT mu t.  Its relative
/// standard error is sqrt(2/12000) = 1.3 %; four of them have a confidence of 0.9999.
TEST_P(NoHydrodynamics, FreeParticlesDiffuse)
{
  LammpsSession lmp;
  lmp.script(box);
  lmp.command("create_atoms 1 random 4000 5 NULL");
  lmp.script(given(GetParam(), 0.7));
  const std::vector<double> before = lmp.unwrapped_positions();
  lmp.command("run 25");
  const std::vector<double> after = lmp.unwrapped_positions();
  double msd = 0.0, cross = 0.0;
  for (size_t k = 0; k < before.size(); ++k) msd += std::pow(after[k] - before[k], 2) / 4000;
  for (size_t k = 3; k < before.size(); ++k)
    cross += (after[k] - before[k]) * (after[k - 3] - before[k - 3]) / 4000;
  double expected = 6.0 * 0.7 / (6.0 * M_PI * viscosity * radius_of(lmp)) * 0.25;
  // The noise of a split step is the mean of two draws, of which the first run lacks one; of its 75
  // near steps all but the ends have the full variance.
  if (std::string(GetParam()).find("split") != std::string::npos) expected *= 1.0 - 0.5 / 75.0;
  EXPECT_NEAR(msd / expected, 1.0, 4.0 * std::sqrt(2.0 / 12000.0));
  EXPECT_NEAR(cross / expected, 0.0, 4.0 / std::sqrt(12000.0));
}

/// The noise is a function of seed, step and id, so both fixes draw the same.
TEST(NoHydrodynamicsRuns, BothFixesTakeTheSameSteps)
{
  LammpsSession lmp;
  lmp.script(box);
  create_three(lmp);
  lmp.script(fix_line("fib", 0.0) + "run 0\n");
  const std::string radius = std::to_string(radius_of(lmp));
  char line[200];
  std::snprintf(line, sizeof line, "fix 1 all bd/pse 0.9 1.3 77 radius %.17g hydrodynamics no\n",
                radius_of(lmp));
  expect_close(trajectory(fix_line("fib", 0.9)), trajectory(line), 1e-12);
  expect_close(trajectory(fix_line("fib", 0.9, "scheme euler")), trajectory(line), 1e-12);
}

/// One particle of a pair does not feel the other, but the same run with interactions does.
TEST(NoHydrodynamicsRuns, OnlyInteractionsAreMissing)
{
  for (const std::string style : {"fib", "pse"}) {
    const std::vector<double> without = trajectory(fix_line(style, 0.0), 1);
    std::string line = fix_line(style, 0.0);
    line.replace(line.find("hydrodynamics no"), 16, "hydrodynamics yes");
    const std::vector<double> with = trajectory(line, 1);
    EXPECT_NEAR(without[1], 0.1, 1e-15) << style;    // no force along y
    EXPECT_GT(std::fabs(with[1] - 0.1), 1e-5) << style;
  }
}

/// In two dimensions the mobility is that of one particle in the middle of the box.
TEST(NoHydrodynamicsRuns, TwoDimensionsTakeTheMobilityOfTheBox)
{
  const std::string flat = R"(
units lj
dimension 2
atom_style atomic
atom_modify map array
region box block 0 10 0 12 -0.5 0.5
create_box 1 box
create_atoms 1 single 5 6 0
mass 1 1.0
neigh_modify every 1 delay 0 check yes
comm_modify cutoff 3.0
)";
  for (const std::string walls : {"", " wall ylo noslip wall yhi noslip"}) {
    std::vector<double> u[2];
    for (const bool with : {false, true}) {
      LammpsSession lmp;
      lmp.command(walls.empty() ? "boundary p p p" : "boundary p f p");
      lmp.script(flat);
      lmp.command("fix 1 all bd/fib 0.0 1.3 77 grid 20 24 1 hydrodynamics " +
                  std::string(with ? "yes" : "no") + walls);
      const GivenForces push(lmp, {1.0, 0.0, 0.0});
      lmp.command("run 1");
      u[with] = lmp.velocities();
    }
    EXPECT_NEAR(u[0][0] / u[1][0], 1.0, 1e-8) << walls;
    EXPECT_EQ(u[0][1], 0.0) << walls;
  }
}

/// The flow due to a shear rate, or to a moving wall of a slit, is known without the fluid.
TEST(NoHydrodynamicsRuns, KnownFlowsAreKept)
{
  LammpsSession lmp;
  lmp.script(box);
  create_three(lmp);
  lmp.script(fix_line("fib", 0.0, "shear 2.0") + "run 1\n");
  EXPECT_NEAR(lmp.velocities()[0], 2.0 * 0.1, 1e-12);
  EXPECT_NEAR(lmp.velocities()[6], 2.0 * 3.0, 1e-12);
}

TEST(NoHydrodynamicsRuns, RestartsContinueTheTrajectory)
{
  for (const std::string &fix : {fix_line("fib", 0.8), fix_line("pse", 0.8),
                                 fix_line("pse", 0.8, "scheme split substeps 2")})
    expect_close(bdh_test::run_twice_through_restart(fix, true),
                 bdh_test::run_twice_through_restart(fix, false), 1e-11);
}

TEST(NoHydrodynamicsRuns, NothingUnnecessaryIsMade)
{
  LammpsSession lmp;
  lmp.script(box);
  create_three(lmp);
  lmp.script(fix_line("pse", 1.0, "check yes") + "run 1\n");
  EXPECT_EQ(lmp->neighbor->nrequest, 0);
  EXPECT_NE(lmp.log().find("no hydrodynamic interactions"), std::string::npos);
  EXPECT_NE(lmp.log().find("nothing to check"), std::string::npos);
  EXPECT_EQ(lmp.log().find("wave space"), std::string::npos);
}

TEST(NoHydrodynamicsRefuses, WhatNeedsTheFluid)
{
  const auto refusal = [](const std::string &setup, const std::string &fix) {
    LammpsSession lmp;
    lmp.script(setup);
    create_three(lmp);
    return lmp.error_of(fix + "\nrun 1");
  };
  const auto expect = [](const std::string &message, const std::string &part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  expect(refusal(box, "fix 1 all bd/pse 1.0 1.0 5 radius 1.0 hydrodynamics maybe"),
         "hydrodynamics = maybe, but must be yes or no");
  expect(refusal(box, fix_line("fib", 1.0, "force 0.1 0 0")), "leave out the keyword force");
  std::string closed = box;
  closed.replace(closed.find("boundary p p p"), 14, "boundary f f p");
  expect(refusal(closed, fix_line("fib", 1.0,
                                  "wall xlo noslip wall xhi noslip wall ylo noslip wall "
                                  "yhi noslip 0 0 1")),
         "keep the walls at rest");
  expect(refusal(closed, "fix 1 all bd/pse 1.0 1.0 5 radius 1.0 hydrodynamics no"),
         "the box must be periodic");
}
