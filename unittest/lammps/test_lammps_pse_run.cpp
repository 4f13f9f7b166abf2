// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/pse from the point of view of a LAMMPS user: restarts, seeds, groups, output, both parts
// per atom, several runs.

#include "lammps/lammps_mobility.h"
#include "lammps/lammps_scenes.h"

#include "update.h"

#include <gtest/gtest.h>

using bdh_test::GivenForces;
using bdh_test::LammpsSession;
using bdh_test::largest_difference;
using bdh_test::lattice_suspension;
using bdh_test::run_twice_through_restart;

namespace {

const std::string move = "fix move all bd/pse 1.0 1.0 321 radius 0.5 xi 1.0 fft estimate ";

std::vector<double> positions_after(const std::string &script)
{
  LammpsSession lmp;
  lmp.script(lattice_suspension);
  lmp.script(script);
  return lmp.unwrapped_positions();
}

}    // namespace

// Exact apart from the order of summation, 1e-16 (precision double) or 1e-7 (single), which
// collisions amplify over 25 steps.
TEST(LammpsPseRun, RestartContinuesTheTrajectory)
{
  for (const std::string keywords : {"precision double", "precision double parts yes"})
    EXPECT_LT(largest_difference(run_twice_through_restart(move + keywords, true),
                                 run_twice_through_restart(move + keywords, false)),
              1e-10)
        << keywords;
  EXPECT_LT(largest_difference(run_twice_through_restart(move, true),
                               run_twice_through_restart(move, false)),
            1e-5);
}

TEST(LammpsPseRun, NothingIsCarriedFromStepToStep)
{
  const std::string fix = move + "precision double\n";
  EXPECT_LT(largest_difference(positions_after(fix + "run 20"),
                               positions_after(fix + "run 10\nunfix move\n" + fix + "run 10")),
            1e-11);
}

// All pairs of atoms are found for any skin, so the lists are rebuilt in time.
TEST(LammpsPseRun, TrajectoryDoesNotDependOnTheNeighborLists)
{
  const std::string run = move + "precision double\nrun 25";
  EXPECT_LT(largest_difference(positions_after("neighbor 1.0 bin\n" + run),
                               positions_after("neighbor 0.05 bin\n" + run)),
            1e-10);
}

TEST(LammpsPseRun, SeedsAreUnrelated)
{
  const auto home = positions_after("");
  std::vector<std::vector<double>> moves;
  for (const std::string seed : {"1", "2", "2147483647"}) {
    moves.push_back(positions_after("pair_style none\nfix move all bd/pse 1.0 1.0 " + seed +
                                    " radius 0.5 xi 1.0 fft estimate\nrun 1"));
    for (size_t i = 0; i < home.size(); ++i) moves.back()[i] -= home[i];
  }
  for (size_t a = 0; a < 3; ++a)
    for (size_t b = 0; b < a; ++b) {
      double product = 0.0;
      for (size_t i = 0; i < home.size(); ++i) product += moves[a][i] * moves[b][i];
      // The correlation of 192 independent numbers has a standard deviation of 0.07, and less than
      // 0.13 with the correlations due to the fluid.  The bound is 5 of these.
      EXPECT_LT(std::fabs(product) /
                    (bdh_test::length_of(moves[a]) * bdh_test::length_of(moves[b])),
                0.65);
    }
}

TEST(LammpsPseRun, EstimatedPlansRepeatBitForBit)
{
  EXPECT_EQ(
      largest_difference(positions_after(move + "\nrun 20"), positions_after(move + "\nrun 20")),
      0.0);
}

TEST(LammpsPseRun, TemperatureAndViscosityAsVariables)
{
  const std::string fixed =
      "fix move all bd/pse 0.5 2.0 321 radius 0.5 xi 1.0 fft estimate precision double\nrun 3";
  const std::string variable =
      "variable T equal 0.5\nvariable eta equal 2.0+0*step\n"
      "fix move all bd/pse v_T v_eta 321 radius 0.5 xi 1.0 fft estimate precision double\nrun 3";
  EXPECT_LT(largest_difference(positions_after(fixed), positions_after(variable)), 1e-13);
}

