/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fix_bd_pse_kokkos.h"

#include "atom_kokkos.h"
#include "bdh_lammps_kokkos.h"
#include "comm.h"
#include "domain.h"
#include "fib/backend_kokkos.h"
#include "force.h"
#include "neigh_list_kokkos.h"
#include "neigh_request.h"
#include "neighbor.h"
#include "npair.h"
#include "pse/mobility_kokkos.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

namespace {

using Space = LMPDeviceType::execution_space;
using Backend = bdh::KokkosBackend<Space>;

/// Largest of some counts.
struct LargestCount {
  const int *atom, *count;
  KOKKOS_INLINE_FUNCTION void operator()(long row, int &most) const
  {
    if (count[atom[row]] > most) most = count[atom[row]];
  }
};

/// listed := 1 for a pair of atoms (two entries of pair) of which the first one's row holds the
/// second one, by pair.
struct FindInRow {
  bdh::DeviceNeighbors list;
  const int *pair;
  char *listed;
  KOKKOS_INLINE_FUNCTION void operator()(long p) const
  {
    const int i = pair[2 * p], j = pair[2 * p + 1];
    listed[p] = 0;
    for (int k = 0; k < list.count[i]; ++k)
      if ((list.neighbors[i * list.atom_stride + k * list.neighbor_stride] & list.mask) == j)
        listed[p] = 1;
  }
};

}    // namespace

/// The device's part of the fix.
struct FixBDPseKokkos::OnDevice : bdh::PseSurroundings<bdh::DeviceNeighbors> {
  OnDevice(FixBDPseKokkos &fix, DeviceGroup<LMPDeviceType>::Judge judge) :
      fix(fix), particles(fix.lmp, fix.name_, fix.groupbit, std::move(judge))
  {}
  bool look(bool mine) override
  {
    if (fix.neighbors_changed_ || !particles.consists_of(mapped)) fix.renew_neighbors();
    return mine;
  }
  bdh::DeviceNeighbors neighbors() override { return fix.device_neighbors(); }
  long all() override { return particles.size(); }
  bdh::KeptByAtom kept() override
  {
    moved.resize(3L * fix.atom->nlocal);
    if (fix.kT_ > 0.0) fix.bring_noise();
    return {particles.local(), moved.data(), 3, noise.data(), 4};
  }

  FixBDPseKokkos &fix;
  DeviceGroup<LMPDeviceType> particles;
  std::unique_ptr<bdh::DevicePseMobility> mobility;
  bdh::PseStep<Backend, bdh::DeviceNeighbors> step;
  // Of the neighbor list and the group; they change with them.
  int most = 0, most_extra = 0;
  bdh::DeviceArray<int, Space> mapped, particle, extra_begin,
      extra;    // mapped: the group that the others were made for
  // Of scheme split, by atom: displacement since the beginning of the step, and the last near noise
  // with 1 if there is one.
  bdh::DeviceArray<double, Space> moved, noise;
  bool noise_is_here = false, noise_is_newer = false;    // than the host's
};

FixBDPseKokkos::FixBDPseKokkos(LAMMPS *lmp, int narg, char **arg) : FixBDPse(lmp, narg, arg)
{
  use_kokkos(this, lmp, name_);
  take_forces_from(std::make_unique<KokkosForces>(lmp));
  if (!wants_device(style) || !why_not_device().empty()) return;
  use_device(this);
  device_.reset(new OnDevice(*this, [this](double longest, long farthest, double count) {
    judge_moves(longest, farthest, count);
  }));
}

FixBDPseKokkos::~FixBDPseKokkos() = default;

int FixBDPseKokkos::setmask() { return FixBDPse::setmask() | FixConst::PRE_NEIGHBOR; }

void FixBDPseKokkos::init()
{
  FixBDPse::init();
  warn_of_rounded_half_box(lmp, name_, warned_half_box_);
}

const bdh::Workers &FixBDPseKokkos::workers() const { return bdh::host_workers(); }

/// What keeps the fix from the kernels of the device; empty: nothing.
std::string FixBDPseKokkos::why_not_device() const { return comm->nprocs > 1 ? "one process" : ""; }

std::string FixBDPseKokkos::plan_text() const
{
  const char *list = device_              ? "full, by the KOKKOS package"
                     : uses_kokkos_list() ? "by the KOKKOS package"
                                          : "by one thread";
  return FixBDPse::plan_text() + fmt::format("  {:<12} {}; neighbor list {}\n", "kernels",
                                             kernels_text(style, why_not_device()), list);
}

double FixBDPseKokkos::mobility_memory() const
{
  if (!device_) return FixBDPse::mobility_memory();
  const auto &m = device_->mobility;
  const OnDevice &d = *device_;
  const size_t own = (d.moved.capacity() + d.noise.capacity()) * sizeof(double) +
                     (d.mapped.capacity() + d.particle.capacity() + d.extra_begin.capacity() +
                      d.extra.capacity()) *
                         sizeof(int);
  return d.particles.memory() + static_cast<double>(own + d.step.memory()) +
         (m ? static_cast<double>(m->grid_memory() + m->particle_memory()) : 0.0);
}

