/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fix_bd_pse.h"

#include "atom.h"
#include "base/constants.h"
#include "base/workers.h"
#include "bdh_lammps.h"
#include "bdh_lammps_classes.h"
#include "citeme.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "modify.h"
#include "update.h"

#include <cstring>

using namespace LAMMPS_NS;
using namespace FixConst;

static const char cite_fix_bd_pse[] =
    "fix bd/pse: doi:10.1063/1.4978242\n\n"
    "@Article{Fiore2017,\n"
    " author = {A. M. Fiore and F. {Balboa Usabiaga} and A. Donev and J. W. Swan},\n"
    " title = {Rapid sampling of stochastic displacements in {B}rownian dynamics simulations},\n"
    " journal = {J.~Chem.\\ Phys.},\n"
    " volume = {146},\n"
    " pages = {124116},\n"
    " year = {2017}\n"
    "}\n\n";

/// radii_of_atoms: the radii are those of the atoms, so that none belongs to the mobility.
static void note_plan(const bdh::PsePlan &plan, bool radii_of_atoms, StepFigures &figures)
{
  figures.radius = plan.radius;
  figures.spacing = plan.spacing;
  figures.least_radius = plan.least_radius;
  figures.mobility = 1.0 / (6.0 * bdh::pi * (radii_of_atoms ? 1.0 : plan.radius));
}

FixBDPse::FixBDPse(LAMMPS *lmp, int narg, char **arg) :
    FixBD(lmp, narg, arg), given_(lmp, name_, options_),
    in_use_(lmp, *this, name_, options_, solvent_, group_.orientations(), given_, scene_, judge_)
{
  if (lmp->citeme) lmp->citeme->add(cite_fix_bd_pse);
  guard_([&] { options_ = bdh::parse_pse_options({arg + 3, arg + narg}); });
  if (options_.radius == 0.0 && !atom->radius_flag)
    error->all(FLERR,
               "{}: radius = atom, but the atoms of atom_style {} have no radius: give one as "
               "radius a",
               name_, plain_style(atom->atom_style));
  solvent_.set(options_.temperature, options_.viscosity, options_.seed);
  group_.orientations().choose(options_.rotation);
  const bool turn = group_.orientations().turn();
  method_ = {options_.hydrodynamics, "scheme split", "scheme euler", options_.radius == 0.0};
  comm_forward = options_.stresslets ? bdh::strain_slots : turn ? 2 * bdh::dof : bdh::dof;
  restart_global = 1;
  if (options_.split) {
    group_.need_forces_within_step(AtomGroup::ForcesFor::scheme);
    kept_ = {columns_.add(bdh::noise_entries + (turn ? bdh::dof : 0) +
                          (options_.choose_substeps ? bdh::force_entries : 0)),
             columns_.add(turn ? 2 * bdh::dof : bdh::dof)};
    restart_column_.keep(kept_.last_noise);    // the next step needs it
    create_attribute = restart_peratom = 1;
  }
  if (options_.parts) parts_ = std::make_unique<PartsOutput>(*this, columns_, turn);
  if (given_.act())
    constraint_output_ = std::make_unique<ConstraintOutput>(lmp, *this, columns_, options_);
  if (options_.split) stiffness_.set_scheme(excess_of_split, options_.substeps);
  if (options_.check_dt) timestep_check_.ask(group_);
  adaptive_.set(options_.adapt, options_.choose_substeps, group_, stiffness_);
  force_watch_ = std::make_unique<HostForceWatch>(lmp, groupbit, group_, columns_);
  auto pairs = std::make_unique<PairSource>(lmp, this);
  auto engine = std::make_unique<HostPseEngine>(lmp, engine_parts_, *pairs, bdh::Workers::one());
  in_use_.work_with(std::move(pairs), std::move(engine));
  columns_.attach();
  restart_column_.attach();
}

void FixBDPse::post_constructor()
{
  restore_from_other_suffix(*modify, *this, atom->nlocal, pse_styles);
}

/// The restart file holds the plan: a run goes on with the same numbers, whatever has become of the
/// box.  The choice of pieces remembers the forces of earlier ones.
void FixBDPse::write_restart(FILE *file)
{
  if (comm->me) return;
  const std::vector<char> state = in_use_.planning().save();
  const bdh::PieceChoice::State pieces = adaptive_.choice().state();
  const int length = state.size(), size = sizeof length + length + sizeof pieces;
  fwrite(&size, sizeof size, 1, file);
  fwrite(&length, sizeof length, 1, file);
  fwrite(state.data(), 1, state.size(), file);
  fwrite(&pieces, sizeof pieces, 1, file);
}

