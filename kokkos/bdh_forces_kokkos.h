/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Evaluates forces within a time step with styles that run on the host or on the device.
#ifndef LMP_BDH_FORCES_KOKKOS_H
#define LMP_BDH_FORCES_KOKKOS_H

#include "atom_kokkos.h"
#include "atom_masks.h"
#include "atom_vec.h"
#include "bdh_arrays_kokkos.h"
#include "bdh_lammps.h"

namespace LAMMPS_NS {

/// Forces within the step for /kk fixes.  The forces are set to 0 on the device, where the styles
/// that run there need them.
class KokkosForces : public MidpointForces {
 public:
  using MidpointForces::MidpointForces;

 protected:
  void clear_forces() const override
  {
    AtomKokkos &atoms = *atomKK;
    if (atoms.avec->forceclearflag)
      return MidpointForces::clear_forces();    // more arrays, of the atom style
    clear(atoms.k_f, F_MASK);
    if (atoms.torque_flag) clear(atoms.k_torque, TORQUE_MASK);
  }
  /// Kernels may still be adding to them, and messages are sent out of the device's memory.
  void wait_for_forces() const override { Kokkos::fence(); }

 private:
  /// What either copy held, and which one was newer, no longer matters.
  void clear(DualArrays::DualForces &forces, AtomMask mask) const
  {
    forces.clear_sync_state();
    Kokkos::deep_copy(forces.view<LMPDeviceType>(), 0.0);
    atomKK->modified(ExecutionSpaceFromDevice<LMPDeviceType>::space, mask);
  }
};

}    // namespace LAMMPS_NS
#endif
