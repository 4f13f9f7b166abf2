/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fix_bd_fib.h"

#include "atom.h"
#include "bdh_lammps.h"
#include "bdh_lammps_classes.h"
#include "citeme.h"
#include "comm.h"
#include "domain.h"
#include "force.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using bdh::Drift;
using bdh::DriftChoice;
using bdh::Scheme;

static const char cite_fix_bd_fib[] = "fix bd/fib: doi:10.1063/1.4869866\n\n"
                                      "@Article{Delong2014,\n"
                                      " author = {S. Delong and F. {Balboa Usabiaga} and R. "
                                      "{Delgado-Buscalioni} and B. E. Griffith and A. Donev},\n"
                                      " title = {Brownian dynamics without {G}reen's functions},\n"
                                      " journal = {J.~Chem.\\ Phys.},\n"
                                      " volume = {140},\n"
                                      " pages = {134110},\n"
                                      " year = {2014}\n"
                                      "}\n\n";

namespace {

Drift drift_of(const bdh::FibOptions &o, double kT)
{
  if (kT == 0.0 || !o.hydrodynamics) return Drift::no;
  switch (o.drift) {
  case DriftChoice::exact: return Drift::exact;
  case DriftChoice::finite_difference: return Drift::finite_difference;
  case DriftChoice::no: return Drift::no;
  case DriftChoice::automatic: break;
  }
  return o.scheme == Scheme::euler ? Drift::no : Drift::exact;
}

bool has_body_force(const bdh::FibOptions &o)
{
  return o.body_force[0] != 0.0 || o.body_force[1] != 0.0 || o.body_force[2] != 0.0;
}

/// Without noise and flow the corrector of the simple midpoint scheme gains nothing, since the
/// scheme is first order with or without it.
bool corrector_of(const bdh::FibOptions &o, double kT)
{
  return o.scheme_given || kT > 0.0 || o.shear_rate != 0.0 || o.walls.any_moves() ||
         has_body_force(o);
}

// Entries of compute_vector() for the walls: three components for each of the six faces.
constexpr int wall_figures = 18;

std::string precision_text(const bdh::FibPrecision &p)
{
  if (!p.single) return fmt::format("double ({})", p.reason);
  return fmt::format("single for grid, transforms and noise ({}); all else in double", p.reason);
}

std::string drift_text(const bdh::FibOptions &o, Drift drift, double kT)
{
  switch (drift) {
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
    return corrector_of(o, kT)
               ? "midpoint: 1 solve, 2 interpolations, forces once a step"
               : "midpoint without its corrector: temperature 0 and no flow, so it gains nothing "
                 "(scheme midpoint keeps it)";
  case Scheme::improved: return "improved midpoint: 2 solves, forces twice a step";
  case Scheme::euler: return "euler: 1 solve, 1 interpolation";
  case Scheme::trapezoidal: return "trapezoidal: 1 solve, 2 interpolations";
  }
  return "";
}

}    // namespace

/* ---------------------------------------------------------------------- */

FixBDFib::FixBDFib(LAMMPS *lmp, int narg, char **arg) :
    FixBD(lmp, narg, arg), given_(lmp, name_, options_)
{
  if (lmp->citeme) lmp->citeme->add(cite_fix_bd_fib);
  run_core(
      error, name_,
      [&] {
        options_ = bdh::parse_fib_options({arg + 3, arg + narg});
      },
      [](long) { return std::string(); });
  size_vector += 1 + wall_figures;
  solvent_.set(options_.temperature, options_.viscosity);
  seed_ = options_.seed;
  method_ = {false, "scheme improved", "scheme midpoint"};
  group_.orientations().choose(options_.rotation);
  group_.unwrap(options_.shear_rate != 0.0 && !options_.walls.any());
  if (options_.scheme == Scheme::improved)
    group_.keep_start_of_step(std::make_unique<MidpointForces>(lmp));
  engine_ = std::make_unique<HostFibEngine>(lmp, bdh::Workers::one(), group_);
  stiffness_.set_scheme(options_.scheme == Scheme::improved ? excess_of_improved : excess_of_euler,
                        1);
  if (options_.check_dt) check_steps();
  if (given_.act())
    constraint_output_ = std::make_unique<ConstraintOutput>(lmp, *this, columns_, options_);
  watch_forces(options_.adapt);
  restart_global = pieces_.acts();
  columns_.attach();
}

