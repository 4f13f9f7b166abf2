// U = M F read out of LAMMPS after one step at temperature 0, against the independent reference cases.

#include "lammps_session.h"

#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using bdh_test::LammpsSession;
using bdh_test::text;

namespace {

nlohmann::json cases()
{
  std::ifstream in(std::string(BDH_REFERENCE_DIR) + "/fib_periodic.json");
  return nlohmann::json::parse(in)["cases"];
}

/// Velocities of the particles of one case, forces given by fix addforce, one group per particle.
std::vector<double> velocities_of(const nlohmann::json &c, const std::string &keywords)
{
  const int dim = static_cast<int>(c["n"].size());
  LammpsSession lmp;
  lmp.commands({"units lj", "dimension " + std::to_string(dim), "boundary p p p", "atom_style atomic",
                "atom_modify map array"});
  std::string box = "region box block";
  for (int d = 0; d < 3; ++d) box += d < dim ? " 0 " + text(c["L"][d].get<double>()) : " -0.5 0.5";
  lmp.commands({box, "create_box 1 box", "mass 1 1.0"});
  const size_t count = c["x"].size();
  for (size_t i = 0; i < count; ++i) {
    double x[3] = {0.0, 0.0, 0.0};
    for (int d = 0; d < dim; ++d) {
      const double L = c["L"][d].get<double>();
      x[d] = c["x"][i][d].get<double>();
      x[d] -= L * std::floor(x[d] / L);
    }
    lmp.create_atom(x);
    const std::string id = std::to_string(i + 1);
    std::string add = "fix force" + id + " g" + id + " addforce";
    for (int d = 0; d < 3; ++d) add += " " + text(d < dim ? c["f"][i][d].get<double>() : 0.0);
    lmp.commands({"group g" + id + " id " + id, add});
  }
  std::string grid = " grid";
  for (int d = 0; d < 3; ++d) grid += " " + std::to_string(d < dim ? c["n"][d].get<int>() : 1);
  const std::string kernel = c["kernel"].get<int>() == 3 ? "roma3" : "peskin4";
  if (dim == 2) lmp.command("fix flat all enforce2d");
  lmp.command("fix move all bd/fib 0.0 " + text(c["eta"].get<double>()) + " 1" + grid + " kernel " + kernel + " " +
              keywords);
  lmp.commands({"timestep 0.1", "run 1"});
  return lmp.velocities();
}

// 1e-12 of the largest velocity: a few hundred roundings in transforms and sums, well above what is seen (1e-15).
void expect_reference_velocities(const std::string &keywords)
{
  for (const auto &c : cases()) {
    const std::vector<double> v = velocities_of(c, keywords);
    double largest = 0.0, worst = 0.0;
    for (size_t i = 0; i < c["u"].size(); ++i)
      for (size_t d = 0; d < c["u"][i].size(); ++d) {
        const double u = c["u"][i][d].get<double>();
        largest = std::max(largest, std::fabs(u));
        worst = std::max(worst, std::fabs(v[3 * i + d] - u));
      }
    EXPECT_LT(worst, 1e-12 * largest) << c["id"];
  }
}

}    // namespace

TEST(LammpsMobility, OneStepAtTemperatureZeroReadsOutMF) { expect_reference_velocities(""); }

TEST(LammpsMobility, AlsoWithEuler) { expect_reference_velocities("scheme euler fft estimate"); }
