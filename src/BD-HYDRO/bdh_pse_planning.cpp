/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_pse_planning.h"

#include "comm.h"
#include "domain.h"
#include "error.h"
#include "group.h"
#include "update.h"

#include <cmath>

using namespace LAMMPS_NS;

// Per particle; plans of xi auto have a tenth of it.
static constexpr double many_neighbors = 5000.0;

double PsePlanning::common_radius() const
{
  if (options_.radius > 0.0) return options_.radius;
  const std::array<double, 2> range = group_.radius_range();
  const double least = range[0], greatest = range[1];
  if (least > greatest) return 1.0;    // an empty group
  if (!(least > 0.0))
    error->all(FLERR, "{}: an atom has radius {}, but must be > 0: use set ... diameter", name_,
               least);
  if (greatest - least > 1e-10 * greatest)
    error->all(FLERR,
               "{}: the atoms' radii go from {} to {}, but must be equal: set them with set ... "
               "diameter, or give one as radius a",
               name_, least, greatest);
  return greatest;
}

bdh::Cell PsePlanning::cell() const
{
  bdh::Cell c;
  for (int d = 0; d < 3; ++d) c.lo[d] = domain->boxlo[d];
  c.lx = domain->prd[0];
  c.ly = domain->prd[1];
  c.lz = domain->prd[2];
  if (domain->triclinic) {
    c.xy = domain->xy;
    c.xz = domain->xz;
    c.yz = domain->yz;
  }
  return c;
}

bdh::PseScene PsePlanning::scene() const
{
  bdh::Cell widest = cell();
  if (domain->box_change_shape) {    // the tilts between two flips
    widest.xy = MAX(std::fabs(widest.xy), 0.5 * widest.lx);
    widest.xz = MAX(std::fabs(widest.xz), 0.5 * widest.lx);
    widest.yz = MAX(std::fabs(widest.yz), 0.5 * widest.ly);
  }
  bdh::PseScene s;
  s.volume = widest.volume();
  for (int d = 0; d < 3; ++d) s.edge[d] = widest.edge(d);
  s.particles = MAX(static_cast<bigint>(1), group->count(igroup_));
  s.radius = radius_;
  s.noise = solvent_.may_be_hot();
  s.tolerance = options_.tolerance;
  s.xi = options_.xi;
  s.substeps = options_.substeps;
  s.precision = options_.precision;
  return s;
}

bool PsePlanning::replan(double radius)
{
  radius_ = radius;
  const bdh::PsePlan last = plan_;
  const bdh::PseScene present = scene();
  plan_ = bdh::plan_pse(present);
  const bool same = planned_ && last.xi == plan_.xi && last.r_cut == plan_.r_cut &&
                    last.k_cut == plan_.k_cut && last.n == plan_.n && last.radius == plan_.radius &&
                    last.volume == plan_.volume && last.window.width == plan_.window.width &&
                    last.window.beta == plan_.window.beta;
  planned_ = true;
  if (!same && options_.split && options_.xi == 0.0)
    split_price_ = bdh::pse_split_price(plan_, present);
  if (comm->me == 0) warn();
  return !same;
}

void PsePlanning::warn() const
{
  if (plan_.neighbors > many_neighbors)
    error->warning(FLERR,
                   "{}: xi = {} makes about {:.0f} neighbors per particle, which take long and "
                   "much memory: use a larger one, or xi auto",
                   name_, plan_.xi, plan_.neighbors);
  if (options_.split && far_stiffness() > 1.0)
    error->warning(FLERR,
                   "{}: xi = {}: a far step is {:.3g} times as stiff as a near one, but should be "
                   "at most as stiff: use xi auto, or fewer substeps",
                   name_, plan_.xi, far_stiffness());
}

/// How stiff a far step is compared with a near one: k mu dt of two touching spheres along their
/// line of centers.
double PsePlanning::far_stiffness() const
{
  const double share = bdh::pse_far_share(plan_.xi * plan_.radius);
  return options_.substeps * share / (1.0 - share);
}

std::string PsePlanning::precision_reason() const
{
  if (options_.precision != bdh::Precision::automatic) return "as given";
  if (plan_.single) return "tolerance 1e-4 or looser";
  return plan_.tolerance < 1e-4 ? "tolerance tighter than 1e-4"
                                : "the rounding of so many pairs adds up";
}

std::string PsePlanning::scheme_text() const
{
  if (!options_.split) return "Euler-Maruyama: 1 evaluation of the mobility, forces once a step";
  const int n = options_.substeps;
  return fmt::format("split: 1 far step of {:.4g}, then {} near step{} of {:.4g}, forces {} times "
                     "a step; for touching spheres a far step is {:.2g} times as stiff as a near "
                     "one",
                     update->dt, n, n > 1 ? "s" : "", update->dt / n, n + 1, far_stiffness());
}

void PsePlanning::describe(PlanText &text, const std::string &ghosts, double grid) const
{
  const bdh::PsePlan &p = plan_;
  const bool hot = solvent_.kT() > 0.0;
  text.line("tolerance", fmt::format("{:g}: relative error of the velocities M F{}", p.tolerance,
                                     hot ? " and of the random ones" : ""));
  text.line("radius", fmt::format("{:.6g} ({})", radius_,
                                  options_.radius > 0.0 ? "as given" : "of the atoms"));
  text.line("splitting",
            fmt::format("xi = {:.4g} = {:.4g}/radius ({})", p.xi, p.xi * radius_,
                        options_.xi > 0.0 ? "as given"
                        : options_.split  ? "the cheapest by the cost model for these substeps"
                                          : "the cheapest by the cost model"));
  text.line("real space",
            fmt::format("pairs within r_c = {:.4g} = {:.3g} radii, about {:.0f} neighbors per "
                        "particle",
                        p.r_cut, p.r_cut / radius_, p.neighbors));
  text.line("wave space",
            fmt::format("{} x {} x {} points, window of {} points per axis, modes with |k| <= k_c "
                        "= {:.4g}",
                        p.n[0], p.n[1], p.n[2], p.window.width, p.k_cut));
  text.line("errors",
            fmt::format("expected {:.2g}: real space {:.1g}, wave space {:.1g}, window {:.1g}, "
                        "rounding {:.1g}",
                        p.errors.total(), p.errors.real_space, p.errors.wave_space, p.errors.window,
                        p.errors.rounding));
  text.line("precision", fmt::format("{} for grid, transforms and pairs ({}); all else in double",
                                     p.single ? "single" : "double", precision_reason()));
  text.line("scheme", scheme_text());
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
