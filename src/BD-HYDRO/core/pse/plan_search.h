// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The plan of positively split Ewald for a scene: with the splitting that the user gives, or the
/// cheapest one.
#ifndef BDH_PSE_PLAN_SEARCH_H
#define BDH_PSE_PLAN_SEARCH_H

#include "pse/plan.h"
#include "pse/planner.h"

namespace bdh {

/// The plan with scene.xi.  Throws InvalidOption if that is out of range, does not reach the
/// tolerance, or exceeds a limit.  planner: of this scene.
PsePlan plan_for_given_splitting(const PseScene &scene, const Planner &planner);

/// The cheapest plan whose estimated error is at most the tolerance, within the limits.  Throws
/// InvalidOption if there is none.  planner: of this scene.
PsePlan cheapest_plan(const PseScene &scene, const Planner &planner);

}    // namespace bdh
#endif
