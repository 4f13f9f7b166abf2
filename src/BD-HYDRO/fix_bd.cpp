/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fix_bd.h"

#include "atom.h"
#include "atom_masks.h"
#include "bdh_lammps.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "group.h"
#include "input.h"
#include "memory.h"
#include "modify.h"
#include "neighbor.h"
#include "timer.h"
#include "update.h"
#include "variable.h"

#include <algorithm>
#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;
using namespace FixConst;

/* ----------------------------------------------------------------------
   the group's atoms on this rank, as the core sees them
------------------------------------------------------------------------- */

class FixBD::GroupParticles : public bdh::Particles {
 public:
  explicit GroupParticles(FixBD &fix) : fix_(fix) {}

  /// Collects positions and forces of the group.
  void gather()
  {
    const Atom &atom = *fix_.atom;
    local_.clear();
    for (int i = 0; i < atom.nlocal; ++i)
      if (atom.mask[i] & fix_.groupbit) local_.push_back(i);
    x_.resize(3 * local_.size());
    force_.resize(3 * local_.size());
    id_.resize(local_.size());
    const bool unwrap = fix_.uses_unwrapped_positions();
    const double to_core = fix_.force->ftm2v;
    for (size_t p = 0; p < local_.size(); ++p) {
      const int i = local_[p];
      if (unwrap)
        fix_.domain->unmap(atom.x[i], atom.image[i], &x_[3 * p]);
      else
        for (int d = 0; d < 3; ++d) x_[3 * p + d] = atom.x[i][d];
      for (int d = 0; d < 3; ++d) force_[3 * p + d] = to_core * atom.f[i][d];
      id_[p] = static_cast<uint64_t>(atom.tag[i]);
    }
  }

  long size() const override { return bdh::ssize(local_); }
  const double *x() const override { return x_.data(); }
  const double *force() const override { return force_.data(); }
  const uint64_t *ids() const override { return id_.data(); }

  /// Forces at the midpoint are for this fix alone: those at the beginning of the step go along
  /// with their atoms and are put back, since other integrators may still need them.
  void move_and_update_forces(std::vector<double> &displacement) override
  {
    Atom &atom = *fix_.atom;
    check_moves(displacement.data());
    fix_.save_start_of_step();
    for (size_t p = 0; p < local_.size(); ++p)
      for (int d = 0; d < 3; ++d) {
        fix_.carried_[local_[p]][d] = displacement[3 * p + d];
        atom.x[local_[p]][d] = inside(d, atom.x[local_[p]][d] + displacement[3 * p + d]);
      }
    {
      const bdh::PhaseScope forces(bdh::Phase::forces);
      fix_.midpoint_forces_->update();
    }
    gather();
    displacement.resize(3 * local_.size());
    for (size_t p = 0; p < local_.size(); ++p)
      for (int d = 0; d < 3; ++d) displacement[3 * p + d] = fix_.carried_[local_[p]][d];
    fix_.restore_start_of_step();
  }

  void finish(const std::vector<double> &displacement, const std::vector<double> &velocity) override
  {
    Atom &atom = *fix_.atom;
    moves_.resize(velocity.size());
    for (size_t k = 0; k < moves_.size(); ++k) moves_[k] = velocity[k] * fix_.update->dt;
    check_moves(moves_.data());
    for (size_t p = 0; p < local_.size(); ++p)
      for (int d = 0; d < 3; ++d) {
        atom.x[local_[p]][d] = inside(d, atom.x[local_[p]][d] + displacement[3 * p + d]);
        atom.v[local_[p]][d] = velocity[3 * p + d];
      }
  }

  const std::vector<int> &atoms() const { return local_; }

  /// A coordinate that the step leads to.  On an upper wall an atom belongs to no box of LAMMPS,
  /// which ends below it and would lose the atom.
  double inside(int d, double x) const
  {
    const Domain &box = *fix_.domain;
    return !box.periodicity[d] && x >= box.boxhi[d] ? std::nextafter(box.boxhi[d], box.boxlo[d])
                                                    : x;
  }

  std::string describe(long index) const
  {
    if (index < 0 || index >= size()) return "an atom of another processor";
    return fmt::format("atom {} at step {}", fix_.atom->tag[local_[index]], fix_.update->ntimestep);
  }

  double memory() const
  {
    const size_t doubles = x_.capacity() + force_.capacity() + moves_.capacity();
    return static_cast<double>(local_.capacity() * sizeof(int) + id_.capacity() * sizeof(uint64_t) +
                               doubles * sizeof(double));
  }

