// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Input scripts as users write them, with known results.  They are short decks in which something
// changes that a fix has read before, another style does harm, or a run continues an earlier one.
//
// Further cases of this kind are elsewhere:
//
//   spheres in boxes of 1e3 to 1e5 radii           PsePlanning.DiluteBoxes
//   comm_style tiled in a box of 12 radii          PsePlanning.GhostsOfTiledDomains
//   fix viscosity                                  Companions.WhatActsOnVelocities
//   restart under fix deform                       Continuation.OfAShearedBoxIsAsAfterAnotherRun
//   density at P = 1: 0.390, and 0.462 by virial   StatisticsTempBrownian
//   barostat with the pressure of velocities       LammpsTempBrownian.WarningsNameTheRemedyOnce

#include "lammps/lammps_session.h"

#include "atom_masks.h"

#include <gtest/gtest.h>

#include <cmath>

using bdh_test::LammpsSession;
using bdh_test::occurrences;

namespace {

using Row = std::vector<double>;

/// The lines of thermo output of all runs, as numbers.
std::vector<Row> thermo_rows(const std::string &log)
{
  std::vector<Row> rows;
  std::istringstream lines(log);
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string first;
    words >> first;
    if (first == "Step") inside = true;
    if (first == "Loop") inside = false;
    if (!inside || first.empty() || first.find_first_not_of("0123456789") != std::string::npos)
      continue;
    Row row{std::stod(first)};
    for (std::string word; words >> word;) row.push_back(std::stod(word));
    rows.push_back(row);
  }
  return rows;
}

/// Velocity under a force of 1 of one sphere in a periodic cube of edge 20 and viscosity 1.
double velocity_in_cube(double radius)
{
  const double s = radius / 20.0;
  return (1.0 - 2.837297 * s + 4.18879 * s * s * s) / (6.0 * M_PI * radius);
}

bool has_style(LammpsSession &lmp, const char *name)
{
  return lmp->modify->fix_map->find(name) != lmp->modify->fix_map->end();
}

size_t own_warnings(LammpsSession &lmp) { return occurrences("WARNING: fix bd/", lmp.log()); }

/// Relative error of the velocities with tolerance 1e-6.  The formula omits terms of order s^6.
constexpr double velocity_error = 3e-7;

/* ----------------------------------------------------------------------
   what is read once
------------------------------------------------------------------------- */

const char *const spheres = R"(
atom_modify map array
region b block 0 20 0 20 0 20
create_box 1 b
pair_style none
neighbor 1.0 bin
neigh_modify every 1 delay 0 check yes
timestep 1e-3
)";
/// f_m[4]: the radius that the fix works with
const char *const velocity_and_radius = R"(
compute r all property/atom radius
compute rr all reduce max c_r
variable v equal vx[1]
thermo_style custom step f_m[4] c_rr v_v
thermo 1
)";

}    // namespace

TEST(UserCases, ASphereIsDepositedIntoAnEmptyGroup)
{
  LammpsSession lmp;
  if (!has_style(lmp, "deposit")) GTEST_SKIP() << "without package MISC";
  lmp.script("units lj\natom_style sphere\n");
  lmp.script(spheres);
  lmp.script("group sp type 1\nfix m sp bd/pse 0 1 123 tolerance 1e-6 fft estimate\n"
             "fix f all addforce 1 0 0\nregion r block 9 11 9 11 9 11\n"
             "fix dep sp deposit 1 1 5 4567 region r near 0.1\ncompute d all property/atom vx\n"
             "compute vx all reduce sum c_d\nthermo_style custom step atoms f_m[4] c_vx\n"
             "thermo 5\nrun 20\nrun 2\n");
  const std::vector<Row> rows = thermo_rows(lmp.log());
  ASSERT_EQ(rows.size(), 7u);
  EXPECT_NEAR(velocity_in_cube(0.5), 0.098584, 1e-6);
  for (size_t i = 1; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i][1], 1.0) << i;
    EXPECT_EQ(rows[i][2], 0.5) << i;
    EXPECT_NEAR(rows[i][3], velocity_in_cube(0.5), velocity_error) << i;
  }
}

