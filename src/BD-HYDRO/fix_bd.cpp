/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fix_bd.h"

#include "atom.h"
#include "bdh_lammps.h"
#include "comm.h"
#include "error.h"
#include "update.h"

using namespace LAMMPS_NS;
using namespace FixConst;

FixBD::FixBD(LAMMPS *lmp, int narg, char **arg) :
    FixWithColumns(lmp, narg, arg), name_(std::string("fix ") + arg[2]), solvent_(lmp, name_),
    judge_(lmp, name_, [this](long i) { return describe(i); }),
    group_(lmp, name_, groupbit, scene_, judge_, columns_), companions_(lmp, this, name_),
    stiffness_(lmp, name_), pressures_(lmp, this, name_), timing_(lmp)
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

void FixBD::check_steps()
{
  checks_steps_ = true;
  group_.keep_numbers();
  if (!group_.midpoint_forces()) group_.keep_start_of_step(std::make_unique<MidpointForces>(lmp));
}

void FixBD::watch_forces(double adapt, bool near)
{
  near_ = near;
  pieces_ = bdh::PieceChoice(adapt);
  stiffness_.set_pieces(pieces_.acts());
  if (takes_pieces()) {
    group_.take_pieces();
    if (!group_.midpoint_forces()) group_.keep_start_of_step(std::make_unique<MidpointForces>(lmp));
  }
  force_watch_ = std::make_unique<HostForceWatch>(lmp, groupbit, group_, columns_);
}

int FixBD::setmask() { return INITIAL_INTEGRATE | FINAL_INTEGRATE; }

void FixBD::init()
{
  solvent_.expire();
  pressures_.begin();
  check_box();
  companions_.set_seed(seed_);
  companions_.set_rotation(group_.orientations().turn());
  scene_.other_integrators = companions_.check(method_.needs_neighbor_list);
  if (group_.midpoint_forces())
    group_.midpoint_forces()->check(name_,
                                    takes_pieces()  ? "adapt"
                                    : checks_steps_ ? "check dt"
                                                    : method_.midpoint_scheme,
                                    takes_pieces()  ? "adapt no"
                                    : checks_steps_ ? "check no"
                                                    : method_.other_scheme);
  // A minimization takes no steps, and it moves the particles that a plan would be made for.
  built_ = update->whichflag != 2;
  if (built_) guard([this] { build(); });
}

/// The plan is printed here because variables may need computes, which are not ready earlier.
void FixBD::setup(int)
{
  timing_.clear();
  stiffness_.begin_run();
  pieces_.clear();
  check_is_due_ = checks_steps_;
  solvent_.update();
  companions_.look_for_rotations();
  std::string text = plan_text();
  if (pieces_.acts())
    text += fmt::format("  {:<10} {}, chosen beforehand: the change of forces within one is to "
                        "move no particle by more than {} radii\n",
                        "adapt", near_ ? "near steps" : "steps in pieces", pieces_.tolerance());
  if (text == plan_) return;
  plan_ = text;
  if (comm->me == 0) utils::logmesg(lmp, text + state_text());
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
  if (pieces_.acts()) set_pieces();
  if (check_is_due_) compare_step();
  timing_.measure([this] {
    guard([this] { step(); });
    force_watch_->keep();
  });
  companions_.end_step();
}

/// The forces are now those at the end of the step.
void FixBD::final_integrate()
{
  timing_.measure([this] {
    const double dt = takes_pieces() ? pieces_.time() : update->dt;
    const int forces = near_ ? pieces_.pieces() : stiffness_.pieces();    // in that time
    const bdh::StiffnessScale scale{dt, dt / MAX(forces, 1),
                                    figures_.mobility / solvent_.viscosity(), solvent_.kT()};
    const SeenStiffness seen = force_watch_->compare(scale, method_.radii_of_atoms);
    stiffness_.add(seen);
    if (takes_pieces()) pieces_.end(bdh::Comm(world).greatest(seen.step.change));
  });
}

void FixBD::set_pieces()
{
  bdh::PieceScene scene;
  scene.dt = update->dt;
  scene.kT = solvent_.kT();
  scene.radius = figures_.least_radius;
  scene.mobility = figures_.mobility / solvent_.viscosity() /
                   (method_.radii_of_atoms ? figures_.least_radius : 1.0);
  scene.longest_move = 0.5 * judge_.shortest_edge();
  pieces_.set_scene(scene);
}

/// Here and not at setup, since thermo output at the beginning of a run needs the energies of the
/// last forces that LAMMPS has computed.
void FixBD::compare_step()
{
  check_is_due_ = false;
  const double radius = figures_.least_radius;
  bdh::StepAgainstHalves found;
  guard([&] { found = compare_with_halves(0.5 * judge_.shortest_edge()); });
  if (comm->me) return;
  if (!found.taken) {
    error->warning(FLERR,
                   "{}: check of the timestep {:g}: the step or one of its halves would end the "
                   "run: use a smaller timestep, or adapt",
                   name_, update->dt);
    return;
  }
  utils::logmesg(lmp,
                 "{}: check of the timestep {:g} against two halves on the same Brownian path\n"
                 "  particles move by {:.2g} radii and end {:.2g} radii apart (root mean square), "
                 "{:.2g} at most\n",
                 name_, update->dt, found.moved / radius, found.apart / radius,
                 found.farthest / radius);
  if (found.farthest > 0.1 * radius)
    error->warning(FLERR,
                   "{}: a step of {:g} and its halves end {:.2g} radii apart: use a smaller "
                   "timestep, or adapt",
                   name_, update->dt, found.farthest / radius);
}

/// At the end of a run; nothing if steps are taken as a whole.
void FixBD::show_pieces()
{
  const bdh::PieceChoice::Seen seen = pieces_.seen();
  pieces_.clear();
  if (seen.pieces == 0.0 || comm->me) return;
  std::string text = fmt::format("{}: adapt: {:.3g} {} a step on average; the change of forces "
                                 "within a piece moves a particle by {:.2g} radii at most",
                                 name_, seen.pieces / MAX(update->nsteps, 1),
                                 near_ ? "near steps" : "pieces", seen.largest);
  if (seen.retries > 0.0) text += fmt::format("; {:.0f} pieces were halved again", seen.retries);
  utils::logmesg(lmp, text + "\n");
  if (seen.retries > 1e-5 * seen.pieces)
    error->warning(FLERR,
                   "{}: {:.0f} of {:.0f} pieces were taken back and halved, since they would have "
                   "ended the run; more than one in 100000 biases the noise: use a smaller "
                   "tolerance of adapt, or a smaller timestep",
                   name_, seen.retries, seen.pieces);
}

/// Clears the table here, too, since setup() is not called before a run with pre no.
void FixBD::post_run()
{
  pressures_.watch();
  timing_.show(id, style);
  timing_.clear();
  stiffness_.show();
  stiffness_.begin_run();
  show_pieces();
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
  if (n == size_vector - 2) return pieces_.acts() ? pieces_.pieces() : 1.0;
  if (n == size_vector - 1) return pieces_.seen().retries;
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

double FixBD::memory_usage() { return mobility_memory() + group_.memory() + columns_.bytes(); }
