/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_pse_planning.h"

#include "atom.h"
#include "base/errors.h"
#include "bdh_conditions.h"
#include "bdh_lammps.h"
#include "bdh_lammps_classes.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "group.h"
#include "update.h"

#include <cmath>
#include <cstring>
#include <type_traits>

using namespace LAMMPS_NS;

// Per particle, of a user's xi.
static constexpr double many_neighbors = 5000.0;

namespace {

/// A plan serves as long as number of particles and volume are within this factor of those it was
/// made for: it would keep the tolerance, but another one would be cheaper.
constexpr double wide = 2.0;
/// Share of the longest cutoff of a box that may become smaller.
constexpr double room_to_shrink = 0.95;
/// While radii grow or shrink, the splitting is searched again when they have changed this much.
constexpr double wide_radius = 1.25;

bool is_within(double factor, double a, double b) { return a <= factor * b && b <= factor * a; }

/// How stiff a far step is compared with a near one: k mu dt of two touching spheres along their
/// line of centers.
double far_stiffness(const bdh::PsePlan &plan, const bdh::PseOptions &options)
{
  const double share = bdh::pse_far_share(plan.xi * plan.radius);
  return options.substeps * share / (1.0 - share);
}

std::string precision_reason(const bdh::PsePlan &plan, const bdh::PseOptions &options)
{
  if (options.precision != bdh::Precision::automatic) return "as given";
  if (plan.single) return "tolerance 1e-4 or looser";
  return plan.tolerance < 1e-4 ? "tolerance tighter than 1e-4"
                               : "the rounding of so many pairs adds up";
}

/// Who chose it, and what kept the choice from a cheaper one.
std::string splitting_reason(const bdh::PsePlan &plan, const bdh::PseOptions &options,
                             bool restored)
{
  if (options.xi > 0.0 && plan.xi == options.xi) return "as given";
  if (options.xi > 0.0) return "the one given needs pairs beyond the list of the run";
  if (restored) return "of the restart file";
  switch (plan.limit) {
  case bdh::PseLimit::cutoff: return "the cheapest whose pairs LAMMPS knows";
  case bdh::PseLimit::neighbors: return "the cheapest with few enough neighbors";
  case bdh::PseLimit::memory: return "the cheapest that fits into memory";
  case bdh::PseLimit::substeps: return "the cheapest for these substeps";
  case bdh::PseLimit::none: break;
  }
  return options.split ? "the cheapest by the cost model for these substeps"
                       : "the cheapest by the cost model";
}

std::string scheme_text(const bdh::PsePlan &plan, const bdh::PseOptions &options, double dt)
{
  if (!options.split) return "Euler-Maruyama: 1 evaluation of the mobility, forces once a step";
  const int n = options.substeps;
  return fmt::format("split: 1 far step of {:.4g}, then {} near step{} of {:.4g}, forces {} times "
                     "a step; for touching spheres a far step is {:.2g} times as stiff as a near "
                     "one",
                     dt, n, n > 1 ? "s" : "", dt / n, n + 1, far_stiffness(plan, options));
}

/// The longest cutoff in cells of these tilts of either sign [distance]; 0: any.
double shortest_of_tilts(LAMMPS *lmp, bdh::Cell cell)
{
  double shortest = longest_cutoff(lmp, cell);
  for (int flips = 0; flips < 8; ++flips) {
    if (flips & 1) cell.xy = -cell.xy;
    if (flips & 2) cell.xz = -cell.xz;
    if (flips & 4) cell.yz = -cell.yz;
    shortest = MIN(shortest, longest_cutoff(lmp, cell));
  }
  return shortest;
}

}    // namespace

struct PsePlanning::State {
  static constexpr int current = 2;    // to be raised when plans mean something else
  int version;
  bool narrow;
  bdh::PsePlan plan;
  bdh::PseScene made_for;
  double split_price;

  bool is_sound() const
  {
    if (version == current && !plan.hydrodynamics) return plan.radius > 0.0;
    return version == current && plan.radius > 0.0 && plan.xi > 0.0 && std::isfinite(plan.xi) &&
           plan.r_cut > 0.0 && std::isfinite(plan.r_cut) && plan.spacing > 0.0 &&
           plan.window.width >= bdh::Window::least && plan.window.width <= bdh::Window::greatest &&
           plan.n[0] > 0 && plan.n[1] > 0 && plan.n[2] > 0;
  }
};