TEST(LammpsPseRun, OutputAndPlan)
{
  LammpsSession lmp;
  lmp.script(lattice_suspension);
  lmp.script(
      "fix move all bd/pse 1.0 2.0 5 radius 0.5 tolerance 1e-3\nfix_modify move dynamic/dof no\n"
      "thermo_style custom step temp f_move f_move[1] f_move[2] f_move[3] f_move[4] f_move[5] "
      "f_move[8]\nthermo 2\nrun 4");
  LAMMPS_NS::Fix *fix = lmp.fix("move");
  const auto v = lmp.velocities();
  double longest = 0.0;
  for (size_t i = 0; i < v.size(); i += 3)
    longest = std::max(longest, std::sqrt(v[i] * v[i] + v[i + 1] * v[i + 1] + v[i + 2] * v[i + 2]));
  EXPECT_NEAR(fix->compute_scalar(), longest * lmp->update->dt / 0.5, 1e-12);
  EXPECT_GE(fix->compute_vector(1), 2.0);    // Lanczos iterations
  EXPECT_LE(fix->compute_vector(1), 30.0);
  EXPECT_LE(fix->compute_vector(2), 1e-3);    // estimated error
  EXPECT_GT(fix->compute_vector(2), 0.0);
  EXPECT_EQ(fix->compute_vector(3), 0.5);
  EXPECT_GT(fix->compute_vector(4), 0.1);    // grid spacing
  EXPECT_EQ(fix->compute_vector(5), 1.0);
  EXPECT_EQ(fix->compute_vector(6), 2.0);
  const std::string log = lmp.log();
  for (const char *words :
       {"fix bd/pse: plan", "0.001: relative error of the velocities M F and of the random ones",
        "0.5 (as given)", "(the cheapest by the cost model)", "pairs within r_c = ",
        "points, window of ", "expected 0.", "single for grid, transforms and pairs",
        "Euler-Maruyama: 1 evaluation", "real space by Lanczos", "none: div M = 0", "kept within ",
        "real space ", "MB for the grid on the first process"})
    EXPECT_NE(log.find(words), std::string::npos) << words;
  EXPECT_GT(fix->memory_usage(), 64 * 3 * 8.0);
}

TEST(LammpsPseRun, PlanNamesWhatWasGiven)
{
  LammpsSession lmp;
  lmp.script(lattice_suspension);
  lmp.script("fix move all bd/pse 0.0 2.0 5 radius 0.5 xi 1.2 precision double parts yes fft "
             "estimate\nrun 0");
  for (const char *words :
       {"xi = 1.2 = 0.6/radius (as given)", "double for grid, transforms and pairs (as given)",
        "off: temperature 0, so neither Lanczos nor random numbers",
        "kept per atom: the forces and the noise"})
    EXPECT_NE(lmp.log().find(words), std::string::npos) << words;
}

TEST(LammpsPseRun, SecondRunShowsThePlanOnlyIfItChanged)
{
  LammpsSession lmp;
  lmp.script(lattice_suspension);
  lmp.script(move + "\nrun 0\nrun 2\nrun 2");
  EXPECT_EQ(bdh_test::occurrences("fix bd/pse: plan", lmp.log()), 1u);
  EXPECT_EQ(bdh_test::occurrences("the same noise is drawn again", lmp.log()), 0u);
  lmp.script("unfix move\n" + move + "tolerance 1e-4\nrun 2\nreset_timestep 0\nrun 2");
  EXPECT_EQ(bdh_test::occurrences("fix bd/pse: plan", lmp.log()), 2u);
}

TEST(LammpsPseRun, RunZeroMovesNothing)
{
  LammpsSession lmp;
  lmp.script(lattice_suspension);
  const auto x = lmp.unwrapped_positions();
  lmp.script(move + "parts yes\nrun 0");
  EXPECT_EQ(largest_difference(x, lmp.unwrapped_positions()), 0.0);
  EXPECT_EQ(bdh_test::length_of(lmp.per_atom("move", 6)), 0.0);
  EXPECT_EQ(lmp.fix("move")->compute_scalar(), 0.0);
}

TEST(LammpsPseRun, EmptyGroup)
{
  LammpsSession lmp;
  lmp.script(lattice_suspension);
  const auto x = lmp.unwrapped_positions();
  lmp.script(
      "group none empty\nfix move none bd/pse 1.0 1.0 5 radius 0.5 fft estimate parts yes\nrun 3");
  EXPECT_EQ(largest_difference(x, lmp.unwrapped_positions()), 0.0);
}

// Atoms that left the group do not move and keep no displacement; those in it move as they would in
// a separate group.
TEST(LammpsPseRun, DynamicGroup)
{
  LammpsSession lmp;
  lmp.script(lattice_suspension);
  lmp.script("pair_style none\nneighbor 1.0 bin\nvariable now atom \"id <= 32 && step < 2 || id > "
             "16 && step >= 2\"\n"
             "group now dynamic all var now every 1\n"
             "fix move now bd/pse 1.0 1.0 321 radius 0.5 xi 1.0 fft estimate precision double "
             "parts yes\nrun 1");
  const auto before = lmp.unwrapped_positions();
  lmp.command("run 2 pre no");
  auto x = lmp.unwrapped_positions();
  const auto parts = lmp.per_atom("move", 6);
  for (size_t i = 0; i < 64; ++i) {
    const double sum =
        std::fabs(parts[6 * i]) + std::fabs(parts[6 * i + 3]) + std::fabs(x[3 * i] - before[3 * i]);
    if (i < 16) {
      EXPECT_EQ(std::fabs(parts[6 * i]) + std::fabs(parts[6 * i + 3]), 0.0) << "atom " << i + 1;
    } else {
      EXPECT_GT(sum, 0.0) << "atom " << i + 1;
    }
  }
}