void FixBDFib::init()
{
  FixBD::init();
  if (constraint_output_) constraint_output_->announce();
}

/// The rows of the grid that follow the particles are known before the plan is printed.
void FixBDFib::setup(int vflag)
{
  guard([this] { engine_->fit_grid(); });
  FixBD::setup(vflag);
}

void FixBDFib::post_constructor()
{
  if (restart_global) restore_from_other_suffix(*modify, *this, atom->nlocal, fib_styles);
}

/// The choice of pieces remembers the forces of earlier ones.
void FixBDFib::write_restart(FILE *file)
{
  if (comm->me) return;
  const bdh::PieceChoice::State state = pieces_.state();
  const int size = sizeof state;
  fwrite(&size, sizeof size, 1, file);
  fwrite(&state, sizeof state, 1, file);
}

void FixBDFib::restart(char *state)
{
  bdh::PieceChoice::State read;
  memcpy(&read, state, sizeof read);
  pieces_.set_state(read);
}

void FixBDFib::check_box() const
{
  if (domain->triclinic)
    error->all(FLERR, "{}: the box is triclinic, but must be orthogonal: use change_box all ortho",
               name_);
  for (int d = 0; d < 3; ++d)
    for (int side = 0; side < 2; ++side)
      if (domain->boundary[d][side] > 1 && !may_follow_atoms(d, side))
        error->all(FLERR,
                   "{}: face {} of the box is shrink-wrapped (boundary s or m), but walls must "
                   "stay in place: use boundary f, or p without walls{}",
                   name_, bdh::face_name(d, side),
                   options_.walls.face[d][side].kind == bdh::Boundary::open
                       ? "; an open face may be shrink-wrapped with keyword radius, opposite to a "
                         "no-slip wall"
                       : "");
  if (update->whichflag == 2) return;    // minimize moves no particle through the fluid
  for (int f = 0; f < modify->nfix; ++f)
    if (modify->fix[f]->box_change & (BOX_CHANGE_SIZE | BOX_CHANGE_SHAPE))
      error->all(FLERR,
                 "{}: fix {} {} changes the box during the run, but the grid is fixed to it: "
                 "remove that fix",
                 name_, modify->fix[f]->id, modify->fix[f]->style);
}

/// An open face may be shrink-wrapped where its place has no influence: opposite to a wall that
/// holds the fluid, if the spacing does not come from the height of the box.
bool FixBDFib::may_follow_atoms(int axis, int side) const
{
  const auto &faces = options_.walls.face[axis];
  return faces[side].kind == bdh::Boundary::open && faces[1 - side].kind == bdh::Boundary::noslip &&
         !options_.grid_given();
}

bdh::Grid FixBDFib::grid_of_box() const
{
  bdh::Grid grid = bdh::choose_grid(
      options_, domain->dimension, {domain->boxlo[0], domain->boxlo[1], domain->boxlo[2]},
      {domain->prd[0], domain->prd[1], domain->prd[2]},
      {domain->xperiodic != 0, domain->yperiodic != 0, domain->zperiodic != 0});
  for (std::size_t d = 0; d < 3; ++d)
    for (std::size_t side = 0; side < 2; ++side)
      if (domain->boundary[d][side] > 1)    // this face goes along with the atoms
        grid.left_out[d][side] = std::max(0L, bdh::most_cells - grid.n[d]) * grid.h(d);
  return grid;
}

