// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// U = M F from LAMMPS after one step at temperature 0, compared with the independent reference
// cases.

#include "lammps/lammps_fib_reference.h"

#include <gtest/gtest.h>

namespace {

// The bound is 1e-12 of the largest velocity, which allows for a few hundred rounding errors in
// transforms and sums and is well above the observed 1e-15.
void expect_reference_velocities(const std::string &keywords)
{
  const nlohmann::json all = bdh_test::json_reference("fib_periodic.json");
  EXPECT_EQ(all["cases"].size(), 11u);
  for (const auto &c : all["cases"])
    EXPECT_LT(bdh_test::deviation(c, bdh_test::velocities_of(c, 0.1, keywords)), 1e-12) << c["id"];
}

}    // namespace

TEST(LammpsMobility, OneStepAtTemperatureZeroReadsOutMF) { expect_reference_velocities(""); }

TEST(LammpsMobility, AlsoWithEuler) { expect_reference_velocities("scheme euler fft estimate"); }
