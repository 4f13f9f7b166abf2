/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/, Sandia National Laboratories

   This software is distributed under the GNU General Public License.
------------------------------------------------------------------------- */

#include "fix_bd_pse_kokkos.h"

#include "atom_kokkos.h"
#include "bdh_lammps_kokkos.h"
#include "comm.h"
#include "neigh_list_kokkos.h"
#include "neigh_request.h"
#include "neighbor.h"

using namespace LAMMPS_NS;

namespace {

// Lists of a GPU are laid out by columns and lie in its memory: there the plain list of the host is asked for.
constexpr bool kokkos_list = std::is_same<LMPDeviceType, LMPHostType>::value &&
    std::is_same<LMPDeviceType::array_layout, Kokkos::LayoutRight>::value;

}    // namespace

FixBDPseKokkos::FixBDPseKokkos(LAMMPS *lmp, int narg, char **arg) : FixBDPse(lmp, narg, arg)
{
  use_kokkos(this, lmp, name_);
}

const bdh::Workers &FixBDPseKokkos::workers() const { return bdh::host_workers(); }

std::string FixBDPseKokkos::plan_text() const
{
  return FixBDPse::plan_text() + fmt::format("  {:<12} {}\n", "threads", threads_text());
}

void FixBDPseKokkos::build()
{
  FixBDPse::build();
  if (kokkos_list) neighbor->requests[neighbor->nrequest - 1]->kokkos_device = 1;
}

/// Rows of a Kokkos list are arrays of their own.
bdh::NeighborView FixBDPseKokkos::neighbor_view() const
{
  bdh::NeighborView v = FixBDPse::neighbor_view();
  if (!kokkos_list) return v;
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
  atomKK->sync(Host, X_MASK);
}
