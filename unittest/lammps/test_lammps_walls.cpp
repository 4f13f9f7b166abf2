// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/fib between walls in LAMMPS: reference mobilities, flows, wall forces, particles at walls.

#include "lammps/lammps_fib_reference.h"
#include "lammps/lammps_scenes.h"

#include <cmath>
#include <gtest/gtest.h>

using bdh_test::LammpsSession;

namespace {

void expect_reference_velocities(const std::string &file, std::size_t expected_cases,
                                 const std::string &keywords)
{
  const nlohmann::json all = bdh_test::json_reference(file);
  EXPECT_EQ(all["cases"].size(), expected_cases);
  for (const auto &c : all["cases"])
    EXPECT_LT(bdh_test::deviation(c, bdh_test::velocities_of(c, 1e-3, keywords)), 1e-10) << c["id"];
}

/// A slit 8 x 6 x 10 with three atoms.
std::string slit(const std::string &fix)
{
  return R"(
units lj
atom_style atomic
atom_modify map array
boundary p p f
neigh_modify every 1 delay 0 check yes
region box block 0 8 0 6 0 10
create_box 1 box
create_atoms 1 single 1 2 3
create_atoms 1 single 5 2 5
create_atoms 1 single 3 4 8.5
mass 1 1.0
timestep 0.01
)" + fix +
         "\n";
}

/// 200 atoms without forces, with steps so long that one of them crosses a wall now and then.
std::string long_steps(const std::string &keywords)
{
  return R"(
units lj
atom_style atomic
atom_modify map array
boundary p p f
neigh_modify every 1 delay 0 check yes
comm_modify cutoff 2.0
region box block 0 8 0 8 0 8
create_box 1 box
create_atoms 1 random 200 5 box
mass 1 1.0
timestep 2.0
fix move all bd/fib 1.0 1.0 7 grid 8 8 8 kernel roma3 wall zlo noslip wall zhi slip )" +
         keywords + "\n";
}

double lowest_z(LammpsSession &lmp)
{
  const std::vector<double> x = lmp.unwrapped_positions();
  double low = 1e300;
  for (size_t i = 2; i < x.size(); i += 3) low = std::min(low, x[i]);
  return low;
}

}    // namespace

TEST(LammpsWalls, OneStepAtTemperatureZeroReadsOutMFInSlits)
{
  expect_reference_velocities("fib_slit.json", 12, "");
}

TEST(LammpsWalls, OneStepAtTemperatureZeroReadsOutMFInBoxes)
{
  expect_reference_velocities("fib_box.json", 8, "tolerance 1e-12");
}

// Between moving walls, u is linear to round-off at every height, and the shear stress acts on the
// walls.
TEST(LammpsWalls, MovingWallsGiveCouetteFlow)
{
  LammpsSession lmp;
  lmp.script(slit("fix 1 all bd/fib 0.0 2.0 5 grid 16 12 20 wall zlo noslip -0.5 0.25 0 wall zhi "
                  "noslip 1.5 0 0\nrun 1"));
  const std::vector<double> v = lmp.velocities();
  const double z[3] = {3.0, 5.0, 8.5};
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(v[3 * i], -0.5 + 0.2 * z[i], 1e-14);
    EXPECT_NEAR(v[3 * i + 1], 0.25 - 0.025 * z[i], 1e-14);
    EXPECT_NEAR(v[3 * i + 2], 0.0, 1e-14);
  }
  // f_1[10 + 6 axis + 3 side + component], counted from 1: eta dv/dz times the area, 48
  const auto wall = [&](int axis, int side, int component) {
    return lmp.fix("1")->compute_vector(9 + 6 * axis + 3 * side + component);
  };
  EXPECT_NEAR(wall(2, 0, 0), 2.0 * 0.2 * 48.0, 1e-12);
  EXPECT_NEAR(wall(2, 1, 0), -2.0 * 0.2 * 48.0, 1e-12);
  EXPECT_NEAR(wall(2, 0, 1), -2.0 * 0.025 * 48.0, 1e-12);
  EXPECT_NEAR(wall(0, 0, 0), 0.0, 1e-12);
}

