/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fix_bd_fib_kokkos.h"

#include "bdh_lammps_kokkos.h"
#include "fib/on_device_kokkos.h"
#include "force.h"

using namespace LAMMPS_NS;

namespace {

/// Works in the memory of the device, with one process.
class DeviceFibEngine : public FibEngine, protected Pointers {
 public:
  DeviceFibEngine(LAMMPS *lmp, const std::string &name, int groupbit, MoveJudge &judge) :
      Pointers(lmp), group_(lmp, name, groupbit, judge)
  {}
  void make(const bdh::Grid &grid, const bdh::FibOptions &options) override
  {
    unwrap_ = options.shear_rate != 0.0;
    fluid_.reset();    // frees its memory first
    fluid_ = std::make_unique<Fluid>(grid, options.kernel, options.effort, bdh::Comm(world));
  }
  void step(const bdh::StepPlan &plan) override
  {
    group_.gather(unwrap_, force->ftm2v);
    fluid_->take(group_, plan);
  }
  const bdh::FibEngine *fluid() const override { return fluid_.get(); }
  std::string describe(long index) const override { return group_.describe(index); }
  double memory() const override
  {
    return group_.memory() +
           (fluid_ ? static_cast<double>(fluid_->grid_memory() + fluid_->particle_memory()) : 0.0);
  }

 private:
  using Fluid = bdh::FibEngineOn<bdh::FibOnDevice<LMPDeviceType::execution_space>>;

  DeviceGroup<LMPDeviceType> group_;
  bool unwrap_ = false;
  std::unique_ptr<Fluid> fluid_;
};

}    // namespace

FixBDFibKokkos::FixBDFibKokkos(LAMMPS *lmp, int narg, char **arg) : FixBDFib(lmp, narg, arg)
{
  use_kokkos(this, lmp, name_);
  group_.take_forces_from(std::make_unique<KokkosForces>(lmp));
  if (works_on_device(style, comm->nprocs)) {
    use_device(this);
    engine_ = std::make_unique<DeviceFibEngine>(lmp, name_, groupbit, judge_);
  } else {
    engine_ = std::make_unique<HostFibEngine>(lmp, group_, bdh::host_workers());
  }
}

void FixBDFibKokkos::init()
{
  FixBDFib::init();
  warn_of_rounded_half_box(lmp, name_, warned_half_box_);
}

std::string FixBDFibKokkos::plan_text() const
{
  return FixBDFib::plan_text() +
         fmt::format("  {:<10} {}\n", "kernels", kernels_text(style, comm->nprocs));
}
