// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Ends of steps that are kept between the walls, and on the rows of the grid.
#ifndef BDH_FIB_CONFINEMENT_H
#define BDH_FIB_CONFINEMENT_H

#include "base/comm.h"
#include "base/errors.h"
#include "base/particles.h"
#include "base/ssize.h"
#include "fib/active_rows.h"
#include "fib/step_kernel.h"
#include "grid/grid.h"
#include "grid/position_kernel.h"
#include "grid/sorted_particles.h"

#include <cstdint>

namespace bdh {

/// What happens when a step would take a particle over a wall.  With `error`, the step throws
/// BadParticle.  With `reflect`, the end of the particle's step is mirrored at the wall.  With
/// `redraw`, the whole step is taken again with other random numbers (not with the improved
/// scheme).
enum class Crossing { error, reflect, redraw };

/// Treats positions at the end of a step, or within it, in the way that the plan says.  Positions
/// are 3 numbers per particle.
template <class Place, class Fluid> class Confinement {
 public:
  using Vector = typename Place::ParticleVector;
  using Particles = ParticlesOf<Vector>;

  explicit Confinement(Fluid &fluid) :
      fluid_(fluid), execution_(fluid.execution()), walls_(wall_limits(fluid.grid())),
      box_(box_limits(fluid.grid())), fits_(fit_limits(fluid.grid()))
  {}

  /// may_fail: a step that would take a particle over a wall is not taken if crossing is `error`.
  void begin_step(Crossing crossing, bool may_fail)
  {
    crossing_ = crossing;
    may_fail_ = may_fail;
    attempt_ = 0;
    crossings_before_ = crossings_;
  }
  /// Attempts of this step that have failed.
  uint32_t attempt() const { return attempt_; }
  /// The number of times that particles of this rank were mirrored at a wall, plus on the first
  /// rank the number of steps that were drawn again.  All ranks decide together on the latter, so
  /// the sum over ranks is right for both.
  double crossings() const { return crossings_; }

  /// Collective.  Throws GridTooLow if the kernels of particles at x do not fit into the grid.
  void require_rows(const Particles &p, const Vector &x)
  {
    if (!fluid_.grid().leaves_out() || !on_any_rank(first_outside(fits_, p, x) >= 0)) return;
    crossings_ = crossings_before_;    // the step will be taken again
    throw GridTooLow();
  }

  /// Brings positions x at the end of a step back between the walls.  Collective if crossing is
  /// `redraw`, or the step may fail; it is then false on all ranks if any particle is outside.
  /// Throws BadParticle for one that leaves through an open face.
  bool confine(const Particles &p, Vector &x)
  {
    mirrored_.resize(0);
    const Grid &g = fluid_.grid();
    if (g.walled_axes() == 0) return true;
    if (crossing_ == Crossing::redraw && on_any_rank(first_outside(walls_, p, x) >= 0))
      return false;
    if (crossing_ == Crossing::error && may_fail_ &&
        on_any_rank(first_outside(walls_, p, x) >= 0 || first_outside(box_, p, x) >= 0))
      return false;
    if (crossing_ == Crossing::reflect) mirror(p, x);
    if (first_outside(box_, p, x) >= 0)
      Place::check_positions(execution_, g, x.data(), p.size(), 0.0);
    return true;
  }
  /// displacement := x - q where the last confine() has mirrored x at a wall.
  void take_mirrored(const Particles &p, const Vector &x, Vector &displacement) const
  {
    execution_.for_each("bdh::take_mirrored", ssize(mirrored_),
                        TakeMirrored{mirrored_.data(), x.data(), p.x(), displacement.data()});
  }

  /// Collective.  Throws BadParticle after so many attempts that the time step is too long for
  /// redrawing to be a small correction.  x: where the last one has ended.
  void next_attempt(const Particles &p, const Vector &x)
  {
    constexpr uint32_t most = 20;
    if (fluid_.comm().rank() == 0) crossings_ += 1.0;
    if (++attempt_ <= most) return;
    // If there is none here, another rank has it and stops the run.
    const long i = first_outside(walls_, p, x);
    if (i >= 0)
      throw BadParticle(i, "it would cross a wall in each of 20 attempts: use a smaller timestep");
  }

 private:
  bool on_any_rank(bool mine) const { return any_rank(fluid_.comm(), mine); }
  void mirror(const Particles &p, Vector &x)
  {
    mirrored_.resize(x.size());
    execution_.clear(mirrored_);
    crossings_ +=
        execution_.sum("bdh::mirror", p.size(), MirrorAtWalls{walls_, x.data(), mirrored_.data()});
  }
  long first_outside(const WallLimits &limits, const Particles &p, const Vector &x) const
  {
    return execution_.first("bdh::first_outside", p.size(), BeyondWalls{limits, x.data()});
  }

  Fluid &fluid_;
  typename Place::Execution execution_;
  WallLimits walls_, box_, fits_;    // box_: walls and open faces
  // For each number of the last confine(), whether a wall has mirrored it; empty if none can have.
  typename Place::Execution::Flags mirrored_;
  Crossing crossing_ = Crossing::error;
  bool may_fail_ = false;
  uint32_t attempt_ = 0;
  double crossings_ = 0.0, crossings_before_ = 0.0;    // before_: the present step
};

}    // namespace bdh
#endif