// A step moves the sphere with the radius that it had at the end of the step before.
TEST(UserCases, ASphereSwellsToTwiceItsDiameter)
{
  LammpsSession lmp;
  if (lmp->kokkos) GTEST_SKIP() << "the KOKKOS package knows no spheres that grow";
  lmp.script("units lj\natom_style sphere 1\n");
  lmp.script(spheres);
  lmp.script("create_atoms 1 single 2 2 2\nset group all diameter 1.0\ncomm_modify cutoff 5.0\n"
             "fix m all bd/pse 0 1 123 tolerance 1e-6 fft estimate\nfix f all addforce 1 0 0\n"
             "variable D equal ramp(1.0,2.0)\nfix ad all adapt 1 atom diameter v_D\n");
  lmp.script(velocity_and_radius);
  lmp.script("run 10\nvariable D equal 2.0\nrun 1\n");
  const std::vector<Row> rows = thermo_rows(lmp.log());
  ASSERT_EQ(rows.size(), 13u);
  for (size_t step = 1; step <= 10; ++step) {
    EXPECT_NEAR(rows[step][1], 0.5 + 0.05 * (step - 1), 1e-7);
    EXPECT_NEAR(rows[step][2], 0.5 + 0.05 * step, 1e-7);
    EXPECT_NEAR(rows[step][3], velocity_in_cube(rows[step - 1][2]), velocity_error) << step;
  }
  EXPECT_NEAR(rows[1][3], 0.0986, 5e-5);
  EXPECT_NEAR(rows[6][3], 0.0632, 5e-5);
  EXPECT_NEAR(rows[12][3], 0.0456, 5e-5);
}

TEST(UserCases, ADynamicGroupGetsItsAtomInTheFirstRun)
{
  LammpsSession lmp;
  lmp.script("units lj\natom_style sphere\n");
  lmp.script(spheres);
  lmp.script("create_atoms 1 single 5 5 5\nset group all diameter 1.0\nneighbor 0.6 bin\n"
             "region left block 0 10 INF INF INF INF\n"
             "group dyn dynamic all region left every 5\nfix f all addforce 1 0 0\n"
             "fix m dyn bd/pse 0 1 123 tolerance 1e-6 check yes fft estimate\n");
  lmp.script(velocity_and_radius);
  lmp.script("thermo 5\nrun 10\nrun 10\n");
  const std::vector<Row> rows = thermo_rows(lmp.log());
  ASSERT_EQ(rows.size(), 6u);
  for (size_t i = 1; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i][1], 0.5) << i;
    EXPECT_NEAR(rows[i][3], velocity_in_cube(0.5), velocity_error) << i;
  }
}

/* ----------------------------------------------------------------------
   the plan
------------------------------------------------------------------------- */

namespace {

/// The splitting parameter in the last plan of the log.
double splitting(const std::string &log)
{
  const std::string title = "splitting    xi = ";
  const size_t at = log.rfind(title);
  return at == std::string::npos ? 0.0 : std::stod(log.substr(at + title.size()));
}

std::string globule(double R, const std::string &xi)
{
  return "units lj\natom_style atomic\nregion b block 0 100 0 100 0 100\ncreate_box 1 b\n"
         "region s sphere 50 50 50 " +
         bdh_test::text(R) +
         "\ncreate_atoms 1 random 3000 987 s\nmass 1 1\npair_style none\nneighbor 1.0 bin\n"
         "neigh_modify every 1 delay 0 check yes\ntimestep 1e-4\n"
         "fix m all bd/pse 1 1 123 radius 1 fft estimate xi " +
         xi + "\nthermo_style custom step f_m f_m[2]\nrun 1\n";
}

/// Moves all atoms towards a point by this factor.
void contract(LammpsSession &lmp, double middle, double factor)
{
  LAMMPS_NS::Atom &atom = lmp.host_atoms();
  for (int i = 0; i < atom.nlocal; ++i)
    for (int d = 0; d < 3; ++d) atom.x[i][d] = middle + factor * (atom.x[i][d] - middle);
  lmp.have_moved_atoms();
}

}    // namespace

