/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/, Sandia National Laboratories

   This software is distributed under the GNU General Public License.
------------------------------------------------------------------------- */

#include "fix_bd_pse_kokkos.h"

#include "atom_kokkos.h"
#include "bdh_backend_kokkos.h"
#include "bdh_lammps_kokkos.h"
#include "bdh_pse_kokkos.h"
#include "comm.h"
#include "domain.h"
#include "force.h"
#include "group.h"
#include "neigh_list_kokkos.h"
#include "neigh_request.h"
#include "neighbor.h"

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

/// True for a particle with a force.
struct HasForce {
  const double *f;
  KOKKOS_INLINE_FUNCTION bool operator()(long p) const { return f[3 * p] != 0.0 || f[3 * p + 1] != 0.0 || f[3 * p + 2] != 0.0; }
};

}    // namespace

/// The device's part of the fix.
struct FixBDPseKokkos::OnDevice {
  DeviceGroup<LMPDeviceType> particles;
  std::unique_ptr<bdh::DevicePse> mobility;
  bdh::DeviceArray<double, Space> velocity, displacement;
  // Of the neighbor list; they change with it.
  int most = 0, most_extra = 0;
  bdh::DeviceArray<int, Space> particle, extra_begin, extra;
};

FixBDPseKokkos::FixBDPseKokkos(LAMMPS *lmp, int narg, char **arg) : FixBDPse(lmp, narg, arg)
{
  use_kokkos(this, lmp, name_);
  take_forces_from(std::make_unique<KokkosForces>(lmp));
  if (!wants_device(style) || !why_not_device().empty()) return;
  use_device(this);
  device_.reset(new OnDevice{DeviceGroup<LMPDeviceType>(lmp, groupbit,
                                                        [this](double longest, long farthest, double count) {
                                                          judge_moves(longest, farthest, count);
                                                        }),
                             nullptr, {}, {}});
}

FixBDPseKokkos::~FixBDPseKokkos() = default;

const bdh::Workers &FixBDPseKokkos::workers() const { return bdh::host_workers(); }

/// What keeps the fix from the kernels of the device; empty: nothing.
std::string FixBDPseKokkos::why_not_device() const
{
  if (comm->nprocs > 1) return "one process";
  if (options_.split) return "scheme euler";
  if (options_.parts) return "runs without keyword parts";
  if (options_.check) return "runs without keyword check";
  return "";
}

std::string FixBDPseKokkos::plan_text() const
{
  const char *list = device_ ? "full, by the KOKKOS package"
      : uses_kokkos_list()   ? "by the KOKKOS package"
                             : "by one thread (with newton off it is by all: -pk kokkos newton off)";
  return FixBDPse::plan_text() + fmt::format("  {:<12} {}; neighbor list {}\n", "kernels", kernels_text(style, why_not_device()), list);
}

double FixBDPseKokkos::mobility_memory() const
{
  if (!device_) return FixBDPse::mobility_memory();
  const auto &m = device_->mobility;
  return device_->particles.memory() + (m ? static_cast<double>(m->grid_memory() + m->particle_memory()) : 0.0);
}

/* ----------------------------------------------------------------------
   neighbors
------------------------------------------------------------------------- */

/// Lists of a GPU are laid out by columns and lie in its memory, and with newton on the KOKKOS package makes no half list
/// whose pairs with ghosts are in the rows of both atoms.  There the host asks for the plain list.
bool FixBDPseKokkos::uses_kokkos_list() const
{
  return device_ ||
      (!has_gpu && std::is_same<LMPDeviceType::array_layout, Kokkos::LayoutRight>::value && !force->newton_pair);
}

void FixBDPseKokkos::adjust_request(NeighRequest &request) const
{
  if (uses_kokkos_list()) request.kokkos_device = 1;
  if (!device_) return;
  request.half = 0;
  request.full = 1;
}

/// Rows of a Kokkos list are arrays of their own.
bdh::NeighborView FixBDPseKokkos::neighbor_view() const
{
  bdh::NeighborView v = FixBDPse::neighbor_view();
  if (!uses_kokkos_list()) return v;
  const auto &list = *static_cast<NeighListKokkos<LMPDeviceType> *>(list_);
  first_neighbor_.resize(static_cast<size_t>(atom->nlocal));
  for (int row = 0; row < list.inum; ++row) {
    const int i = list.d_ilist(row);
    first_neighbor_[static_cast<size_t>(i)] = &list.d_neighbors(i, 0);
  }
  v.atom = list.d_ilist.data();
  v.count = list.d_numneigh.data();
  v.neighbors = first_neighbor_.data();
  return v;
}

