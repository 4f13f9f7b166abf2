/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_pse_plan_report.h"

#include "comm.h"
#include "domain.h"
#include "error.h"
#include "pse/plan_cost.h"
#include "pse/window_spread.h"
#include "update.h"

using namespace LAMMPS_NS;

namespace {

/// Above this number of neighbors per particle, an xi given by the user causes a warning.
constexpr double many_neighbors = 5000.0;

std::string precision_reason(const bdh::PsePlan &plan, const bdh::PseOptions &options)
{
  if (options.precision != bdh::Precision::automatic) return "as given";
  if (plan.single) return "tolerance 1e-4 or looser";
  return plan.tolerance < 1e-4 ? "tolerance tighter than 1e-4"
                               : "the rounding of so many pairs adds up";
}

/// The radii, and who gave them.
std::string radius_text(const bdh::PsePlan &plan, const bdh::PseOptions &options)
{
  if (options.radius > 0.0) return fmt::format("{:.6g} (as given)", plan.radius);
  if (plan.least_radius == plan.radius) return fmt::format("{:.6g} (of the atoms)", plan.radius);
  return fmt::format("{:.6g} to {:.6g} (of the atoms)", plan.least_radius, plan.radius);
}

/// Says who chose the splitting, and what ruled out a cheaper one.
std::string splitting_reason(const bdh::PsePlan &plan, const bdh::PseOptions &options,
                             bool restored)
{
  if (options.xi > 0.0 && plan.xi == options.xi) return "as given";
  if (options.xi > 0.0) return "the given one needs pairs beyond the neighbor list of this run";
  if (restored) return "from the restart file";
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

/// Rigid spheres and held atoms: evaluations for the known and the unknown loads, and iterations.
std::string constrained_scheme_text(const bdh::PsePlan &plan, bool hot)
{
  const std::string count =
      plan.stresslets
          ? fmt::format("about {} iterations", bdh::expected_constraint_iterations(plan.tolerance))
          : std::string("iterations");
  return fmt::format("{}: {} to solve for the constraint, forces once a step",
                     hot ? "midpoint of the noise, drawn at the beginning" : "Euler", count);
}

std::string scheme_text(const bdh::PsePlan &plan, const bdh::PseOptions &options, double dt)
{
  if (!options.split) return "Euler-Maruyama: 1 evaluation of the mobility, forces once a step";
  const int n = options.substeps;
  if (options.choose_substeps)
    return fmt::format("split: 1 far step of {:.4g}, then near steps that are chosen, forces once "
                       "for each; for touching spheres a far step is {:.2g} times as stiff as the "
                       "near ones together",
                       dt, bdh::pse_far_stiffness(plan, 1));
  return fmt::format("split: 1 far step of {:.4g}, then {} near step{} of {:.4g}, forces {} times "
                     "a step; for touching spheres a far step is {:.2g} times as stiff as a near "
                     "one",
                     dt, n, n > 1 ? "s" : "", dt / n, n + 1, bdh::pse_far_stiffness(plan, n));
}

}    // namespace

void PsePlanReport::warn(const bdh::PsePlan &plan) const
{
  if (!plan.hydrodynamics) return;
  if (options_.xi > 0.0 && plan.neighbors > many_neighbors)
    error->warning(FLERR,
                   "{}: xi = {} gives about {:.0f} neighbors per particle, which take much time "
                   "and memory: use a larger one, or xi auto",
                   name_, plan.xi, plan.neighbors);
  const double stiffness = bdh::pse_far_stiffness(plan, options_.substeps);
  if (options_.split && stiffness > 1.0)
    error->warning(FLERR,
                   "{}: xi = {}: a far step is {:.3g} times as stiff as a near one, but should be "
                   "at most as stiff: use xi auto, or fewer substeps",
                   name_, plan.xi, stiffness);
}

void PsePlanReport::log_change(const bdh::PsePlan &plan, bool is_first,
                               const std::string &reason) const
{
  if (!plan.hydrodynamics) {
    utils::logmesg(lmp, "{}: step {}: {}: radius {:.6g}\n", name_, update->ntimestep, reason,
                   plan.radius);
    return;
  }
  utils::logmesg(lmp,
                 "{}: step {}: the plan is made{}, since {}: radius {:.6g}, xi = {:.4g}, "
                 "r_c = {:.4g}, {} x {} x {} points, expected error {:.2g}\n",
                 name_, update->ntimestep, is_first ? "" : " again", reason, plan.radius, plan.xi,
                 plan.r_cut, plan.n[0], plan.n[1], plan.n[2], plan.errors.total());
}

void PsePlanReport::describe_waiting(PlanText &text) const
{
  text.line("waits", "the group is empty, and the radius is that of its atoms: the plan will be "
                     "made when there are some");
}

void PsePlanReport::describe(PlanText &text, const bdh::PsePlan &plan,
                             const PsePlanDetails &details) const
{
  if (!plan.hydrodynamics) return describe_free_particles(text, plan);
  describe_accuracy(text, plan, details.restored);
  describe_steps(text, plan);
  describe_surroundings(text, details.ghosts);
  describe_cost(text, plan, details);
}

void PsePlanReport::describe_free_particles(PlanText &text, const bdh::PsePlan &p) const
{
  text.line("mobility", "1/(6 pi viscosity radius) for each particle alone: no hydrodynamic "
                        "interactions (hydrodynamics no), so neither pairs nor a grid");
  text.line("radius", radius_text(p, options_));
  text.line("scheme", options_.choose_substeps
                          ? "split: near steps that are chosen, forces once for each"
                      : options_.split
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

void PsePlanReport::describe_accuracy(PlanText &text, const bdh::PsePlan &p, bool restored) const
{
  text.line("tolerance", fmt::format("{:g}: relative error of the velocities M F{}", p.tolerance,
                                     solvent_.kT() > 0.0 ? " and of the random ones" : ""));
  text.line("radius", radius_text(p, options_));
  text.line("splitting",
            fmt::format("xi = {:.4g} = {:.4g}/{}radius{} ({})", p.xi, p.xi * p.radius,
                        p.least_radius < p.radius ? "greatest " : "",
                        p.splitting == bdh::Splitting::kaiser_bessel ? ", Kaiser-Bessel" : "",
                        splitting_reason(p, options_, restored)));
  text.line("real space",
            fmt::format("pairs within r_c = {:.4g} = {:.3g} radii{}: about {:.0f} neighbors per "
                        "particle, at most {:.0f}",
                        p.r_cut, p.r_cut / p.radius,
                        p.least_radius < p.radius ? ", smaller spheres sooner" : "", p.neighbors,
                        p.most_neighbors));
  text.line("wave space",
            fmt::format("{} x {} x {} points, window of {} points per axis, modes with |k| <= k_c "
                        "= {:.4g}",
                        p.n[0], p.n[1], p.n[2], p.window.width, p.k_cut));
  if (comm->nprocs > 1)
    text.line("processes",
              fmt::format("{}, {}", comm->nprocs,
                          layout_text(bdh::fractional_grid(p.n), options_.fft, comm->nprocs)));
  if (!p.basis().single())
    text.line("shapes", fmt::format("two fields, of spheres of radius {:.6g} and {:.6g}, for all",
                                    p.basis().b1, p.basis().b2));
  text.line("errors",
            fmt::format("expected {:.2g}: real space {:.1g}, wave space {:.1g}, window {:.1g}, "
                        "rounding {:.1g}",
                        p.errors.total(), p.errors.real_space, p.errors.wave_space, p.errors.window,
                        p.errors.rounding));
  text.line("precision",
            fmt::format("{} for grid, transforms and pairs ({}); all else in double",
                        p.single ? "single" : "double", precision_reason(p, options_)));
}

void PsePlanReport::describe_steps(PlanText &text, const bdh::PsePlan &p) const
{
  const bool hot = solvent_.kT() > 0.0, constrained = p.stresslets || !options_.holds.empty();
  text.line("scheme",
            constrained ? constrained_scheme_text(p, hot) : scheme_text(p, options_, update->dt));
  text.line("noise", solvent_.kT() > 0.0
                         ? fmt::format("real space by Lanczos, about {} iterations; wave space "
                                       "within the transforms of the forces",
                                       p.iterations)
                         : "off: temperature 0, so neither Lanczos nor random numbers");
  text.line("drift", constrained && hot
                         ? "of the constraint, by the displacement to the midpoint; div M is 0"
                         : "none: div M = 0 in a periodic box");
  if (options_.parts)
    text.line("parts", "kept per atom: the forces and the noise need a set of transforms each "
                       "(keyword parts)");
}

void PsePlanReport::describe_surroundings(PlanText &text, const std::string &ghosts) const
{
  if (domain->box_change_shape || domain->box_change_size)
    text.line("box", "changes during the run: wave vectors follow it, and the grid when it must");
  if (!ghosts.empty()) text.line("ghosts", ghosts);
  if (solvent_.has_variables())
    text.line("variables", fmt::format("temperature {:.6g} and viscosity {:.6g} now",
                                       solvent_.user_temperature(), solvent_.user_viscosity()));
}

void PsePlanReport::describe_cost(PlanText &text, const bdh::PsePlan &p,
                                  const PsePlanDetails &details) const
{
  text.line("cost", fmt::format("{:.2g} s in real space, {:.2g} s in wave space per step on one "
                                "core, by the cost model",
                                p.real_seconds, p.wave_seconds));
  if (options_.split && options_.xi == 0.0)
    text.line("", fmt::format("a unit of time costs {:.2g} times as much as with scheme euler at "
                              "timestep {:.4g}; forces not counted",
                              details.split_price, update->dt / options_.substeps));
  text.line("memory", fmt::format("{:.3g} MB for the grid on the first process",
                                  megabytes(details.grid_memory)));
}
