/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_pse_planning.h"

#include "base/errors.h"
#include "comm.h"
#include "error.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

namespace {

/// True for a plan or a scene that has the least and the greatest radius of another scene.
template <class Plan> bool has_range_of(const Plan &plan, const bdh::PseScene &now)
{
  return std::fabs(plan.radius - now.radius) <= 1e-10 * now.radius &&
         std::fabs(plan.least_radius - now.least_radius) <= 1e-10 * now.radius &&
         plan.rotation == now.rotation && plan.stresslets == now.stresslets;
}

bool has_radii_of(const bdh::PseScene &then, const bdh::PseScene &now)
{
  return has_range_of(then, now) && then.classes.are_two() == now.classes.are_two();
}

bigint share_of(bigint particles, double factor) { return factor * particles; }

}    // namespace

/// True if the plan keeps the tolerance in the scene, and may be about the cheapest.
bool PsePlanning::serves(const bdh::PseScene &now) const
{
  const bdh::PseScene &then = made_for();
  const bool same_options = then.tolerance == now.tolerance && then.xi == now.xi &&
                            then.hydrodynamics == now.hydrodynamics &&
                            then.substeps == now.substeps && then.precision == now.precision &&
                            then.noise == now.noise;
  if (!same_options || !has_radii_of(then, now)) return false;
  if (!now.hydrodynamics) return true;
  const bool is_near =
      is_within(wide, then.particles, now.particles) && is_within(wide, then.volume, now.volume);
  return (options_.xi > 0.0 || is_near) && keeps_tolerance(now);
}

Radii PsePlanning::planned_radii() const
{
  return {made_for().least_radius, made_for().radius, made_for().mean_cube, made_for().classes};
}

/// True if the plan keeps the tolerance in the scene, whatever it costs.
bool PsePlanning::keeps_tolerance(const bdh::PseScene &now) const
{
  if (!has_range_of(plan(), now) || !now_.has_ghosts_up_to(plan().r_cut)) return false;
  bdh::PseScene present = now;
  present.radius = plan().radius;
  present.least_radius = plan().least_radius;
  return bdh::pse_plan_holds(plan(), present);
}

void PsePlanning::adopt(const bdh::PsePlan &plan, const bdh::PseScene &now)
{
  made_.plan = plan;
  made_.made_for = now;
  made_.made_for.xi = options_.xi;
  made_.narrow = false;
  planned_ = true;
  restored_ = false;
}

/// From now on the scene is that of this plan, with about so many particles.
void PsePlanning::watch(bigint particles)
{
  if (options_.radius == 0.0) {
    const bdh::PseScene &then = made_for();
    scene_.radii = {then.least_radius, then.radius, then.classes.are_two()};
  }
  known_ = now_.cell();
  const bigint planned = made_for().particles;
  const auto serves_for = [&](double factor) {
    return serves(now_.scene_of(share_of(planned, factor), planned_radii()));
  };
  double most = wide, fewest = 1.0 / wide;
  while (most > 1.0 && !serves_for(most)) most = most > 1.1 ? 0.5 * (1.0 + most) : 1.0;
  while (fewest < 1.0 && !serves_for(fewest)) fewest = fewest < 0.9 ? 0.5 * (1.0 + fewest) : 1.0;
  scene_.most = MAX(share_of(planned, most), particles);
  scene_.fewest = MIN(share_of(planned, fewest), particles);
}

bool PsePlanning::prepare()
{
  const bigint particles = now_.count();
  const Radii radii = now_.radii(particles);
  if (!radii.any()) return false;
  const bdh::PseScene now = now_.scene_of(particles, radii);
  const bool make = !planned_ || made_.narrow || !serves(now);
  if (make) {
    const bool has_price = options_.split && options_.xi == 0.0;
    adopt(search_.cheapest(now, has_price ? &made_.split_price : nullptr), now);
    if (comm->me == 0) report_.warn(plan());
  }
  logged_radius_ = radii.greatest;
  watch(particles);
  return make;
}