void FixBDFib::build()
{
  const bdh::Grid grid = grid_of_box();
  const bool same = engine_->is_made() && grid.n == grid_.n && grid.lo == grid_.lo &&
                    grid.length == grid_.length && grid.boundary == grid_.boundary &&
                    grid.beyond == grid_.beyond && grid.left_out == grid_.left_out;
  walls_ = bdh::WallMotion(options_.walls, grid, options_.kernel, options_.shear_rate);
  grid_ = grid;
  for (int d = 0; d < 3; ++d) box_[d] = {domain->boxlo[d], domain->boxhi[d]};
  check_flow();
  given_.check();
  check_stresslets();
  if (!same) engine_->make(grid_, options_, group_.orientations().turn(), given_);
  figures_.radius = figures_.least_radius = bdh::hydrodynamic_radius(options_.kernel, grid_);
  figures_.spacing = std::pow(grid_.cell_volume(), 1.0 / grid_.dim);
  if (!same) figures_.mobility = bdh::self_mobility(grid_, options_.kernel, bdh::Comm(world));
  judge_.set_limit(figures_.spacing, "the grid spacing");
  if (!same) warn_about_cells();
  warn_about_radii();
}

/// Refuses moving walls whose flow only the fluid solver can determine, if there is none.
void FixBDFib::check_flow() const
{
  if (options_.hydrodynamics || walls_.left_to_solver() == bdh::WallVectors{}) return;
  error->all(
      FLERR,
      "{}: with hydrodynamics no, the flow that moving walls drive in a duct or a closed box is "
      "not computed: keep the walls at rest, or use a slit, whose flow is known",
      name_);
}

void FixBDFib::check_stresslets() const
{
  if (!options_.stresslets) return;
  if (grid_.dim == 2)
    error->all(FLERR,
               "{}: stresslet = yes, but in two dimensions there are no spheres: remove stresslet",
               name_);
  if (walls_.left_to_solver() != bdh::WallVectors{})
    error->all(FLERR,
               "{}: stresslet = yes is not possible in a duct or a closed box with moving walls: "
               "keep the walls at rest, or use a slit",
               name_);
}

void FixBDFib::warn_about_cells() const
{
  if (comm->me) return;
  const double off = bdh::anisotropy(grid_);
  if (off > 0.005)
    error->warning(FLERR,
                   "{}: the cells are not cubic: spacings {:.6g} {:.6g} {:.6g} differ by {:.2g} %; "
                   "the hydrodynamic "
                   "radius depends on the direction and {:.6g} is that of the mean spacing",
                   name_, grid_.h(0), grid_.h(1), grid_.dim == 3 ? grid_.h(2) : 0.0, 100.0 * off,
                   figures_.radius);
  const double miss = options_.radius > 0.0 ? figures_.radius / options_.radius - 1.0 : 0.0;
  if (std::fabs(miss) > 0.01)
    error->warning(FLERR,
                   "{}: radius {} was requested, but the nearest that a grid of this box gives is "
                   "{:.6g} ({:+.2g} %): change the box a little, or give the grid",
                   name_, options_.radius, figures_.radius, 100.0 * miss);
}

/// False if the body force drives no flow.  In a periodic box the mean velocity is zero.  Between
/// free-slip walls nothing holds the flow back, so its mean is left out, too.  If a wall lies
/// across the force, the pressure balances it.  With open faces there is no body force.
bool FixBDFib::body_force_has_effect() const
{
  for (int d = 0; d < grid_.dim; ++d)
    for (int across = 0; across < grid_.dim && options_.body_force[d] != 0.0 && !grid_.walled(d);
         ++across)
      if (grid_.has(bdh::Boundary::noslip, across)) return true;
  return false;
}

/// Collective.  Once.
void FixBDFib::warn_about_radii()
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
          name_, modify->fix[f]->id, figures_.radius);
    return;
  }
  const Radii radii = radii_of(*lmp, groupbit);
  warned_radii_ = radii.greatest - radii.least > 0.01 * radii.greatest;
  if (warned_radii_ && comm->me == 0)
    error->warning(FLERR,
                   "{}: the atoms' radii go from {:.6g} to {:.6g}, but kernel and grid give all of "
                   "them the hydrodynamic radius {:.6g}: the fix does not use radii of atoms",
                   name_, radii.least, radii.greatest, figures_.radius);
}

