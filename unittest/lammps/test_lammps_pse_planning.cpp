// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// What fix bd/pse plans for dilute boxes and clusters, and within the limits of LAMMPS.

#include "lammps/lammps_session.h"
#include "oracle/dense_rpy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

using namespace bdh_test;

namespace {

/// Spheres of radius 1 at random positions within a region of a cube of side L; they may overlap.
std::string spheres(long n, double L, const std::string &region)
{
  return "units lj\natom_style atomic\natom_modify map array\nregion b block 0 " + text(L) + " 0 " +
         text(L) + " 0 " + text(L) + "\ncreate_box 1 b\n" + region + "create_atoms 1 random " +
         std::to_string(n) + " 987 " + (region.empty() ? "b" : "s") +
         "\nmass 1 1\npair_style none\nneighbor 1.0 bin\n"
         "neigh_modify every 1 delay 0 check yes\ntimestep 1e-4\n";
}

std::string globule(long n, double L, double R)
{
  const std::string middle = text(0.5 * L) + " ";
  return spheres(n, L, "region s sphere " + middle + middle + middle + text(R) + "\n");
}

/// The numbers in the line of the plan with this title, in order.
std::vector<double> numbers_of(const std::string &log, const std::string &title)
{
  std::istringstream lines(log);
  std::vector<double> numbers;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("  " + title + " ") != 0) continue;
    numbers.clear();
    std::istringstream words(line.substr(title.size() + 2));
    for (std::string word; words >> word;) {
      char *end = nullptr;
      const double number = std::strtod(word.c_str(), &end);
      if (end != word.c_str()) numbers.push_back(number);
    }
  }
  return numbers;
}

/// |v - M F|/|M F| of a step at temperature 0 under a force of 1 along x on all particles, by
/// direct sums.
double error_of(LammpsSession &lmp, double L, const std::vector<double> &x)
{
  bdh::Cell cell;
  cell.lx = cell.ly = cell.lz = L;
  const std::vector<double> v = lmp.velocities();
  std::vector<double> f(x.size(), 0.0), exact(x.size());
  for (size_t i = 0; i < f.size(); i += 3) f[i] = 1.0;
  bdh::dense_apply(cell, x.data(), x.size() / 3, 1.0, 1.0, f.data(), exact.data());
  double error = 0.0, scale = 0.0;
  for (size_t i = 0; i < f.size(); ++i) {
    error += std::pow(v[i] - exact[i], 2);
    scale += exact[i] * exact[i];
  }
  return std::sqrt(error / scale);
}

const char *const push = "fix f all addforce 1 0 0\n";
const char *const move_cold = "fix m all bd/pse 0 1 123 radius 1 ";
const char *const move_hot = "fix m all bd/pse 1 1 123 radius 1 ";

/// Largest number of other particles within r of a particle, in a box without images.
double most_within(const std::vector<double> &x, double r)
{
  double most = 0.0;
  for (size_t i = 0; i < x.size(); i += 3) {
    double others = -1.0;
    for (size_t j = 0; j < x.size(); j += 3) {
      double r2 = 0.0;
      for (int d = 0; d < 3; ++d) r2 += std::pow(x[i + d] - x[j + d], 2);
      others += r2 < r * r;
    }
    most = std::max(most, others);
  }
  return most;
}

}    // namespace

// Nearly empty boxes need only a few modes and a few pairs.
TEST(PsePlanning, DiluteBoxes)
{
  for (double L : {1e3, 1e4, 1e5}) {
    LammpsSession lmp;
    lmp.script(spheres(20, L, ""));
    lmp.script(push);
    lmp.script(move_cold);
    const std::vector<double> x = lmp.unwrapped_positions();
    lmp.script("run 1");
    const std::vector<double> grid = numbers_of(lmp.log(), "wave space"),
                              cost = numbers_of(lmp.log(), "cost");
    ASSERT_GE(grid.size(), 3u);
    for (int d = 0; d < 3; ++d) EXPECT_LE(grid[d], 16.0) << L;
    ASSERT_GE(cost.size(), 2u);
    EXPECT_LT(cost[0] + cost[1], 1e-4) << L;
    EXPECT_LE(error_of(lmp, L, x), 1e-3) << L;
  }
}

// A splitting whose grid fits into no machine ends with a message; one with a small grid runs.
TEST(PsePlanning, GivenSplittingsInDiluteBoxes)
{
  const double L = 1e5;
  LammpsSession lmp;
  lmp.script(spheres(20, L, ""));
  lmp.script(push);
  const std::vector<double> x = lmp.unwrapped_positions();
  const std::string message = lmp.error_of(std::string(move_cold) + "xi 0.08\nrun 1");
  for (const char *words :
       {"fix bd/pse: xi = 0.08, but its grid of ", "in a box of 1e+05 x 1e+05 x 1e+05", " GB",
        "use a smaller one, or xi auto"})
    EXPECT_NE(message.find(words), std::string::npos) << message;
  lmp.script(std::string("unfix m\n") + move_cold + "xi 3e-4\nrun 1");
  EXPECT_LE(error_of(lmp, L, x), 1e-3);
}

