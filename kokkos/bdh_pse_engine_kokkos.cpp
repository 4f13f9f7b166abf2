/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_pse_engine_kokkos.h"

#include "atom_kokkos.h"
#include "atom_masks.h"
#include "force.h"
#include "neigh_list_kokkos.h"
#include "neighbor.h"
#include "npair.h"
#include "nstencil.h"

#include <algorithm>

using namespace LAMMPS_NS;

namespace {

using Space = LMPDeviceType::execution_space;
using KokkosList = NeighListKokkos<LMPDeviceType>;

/// See show_new_stencils().
void show_new_stencil(NeighList *list)
{
  static bigint step = -1;    // not a step of any run, and different each time
  if (list && list->np && list->np->ns)
    list->np->ns->last_stencil = --step;    // copies of a list have none of their own
}

const KokkosList &in_kokkos(const NeighList *list)
{
  return *static_cast<const KokkosList *>(list);
}

/// Finds the largest of some counts.
struct LargestCount {
  const int *atom, *count;
  KOKKOS_INLINE_FUNCTION void operator()(long row, int &most) const
  {
    if (count[atom[row]] > most) most = count[atom[row]];
  }
};

/// listed := 1 if the row of a pair's first atom holds its second atom, else 0.  `pair` has two
/// entries for each pair; the index is that of a pair.
struct FindInRow {
  bdh::DeviceNeighbors list;
  const int *pair;
  char *listed;
  KOKKOS_INLINE_FUNCTION void operator()(long p) const
  {
    const int i = pair[2 * p], j = pair[2 * p + 1];
    listed[p] = 0;
    for (int k = 0; k < list.count[i]; ++k) {
      const int entry = list.neighbors[i * list.atom_stride + k * list.neighbor_stride];
      if ((entry & list.mask) == j) listed[p] = 1;
    }
  }
};

/// Radii of this rank's particles.  The index is that of a particle.
struct GatherRadii {
  Arrays<LMPDeviceType>::Radii radius;
  const int *local;
  double given;    // 0: those of the atoms
  double *to;
  KOKKOS_INLINE_FUNCTION void operator()(long p) const
  {
    to[p] = given > 0.0 ? given : double(radius(local[p]));
  }
};
/// Radii of other ranks' particles, which follow.  The index is that of a ghost.
struct GatherGhostRadii {
  Arrays<LMPDeviceType>::Radii radius;
  const int *particle;
  long atoms, particles;    // of this rank
  double given;
  double *to;
  KOKKOS_INLINE_FUNCTION void operator()(long ghost) const
  {
    const long i = atoms + ghost, p = particle[i];
    if (p >= particles) to[p] = given > 0.0 ? given : double(radius(i));
  }
};

/// to := displacements with room for the fourth number of a quad.  The index is that of a number of
/// `to`.
struct InQuads {
  const double *displacement;
  double *to;
  KOKKOS_INLINE_FUNCTION void operator()(long i) const
  {
    const long p = i / bdh::quad, c = i % bdh::quad;
    to[i] = c < bdh::dof ? displacement[bdh::dof * p + c] : 0.0;
  }
};
/// to := positions with the displacements of particles, quads.  The index is that of an atom.
struct ShiftAtoms {
  bdh::DeviceNeighbors list;
  const double *displacement;
  double *to;
  KOKKOS_INLINE_FUNCTION void operator()(long i) const
  {
    const long p = list.particle[i];
    for (int c = 0; c < bdh::dim; ++c) {
      const double moved = p < 0 ? 0.0 : displacement[bdh::quad * p + c];
      to[bdh::dim * i + c] = list.x[bdh::dim * i + c] + moved;
    }
  }
};

}    // namespace

void LAMMPS_NS::show_new_stencils(const Neighbor &neighbor)
{
  for (int i = 0; i < neighbor.nlist; ++i) show_new_stencil(neighbor.lists[i]);
}

/* ----------------------------------------------------------------------
   pairs for the host
------------------------------------------------------------------------- */

bool LAMMPS_NS::host_reads_kokkos_lists()
{
  return !has_gpu && std::is_same<LMPDeviceType::array_layout, Kokkos::LayoutRight>::value;
}

void KokkosPairs::adjust(ListWish &wish) const { wish.kokkos_device = host_reads_kokkos_lists(); }

void KokkosPairs::refresh_ghosts()
{
  PairSource::refresh_ghosts();
  atomKK->sync(Host, X_MASK);
}