std::string FixBDFib::plan_text() const
{
  if (!options_.hydrodynamics) return free_particles_text();
  const Drift drift = drift_of(options_, solvent_.kT());
  PlanText text(name_, 10);
  if (grid_.dim == 3)
    text.line("grid", fmt::format("{} x {} x {} cells, spacing h = {:.6g} ({})", grid_.n[0],
                                  grid_.n[1], grid_.n[2], figures_.spacing,
                                  options_.radius > 0.0 ? "from the radius" : "as given"));
  else
    text.line("grid", fmt::format("{} x {} cells, spacing h = {:.6g} ({}); two-dimensional, all "
                                  "quantities per unit length",
                                  grid_.n[0], grid_.n[1], figures_.spacing,
                                  options_.radius > 0.0 ? "from the radius" : "as given"));
  text.line("kernel",
            fmt::format("{}: hydrodynamic radius {:.6g} +- {:.2g} % over positions in a cell",
                        bdh::kernel_name(options_.kernel), figures_.radius,
                        100.0 * bdh::radius_spread(options_.kernel, grid_.dim)));
  if (group_.orientations().matter()) text.line("rotation", rotation_text());
  if (options_.stresslets) text.line("stresslet", stresslet_text());
  if (!options_.holds.empty()) text.line("held", given_.text());
  if (given_.act())
    text.line(
        "constraint",
        fmt::format("conjugate gradients, one solve each, to {} of the motions that are given",
                    options_.constraint_tolerance));
  text.line("solver", fmt::format("{}; {} process{}", solver_text(), comm->nprocs,
                                  comm->nprocs > 1 ? "es, the grid in slabs" : ""));
  text.line("precision", precision_text(engine_->precision()));
  for (int d = 0; d < grid_.dim; ++d)
    for (int side = 0; side < 2 && grid_.walled(d); ++side) text.line("wall", wall_text(d, side));
  text.line("scheme", scheme_text(options_, solvent_.kT()));
  if (solvent_.has_variables())
    text.line(
        "variables",
        fmt::format(
            "temperature {:.6g} and viscosity {:.6g} now; noise and drift follow the temperature",
            solvent_.user_temperature(), solvent_.user_viscosity()));
  const bool box = grid_.walled_axes() > 1;
  text.line("noise", solvent_.kT() > 0.0
                         ? fmt::format("drawn in the space of modes, {} {} normal{} per mode",
                                       box ? grid_.dim : grid_.dim - 1, box ? "real" : "complex",
                                       !box && grid_.dim == 2 ? "" : "s")
                         : "off: temperature 0");
  text.line("drift", drift_text(options_, drift, solvent_.kT()));
  if (options_.shear_rate != 0.0) text.line("flow", shear_text(options_, grid_));
  if (grid_.opens() && !has_friction(grid_))
    text.line(
        "mean",
        "without a no-slip wall the common velocity along the faces is a convention; relative "
        "motion is not");
  if (has_body_force(options_))
    text.line(
        "force",
        fmt::format(
            "density {} {} {} on the fluid{}", options_.body_force[0], options_.body_force[1],
            options_.body_force[2],
            body_force_has_effect()
                ? ""
                : ": no effect, since no wall without slip lies along it, or walls lie across it"));
  if (bdh::ActiveRows::axis_of(grid_) >= 0)
    text.line("rows",
              fmt::format("only those up to the highest particle, in steps of {}: exact, since "
                          "no force acts above",
                          bdh::ActiveRows::quantum));
  else
    text.line("memory", fmt::format("{:.3g} MB for the grid on the first process",
                                    megabytes(engine_->grid_memory())));
  return text.text();
}

/// The rows in use, where they follow the particles.
std::string FixBDFib::state_text() const
{
  const int axis = bdh::ActiveRows::axis_of(grid_);
  if (axis < 0 || !options_.hydrodynamics) return "";
  return fmt::format("  {:<10} {} rows, {:.3g} MB for the grid on the first process\n", "now",
                     engine_->cells()[axis], megabytes(engine_->grid_memory()));
}

std::string FixBDFib::rotation_text() const
{
  const Orientations &orientations = group_.orientations();
  if (!orientations.turn()) return orientations.text();
  return fmt::format("{}; rotational radius {:.6g} +- {:.2g} % ({} for the curl)",
                     orientations.text(), bdh::rotational_radius(options_.kernel, grid_),
                     100.0 * bdh::rotational_radius_spread(options_.kernel, grid_.dim),
                     bdh::turning_kernel_name(options_.kernel));
}

