// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Steps in pieces, on a Brownian tree (base/rng_kernel.h), for any scheme.
#ifndef BDH_BASE_PIECES_H
#define BDH_BASE_PIECES_H

#include "base/comm.h"
#include "base/particles.h"
#include "base/piece_choice.h"
#include "base/ssize.h"

#include <cmath>
#include <cstdint>

namespace bdh {

/// True for a number that is not one below the bound.
struct IsBeyond {
  const double *displacement;
  double bound;
  BDH_FN bool operator()(long k) const { return !(std::fabs(displacement[k]) <= bound); }
};

/// The particles as a scheme sees them during a piece: what would end the step is kept instead.
template <class Vector> class ParticlesInPiece : public ParticlesOf<Vector> {
 public:
  explicit ParticlesInPiece(ParticlesOf<Vector> &p) : p_(p) {}

  long size() const override { return p_.size(); }
  const double *x() const override { return p_.x(); }
  const double *force() const override { return p_.force(); }
  const double *torque() const override { return p_.torque(); }
  const uint64_t *ids() const override { return p_.ids(); }
  void move_and_update_forces(Vector &displacement, Vector *rotation) override
  {
    moved_ = true;
    p_.move_and_update_forces(displacement, rotation);
  }
  void finish(const Vector &displacement, const Vector &velocity) override
  {
    displacement_ = displacement;
    velocity_ = velocity;
  }
  void turn(const Vector &rotation, const Vector &angular_velocity) override
  {
    rotation_ = rotation;
    angular_velocity_ = angular_velocity;
    turns_ = true;
  }

  bool moved() const { return moved_; }    ///< the scheme has moved particles within the piece
  /// True for a particle whose displacement is not a number below the bound.
  template <class Execution> bool is_beyond(const Execution &execution, double bound) const
  {
    return execution.first("bdh::beyond", ssize(velocity_),
                           IsBeyond{displacement_.data(), bound}) >= 0;
  }
  /// Ends the step, of which the piece was the last part.
  void end_step()
  {
    p_.finish(displacement_, velocity_);
    if (turns_) p_.turn(rotation_, angular_velocity_);
  }
  /// Collective.
  void end_piece()
  {
    p_.end_piece(displacement_, velocity_, turns_ ? &rotation_ : nullptr, angular_velocity_);
  }

 private:
  ParticlesOf<Vector> &p_;
  Vector displacement_, velocity_, rotation_, angular_velocity_;
  bool moved_ = false, turns_ = false;
};

/// Length of a vector, and of a difference of two.
struct LengthOf {
  const double *v;
  BDH_FN double operator()(long i) const
  {
    return std::sqrt(v[3 * i] * v[3 * i] + v[3 * i + 1] * v[3 * i + 1] +
                     v[3 * i + 2] * v[3 * i + 2]);
  }
};
struct LengthOfChange {
  const double *before, *after;
  BDH_FN double operator()(long i) const
  {
    double sum = 0.0;
    for (long k = 3 * i; k < 3 * i + 3; ++k) sum += (after[k] - before[k]) * (after[k] - before[k]);
    return std::sqrt(sum);
  }
};

/// Takes steps in pieces.  A plan has the members dt, step and may_fail.
template <class Execution> class StepInPieces {
 public:
  using Vector = typename Execution::ParticleVector;
  using Particles = ParticlesOf<Vector>;

  StepInPieces(const Execution &execution, const Comm &comm) : execution_(execution), comm_(comm) {}

  /// Collective.  take(particles, plan) takes one step.  With plan.may_fail it returns false on all
  /// ranks, having moved nothing, if it cannot.
  template <class Plan, class Take>
  void step(Particles &p, const Plan &plan, PieceChoice &choice, const Take &take) const
  {
    if (!choice.acts()) {
      take(p, plan);
      return;
    }
    uint64_t begin = 0;    // in the shortest pieces
    while (begin < shortest_pieces) begin += piece(p, plan, begin, choice, take);
  }

 private:
  static constexpr uint64_t shortest_pieces = uint64_t(1) << deepest_piece;

  /// Takes the next piece and returns its length.
  template <class Plan, class Take> uint64_t piece(Particles &p, const Plan &plan, uint64_t begin,
                                                   PieceChoice &choice, const Take &take) const
  {
    const double force =
        comm_.greatest(execution_.greatest("bdh::force", p.size(), LengthOf{p.force()}));
    int depth = choice.depth(force);
    while (begin % (shortest_pieces >> depth)) ++depth;
    for (;; ++depth) {
      ParticlesInPiece<Vector> in(p);
      Plan part = plan;
      part.dt = std::ldexp(plan.dt, -depth);
      part.may_fail = depth < deepest_piece;
      part.step =
          piece_of_step(plan.step, (uint64_t(1) << depth) + (begin >> (deepest_piece - depth)));
      p.begin_piece(std::ldexp(1.0, -depth));
      const bool lost = !take(in, part) || in.is_beyond(execution_, choice.longest_move());
      if (any_rank(comm_, lost) && part.may_fail && !in.moved()) {
        choice.retry();
        continue;
      }
      choice.begin(force, part.dt);
      end(p, in, begin + (shortest_pieces >> depth) == shortest_pieces, choice);
      return shortest_pieces >> depth;
    }
  }
  /// The change of forces in the last piece is known only when LAMMPS has computed them.
  void end(Particles &p, ParticlesInPiece<Vector> &in, bool last, PieceChoice &choice) const
  {
    if (last) {
      in.end_step();
      return;
    }
    in.end_piece();
    choice.end(comm_.greatest(
        execution_.greatest("bdh::change", p.size(), LengthOfChange{p.force_before(), p.force()})));
  }

  Execution execution_;
  Comm comm_;
};

}    // namespace bdh
#endif
