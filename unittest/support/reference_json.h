// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Reads the JSON files of unittest/reference.
#ifndef BDH_TEST_REFERENCE_JSON_H
#define BDH_TEST_REFERENCE_JSON_H

#include "grid/cell_kernel.h"

#include "support/json_library.h"

#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace bdh_test {

inline nlohmann::json json_reference(const std::string &file)
{
  std::ifstream in(std::string(BDH_REFERENCE_DIR) + "/" + file);
  if (!in) throw std::runtime_error("cannot read " + file);
  return nlohmann::json::parse(in);
}

/// All numbers, row by row.
inline std::vector<double> flatten(const nlohmann::json &rows)
{
  std::vector<double> v;
  for (const auto &row : rows)
    for (const auto &value : row) v.push_back(value.get<double>());
  return v;
}

/// n rows of 2 or 3 coordinates as 3 n numbers.
inline std::vector<double> flatten_to_3d(const nlohmann::json &rows)
{
  std::vector<double> v;
  for (const auto &row : rows)
    for (std::size_t d = 0; d < 3; ++d) v.push_back(d < row.size() ? row[d].get<double>() : 0.0);
  return v;
}

/// The box of a case of rpy_periodic.json.
inline bdh::Cell cell_of(const nlohmann::json &box)
{
  bdh::Cell c;
  c.lx = box["Lx"];
  c.ly = box["Ly"];
  c.lz = box["Lz"];
  c.xy = box.value("xy", 0.0);
  c.xz = box.value("xz", 0.0);
  c.yz = box.value("yz", 0.0);
  return c;
}

}    // namespace bdh_test
#endif