/// Collective.  Particles of the group.
bigint PsePlanning::count() const
{
  sync_atoms(lmp, Host, MASK_MASK | RADIUS_MASK, EMPTY_MASK);
  return group->count(igroup_);
}

/// Collective.  The radius of all particles, given or of the atoms [distance]; 0 without any.
double PsePlanning::common_radius(bigint particles) const
{
  if (options_.radius > 0.0) return options_.radius;
  if (particles == 0) return 0.0;
  const int bit = group->bitmask[igroup_];
  const std::array<double, 2> range = radius_range(*lmp, bit);
  const double least = range[0], greatest = range[1];
  if (!(least > 0.0))
    error->all(FLERR,
               "{}: atom {} has radius {} at step {}, but must be > 0: use set ... diameter, or "
               "give one radius for all as radius a",
               name_, first_with_radius(*lmp, bit, least), least, update->ntimestep);
  if (greatest - least > 1e-10 * greatest)
    error->all(FLERR,
               "{}: atom {} has radius {} and atom {} has {} at step {}, but the radii of a group "
               "must be equal: set them with set ... diameter, or give one as radius a",
               name_, first_with_radius(*lmp, bit, least), least,
               first_with_radius(*lmp, bit, greatest), greatest, update->ntimestep);
  return greatest;
}

bdh::PseScene PsePlanning::scene_of(bigint particles, double radius) const
{
  bdh::Cell widest = cell_now(*domain);
  if (domain->box_change_shape) {    // the tilts between two flips
    widest.xy = MAX(std::fabs(widest.xy), 0.5 * widest.lx);
    widest.xz = MAX(std::fabs(widest.xz), 0.5 * widest.lx);
    widest.yz = MAX(std::fabs(widest.yz), 0.5 * widest.ly);
  }
  bdh::PseScene s;
  s.volume = widest.volume();
  for (int d = 0; d < 3; ++d) s.edge[d] = widest.edge(d);
  s.particles = MAX(static_cast<bigint>(1), particles);
  s.radius = radius;
  s.noise = solvent_.may_be_hot();
  s.hydrodynamics = options_.hydrodynamics;
  s.tolerance = options_.tolerance;
  s.xi = options_.xi;
  s.substeps = options_.substeps;
  s.precision = options_.precision;
  s.largest_cutoff = shortest_of_tilts(lmp, widest);
  if (domain->box_change_size) s.largest_cutoff *= room_to_shrink;
  return s;
}

/// Collective.
bdh::PsePlan PsePlanning::plan_now(const bdh::PseScene &now, double *split_price) const
{
  if (!now.hydrodynamics) return bdh::plan_pse(now);
  const bdh::PseConditions conditions =
      conditions_now(lmp, group->bitmask[igroup_], now.radius, cell_now(*domain));
  const bdh::PsePlan plan = bdh::plan_pse(now, conditions);
  if (split_price) *split_price = bdh::pse_split_price(plan, now, conditions);
  return plan;
}

/// True if the plan keeps the tolerance in the scene, and may be about the cheapest.
bool PsePlanning::serves(const bdh::PseScene &now) const
{
  const bdh::PseScene &then = made_for_;
  const bool same_options = then.tolerance == now.tolerance && then.xi == now.xi &&
                            then.hydrodynamics == now.hydrodynamics &&
                            then.substeps == now.substeps && then.precision == now.precision &&
                            then.noise == now.noise;
  if (!same_options || std::fabs(then.radius - now.radius) > 1e-10 * now.radius) return false;
  if (!now.hydrodynamics) return true;
  const bool is_near =
      is_within(wide, then.particles, now.particles) && is_within(wide, then.volume, now.volume);
  return (options_.xi > 0.0 || is_near) && keeps_tolerance(now);
}

/// True if the plan would do in the scene, whatever it costs.
bool PsePlanning::keeps_tolerance(const bdh::PseScene &now) const
{
  if (std::fabs(plan_.radius - now.radius) > 1e-10 * now.radius || is_too_long()) return false;
  bdh::PseScene present = now;
  present.radius = plan_.radius;
  return bdh::pse_plan_holds(plan_, present);
}

