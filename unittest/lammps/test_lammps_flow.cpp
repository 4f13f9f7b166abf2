// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/fib: flows imposed by shear, by moving walls and by a body force.

#include "lammps/lammps_session.h"

#include <gtest/gtest.h>

using bdh_test::LammpsSession;
using bdh_test::text;

namespace {

/// A cube of edge 8 about the origin, with its faces on planes of a 16^3 grid.
std::string cube(const std::string &boundary)
{
  return "units lj\natom_style atomic\natom_modify map array\nboundary " + boundary + R"(
neigh_modify every 1 delay 0 check yes
comm_modify cutoff 2.0
region box block -4 4 -4 4 -4 4
create_box 1 box
mass 1 1.0
)";
}

const std::string cold = "fix move all bd/fib 0.0 1.0 7 grid 16 16 16 kernel bkp6 fft estimate ";

/// Velocity in one step of dt = 0.2 of an atom at `start` under a force.
std::vector<double> velocity(const std::string &boundary, const std::string &start,
                             const std::string &force, const std::string &keywords)
{
  LammpsSession lmp;
  lmp.script(cube(boundary) + "create_atoms 1 single " + start + "\nfix push all addforce " +
             force + "\n" + cold + keywords + "\ntimestep 0.2\nrun 1");
  return lmp.velocities();
}

}    // namespace

// u = rate y, where y continues to grow when the atom re-enters the box on the other side.
TEST(LammpsFlow, ShearGoesOnBeyondTheBox)
{
  const double rate = 0.5;
  LammpsSession lmp;
  lmp.script(cube("p p p") + "create_atoms 1 single 1.1 3.7 0.3\nfix push all addforce 0 30 0\n" +
             cold + "shear 0.5\ntimestep 0.2\nrun 3\nunfix push");
  for (int step = 0; step < 3; ++step) {
    const double y = lmp.unwrapped_positions()[1];
    EXPECT_GT(y, 4.5);
    lmp.command("run 1");
    const auto v = lmp.velocities();
    EXPECT_NEAR(v[0], rate * y, 1e-12) << step;
    EXPECT_NEAR(v[1], 0.0, 1e-12) << step;
    EXPECT_NEAR(v[2], 0.0, 1e-12) << step;
  }
  EXPECT_LT(lmp->atom->x[0][1], 4.0);
}

// Periods that an atom has crossed along the other axes do not count.
TEST(LammpsFlow, ShearCountsPeriodsOfOneAxis)
{
  LammpsSession lmp;
  lmp.script(cube("p p p") +
             "create_atoms 1 single 1.1 1.5 0.3\ncreate_atoms 1 single -2.1 -1.5 0.3\nset atom 1 "
             "image 3 -2 5\n" +
             cold + "shear 0.5 scheme euler\ntimestep 0.02\nrun 1");
  const auto v = lmp.velocities();
  EXPECT_NEAR(v[0], 0.5 * (1.5 - 2.0 * 8.0), 1e-12);
  EXPECT_NEAR(v[3], 0.5 * -1.5, 1e-12);
}

// A force across the flow takes the atom to positions with a different flow velocity within the
// step. The default scheme, which is second order, takes this into account even at temperature 0.
// Where mirror symmetry leaves only the flow along x, the velocity at the midpoint is known.
TEST(LammpsFlow, MidpointOfTheFlowAtTemperatureZero)
{
  const double half = 0.1;
  const auto shear = velocity("p p p", "0 0 0", "0 2 0", "shear 0.5");
  const double rise = velocity("p p p", "0 0 0", "0 2 0", "scheme euler")[1];
  EXPECT_GT(half * rise, 0.01);
  EXPECT_NEAR(shear[0], 0.5 * half * rise, 1e-13);

  // The walls leave the fluid at rest at the initial position of the atom.
  const std::string rest = "wall zlo noslip wall zhi noslip ";
  const double lift = velocity("p p f", "0 0 -1", "0 0 4", rest + "scheme euler")[2];
  EXPECT_GT(half * lift, 0.01);
  const auto couette =
      velocity("p p f", "0 0 -1", "0 0 4", "wall zlo noslip -0.75 0 0 wall zhi noslip 1.25 0 0");
  EXPECT_NEAR(couette[0], 0.25 * half * lift, 1e-13);

  const std::string driven = "force 0.3 0 0 " + rest;
  const auto by_default = velocity("p p f", "0 0 -1", "0 0 4", driven),
             asked = velocity("p p f", "0 0 -1", "0 0 4", driven + "scheme midpoint"),
             euler = velocity("p p f", "0 0 -1", "0 0 4", driven + "scheme euler");
  EXPECT_LT(bdh_test::largest_difference(by_default, asked), 1e-13);
  EXPECT_NEAR(by_default[0] - euler[0], 0.3 * half * lift,
              0.2 * 0.3 * half * lift);    // b/eta z times the distance
}

