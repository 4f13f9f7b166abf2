// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The reference cases of the immersed-boundary mobility, run through LAMMPS.
#ifndef BDH_TEST_LAMMPS_FIB_REFERENCE_H
#define BDH_TEST_LAMMPS_FIB_REFERENCE_H

#include "lammps/lammps_session.h"
#include "support/reference_json.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace bdh_test {

/// Keywords such as " wall zlo noslip wall zhi slip", and the boundary command that fits them.
inline std::string wall_keywords(const nlohmann::json &bc, std::string &boundary)
{
  std::string walls;
  boundary = "boundary";
  for (std::size_t d = 0; d < 3; ++d) {
    const std::string kind = d < bc.size() ? bc[d].get<std::string>() : "p";
    boundary += kind == "p" ? " p" : " f";
    for (std::size_t side = 0; kind != "p" && side < 2; ++side)
      walls += std::string(" wall ") + "xyz"[d] + (side ? "hi " : "lo ") +
               (kind[side] == 'n'   ? "noslip"
                : kind[side] == 's' ? "slip"
                                    : "open");
  }
  return walls;
}

/// Velocities of the particles of one case.  fix addforce applies the forces, with one group per
/// particle.
inline std::vector<double> velocities_of(const nlohmann::json &c, double timestep,
                                         const std::string &keywords)
{
  const int dim = c["n"].size();
  LammpsSession lmp;
  std::string boundary;
  const std::string walls = wall_keywords(c["bc"], boundary);
  lmp.commands({"units lj", "dimension " + std::to_string(dim), boundary, "atom_style atomic",
                "atom_modify map array"});
  std::string box = "region box block";
  for (int d = 0; d < 3; ++d) box += d < dim ? " 0 " + text(c["L"][d].get<double>()) : " -0.5 0.5";
  lmp.commands({box, "create_box 1 box", "mass 1 1.0"});
  for (size_t i = 0; i < c["x"].size(); ++i) {
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
  if (dim == 2) lmp.command("fix flat all enforce2d");
  lmp.command("fix move all bd/fib 0.0 " + text(c["eta"].get<double>()) + " 1" + grid + " kernel " +
              (c["kernel"].get<int>() == 3 ? "roma3" : "peskin4") + walls + " " + keywords);
  lmp.commands({"timestep " + text(timestep), "run 1"});
  return lmp.velocities();
}

/// Largest deviation of the velocities v from those of the case, relative to its largest velocity.
inline double deviation(const nlohmann::json &c, const std::vector<double> &v)
{
  double largest = 0.0, worst = 0.0;
  for (size_t i = 0; i < c["u"].size(); ++i)
    for (size_t d = 0; d < c["u"][i].size(); ++d) {
      const double u = c["u"][i][d].get<double>();
      largest = std::max(largest, std::fabs(u));
      worst = std::max(worst, std::fabs(v[3 * i + d] - u));
    }
  return worst / largest;
}

}    // namespace bdh_test
#endif