/// True if LAMMPS no longer keeps ghosts as far as the plan needs them.
bool PsePlanning::is_too_long() const
{
  const double longest = longest_cutoff(lmp, cell_now(*domain));
  return longest > 0.0 && plan_.r_cut > longest;
}

void PsePlanning::adopt(const bdh::PsePlan &plan, const bdh::PseScene &now)
{
  plan_ = plan;
  made_for_ = now;
  made_for_.xi = options_.xi;
  planned_ = true;
  restored_ = narrow_ = false;
}

/// From now on the scene is that of this plan, with about so many particles.
void PsePlanning::watch(bigint particles)
{
  if (options_.radius == 0.0) scene_.radius = made_for_.radius;
  known_ = cell_now(*domain);
  const auto serves_for = [&](double factor) {
    return serves(scene_of(static_cast<bigint>(factor * made_for_.particles), made_for_.radius));
  };
  double most = wide, fewest = 1.0 / wide;
  while (most > 1.0 && !serves_for(most)) most = most > 1.1 ? 0.5 * (1.0 + most) : 1.0;
  while (fewest < 1.0 && !serves_for(fewest)) fewest = fewest < 0.9 ? 0.5 * (1.0 + fewest) : 1.0;
  scene_.most = MAX(static_cast<bigint>(most * made_for_.particles), particles);
  scene_.fewest = MIN(static_cast<bigint>(fewest * made_for_.particles), particles);
}

bool PsePlanning::prepare()
{
  const bigint particles = count();
  const double radius = common_radius(particles);
  if (!(radius > 0.0)) return false;
  const bdh::PseScene now = scene_of(particles, radius);
  const bool make = !planned_ || narrow_ || !serves(now);
  if (make) {
    const bool has_price = options_.split && options_.xi == 0.0;
    adopt(plan_now(now, has_price ? &split_price_ : nullptr), now);
    searched_radius_ = radius;
    if (comm->me == 0 && plan_.hydrodynamics) warn();
  }
  logged_radius_ = radius;
  watch(particles);
  return make;
}

bool PsePlanning::follow(double reach)
{
  const bigint particles = count();
  const double radius = common_radius(particles);
  if (!(radius > 0.0)) {
    scene_.fewest = 0;    // the plan stays for those that may come
    return false;
  }
  const bdh::PseScene now = scene_of(particles, radius);
  const bool make = !planned_ || !serves(now);
  if (make) {
    const std::string change = change_since_planning(now);
    const bool was_planned = planned_;
    bdh::PseScene within_reach = now;
    within_reach.largest_cutoff = now.largest_cutoff > 0.0 ? MIN(now.largest_cutoff, reach) : reach;
    try {
      adopt(search(within_reach), now);
      const bool soft = !options_.split || far_stiffness(plan_, options_) <= 1.0;
      narrow_ = plan_.hydrodynamics && (plan_.limit == bdh::PseLimit::cutoff || !soft ||
                                        (options_.xi > 0.0 && plan_.xi != options_.xi));
      if (comm->me == 0 && narrow_) warn();
    } catch (const bdh::InvalidOption &e) {
      if (was_planned && keeps_tolerance(now)) {    // another one would only have been cheaper
        watch(particles);
        scene_.fewest = particles / 2;
        scene_.most = 2 * particles;
        return false;
      }
      error->all(FLERR,
                 "{}: step {}: {}; within this run pairs are known only up to a distance of "
                 "{:.6g}: begin another run here, whose neighbor list can reach further",
                 name_, update->ntimestep, e.what(), reach);
    }
    if (comm->me == 0 && !change.empty() && !plan_.hydrodynamics)
      utils::logmesg(lmp, "{}: step {}: {}: radius {:.6g}\n", name_, update->ntimestep, change,
                     radius);
    else if (comm->me == 0 && !change.empty())
      utils::logmesg(lmp,
                     "{}: step {}: the plan is made{}, since {}: radius {:.6g}, xi = {:.4g}, "
                     "r_c = {:.4g}, {} x {} x {} points, expected error {:.2g}\n",
                     name_, update->ntimestep, was_planned ? " again" : "", change, radius,
                     plan_.xi, plan_.r_cut, plan_.n[0], plan_.n[1], plan_.n[2],
                     plan_.errors.total());
    if (!change.empty()) logged_radius_ = radius;
  }
  watch(particles);
  return make;
}

