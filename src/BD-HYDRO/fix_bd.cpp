/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fix_bd.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "update.h"

using namespace LAMMPS_NS;
using namespace FixConst;

FixBD::FixBD(LAMMPS *lmp, int narg, char **arg) :
    FixWithColumns(lmp, narg, arg), name_(std::string("fix ") + arg[2]),
    guard_(lmp, name_, [this](long i) { return describe(i); }), solvent_(lmp, name_),
    judge_(lmp, name_, [this](long i) { return describe(i); }),
    group_(lmp, name_, groupbit, scene_, judge_, columns_), companions_(lmp, this, name_),
    stiffness_(lmp, name_), adaptive_(lmp, name_), timestep_check_(lmp, name_),
    pressures_(lmp, this, name_), timing_(lmp)
{
  time_integrate = 1;
  dynamic_group_allow = 1;
  scalar_flag = vector_flag = 1;
  size_vector = figure_count + last_figures;
  global_freq = 1;
  extscalar = extvector = 0;
  if (!atom->tag_enable)
    error->all(FLERR, "{}: random numbers are drawn by atom id: use atom_modify id yes", name_);
}

int FixBD::setmask() { return INITIAL_INTEGRATE | FINAL_INTEGRATE; }

void FixBD::init()
{
  solvent_.expire();
  pressures_.begin();
  check_box();
  companions_.set_seed(solvent_.seed());
  companions_.set_rotation(group_.orientations().turn());
  scene_.other_integrators = companions_.check(method_.needs_neighbor_list);
  if (const MidpointForces *forces = group_.midpoint_forces()) {
    if (adaptive_.take_pieces())
      forces->check(name_, "adapt", "adapt no");
    else if (timestep_check_.is_asked())
      forces->check(name_, "check dt", "check no");
    else
      forces->check(name_, method_.midpoint_scheme, method_.other_scheme);
  }
  // A minimization takes no steps, and it moves the particles that a plan would be made for.
  built_ = update->whichflag != 2;
  if (built_) guard_([this] { build(); });
}

/// The plan is printed here because variables may need computes, which are not ready earlier.
void FixBD::setup(int)
{
  timing_.clear();
  stiffness_.begin_run();
  adaptive_.begin_run();
  timestep_check_.begin_run();
  solvent_.update();
  companions_.look_for_rotations();
  PlanText text = plan_text();
  adaptive_.describe(text);
  if (text.text() == plan_) return;
  plan_ = text.text();
  if (comm->me == 0) utils::logmesg(lmp, plan_ + text.state_text());
}

void FixBD::initial_integrate(int)
{
  if (!built_)
    error->all(FLERR,
               "{}: the fix was defined after the last setup and is not initialised: use run "
               "with pre yes",
               name_);
  judge_.begin_step();
  companions_.begin_step();
  pressures_.watch();
  solvent_.update();
  adaptive_.begin_step(piece_scene());
  if (timestep_check_.is_due())
    guard_([this] {
      timestep_check_.report(compare_with_halves(0.5 * judge_.shortest_edge()),
                             figures_.least_radius);
    });
  timing_.measure([this] {
    guard_([this] { step(); });
    force_watch_->keep();
  });
  companions_.end_step();
}

/// The forces are now those at the end of the step.
void FixBD::final_integrate()
{
  timing_.measure([this] {
    const double dt = adaptive_.time_of_forces();
    const int parts = adaptive_.parts_of_time(stiffness_.pieces());
    const bdh::StiffnessScale scale{dt, dt / MAX(parts, 1),
                                    figures_.mobility / solvent_.viscosity(), solvent_.kT()};
    const SeenStiffness seen = force_watch_->compare(scale, method_.radii_of_atoms);
    stiffness_.add(seen);
    adaptive_.end_step(seen.step.change);
  });
}

bdh::PieceScene FixBD::piece_scene() const
{
  bdh::PieceScene scene;
  scene.dt = update->dt;
  scene.kT = solvent_.kT();
  scene.radius = figures_.least_radius;
  scene.mobility = figures_.mobility / solvent_.viscosity() /
                   (method_.radii_of_atoms ? figures_.least_radius : 1.0);
  scene.longest_move = 0.5 * judge_.shortest_edge();
  return scene;
}

/// Clears the table here, too, since setup() is not called before a run with pre no.
void FixBD::post_run()
{
  pressures_.watch();
  timing_.show(id, style);
  timing_.clear();
  stiffness_.show();
  stiffness_.begin_run();
  adaptive_.show();
}

double FixBD::compute_scalar()
{
  double mine = judge_.longest(), longest = 0.0;
  MPI_Allreduce(&mine, &longest, 1, MPI_DOUBLE, MPI_MAX, world);
  return longest > 0.0 ? longest / judge_.limit() : 0.0;
}

double FixBD::compute_vector(int n)
{
  if (n == size_vector - 4) return stiffness_.mean();
  if (n == size_vector - 3) return stiffness_.largest();
  if (n == size_vector - 2) return adaptive_.pieces();
  if (n == size_vector - 1) return adaptive_.retries();
  double mine = judge_.long_moves(), long_moves = 0.0;
  MPI_Allreduce(&mine, &long_moves, 1, MPI_DOUBLE, MPI_SUM, world);
  const double list[figure_count] = {figures_.solver_iterations, figures_.lanczos_iterations,
                                     figures_.error_estimate,    figures_.radius,
                                     figures_.spacing,           solvent_.user_temperature(),
                                     solvent_.user_viscosity(),  long_moves};
  return list[n];
}

/// For fix adapt, users of the library, and whatever else asks for a thermostat's temperature.
void *FixBD::extract(const char *what, int &dim)
{
  dim = 0;
  return solvent_.find(what);
}

void FixBD::reset_target(double temperature) { solvent_.reset_temperature(temperature); }

double FixBD::memory_usage() { return group_.memory() + columns_.bytes(); }