void FixBDPse::restart(char *state)
{
  int length = 0;
  memcpy(&length, state, sizeof length);
  in_use_.planning().restore(state + sizeof length, length);
  bdh::PieceChoice::State pieces;
  memcpy(&pieces, state + sizeof length + length, sizeof pieces);
  adaptive_.choice().set_state(pieces);
}

int FixBDPse::setmask() { return FixBD::setmask() | PRE_NEIGHBOR | POST_NEIGHBOR; }

int FixBDPse::pack_forward_comm(int n, int *list, double *buffer, int, int *)
{
  return in_use_.pairs().ghosts().pack(n, list, buffer);
}

void FixBDPse::unpack_forward_comm(int n, int first, double *buffer)
{
  in_use_.pairs().ghosts().unpack(n, first, buffer);
}

void FixBDPse::check_box() const
{
  if (lmp->kokkos && !kokkosable)
    error->all(FLERR,
               "{}: the KOKKOS package's copies of the atoms are not kept up to date: use "
               "bd/pse/kk (-sf kk), or run without -k on",
               name_);
  if (domain->dimension == 2)
    error->all(FLERR,
               "{}: the simulation is two-dimensional, but the Rotne-Prager-Yamakawa mobility is "
               "not: use fix bd/fib",
               name_);
  if (!domain->xperiodic || !domain->yperiodic || !domain->zperiodic)
    error->all(
        FLERR,
        "{}: the box must be periodic in all directions, since Ewald sums cannot represent walls: "
        "use boundary p p p, or fix bd/fib for confined suspensions",
        name_);
  for (int f = 0; f < modify->nfix; ++f) {
    const FixDeform *deform = dynamic_cast<const FixDeform *>(modify->fix[f]);
    if (!deform) continue;
    if (deform->remapflag == Domain::V_REMAP)
      error->all(FLERR,
                 "{}: fix {} deform remaps velocities, which here are displacement/timestep: use "
                 "remap x, which carries particles along with the flow",
                 name_, deform->id);
    if (deform->remapflag == Domain::NO_REMAP && comm->me == 0)
      error->warning(FLERR,
                     "{}: fix {} deform changes the box but does not carry particles along (remap "
                     "none): there is no flow; use remap x for one",
                     name_, deform->id);
  }
}

void FixBDPse::init()
{
  FixBD::init();
  if (constraint_output_) constraint_output_->announce();
  if (update->whichflag == 2) in_use_.pairs().forget_list();
}

void FixBDPse::build()
{
  in_use_.begin_run(instance_me);
  if (in_use_.planning().is_made())
    note_plan(in_use_.planning().plan(), method_.radii_of_atoms, figures_);
}

PlanText FixBDPse::plan_text() const
{
  PlanText text(name_, 12);
  in_use_.describe(text);
  return text;
}

void FixBDPse::setup(int vflag)
{
  FixBD::setup(vflag);
  guard_([this] { in_use_.check_tolerance(group_); });
}

bdh::StepAgainstHalves FixBDPse::compare_with_halves(double limit)
{
  bdh::StepAgainstHalves nothing;
  nothing.taken = true;
  return in_use_.follow() ? in_use_.compare_with_halves(limit) : nothing;
}

void FixBDPse::step()
{
  if (!in_use_.follow()) return;
  const bdh::PseReport report = in_use_.step(adaptive_.choice());
  note_plan(in_use_.planning().plan(), method_.radii_of_atoms, figures_);
  figures_.lanczos_iterations = report.iterations;
  figures_.error_estimate = report.root_error;
  if (constraint_output_)
    constraint_output_->keep(
        in_use_.engine().constrained(), group_.atoms(), given_.held(),
        {given_.strain(), flow_now(*domain).half_curl(), solvent_.viscosity(), solvent_.kT()},
        report.constraint_iterations);
  if (parts_) parts_->keep(group_, in_use_.engine(), update->dt);
}

double FixBDPse::compute_vector(int n)
{
  const int first = size_vector - last_figures - Rheology::figures;
  if (!constraint_output_ || n < first || n >= size_vector - last_figures)
    return FixBD::compute_vector(n);
  return constraint_output_->figure(n - first);
}

double FixBDPse::memory_usage() { return FixBD::memory_usage() + in_use_.engine().memory(); }
