// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// How the radii of particles are distributed, as far as plans need to know.
#ifndef BDH_PSE_RADII_H
#define BDH_PSE_RADII_H

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <vector>

namespace bdh {

/// Classes have the same width in the logarithm of the radius, from the least to the greatest one.
constexpr int radius_classes = 4;

/// Radii within this relative distance are the same.
constexpr double same_radius = 1e-10;

/// Numbers of particles by class.  Several ranks add up their numbers, and take the greatest radius
/// of all.
struct RadiusClasses {
  std::array<double, radius_classes> count{};       ///< all 0: not known
  std::array<double, radius_classes> greatest{};    ///< radius of each class [length]
  double between = 0.0;    ///< particles whose radius is neither the least nor the greatest one

  /// All members, to compare and to store them: an incomplete list does not compile.
  template <class Classes> static auto members(Classes &c)
  {
    auto &[count, greatest, between] = c;
    return std::tie(count, greatest, between);
  }
  friend bool operator==(const RadiusClasses &a, const RadiusClasses &b)
  {
    return members(a) == members(b);
  }

  double all() const { return std::accumulate(count.begin(), count.end(), 0.0); }
  /// True if there are two radii, and no others.
  bool are_two() const { return all() > 0.0 && between == 0.0; }
  /// Counts a particle of radius a; least and most: of all particles, least < most [length].
  void add(double a, double least, double most)
  {
    const double place = radius_classes * std::log(a / least) / std::log(most / least);
    const int k = std::clamp(static_cast<int>(place), 0, radius_classes - 1);
    count[k] += 1.0;
    greatest[k] = std::max(greatest[k], a);
    if (a > least * (1.0 + same_radius) && a < most * (1.0 - same_radius)) between += 1.0;
  }
};

/// Particles of about one radius.
struct RadiusClass {
  double radius;    ///< the greatest [length]
  double share;     ///< of all particles
};

/// The classes that have particles, by radius.  Those that were not counted are all of the greatest
/// radius.
inline std::vector<RadiusClass> classes_of(const RadiusClasses &c, double greatest)
{
  const double all = c.all();
  if (!(all > 0.0)) return {{greatest, 1.0}};
  std::vector<RadiusClass> used;
  for (int k = 0; k < radius_classes; ++k)
    if (c.count[k] > 0.0) used.push_back({c.greatest[k], c.count[k] / all});
  return used;
}

}    // namespace bdh
#endif