// For evenly spread beads the splitting would be 0.23, with which a step takes several times as
// long as with 0.5.
TEST(UserCases, AGlobuleInADiluteBox)
{
  for (double R : {18.0, 4.5}) {
    LammpsSession lmp;
    EXPECT_EQ(lmp.error_of(globule(R, "auto")), "") << R;
    const double xi = splitting(lmp.log());
    EXPECT_GT(xi, R > 10.0 ? 0.4 : 0.6) << R;
    EXPECT_LT(xi, R > 10.0 ? 0.75 : 1.1) << R;
  }
}

// The atoms move together after half of the runs.  A plan made then would be different.
TEST(UserCases, HundredRunsHaveOnePlan)
{
  const std::string fix = "fix m all bd/pse 1 1 12345 radius 0.8 fft estimate\n";
  LammpsSession lmp;
  lmp.script("units lj\natom_style atomic\nregion b block 0 20 0 20 0 20\ncreate_box 1 b\n"
             "create_atoms 1 random 100 987 b\nmass 1 1\nneighbor 1 bin\n"
             "neigh_modify every 1 delay 0 check yes\n" +
             fix + "timestep 0.01\nthermo 100000\n");
  for (int run = 0; run < 100; ++run) {
    if (run == 50) contract(lmp, 10.0, 0.3);
    lmp.command("run 1 post no");
  }
  EXPECT_EQ(occurrences("fix bd/pse: plan", lmp.log()), 1u);
  const double kept = splitting(lmp.log());
  lmp.script("unfix m\n" + fix + "run 1 post no\n");
  EXPECT_EQ(occurrences("fix bd/pse: plan", lmp.log()), 2u);
  EXPECT_GT(splitting(lmp.log()), 1.1 * kept);
}

/* ----------------------------------------------------------------------
   companions
------------------------------------------------------------------------- */

namespace {

/// One warning per run that nothing rotates the particles.  Columns 2 and 3 of the thermo output
/// are a sum of orientations, which does not change, and the sum of squares of torques.
void expect_unturned(LammpsSession &lmp, const char *words)
{
  const std::string log = lmp.log();
  EXPECT_EQ(occurrences("but nothing rotates them", log), 1u) << log;
  EXPECT_NE(log.find(words), std::string::npos) << log;
  EXPECT_EQ(own_warnings(lmp), 1u) << log;
  const std::vector<Row> rows = thermo_rows(log);
  ASSERT_GE(rows.size(), 3u);
  for (const Row &row : rows) {
    EXPECT_EQ(row[2], rows[0][2]);
    EXPECT_GT(row[3], 0.0);
  }
}

}    // namespace

TEST(UserCases, EllipsoidsDoNotTurnWithoutRotation)
{
  LammpsSession lmp;
  const std::string message = lmp.error_of(
      "units lj\natom_style ellipsoid\nregion b block 0 16 0 16 0 16\ncreate_box 1 b\n"
      "create_atoms 1 random 30 987 b\nset group all shape 2 1 1\n"
      "set group all quat/random 765\nset group all density 1\n"
      "pair_style gayberne 1.0 3.0 1.0 4.0\npair_coeff * * 1.0 1.0 1 1 0.2 1 1 0.2 2.5\n"
      "neighbor 0.6 bin\nneigh_modify every 1 delay 0 check yes\n"
      "fix m all bd/pse 1 0.1 123 radius 0.7 fft estimate rotation no\ntimestep 1e-6\n"
      "compute q all property/atom quatw tqx\ncompute qq all reduce sum c_q[1]\n"
      "compute tt all reduce sumsq c_q[2]\nthermo_style custom step pe c_qq c_tt\nthermo 5\n"
      "run 10\n");
  if (!message.empty()) GTEST_SKIP() << message;
  expect_unturned(lmp, "have orientations and torques");
}

