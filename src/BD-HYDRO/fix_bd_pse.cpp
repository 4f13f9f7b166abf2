/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fix_bd_pse.h"

#include "atom.h"
#include "base/workers.h"
#include "citeme.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix_deform.h"
#include "modify.h"
#include "update.h"

#include <algorithm>

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

namespace {

/// Complaints of Lanczos, with what to do about them.
template <class Body> auto with_remedy(Body body)
{
  try {
    return body();
  } catch (const bdh::NotConverged &e) {
    throw bdh::NotConverged(std::string(e.what()) +
                            ": use more iterations, a larger xi or a looser tolerance");
  }
}

}    // namespace

FixBDPse::FixBDPse(LAMMPS *lmp, int narg, char **arg) :
    FixBD(lmp, narg, arg), pairs_(new PairSource(lmp, this, name_)),
    planning_(lmp, name_, igroup, options_, group_, solvent_), check_(lmp, name_)
{
  if (lmp->citeme) lmp->citeme->add(cite_fix_bd_pse);
  run_core(
      error, name_,
      [&] {
        options_ = bdh::parse_pse_options({arg + 3, arg + narg});
      },
      [](long) { return std::string(); });
  if (options_.radius == 0.0 && !atom->radius_flag)
    error->all(FLERR,
               "{}: radius = atom, but the atoms of atom_style {} have no radius: give one as "
               "radius a",
               name_, atom->atom_style);
  solvent_.set(options_.temperature, options_.viscosity);
  seed_ = options_.seed;
  method_ = {true, "split", "euler"};
  comm_forward = 3;
  if (options_.split) {
    group_.keep_start_of_step(std::make_unique<MidpointForces>(lmp));
    kept_ = {columns_.add(bdh::noise_entries), columns_.add(bdh::dof)};
    create_attribute = restart_peratom = 1;
  }
  if (options_.parts) {
    parts_ = columns_.add(6);
    peratom_flag = create_attribute = peratom_freq = 1;
    size_peratom_cols = parts_.width;
  }
  engine_ = std::make_unique<HostPseEngine>(lmp, engine_parts(), *pairs_, bdh::Workers::one());
  columns_.attach(options_.split);
  array_atom = columns_.array();
}

int FixBDPse::setmask() { return FixBD::setmask() | POST_NEIGHBOR; }

int FixBDPse::pack_forward_comm(int n, int *list, double *buffer, int, int *)
{
  return pairs_->pack(n, list, buffer);
}

void FixBDPse::unpack_forward_comm(int n, int first, double *buffer)
{
  pairs_->unpack(n, first, buffer);
}

void FixBDPse::grow_arrays(int nmax)
{
  FixBD::grow_arrays(nmax);
  array_atom = columns_.array();
}

/// The last near noise: the next step needs it.
int FixBDPse::pack_restart(int i, double *buffer)
{
  return columns_.pack_restart(kept_.last_noise, i, buffer);
}

/// A run with scheme split may go on with euler, which keeps nothing.
void FixBDPse::unpack_restart(int i, int which)
{
  if (options_.split) columns_.unpack_restart(kept_.last_noise, i, which);
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
    error->all(FLERR,
               "{}: the box must be periodic in all directions, since Ewald sums know no walls: "
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

void FixBDPse::build()
{
  figures_.radius = planning_.common_radius();
  judge_.set_limit(figures_.radius, "the radius");
  pairs_->check(figures_.radius);
  const bool anew = planning_.replan(figures_.radius);
  const bdh::PsePlan &plan = planning_.plan();
  if (options_.check) check_.prepare(plan, planning_.scene());
  if (anew) grid_memory_ = engine_->make(plan);
  engine_->set_cell(planning_.cell());
  figures_.spacing = plan.spacing;
  pairs_->request(plan, options_.check ? MAX(plan.r_cut, check_.cutoff()) : plan.r_cut,
                  instance_me);
}

std::string FixBDPse::plan_text() const
{
  PlanText text(name_, 12);
  planning_.describe(text, pairs_->ghost_note(), grid_memory_);
  return text.text();
}

void FixBDPse::setup(int vflag)
{
  FixBD::setup(vflag);
  if (!options_.check) return;
  guard([this] { with_remedy([this] { check_.run(*engine_, group_, plan_step()); }); });
}

bdh::PseStepPlan FixBDPse::plan_step() const
{
  bdh::PseStepPlan p;
  p.dt = update->dt;
  p.kT = solvent_.kT();
  p.viscosity = solvent_.viscosity();
  p.substeps = options_.substeps;
  p.parts = options_.parts;
  p.seed = seed_;
  p.step = update->ntimestep;
  return p;
}

void FixBDPse::step()
{
  // They are where they were before the box, or another fix, moved atoms since the last forces.
  pairs_->refresh_ghosts();
  follow_box();
  const bdh::PseReport report = with_remedy([this] { return engine_->step(plan_step()); });
  figures_.lanczos_iterations = report.iterations;
  figures_.error_estimate = report.root_error;
  if (options_.parts) keep_parts();
}

/// Collective.
void FixBDPse::follow_box()
{
  if (!domain->box_change || !engine_->set_cell(planning_.cell()) || comm->me) return;
  const std::array<long, 3> n = engine_->plan().n;
  utils::logmesg(lmp, "{}: step {}: the box has changed, new grid {} x {} x {}\n", name_,
                 update->ntimestep, n[0], n[1], n[2]);
}

/// Keyword parts: the displacements of this step by forces and by noise, by atom.
void FixBDPse::keep_parts()
{
  const std::vector<int> &atoms = group_.atoms();
  const std::vector<double> by_forces = engine_->by_forces(), by_noise = engine_->by_noise();
  for (int i = 0; i < atom->nlocal; ++i) columns_.clear(i);    // atoms that have left the group
  for (size_t p = 0; p < atoms.size(); ++p)
    for (int c = 0; c < 3; ++c) {
      columns_.of(parts_, atoms[p])[c] = update->dt * by_forces[3 * p + c];
      columns_.of(parts_, atoms[p])[3 + c] = update->dt * by_noise[3 * p + c];
    }
}