// A globule in a large box has many neighbors where the mean density suggests few.
TEST(PsePlanning, CountsNeighborsInAGlobule)
{
  LammpsSession lmp;
  lmp.script(globule(1500, 100.0, 14.0));
  lmp.script(move_hot);
  const std::vector<double> x = lmp.unwrapped_positions();
  lmp.script("run 1");
  const std::vector<double> pairs = numbers_of(lmp.log(), "real space");
  ASSERT_EQ(pairs.size(), 4u) << lmp.log();    // r_c, r_c in radii, neighbors: mean, largest
  EXPECT_NEAR(pairs[3], most_within(x, pairs[0]), 0.07 * pairs[3] + 1.0);
  EXPECT_GT(pairs[2], 0.3 * pairs[3]);
  const std::vector<double> splitting = numbers_of(lmp.log(), "splitting");
  ASSERT_GE(splitting.size(), 1u);
  EXPECT_GT(splitting[0], 0.4);    // by the mean density: 0.2
}

// Without neigh_modify one, LAMMPS ends a run when an atom has more than 2000 neighbors.
TEST(PsePlanning, RoomForTheNeighborsOfAGlobule)
{
  LammpsSession lmp;
  lmp.script(globule(2500, 100.0, 3.0));
  EXPECT_EQ(lmp.error_of(std::string(move_hot) + "tolerance 1e-1 xi 0.5\nrun 1"), "");
  EXPECT_GT(numbers_of(lmp.log(), "real space").back(), 2000.0);
}

TEST(PsePlanning, RoomForAGlobuleThatForms)
{
  LammpsSession lmp;
  lmp.script(globule(2500, 100.0, 30.0));
  lmp.script(std::string(move_hot) + "tolerance 1e-1 xi 0.5\nrun 0");
  EXPECT_LT(numbers_of(lmp.log(), "real space").back(), 500.0);
  LAMMPS_NS::Atom &atom = lmp.host_atoms();
  for (int i = 0; i < atom.nlocal; ++i)
    for (int d = 0; d < 3; ++d) atom.x[i][d] = 50.0 + 0.08 * (atom.x[i][d] - 50.0);
  lmp.have_moved_atoms();
  EXPECT_EQ(lmp.error_of("run 1"), "");
}

// comm_style tiled keeps ghosts up to the length of the box.
TEST(PsePlanning, GhostsOfTiledDomains)
{
  const std::string pair = "pair_style zero 2.5\npair_coeff * *\nneighbor 0.5 bin\n";
  const std::string precise = std::string(move_cold) + "tolerance 1e-5 ";
  LammpsSession lmp;
  lmp.script("comm_style tiled");
  lmp.script(spheres(5, 12.0, ""));
  lmp.script(pair + push);
  const std::vector<double> x = lmp.unwrapped_positions();
  lmp.script(precise + "check yes\nrun 1");
  EXPECT_NE(lmp.log().find("the cheapest whose pairs LAMMPS knows"), std::string::npos);
  EXPECT_LE(numbers_of(lmp.log(), "real space")[0], 11.5);
  EXPECT_LE(error_of(lmp, 12.0, x), 1e-5);
  const std::string message = lmp.error_of("unfix m\n" + precise + "xi 0.3\nrun 1");
  for (const char *words : {"fix bd/pse: xi = 0.3, but its cutoff of ", "exceeds 11.5",
                            "comm_style tiled", "use comm_style brick", "or an xi of at least 0.3"})
    EXPECT_NE(message.find(words), std::string::npos) << message;
  // In a smaller box another plan is made, although this one is about the cheapest.
  lmp.script(std::string("unfix m\n") + move_cold + "tolerance 1e-7\nrun 0");
  const double before = numbers_of(lmp.log(), "real space")[0];
  const std::vector<double> y = lmp.unwrapped_positions();
  lmp.script("change_box all x final 0 11 y final 0 11 z final 0 11 remap units box\nrun 1");
  EXPECT_GT(before, 10.5);
  EXPECT_LE(numbers_of(lmp.log(), "real space")[0], 10.5);
  LammpsSession brick;
  brick.script(spheres(5, 12.0, ""));
  brick.script(pair + push);
  brick.script(precise + "xi 0.3\nrun 1");
  EXPECT_LE(error_of(brick, 12.0, x), 1e-5);
}