/* ----------------------------------------------------------------------
   neighbors
------------------------------------------------------------------------- */

/// Lists of a GPU are laid out by columns and lie in its memory: there the host asks for the plain
/// list.
bool FixBDPseKokkos::uses_kokkos_list() const
{
  return device_ ||
         (!has_gpu && std::is_same<LMPDeviceType::array_layout, Kokkos::LayoutRight>::value);
}

void FixBDPseKokkos::adjust_request(NeighRequest &request) const
{
  if (uses_kokkos_list()) request.kokkos_device = 1;
  if (!device_) return;
  request.half = 0;
  request.full = 1;
}

/// Keyword check gathers forces and ids on the host.
void FixBDPseKokkos::setup(int vflag)
{
  if (device_ && options_.check) atomKK->sync(Host, DeviceGroup<LMPDeviceType>::datamask_read);
  FixBDPse::setup(vflag);
}

/// The KOKKOS package builds every half list by the newton setting of the whole run, whatever was
/// asked for; it takes that once a run, before this.  On the host this fix needs the pairs with
/// ghosts in the rows of both atoms.
void FixBDPseKokkos::setup_pre_neighbor()
{
  if (device_ || !uses_kokkos_list()) return;
  const int newton = force->newton_pair;
  force->newton_pair = 0;
  list_->np->copy_neighbor_info();
  force->newton_pair = newton;
}

