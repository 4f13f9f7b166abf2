/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_pse_engine.h"

#include "atom.h"
#include "base/ssize.h"
#include "comm.h"

using namespace LAMMPS_NS;

/// The surroundings of the particles: neighbors, ghosts and per-atom columns.
class HostPseEngine::Around : public bdh::PseSurroundings<bdh::NeighborView> {
 public:
  explicit Around(HostPseEngine &engine) : e_(engine) {}
  /// Announces that the next look is the first one of a step.
  void begin_step()
  {
    begins_ = true;
    matches_ = e_.group_.matches_scene();
  }
  bool look(bool mine) override
  {
    // A dynamic group may change on a single rank.
    bigint here[4] = {!e_.pairs_.is_current(e_.group_.atoms()), mine, !matches_, e_.group_.size()};
    bigint all[4];
    bdh::Comm(e_.world).sum(here, all, 4);
    if (begins_ && (all[2] || !e_.group_.scene().has_room_for(all[3]))) throw SceneChanged();
    begins_ = false;
    if (all[0]) e_.pairs_.map(e_.group_.atoms());
    return all[1];
  }
  bdh::NeighborView neighbors() override { return e_.pairs_.view(); }
  long all() override
  {
    return e_.options_.hydrodynamics ? e_.pairs_.ghosts().all() : e_.group_.size();
  }
  const double *radii() override
  {
    if (e_.mobility_->plan().is_plain()) return nullptr;
    find_radii();
    return radii_.data();
  }
  bdh::NeighborView shifted(const double *displacement) override
  {
    bdh::NeighborView view = e_.pairs_.view();
    const long mine = bdh::dof * e_.group_.size();
    shift_.assign(bdh::quad * all(), 0.0);
    for (long k = 0; k < mine; ++k)
      shift_[bdh::quad * (k / bdh::dof) + k % bdh::dof] = displacement[k];
    if (e_.comm->nprocs > 1) e_.pairs_.ghosts().forward(shift_.data(), 1);
    const int atoms = e_.atom->nlocal + e_.atom->nghost;
    shifted_.assign(view.x, view.x + bdh::dim * atoms);
    for (int i = 0; i < atoms; ++i)
      if (view.particle[i] >= 0)
        for (int c = 0; c < bdh::dim; ++c)
          shifted_[bdh::dim * i + c] += shift_[bdh::quad * view.particle[i] + c];
    view.x = shifted_.data();
    return view;
  }
  double sum(double mine) const override { return bdh::Comm(e_.world).sum(mine); }
  double greatest(double mine) const override { return bdh::Comm(e_.world).greatest(mine); }
  bdh::KeptByAtom kept() override
  {
    const std::vector<int> &atoms = e_.group_.atoms();
    if (atoms.empty()) return {};
    const int stride = e_.columns_.width();
    double *const noise = e_.columns_.of(e_.kept_.last_noise, 0);
    return {atoms.data(), e_.columns_.of(e_.kept_.moved, 0), stride, noise,
            stride,       noise + force_entry(e_.kept_)};
  }

 private:
  /// Those of the group first, then those of ghosts.
  void find_radii()
  {
    const Atom &atom = *e_.atom;
    const double given = e_.options_.radius;
    radii_.assign(all(), given);
    if (given > 0.0) return;
    const std::vector<int> &atoms = e_.group_.atoms(), &particle = e_.pairs_.ghosts().particle_of();
    for (size_t p = 0; p < atoms.size(); ++p) radii_[p] = atom.radius[atoms[p]];
    if (!e_.options_.hydrodynamics) return;
    for (int i = atom.nlocal; i < atom.nlocal + atom.nghost; ++i)
      if (particle[i] >= bdh::ssize(atoms)) radii_[particle[i]] = atom.radius[i];
  }

  HostPseEngine &e_;
  std::vector<double> radii_, shift_, shifted_;
  bool begins_ = false, matches_ = true;
};

HostPseEngine::HostPseEngine(LAMMPS *lmp, const PseFixParts &fix, PairSource &pairs,
                             const bdh::Workers &workers) :
    Pointers(lmp),
    options_(fix.options), group_(fix.group), pairs_(pairs), columns_(fix.columns), kept_(fix.kept),
    workers_(workers), around_(new Around(*this)), given_(fix.given)
{}

HostPseEngine::~HostPseEngine() noexcept = default;

std::unique_ptr<bdh::HostPseMobility>
HostPseEngine::made_for(const bdh::PsePlan &plan, const bdh::FftSetup &setup, int iterations) const
{
  return bdh::make_pse(plan, iterations, {bdh::Comm(world), setup, &pairs_.ghosts(), workers_});
}

double HostPseEngine::make(const bdh::PsePlan &plan)
{
  if (mobility_ && mobility_->change_radius(plan)) return mobility_->grid_memory();
  mobility_.reset();    // frees its memory first
  mobility_ = made_for(plan, options_.fft, options_.iterations);
  return mobility_->grid_memory();
}

bool HostPseEngine::set_cell(const bdh::Cell &cell)
{
  cell_ = cell;
  return mobility_->set_cell(cell);
}

bdh::PseReport HostPseEngine::step(const bdh::PseStepPlan &plan, bdh::PieceChoice &choice)
{
  group_.gather();
  around_->begin_step();
  if (!given_.act())
    return step_in_pieces(pieces(), group_, plan, choice, step_, *around_, *mobility_);
  const bdh::Constraint constraint = constraint_.of(given_, group_.atoms());
  return step_.take(group_, *around_, *mobility_, plan, constraint);
}

bdh::StepAgainstHalves HostPseEngine::compare_with_halves(const bdh::PseStepPlan &plan,
                                                          double limit)
{
  group_.gather();
  around_->begin_step();
  return halves_of_step(pieces(), group_, plan, limit, step_, *around_, *mobility_);
}

void HostPseEngine::look_again()
{
  group_.gather();
  pairs_.map(group_.atoms());
}

std::unique_ptr<bdh::PseProbe> HostPseEngine::probe(const bdh::PsePlan *other, double viscosity)
{
  std::unique_ptr<bdh::HostPseMobility> made;
  if (other) {
    made = made_for(*other, bdh::FftEffort::estimate, more_iterations(options_));
    made->set_cell(cell_);
  }
  return std::make_unique<bdh::PseProbeOn<bdh::HostExecution, bdh::NeighborView>>(
      group_, *around_, viscosity, mobility_.get(), std::move(made));
}

double HostPseEngine::memory() const
{
  return mobility_ ? mobility_->grid_memory() + mobility_->particle_memory() + step_.memory() : 0.0;
}
