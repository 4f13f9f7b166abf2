/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fix_bd_fib_kokkos.h"

#include "bdh_force_watch_kokkos.h"
#include "bdh_lammps_kokkos.h"
#include "fib/on_device_kokkos.h"

using namespace LAMMPS_NS;

using DeviceFibEngine =
    FibEngineOn<bdh::FibOnDevice<LMPDeviceType::execution_space>, DeviceGroup<LMPDeviceType>>;

FixBDFibKokkos::FixBDFibKokkos(LAMMPS *lmp, int narg, char **arg) : FixBDFib(lmp, narg, arg)
{
  use_kokkos(this, lmp, name_);
  group_.take_forces_from(std::make_unique<KokkosForces>(lmp));
  if (works_on_device(style, comm->nprocs, group_)) {
    use_device(this, *lmp->kokkos);
    use_slabs(lmp, name_, options_.fft);
    auto engine =
        std::make_unique<DeviceFibEngine>(lmp, bdh::host_workers(), lmp, name_, groupbit, scene_,
                                          judge_, group_.unwraps(), &group_.orientations());
    force_watch_ =
        std::make_unique<DeviceForceWatch<LMPDeviceType>>(lmp, groupbit, engine->particles());
    engine_ = std::move(engine);
    if (!given_.act()) columns_.give_up();
  } else {
    engine_ = std::make_unique<HostFibEngine>(lmp, bdh::host_workers(), group_);
  }
  if (group_.orientations().turn()) use_rotation(this);
}

void FixBDFibKokkos::init()
{
  FixBDFib::init();
  warn_of_rounded_half_box(lmp, name_, warned_half_box_);
}

PlanText FixBDFibKokkos::plan_text() const
{
  PlanText text = FixBDFib::plan_text();
  text.line("kernels", kernels_text(style, comm->nprocs, group_));
  return text;
}
