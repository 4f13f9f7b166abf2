/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_fib_plan_report.h"

#include "atom.h"
#include "bdh_lammps.h"
#include "bdh_scene.h"
#include "comm.h"
#include "error.h"
#include "fib/active_rows.h"
#include "input/grid_choice.h"
#include "modify.h"
#include "stokes/choice.h"

#include <cmath>

using namespace LAMMPS_NS;
using bdh::Drift;
using bdh::DriftChoice;
using bdh::Scheme;

namespace {

std::string precision_text(const bdh::FibPrecision &p)
{
  if (!p.single) return fmt::format("double ({})", p.reason);
  return fmt::format("single for grid, transforms and noise ({}); all else in double", p.reason);
}

std::string drift_text(const bdh::FibOptions &o, double kT)
{
  switch (o.drift_at(kT)) {
  case Drift::exact: return "exact derivative of the kernel, spread together with the forces";
  case Drift::finite_difference:
    return fmt::format("random finite difference, delta = {} h: two more spreadings", o.delta);
  case Drift::no: break;
  }
  if (kT == 0.0) return "off: temperature 0";
  if (o.scheme == Scheme::euler && o.drift == DriftChoice::automatic)
    return "off: scheme euler leaves the thermal drift out and is biased (keyword drift adds part "
           "of it)";
  return "off: keyword drift no; the equilibrium distribution is biased";
}

const char *kind_text(bdh::Boundary kind)
{
  switch (kind) {
  case bdh::Boundary::noslip: return " no-slip";
  case bdh::Boundary::slip: return " free-slip";
  case bdh::Boundary::open: return " open";
  case bdh::Boundary::periodic: break;
  }
  return "";
}

bool has_friction(const bdh::Grid &grid)
{
  using bdh::Boundary;
  return grid.has(Boundary::noslip, 0) || grid.has(Boundary::noslip, 1) ||
         grid.has(Boundary::noslip, 2);
}

/// A flow at a shear rate, for the plan.
std::string shear_text(const bdh::FibOptions &o, const bdh::Grid &grid)
{
  for (int d = 0; d < grid.dim; ++d) {
    if (!grid.has(bdh::Boundary::open, d)) continue;
    const char *from =
        grid.has(bdh::Boundary::noslip, d) ? "distance from the wall" : "distance from the middle";
    return fmt::format("u = {} times the {} along x is added", o.shear_rate, from);
  }
  return fmt::format("u = {} y along x is added to the periodic flow", o.shear_rate);
}

std::string scheme_text(const bdh::FibOptions &o, double kT)
{
  switch (o.scheme) {
  case Scheme::midpoint:
    return o.needs_corrector(kT)
               ? "midpoint: 1 solve, 2 interpolations, forces once a step"
               : "midpoint without its corrector: temperature 0 and no flow, so it gains nothing "
                 "(scheme midpoint keeps it)";
  case Scheme::improved: return "improved midpoint: 2 solves, forces twice a step";
  case Scheme::euler: return "euler: 1 solve, 1 interpolation";
  case Scheme::trapezoidal: return "trapezoidal: 1 solve, 2 interpolations";
  }
  return "";
}

/// False if the body force drives no flow.  In a periodic box the mean velocity is zero.  Between
/// free-slip walls nothing holds the flow back, so its mean is left out, too.  If a wall lies
/// across the force, the pressure balances it.  With open faces there is no body force.
bool body_force_has_effect(const bdh::FibOptions &o, const bdh::Grid &grid)
{
  for (int d = 0; d < grid.dim; ++d)
    for (int across = 0; across < grid.dim && o.body_force[d] != 0.0 && !grid.walled(d); ++across)
      if (grid.has(bdh::Boundary::noslip, across)) return true;
  return false;
}

std::string solver_text(const bdh::FibOptions &o, const bdh::Grid &grid)
{
  switch (bdh::solver_kind(grid)) {
  case bdh::SolverKind::periodic:
    return "Fourier transforms diagonalise a periodic box: exact, no iteration";
  case bdh::SolverKind::slit:
    return fmt::format("Fourier transforms along the {}, for each mode a banded factorisation "
                       "across {}: exact, no iteration",
                       grid.opens() ? "faces" : "walls",
                       grid.opens() ? "the grid, which eliminates the fluid beyond open faces"
                                    : "the channel");
  case bdh::SolverKind::box:
    return fmt::format("sine, cosine and Fourier transforms for each component, conjugate "
                       "gradients for the pressure, "
                       "relative residual {}",
                       o.tolerance);
  case bdh::SolverKind::slip_box:
    return "sine and cosine transforms diagonalise a box without friction: exact, no iteration "
           "beyond the first";
  }
  return "";
}

std::string wall_text(const bdh::FibOptions &o, const bdh::Grid &grid, int axis, int side)
{
  const auto &wall = o.walls.face[axis][side];
  std::string text = bdh::face_name(axis, side) + kind_text(wall.kind);
  if (wall.kind == bdh::Boundary::open && o.hydrodynamics)
    text += fmt::format(": fluid without end; {} rows of the grid lie beyond the box",
                        std::lround(grid.beyond[axis][side] / grid.h(axis)));
  if (wall.moves())
    text +=
        fmt::format(", velocity {} {} {}", wall.velocity[0], wall.velocity[1], wall.velocity[2]);
  return text;
}

std::string stresslet_text(const bdh::FibOptions &o, const bdh::Grid &grid, double radius)
{
  const bdh::StressletRadii radii = bdh::stresslet_radii(o.kernel, grid);
  const double ratio = radii.mean() / radius;
  return fmt::format("yes: spheres do not strain with the flow; radius {:.6g} for shear along the "
                     "axes of the grid, {:.6g} for stretching, so that a dilute suspension has the "
                     "viscosity 1 + {:.3g} phi",
                     radii.shear, radii.stretching, 2.5 * ratio * ratio * ratio);
}

}    // namespace

