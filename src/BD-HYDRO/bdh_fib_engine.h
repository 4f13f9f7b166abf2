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
#include <type_traits>
#include <utility>

namespace LAMMPS_NS {

/// The fluid of fix bd/fib, and its steps with the atoms of the group.
class FibEngine {
 public:
  virtual ~FibEngine() = default;
  /// Collective.  Makes the fluid.  What else is asked before that answers 0.
  virtual void make(const bdh::Grid &grid, const bdh::FibOptions &options) = 0;
  virtual bool is_made() const = 0;
  /// Collective.  One step with the atoms as they are.
  virtual void step(const bdh::StepPlan &plan) = 0;
  virtual bdh::SolveReport report() const = 0;    ///< of the last solve
  virtual double crossings() const = 0;           ///< see bdh::BrownianStep
  /// Names the particle at a place of the core's arrays, and the step.
  virtual std::string describe(long index) const = 0;
  virtual double grid_memory() const = 0;    ///< bytes on this rank
  virtual double memory() const = 0;         ///< all bytes on this rank
};

/// Place: bdh::FibOnHost or its counterpart on a device.  Group: the particles there, owned by the
/// engine, or a reference to somebody else's.
template <class Place, class Group> class FibEngineOn : public FibEngine, protected Pointers {
 public:
  /// group: for the constructor of Group.
  template <class... Args> FibEngineOn(LAMMPS *lmp, const bdh::Workers &workers, Args &&...group) :
      Pointers(lmp), workers_(workers), group_(std::forward<Args>(group)...)
  {}
  void make(const bdh::Grid &grid, const bdh::FibOptions &options) override
  {
    flow_.reset();    // frees its memory first
    flow_ = std::make_unique<Flow>(grid, options, bdh::Comm(world), workers_);
  }
  bool is_made() const override { return flow_ != nullptr; }
  void step(const bdh::StepPlan &plan) override
  {
    group_.gather();
    group_.matches_scene();    // ends the run if another fix integrates one of them
    flow_->step.take(group_, plan);
  }
  bdh::SolveReport report() const override
  {
    return flow_ ? flow_->fluid.report() : bdh::SolveReport();
  }
  double crossings() const override { return flow_ ? flow_->step.crossings() : 0.0; }
  std::string describe(long index) const override { return group_.describe(index); }
  double grid_memory() const override { return flow_ ? flow_->fluid.grid_memory() : 0.0; }
  double memory() const override
  {
    double bytes = grid_memory();
    if (flow_) bytes += flow_->fluid.particle_memory() + flow_->step.memory();
    if (!std::is_reference<Group>::value) bytes += group_.memory();
    return bytes;
  }

 private:
  struct Flow {
    Flow(const bdh::Grid &grid, const bdh::FibOptions &options, const bdh::Comm &comm,
         const bdh::Workers &workers) :
        fluid(grid, options.kernel, options.effort, comm, workers),
        step(fluid)
    {}
    bdh::FibFluid<Place> fluid;
    bdh::BrownianStep<Place> step;
  };

  const bdh::Workers &workers_;
  Group group_;
  std::unique_ptr<Flow> flow_;
};

using HostFibEngine = FibEngineOn<bdh::FibOnHost, AtomGroup &>;

}    // namespace LAMMPS_NS
#endif
