/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Names of the KOKKOS package's arrays in all releases of LAMMPS.
#ifndef LMP_BDH_ARRAYS_KOKKOS_H
#define LMP_BDH_ARRAYS_KOKKOS_H

#include "kokkos_type.h"

#include <type_traits>

namespace LAMMPS_NS {

/// AT: ArrayTypes of a device.
template <class AT, class = void> struct ArrayNames {
  using Positions = typename AT::t_kkfloat_1d_3_lr;
  using ConstPositions = typename AT::t_kkfloat_1d_3_lr_randomread;
  using Velocities = typename AT::t_kkfloat_1d_3;
  using Forces = typename AT::t_kkacc_1d_3;
  using Radii = typename AT::t_kkfloat_1d;
  using Energies = typename AT::t_kkacc_1d;
  using Virials = typename AT::t_kkacc_1d_6;
  using TypePairs = typename AT::t_kkfloat_2d;
  // both copies of an array
  using DualForces = typename AT::ttransform_kkacc_1d_3;
  using DualEnergies = typename AT::ttransform_kkacc_1d;
  using DualVirials = typename AT::ttransform_kkacc_1d_6;
  using DualTypePairs = typename AT::ttransform_kkfloat_2d;
};
/// For releases before 2026.
template <class AT> struct ArrayNames<AT, std::void_t<typename AT::t_x_array>> {
  using Positions = typename AT::t_x_array;
  using ConstPositions = typename AT::t_x_array_randomread;
  using Velocities = typename AT::t_v_array;
  using Forces = typename AT::t_f_array;
  using Radii = typename AT::t_float_1d;
  using Energies = typename AT::t_efloat_1d;
  using Virials = typename AT::t_virial_array;
  using TypePairs = typename AT::t_ffloat_2d;
  using DualForces = typename AT::tdual_f_array;
  using DualEnergies = typename AT::tdual_efloat_1d;
  using DualVirials = typename AT::tdual_virial_array;
  using DualTypePairs = typename AT::tdual_ffloat_2d;
};

template <class DeviceType> using Arrays = ArrayNames<ArrayTypes<DeviceType>>;
/// Arrays that have one copy on the host and one on the device.
using DualArrays = ArrayNames<DAT>;

static_assert(
    std::is_same<Arrays<LMPDeviceType>::Forces::non_const_value_type, double>::value &&
        std::is_same<Arrays<LMPDeviceType>::Positions::non_const_value_type, double>::value,
    "BD-HYDRO needs LAMMPS with KOKKOS_PREC=double");

}    // namespace LAMMPS_NS
#endif