void FibPlanReport::describe(PlanText &text, const FibEngine &engine, double radius,
                             double spacing) const
{
  if (!o_.hydrodynamics) return describe_free_particles(text, radius);
  describe_grid(text, radius, spacing);
  describe_particles(text, radius);
  text.line("solver", fmt::format("{}; {}", solver_text(o_, box_.grid()), processes_text(engine)));
  text.line("precision", precision_text(engine.precision()));
  describe_walls(text);
  describe_scheme(text);
  describe_noise(text);
  describe_flows(text);
  describe_memory(text, engine);
}

void FibPlanReport::describe_free_particles(PlanText &text, double radius) const
{
  const bdh::Grid &grid = box_.grid();
  text.line("mobility",
            fmt::format("{} for each particle alone: no hydrodynamic interactions "
                        "(hydrodynamics no), and walls act on particles only by forces",
                        grid.dim == 3 ? "1/(6 pi viscosity radius)"
                                      : "that of one particle in the middle of the box"));
  text.line("radius",
            fmt::format("{:.6g}, as kernel {} on {} x {} x {} cells would give it", radius,
                        bdh::kernel_name(o_.kernel), grid.n[0], grid.n[1], grid.n[2]));
  if (orientations_.matter()) text.line("rotation", rotation_text());
  describe_walls(text);
  text.line("scheme", fmt::format("{}: forces {} a step", bdh::scheme_name(o_.scheme),
                                  o_.scheme == Scheme::improved ? "twice" : "once"));
  if (solvent_.has_variables())
    text.line("variables", fmt::format("temperature {:.6g} and viscosity {:.6g} now",
                                       solvent_.user_temperature(), solvent_.user_viscosity()));
  text.line("noise", solvent_.kT() > 0.0 ? fmt::format("{} normals per particle", grid.dim)
                                         : std::string("off: temperature 0"));
  if (o_.shear_rate != 0.0) text.line("flow", shear_text(o_, grid));
}

void FibPlanReport::describe_grid(PlanText &text, double radius, double spacing) const
{
  const bdh::Grid &grid = box_.grid();
  const char *source = o_.radius > 0.0 ? "from the radius" : "as given";
  if (grid.dim == 3)
    text.line("grid", fmt::format("{} x {} x {} cells, spacing h = {:.6g} ({})", grid.n[0],
                                  grid.n[1], grid.n[2], spacing, source));
  else
    text.line("grid", fmt::format("{} x {} cells, spacing h = {:.6g} ({}); two-dimensional, all "
                                  "quantities per unit length",
                                  grid.n[0], grid.n[1], spacing, source));
  text.line("kernel",
            fmt::format("{}: hydrodynamic radius {:.6g} +- {:.2g} % over positions in a cell",
                        bdh::kernel_name(o_.kernel), radius,
                        100.0 * bdh::radius_spread(o_.kernel, grid.dim)));
}

void FibPlanReport::describe_particles(PlanText &text, double radius) const
{
  if (orientations_.matter()) text.line("rotation", rotation_text());
  if (o_.stresslets) text.line("stresslet", stresslet_text(o_, box_.grid(), radius));
  if (!o_.holds.empty()) text.line("held", given_.text());
  if (o_.control_variate) text.line("variate", given_.control_variate_text(solvent_.kT()));
  if (given_.act())
    text.line(
        "constraint",
        fmt::format("conjugate gradients, one solve each, to {} of the motions that are given",
                    o_.constraint_tolerance));
}

std::string FibPlanReport::processes_text(const FibEngine &engine) const
{
  if (comm->nprocs == 1) return "1 process";
  bdh::Grid grid = box_.grid();
  grid.n = engine.cells();
  const bdh::FftSetup fft = bdh::can_have_pencils(grid) ? o_.fft : bdh::FftSetup(o_.fft.effort, 1);
  return fmt::format("{} processes, {}", comm->nprocs,
                     layout_text(bdh::solver_order(grid)(grid), fft, comm->nprocs));
}