/// A search takes 0.1 s: radii that grow step by step keep the splitting for a while.  One that was
/// given is kept as long as its pairs are within the list.
bdh::PsePlan PsePlanning::search(bdh::PseScene now)
{
  if (options_.xi > 0.0) {
    try {
      return plan_now(now);
    } catch (const bdh::InvalidOption &) {
      now.xi = 0.0;
    }
  }
  if (planned_ && options_.xi == 0.0 && is_within(wide_radius, searched_radius_, now.radius) &&
      now.particles == made_for_.particles) {
    try {
      bdh::PseScene same_splitting = now;
      same_splitting.xi = plan_.xi;
      return plan_now(same_splitting);
    } catch (const bdh::InvalidOption &) {
    }
  }
  searched_radius_ = now.radius;
  try {
    return plan_now(now);
  } catch (const bdh::InvalidOption &) {
    if (now.substeps == 0) throw;
  }
  // Soft far steps of scheme split need pairs that the list does not have: the mobility comes
  // first.
  now.substeps = 0;
  return plan_now(now);
}

/// Empty for a radius that the log has already shown almost as it is.
std::string PsePlanning::change_since_planning(const bdh::PseScene &now) const
{
  if (!planned_) return "the group has its first particles";
  if (now.particles != made_for_.particles)
    return fmt::format("the group has {} particles instead of {}", now.particles,
                       made_for_.particles);
  if (std::fabs(now.radius - made_for_.radius) > 1e-10 * now.radius)
    return is_within(1.1, logged_radius_, now.radius) ? "" : "the radius has changed";
  return fmt::format("the volume is {:.6g} instead of {:.6g}", now.volume, made_for_.volume);
}

bool PsePlanning::fits_box()
{
  const bdh::Cell now = cell_now(*domain);
  bool is_known = is_within(1.01, now.volume(), known_.volume());
  for (int d = 0; d < 3; ++d) is_known = is_known && is_within(1.01, now.edge(d), known_.edge(d));
  if (is_known) return !is_too_long();
  if (!serves(scene_of(made_for_.particles, made_for_.radius))) return false;
  known_ = now;
  return true;
}

std::vector<char> PsePlanning::save() const
{
  if (!planned_) return {};
  const State state{State::current, narrow_, plan_, made_for_, split_price_};
  const char *bytes = reinterpret_cast<const char *>(&state);
  return {bytes, bytes + sizeof state};
}

void PsePlanning::restore(const char *bytes, std::size_t size)
{
  static_assert(std::is_trivially_copyable<State>::value, "a restart file has the bytes");
  if (size != sizeof(State)) return;
  State state;
  memcpy(&state, bytes, size);
  if (!state.is_sound()) return;
  narrow_ = state.narrow;
  plan_ = state.plan;
  made_for_ = state.made_for;
  split_price_ = state.split_price;
  searched_radius_ = made_for_.radius;
  planned_ = restored_ = true;
}

void PsePlanning::warn() const
{
  if (options_.xi > 0.0 && plan_.neighbors > many_neighbors)
    error->warning(FLERR,
                   "{}: xi = {} makes about {:.0f} neighbors per particle, which take long and "
                   "much memory: use a larger one, or xi auto",
                   name_, plan_.xi, plan_.neighbors);
  const double stiffness = far_stiffness(plan_, options_);
  if (options_.split && stiffness > 1.0)
    error->warning(FLERR,
                   "{}: xi = {}: a far step is {:.3g} times as stiff as a near one, but should be "
                   "at most as stiff: use xi auto, or fewer substeps",
                   name_, plan_.xi, stiffness);
}

