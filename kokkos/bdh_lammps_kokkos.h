/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/, Sandia National Laboratories

   This software is distributed under the GNU General Public License.
------------------------------------------------------------------------- */

/// What the /kk fixes of this package share.
#ifndef LMP_BDH_LAMMPS_KOKKOS_H
#define LMP_BDH_LAMMPS_KOKKOS_H

#include "atom_masks.h"
#include "bdh_workers_kokkos.h"
#include "error.h"
#include "fix.h"
#include "kokkos.h"
#include "kokkos_type.h"

#include <string>

namespace LAMMPS_NS {

/// The fix works on the host's copies of the atoms, which with a backend of the host are the only ones; with one of a
/// GPU the KOKKOS package copies before and after each call what the masks name.
inline void use_kokkos(Fix *fix, LAMMPS *lmp, const std::string &name)
{
  if (!lmp->kokkos || !lmp->kokkos->kokkos_exists)
    lmp->error->all(FLERR, "{}: a /kk style needs the KOKKOS package: start with -k on", name);
  fix->kokkosable = 1;
  fix->execution_space = Host;
  fix->datamask_read = ALL_MASK;
  fix->datamask_modify = X_MASK | V_MASK;
}

/// For the plan.
inline std::string threads_text()
{
  const int count = bdh::host_workers().count();
  std::string text = fmt::format("{} per process, by Kokkos ({})", count, Kokkos::DefaultHostExecutionSpace::name());
  if (!std::is_same<LMPDeviceType, LMPHostType>::value)
    text += "; this fix works on the host: positions, forces and velocities are copied from and to the GPU at every step";
  return text;
}

}    // namespace LAMMPS_NS
#endif