void FibPlanReport::describe_walls(PlanText &text) const
{
  const bdh::Grid &grid = box_.grid();
  for (int d = 0; d < grid.dim; ++d)
    for (int side = 0; side < 2 && grid.walled(d); ++side)
      text.line("wall", wall_text(o_, grid, d, side));
}

void FibPlanReport::describe_scheme(PlanText &text) const
{
  text.line("scheme", scheme_text(o_, solvent_.kT()));
  if (solvent_.has_variables())
    text.line(
        "variables",
        fmt::format(
            "temperature {:.6g} and viscosity {:.6g} now; noise and drift follow the temperature",
            solvent_.user_temperature(), solvent_.user_viscosity()));
}

void FibPlanReport::describe_noise(PlanText &text) const
{
  const bdh::Grid &grid = box_.grid();
  const bool box = grid.walled_axes() > 1;
  text.line("noise", solvent_.kT() > 0.0
                         ? fmt::format("drawn in the space of modes, {} {} normal{} per mode",
                                       box ? grid.dim : grid.dim - 1, box ? "real" : "complex",
                                       !box && grid.dim == 2 ? "" : "s")
                         : "off: temperature 0");
  text.line("drift", drift_text(o_, solvent_.kT()));
}

void FibPlanReport::describe_flows(PlanText &text) const
{
  const bdh::Grid &grid = box_.grid();
  if (o_.shear_rate != 0.0) text.line("flow", shear_text(o_, grid));
  if (grid.opens() && !has_friction(grid))
    text.line("mean", "without a no-slip wall the common velocity along the faces is a convention; "
                      "relative motion is not");
  if (!o_.has_body_force()) return;
  text.line("force",
            fmt::format("density {} {} {} on the fluid{}", o_.body_force[0], o_.body_force[1],
                        o_.body_force[2],
                        body_force_has_effect(o_, grid)
                            ? ""
                            : ": no effect, since no wall without slip lies along it, or walls lie "
                              "across it"));
}

/// The rows in use follow the particles in some boxes.
void FibPlanReport::describe_memory(PlanText &text, const FibEngine &engine) const
{
  const std::string memory =
      fmt::format("{:.3g} MB for the grid on the first process", megabytes(engine.grid_memory()));
  const int axis = bdh::ActiveRows::axis_of(box_.grid());
  if (axis < 0) return text.line("memory", memory);
  text.line("rows",
            fmt::format("only those up to the highest particle, in steps of {}: exact, since "
                        "no force acts above",
                        bdh::ActiveRows::quantum));
  text.state("now", fmt::format("{} rows, {}", engine.cells()[axis], memory));
}

std::string FibPlanReport::rotation_text() const
{
  if (!orientations_.turn()) return orientations_.text();
  return fmt::format("{}; rotational radius {:.6g} +- {:.2g} % ({} for the curl)",
                     orientations_.text(), bdh::rotational_radius(o_.kernel, box_.grid()),
                     100.0 * bdh::rotational_radius_spread(o_.kernel, box_.grid().dim),
                     bdh::turning_kernel_name(o_.kernel));
}

void FibPlanReport::warn_of_cells(double radius) const
{
  if (comm->me) return;
  const bdh::Grid &grid = box_.grid();
  const double off = bdh::anisotropy(grid);
  if (off > 0.005)
    error->warning(FLERR,
                   "{}: the cells are not cubic: spacings {:.6g} {:.6g} {:.6g} differ by {:.2g} %; "
                   "the hydrodynamic "
                   "radius depends on the direction and {:.6g} is that of the mean spacing",
                   name_, grid.h(0), grid.h(1), grid.dim == 3 ? grid.h(2) : 0.0, 100.0 * off,
                   radius);
  const double miss = o_.radius > 0.0 ? radius / o_.radius - 1.0 : 0.0;
  if (std::fabs(miss) > 0.01)
    error->warning(FLERR,
                   "{}: radius {} was requested, but the nearest that a grid of this box gives is "
                   "{:.6g} ({:+.2g} %): change the box a little, or give the grid",
                   name_, o_.radius, radius, 100.0 * miss);
}

void FibPlanReport::warn_of_radii(int groupbit, double radius)
{
  if (!atom->radius_flag || warned_radii_) return;
  for (int f = 0; f < modify->nfix; ++f) {
    if (!adapts_radii(*modify->fix[f])) continue;
    warned_radii_ = true;
    if (comm->me == 0)
      error->warning(
          FLERR,
          "{}: fix {} adapt changes radii of atoms, but kernel and grid give all "
          "particles the hydrodynamic radius {:.6g}: the fix does not use radii of atoms",
          name_, modify->fix[f]->id, radius);
    return;
  }
  const Radii radii = radii_of(*lmp, groupbit);
  warned_radii_ = radii.greatest - radii.least > 0.01 * radii.greatest;
  if (warned_radii_ && comm->me == 0)
    error->warning(FLERR,
                   "{}: the atoms' radii go from {:.6g} to {:.6g}, but kernel and grid give all of "
                   "them the hydrodynamic radius {:.6g}: the fix does not use radii of atoms",
                   name_, radii.least, radii.greatest, radius);
}
