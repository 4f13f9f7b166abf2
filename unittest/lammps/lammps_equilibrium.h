// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The suspension of FIB Table II samples the Gibbs-Boltzmann distribution: g(r), energy and
/// pressure are compared with Monte Carlo.
#ifndef BDH_TEST_LAMMPS_EQUILIBRIUM_H
#define BDH_TEST_LAMMPS_EQUILIBRIUM_H

#include "lammps/lammps_session.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace bdh_test {
namespace equilibrium {

constexpr double L = 32.0, kT = 1e-3, sigma = 2.0, width = 0.04, first = 1.8, last = 4.0;
constexpr int bins = 55;

/// Monte Carlo g(r) and its standard error in the same bins.
struct Reference {
  std::vector<double> g, error;
};

inline Reference monte_carlo(const std::string &file)
{
  std::ifstream in(std::string(BDH_REFERENCE_DIR) + "/" + file);
  Reference ref{std::vector<double>(bins), std::vector<double>(bins)};
  for (std::string line; std::getline(in, line);) {
    double r, g, e;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf", &r, &g, &e) != 3) continue;
    const int b = std::floor((r - first) / width);
    if (b < 0 || b >= bins) continue;
    ref.g[b] = g;
    ref.error[b] = e;
  }
  return ref;
}

inline std::vector<double> histogram(const std::vector<double> &x)
{
  std::vector<double> h(bins, 0.0);
  const size_t n = x.size() / 3;
  for (size_t i = 0; i < n; ++i)
    for (size_t j = 0; j < i; ++j) {
      double r2 = 0.0;
      for (int d = 0; d < 3; ++d) {
        double s = x[3 * i + d] - x[3 * j + d];
        s -= L * std::nearbyint(s / L);
        r2 += s * s;
      }
      if (r2 >= last * last || r2 < first * first) continue;
      h[(std::sqrt(r2) - first) / width] += 1.0;
    }
  const double pairs = 0.5 * n * (n - 1);
  for (int b = 0; b < bins; ++b) {
    const double lo = first + b * width, hi = lo + width;
    h[b] /= pairs * 4.0 / 3.0 * M_PI * (hi * hi * hi - lo * lo * lo) / (L * L * L);
  }
  return h;
}

struct Mean {
  double value, error;
};

/// Mean and standard error from block averages.
inline Mean block_mean(const std::vector<double> &blocks)
{
  double m = 0.0, v = 0.0;
  for (double b : blocks) m += b / blocks.size();
  for (double b : blocks) v += (b - m) * (b - m);
  const double n = blocks.size();
  return {m, std::sqrt(v / (n - 1.0) / n)};
}

// Errors come from 20 blocks, so ratios follow Student's t with 19 degrees of freedom.  |t| > 7 has
// probability 1.2e-6, or 7e-5 over 57 comparisons.  The sum of 54 squares has mean 60 and standard
// deviation 14, since neighbouring bins are nearly independent; 140 is more than 5 standard
// deviations above.  A temperature wrong by 3 % or a missing thermal drift fails.
constexpr double bound = 7.0;

/// move: fix command that moves the atoms, for kT = 0.001; dt: time step; steps: time steps between
/// samples; samples: number of samples in each of 20 blocks
inline void expect_monte_carlo(int atoms, const std::string &move, double dt, int equilibrate,
                               int every, int samples, const std::string &file, Mean energy_mc,
                               Mean z_mc)
{
  LammpsSession lmp;
  const int side = std::ceil(std::cbrt(atoms));
  lmp.script("units lj\natom_style atomic\natom_modify map array\nboundary p p p\nregion box block "
             "0 32 0 32 0 32\n"
             "create_box 1 box\nmass 1 1.0");
  for (int i = 0; i < atoms; ++i) {
    // Takes every (side^3/atoms)-th site of a simple cubic lattice, which spreads the vacancies.
    const long site = static_cast<long>(i) * side * side * side / atoms;
    const double x[3] = {L / side * (site % side), L / side * (site / side % side),
                         L / side * (site / side / side)};
    lmp.create_atom(x);
  }
  lmp.script(
      "pair_style lj/cut 2.244924096618746\npair_coeff 1 1 0.001 2.0\npair_modify shift yes\n"
      "neighbor 0.5 bin\nneigh_modify every 1 delay 0 check yes\ncompute virial all pressure NULL "
      "virial\n"
      "compute energy all pe\n"
      "fix mean all ave/time 5 1 5 c_virial c_energy ave running\n" +
      move);
  // Long steps melt the lattice but bias the structure by a per cent; short ones remove the bias.
  lmp.script("timestep 20.0\nrun " + std::to_string(equilibrate));
  lmp.script("timestep " + std::to_string(dt) + "\nrun 1000");

  std::vector<std::vector<double>> g(20, std::vector<double>(bins, 0.0));
  std::vector<double> energy, z;
  for (int block = 0; block < 20; ++block) {
    lmp.script("unfix mean\nfix mean all ave/time 5 1 5 c_virial c_energy ave running");
    for (int s = 0; s < samples; ++s) {
      lmp.command("run " + std::to_string(every));
      const auto h = histogram(lmp.unwrapped_positions());
      for (int b = 0; b < bins; ++b) g[block][b] += h[b] / samples;
    }
    z.push_back(1.0 + lmp.fix("mean")->compute_vector(0) * L * L * L / (atoms * kT));
    energy.push_back(lmp.fix("mean")->compute_vector(1) / (kT * atoms));
  }

  const Reference mc = monte_carlo(file);
  double chi2 = 0.0;
  for (int b = 0; b < bins; ++b) {
    std::vector<double> blocks;
    for (const auto &one : g) blocks.push_back(one[b]);
    const Mean m = block_mean(blocks);
    const double error = std::hypot(m.error, mc.error[b]);
    if (mc.g[b] < 1e-2) continue;    // too few counts inside the core for a standard error
    const double t = (m.value - mc.g[b]) / error;
    chi2 += t * t;
    EXPECT_LT(std::fabs(t), bound)
        << "r = " << first + (b + 0.5) * width << ": " << m.value << " +- " << m.error
        << ", Monte Carlo " << mc.g[b] << " +- " << mc.error[b];
  }
  EXPECT_LT(chi2, 140.0);
  const Mean e = block_mean(energy), p = block_mean(z);
  std::printf("chi2 %.1f; energy/NkT %.5f +- %.5f (Monte Carlo %.5f); PV/NkT %.4f +- %.4f (%.4f)\n",
              chi2, e.value, e.error, energy_mc.value, p.value, p.error, z_mc.value);
  EXPECT_LT(std::fabs(e.value - energy_mc.value) / std::hypot(e.error, energy_mc.error), bound)
      << e.value;
  EXPECT_LT(std::fabs(p.value - z_mc.value) / std::hypot(p.error, z_mc.error), bound) << p.value;
}

}    // namespace equilibrium
}    // namespace bdh_test
#endif