/// Dipoles that repel each other in a field along z, and the words for a fix that moves them.
/// Returns the message of an error.
std::string magnets_in_a_field(LammpsSession &lmp, const std::string &fix)
{
  return lmp.error_of(
      "units lj\natom_style hybrid sphere dipole\nregion b block 0 16 0 16 0 16\n"
      "create_box 1 b\ncreate_atoms 1 random 60 987 b\nset group all diameter 1.0\n"
      "set group all dipole/random 765 2.0\npair_style soft 1.8\npair_coeff * * 30\n"
      "neighbor 0.6 bin\nneigh_modify every 1 delay 0 check yes\nthermo 0\n"
      "minimize 1e-6 1e-6 500 2000\nreset_timestep 0\n"
      "pair_style lj/cut/dipole/cut 1.1225 4.0\npair_coeff * * 1.0 1.0\n"
      "fix ef all efield 0 0 3.0\n" +
      fix +
      "\ntimestep 1e-4\n"
      "compute mu all property/atom muz tqx\ncompute mz all reduce ave c_mu[1]\n"
      "compute tq all reduce sumsq c_mu[2]\n");
}

TEST(UserCases, DipolesInAFieldDoNotTurnWithoutRotation)
{
  LammpsSession lmp;
  const std::string message =
      magnets_in_a_field(lmp, "fix m all bd/pse 1 0.1 123 fft estimate rotation no");
  if (!message.empty()) GTEST_SKIP() << message;
  const size_t before = thermo_rows(lmp.log()).size();
  lmp.script("thermo_style custom step pe c_mz c_tq\nthermo 10\nrun 20\n");
  EXPECT_EQ(thermo_rows(lmp.log()).size(), before + 3);
  EXPECT_EQ(occurrences("have dipoles and torques, but nothing rotates them", lmp.log()), 1u);
}

/// Both fixes turn them without being asked.
TEST(UserCases, DipolesInAFieldTurnTowardsIt)
{
  for (const std::string fix : {"fix m all bd/pse 1 0.1 123 fft estimate",
                                "fix m all bd/fib 1 0.1 123 grid 16 16 16 fft estimate"}) {
    LammpsSession lmp;
    const std::string message = magnets_in_a_field(lmp, fix);
    if (!message.empty()) GTEST_SKIP() << message;
    // The spheres of the grid are 2.5 times as large and turn more slowly.
    if (fix.find("fib") != std::string::npos) lmp.command("timestep 0.001");
    lmp.script("thermo_style custom step pe c_mz c_tq\nthermo 200\nrun 1000\n");
    const std::vector<Row> rows = thermo_rows(lmp.log());
    EXPECT_LT(rows[rows.size() - 6][2], 0.3);
    EXPECT_GT(rows.back()[2], 1.0);
    EXPECT_EQ(occurrences("nothing rotates", lmp.log()), 0u);
  }
}

namespace {

/// Returns where a sphere ends up that something is meant to hold at x = 6 while another one is
/// pulled past it.
double obstacle_after(const std::string &hold, size_t hints)
{
  LammpsSession lmp;
  lmp.script("units lj\natom_style atomic\natom_modify map array\nregion b block 0 12 0 12 0 12\n"
             "create_box 2 b\ncreate_atoms 1 single 3 6 6\ncreate_atoms 2 single 6 6 6\nmass * 1\n"
             "pair_style none\nneighbor 1.0 bin\nneigh_modify every 1 delay 0 check yes\n"
             "group obst type 2\ngroup mob type 1\nfix p mob addforce 1 0 0\n" +
             hold + "timestep 0.1\nthermo_style custom step\nrun 200\n");
  EXPECT_EQ(occurrences("as if to hold atoms where they are, but the fluid and its noise still "
                        "move them: to hold them, leave them out of group all",
                        lmp.log()),
            hints);
  EXPECT_EQ(own_warnings(lmp), hints);
  return lmp.unwrapped_positions()[3];
}

}    // namespace

