// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/recent_plans.h"

#include <tuple>

namespace bdh {

namespace {

/// All members: an incomplete list does not compile.
auto members(const PseConditions &c)
{
  const auto &[counts, skin, cutoff_reason, most_neighbors, memory] = c;
  const auto &[radii, mean, crowded, largest] = counts;
  return std::tie(radii, mean, crowded, largest, skin, cutoff_reason, most_neighbors, memory);
}

}    // namespace

const PsePlan *RecentPlans::find(const PseScene &scene, const PseConditions &conditions) const
{
  for (const Entry &e : entries_)
    if (PseScene::members(e.scene) == PseScene::members(scene) &&
        members(e.conditions) == members(conditions))
      return &e.plan;
  return nullptr;
}

void RecentPlans::add(const PseScene &scene, const PseConditions &conditions, const PsePlan &plan)
{
  entries_.push_front({scene, conditions, plan});
  if (entries_.size() > most) entries_.pop_back();
}

}    // namespace bdh
