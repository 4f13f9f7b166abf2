// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/pse: displacements have the covariance 2 kT M dt, and suspensions sample the
// Gibbs-Boltzmann distribution.

#include "lammps/lammps_equilibrium.h"
#include "lammps/lammps_mobility.h"

using bdh_test::AtForces;
using bdh_test::LammpsSession;

// 20 000 samples for two atoms that hardly move, since the step is so short.  An entry C_ij of the
// covariance of normal numbers has the standard error sqrt((C_ii C_jj + C_ij^2)/samples).  With 21
// entries and a bound of 5 standard errors the false-alarm rate is 1.2e-5.  At tolerance 1e-3 the
// bias is 0.1 standard errors.  The mean of the six variances, each relative to its own value,
// detects a temperature wrong by 2 %.
TEST(LammpsPseStatistics, CovarianceOfDisplacements)
{
  const double kT = 0.7, viscosity = 1.4, radius = 0.9, dt = 1e-12;
  const int samples = 20000;
  for (const std::string keywords : {"", "parts yes", "precision double xi 0.9"}) {
    LammpsSession lmp;
    bdh::Cell cell;
    cell.lx = 5.0;
    cell.ly = 4.0;
    cell.lz = 6.0;
    cell.xy = 1.3;
    cell.yz = -0.8;
    lmp.script("units lj\natom_style atomic\natom_modify map array\nboundary p p p\n" +
               bdh_test::box_commands(cell) + "mass 1 1.0");
    bdh_test::create_atoms(lmp, {0.1, 0.2, 0.3, 1.6, 0.9, 5.8});
    const auto x = lmp.unwrapped_positions();
    const auto M = bdh::dense_mobility(cell, x.data(), 2, radius, viscosity);
    double product[6][6] = {};
    AtForces sample(lmp, [&](const AtForces::Call &call) {
      if (call.step == 0) return;
      double v[6] = {};
      for (int i = 0; i < call.atoms; ++i)
        for (int d = 0; d < 3; ++d) v[3 * (call.id[i] - 1) + d] = lmp->atom->v[i][d];
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) product[i][j] += v[i] * v[j] / samples;
    });
    lmp.script("fix move all bd/pse " + bdh_test::text(kT) + " " + bdh_test::text(viscosity) +
               " 99 fft estimate radius " + bdh_test::text(radius) + " " + keywords +
               "\ntimestep " + bdh_test::text(dt) + "\nthermo 100000\nrun " +
               std::to_string(samples) + " post no");
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j <= i; ++j) {
        const double scale = 2.0 * kT / dt, exact = scale * M[6 * i + j];
        const double error =
            std::sqrt((scale * M[7 * i] * scale * M[7 * j] + exact * exact) / samples);
        EXPECT_LT(std::fabs(product[i][j] - exact), 5.0 * error)
            << i << " " << j << " " << keywords;
      }
    double mean = 0.0, variance = 0.0;
    for (int i = 0; i < 6; ++i) {
      mean += product[i][i] / (2.0 * kT / dt * M[7 * i]) / 6.0;
      for (int j = 0; j < 6; ++j)
        variance += 2.0 * M[6 * i + j] * M[6 * i + j] / (M[7 * i] * M[7 * j]) / 36.0 / samples;
    }
    EXPECT_NEAR(mean, 1.0, 5.0 * std::sqrt(variance)) << keywords;
  }
}

TEST(LammpsPseStatistics, SuspensionAgainstMonteCarlo)
{
  bdh_test::equilibrium::expect_monte_carlo(
      1000, "fix move all bd/pse 0.001 1.0 7 radius 1.0 tolerance 1e-3 fft estimate", 20.0, 3000,
      20, 12, "rdf_wca_N1000.csv", {0.08185, 2.0e-4}, {1.7694, 0.0015});
}