/// The KOKKOS package builds all half lists with the newton setting of the run, whatever setting
/// was requested.  It reads that setting once per run, before this.  This fix needs pairs with
/// ghosts in the rows of both atoms.
void KokkosPairs::before_lists() const
{
  if (!host_reads_kokkos_lists()) return;
  show_new_stencil(list_);
  const int newton = force->newton_pair;
  force->newton_pair = 0;
  if (list_) list_->np->copy_neighbor_info();
  force->newton_pair = newton;
}

/// Each row of a Kokkos list is a separate array.
bdh::NeighborView KokkosPairs::view() const
{
  bdh::NeighborView v = PairSource::view();
  if (!list_ || !host_reads_kokkos_lists()) return v;
  const auto &list = in_kokkos(list_);
  first_neighbor_.resize(atom->nlocal);
  for (int row = 0; row < list.inum; ++row) {
    const int i = list.d_ilist(row);
    first_neighbor_[i] = &list.d_neighbors(i, 0);
  }
  v.atom = list.d_ilist.data();
  v.count = list.d_numneigh.data();
  v.neighbors = first_neighbor_.data();
  return v;
}

/* ----------------------------------------------------------------------
   pairs for the device
------------------------------------------------------------------------- */

void DevicePairs::adjust(ListWish &wish) const { wish.kokkos_device = wish.full = true; }

void DevicePairs::before_lists() const { show_new_stencil(list_); }

void DevicePairs::refresh_ghosts()
{
  PairSource::refresh_ghosts();
  atomKK->sync(ExecutionSpaceFromDevice<LMPDeviceType>::space, X_MASK);
}

/// Pairs missing from the list are found on the host, which has the bonds and positions.
void DevicePairs::list_was_built()
{
  if (!list_) return;
  atomKK->sync(Host, ALL_MASK);
  PairSource::list_was_built();
  built_ = true;
}

bool DevicePairs::is_current(const DeviceGroup<LMPDeviceType> &group) const
{
  return !built_ && group.consists_of(mapped_);
}

void DevicePairs::renew(AtomGroup &group)
{
  atomKK->sync(Host, DeviceGroup<LMPDeviceType>::datamask_read);
  group.gather();
  map(group.atoms());
  mapped_.assign(group.atoms().data(), group.atoms().size());
  particle_.assign(ghosts().particle_of().data(), ghosts().particle_of().size());
  most_ = 0;
  const bdh::DeviceNeighbors list = rows();
  if (list.rows > 0)
    Kokkos::parallel_reduce("bdh::largest_count",
                            Kokkos::RangePolicy<Space, Kokkos::IndexType<long>>(0, list.rows),
                            LargestCount{list.atom, list.count}, Kokkos::Max<int>(most_));
  copy_unlisted(group.atoms().size());
  built_ = false;
}

void DevicePairs::copy_unlisted(std::size_t particles)
{
  std::vector<std::vector<int>> extra(particles);
  const auto add = [&](int i, int j) {
    if (ghosts().particle_of()[i] >= 0) extra[ghosts().particle_of()[i]].push_back(j);
  };
  for (const auto &pair : unlisted()) {
    add(pair.first, pair.second);
    // A pair with a ghost is already given once for each of its two rows.
    if (pair.second < atom->nlocal) add(pair.second, pair.first);
  }
  std::vector<int> begin(1, 0), all;
  most_extra_ = 0;
  for (const auto &row : extra) {
    all.insert(all.end(), row.begin(), row.end());
    begin.push_back(all.size());
    most_extra_ = std::max<int>(most_extra_, row.size());
  }
  extra_begin_.assign(begin.data(), begin.size());
  extra_.assign(all.data(), all.size());
}

/// Removes the pairs that the list has.  A full list holds each pair in the row of its first atom,
/// too.
void DevicePairs::drop_listed(std::vector<std::pair<int, int>> &pairs) const
{
  std::vector<int> atoms;
  for (const auto &p : pairs) atoms.insert(atoms.end(), {p.first, p.second});
  const Array<int> on_device(atoms);
  Array<char> listed;
  listed.resize(pairs.size());
  bdh::DeviceExecution<Space>().for_each("bdh::find_in_row", bdh::ssize(pairs),
                                         FindInRow{rows(), on_device.data(), listed.data()});
  const std::vector<char> there = listed.to_host();
  size_t left = 0;
  for (size_t p = 0; p < pairs.size(); ++p)
    if (!there[p]) pairs[left++] = pairs[p];
  pairs.resize(left);
}

