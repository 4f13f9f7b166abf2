/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "pair_asakura_oosawa_kokkos.h"

#include "atom_kokkos.h"
#include "atom_masks.h"
#include "bdh_lammps_kokkos.h"
#include "force.h"
#include "kokkos.h"
#include "memory_kokkos.h"
#include "neighbor.h"

#include <type_traits>

using namespace LAMMPS_NS;

/* ---------------------------------------------------------------------- */

template <class DeviceType>
PairAsakuraOosawaKokkos<DeviceType>::PairAsakuraOosawaKokkos(LAMMPS *lmp) : PairAsakuraOosawa(lmp)
{
  require_kokkos(lmp, "pair_style asakura/oosawa/kk");
  kokkosable = 1;
  atomKK = (AtomKokkos *) atom;
  execution_space = ExecutionSpaceFromDevice<DeviceType>::space;
  datamask_read = X_MASK | F_MASK | TYPE_MASK | ENERGY_MASK | VIRIAL_MASK;
  datamask_modify = F_MASK | ENERGY_MASK | VIRIAL_MASK;
}

/* ---------------------------------------------------------------------- */

template <class DeviceType> PairAsakuraOosawaKokkos<DeviceType>::~PairAsakuraOosawaKokkos()
{
  if (copymode || !allocated) return;
  memoryKK->destroy_kokkos(k_eatom, eatom);
  memoryKK->destroy_kokkos(k_vatom, vatom);
  memoryKK->destroy_kokkos(k_cutsq, cutsq);
}

/* ---------------------------------------------------------------------- */

template <class DeviceType>
void PairAsakuraOosawaKokkos<DeviceType>::compute(int eflag_in, int vflag_in)
{
  eflag = eflag_in;
  vflag = vflag_in;
  if (neighflag == FULL) no_virial_fdotr_compute = 1;
  ev_init(eflag, vflag, 0);
  reserve_per_atom_sums();

  atomKK->sync(execution_space, datamask_read);
  atomKK->modified(execution_space, eflag || vflag ? datamask_modify : F_MASK);
  k_cutsq.template sync<DeviceType>();
  k_depletion.template sync<DeviceType>();

  x = atomKK->k_x.template view<DeviceType>();
  f = atomKK->k_f.template view<DeviceType>();
  type = atomKK->k_type.template view<DeviceType>();
  nlocal = atom->nlocal;
  newton_pair = force->newton_pair;
  for (int i = 0; i < 4; i++) special_lj[i] = force->special_lj[i];

  const EV_FLOAT sum = pair_compute<PairAsakuraOosawaKokkos<DeviceType>, void>(
      this, (NeighListKokkos<DeviceType> *) list);
  if (eflag_global) eng_vdwl += sum.evdwl;
  if (vflag_global)
    for (int i = 0; i < 6; i++) virial[i] += sum.v[i];
  if (vflag_fdotr) pair_virial_fdotr_compute(this);

  if (eflag_atom) {
    k_eatom.template modify<DeviceType>();
    k_eatom.template sync<LMPHostType>();
  }
  if (vflag_atom) {
    k_vatom.template modify<DeviceType>();
    k_vatom.template sync<LMPHostType>();
  }
}

/* ----------------------------------------------------------------------
   zeroed arrays for per-atom energies and virials, if requested
------------------------------------------------------------------------- */

template <class DeviceType> void PairAsakuraOosawaKokkos<DeviceType>::reserve_per_atom_sums()
{
  if (eflag_atom) {
    memoryKK->destroy_kokkos(k_eatom, eatom);
    memoryKK->create_kokkos(k_eatom, eatom, maxeatom, "pair:eatom");
    d_eatom = k_eatom.template view<DeviceType>();
  }
  if (vflag_atom) {
    memoryKK->destroy_kokkos(k_vatom, vatom);
    memoryKK->create_kokkos(k_vatom, vatom, maxvatom, "pair:vatom");
    d_vatom = k_vatom.template view<DeviceType>();
  }
}

/* ---------------------------------------------------------------------- */

template <class DeviceType> void PairAsakuraOosawaKokkos<DeviceType>::allocate()
{
  PairAsakuraOosawa::allocate();
  const int n = atom->ntypes + 1;
  memory->destroy(cutsq);
  memoryKK->create_kokkos(k_cutsq, cutsq, n, n, "pair:cutsq");
  d_cutsq = k_cutsq.template view<DeviceType>();
  k_depletion = decltype(k_depletion)("PairAsakuraOosawa:depletion", n, n);
  d_depletion = k_depletion.template view<DeviceType>();
}

/* ---------------------------------------------------------------------- */

template <class DeviceType> void PairAsakuraOosawaKokkos<DeviceType>::init_style()
{
  PairAsakuraOosawa::init_style();
  neighflag = lmp->kokkos->neighflag;
  ListWish wish;
  wish.kokkos_device = std::is_same<DeviceType, LMPDeviceType>::value;
  wish.kokkos_host = !wish.kokkos_device;
  wish.full = neighflag == FULL;
  change_request(*neighbor, this, wish);
}

/* ----------------------------------------------------------------------
   also called by fix adapt after it has changed c or D
------------------------------------------------------------------------- */

template <class DeviceType> double PairAsakuraOosawaKokkos<DeviceType>::init_one(int i, int j)
{
  const double reach_ij = PairAsakuraOosawa::init_one(i, j);
  const Depletion p{c[i][j], D[i][j]};
  k_depletion.view_host()(i, j) = k_depletion.view_host()(j, i) = p;
  k_depletion.template modify<LMPHostType>();
  k_cutsq.template modify<LMPHostType>();    // the caller writes reach_ij^2 into the host copy
  if (i <= MAX_TYPES_STACKPARAMS && j <= MAX_TYPES_STACKPARAMS) {
    m_depletion[i][j] = m_depletion[j][i] = p;
    m_cutsq[i][j] = m_cutsq[j][i] = reach_ij * reach_ij;
  }
  return reach_ij;
}

namespace LAMMPS_NS {
template class PairAsakuraOosawaKokkos<LMPDeviceType>;
#ifdef LMP_KOKKOS_GPU
template class PairAsakuraOosawaKokkos<LMPHostType>;
#endif
}    // namespace LAMMPS_NS
