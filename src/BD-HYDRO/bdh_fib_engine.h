/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Computes the steps of fix bd/fib: on the host with its threads, or on a device.
#ifndef LMP_BDH_FIB_ENGINE_H
#define LMP_BDH_FIB_ENGINE_H

#include "base/pieces.h"
#include "bdh_given_motions.h"
#include "bdh_group.h"
#include "fib/active_rows.h"
#include "fib/constrained_step.h"
#include "fib/free_fluid.h"
#include "fib/step.h"
#include "input/fib_precision.h"
#include "input/options.h"

#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

namespace LAMMPS_NS {

/// The fluid of fix bd/fib, and the steps of the group's atoms in it.
class FibEngine {
 public:
  virtual ~FibEngine() = default;
  /// Collective.  Makes the fluid.  Until then all other functions return 0.  Throws InvalidOption
  /// if the precision that the options ask for is impossible.
  /// turns: particles turn.  given: outlives the engine.
  virtual void make(const bdh::Grid &grid, const bdh::FibOptions &options, bool turns,
                    GivenMotions &given) = 0;
  virtual bool is_made() const = 0;
  /// Collective.  Makes the grid that the present positions of the atoms require, before a step
  /// does.
  virtual void fit_grid() = 0;
  /// Of the grid, with the reason.
  virtual const bdh::FibPrecision &precision() const = 0;
  /// Cells of the present grid; 0 if there is none.
  virtual std::array<long, 3> cells() const = 0;
  /// Collective.  One step from the present state of the atoms.
  virtual void step(const bdh::StepPlan &plan, bdh::PieceChoice &choice) = 0;
  /// Collective.  See bdh::StepInPieces.
  virtual bdh::StepAgainstHalves compare_with_halves(const bdh::StepPlan &plan, double limit) = 0;
  virtual bdh::SolveReport report() const = 0;    ///< of the last solve
  virtual double crossings() const = 0;           ///< see bdh::BrownianStep
  /// Local indices of the atoms of the last step, in the core's order.
  virtual std::vector<int> atoms() const = 0;
  /// What the constraint of the last step did; empty without one.
  virtual ConstrainedMotion constrained() const = 0;
  virtual int constraint_iterations() const = 0;
  /// Names the particle at an index of the core's arrays, and the step, for messages.
  virtual std::string describe(long index) const = 0;
  virtual double grid_memory() const = 0;    ///< bytes on this rank, of the present grid
  virtual double memory() const = 0;         ///< all bytes on this rank
};

/// Place is bdh::FibOnHost or its counterpart on a device.  Group holds the particles there: an
/// object that the engine owns, or a reference to one that it does not.
template <class Place, class Group> class FibEngineOn : public FibEngine, protected Pointers {
 public:
  /// group: arguments for the constructor of Group.
  template <class... Args> FibEngineOn(LAMMPS *lmp, const bdh::Workers &workers, Args &&...group) :
      Pointers(lmp), workers_(workers), group_(std::forward<Args>(group)...)
  {}
  ~FibEngineOn() noexcept override {}    // newer releases let that of Pointers throw
  void make(const bdh::Grid &grid, const bdh::FibOptions &options, bool turns,
            GivenMotions &given) override
  {
    grid_ = grid;
    options_ = options;
    moments_ = options.stresslets ? bdh::Moments::stresslet : bdh::moments_of(turns);
    given_ = given.act() ? &given : nullptr;
    constexpr bool only_double = std::is_void<typename Place::InSingle>::value;
    precision_ = bdh::choose_precision(options, grid, only_double);
    rows_.reset();
    flow_.reset();
    crossings_ = 0.0;
    if (options.hydrodynamics && bdh::ActiveRows::axis_of(grid) >= 0)
      rows_ = std::make_unique<bdh::ActiveRows>(grid, bdh::Comm(world));
    else
      make_flow(grid);
    made_ = true;
  }
  bool is_made() const override { return made_; }
  const bdh::FibPrecision &precision() const override { return precision_; }
  void fit_grid() override
  {
    if (!rows_) return;
    group_.gather();
    follow_particles();
  }
  std::array<long, 3> cells() const override { return flow_ ? cells_ : std::array<long, 3>{}; }
  const auto &particles() const { return group_; }
  void step(const bdh::StepPlan &plan, bdh::PieceChoice &choice) override
  {
    group_.gather();
    group_.matches_scene();    // stops the run if another fix integrates one of the atoms
    if (given_) find_constraint();
    pieces().step(group_, plan, choice,
                  [this](Particles &p, const bdh::StepPlan &part) { return take(p, part); });
  }
  bdh::StepAgainstHalves compare_with_halves(const bdh::StepPlan &plan, double limit) override
  {
    group_.gather();
    return pieces().compare_with_halves(
        group_, plan, limit,
        [this](Particles &p, const bdh::StepPlan &part) { return take(p, part); });
  }
  bdh::SolveReport report() const override { return flow_ ? flow_->report() : bdh::SolveReport(); }
  double crossings() const override { return crossings_ + (flow_ ? flow_->crossings() : 0.0); }
  std::vector<int> atoms() const override { return group_.atoms_on_host(); }
  ConstrainedMotion constrained() const override
  {
    return flow_ ? flow_->constrained() : ConstrainedMotion();
  }
  int constraint_iterations() const override { return flow_ ? flow_->iterations() : 0; }
  std::string describe(long index) const override { return group_.describe(index); }
  double grid_memory() const override { return flow_ ? flow_->grid_memory() : 0.0; }
  double memory() const override
  {
    double bytes = grid_memory();
    if (flow_) bytes += flow_->particle_memory();
    bytes += bdh::bytes_of(held_, held_velocity_);
    if (!std::is_reference<Group>::value) bytes += group_.memory();
    return bytes;
  }

 private:
  using Particles = typename bdh::BrownianStep<Place>::Particles;

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
    const bdh::Comm comm(world);
    if (given_)
      flow_ = std::make_unique<ConstrainedFlow>(how_to_constrain(grid), grid, options_.kernel,
                                                options_.effort, comm, workers_, moments_);
    else if (options_.hydrodynamics && precision_.single)
      make_free_flow<typename Place::InSingle>(grid);
    else if (options_.hydrodynamics)
      make_free_flow<Place>(grid);
    else
      flow_ = std::make_unique<FreeFlow<bdh::FreeFluid<Place>>>(
          grid, bdh::self_mobility(grid, options_.kernel, comm),
          bdh::self_rotation(grid, options_.kernel), group_, comm, workers_);
  }
  /// On: Place, or with a grid in single precision.
  template <class On> void make_free_flow(const bdh::Grid &grid)
  {
    if constexpr (std::is_void<On>::value)
      throw std::logic_error("FibEngine: the device has no grid in single precision");
    else
      flow_ = std::make_unique<FreeFlow<bdh::FibFluid<On>>>(grid, options_.kernel, options_.effort,
                                                            bdh::Comm(world), workers_, moments_);
  }
  bdh::StepInPieces<typename Place::Execution> pieces() const
  {
    return {typename Place::Execution(workers_), bdh::Comm(world)};
  }
  bool take(Particles &p, const bdh::StepPlan &plan)
  {
    return rows_ ? step_on_active_rows(p, plan) : flow_->take(p, plan, constraint_);
  }
  bdh::ConstraintPlan how_to_constrain(const bdh::Grid &grid) const
  {
    bdh::ConstraintPlan how;
    how.moments = moments_;
    how.radius = bdh::hydrodynamic_radius(options_.kernel, grid);
    how.tolerance = options_.constraint_tolerance;
    return how;
  }
  void find_constraint()
  {
    given_->gather(group_.atoms_on_host());
    constraint_ = given_->constraint();
    held_ = Place::Execution::from_host(given_->held());
    held_velocity_ = Place::Execution::from_host(given_->velocity());
    if (given_->held().empty()) return;
    constraint_.held = held_.data();
    constraint_.velocity = held_velocity_.data();
  }
  /// Makes the grid as high as the particles require.
  void follow_particles()
  {
    const typename Place::Execution execution(workers_);
    Place::check_positions(execution, grid_, group_.x(), group_.size(), 0.0);
    if (rows_->follow(execution, group_.x(), group_.size())) make_flow(rows_->grid());
  }
  bool step_on_active_rows(Particles &p, const bdh::StepPlan &plan)
  {
    follow_particles();
    for (;;) try {
        return flow_->take(p, plan, constraint_);
      } catch (const bdh::GridTooLow &) {
        rows_->grow();
        make_flow(rows_->grid());
      }
  }

  const bdh::Workers &workers_;
  Group group_;
  bdh::Grid grid_;    // of the whole box
  bdh::FibOptions options_;
  bdh::FibPrecision precision_;
  std::unique_ptr<bdh::ActiveRows> rows_;    // null: the grid is that of the whole box
  std::unique_ptr<Flow> flow_;
  std::array<long, 3> cells_{};    // of the grid of flow_
  double crossings_ = 0.0;         // on grids before the present one
  bool made_ = false;
  bdh::Moments moments_ = bdh::Moments::none;
  GivenMotions *given_ = nullptr;    // null: no motions are given
  bdh::Constraint constraint_;       // of this step; its arrays are the following ones
  typename Place::Execution::Flags held_;
  typename Place::ParticleVector held_velocity_;
};

using HostFibEngine = FibEngineOn<bdh::FibOnHost, AtomGroup &>;

}    // namespace LAMMPS_NS
#endif
