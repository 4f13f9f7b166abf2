/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fix_bd_fib_kokkos.h"

#include "bdh_lammps_kokkos.h"
#include "fib/backend_kokkos.h"
#include "force.h"

using namespace LAMMPS_NS;

namespace {
using Space = LMPDeviceType::execution_space;
using Backend = bdh::KokkosBackend<Space>;
}    // namespace

/// The device's part of the fix.
struct FixBDFibKokkos::OnDevice {
  DeviceGroup<LMPDeviceType> particles;
};

FixBDFibKokkos::FixBDFibKokkos(LAMMPS *lmp, int narg, char **arg) : FixBDFib(lmp, narg, arg)
{
  use_kokkos(this, lmp, name_);
  take_forces_from(std::make_unique<KokkosForces>(lmp));
}

FixBDFibKokkos::~FixBDFibKokkos() = default;

void FixBDFibKokkos::init()
{
  FixBDFib::init();
  warn_of_rounded_half_box(lmp, name_, warned_half_box_);
}

const bdh::Workers &FixBDFibKokkos::workers() const { return bdh::host_workers(); }

/// What keeps the fix from the kernels of the device; empty: nothing.
std::string FixBDFibKokkos::why_not_device() const { return comm->nprocs > 1 ? "one process" : ""; }

std::unique_ptr<bdh::FibEngine> FixBDFibKokkos::make_engine() const
{
  if (!(wants_device(style) && why_not_device().empty())) return FixBDFib::make_engine();
  return std::make_unique<bdh::FibEngineOn<Backend>>(grid(), options().kernel, options().effort,
                                                     bdh::Comm(world));
}

void FixBDFibKokkos::build()
{
  FixBDFib::build();
  if (wants_device(style) && why_not_device().empty()) {
    use_device(this);
    if (!device_)
      device_.reset(new OnDevice{DeviceGroup<LMPDeviceType>(
          lmp, name_, groupbit, [this](double longest, long farthest, double count) {
            judge_moves(longest, farthest, count);
          })});
  } else {
    use_host(this);
    device_.reset();
  }
}

void FixBDFibKokkos::take_step()
{
  if (!device_) return FixBDFib::take_step();
  device_->particles.gather(uses_unwrapped_positions(), force->ftm2v, longest_move());
  take_with<Backend>(device_->particles);
}

std::string FixBDFibKokkos::describe(long index) const
{
  return device_ ? device_->particles.describe(index) : FixBDFib::describe(index);
}

double FixBDFibKokkos::memory_usage()
{
  return FixBDFib::memory_usage() + (device_ ? device_->particles.memory() : 0.0);
}

std::string FixBDFibKokkos::plan_text() const
{
  return FixBDFib::plan_text() +
         fmt::format("  {:<10} {}\n", "kernels", kernels_text(style, why_not_device()));
}