void PsePlanning::describe_free_particles(PlanText &text) const
{
  text.line("mobility", "1/(6 pi viscosity radius) for each particle alone: no hydrodynamic "
                        "interactions (hydrodynamics no), so neither pairs nor a grid");
  text.line("radius", fmt::format("{:.6g} ({})", plan_.radius,
                                  options_.radius > 0.0 ? "as given" : "of the atoms"));
  text.line("scheme", options_.split
                          ? fmt::format("split: {} near step{} of {:.4g}, forces {} times a step",
                                        options_.substeps, options_.substeps > 1 ? "s" : "",
                                        update->dt / options_.substeps, options_.substeps + 1)
                          : std::string("Euler-Maruyama: forces once a step"));
  text.line("noise", solvent_.kT() > 0.0 ? "three normals per particle" : "off: temperature 0");
  if (solvent_.has_variables())
    text.line("variables", fmt::format("temperature {:.6g} and viscosity {:.6g} now",
                                       solvent_.user_temperature(), solvent_.user_viscosity()));
  if (options_.check) text.line("check", "nothing to check: this mobility is exact");
}

void PsePlanning::describe(PlanText &text, const std::string &ghosts, double grid) const
{
  if (!planned_) {
    text.line("waits", "the group is empty, and the radius is to be that of its atoms: the plan is "
                       "made when there are some");
    return;
  }
  if (!plan_.hydrodynamics) return describe_free_particles(text);
  const bdh::PsePlan &p = plan_;
  const bool hot = solvent_.kT() > 0.0;
  text.line("tolerance", fmt::format("{:g}: relative error of the velocities M F{}", p.tolerance,
                                     hot ? " and of the random ones" : ""));
  text.line("radius", fmt::format("{:.6g} ({})", p.radius,
                                  options_.radius > 0.0 ? "as given" : "of the atoms"));
  text.line("splitting", fmt::format("xi = {:.4g} = {:.4g}/radius ({})", p.xi, p.xi * p.radius,
                                     splitting_reason(p, options_, restored_)));
  text.line("real space",
            fmt::format("pairs within r_c = {:.4g} = {:.3g} radii: about {:.0f} neighbors per "
                        "particle, at most {:.0f}",
                        p.r_cut, p.r_cut / p.radius, p.neighbors, p.most_neighbors));
  text.line("wave space",
            fmt::format("{} x {} x {} points, window of {} points per axis, modes with |k| <= k_c "
                        "= {:.4g}",
                        p.n[0], p.n[1], p.n[2], p.window.width, p.k_cut));
  text.line("errors",
            fmt::format("expected {:.2g}: real space {:.1g}, wave space {:.1g}, window {:.1g}, "
                        "rounding {:.1g}",
                        p.errors.total(), p.errors.real_space, p.errors.wave_space, p.errors.window,
                        p.errors.rounding));
  text.line("precision",
            fmt::format("{} for grid, transforms and pairs ({}); all else in double",
                        p.single ? "single" : "double", precision_reason(p, options_)));
  text.line("scheme", scheme_text(p, options_, update->dt));
  text.line("noise", hot ? fmt::format("real space by Lanczos, about {} iterations; wave space "
                                       "within the transforms of the forces",
                                       p.iterations)
                         : "off: temperature 0, so neither Lanczos nor random numbers");
  text.line("drift", "none: div M = 0 in a periodic box");
  if (options_.parts)
    text.line("parts", "kept per atom: the forces and the noise need a set of transforms each "
                       "(keyword parts)");
  if (domain->box_change_shape || domain->box_change_size)
    text.line("box", "changes during the run: wave vectors follow it, and the grid when it must");
  if (!ghosts.empty()) text.line("ghosts", ghosts);
  if (solvent_.has_variables())
    text.line("variables", fmt::format("temperature {:.6g} and viscosity {:.6g} now",
                                       solvent_.user_temperature(), solvent_.user_viscosity()));
  text.line("cost", fmt::format("{:.2g} s in real space, {:.2g} s in wave space per step on one "
                                "core, by the cost model",
                                p.real_seconds, p.wave_seconds));
  if (options_.split && options_.xi == 0.0)
    text.line("", fmt::format("a unit of time costs {:.2g} times as much as with scheme euler at "
                              "timestep {:.4g}; forces not counted",
                              split_price_, update->dt / options_.substeps));
  text.line("memory", fmt::format("{:.3g} MB for the grid on the first process", megabytes(grid)));
}