TEST(LammpsPseRun, TwoFixesOfTwoGroups)
{
  LammpsSession both, one;
  const std::string a =
      "fix a half bd/pse 1.0 1.0 7 radius 0.5 xi 1.0 fft estimate precision double\n";
  const std::string b =
      "fix b rest bd/pse 1.0 1.0 8 radius 0.4 xi 1.4 fft estimate precision double\n";
  for (LammpsSession *lmp : {&both, &one}) {
    lmp->script(lattice_suspension);
    lmp->script("pair_style none\ngroup half id 1:64:2\ngroup rest subtract all half\n" + a);
  }
  both.script(b + "run 2");
  one.command("run 2");
  EXPECT_NE(both.log().find("has a fluid of its own"), std::string::npos);
  const auto x = both.unwrapped_positions(), y = one.unwrapped_positions();
  double moved = 0.0;
  for (size_t i = 0; i < 64; ++i)
    for (size_t d = 0; d < 3; ++d) {
      if (i % 2 == 0)
        EXPECT_NEAR(x[3 * i + d], y[3 * i + d], 1e-13);
      else
        moved = std::max(moved, std::fabs(x[3 * i + d] - y[3 * i + d]));
    }
  EXPECT_GT(moved, 1e-3);
}

// Keyword parts: the first three numbers are M F dt, and all six add up to the displacement.  Atoms
// that are sorted and wrapped keep their numbers, and LAMMPS' output reads them.
TEST(LammpsPseRun, PartsOfTheDisplacement)
{
  LammpsSession lmp;
  lmp.script(lattice_suspension);
  lmp.script("pair_style none\natom_modify sort 1 2.0\ntimestep 0.05");
  GivenForces forces(lmp, bdh_test::random_vector(192, 5));
  lmp.script(move + "tolerance 1e-6 parts yes\nrun 30");
  const auto exact = bdh_test::exact_velocities(lmp, 0.5, 1.0, forces());
  const auto before = lmp.unwrapped_positions();
  const std::string file = "test_" + std::to_string(getpid()) + ".dump";
  lmp.script(
      "compute most all reduce max f_move[1] f_move[2] f_move[3] f_move[4] f_move[5] f_move[6]\n"
      "thermo_style custom step c_most[1] c_most[6]\n"
      "dump parts all custom 1 " +
      file +
      " id f_move[1] f_move[6]\ndump_modify parts sort id format float %.15g\nrun 1\nundump parts");
  const auto after = lmp.unwrapped_positions(), v = lmp.velocities(),
             parts = lmp.per_atom("move", 6);
  std::vector<double> deterministic(192), sum(192);
  double random = 0.0;
  for (size_t i = 0; i < 64; ++i)
    for (size_t d = 0; d < 3; ++d) {
      deterministic[3 * i + d] = parts[6 * i + d] / 0.05;
      sum[3 * i + d] = parts[6 * i + d] + parts[6 * i + 3 + d];
      random = std::max(random, std::fabs(parts[6 * i + 3 + d]));
      EXPECT_NEAR(sum[3 * i + d], 0.05 * v[3 * i + d], 1e-14);
      EXPECT_NEAR(sum[3 * i + d], after[3 * i + d] - before[3 * i + d], 1e-12);
    }
  EXPECT_LE(bdh_test::relative_error(deterministic, exact), 1e-6);
  EXPECT_GT(random, 0.01);
  std::ifstream in(file);
  std::string line;
  for (int header = 0; header < 2 * 9 + 64; ++header) std::getline(in, line);
  for (size_t i = 0; i < 64; ++i) {
    size_t id = 0;
    double first = 0.0, last = 0.0;
    in >> id >> first >> last;
    EXPECT_EQ(id, i + 1);
    EXPECT_NEAR(first, parts[6 * i], 1e-14);
    EXPECT_NEAR(last, parts[6 * i + 5], 1e-14);
  }
  std::remove(file.c_str());
}