TEST(UserCases, AnObstacleThatIsMeantToStay)
{
  const std::string move = "bd/pse 0 1 123 radius 1 fft estimate\n";
  const std::string freeze = "fix fr obst setforce 0 0 0\nvelocity obst set 0 0 0\n";
  EXPECT_NEAR(obstacle_after(freeze + "fix m all " + move, 1), 6.303, 1e-3);
  // The two remedies that the warning suggests.
  EXPECT_EQ(obstacle_after(freeze + "fix m mob " + move, 0), 6.0);
  const double tied = obstacle_after("fix fr obst spring/self 80\nfix m all " + move, 0);
  EXPECT_NEAR(tied, 6.0, 0.02);
  EXPECT_NE(tied, 6.0);
}

/* ----------------------------------------------------------------------
   continuation
------------------------------------------------------------------------- */

namespace {

double mean_square(const std::vector<double> &from, const std::vector<double> &to)
{
  double sum = 0.0;
  for (size_t i = 0; i < from.size(); ++i) sum += std::pow(to[i] - from[i], 2);
  return 3.0 * sum / from.size();
}

/// A second job with the same seed, from the data file of the first; `noted`: whether the log says
/// that it repeats the noise.  Returns the final positions.
std::vector<double> second_job(const std::string &file, const std::string &before, bool noted)
{
  LammpsSession lmp;
  lmp.script("units lj\natom_style atomic\natom_modify map array\nread_data " + file + "\n" +
             before +
             "neighbor 1 bin\nneigh_modify every 1 delay 0 check yes\n"
             "fix m all bd/pse 1 1 12345 radius 0.5 fft estimate\ntimestep 0.01\nrun 1000\n");
  EXPECT_EQ(occurrences("this run repeats its noise from the first step on", lmp.log()), noted);
  return lmp.unwrapped_positions();
}

}    // namespace

// The mean square of 300 nearly uncorrelated numbers has a relative standard deviation of 0.08, and
// the bound is 4 of them.  Repeated noise lies 10 above the mean, because the displacements of the
// two jobs then add up as lengths, not as squares.
TEST(UserCases, TwoJobsThroughADataFile)
{
  const std::string file = "test_user_case_" + std::to_string(getpid()) + ".data";
  std::vector<double> start, middle;
  {
    LammpsSession lmp;
    lmp.script("units lj\natom_style atomic\natom_modify map array\n"
               "region b block 0 20 0 20 0 20\ncreate_box 1 b\ncreate_atoms 1 random 100 987 b\n"
               "mass 1 1\nneighbor 1 bin\nneigh_modify every 1 delay 0 check yes\n"
               "fix m all bd/pse 1 1 12345 radius 0.5 fft estimate\ntimestep 0.01\n");
    start = lmp.unwrapped_positions();
    lmp.script("run 1000\nwrite_data " + file);
    middle = lmp.unwrapped_positions();
  }
  const double expected = 6.0 * velocity_in_cube(0.5) * 20.0;
  const std::vector<double> end = second_job(file, "reset_timestep 1000\n", false),
                            repeated = second_job(file, "", true);
  EXPECT_NEAR(mean_square(start, end), expected, 4.0 * 0.08 * expected);
  EXPECT_NEAR(mean_square(start, middle) + mean_square(middle, repeated), 11.4, 0.2);
  EXPECT_NEAR(mean_square(start, repeated), 22.3, 0.3);
  std::remove(file.c_str());
}
