// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Positively split Ewald for spheres of any radii, with and without rotation, compared with
// independent references.

#include "pse/sphere_support.h"
#include "support/reference_json.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

using namespace bdh_test;
using bdh::PsePlan;

namespace {

const double tolerances[] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-7, 1e-10};

Spheres spheres_of(const nlohmann::json &c, bool rotation)
{
  return {cell_of(c["box"]), flatten(c["x"]), c["radius"].get<std::vector<double>>(), rotation};
}

}    // namespace

TEST(Spheres, ReferenceCasesOfUnequalRadii)
{
  const auto cases = json_reference("rpy_periodic_poly.json")["cases"];
  for (const auto &c : cases) {
    const Spheres s = spheres_of(c, false);
    for (double tolerance : tolerances) {
      SphereHarness M(s, bdh::plan_pse(s.scene(tolerance)));
      const Motions u = M.apply({flatten(c["f"]), {}}, c["eta"]);
      const double error = relative_error(u.linear, flatten(c["u"]));
      EXPECT_LE(error, tolerance) << c["id"];
      std::printf("%-24s %.0e  ratio %.3f\n", std::string(c["id"]).c_str(), tolerance, error / tolerance);
    }
  }
}

TEST(Spheres, ReferenceCasesOfRotation)
{
  const auto cases = json_reference("rpy_periodic_rot.json")["cases"];
  for (const auto &c : cases) {
    const Spheres s = spheres_of(c, true);
    for (double tolerance : tolerances) {
      SphereHarness M(s, bdh::plan_pse(s.scene(tolerance)));
      const Motions u = M.apply({flatten(c["f"]), flatten(c["torque"])}, c["eta"]);
      const double error = relative_error(u.linear, flatten(c["u"])),
                   angular = relative_error(u.angular, flatten(c["omega"]));
      EXPECT_LE(error, tolerance) << c["id"];
      EXPECT_LE(angular, tolerance) << c["id"];
      std::printf("%-24s %.0e  ratio %.3f %.3f\n", std::string(c["id"]).c_str(), tolerance, error / tolerance, angular / tolerance);
    }
  }
}