std::string FixBDFib::stresslet_text() const
{
  const bdh::StressletRadii radii = bdh::stresslet_radii(options_.kernel, grid_);
  const double ratio = radii.mean() / figures_.radius;
  return fmt::format("yes: spheres do not strain with the flow; radius {:.6g} for shear along the "
                     "axes of the grid, {:.6g} for stretching, so that a dilute suspension has the "
                     "viscosity 1 + {:.3g} phi",
                     radii.shear, radii.stretching, 2.5 * ratio * ratio * ratio);
}

std::string FixBDFib::free_particles_text() const
{
  PlanText text(name_, 10);
  text.line("mobility",
            fmt::format("{} for each particle alone: no hydrodynamic interactions "
                        "(hydrodynamics no), and walls act on particles only by forces",
                        grid_.dim == 3 ? "1/(6 pi viscosity radius)"
                                       : "that of one particle in the middle of the box"));
  text.line("radius",
            fmt::format("{:.6g}, as kernel {} on {} x {} x {} cells would give it", figures_.radius,
                        bdh::kernel_name(options_.kernel), grid_.n[0], grid_.n[1], grid_.n[2]));
  if (group_.orientations().matter()) text.line("rotation", rotation_text());
  for (int d = 0; d < grid_.dim; ++d)
    for (int side = 0; side < 2 && grid_.walled(d); ++side) text.line("wall", wall_text(d, side));
  text.line("scheme", fmt::format("{}: forces {} a step", bdh::scheme_name(options_.scheme),
                                  options_.scheme == Scheme::improved ? "twice" : "once"));
  if (solvent_.has_variables())
    text.line("variables", fmt::format("temperature {:.6g} and viscosity {:.6g} now",
                                       solvent_.user_temperature(), solvent_.user_viscosity()));
  text.line("noise", solvent_.kT() > 0.0 ? fmt::format("{} normals per particle", grid_.dim)
                                         : std::string("off: temperature 0"));
  if (options_.shear_rate != 0.0) text.line("flow", shear_text(options_, grid_));
  return text.text();
}

bdh::StepPlan FixBDFib::plan_step() const
{
  bdh::StepPlan p;
  p.scheme = options_.scheme;
  p.drift = drift_of(options_, solvent_.kT());
  p.corrector = corrector_of(options_, solvent_.kT());
  p.turns = group_.orientations().turn();
  p.dt = update->dt;
  p.kT = solvent_.kT();
  p.viscosity = solvent_.viscosity();
  p.shear_rate = grid_.opens() ? 0.0 : options_.shear_rate;    // else it is in walls_
  p.walls = walls_;
  for (std::size_t d = 0; d < 3; ++d) p.body_force[d] = options_.body_force[d] * force->ftm2v;
  p.tolerance = options_.tolerance;
  p.crossing = options_.crossing;
  p.delta = options_.delta;
  p.seed = seed_;
  p.step = update->ntimestep;
  return p;
}

/// The box of a run with pre no may differ from that of init().  A face that goes along with the
/// atoms may be anywhere.
void FixBDFib::check_same_box() const
{
  const double *const faces[2] = {domain->boxlo, domain->boxhi};
  for (int d = 0; d < grid_.dim; ++d)
    for (int side = 0; side < 2; ++side)
      if (domain->boundary[d][side] <= 1 && faces[side][d] != box_[d][side])
        error->all(FLERR,
                   "{}: step {}: the box has changed, now {:.6g} to {:.6g} along {}, but the grid "
                   "is fixed: use run with pre yes after a change of the box",
                   name_, update->ntimestep, domain->boxlo[d], domain->boxhi[d], "xyz"[d]);
}

bdh::StepAgainstHalves FixBDFib::compare_with_halves(double limit)
{
  return engine_->compare_with_halves(plan_step(), limit);
}

