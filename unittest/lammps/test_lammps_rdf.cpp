// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/fib: g(r), energy and pressure of suspensions compared with Monte Carlo.

#include "lammps/lammps_equilibrium.h"

using bdh_test::equilibrium::expect_monte_carlo;

namespace {

const std::string move =
    "fix move all bd/fib 0.001 1.0 7 grid 32 32 32 kernel roma3 fft estimate scheme ";

}    // namespace

// Z and the energy combine the results of two independent Monte Carlo programs.
TEST(LammpsSuspension, Dilute)
{
  expect_monte_carlo(1000, move + "midpoint", 20.0, 3000, 40, 16, "rdf_wca_N1000.csv",
                     {0.08185, 2.0e-4}, {1.7694, 0.0015});
}

TEST(LammpsSuspension, Dense)
{
  expect_monte_carlo(3300, move + "improved", 5.0, 5000, 40, 5, "rdf_wca_N3300.csv",
                     {0.84179, 4.3e-4}, {8.3941, 0.0029});
}
