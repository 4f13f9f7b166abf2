/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The fluid of fix bd/fib on the grid that the particles need now.
#ifndef LMP_BDH_FIB_FLOW_H
#define LMP_BDH_FIB_FLOW_H

#include "bdh_given_motions.h"
#include "fib/active_rows.h"
#include "fib/constrained_step.h"
#include "fib/free_fluid.h"
#include "fib/step.h"
#include "input/fib_precision.h"
#include "input/options.h"

#include <array>
#include <memory>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace LAMMPS_NS {

/// What a flow is made for.
struct FibFlowPlan {
  bdh::Grid grid;    ///< of the whole box
  bdh::FibOptions options;
  bdh::Moments moments = bdh::Moments::none;
  bool constrained = false;    ///< motions are given
};

/// A fluid with the steps of particles in it: with or without hydrodynamic interactions and
/// constraints.  Where the rows of the grid follow the particles, it makes another fluid when their
/// number changes.  Place is bdh::FibOnHost or its counterpart on a device.
template <class Place> class FibFlow {
 public:
  using Particles = typename bdh::BrownianStep<Place>::Particles;

  /// particles: those of the steps.  They outlive the flow, as the workers do.
  FibFlow(const bdh::Comm &comm, const bdh::Workers &workers, const Particles &particles) :
      comm_(comm), workers_(workers), particles_(particles)
  {}
  /// Collective.  Makes the fluid, or leaves that to follow().  Throws InvalidOption if the
  /// precision that the options ask for is impossible.
  void make(const FibFlowPlan &plan)
  {
    plan_ = plan;
    constexpr bool only_double = std::is_void<typename Place::InSingle>::value;
    precision_ = bdh::choose_precision(plan.options, plan.grid, only_double);
    rows_.reset();
    flow_.reset();
    crossings_ = 0.0;
    if (plan.options.hydrodynamics && bdh::ActiveRows::axis_of(plan.grid) >= 0)
      rows_ = std::make_unique<bdh::ActiveRows>(plan.grid, comm_);
    else
      make_flow(plan.grid);
  }
  /// Of the grid, with the reason.
  const bdh::FibPrecision &precision() const { return precision_; }
  /// The rows of the grid follow the particles.
  bool follows() const { return rows_ != nullptr; }
  /// Collective.  Makes the grid as high as the particles require, where it follows them.
  void follow()
  {
    const typename Place::Execution execution(workers_);
    Place::check_positions(execution, plan_.grid, particles_.x(), particles_.size(), 0.0);
    if (rows_->follow(execution, particles_.x(), particles_.size())) make_flow(rows_->grid());
  }
  /// Collective.  Takes a step; see bdh::BrownianStep.
  bool take(Particles &p, const bdh::StepPlan &plan, const bdh::Constraint &constraint)
  {
    if (!rows_) return flow_->take(p, plan, constraint);
    follow();
    for (;;) try {
        return flow_->take(p, plan, constraint);
      } catch (const bdh::GridTooLow &) {
        rows_->grow();
        make_flow(rows_->grid());
      }
  }

  /// Cells of the present grid; 0 if there is none.
  std::array<long, 3> cells() const { return flow_ ? cells_ : std::array<long, 3>{}; }
  bdh::SolveReport report() const { return flow_ ? flow_->report() : bdh::SolveReport(); }
  double crossings() const { return crossings_ + (flow_ ? flow_->crossings() : 0.0); }
  ConstrainedMotion constrained() const
  {
    return flow_ ? flow_->constrained() : ConstrainedMotion();
  }
  int iterations() const { return flow_ ? flow_->iterations() : 0; }
  /// Bytes on this rank.
  double grid_memory() const { return flow_ ? flow_->grid_memory() : 0.0; }
  double particle_memory() const { return flow_ ? flow_->particle_memory() : 0.0; }

 private:
  /// A fluid and its steps.
  struct Flow {
    virtual ~Flow() = default;
    virtual bool take(Particles &particles, const bdh::StepPlan &plan,
                      const bdh::Constraint &constraint) = 0;
    virtual bdh::SolveReport report() const = 0;
    virtual double crossings() const = 0;
    virtual ConstrainedMotion constrained() const { return {}; }
    virtual int iterations() const { return 0; }
    virtual std::size_t grid_memory() const = 0;
    virtual std::size_t particle_memory() const = 0;
  };
  template <class Fluid, class Step> struct FlowWith : Flow {
    /// parts: arguments for the constructor of Fluid.
    template <class... Parts> explicit FlowWith(Parts &&...parts) :
        fluid(std::forward<Parts>(parts)...), step(fluid)
    {}
    bdh::SolveReport report() const override { return step.report(); }
    double crossings() const override { return step.crossings(); }
    std::size_t grid_memory() const override { return fluid.grid_memory(); }
    std::size_t particle_memory() const override { return fluid.particle_memory() + step.memory(); }
    Fluid fluid;
    Step step;
  };
  template <class Fluid> struct FreeFlow : FlowWith<Fluid, bdh::BrownianStep<Place, Fluid>> {
    using FlowWith<Fluid, bdh::BrownianStep<Place, Fluid>>::FlowWith;
    bool take(Particles &particles, const bdh::StepPlan &plan, const bdh::Constraint &) override
    {
      return this->step.take(particles, plan);
    }
  };
  struct ConstrainedFlow : FlowWith<bdh::FibFluid<Place>, bdh::ConstrainedBrownianStep<Place>> {
    template <class... Parts>
    explicit ConstrainedFlow(const bdh::ConstraintPlan &how, Parts &&...parts) :
        FlowWith<bdh::FibFluid<Place>, bdh::ConstrainedBrownianStep<Place>>(
            std::forward<Parts>(parts)...),
        how_(how)
    {}
    bool take(Particles &particles, const bdh::StepPlan &plan,
              const bdh::Constraint &constraint) override
    {
      this->step.take(particles, plan, constraint, how_);
      return true;
    }
    ConstrainedMotion constrained() const override { return motion_of(this->step); }
    int iterations() const override { return this->step.iterations(); }
    const bdh::ConstraintPlan how_;
  };

  void make_flow(const bdh::Grid &grid)
  {
    if (flow_) crossings_ += flow_->crossings();
    flow_.reset();    // frees its memory first
    cells_ = grid.n;
    const bdh::FibOptions &o = plan_.options;
    if (plan_.constrained)
      flow_ = std::make_unique<ConstrainedFlow>(how_to_constrain(grid), grid, o.kernel, o.fft,
                                                comm_, workers_, plan_.moments);
    else if (o.hydrodynamics && precision_.single)
      make_free_flow<typename Place::InSingle>(grid);
    else if (o.hydrodynamics)
      make_free_flow<Place>(grid);
    else
      flow_ = std::make_unique<FreeFlow<bdh::FreeFluid<Place>>>(
          grid, bdh::self_mobility(grid, o.kernel, comm_), bdh::self_rotation(grid, o.kernel),
          particles_, comm_, workers_);
  }
  /// On: Place, or with a grid in single precision.
  template <class On> void make_free_flow(const bdh::Grid &grid)
  {
    if constexpr (std::is_void<On>::value)
      throw std::logic_error("FibFlow: the device has no grid in single precision");
    else
      flow_ = std::make_unique<FreeFlow<bdh::FibFluid<On>>>(
          grid, plan_.options.kernel, plan_.options.fft, comm_, workers_, plan_.moments);
  }
  bdh::ConstraintPlan how_to_constrain(const bdh::Grid &grid) const
  {
    bdh::ConstraintPlan how;
    how.moments = plan_.moments;
    how.radius = bdh::hydrodynamic_radius(plan_.options.kernel, grid);
    how.tolerance = plan_.options.constraint_tolerance;
    how.noise_loads = plan_.options.control_variate;
    return how;
  }

  const bdh::Comm comm_;
  const bdh::Workers &workers_;
  const Particles &particles_;
  FibFlowPlan plan_;
  bdh::FibPrecision precision_;
  std::unique_ptr<bdh::ActiveRows> rows_;    // null: the grid is that of the whole box
  std::unique_ptr<Flow> flow_;
  std::array<long, 3> cells_{};    // of the grid of flow_
  double crossings_ = 0.0;         // on grids before the present one
};

}    // namespace LAMMPS_NS
#endif