// The walls of a duct that move together carry the fluid; one that moves alone experiences
// friction.
TEST(LammpsWalls, WallsOfADuctMayMove)
{
  const std::string duct =
      "change_box all boundary p f f\nfix 1 all bd/fib 0.0 2.0 5 grid 16 12 20 ";
  const std::string side = " noslip 0.7 0 0 ";
  LammpsSession together, lid;
  together.script(slit(duct + "wall ylo" + side + "wall yhi" + side + "wall zlo" + side +
                       "wall zhi" + side + "\nrun 1"));
  const std::vector<double> v = together.velocities();
  for (size_t i = 0; i < v.size(); ++i) EXPECT_NEAR(v[i], i % 3 == 0 ? 0.7 : 0.0, 1e-13);
  lid.script(
      slit(duct + "wall ylo noslip wall yhi noslip wall zlo noslip wall zhi" + side + "\nrun 1"));
  const auto wall = [&](int axis, int which) {
    return lid.fix("1")->compute_vector(9 + 6 * axis + 3 * which);
  };
  EXPECT_LT(wall(2, 1), -1.0);
  EXPECT_NEAR(wall(1, 0) + wall(1, 1) + wall(2, 0) + wall(2, 1), 0.0,
              1e-10 * std::fabs(wall(2, 1)));
}

// If one wall has no friction, the fluid moves with the other one.
TEST(LammpsWalls, OneMovingWallCarriesAllFluid)
{
  LammpsSession lmp;
  lmp.script(slit(
      "fix 1 all bd/fib 0.0 2.0 5 grid 16 12 20 wall zlo slip wall zhi noslip 1.5 0.5 0\nrun 1"));
  const std::vector<double> v = lmp.velocities();
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(v[3 * i], 1.5, 1e-14);
    EXPECT_NEAR(v[3 * i + 1], 0.5, 1e-14);
  }
}

// u = b/(2 eta) (z (H - z) + h^2/4 - K h^2), the discrete parabola with the second moment K of
// bkp6.
TEST(LammpsWalls, BodyForceGivesPoiseuilleFlow)
{
  const double K = 59.0 / 60.0 - std::sqrt(29.0) / 20.0, h = 0.5, H = 10.0;
  LammpsSession lmp;
  lmp.script(slit("fix 1 all bd/fib 0.0 2.0 5 grid 16 12 20 kernel bkp6 force 0.3 -0.1 0 wall zlo "
                  "noslip wall zhi noslip\nrun 1"));
  const std::vector<double> v = lmp.velocities();
  const double z[3] = {3.0, 5.0, 8.5};
  for (size_t i = 0; i < 3; ++i) {
    const double profile = (z[i] * (H - z[i]) + h * h * (0.25 - K)) / 4.0;
    EXPECT_NEAR(v[3 * i], 0.3 * profile, 1e-13);
    EXPECT_NEAR(v[3 * i + 1], -0.1 * profile, 1e-13);
  }
  EXPECT_NEAR(lmp.fix("1")->compute_vector(9 + 12) + lmp.fix("1")->compute_vector(9 + 15),
              0.3 * 480.0, 1e-11);
}

TEST(LammpsWalls, PlanNamesSolverAndWalls)
{
  LammpsSession lmp;
  lmp.script(slit("fix 1 all bd/fib 1.0 2.0 5 grid 16 12 20 wall zlo noslip wall zhi slip\nrun 0"));
  const std::string log = lmp.log();
  for (const char *words : {"banded factorisation across the channel: exact, no iteration",
                            "zlo no-slip", "zhi free-slip"})
    EXPECT_NE(log.find(words), std::string::npos) << words;
}

TEST(LammpsWalls, CrossingIsAnErrorThatNamesTheAtom)
{
  for (const char *scheme : {"scheme euler", "scheme improved"}) {
    LammpsSession lmp;
    const std::string message = lmp.error_of(long_steps(scheme) + "run 200");
    EXPECT_NE(message.find("atom "), std::string::npos) << message;
    EXPECT_NE(message.find("it is outside the wall z"), std::string::npos) << message;
  }
}

