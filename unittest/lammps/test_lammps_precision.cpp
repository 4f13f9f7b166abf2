// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/fib with its grid in single precision, from the point of view of a LAMMPS user.

#include "lammps/lammps_fib_reference.h"
#include "lammps/lammps_scenes.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <unistd.h>

using bdh_test::LammpsSession;

namespace {

/// Half of the trajectory in one precision, then a restart, and the other half in another one.
std::vector<double> positions(const std::string &first, const std::string &second)
{
  const std::string file = "test_precision_" + std::to_string(getpid()) + ".restart",
                    fix = "fix move all bd/fib 1.0 1.0 321 grid 16 16 16 adapt 0.1 precision ";
  {
    LammpsSession lmp;
    lmp.script(bdh_test::lattice_suspension);
    lmp.script(fix + first);
    lmp.command("run 10");
    lmp.command("write_restart " + file);
  }
  LammpsSession lmp;
  lmp.command("read_restart " + file);
  lmp.script("neighbor 0.4 bin\nneigh_modify every 1 delay 0 check yes\ntimestep 0.002");
  lmp.script(fix + second);
  lmp.command("run 10");
  const std::vector<double> x = lmp.unwrapped_positions();
  std::remove(file.c_str());
  return x;
}

std::string plan_of(const std::string &keywords)
{
  LammpsSession lmp;
  lmp.script(bdh_test::lattice_suspension);
  lmp.script("fix move all bd/fib 1.0 1.0 5 grid 16 16 16 " + keywords + "\nrun 1");
  return lmp.log();
}

}    // namespace

// The bound is the round-off that the manual states, of the largest velocity; these are sums over a
// few particles.  In double precision deviations are 1e-12.
TEST(LammpsPrecision, SingleReadsOutMFToItsRoundOff)
{
  double most = 0.0;
  for (const char *file : {"fib_periodic.json", "fib_slit.json", "fib_open.json"}) {
    const nlohmann::json all = bdh_test::json_reference(file);
    EXPECT_GE(all["cases"].size(), 11u) << file;
    for (const auto &c : all["cases"]) {
      const double off =
          bdh_test::deviation(c, bdh_test::velocities_of(c, 1e-5, "precision single"));
      EXPECT_LT(off, 2e-6) << file << " " << c["id"];
      most = std::max(most, off);
    }
  }
  EXPECT_GT(most, 1e-9) << "is this single precision?";
}

// Noise, drift and forces of both precisions are the same up to round-off, which the forces of
// twenty steps enlarge.  A restart does not depend on the precision.
TEST(LammpsPrecision, RestartMayChangeThePrecision)
{
  const std::vector<double> precise = positions("double", "double");
  for (const char *second : {"double", "single"}) {
    const double off = bdh_test::largest_difference(positions("single", second), precise);
    EXPECT_LT(off, 1e-4) << second;
    EXPECT_GT(off, 1e-12) << second;
  }
}

TEST(LammpsPrecision, PlanSaysWhatIsTakenAndWhy)
{
  const struct {
    const char *keywords, *line;
  } cases[] = {
      {"precision single", "precision  single for grid, transforms and noise (as given)"},
      {"precision auto", "precision  single for grid, transforms and noise (round-off is below"},
      {"precision double", "precision  double (as given or by default)"},
      {"precision auto drift rfd", "precision  double (drift rfd takes differences"},
      {"precision auto stresslet yes", "precision  double (the iteration for motions"},
  };
  for (const auto &c : cases)
    EXPECT_NE(plan_of(c.keywords).find(c.line), std::string::npos) << c.keywords;
}