 private:
  /// Of displacements (3 size()).
  void check_moves(const double *displacement) const
  {
    const double limit = fix_.longest_move();
    double longest2 = 0.0, long_moves = 0.0;
    long farthest = -1;
    for (long p = 0; p < size(); ++p) {
      const double *u = displacement + 3 * p;
      const double move2 = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
      if (move2 > limit * limit) long_moves += 1.0;
      if (!(move2 <= longest2)) {    // true for NaN as well
        longest2 = move2;
        farthest = p;
      }
    }
    fix_.judge_moves(std::sqrt(longest2), farthest, long_moves);
  }

  FixBD &fix_;
  std::vector<int> local_;
  std::vector<uint64_t> id_;
  std::vector<double> x_, force_, moves_;
};

/* ---------------------------------------------------------------------- */

FixBD::FixBD(LAMMPS *lmp, int narg, char **arg) :
    Fix(lmp, narg, arg), name_(std::string("fix ") + arg[2]), particles_(new GroupParticles(*this)),
    midpoint_forces_(new MidpointForces(lmp))
{
  time_integrate = 1;
  dynamic_group_allow = 1;
  scalar_flag = vector_flag = 1;
  size_vector = sizeof(Figures) / sizeof(double);
  global_freq = 1;
  extscalar = extvector = 0;
  if (!atom->tag_enable)
    error->all(FLERR, "{}: random numbers go with atom ids: use atom_modify id yes", name_);
}

FixBD::~FixBD()
{
  if (registered_) atom->delete_callback(id, Atom::GROW);
  if (registered_ && restart_peratom) atom->delete_callback(id, Atom::RESTART);
  memory->destroy(carried_);
}

void FixBD::take_forces_from(std::unique_ptr<MidpointForces> forces)
{
  midpoint_forces_ = std::move(forces);
}

int FixBD::setmask() { return INITIAL_INTEGRATE; }

void FixBD::set_common(const bdh::Quantity &temperature, const bdh::Quantity &viscosity,
                       uint32_t seed)
{
  temperature_ = temperature;
  viscosity_ = viscosity;
  seed_ = seed;
  if (carried_columns() == 0) return;
  maxexchange = carried_columns();
  // Only now: a constructor that throws after this would leave LAMMPS a callback to a fix that does
  // not exist.
  grow_arrays(atom->nmax);
  atom->add_callback(Atom::GROW);
  if (restart_peratom) atom->add_callback(Atom::RESTART);
  registered_ = true;
}

/* ---------------------------------------------------------------------- */

void FixBD::init()
{
  if (utils::strmatch(update->integrate_style, "^respa"))
    error->all(FLERR, "{}: run_style respa has no meaning without inertia: use run_style verlet",
               name_);
  check_box();
  refuse_second_integrator();
  check_companions();
  check_neighbor_settings();
  if (uses_midpoint_forces()) midpoint_forces_->check(name_, midpoint_scheme(), other_scheme());
  known_danger_ = 0;
  run_core(
      error, name_, [this] { build(); }, [this](long i) { return describe(i); });
  built_ = true;
}

/// An atom that two fixes move would move too far, at the wrong temperature.
void FixBD::refuse_second_integrator() const
{
  for (int f = 0; f < modify->nfix; ++f) {
    const Fix *other = modify->fix[f];
    if (other == this || !other->time_integrate) continue;
    bigint shared = 0, total = 0;
    for (int i = 0; i < atom->nlocal; ++i)
      if ((atom->mask[i] & groupbit) && (atom->mask[i] & other->groupbit)) ++shared;
    MPI_Allreduce(&shared, &total, 1, MPI_LMP_BIGINT, MPI_SUM, world);
    if (total)
      error->all(FLERR,
                 "{}: {} atoms of group {} are also integrated by fix {} {}: unfix it or separate "
                 "the groups",
                 name_, total, group->names[igroup], other->id, other->style);
    const FixBD *fluid = dynamic_cast<const FixBD *>(other);
    if (fluid && fluid->seed_ == seed_)
      error->all(FLERR,
                 "{}: fix {} {} has the same seed {}, so their particles would get the same noise: "
                 "give another",
                 name_, other->id, other->style, seed_);
    if (fluid && comm->me == 0)
      error->warning(
          FLERR,
          "{}: fix {} {} has a fluid of its own: particles of the two do not interact through it",
          name_, other->id, other->style);
  }
}

