/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_plan_in_use.h"

#include "atom.h"
#include "base/errors.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix.h"
#include "group.h"
#include "neighbor.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

namespace {

bool same_cell(const bdh::Cell &a, const bdh::Cell &b)
{
  return std::equal(a.lo, a.lo + 3, b.lo) && a.lx == b.lx && a.ly == b.ly && a.lz == b.lz &&
         a.xy == b.xy && a.xz == b.xz && a.yz == b.yz;
}

/// Adds the remedy to error messages of the Lanczos process.
template <class Body> auto with_remedy(Body body)
{
  try {
    return body();
  } catch (const bdh::NotConverged &e) {
    throw bdh::NotConverged(std::string(e.what()) +
                            ": use more iterations, a larger xi or a looser tolerance");
  }
}

/// A plan for a neighbor list that is cheap for the present atoms, used while nothing is known of
/// the particles to come.  It reaches far enough for about a hundred neighbors, or half the box.
bdh::PsePlan plan_for_strangers(const Domain &box, bigint atoms)
{
  const double shortest = MIN(MIN(box.prd[0], box.prd[1]), box.prd[2]);
  const double volume = box.prd[0] * box.prd[1] * box.prd[2];
  bdh::PsePlan plan;
  plan.r_cut = MIN(0.5 * shortest, std::cbrt(30.0 * volume / std::max<double>(atoms, 1.0)));
  plan.radius = 0.1 * plan.r_cut;
  return plan;
}

}    // namespace

PlanInUse::PlanInUse(LAMMPS *lmp, const Fix &fix, const std::string &name,
                     const bdh::PseOptions &options, const Solvent &solvent,
                     const Orientations &orientations, GivenMotions &given, Scene &scene,
                     MoveJudge &judge) :
    Pointers(lmp),
    fix_(fix), name_(name), options_(options), solvent_(solvent), orientations_(orientations),
    given_(given), judge_(judge), settings_(lmp, fix, name),
    planning_(lmp, name, fix.igroup, options, solvent, orientations, scene), check_(lmp, name)
{}

void PlanInUse::work_with(std::unique_ptr<PairSource> pairs, std::unique_ptr<PseEngine> engine)
{
  engine_ = std::move(engine);    // the old one refers to the old pairs
  pairs_ = std::move(pairs);
}

void PlanInUse::begin_run(int instance)
{
  given_.check();
  const bool is_new = planning_.prepare();
  if (options_.hydrodynamics) settings_.check(has_plan() ? planning_.plan().radius : 1.0);
  if (has_plan()) use_plan(is_new);
  if (options_.hydrodynamics) request_pairs(is_new, instance);
}

/// At init.
void PlanInUse::request_pairs(bool is_new, int instance)
{
  const bdh::PsePlan plan =
      has_plan() ? planning_.plan() : plan_for_strangers(*domain, atom->natoms);
  double reach = plan.r_cut;
  if (has_plan() && options_.check) {
    if (is_new || !check_.is_ready()) check_.prepare(plan, planning_.made_for());
    reach = MAX(reach, check_.cutoff());
  }
  pairs_->request(reach, instance);
  settings_.allow_neighbors(plan, reach + neighbor->skin);
}

/// Collective.
void PlanInUse::use_plan(bool is_new)
{
  judge_.set_limit(planning_.plan().least_radius, "the radius");
  if (is_new || grid_memory_ == 0.0) grid_memory_ = engine_->make(planning_.plan());
  cell_ = cell_now(*domain);
  engine_->set_cell(cell_);
}

bool PlanInUse::follow()
{
  if (!has_plan() || !planning_.fits_box()) follow_scene();
  if (!has_plan()) return false;
  // The box, or another fix, may have moved atoms since the last forces.
  if (options_.hydrodynamics) pairs_->refresh_ghosts();
  follow_box();
  return true;
}

bdh::PseStepPlan PlanInUse::step_plan() const
{
  bdh::PseStepPlan p;
  p.dt = update->dt;
  p.kT = solvent_.kT();
  p.viscosity = solvent_.viscosity();
  p.substeps = options_.substeps;
  p.parts = options_.parts;
  p.seed = options_.seed;
  p.step = update->ntimestep;
  p.constraint_limit = options_.iterations;
  p.noise_loads = options_.control_variate;
  p.rotation = orientations_.turn();
  if (p.rotation) p.vorticity = flow_now(*domain).half_curl();
  return p;
}

/// Runs body, again with another plan if the particles no longer match the scene.
template <class Body> auto PlanInUse::in_scene(const Body &body)
{
  try {
    return with_remedy(body);
  } catch (const SceneChanged &) {
    follow_scene();
  }
  try {
    return with_remedy(body);
  } catch (const SceneChanged &) {
    error->all(FLERR,
               "{}: step {}: no plan suits the {} particles of the group as they are: use a looser "
               "tolerance, xi auto, or another run from here on",
               name_, update->ntimestep, group->count(fix_.igroup));
  }
  return decltype(body())();
}

bdh::PseReport PlanInUse::step(bdh::PieceChoice &choice)
{
  if (given_.act()) given_.update();
  return in_scene([&] {
    bdh::PseStepPlan plan = step_plan();
    if (options_.choose_substeps) plan.near_steps = &choice;
    return engine_->step(plan, choice);
  });
}

bdh::StepAgainstHalves PlanInUse::compare_with_halves(double limit)
{
  return in_scene([&] { return engine_->compare_with_halves(step_plan(), limit); });
}

/// Collective.  Within a run the list of pairs can become shorter, but not longer.
void PlanInUse::follow_scene()
{
  if (!planning_.follow(pairs_->reach())) return;
  use_plan(true);
  check_.expire();
  if (options_.hydrodynamics) pairs_->shorten(planning_.plan().r_cut);
}

/// Collective.
void PlanInUse::follow_box()
{
  const bdh::Cell cell = cell_now(*domain);
  if (same_cell(cell, cell_)) return;
  cell_ = cell;
  if (!engine_->set_cell(cell) || comm->me) return;
  const std::array<long, 3> n = engine_->plan().n;
  utils::logmesg(lmp, "{}: step {}: the box has changed, new grid {} x {} x {}\n", name_,
                 update->ntimestep, n[0], n[1], n[2]);
}

void PlanInUse::check_tolerance(AtomGroup &group)
{
  if (!options_.check || !options_.hydrodynamics || !has_plan()) return;
  with_remedy([&] { check_.run(*engine_, group, step_plan()); });
}

void PlanInUse::describe(PlanText &text) const
{
  planning_.describe(text, pairs_->ghost_note(), grid_memory_);
  if (orientations_.turn() || options_.rotation != bdh::Rotation::automatic)
    text.line("rotation", orientations_.text());
  if (options_.stresslets) text.line("stresslet", "yes: spheres do not strain with the flow");
  if (!options_.holds.empty()) text.line("held", given_.text());
  if (options_.control_variate) text.line("variate", given_.control_variate_text(solvent_.kT()));
}
