/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fix_bd_pse_kokkos.h"

#include "atom_kokkos.h"
#include "bdh_force_watch_kokkos.h"
#include "bdh_pse_engine_kokkos.h"
#include "domain.h"
#include "neighbor.h"

using namespace LAMMPS_NS;

FixBDPseKokkos::FixBDPseKokkos(LAMMPS *lmp, int narg, char **arg) : FixBDPse(lmp, narg, arg)
{
  use_kokkos(this, lmp, name_);
  group_.take_forces_from(std::make_unique<KokkosForces>(lmp));
  if (works_on_device(style, comm->nprocs, group_))
    make_device_engine();
  else
    make_host_engine();
  if (group_.orientations().turn()) use_rotation(this);
}

void FixBDPseKokkos::make_device_engine()
{
  use_device(this, *lmp->kokkos);
  use_slabs(lmp, name_, options_.fft);
  auto pairs = std::make_unique<DevicePairs>(lmp, this);
  auto group = std::make_unique<DevicePseEngine::Group>(lmp, name_, groupbit, group_.scene(),
                                                        judge_, false, &group_.orientations());
  force_watch_ = std::make_unique<DeviceForceWatch<LMPDeviceType>>(lmp, groupbit, *group);
  auto engine = std::make_unique<DevicePseEngine>(lmp, engine_parts_, *pairs, std::move(group));
  if (!options_.split && !options_.parts && !given_.act()) columns_.give_up();
  in_use_.work_with(std::move(pairs), std::move(engine));
  list_text_ = "full, by the KOKKOS package";
}

void FixBDPseKokkos::make_host_engine()
{
  auto pairs = std::make_unique<KokkosPairs>(lmp, this);
  auto engine = std::make_unique<HostPseEngine>(lmp, engine_parts_, *pairs, bdh::host_workers());
  in_use_.work_with(std::move(pairs), std::move(engine));
  list_text_ = host_reads_kokkos_lists() ? "by the KOKKOS package" : "by one thread";
}

void FixBDPseKokkos::setup_pre_neighbor()
{
  FixBDPse::setup_pre_neighbor();
  show_new_stencils(*neighbor);
  in_use_.pairs().before_lists();
}

/// Needed here because scheme split may build lists several times a step.
void FixBDPseKokkos::pre_neighbor()
{
  if (options_.split && domain->box_change) show_new_stencils(*neighbor);
}

void FixBDPseKokkos::init()
{
  FixBDPse::init();
  warn_of_rounded_half_box(lmp, name_, warned_half_box_);
}

PlanText FixBDPseKokkos::plan_text() const
{
  PlanText text = FixBDPse::plan_text();
  text.line("kernels", fmt::format("{}; neighbor list {}",
                                   kernels_text(style, comm->nprocs, group_), list_text_));
  return text;
}
