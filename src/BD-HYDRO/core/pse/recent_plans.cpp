// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/recent_plans.h"

#include <tuple>

namespace bdh {

namespace {

bool are_equal(const PseScene &a, const PseScene &b)
{
  const auto all = [](const PseScene &s) {
    return std::tie(s.volume, s.edge, s.particles, s.radius, s.least_radius, s.mean_cube,
                    s.classes.count, s.classes.greatest, s.classes.between, s.rotation,
                    s.stresslets, s.noise, s.hydrodynamics, s.tolerance, s.xi, s.splitting,
                    s.substeps, s.largest_cutoff, s.precision);
  };
  return all(a) == all(b);
}

/// Except for the memory, which is never twice the same.
bool are_equal(const PseConditions &a, const PseConditions &b)
{
  const auto all = [](const PseConditions &c) {
    return std::tie(c.counts.radii, c.counts.mean, c.counts.crowded, c.counts.largest, c.skin,
                    c.cutoff_reason, c.most_neighbors);
  };
  return all(a) == all(b);
}

/// The cheapest plan still is when there is more memory or less, as long as it fits.  One that the
/// memory has limited may not be.
bool fits(const PsePlan &plan, double memory)
{
  return plan.limit != PseLimit::memory &&
         (memory == 0.0 || plan.grid_bytes + plan.pair_bytes <= memory);
}

}    // namespace

const PsePlan *RecentPlans::find(const PseScene &scene, const PseConditions &conditions) const
{
  for (const Entry &e : entries_)
    if (are_equal(e.scene, scene) && are_equal(e.conditions, conditions))
      return fits(e.plan, conditions.memory) ? &e.plan : nullptr;
  return nullptr;
}

void RecentPlans::add(const PseScene &scene, const PseConditions &conditions, const PsePlan &plan)
{
  entries_.push_front({scene, conditions, plan});
  if (entries_.size() > most) entries_.pop_back();
}

}    // namespace bdh