void FixBDFib::step()
{
  check_same_box();
  if (given_.act()) given_.update();
  try {
    engine_->step(plan_step(), pieces_);
  } catch (const bdh::NotConverged &e) {
    throw bdh::NotConverged(std::string(e.what()) +
                            ": use a looser tolerance, or a less elongated box");
  }
  const bdh::SolveReport report = engine_->report();
  figures_.solver_iterations = report.iterations;
  figures_.error_estimate = report.residual;
  if (constraint_output_)
    constraint_output_->keep(engine_->constrained(), engine_->atoms(), given_.held(),
                             {strain_of_flow(), {}, solvent_.viscosity(), solvent_.kT()},
                             engine_->constraint_iterations());
}

/// Of the background: keyword shear, or moving walls of a slit.
bdh::Symmetric<double> FixBDFib::strain_of_flow() const
{
  bdh::Symmetric<double> shear;
  if (!grid_.opens()) shear.xy = 0.5 * options_.shear_rate;
  const auto known = walls_.known_flow().strain();
  const auto walls = bdh::Symmetric<double>::of(known.data());
  return {walls.xx, walls.yy, walls.zz, walls.xy + shear.xy, walls.xz, walls.yz};
}

/// The figures of the base class, then the crossings so far, then the force of the fluid on each
/// wall, then those of constraints.
double FixBDFib::compute_vector(int n)
{
  const int base = figure_count;
  const int constraints = base + 1 + wall_figures;
  if (constraint_output_ && n >= constraints && n < constraints + Rheology::figures)
    return constraint_output_->figure(n - constraints);
  if (n < base || n >= constraints) return FixBD::compute_vector(n);
  double mine = 0.0, sum = 0.0;
  if (n == base) {
    mine = engine_->crossings();
  } else if (engine_->is_made()) {
    const int axis = (n - base - 1) / 6, side = (n - base - 1) / 3 % 2,
              component = (n - base - 1) % 3;
    mine = engine_->report().wall_force[axis][side][component] / force->ftm2v;
    // The slit solver takes the walls to be at rest; their known flow adds a uniform shear stress.
    const bdh::LinearFlow &flow = walls_.known_flow();
    if (comm->me == 0 && flow.flows() && flow.axis == axis &&
        grid_.boundary[axis][side] != bdh::Boundary::open)
      mine += (side ? -1.0 : 1.0) * solvent_.viscosity() * flow.gradient[component] *
              grid_.cell_volume() * grid_.cells() / grid_.length[axis] / force->ftm2v;
  }
  MPI_Allreduce(&mine, &sum, 1, MPI_DOUBLE, MPI_SUM, world);
  return sum;
}

std::string FixBDFib::solver_text() const
{
  switch (bdh::solver_kind(grid_)) {
  case bdh::SolverKind::periodic:
    return "Fourier transforms diagonalise a periodic box: exact, no iteration";
  case bdh::SolverKind::slit:
    return fmt::format("Fourier transforms along the {}, for each mode a banded factorisation "
                       "across {}: exact, no iteration",
                       grid_.opens() ? "faces" : "walls",
                       grid_.opens() ? "the grid, which eliminates the fluid beyond open faces"
                                     : "the channel");
  case bdh::SolverKind::box:
    return fmt::format("sine, cosine and Fourier transforms for each component, conjugate "
                       "gradients for the pressure, "
                       "relative residual {}",
                       options_.tolerance);
  case bdh::SolverKind::slip_box:
    return "sine and cosine transforms diagonalise a box without friction: exact, no iteration "
           "beyond the first";
  }
  return "";
}

std::string FixBDFib::wall_text(int axis, int side) const
{
  const auto &wall = options_.walls.face[axis][side];
  std::string text = bdh::face_name(axis, side) + kind_text(wall.kind);
  if (wall.kind == bdh::Boundary::open && options_.hydrodynamics)
    text += fmt::format(": fluid without end; {} rows of the grid lie beyond the box",
                        std::lround(grid_.beyond[axis][side] / grid_.h(axis)));
  if (wall.moves())
    text +=
        fmt::format(", velocity {} {} {}", wall.velocity[0], wall.velocity[1], wall.velocity[2]);
  return text;
}