void FixBDPseKokkos::refresh_ghosts()
{
  FixBDPse::refresh_ghosts();
  atomKK->sync(device_ ? execution_space : Host, X_MASK);
}

void FixBDPseKokkos::post_neighbor()
{
  if (device_) atomKK->sync(Host, ALL_MASK);    // bonds and positions, with which unlisted pairs are found
  FixBDPse::post_neighbor();
}

/// What only changes with the neighbor list, or with a dynamic group: made on the host, and copied.
void FixBDPseKokkos::renew_neighbors()
{
  atomKK->sync(Host, DeviceGroup<LMPDeviceType>::datamask_read);
  gather_particles();
  map_particles();
  OnDevice &d = *device_;
  d.particle.assign(particle_of_.data(), particle_of_.size());
  const auto &list = *static_cast<NeighListKokkos<LMPDeviceType> *>(list_);
  d.most = 0;
  if (list.inum > 0)
    Kokkos::parallel_reduce("bdh::largest_count", Kokkos::RangePolicy<Space, Kokkos::IndexType<long>>(0, list.inum),
                            LargestCount{list.d_ilist.data(), list.d_numneigh.data()}, Kokkos::Max<int>(d.most));
  std::vector<std::vector<int>> extra(group_atoms().size());
  const auto add = [&](int i, int j) {
    if (particle_of_[i] >= 0) extra[static_cast<size_t>(particle_of_[i])].push_back(j);
  };
  for (const auto &pair : unlisted_) {
    add(pair.first, pair.second);
    if (pair.second < atom->nlocal) add(pair.second, pair.first);    // with ghosts each row has its own
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

bdh::DeviceNeighbors FixBDPseKokkos::device_neighbors() const
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
  device_->mobility = bdh::DevicePse::make<Space>(plan_, options_.iterations);
  return static_cast<double>(device_->mobility->grid_memory());
}

bool FixBDPseKokkos::update_cell() { return device_ ? device_->mobility->set_cell(cell()) : FixBDPse::update_cell(); }

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
  if (neighbors_changed_ || group->dynamic[igroup]) renew_neighbors();
  d.particles.gather(false, force->ftm2v, longest_move());
  bdh::check_finite_forces<Backend>(d.particles);
  const long n = d.particles.size(), lost = Backend::first("bdh::lost", n, bdh::NotFinite{d.particles.x()});
  if (lost >= 0)
    throw bdh::BadParticle(lost, "its position is not a finite number: use a smaller timestep, and look at what else moves atoms");
  d.velocity.resize(static_cast<std::size_t>(3 * n));
  d.displacement.resize(d.velocity.size());
  d.mobility->bind(d.particles.x(), n, device_neighbors());
  with_remedy([this] { find_velocities(); });
  Backend::for_each("bdh::displacement", 3 * n, bdh::Scale<double>{update->dt, d.velocity.data(), d.displacement.data()});
  d.particles.finish(d.displacement, d.velocity);
}

/// velocity := M F + noise
void FixBDPseKokkos::find_velocities()
{
  OnDevice &d = *device_;
  const double *f = d.particles.force();
  const bool forces = Backend::first("bdh::forces", d.particles.size(), HasForce{f}) >= 0;
  figures_.lanczos_iterations = figures_.error_estimate = 0.0;
  if (kT_ == 0.0) {
    if (forces)
      d.mobility->apply(f, core_viscosity_, d.velocity.data());
    else
      d.velocity.clear_values();
    return;
  }
  const bdh::PseNoise noise{kT_ / update->dt, seed_, static_cast<uint64_t>(update->ntimestep)};
  const bdh::PseReport report = d.mobility->fluctuate(forces, f, noise, d.particles.ids(), core_viscosity_, d.velocity.data());
  figures_.lanczos_iterations = report.iterations;
  figures_.error_estimate = report.root_error;
}

std::string FixBDPseKokkos::describe(long index) const
{
  return device_ ? device_->particles.describe(index) : FixBDPse::describe(index);
}
