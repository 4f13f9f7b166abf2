/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fix_wall_harmonic_kokkos.h"

#include "atom_kokkos.h"
#include "atom_masks.h"
#include "bdh_lammps_kokkos.h"
#include "error.h"
#include "update.h"

using namespace LAMMPS_NS;

namespace {

/// Sums over the atoms of a rank for one wall.
struct WallSums {
  double energy = 0.0;    // [energy]
  double force = 0.0;     // on the wall, along its dimension [force]
  double virial = 0.0;    // [energy]
  tagint outside =
      -1;    // largest id of the atoms on or behind the wall, 0 without ids; -1: no such atom

  KOKKOS_INLINE_FUNCTION WallSums() {}
  KOKKOS_INLINE_FUNCTION void operator+=(const volatile WallSums &other) volatile
  {
    energy = energy + other.energy;
    force = force + other.force;
    virial = virial + other.virial;
    if (other.outside > outside) outside = other.outside;
  }
};

template <class DeviceType> struct HarmonicWall {
  using device_type = DeviceType;
  using value_type = WallSums;
  using AT = ArrayTypes<DeviceType>;

  typename Arrays<DeviceType>::Positions x;
  typename Arrays<DeviceType>::Forces f;
  typename AT::t_int_1d mask;
  typename AT::t_tagint_1d tag;
  Kokkos::View<double *, DeviceType> virial;    // per atom; empty if not requested
  int groupbit, dim;
  double side;    // -1 lower, +1 upper wall
  double coord, cutoff, epsilon;

  KOKKOS_INLINE_FUNCTION void operator()(int i, WallSums &sums) const
  {
    if (!(mask(i) & groupbit)) return;
    const double distance = side * (coord - x(i, dim));
    if (distance >= cutoff) return;
    if (!(distance > 0.0)) {
      if (tag(i) > sums.outside) sums.outside = tag(i);
      return;
    }
    const double depth = cutoff - distance;
    const double push = side * 2.0 * epsilon * depth;
    f(i, dim) -= push;
    sums.energy += epsilon * depth * depth;
    sums.force += push;
    sums.virial += side * push * distance;
    if (virial.extent(0)) virial(i) = side * push * distance;
  }
};

}    // namespace

/* ---------------------------------------------------------------------- */

template <class DeviceType>
FixWallHarmonicKokkos<DeviceType>::FixWallHarmonicKokkos(LAMMPS *lmp, int narg, char **arg) :
    FixWallHarmonic(lmp, narg, arg)
{
  require_kokkos(lmp, "fix wall/harmonic/kk");
  kokkosable = 1;
  atomKK = (AtomKokkos *) atom;
  execution_space = ExecutionSpaceFromDevice<DeviceType>::space;
  datamask_read = X_MASK | F_MASK | MASK_MASK | TAG_MASK;
  datamask_modify = F_MASK;
}

/* ----------------------------------------------------------------------
   wall m of this fix, which = 0..5 for xlo..zhi, at the position coord
------------------------------------------------------------------------- */

template <class DeviceType>
void FixWallHarmonicKokkos<DeviceType>::wall_particle(int m, int which, double coord)
{
  atomKK->sync(execution_space, datamask_read);
  const int nlocal = atom->nlocal;
  const int dim = which / 2;
  k_virial = evflag && vflag_atom ? decltype(k_virial)("wall/harmonic:virial", nlocal)
                                  : decltype(k_virial)();

  const HarmonicWall<DeviceType> wall{atomKK->k_x.template view<DeviceType>(),
                                      atomKK->k_f.template view<DeviceType>(),
                                      atomKK->k_mask.template view<DeviceType>(),
                                      atomKK->k_tag.template view<DeviceType>(),
                                      k_virial.template view<DeviceType>(),
                                      groupbit,
                                      dim,
                                      which % 2 ? 1.0 : -1.0,
                                      coord,
                                      cutoff[m],
                                      epsilon[m]};
  WallSums sums;
  Kokkos::parallel_reduce(Kokkos::RangePolicy<typename DeviceType::execution_space>(0, nlocal),
                          wall, sums);
  atomKK->modified(execution_space, F_MASK);

  if (sums.outside >= 0)
    error->one(FLERR, "Particle on or inside fix wall surface: atom {} at step {}", sums.outside,
               update->ntimestep);
  ewall[0] += sums.energy;
  ewall[m + 1] += sums.force;
  if (evflag) tally_virial(dim, sums.virial);
}

/* ---------------------------------------------------------------------- */

template <class DeviceType>
void FixWallHarmonicKokkos<DeviceType>::tally_virial(int dim, double sum)
{
  if (vflag_global) virial[dim] += sum;
  if (!vflag_atom) return;
  k_virial.template modify<DeviceType>();
  k_virial.template sync<LMPHostType>();
  for (int i = 0; i < atom->nlocal; i++) vatom[i][dim] += k_virial.view_host()(i);
}

namespace LAMMPS_NS {
template class FixWallHarmonicKokkos<LMPDeviceType>;
#ifdef LMP_KOKKOS_GPU
template class FixWallHarmonicKokkos<LMPHostType>;
#endif
}    // namespace LAMMPS_NS