TEST(LammpsPseRun, NewAtomsHaveNotBeenDisplaced)
{
  LammpsSession lmp;
  lmp.script(lattice_suspension);
  lmp.script(move + "parts yes\nrun 2\nset group all image 0 0 0\ngroup gone id 1:10\ndelete_atoms "
                    "group gone compress yes\n"
                    "create_atoms 1 single 1.0 1.0 1.0 units box");
  const auto parts = lmp.per_atom("move", 6);
  EXPECT_EQ(lmp->atom->natoms, 55);
  for (size_t c = 0; c < 6; ++c) EXPECT_EQ(parts[6 * 54 + c], 0.0);
  EXPECT_GT(bdh_test::length_of(parts), 0.0);
}

// Keyword check: it prints the error of M F and does not change the run.
TEST(LammpsPseRun, CheckPrintsTheErrorAchieved)
{
  for (const std::string tolerance : {"0.3", "1e-2", "1e-4", "1e-7", "1e-10", "1e-12"}) {
    LammpsSession lmp;
    lmp.script(lattice_suspension);
    lmp.script("pair_style none\ndisplace_atoms all random 0.9 0.9 0.9 5");
    GivenForces forces(lmp, bdh_test::random_vector(192, 5));
    const auto exact = bdh_test::exact_velocities(lmp, 0.5, 1.0, forces());
    lmp.script("fix move all bd/pse 0.0 1.0 1 radius 0.5 fft estimate check yes tolerance " +
               tolerance + "\nrun 1");
    const double error = bdh_test::relative_error(lmp.velocities(), exact);
    const std::string log = lmp.log(), words = "error of M F, forces as they are:";
    const size_t at = log.find(words);
    ASSERT_NE(at, std::string::npos) << tolerance;
    // Two digits are printed, and the error of the solve used for comparison is a hundredth of the
    // tolerance (a tenth of the error).
    if (tolerance != "1e-10" && tolerance != "1e-12") {
      EXPECT_NEAR(std::stod(log.substr(at + words.size())), error, 0.15 * error) << tolerance;
    }
    EXPECT_EQ(log.find("above the tolerance"), std::string::npos) << tolerance;
    EXPECT_LE(error, std::stod(tolerance));
  }
}

// With this splitting there is no precise solve whose pairs are within the plan's cutoff, so that
// the neighbor list has to be longer than the plan requires.
TEST(LammpsPseRun, CheckMayNeedALongerList)
{
  LammpsSession lmp;
  lmp.script("units lj\natom_style atomic\natom_modify map array\n"
             "region box block 0 2.2 0 2.3 0 2.4\ncreate_box 1 box\nmass 1 1\npair_style none\n"
             "neighbor 0.01 bin\nneigh_modify every 1 delay 0 check yes\ntimestep 1e-3\n"
             "create_atoms 1 random 6 987 box");
  GivenForces forces(lmp, bdh_test::random_vector(18, 5));
  const auto exact = bdh_test::exact_velocities(lmp, 0.5, 1.0, forces());
  lmp.script("fix move all bd/pse 0 1 123 radius 0.5 xi 20 tolerance 0.1 check yes fft estimate\n"
             "run 1");
  const double error = bdh_test::relative_error(lmp.velocities(), exact);
  const std::string log = lmp.log(), words = "error of M F, forces as they are:";
  const size_t at = log.find(words);
  ASSERT_NE(at, std::string::npos) << log;
  EXPECT_NEAR(std::stod(log.substr(at + words.size())), error, 0.15 * error);
}

TEST(LammpsPseRun, CheckLeavesTheTrajectoryAlone)
{
  LammpsSession lmp;
  lmp.script(lattice_suspension);
  lmp.script(move + "check yes\nrun 10");
  EXPECT_NE(lmp.log().find("error of the noise, by Lanczos:"), std::string::npos);
  EXPECT_EQ(largest_difference(lmp.unwrapped_positions(), positions_after(move + "\nrun 10")), 0.0);
}

// fix adapt changes temperature and viscosity between steps.
TEST(LammpsPseRun, FixAdaptReachesTemperatureAndViscosity)
{
  const std::string tail = " 321 radius 0.5 xi 1.0 fft estimate precision double\n";
  LammpsSession a;
  a.script(lattice_suspension);
  a.script("fix move all bd/pse 1.0 1.0" + tail);
  int dim = -1;
  *static_cast<double *>(a.fix("move")->extract("temperature", dim)) = 0.3;
  *static_cast<double *>(a.fix("move")->extract("viscosity", dim)) = 4.0;
  a.command("run 5");
  EXPECT_EQ(largest_difference(a.unwrapped_positions(),
                               positions_after("fix move all bd/pse 0.3 4.0" + tail + "run 5")),
            0.0);
}
