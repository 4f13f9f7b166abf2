/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(wall/harmonic/kk,FixWallHarmonicKokkos<LMPDeviceType>);
FixStyle(wall/harmonic/kk/device,FixWallHarmonicKokkos<LMPDeviceType>);
FixStyle(wall/harmonic/kk/host,FixWallHarmonicKokkos<LMPHostType>);
// clang-format on
#else

#ifndef LMP_FIX_WALL_HARMONIC_KOKKOS_H
#define LMP_FIX_WALL_HARMONIC_KOKKOS_H

#include "fix_wall_harmonic.h"
#include "kokkos_type.h"

namespace LAMMPS_NS {

/// LAMMPS' fix wall/harmonic, E = epsilon (cutoff - distance)^2, on the device.  The forces on
/// atoms are identical to those of the plain fix; sums over atoms differ by round-off.  Energies,
/// forces on walls, and the global and per-atom virial are computed as in the plain fix.
template <class DeviceType> class FixWallHarmonicKokkos : public FixWallHarmonic {
 public:
  using AT = ArrayTypes<DeviceType>;

  FixWallHarmonicKokkos(class LAMMPS *, int, char **);
  void wall_particle(int, int, double) override;

 private:
  /// Contributions to the per-atom virial [energy] of the walls in one dimension.  Kept as a member
  /// since output needs it on the host.
  Kokkos::DualView<double *, DeviceType> k_virial;

  void tally_virial(int dim, double sum);
};

}    // namespace LAMMPS_NS

#endif
#endif