/// Fixes and pair styles that take the velocity for more than displacement/dt.
void FixBD::check_companions() const
{
  for (int f = 0; f < modify->nfix; ++f) {
    const Fix *other = modify->fix[f];
    if (is_style(other->style, {"shake", "rattle"}))
      error->all(FLERR,
                 "{}: fix {} {} predicts positions from velocities, which have no inertia here: "
                 "use stiff bonds",
                 name_, other->id, other->style);
    if (is_style(other->style, {"langevin", "viscous", "gle", "gld", "drag", "qtb", "temp", "heat",
                                "ehex", "momentum", "thermal/conductivity"}) &&
        comm->me == 0)
      error->warning(FLERR,
                     "{}: fix {} {} acts on velocities, which here are displacement/dt: friction "
                     "and noise come "
                     "from the fluid, so remove it",
                     name_, other->id, other->style);
  }
  if (comm->ghost_velocity && comm->me == 0)
    error->warning(FLERR,
                   "{}: velocities of ghost atoms are communicated for a pair style that uses "
                   "them; here they are "
                   "displacement/dt",
                   name_);
}

void FixBD::check_neighbor_settings() const
{
  if (!(force->pair || keeps_neighbor_list()) || comm->me) return;
  if (neighbor->delay > 0 || neighbor->every > 1)
    error->warning(FLERR,
                   "{}: neighbor lists are only looked at {} steps after they were built (every {} "
                   "delay {}); Brownian "
                   "steps are long, so use neigh_modify every 1 delay 0 check yes",
                   name_, MAX(neighbor->delay, neighbor->every), neighbor->every, neighbor->delay);
}

/// A build at the first step at which it was allowed may have come too late.
void FixBD::watch_neighbor_builds()
{
  const bool each_step = neighbor->delay == 0 && neighbor->every == 1;
  if ((force->pair || keeps_neighbor_list()) && !each_step && neighbor->ndanger > known_danger_ &&
      !warned_danger_ && comm->me == 0) {
    warned_danger_ = true;
    error->warning(FLERR,
                   "{}: dangerous neighbor list build before step {}: atoms had moved more than "
                   "half the skin {} and "
                   "pairs may have been missed; use neigh_modify every 1 delay 0 check yes",
                   name_, update->ntimestep, neighbor->skin);
  }
  known_danger_ = neighbor->ndanger;
}

/// The noise is a function of the step.
void FixBD::watch_step_number()
{
  if (update->ntimestep <= last_step_ && !warned_replay_ && comm->me == 0) {
    warned_replay_ = true;
    error->warning(FLERR,
                   "{}: step {} was taken before (reset_timestep?): the same noise is drawn again, "
                   "unless the fix "
                   "is defined anew with another seed",
                   name_, update->ntimestep);
  }
  last_step_ = update->ntimestep;
}

/// The plan is said here: variables may need computes, which are ready only now.
void FixBD::setup(int)
{
  times_.fill(0.0);
  update_quantities();
  const std::string text = plan_text();
  if (text == plan_) return;
  plan_ = text;
  if (comm->me == 0) utils::logmesg(lmp, text);
}

double FixBD::evaluate(const bdh::Quantity &quantity, const char *what) const
{
  if (!quantity.is_variable()) return quantity.value;
  const int index = input->variable->find(quantity.variable.c_str());
  if (index < 0)
    error->all(FLERR,
               "{}: {} = v_{}, but there is no variable of that name: define it before the run",
               name_, what, quantity.variable);
  if (!input->variable->equalstyle(index))
    error->all(FLERR, "{}: {} = v_{}, but the variable must be of style equal", name_, what,
               quantity.variable);
  return input->variable->compute_equal(index);
}

/// Temperature and viscosity of this step, in core units.
void FixBD::update_quantities()
{
  if (!(update->dt > 0.0))
    error->all(FLERR, "{}: timestep = {}, but must be > 0", name_, update->dt);
  const bool variable = temperature_.is_variable() || viscosity_.is_variable();
  if (variable) modify->clearstep_compute();
  const double T = evaluate(temperature_, "temperature"), eta = evaluate(viscosity_, "viscosity");
  if (variable) modify->addstep_compute(update->ntimestep + 1);
  if (!(T >= 0.0) || !std::isfinite(T))
    error->all(FLERR, "{}: temperature = {} at step {}, but must be >= 0", name_, T,
               update->ntimestep);
  if (!(eta > 0.0) || !std::isfinite(eta))
    error->all(FLERR, "{}: viscosity = {} at step {}, but must be > 0", name_, eta,
               update->ntimestep);
  figures_.temperature = T;
  figures_.viscosity = eta;
  kT_ = force->boltz * T / force->mvv2e;
  core_viscosity_ = eta * force->vxmu2f * force->ftm2v;
}

