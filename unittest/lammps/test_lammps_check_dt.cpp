// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Keyword check dt: a step against its halves on the same Brownian path.

#include "lammps/lammps_stiffness.h"
#include "lammps/wrong_input.h"

using bdh_test::LammpsSession;

namespace {

struct Found {
  double moved = 0.0, apart = 0.0, farthest = 0.0;
};
Found check_in(const std::string &log)
{
  Found found;
  const size_t at = log.rfind("check of the timestep");
  if (at == std::string::npos) return found;
  const size_t line = log.find("particles move by", at);
  EXPECT_EQ(std::sscanf(log.c_str() + line,
                        "particles move by %lf radii and end %lf radii apart (root mean square), "
                        "%lf at most",
                        &found.moved, &found.apart, &found.farthest),
            3);
  return found;
}

/// Hard enough that steps of 0.02 and their halves differ.
const char *const suspension = bdh_test::wca_suspension;

}    // namespace

// Without noise a bond that is stretched by e has e (1 - p) after a step and e (1 - p/2)^2 after
// its halves, so each of its particles ends e p^2/8 apart.
TEST(CheckDt, OfAStretchedBondIsExact)
{
  for (const char *style : {"bd/pse 0.0 1.0 77 radius 1.0", "bd/fib 0.0 1.0 77 radius 1.0"}) {
    bdh_test::HarmonicPairs scene;
    const double e = 0.5;
    const std::string bonds = scene.scene();
    scene.bond += e;
    std::string text = scene.scene();
    text.replace(text.find("bond_coeff"),
                 text.find('\n', text.find("bond_coeff")) - text.find("bond_coeff"),
                 bonds.substr(bonds.find("bond_coeff"), bonds.find('\n', bonds.find("bond_coeff")) -
                                                            bonds.find("bond_coeff")));
    LammpsSession lmp;
    lmp.script(text);
    lmp.script("fix 1 all " + std::string(style) + " hydrodynamics no check dt\ntimestep " +
               bdh_test::text(scene.step_for(0.8)) + "\nrun 1");
    const double radius = lmp.fix("1")->compute_vector(3), p = 0.8 / radius;
    const Found found = check_in(lmp.log());
    // Two digits are printed.
    EXPECT_NEAR(found.moved * radius, 0.5 * p * e, 0.06 * 0.5 * p * e) << style;
    EXPECT_NEAR(found.apart * radius, e * p * p / 8.0, 0.06 * e * p * p / 8.0) << style;
    EXPECT_NEAR(found.farthest, found.apart, 0.06 * found.apart) << style;
  }
}

// The path is the same: without forces the halves end where the step does.
TEST(CheckDt, IsZeroWithoutForces)
{
  LammpsSession lmp;
  lmp.script(bdh_test::HarmonicPairs().scene());
  lmp.script("bond_coeff 1 0.0 8.0\nfix 1 all bd/pse 1.0 1.0 77 radius 1.0 hydrodynamics no check "
             "dt\ntimestep 0.1\nrun 1");
  const Found found = check_in(lmp.log());
  EXPECT_NEAR(found.moved, std::sqrt(6.0 * 0.1 / (6.0 * M_PI)), 0.05);
  EXPECT_LT(found.farthest, 1e-12);
}

// It leaves the run as it was, and is done once a run.  The particles come back to where they were
// up to round-off, which a grid in single precision would magnify.
TEST(CheckDt, ChangesNothing)
{
  for (const char *style :
       {"bd/pse 1.0 1.0 77 radius 1.0", "bd/fib 1.0 1.0 77 radius 1.0 scheme trapezoidal"}) {
    std::vector<double> x[2];
    for (const int check : {0, 1}) {
      LammpsSession lmp;
      lmp.script(suspension);
      lmp.script("fix 1 all " + std::string(style) + " precision double fft estimate check " +
                 (check ? "dt" : "no") + "\ntimestep 0.02\nrun 5");
      x[check] = lmp.unwrapped_positions();
      const std::string log = lmp.log();
      const size_t first = log.find("check of the timestep");
      EXPECT_EQ(first != std::string::npos, check == 1);
      EXPECT_EQ(log.find("check of the timestep", first + 1), std::string::npos);
    }
    EXPECT_LT(bdh_test::largest_difference(x[0], x[1]), 1e-10) << style;
  }
}

// Strong order: with additive noise a step and its halves differ by terms of order dt^(3/2).
TEST(CheckDt, FollowsTheTimeStep)
{
  double apart[2];
  int k = 0;
  for (const char *dt : {"0.08", "0.02"}) {
    LammpsSession lmp;
    lmp.script(suspension);
    lmp.script("fix 1 all bd/pse 1.0 1.0 77 radius 1.0 hydrodynamics no check dt\ntimestep " +
               std::string(dt) + "\nrun 1");
    apart[k++] = check_in(lmp.log()).apart;
  }
  EXPECT_GT(apart[1], 0.0);
  EXPECT_GT(std::log(apart[0] / apart[1]) / std::log(4.0), 1.3);
}

TEST(CheckDt, WarnsOfAStepThatIsTooLong)
{
  for (const char *dt : {"1.0", "100.0"}) {
    LammpsSession lmp;
    lmp.script(suspension);
    lmp.error_of("fix 1 all bd/pse 1.0 1.0 77 radius 1.0 hydrodynamics no check dt\ntimestep " +
                 std::string(dt) + "\nrun 1");
    EXPECT_NE(lmp.log().find("use a smaller timestep, or adapt"), std::string::npos) << dt;
  }
}

class WrongCheckDt : public testing::TestWithParam<bdh_test::WrongInput> {};
TEST_P(WrongCheckDt, IsRefused) { bdh_test::expect_message(GetParam()); }
INSTANTIATE_TEST_SUITE_P(
    CheckDt, WrongCheckDt,
    testing::Values(
        bdh_test::WrongInput{"fix 1 all bd/pse 1 1 5 radius 1 check all",
                             "fix bd/pse: check = all, but must be yes, no or dt"},
        bdh_test::WrongInput{"fix 1 all bd/fib 1 1 5 radius 1 check yes",
                             "fix bd/fib: check = yes, but must be dt or no"},
        bdh_test::WrongInput{"fix 1 all bd/fib 1 1 5 radius 1 check dt scheme improved",
                             "check = dt, but needs a scheme that takes forces where the step"},
        bdh_test::WrongInput{"fix 1 all bd/pse 1 1 5 radius 1 check dt scheme split substeps 2",
                             "check = dt, but needs scheme euler"},
        bdh_test::WrongInput{"fix 1 all bd/pse 1 1 5 radius 1 check dt adapt 0.02",
                             "check = dt, but needs adapt no"},
        bdh_test::WrongInput{"fix 1 all bd/pse 1 1 5 radius 1 check dt stresslet yes",
                             "stresslet = yes, but needs no check dt"}));