/// Rows of a Kokkos list are arrays of their own.
bdh::NeighborView FixBDPseKokkos::neighbor_view() const
{
  bdh::NeighborView v = FixBDPse::neighbor_view();
  if (!uses_kokkos_list()) return v;
  const auto &list = *static_cast<NeighListKokkos<LMPDeviceType> *>(list_);
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

/// In a full list.
void FixBDPseKokkos::drop_listed_pairs(std::vector<std::pair<int, int>> &pairs) const
{
  if (!device_) return FixBDPse::drop_listed_pairs(pairs);
  std::vector<int> atoms;
  for (const auto &p : pairs) atoms.insert(atoms.end(), {p.first, p.second});
  const bdh::DeviceArray<int, Space> on_device(atoms);
  bdh::DeviceArray<char, Space> listed;
  listed.resize(pairs.size());
  Backend::for_each("bdh::find_in_row", bdh::ssize(pairs),
                    FindInRow{device_list(), on_device.data(), listed.data()});
  const std::vector<char> there = listed.to_host();
  size_t left = 0;
  for (size_t p = 0; p < pairs.size(); ++p)
    if (!there[p]) pairs[left++] = pairs[p];
  pairs.resize(left);
}

void FixBDPseKokkos::refresh_ghosts()
{
  FixBDPse::refresh_ghosts();
  atomKK->sync(device_ ? execution_space : Host, X_MASK);
}

void FixBDPseKokkos::post_neighbor()
{
  if (device_)
    atomKK->sync(Host, ALL_MASK);    // bonds and positions, with which unlisted pairs are found
  FixBDPse::post_neighbor();
}

/// What only changes with the neighbor list, or with the group: made on the host, and copied.
void FixBDPseKokkos::renew_neighbors()
{
  if (!device_) return FixBDPse::renew_neighbors();
  atomKK->sync(Host, DeviceGroup<LMPDeviceType>::datamask_read);
  gather_particles();
  map_particles();
  OnDevice &d = *device_;
  d.mapped.assign(group_atoms().data(), group_atoms().size());
  d.particle.assign(particle_of_.data(), particle_of_.size());
  const auto &list = *static_cast<NeighListKokkos<LMPDeviceType> *>(list_);
  d.most = 0;
  if (list.inum > 0)
    Kokkos::parallel_reduce(
        "bdh::largest_count", Kokkos::RangePolicy<Space, Kokkos::IndexType<long>>(0, list.inum),
        LargestCount{list.d_ilist.data(), list.d_numneigh.data()}, Kokkos::Max<int>(d.most));
  std::vector<std::vector<int>> extra(group_atoms().size());
  const auto add = [&](int i, int j) {
    if (particle_of_[i] >= 0) extra[particle_of_[i]].push_back(j);
  };
  for (const auto &pair : unlisted_) {
    add(pair.first, pair.second);
    if (pair.second < atom->nlocal)
      add(pair.second, pair.first);    // with ghosts each row has its own
  }
  std::vector<int> begin(1, 0), all;
  d.most_extra = 0;
  for (const auto &row : extra) {
    all.insert(all.end(), row.begin(), row.end());
    begin.push_back(static_cast<int>(all.size()));
    d.most_extra = MAX(d.most_extra, static_cast<int>(row.size()));
  }
  d.extra_begin.assign(begin.data(), begin.size());
  d.extra.assign(all.data(), all.size());
}

/// The rows alone.
bdh::DeviceNeighbors FixBDPseKokkos::device_list() const
{
  const auto &list = *static_cast<NeighListKokkos<LMPDeviceType> *>(list_);
  bdh::DeviceNeighbors v;
  v.rows = list.inum;
  v.atom = list.d_ilist.data();
  v.count = list.d_numneigh.data();
  v.neighbors = list.d_neighbors.data();
  v.atom_stride = static_cast<long>(list.d_neighbors.stride(0));
  v.neighbor_stride = static_cast<long>(list.d_neighbors.stride(1));
  v.mask = NEIGHMASK;
  return v;
}

bdh::DeviceNeighbors FixBDPseKokkos::device_neighbors() const
{
  bdh::DeviceNeighbors v = device_list();
  v.most = device_->most;
  v.x = atomKK->k_x.view<LMPDeviceType>().data();
  v.particle = device_->particle.data();
  if (device_->most_extra > 0) {
    v.extra_begin = device_->extra_begin.data();
    v.extra = device_->extra.data();
    v.most_extra = device_->most_extra;
  }
  return v;
}

/* ----------------------------------------------------------------------
   mobility and time step
------------------------------------------------------------------------- */

double FixBDPseKokkos::make_mobility()
{
  if (!device_) return FixBDPse::make_mobility();
  device_->mobility.reset();
  device_->mobility = bdh::make_device_pse<Space>(plan_, options_.iterations);
  return static_cast<double>(device_->mobility->grid_memory());
}

/// A probe of the device's kernels.
std::unique_ptr<bdh::PseProbe> FixBDPseKokkos::probe(const bdh::PsePlan *other)
{
  if (!device_) return FixBDPse::probe(other);
  OnDevice &d = *device_;
  std::unique_ptr<bdh::DevicePseMobility> made;
  if (other) {
    made = bdh::make_device_pse<Space>(*other, more_iterations());
    made->set_cell(cell());
  }
  d.particles.gather(false, force->ftm2v, longest_move());
  return std::make_unique<bdh::PseProbeOn<Backend, bdh::DeviceNeighbors>>(
      d.particles, d, core_viscosity_, d.mobility.get(), std::move(made));
}

bool FixBDPseKokkos::update_cell()
{
  return device_ ? device_->mobility->set_cell(cell()) : FixBDPse::update_cell();
}

std::array<long, 3> FixBDPseKokkos::grid_points() const
{
  return device_ ? device_->mobility->plan().n : FixBDPse::grid_points();
}

void FixBDPseKokkos::take_step()
{
  if (!device_) return FixBDPse::take_step();
  OnDevice &d = *device_;
  // They are where they were before the box, or another fix, moved atoms since the last forces.
  refresh_ghosts();
  follow_box();
  d.particles.gather(false, force->ftm2v, longest_move());
  take_with(d.step, d.particles, d, *d.mobility);
}

/* ----------------------------------------------------------------------
   the last near noise: it stays on the device until LAMMPS moves atoms in memory, or writes a
restart file.  The one process of a periodic box exchanges no atoms, but for those that are lost.
------------------------------------------------------------------------- */

/// The device's := the host's, unless it is the newer one; it is going to change.
void FixBDPseKokkos::bring_noise()
{
  OnDevice &d = *device_;
  if (!d.noise_is_here) {
    std::vector<double> noise;
    for (int i = 0; i < atom->nlocal; ++i)
      noise.insert(noise.end(), carried_[i] + last_noise, carried_[i] + last_noise + 4);
    d.noise.assign(noise.data(), noise.size());
  }
  d.noise_is_here = d.noise_is_newer = true;
}

/// The host's := the device's, of the atoms of the last step.
void FixBDPseKokkos::fetch_noise() const
{
  if (!device_ || !device_->noise_is_newer) return;
  const std::vector<double> noise = device_->noise.to_host();
  for (size_t i = 0; 4 * i < noise.size(); ++i)
    std::copy_n(&noise[4 * i], 4, carried_[i] + last_noise);
  device_->noise_is_newer = false;
}

/// The host's is going to change.
void FixBDPseKokkos::replace_noise()
{
  fetch_noise();
  if (device_) device_->noise_is_here = false;
}

void FixBDPseKokkos::copy_arrays(int i, int j, int flag)
{
  replace_noise();
  FixBDPse::copy_arrays(i, j, flag);
}

void FixBDPseKokkos::set_arrays(int i)
{
  replace_noise();
  FixBDPse::set_arrays(i);
}

int FixBDPseKokkos::pack_restart(int i, double *buffer)
{
  fetch_noise();
  return FixBDPse::pack_restart(i, buffer);
}

void FixBDPseKokkos::unpack_restart(int i, int which)
{
  replace_noise();
  FixBDPse::unpack_restart(i, which);
}

/* ---------------------------------------------------------------------- */

std::string FixBDPseKokkos::describe(long index) const
{
  return device_ ? device_->particles.describe(index) : FixBDPse::describe(index);
}