bdh::DeviceNeighbors DevicePairs::rows() const
{
  bdh::DeviceNeighbors v;
  if (!list_) return v;
  const auto &list = in_kokkos(list_);
  v.rows = list.inum;
  v.atom = list.d_ilist.data();
  v.count = list.d_numneigh.data();
  v.neighbors = list.d_neighbors.data();
  v.atom_stride = list.d_neighbors.stride(0);
  v.neighbor_stride = list.d_neighbors.stride(1);
  v.mask = NEIGHMASK;
  return v;
}

bdh::DeviceNeighbors DevicePairs::neighbors() const
{
  bdh::DeviceNeighbors v = rows();
  v.most = most_;
  v.x = atomKK->k_x.view<LMPDeviceType>().data();
  v.particle = particle_.data();
  if (most_extra_ > 0) {
    v.extra_begin = extra_begin_.data();
    v.extra = extra_.data();
    v.most_extra = most_extra_;
  }
  return v;
}

bdh::DeviceNeighbors DevicePairs::shifted(const double *displacement)
{
  bdh::DeviceNeighbors v = neighbors();
  const long mine = mapped_.size(), all = ghosts().all();
  displacement_.resize(bdh::quad * all);
  bdh::device_for<Space>("bdh::in_quads", bdh::quad * mine,
                         InQuads{displacement, displacement_.data()});
  if (comm->nprocs > 1) bdh::fill_ghosts<Space>(ghosts(), displacement_.data(), 1, mine, all);
  shifted_.resize(bdh::dim * particle_.size());
  bdh::device_for<Space>("bdh::shift_atoms", particle_.size(),
                         ShiftAtoms{v, displacement_.data(), shifted_.data()});
  v.x = shifted_.data();
  return v;
}

void DevicePairs::gather_ghost_radii(double given, double *radius) const
{
  const long mine = atom->nlocal, all = bdh::ssize(particle_);
  bdh::device_for<Space>("bdh::gather_ghost_radii", all - mine,
                         GatherGhostRadii{atomKK->k_radius.view<LMPDeviceType>(), particle_.data(),
                                          mine, bdh::ssize(mapped_), given, radius});
}

std::size_t DevicePairs::memory() const
{
  return bdh::bytes_of(mapped_, particle_, extra_begin_, extra_, displacement_, shifted_);
}

/* ----------------------------------------------------------------------
   the noise of scheme split
------------------------------------------------------------------------- */

double *DeviceNoise::bring()
{
  if (!is_here_) {
    std::vector<double> noise;
    for (int i = 0; i < atom->nlocal; ++i) {
      const double *own = columns_.of(column_, i);
      noise.insert(noise.end(), own, own + column_.width);
    }
    noise_.assign(noise.data(), noise.size());
  }
  is_here_ = is_newer_ = true;
  return noise_.data();
}

/// For the atoms of the last step.
void DeviceNoise::bring_home()
{
  if (!is_newer_) return;
  const std::vector<double> noise = noise_.to_host();
  const size_t width = column_.width;
  for (size_t i = 0; width * i < noise.size(); ++i)
    std::copy_n(&noise[width * i], width, columns_.of(column_, i));
  is_newer_ = false;
}

/* ----------------------------------------------------------------------
   the engine
------------------------------------------------------------------------- */

/// The surroundings of the particles: neighbors, and per-atom data of scheme split.
class DevicePseEngine::Around : public bdh::PseSurroundings<bdh::DeviceNeighbors> {
 public:
  explicit Around(DevicePseEngine &engine) : e_(engine) {}
  /// Announces the first look of a step.  hot: noise is drawn in it, or near steps are chosen.
  void begin_step(bool hot)
  {
    begins_ = true;
    hot_ = hot;
  }
  /// Collective.  Finds the group's atoms in the list.  Throws SceneChanged at the beginning of a
  /// step.
  bool look(bool mine) override
  {
    const Group &group = *e_.group_;
    AtomGroup &on_host = e_.host_group_;
    // A dynamic group may change on a single rank.
    bigint here[4] = {!e_.pairs_.is_current(group), mine, begins_ && !group.matches_scene(),
                      group.size()};
    bigint all[4];
    bdh::Comm(e_.world).sum(here, all, 4);
    if (begins_ && (all[2] || !on_host.scene().has_room_for(all[3]))) throw SceneChanged();
    begins_ = false;
    if (all[0]) e_.pairs_.renew(on_host);
    return all[1];
  }
  bdh::DeviceNeighbors neighbors() override { return e_.pairs_.neighbors(); }
  bdh::DeviceNeighbors shifted(const double *displacement) override
  {
    return e_.pairs_.shifted(displacement);
  }
  double sum(double mine) const override { return bdh::Comm(e_.world).sum(mine); }
  double greatest(double mine) const override { return bdh::Comm(e_.world).greatest(mine); }
  long all() override
  {
    return e_.options_.hydrodynamics ? e_.pairs_.ghosts().all() : e_.group_->size();
  }
  bdh::KeptByAtom kept() override
  {
    const int moved = e_.kept_.moved.width;
    moved_.resize(static_cast<long>(moved) * e_.atom->nlocal);
    double *const noise = hot_ ? e_.noise_.bring() : e_.noise_.data();
    return {e_.group_->local(),           moved_.data(), moved, noise, e_.kept_.last_noise.width,
            noise + force_entry(e_.kept_)};
  }
  const double *radii() override
  {
    if (e_.mobility_->plan().is_plain()) return nullptr;
    const Group &group = *e_.group_;
    const double given = e_.options_.radius;
    radii_.resize(all());
    bdh::device_for<Space>("bdh::gather_radii", group.size(),
                           GatherRadii{e_.lmp->atomKK->k_radius.view<LMPDeviceType>(),
                                       group.local(), given, radii_.data()});
    if (e_.options_.hydrodynamics) e_.pairs_.gather_ghost_radii(given, radii_.data());
    return radii_.data();
  }
  std::size_t memory() const { return bdh::bytes_of(moved_, radii_); }