void FixBD::judge_moves(double longest, long farthest, double long_moves)
{
  longest_ = MAX(longest_, longest);
  figures_.long_moves += long_moves;
  if (farthest >= 0) judge_longest(farthest, longest);
}

void FixBD::judge_longest(long index, double longest)
{
  if (!std::isfinite(longest))
    error->one(FLERR, "{}: {}: its displacement is not a finite number: use a smaller timestep",
               name_, describe(index));
  const double *prd = domain->prd;
  const double half_box = 0.5 * MIN(MIN(prd[0], prd[1]), domain->dimension == 3 ? prd[2] : prd[1]);
  if (longest > half_box)
    error->one(FLERR,
               "{}: {} moved by {:.3g} in one step, which is more than half the box: use a smaller "
               "timestep",
               name_, describe(index), longest);
  warn_of_lost_atoms(index, longest);
  if (longest <= longest_move() || warned_long_move_) return;
  warned_long_move_ = true;
  error->warning(FLERR,
                 "{}: {} moved by {:.3g} in one step, which is more than {} = {:.3g}: use a "
                 "smaller timestep if "
                 "forces change over that distance (further cases are counted in the fix's output)",
                 name_, describe(index), longest, longest_move_name(), longest_move());
}

void FixBD::take_step()
{
  particles_->gather();
  step(*particles_);
}

/// LAMMPS takes atoms back into a periodic box, by one period, only where it may build neighbor
/// lists.
void FixBD::warn_of_lost_atoms(long index, double longest)
{
  const int apart = MAX(neighbor->delay, neighbor->every);
  const double *prd = domain->prd;
  const double shortest = MIN(MIN(prd[0], prd[1]), domain->dimension == 3 ? prd[2] : prd[1]);
  if (apart <= 1 || apart * longest < shortest || warned_lost_) return;
  warned_lost_ = true;
  error->warning(FLERR,
                 "{}: {} moved by {:.3g} in one step, but LAMMPS takes atoms back into the box "
                 "only every {} steps (neigh_modify every {} "
                 "delay {}) and loses those that have gone farther than a box length: use "
                 "neigh_modify every 1 delay 0 check yes",
                 name_, describe(index), longest, apart, neighbor->every, neighbor->delay);
}

void FixBD::initial_integrate(int)
{
  if (!built_)
    error->all(FLERR,
               "{}: it was defined after the last setup, and has not been initialised: use run "
               "with pre yes",
               name_);
  longest_ = 0.0;
  watch_neighbor_builds();
  watch_step_number();
  update_quantities();
  const bdh::PhaseTimes before = bdh::PhaseClock::mine().times();
  {
    const bdh::PhaseScope rest(bdh::Phase::other);
    run_core(
        error, name_, [this] { take_step(); }, [this](long i) { return describe(i); });
  }
  const bdh::PhaseTimes &after = bdh::PhaseClock::mine().times();
  for (size_t p = 0; p < times_.size(); ++p) times_[p] += after[p] - before[p];
}

/// True if the run, or the timer command, asks for no statistics.
bool FixBD::is_silent_run() const
{
  if (!timer->has_normal()) return true;
  for (int k = 0; k + 1 < input->narg; ++k)
    if (strcmp(input->arg[k], "post") == 0 && strcmp(input->arg[k + 1], "no") == 0) return true;
  return false;
}

/// Time of a phase over the ranks, as LAMMPS shows its own; empty if no rank was in it. Collective.
std::string FixBD::timing_line(int phase, double all) const
{
  const double mine[2] = {times_[phase], times_[phase] * times_[phase]},
               range[2] = {-mine[0], mine[0]};
  double sum[2], extreme[2];    // - least, greatest
  MPI_Allreduce(mine, sum, 2, MPI_DOUBLE, MPI_SUM, world);
  MPI_Allreduce(range, extreme, 2, MPI_DOUBLE, MPI_MAX, world);
  const double average = sum[0] / comm->nprocs;
  if (extreme[1] == 0.0) return "";
  const double spread = sum[1] / comm->nprocs / average - average;
  return fmt::format("{:<8s}| {:<10.5g} | {:<10.5g} | {:<10.5g} |{:6.1f} |{:6.2f}\n",
                     bdh::phase_name(phase), -extreme[0], average, extreme[1],
                     average > 0.001 && spread > 1e-10 ? 100.0 * std::sqrt(spread) : 0.0,
                     100.0 * average / all);
}

