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
#include "citeme.h"
#include "comm.h"
#include "force.h"
#include "modify.h"
#include "update.h"

#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
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

// Entries of compute_vector() for the walls: three components for each of the six faces.
static constexpr int wall_figures = 18;

/* ---------------------------------------------------------------------- */

FixBDFib::FixBDFib(LAMMPS *lmp, int narg, char **arg) :
    FixBD(lmp, narg, arg), given_(lmp, name_, options_), box_(lmp, name_, options_),
    report_(lmp, name_, {options_, box_, solvent_, group_.orientations(), given_})
{
  if (lmp->citeme) lmp->citeme->add(cite_fix_bd_fib);
  guard_([&] { options_ = bdh::parse_fib_options({arg + 3, arg + narg}); });
  size_vector += 1 + wall_figures;
  solvent_.set(options_.temperature, options_.viscosity, options_.seed);
  method_ = {false, "scheme improved", "scheme midpoint"};
  group_.orientations().choose(options_.rotation);
  group_.unwrap(options_.shear_rate != 0.0 && !options_.walls.any());
  if (options_.scheme == Scheme::improved)
    group_.need_forces_within_step(AtomGroup::ForcesFor::scheme);
  engine_ = std::make_unique<HostFibEngine>(lmp, bdh::Workers::one(), group_);
  stiffness_.set_scheme(options_.scheme == Scheme::improved ? excess_of_improved : excess_of_euler,
                        1);
  if (options_.check_dt) timestep_check_.ask(group_);
  if (given_.act())
    constraint_output_ = std::make_unique<ConstraintOutput>(lmp, *this, columns_, options_);
  adaptive_.set(options_.adapt, false, group_, stiffness_);
  force_watch_ = std::make_unique<HostForceWatch>(lmp, groupbit, group_, columns_);
  restart_global = adaptive_.take_pieces();
  columns_.attach();
}

void FixBDFib::post_constructor()
{
  if (restart_global) restore_from_other_suffix(*modify, *this, atom->nlocal, fib_styles);
}

/// The choice of pieces remembers the forces of earlier ones.
void FixBDFib::write_restart(FILE *file)
{
  if (comm->me) return;
  const bdh::PieceChoice::State state = adaptive_.choice().state();
  const int size = sizeof state;
  fwrite(&size, sizeof size, 1, file);
  fwrite(&state, sizeof state, 1, file);
}

void FixBDFib::restart(char *state)
{
  bdh::PieceChoice::State read;
  memcpy(&read, state, sizeof read);
  adaptive_.choice().set_state(read);
}

void FixBDFib::init()
{
  FixBD::init();
  if (constraint_output_) constraint_output_->announce();
}

/// The rows of the grid that follow the particles are known before the plan is printed.
void FixBDFib::setup(int vflag)
{
  guard_([this] { engine_->fit_grid(); });
  FixBD::setup(vflag);
}

void FixBDFib::build()
{
  const bool is_new = box_.fit() || !engine_->is_made();
  const bdh::Grid &grid = box_.grid();
  given_.check();
  if (is_new) engine_->make(grid, options_, group_.orientations().turn(), given_);
  figures_.radius = figures_.least_radius = bdh::hydrodynamic_radius(options_.kernel, grid);
  figures_.spacing = std::pow(grid.cell_volume(), 1.0 / grid.dim);
  if (is_new) figures_.mobility = bdh::self_mobility(grid, options_.kernel, bdh::Comm(world));
  judge_.set_limit(figures_.spacing, "the grid spacing");
  if (is_new) report_.warn_of_cells(figures_.radius);
  report_.warn_of_radii(groupbit, figures_.radius);
}

PlanText FixBDFib::plan_text() const
{
  PlanText text(name_, 10);
  report_.describe(text, *engine_, figures_.radius, figures_.spacing);
  return text;
}

bdh::StepPlan FixBDFib::plan_step() const
{
  bdh::StepPlan p;
  p.scheme = options_.scheme;
  p.drift = options_.drift_at(solvent_.kT());
  p.corrector = options_.needs_corrector(solvent_.kT());
  p.turns = group_.orientations().turn();
  p.dt = update->dt;
  p.kT = solvent_.kT();
  p.viscosity = solvent_.viscosity();
  p.shear_rate = box_.grid().opens() ? 0.0 : options_.shear_rate;    // else it is in walls
  p.walls = box_.walls();
  for (std::size_t d = 0; d < 3; ++d) p.body_force[d] = options_.body_force[d] * force->ftm2v;
  p.tolerance = options_.tolerance;
  p.crossing = options_.crossing;
  p.delta = options_.delta;
  p.seed = options_.seed;
  p.step = update->ntimestep;
  return p;
}

bdh::StepAgainstHalves FixBDFib::compare_with_halves(double limit)
{
  return engine_->compare_with_halves(plan_step(), limit);
}

void FixBDFib::step()
{
  box_.check_unchanged();
  if (given_.act()) given_.update();
  try {
    engine_->step(plan_step(), adaptive_.choice());
  } catch (const bdh::NotConverged &e) {
    throw bdh::NotConverged(std::string(e.what()) +
                            ": use a looser tolerance, or a less elongated box");
  }
  const bdh::SolveReport report = engine_->report();
  figures_.solver_iterations = report.iterations;
  figures_.error_estimate = report.residual;
  if (constraint_output_)
    constraint_output_->keep(engine_->constrained(), engine_->atoms(), given_.held(),
                             {box_.strain(), {}, solvent_.viscosity(), solvent_.kT()},
                             engine_->constraint_iterations());
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
    if (comm->me == 0)
      mine += box_.background_force(axis, side, component, solvent_.viscosity()) / force->ftm2v;
  }
  MPI_Allreduce(&mine, &sum, 1, MPI_DOUBLE, MPI_SUM, world);
  return sum;
}

double FixBDFib::memory_usage() { return FixBD::memory_usage() + engine_->memory(); }
