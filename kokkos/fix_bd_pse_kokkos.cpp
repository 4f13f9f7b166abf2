/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/, Sandia National Laboratories

   This software is distributed under the GNU General Public License.
------------------------------------------------------------------------- */

#include "fix_bd_pse_kokkos.h"

#include "atom_kokkos.h"
#include "bdh_lammps_kokkos.h"
#include "comm.h"
#include "force.h"
#include "neigh_list_kokkos.h"
#include "neigh_request.h"
#include "neighbor.h"

using namespace LAMMPS_NS;

FixBDPseKokkos::FixBDPseKokkos(LAMMPS *lmp, int narg, char **arg) : FixBDPse(lmp, narg, arg)
{
  use_kokkos(this, lmp, name_);
}

const bdh::Workers &FixBDPseKokkos::workers() const { return bdh::host_workers(); }

std::string FixBDPseKokkos::plan_text() const
{
  return FixBDPse::plan_text() +
      fmt::format("  {:<12} {}; neighbor list {}\n", "kernels", kernels_text(style, "fix bd/fib"),
                  uses_kokkos_list() ? "by the KOKKOS package" : "by one thread (with newton off it is by all: -pk kokkos newton off)");
}

/// Lists of a GPU are laid out by columns and lie in its memory, and with newton on the KOKKOS package makes no list whose
/// pairs with ghosts are in the rows of both atoms.  There the plain list of the host is asked for.
bool FixBDPseKokkos::uses_kokkos_list() const
{
  return std::is_same<LMPDeviceType, LMPHostType>::value &&
      std::is_same<LMPDeviceType::array_layout, Kokkos::LayoutRight>::value && !force->newton_pair;
}

void FixBDPseKokkos::build()
{
  FixBDPse::build();
  if (uses_kokkos_list()) neighbor->requests[neighbor->nrequest - 1]->kokkos_device = 1;
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
  atomKK->sync(Host, X_MASK);
}