/// setup() is not called before a run with pre no, nor before minimize, which takes no steps.
void FixBD::post_run()
{
  show_times();
  times_.fill(0.0);
}

/// Collective.  LAMMPS counts all of this as Modify.
void FixBD::show_times() const
{
  double mine = 0.0, all = 0.0;
  for (double t : times_) mine += t;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  if (is_silent_run() || all == 0.0) return;
  all /= comm->nprocs;
  std::string text =
      fmt::format("\nTiming breakdown of fix {} {}: {:.6g} s for {} steps\n"
                  "Section |  min time  |  avg time  |  max time  |%varavg| %total\n"
                  "---------------------------------------------------------------\n",
                  id, style, all, update->nsteps);
  for (int p = 0; p < bdh::phase_count; ++p) text += timing_line(p, all);
  if (comm->me == 0) utils::logmesg(lmp, text + "\n");
}

std::array<double, 2> FixBD::radius_range() const
{
  double range[2] = {-HUGE_VAL, -HUGE_VAL}, all[2];    // - least, greatest
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      range[0] = MAX(range[0], -atom->radius[i]);
      range[1] = MAX(range[1], atom->radius[i]);
    }
  MPI_Allreduce(range, all, 2, MPI_DOUBLE, MPI_MAX, world);
  return {-all[0], all[1]};
}

bdh::Particles &FixBD::gather_particles()
{
  particles_->gather();
  return *particles_;
}

const std::vector<int> &FixBD::group_atoms() const { return particles_->atoms(); }

std::string FixBD::describe(long index) const { return particles_->describe(index); }

/* ---------------------------------------------------------------------- */

double FixBD::compute_scalar()
{
  double longest = 0.0;
  MPI_Allreduce(&longest_, &longest, 1, MPI_DOUBLE, MPI_MAX, world);
  return longest > 0.0 ? longest / longest_move() : 0.0;
}

double FixBD::compute_vector(int n)
{
  Figures all = figures_;
  MPI_Allreduce(&figures_.long_moves, &all.long_moves, 1, MPI_DOUBLE, MPI_SUM, world);
  const double list[] = {
      all.solver_iterations, all.lanczos_iterations, all.error_estimate, all.radius,
      all.spacing,           all.temperature,        all.viscosity,      all.long_moves};
  return list[n];
}

/// fix adapt and library users reach the two constants here.
void *FixBD::extract(const char *what, int &dim)
{
  dim = 0;
  if (strcmp(what, "temperature") == 0 && !temperature_.is_variable()) return &temperature_.value;
  if (strcmp(what, "viscosity") == 0 && !viscosity_.is_variable()) return &viscosity_.value;
  return nullptr;
}

double FixBD::memory_usage()
{
  return mobility_memory() + particles_->memory() +
         (carried_ ? carried_columns() * sizeof(double) * static_cast<double>(atom->nmax) : 0.0);
}

/* ---------------------------------------------------------------------- */

void FixBD::grow_arrays(int nmax)
{
  memory->grow(carried_, nmax, carried_columns(), "fix_bd:carried");
}

void FixBD::copy_arrays(int i, int j, int)
{
  std::copy_n(carried_[i], carried_columns(), carried_[j]);
}

int FixBD::pack_exchange(int i, double *buffer)
{
  std::copy_n(carried_[i], carried_columns(), buffer);
  return carried_columns();
}

int FixBD::unpack_exchange(int i, double *buffer)
{
  std::copy_n(buffer, carried_columns(), carried_[i]);
  return carried_columns();
}

/// carried_ := no displacement, and force and torque of every atom.
void FixBD::save_start_of_step()
{
  for (int i = 0; i < atom->nlocal; ++i)
    for (int d = 0; d < 3; ++d) {
      carried_[i][d] = 0.0;
      carried_[i][3 + d] = atom->f[i][d];
      carried_[i][6 + d] = atom->torque_flag ? atom->torque[i][d] : 0.0;
    }
}

void FixBD::restore_start_of_step() const
{
  for (int i = 0; i < atom->nlocal; ++i)
    for (int d = 0; d < 3; ++d) {
      atom->f[i][d] = carried_[i][3 + d];
      if (atom->torque_flag) atom->torque[i][d] = carried_[i][6 + d];
    }
  atom->sync_modify(Host, EMPTY_MASK, atom->torque_flag ? F_MASK | TORQUE_MASK : F_MASK);
}
