// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The plans that were made last, for scripts that come back to a scene.
#ifndef BDH_PSE_RECENT_PLANS_H
#define BDH_PSE_RECENT_PLANS_H

#include "pse/plan.h"

#include <deque>

namespace bdh {

/// Keeps the last plans with what they were made for.  A script that runs many short trajectories
/// from one start, with the command clear between them, asks for the same plan again and again, and
/// a search takes tenths of a second.
class RecentPlans {
 public:
  /// The plan that a search would find now, or null if it is not known.
  const PsePlan *find(const PseScene &scene, const PseConditions &conditions) const;
  void add(const PseScene &scene, const PseConditions &conditions, const PsePlan &plan);

 private:
  static constexpr std::size_t most = 8;
  struct Entry {
    PseScene scene;
    PseConditions conditions;
    PsePlan plan;
  };
  std::deque<Entry> entries_;    // the newest first
};

}    // namespace bdh
#endif
