// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Checks the numbers in the yaml files for LAMMPS' driver test_fix_timestep independently: eight
// Euler steps with the mobility as a matrix from Ewald sums, and Lennard-Jones forces summed here.
// The temperature is 0; noise has its own tests.

#include "oracle/dense_rpy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Values = std::vector<double>;

constexpr double box = 16.0;
constexpr int atoms = 8;
// unittest/lammps_drivers/in.spheres
const int kind[atoms] = {1, 2, 3, 4, 5, 1, 3, 2};
const Values start = {2.1, 3.3,  4.7, 4.9,  3.0, 5.2, 9.4, 8.1, 15.3, 12.8, 8.6,  1.0,
                      7.7, 12.9, 8.8, 15.4, 1.2, 9.6, 1.9, 0.7, 10.9, 8.3,  10.2, 10.1};

/// A block of a yaml file, three numbers for each atom.
Values block(const std::string &file, const std::string &name)
{
  std::ifstream in(std::string(BDH_REFERENCE_DIR) + "/../lammps_drivers/" + file);
  std::string line;
  while (std::getline(in, line) && line.rfind(name + ":", 0) != 0) {
  }
  Values all;
  for (int i = 0; i < atoms && std::getline(in, line); ++i) {
    std::istringstream row(line);
    double id, x[3];
    row >> id >> x[0] >> x[1] >> x[2];
    all.insert(all.end(), x, x + 3);
  }
  return all;
}

/// Forces of lj/cut 8.0 with the coefficients of the driver and geometric mixing.
Values forces(const Values &x)
{
  const double epsilon[] = {0, 0.02, 0.005, 0.02, 0.015, 0.015},
               sigma[] = {0, 2.5, 1.0, 3.2, 3.1, 3.1};
  Values f(x.size(), 0.0);
  for (int i = 0; i < atoms; ++i)
    for (int j = 0; j < atoms; ++j)
      for (int image = 0; image < 27; ++image) {
        if (i == j) continue;
        const int shift[3] = {image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1};
        double r[3], r2 = 0.0;
        for (int d = 0; d < 3; ++d) {
          r[d] = x[3 * i + d] - x[3 * j + d] + box * shift[d];
          r2 += r[d] * r[d];
        }
        if (r2 >= 64.0) continue;
        const int a = std::min(kind[i], kind[j]), b = std::max(kind[i], kind[j]);
        const bool given = a == 2 && b == 4;
        const double e = given ? 0.005 : std::sqrt(epsilon[a] * epsilon[b]),
                     s = given ? 0.5 : std::sqrt(sigma[a] * sigma[b]);
        const double s6 = std::pow(s * s / r2, 3.0);
        for (int d = 0; d < 3; ++d) f[3 * i + d] += 24.0 * e * (2.0 * s6 * s6 - s6) / r2 * r[d];
      }
  return f;
}

struct Path {
  Values x, u;
};

Path eight_steps(double radius)
{
  bdh::Cell cell;
  cell.lx = cell.ly = cell.lz = box;
  Path p{start, Values(start.size())};
  for (int step = 0; step < 8; ++step) {
    const Values f = forces(p.x), M = bdh::dense_mobility(cell, p.x.data(), atoms, radius, 0.1);
    for (std::size_t r = 0; r < p.u.size(); ++r) {
      p.u[r] = 0.0;
      for (std::size_t c = 0; c < f.size(); ++c) p.u[r] += M[r * f.size() + c] * f[c];
    }
    for (std::size_t r = 0; r < p.u.size(); ++r) p.x[r] += 0.25 * p.u[r];
  }
  return p;
}

/// Largest |a - b| relative to the largest |b|.
double deviation(const Values &a, const Values &b)
{
  double most = 0.0, worst = a.size() == b.size() ? 0.0 : 1e300;
  for (std::size_t i = 0; i < b.size() && i < a.size(); ++i) {
    most = std::max(most, std::fabs(b[i]));
    worst = std::max(worst, std::fabs(a[i] - b[i]));
  }
  return worst / most;
}

}    // namespace

TEST(YamlValues, PseIsTheDenseMobility)
{
  const Path dense = eight_steps(1.0);
  EXPECT_LT(deviation(block("fix-timestep-bd_pse.yaml", "run_vel"), dense.u), 1e-9);
  EXPECT_LT(deviation(block("fix-timestep-bd_pse.yaml", "run_pos"), dense.x), 1e-11);
}

// Immersed-boundary particles behave like RPY spheres of the kernel's radius within 3 %, and not
// like those of another radius.
TEST(YamlValues, FibIsCloseToTheDenseMobility)
{
  const Values u = block("fix-timestep-bd_fib.yaml", "run_vel");
  EXPECT_LT(deviation(u, eight_steps(1.2544).u), 0.03);
  EXPECT_GT(deviation(u, eight_steps(1.0).u), 0.05);
}
