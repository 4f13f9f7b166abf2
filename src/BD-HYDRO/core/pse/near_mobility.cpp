// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/near_mobility.h"

namespace bdh {

double whole_noise(const PsePlan &plan, double volume)
{
  return std::sqrt(periodic_self_mobility(plan.radius, volume));
}

LanczosOptions root_options(const PsePlan &plan, double volume, int limit)
{
  return {0.7 * plan.root_tolerance * whole_noise(plan, volume), limit, plan.tolerance};
}

}    // namespace bdh