 private:
  DevicePseEngine &e_;
  bool hot_ = false, begins_ = false;
  bdh::DeviceArray<double, Space> moved_;    // the displacement since the beginning of the step
  bdh::DeviceArray<double, Space> radii_;
};

DevicePseEngine::DevicePseEngine(LAMMPS *lmp, const PseFixParts &fix, DevicePairs &pairs,
                                 std::unique_ptr<Group> group) :
    Pointers(lmp),
    options_(fix.options), host_group_(fix.group), pairs_(pairs), kept_(fix.kept),
    group_(std::move(group)), noise_(lmp, fix.columns, fix.kept.last_noise),
    around_(new Around(*this)), given_(fix.given)
{
  if (options_.split) fix.columns.set_mirror(&noise_);
}

DevicePseEngine::~DevicePseEngine() noexcept = default;

bdh::PseDevice DevicePseEngine::parts_of_device() const
{
  return {bdh::Comm(world), &pairs_.ghosts()};
}

double DevicePseEngine::make(const bdh::PsePlan &plan)
{
  if (mobility_ && mobility_->change_radius(plan)) return mobility_->grid_memory();
  mobility_.reset();    // frees its memory first
  mobility_ = bdh::make_device_pse<Space>(plan, options_.iterations, parts_of_device());
  return mobility_->grid_memory();
}

bool DevicePseEngine::set_cell(const bdh::Cell &cell)
{
  cell_ = cell;
  return mobility_->set_cell(cell);
}

bdh::PseReport DevicePseEngine::step(const bdh::PseStepPlan &plan, bdh::PieceChoice &choice)
{
  group_->gather();
  around_->begin_step(plan.kT > 0.0 || plan.near_steps);
  if (!given_.act())
    return step_in_pieces(pieces(), *group_, plan, choice, step_, *around_, *mobility_);
  around_->look(false);    // brings the group on the host up to date
  const bdh::Constraint constraint = constraint_.of(given_, host_group_.atoms());
  return step_.take(*group_, *around_, *mobility_, plan, constraint);
}

bdh::StepAgainstHalves DevicePseEngine::compare_with_halves(const bdh::PseStepPlan &plan,
                                                            double limit)
{
  group_->gather();
  around_->begin_step(plan.kT > 0.0);
  return halves_of_step(pieces(), *group_, plan, limit, step_, *around_, *mobility_);
}

void DevicePseEngine::look_again() { pairs_.renew(host_group_); }

std::unique_ptr<bdh::PseProbe> DevicePseEngine::probe(const bdh::PsePlan *other, double viscosity)
{
  std::unique_ptr<bdh::DevicePseMobility> made;
  if (other) {
    made = bdh::make_device_pse<Space>(*other, more_iterations(options_), parts_of_device());
    made->set_cell(cell_);
  }
  group_->gather();
  return std::make_unique<bdh::PseProbeOn<Execution, bdh::DeviceNeighbors>>(
      *group_, *around_, viscosity, mobility_.get(), std::move(made));
}

double DevicePseEngine::memory() const
{
  double bytes = group_->memory() + around_->memory() + pairs_.memory() + step_.memory() +
                 noise_.memory() + constraint_.memory();
  if (mobility_) bytes += mobility_->grid_memory() + mobility_->particle_memory();
  return bytes;
}
