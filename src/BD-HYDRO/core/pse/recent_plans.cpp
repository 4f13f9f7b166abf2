// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/recent_plans.h"

#include <tuple>

namespace bdh {

namespace {

// The lists of members must be complete, or else these do not compile.

auto members(const RadiusClasses &c)
{
  const auto &[count, greatest, between] = c;
  return std::tie(count, greatest, between);
}

auto members(const PseScene &s)
{
  const auto &[volume, edge, particles, radius, least_radius, mean_cube, classes, rotation,
               stresslets, noise, hydrodynamics, tolerance, xi, splitting, substeps, cutoff,
               precision] = s;
  return std::tuple_cat(std::tie(volume, edge, particles, radius, least_radius, mean_cube),
                        members(classes),
                        std::tie(rotation, stresslets, noise, hydrodynamics, tolerance, xi,
                                 splitting, substeps, cutoff, precision));
}

auto members(const PairCounts &c)
{
  const auto &[radii, mean, crowded, largest] = c;
  return std::tie(radii, mean, crowded, largest);
}

auto members(const PseConditions &c)
{
  const auto &[counts, skin, cutoff_reason, most_neighbors, memory] = c;
  return std::tuple_cat(members(counts), std::tie(skin, cutoff_reason, most_neighbors, memory));
}

}    // namespace

const PsePlan *RecentPlans::find(const PseScene &scene, const PseConditions &conditions) const
{
  for (const Entry &e : entries_)
    if (members(e.scene) == members(scene) && members(e.conditions) == members(conditions))
      return &e.plan;
  return nullptr;
}

void RecentPlans::add(const PseScene &scene, const PseConditions &conditions, const PsePlan &plan)
{
  entries_.push_front({scene, conditions, plan});
  if (entries_.size() > most) entries_.pop_back();
}

}    // namespace bdh