// In units real, b is in kcal/mol/Angstrom^4 and the viscosity in poise.  The test uses 4184 J per
// kcal and Avogadro's number; LAMMPS' own constants are accurate to 1e-6.
TEST(LammpsFlow, BodyForceAndWallForcesInUnitsReal)
{
  const double force = 4184.0 * 1e-7,
               viscosity = 6.02214076;    // 1 kcal/mol/A and 1 P in terms of g/mol, A and fs
  const double b = 2e-6, eta = 0.009, H = 40.0, h = 2.0, K = 59.0 / 60.0 - std::sqrt(29.0) / 20.0;
  const std::string slit = R"(
units real
atom_style atomic
atom_modify map array
boundary p p f
neigh_modify every 1 delay 0 check yes
comm_modify cutoff 10.0
region box block 0 20 0 24 -10 30
create_box 1 box
create_atoms 1 single 3 5 2
create_atoms 1 single 13 5 11.3
mass 1 1.0
timestep 10.0
)",
                    grid =
                        "fix move all bd/fib 0.0 0.009 7 grid 10 12 20 kernel bkp6 fft estimate ";
  const double area = 480.0, volume = area * H;
  LammpsSession driven, dragged;
  const auto wall = [](LammpsSession &lmp, int side, int component) {
    return lmp.fix("move")->compute_vector(9 + 12 + 3 * side + component);
  };
  driven.script(slit + grid + "force 2e-6 0 0 wall zlo noslip wall zhi noslip\nrun 1");
  const auto v = driven.velocities();
  const double z[2] = {12.0, 21.3};
  for (size_t i = 0; i < 2; ++i) {
    const double expected =
        b * force / (2.0 * eta * viscosity) * (z[i] * (H - z[i]) + h * h * (0.25 - K));
    EXPECT_NEAR(v[3 * i], expected, 1e-5 * expected) << i;
  }
  EXPECT_NEAR(wall(driven, 0, 0) + wall(driven, 1, 0), b * volume, 1e-9 * b * volume);

  dragged.script(slit + grid + "wall zlo noslip wall zhi noslip 0 2e-3 0\nrun 1");
  const double friction = eta * viscosity / force * 2e-3 / H * area;
  EXPECT_NEAR(dragged.velocities()[1], 2e-3 * z[0] / H, 1e-15);
  EXPECT_NEAR(wall(dragged, 0, 1), friction, 1e-5 * friction);
  EXPECT_NEAR(wall(dragged, 1, 1), -friction, 1e-5 * friction);
}

// Without the keyword drift, scheme euler has no drift, and the other schemes have the exact one.
TEST(LammpsFlow, DriftThatComesWithAScheme)
{
  const auto step = [](const std::string &keywords, std::string *log = nullptr) {
    LammpsSession lmp;
    lmp.script(
        cube("p p f") +
        "create_atoms 1 random 50 5 box\nfix move all bd/fib 1.0 1.0 7 grid 16 16 16 fft estimate "
        "wall zlo noslip wall zhi slip " +
        keywords + "\ntimestep 1e-3\nrun 1");
    if (log) *log = lmp.log();
    return lmp.velocities();
  };
  for (const std::string scheme : {"euler", "midpoint", "trapezoidal", "improved"}) {
    const std::string words = "scheme " + scheme;
    std::string log;
    const auto by_default = step(words, &log), without = step(words + " drift no"),
               exact = step(words + " drift exact");
    const bool none = scheme == "euler";
    EXPECT_GT(bdh_test::largest_difference(without, exact), 1e-3) << scheme;
    EXPECT_LT(bdh_test::largest_difference(by_default, none ? without : exact), 1e-12) << scheme;
    EXPECT_EQ(log.find("off: scheme euler leaves the thermal drift out") != std::string::npos, none)
        << log;
  }
}
