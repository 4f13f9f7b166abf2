/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// What computes the steps of fix bd/fib: the host with its threads, or a device.
#ifndef LMP_BDH_FIB_ENGINE_H
#define LMP_BDH_FIB_ENGINE_H

#include "bdh_group.h"
#include "fib/step.h"
#include "input/options.h"

#include <memory>
#include <string>

namespace LAMMPS_NS {

/// The fluid of fix bd/fib, and its steps with the atoms of the group.
class FibEngine {
 public:
  virtual ~FibEngine() = default;
  /// Collective.  Makes the fluid.
  virtual void make(const bdh::Grid &grid, const bdh::FibOptions &options) = 0;
  /// Collective.  One step with the atoms as they are.
  virtual void step(const bdh::StepPlan &plan) = 0;
  /// The fluid; null before make().
  virtual const bdh::FibEngine *fluid() const = 0;
  /// Names the particle at a place of the core's arrays, and the step.
  virtual std::string describe(long index) const = 0;
  /// Bytes on this rank.
  virtual double memory() const = 0;
};

/// Works in the memory of the host, with any number of processes and the threads of `workers`.
class HostFibEngine : public FibEngine, protected Pointers {
 public:
  HostFibEngine(LAMMPS *lmp, AtomGroup &group, const bdh::Workers &workers) :
      Pointers(lmp), group_(group), workers_(workers)
  {}
  void make(const bdh::Grid &grid, const bdh::FibOptions &options) override
  {
    fluid_.reset();    // frees its memory first
    fluid_ =
        std::make_unique<Fluid>(grid, options.kernel, options.effort, bdh::Comm(world), workers_);
  }
  void step(const bdh::StepPlan &plan) override
  {
    group_.gather();
    fluid_->take(group_, plan);
  }
  const bdh::FibEngine *fluid() const override { return fluid_.get(); }
  std::string describe(long index) const override { return group_.describe(index); }
  double memory() const override
  {
    return fluid_ ? fluid_->grid_memory() + fluid_->particle_memory() : 0.0;
  }

 private:
  using Fluid = bdh::FibEngineOn<bdh::FibOnHost>;

  AtomGroup &group_;
  const bdh::Workers &workers_;
  std::unique_ptr<Fluid> fluid_;
};

}    // namespace LAMMPS_NS
#endif
