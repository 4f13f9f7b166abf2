/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_pse_plan_search.h"

#include "base/errors.h"

using namespace LAMMPS_NS;

/// While radii grow or shrink, another splitting is searched for after changes by this factor.
static constexpr double wide_radius = 1.25;

bdh::PsePlan PsePlanSearch::plan_for(const bdh::PseScene &now, double *split_price) const
{
  if (!now.hydrodynamics) return bdh::plan_pse(now);
  const bdh::PseConditions conditions = now_.conditions(now.radius);
  const bdh::PsePlan plan = bdh::plan_pse(now, conditions);
  if (split_price) *split_price = bdh::pse_split_price(plan, now, conditions);
  return plan;
}

bdh::PsePlan PsePlanSearch::cheapest(const bdh::PseScene &now, double *split_price)
{
  const bdh::PsePlan plan = plan_for(now, split_price);
  searched_ = now;
  return plan;
}

/// True while the splitting of the last search may still be about the cheapest.
bool PsePlanSearch::is_like_last(const PseRestart *in_use, const bdh::PseScene &now) const
{
  return in_use && now.particles == in_use->made_for.particles &&
         is_within(wide_radius, searched_.radius, now.radius) &&
         is_within(wide, searched_.volume, now.volume);
}

bdh::PsePlan PsePlanSearch::again(const PseRestart *in_use, bdh::PseScene now)
{
  const bool is_like = is_like_last(in_use, now);
  if (is_like && (options_.xi == 0.0 || in_use->plan.xi == options_.xi)) {
    bdh::PsePlan changed = in_use->plan;
    if (bdh::change_radius(changed, now)) return changed;
  }
  if (options_.xi > 0.0) {
    try {
      return cheapest(now, nullptr);
    } catch (const bdh::InvalidOption &) {
      now.xi = 0.0;
    }
  } else if (is_like) {
    try {
      bdh::PseScene same_splitting = now;
      same_splitting.xi = in_use->plan.xi;
      same_splitting.splitting = in_use->plan.splitting;
      return plan_for(same_splitting);
    } catch (const bdh::InvalidOption &) {
    }
  }
  searched_ = now;
  try {
    return plan_for(now);
  } catch (const bdh::InvalidOption &) {
    if (now.substeps == 0) throw;
  }
  // Soft far steps of scheme split need pairs that the list does not have.  An accurate mobility is
  // more important.
  now.substeps = 0;
  return plan_for(now);
}
