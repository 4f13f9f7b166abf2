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
#include "bdh_lammps.h"
#include "bdh_lammps_classes.h"
#include "citeme.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "group.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
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

namespace {

bool same_cell(const bdh::Cell &a, const bdh::Cell &b)
{
  return std::equal(a.lo, a.lo + 3, b.lo) && a.lx == b.lx && a.ly == b.ly && a.lz == b.lz &&
         a.xy == b.xy && a.xz == b.xz && a.yz == b.yz;
}

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
    planning_(lmp, name_, igroup, options_, solvent_, scene_), check_(lmp, name_)
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
  method_ = {options_.hydrodynamics, "split", "euler"};
  comm_forward = bdh::dof;
  restart_global = 1;
  if (options_.split) {
    group_.keep_start_of_step(std::make_unique<MidpointForces>(lmp));
    kept_ = {columns_.add(bdh::noise_entries), columns_.add(bdh::dof)};
    columns_.keep_in_restart(kept_.last_noise);    // the next step needs it
    create_attribute = restart_peratom = 1;
  }
  if (options_.parts) {
    parts_ = columns_.add(2 * bdh::dof);
    peratom_flag = create_attribute = peratom_freq = 1;
    size_peratom_cols = parts_.width;
  }
  engine_ = std::make_unique<HostPseEngine>(lmp, engine_parts(), *pairs_, bdh::Workers::one());
  columns_.attach();
}

void FixBDPse::post_constructor()
{
  restore_from_other_suffix(*modify, *this, atom->nlocal, pse_styles);
}

/// The plan: a run goes on with the same numbers, whatever has become of the box.
void FixBDPse::write_restart(FILE *file)
{
  if (comm->me) return;
  const std::vector<char> state = planning_.save();
  const int size = static_cast<int>(sizeof(int) + state.size()), length = state.size();
  fwrite(&size, sizeof size, 1, file);
  fwrite(&length, sizeof length, 1, file);
  fwrite(state.data(), 1, state.size(), file);
}

void FixBDPse::restart(char *state)
{
  int length = 0;
  memcpy(&length, state, sizeof length);
  planning_.restore(state + sizeof length, length);
}

int FixBDPse::setmask() { return FixBD::setmask() | POST_NEIGHBOR; }

int FixBDPse::pack_forward_comm(int n, int *list, double *buffer, int, int *)
{
  return pairs_->ghosts().pack(n, list, buffer);
}

void FixBDPse::unpack_forward_comm(int n, int first, double *buffer)
{
  pairs_->ghosts().unpack(n, first, buffer);
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

void FixBDPse::init()
{
  FixBD::init();
  if (update->whichflag == 2) pairs_->forget_list();
}

void FixBDPse::build()
{
  const bool is_new = planning_.prepare();
  if (!options_.hydrodynamics) {
    if (planning_.is_made()) use_plan(is_new);
    return;
  }
  pairs_->check(planning_.is_made() ? planning_.plan().radius : 1.0);
  if (!planning_.is_made()) {
    pairs_->request_for_strangers(instance_me);
    return;
  }
  use_plan(is_new);
  const bdh::PsePlan &plan = planning_.plan();
  if (options_.check && (is_new || !check_.is_ready())) check_.prepare(plan, planning_.made_for());
  pairs_->request(plan, options_.check ? MAX(plan.r_cut, check_.cutoff()) : plan.r_cut,
                  instance_me);
}

/// Collective.
void FixBDPse::use_plan(bool is_new)
{
  const bdh::PsePlan &plan = planning_.plan();
  figures_.radius = plan.radius;
  figures_.spacing = plan.spacing;
  judge_.set_limit(plan.radius, "the radius");
  if (is_new || grid_memory_ == 0.0) grid_memory_ = engine_->make(plan);
  cell_ = cell_now(*domain);
  engine_->set_cell(cell_);
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
  if (!options_.check || !options_.hydrodynamics || !planning_.is_made()) return;
  guard([this] { with_remedy([this] { check_.run(*engine_, group_, step_plan()); }); });
}

bdh::PseStepPlan FixBDPse::step_plan() const
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
  if (!planning_.is_made() || !planning_.fits_box()) follow_scene();
  if (!planning_.is_made()) return;    // there is no particle
  // They are where they were before the box, or another fix, moved atoms since the last forces.
  if (options_.hydrodynamics) pairs_->refresh_ghosts();
  follow_box();
  const auto take = [this] { return with_remedy([this] { return engine_->step(step_plan()); }); };
  bdh::PseReport report;
  for (int attempt = 0;; ++attempt) {
    try {
      report = take();
      break;
    } catch (const SceneChanged &) {
      if (attempt)
        error->all(FLERR, "{}: step {}: no plan suits the {} particles of the group as they are",
                   name_, update->ntimestep, group->count(igroup));
      follow_scene();
    }
  }
  figures_.lanczos_iterations = report.iterations;
  figures_.error_estimate = report.root_error;
  if (options_.parts) {
    columns_.clear_all();    // atoms may have left the group
    columns_.set(parts_, 0, group_.atoms(), engine_->by_forces(), update->dt);
    columns_.set(parts_, 3, group_.atoms(), engine_->by_noise(), update->dt);
  }
}

/// Collective.  Within a run the list of pairs can become shorter, but not longer.
void FixBDPse::follow_scene()
{
  if (!planning_.follow(pairs_->reach())) return;
  use_plan(true);
  check_.expire();
  if (options_.hydrodynamics) pairs_->shorten(planning_.plan().r_cut);
}

/// Collective.
void FixBDPse::follow_box()
{
  const bdh::Cell cell = cell_now(*domain);
  if (same_cell(cell, cell_)) return;
  cell_ = cell;
  if (!engine_->set_cell(cell) || comm->me) return;
  const std::array<long, 3> n = engine_->plan().n;
  utils::logmesg(lmp, "{}: step {}: the box has changed, new grid {} x {} x {}\n", name_,
                 update->ntimestep, n[0], n[1], n[2]);
}
