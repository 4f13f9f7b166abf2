/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Shared parts of the /kk styles of this package.
#ifndef LMP_BDH_LAMMPS_KOKKOS_H
#define LMP_BDH_LAMMPS_KOKKOS_H

#include "atom.h"
#include "atom_masks.h"
#include "base/messages_kokkos.h"
#include "base/workers_kokkos.h"
#include "bdh_forces_kokkos.h"
#include "bdh_group.h"
#include "bdh_group_kokkos.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix.h"
#include "force.h"
#include "kokkos.h"
#include "kokkos_type.h"
#include "neighbor.h"
#include "pair.h"

#include <cmath>
#include <string>

namespace LAMMPS_NS {

constexpr bool has_gpu = !std::is_same<LMPDeviceType, LMPHostType>::value;

/// Makes the fix work on the host's copies of the atoms.  Without a GPU there are no others.  With
/// one the KOKKOS package copies what the masks name before and after each call.
inline void use_host(Fix *fix)
{
  fix->execution_space = Host;
  fix->datamask_read = ALL_MASK;
  fix->datamask_modify = X_MASK | V_MASK;
}

inline void require_kokkos(LAMMPS *lmp, const std::string &name)
{
  if (!lmp->kokkos || !lmp->kokkos->kokkos_exists)
    lmp->error->all(FLERR, "{}: a /kk style needs the KOKKOS package: start with -k on", name);
}

inline void use_kokkos(Fix *fix, LAMMPS *lmp, const std::string &name)
{
  require_kokkos(lmp, name);
  fix->kokkosable = 1;
  use_host(fix);
}

/// At init.  The neighbor lists of the KOKKOS package take the integer below half the box for half
/// the box, and keep bonded pairs farther apart than that as if they had no bond.
inline void warn_of_rounded_half_box(LAMMPS *lmp, const std::string &name, bool &warned)
{
  const Force &force = *lmp->force;
  const Domain &box = *lmp->domain;
  if (warned || lmp->comm->me || lmp->atom->molecular == Atom::ATOMIC || !force.pair ||
      !force.pair->kokkosable)
    return;
  bool special = false;
  for (int level = 1; level <= 3; ++level)
    special |= force.special_lj[level] != 1.0 || force.special_coul[level] != 1.0;
  for (int d = 0; d < box.dimension && special && !warned; ++d) {
    const double half = 0.5 * box.prd[d], whole = std::floor(half);
    if (!box.periodicity[d] || whole == half || whole >= force.pair->cutforce + lmp->neighbor->skin)
      continue;
    warned = true;
    lmp->error->warning(FLERR,
                        "{}: the KOKKOS package rounds half the box, {:.6g}, down to {:.0f} when "
                        "it looks for bonded pairs, so those farther apart than that keep the "
                        "whole pair interaction, whatever special_bonds says: use units in "
                        "which the box is longer",
                        name, half, whole);
  }
}

/// Makes the fix work on the device's copies of the atoms.
inline void use_device(Fix *fix, const KokkosLMP &kokkos)
{
  bdh::mpi_reads_device() = kokkos.gpu_aware_flag;
  fix->execution_space = ExecutionSpaceFromDevice<LMPDeviceType>::space;
  fix->datamask_read = DeviceGroup<LMPDeviceType>::datamask_read;
  fix->datamask_modify = DeviceGroup<LMPDeviceType>::datamask_modify;
}

/// After use_host() or use_device(): the fix turns particles, too.
inline void use_rotation(Fix *fix)
{
  fix->datamask_read |= DeviceGroup<LMPDeviceType>::turning_reads;
  fix->datamask_modify |= DeviceGroup<LMPDeviceType>::turning_modifies;
}

/// Style .../kk/device selects kernels on the device and .../kk/host threads on the host.  Style
/// .../kk selects the former if the device is a GPU.
inline bool wants_device(const std::string &style)
{
  return utils::strmatch(style, "/kk/device$") || (has_gpu && !utils::strmatch(style, "/kk/host$"));
}

/// Forces are evaluated within the step on a device only on one process: atoms that change
/// processors within a step are followed on the host alone.
inline bool works_on_device(const std::string &style, int processes, const AtomGroup &group)
{
  return wants_device(style) && (processes == 1 || !group.midpoint_forces());
}

/// A fix on a device has slabs.
inline void use_slabs(LAMMPS *lmp, const std::string &name, bdh::FftSetup &fft)
{
  if (fft.share > 1)
    lmp->error->all(FLERR,
                    "{} pencils = {}, but a device has only slabs: give 1 for slabs, or use the "
                    "style with /kk/host",
                    name, fft.share);
  fft.share = 1;
}

/// For the plan: where the fix works, and why not on the device if that was requested.
inline std::string kernels_text(const std::string &style, int processes, const AtomGroup &group)
{
  if (works_on_device(style, processes, group)) {
    std::string text =
        fmt::format("of the device, by Kokkos ({}): positions, forces and grids stay there",
                    LMPDeviceType::execution_space::name());
    if (processes > 1) text += "; planes, particles in them and neighbors are exchanged";
    if (processes > 1 && has_gpu)
      text += bdh::mpi_reads_device() ? " from GPU to GPU, but for neighbors, through the host"
                                      : " through the host, since MPI does not read the GPU";
    return text;
  }
  std::string text =
      fmt::format("of the host: {} threads per process, by Kokkos ({})",
                  bdh::host_workers().count(), Kokkos::DefaultHostExecutionSpace::name());
  if (wants_device(style))
    text += "; on several processes those of the device do not evaluate forces within the step";
  if (has_gpu)
    text += "; positions, forces and velocities are copied from and to the GPU at every step";
  return text;
}

}    // namespace LAMMPS_NS
#endif