TEST(LammpsWalls, ReflectAndRedrawLoseNoAtom)
{
  for (const char *way : {"crossing reflect scheme euler", "crossing reflect scheme improved",
                          "crossing redraw scheme euler"}) {
    LammpsSession lmp;
    EXPECT_EQ(lmp.error_of(long_steps(way) + "run 200"), "") << way;
    EXPECT_EQ(lmp->atom->natoms, 200) << way;
    EXPECT_GE(lowest_z(lmp), 0.0) << way;
    EXPECT_GT(lmp.fix("move")->compute_vector(8), 0.0) << way;
  }
}

// Without the drift, atoms gather at the walls until they lie on the faces to round-off.  LAMMPS'
// boxes exclude their upper face, so LAMMPS would lose atoms there.
TEST(LammpsWalls, AtomsOnTheUpperWallAreKept)
{
  LammpsSession lmp;
  const char *deck = R"(
units lj
dimension 2
boundary p f p
atom_style atomic
atom_modify map array
neigh_modify every 1 delay 0 check no
comm_modify cutoff 2.0
region box block 0 32 0 12 -0.5 0.5
create_box 1 box
create_atoms 1 random 100 5 box
mass 1 1.0
fix move all bd/fib 1.0 1.0 1 grid 32 12 1 fft estimate scheme euler )"
                     R"(wall ylo noslip wall yhi noslip crossing reflect
timestep 1
run 2000
)";
  EXPECT_EQ(lmp.error_of(deck), "");
  EXPECT_EQ(lmp->atom->nlocal, 100);
}

// The force takes the atom across the wall whatever the noise.
TEST(LammpsWalls, RedrawGivesUpWithAMessage)
{
  LammpsSession lmp;
  const std::string message =
      lmp.error_of(slit("fix down all addforce 0 0 -1000\nfix 1 all bd/fib 1e-6 1.0 5 grid 8 6 10 "
                        "kernel roma3 scheme euler "
                        "wall zlo noslip wall zhi slip crossing redraw\ntimestep 0.25\nrun 5"));
  EXPECT_NE(message.find("in each of 20 attempts: use a smaller timestep"), std::string::npos)
      << message;
}

// The number of iterations for a closed box grows with its aspect ratio, not with the number of
// cells.  Here an error of 3e-6 remains after 1000 of them.
TEST(LammpsWalls, PressureThatDoesNotConvergeIsAnError)
{
  const std::string channel =
      std::string(bdh_test::long_channel) +
      "fix move all bd/fib 0.0 1.0 7 grid 4000 4 1 kernel roma3 fft estimate" +
      bdh_test::channel_walls;
  LammpsSession strict, loose;
  const std::string message = strict.error_of(channel + "tolerance 1e-14\nrun 1");
  EXPECT_NE(message.find("fix bd/fib: the pressure"), std::string::npos) << message;
  bdh_test::expect_unconverged_pressure(message);
  EXPECT_EQ(loose.error_of(channel + "tolerance 1e-5\nrun 1"), "");
  EXPECT_LT(loose.fix("move")->compute_vector(0), 1000.0);
}

TEST(LammpsWalls, RestartContinuesExactly)
{
  const std::string fix =
      "fix 1 all bd/fib 1.0 2.0 5 grid 8 6 10 fft estimate force 0.1 0 0 crossing reflect "
      "wall zlo noslip wall zhi noslip 0.3 0 0\n";
  const std::string file = "test_" + std::to_string(getpid()) + "_walls.restart";
  LammpsSession whole, first, second;
  whole.script(slit(fix) + "run 10\nrun 10");
  first.script(slit(fix) + "run 10\nwrite_restart " + file);
  second.script("read_restart " + file +
                "\nneigh_modify every 1 delay 0 check yes\ntimestep 0.01\n" + fix + "run 10");
  std::remove(file.c_str());
  EXPECT_EQ(bdh_test::largest_difference(whole.unwrapped_positions(), second.unwrapped_positions()),
            0.0);
}