bool PsePlanning::follow(double reach)
{
  const bigint particles = now_.count();
  const Radii radii = now_.radii(particles);
  if (!radii.any()) {
    scene_.fewest = 0;    // the plan stays for those that may come
    return false;
  }
  const bdh::PseScene now = now_.scene_of(particles, radii);
  if (planned_ && serves(now)) {
    watch(particles);
    return false;
  }
  const std::string change = change_since_planning(now);
  const bool is_first = !planned_;
  const bool make = replace(now, reach);
  watch(particles);
  if (!make) {
    scene_.fewest = particles / 2;
    scene_.most = 2 * particles;
  } else if (!change.empty()) {
    logged_radius_ = radii.greatest;
    if (comm->me == 0) report_.log_change(plan(), is_first, change);
  }
  return make;
}

/// Collective.  Within a run another plan can only use the pairs of the neighbor list.  False if
/// there is none, but the old plan still keeps the tolerance.
bool PsePlanning::replace(const bdh::PseScene &now, double reach)
{
  bdh::PseScene within_reach = now;
  within_reach.largest_cutoff = now.largest_cutoff > 0.0 ? MIN(now.largest_cutoff, reach) : reach;
  try {
    adopt(search_.again(planned_ ? &made_ : nullptr, within_reach), now);
  } catch (const bdh::InvalidOption &e) {
    if (!planned_ || !keeps_tolerance(now))
      error->all(FLERR,
                 "{}: step {}: {}; within this run pairs are known only up to a distance of "
                 "{:.6g}: begin another run here, whose neighbor list can reach further",
                 name_, update->ntimestep, e.what(), reach);
    return false;
  }
  const bool is_soft = !options_.split || bdh::pse_far_stiffness(plan(), options_.substeps) <= 1.0;
  made_.narrow = plan().hydrodynamics && (plan().limit == bdh::PseLimit::cutoff || !is_soft ||
                                          (options_.xi > 0.0 && plan().xi != options_.xi));
  if (comm->me == 0 && made_.narrow) report_.warn(plan());
  return true;
}

/// The reason for another plan.  It is empty if the radius alone has changed, and the log has
/// already shown about the same.
std::string PsePlanning::change_since_planning(const bdh::PseScene &now) const
{
  if (!planned_) return "the group has its first particles";
  if (now.particles != made_for().particles)
    return fmt::format("the group has {} particles instead of {}", now.particles,
                       made_for().particles);
  if (!has_radii_of(made_for(), now)) {
    const auto equal = [](const bdh::PseScene &s) { return s.least_radius == s.radius; };
    const bool alike = equal(now) == equal(made_for());
    if (alike && is_within(1.1, logged_radius_, now.radius)) return "";
    return equal(now) && alike ? "the radius has changed" : "the radii have changed";
  }
  return fmt::format("the volume is {:.6g} instead of {:.6g}", now.volume, made_for().volume);
}

bool PsePlanning::fits_box()
{
  const bdh::Cell now = now_.cell();
  bool is_known = is_within(1.01, now.volume(), known_.volume());
  for (int d = 0; d < 3; ++d) is_known = is_known && is_within(1.01, now.edge(d), known_.edge(d));
  if (is_known) return now_.has_ghosts_up_to(plan().r_cut);
  if (!serves(now_.scene_of(made_for().particles, planned_radii()))) return false;
  known_ = now;
  return true;
}

std::vector<char> PsePlanning::save() const
{
  return planned_ ? bytes_of(made_) : std::vector<char>();
}

void PsePlanning::restore(const char *bytes, std::size_t size)
{
  if (!from_bytes(bytes, size, made_)) {
    if (size > 0 && comm->me == 0)
      error->warning(FLERR,
                     "{}: the restart file has a plan of another version of BD-HYDRO: a new plan "
                     "is made, so the run does not go on with the same numbers",
                     name_);
    return;
  }
  search_.remember(made_for());
  planned_ = restored_ = true;
}

void PsePlanning::describe(PlanText &text, const std::string &ghosts, double grid) const
{
  if (planned_)
    report_.describe(text, plan(), {restored_, made_.split_price, ghosts, grid});
  else
    report_.describe_waiting(text);
}
