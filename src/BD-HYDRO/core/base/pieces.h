// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Steps in pieces, on a Brownian tree (base/rng_kernel.h), for any scheme.
#ifndef BDH_BASE_PIECES_H
#define BDH_BASE_PIECES_H

#include "base/comm.h"
#include "base/particles.h"
#include "base/piece_choice.h"
#include "base/ssize.h"
#include "base/vectors.h"

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

  const Vector &displacement() const { return displacement_; }
  /// Collective.  Moves the particles by `factor` times the displacement that has been kept.
  template <class Execution> void move(const Execution &execution, double factor)
  {
    for (Vector *v : {&displacement_, &rotation_}) scale(execution, factor, *v, *v);
    p_.move_and_update_forces(displacement_, rotation());
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
  void end_piece() { p_.end_piece(displacement_, velocity_, rotation(), angular_velocity_); }
  /// Collective, after end_piece().  Particles that moved only then are back where the piece began,
  /// to round-off, and so are the forces.
  template <class Execution> void take_back(const Execution &execution)
  {
    p_.forget_piece();
    move(execution, -1.0);
  }

 private:
  Vector *rotation() { return turns_ ? &rotation_ : nullptr; }

  ParticlesOf<Vector> &p_;
  Vector displacement_, velocity_, rotation_, angular_velocity_;
  bool moved_ = false, turns_ = false;
};

/// Square of the length of a vector, its length, which is infinite if a number is not finite, and
/// the length of a difference of two.
struct SquareOfLength {
  const double *v;
  BDH_FN double operator()(long i) const { return scalar_product(v + 3 * i, v + 3 * i); }
};
struct LengthOf {
  const double *v;
  BDH_FN double operator()(long i) const
  {
    const double square = SquareOfLength{v}(i);
    return square < HUGE_VAL ? std::sqrt(square) : HUGE_VAL;
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

/// Where a step in pieces is.  Pieces follow each other, and each begins at a multiple of its
/// length.
///
/// The Brownian path has no detail below the deepest pieces of its tree: pieces that are shorter,
/// of particles that overlap by far, share the noise of the one that they are in.
class PlaceInStep {
 public:
  static constexpr int most_halvings = 62;

  bool is_over() const { return begin_ == whole; }
  /// Halvings of the step for a piece that begins here: `depth` or more.
  int fit(int depth) const
  {
    while (begin_ % (whole >> depth)) ++depth;
    return depth;
  }
  /// The node of the tree whose noise a piece that begins here has, and the halvings to that node.
  uint64_t node(int depth) const
  {
    const int in_tree = halvings_of_noise(depth);
    return (uint64_t(1) << in_tree) + (begin_ >> (most_halvings - in_tree));
  }
  static int halvings_of_noise(int depth) { return depth < deepest_piece ? depth : deepest_piece; }
  void pass(int depth) { begin_ += whole >> depth; }

 private:
  static constexpr uint64_t whole = uint64_t(1) << most_halvings;    // in the shortest pieces
  uint64_t begin_ = 0;
};

/// How far apart a step and its two halves end, on the same Brownian path [length].
struct StepAgainstHalves {
  bool taken = false;       ///< false: a step or a half would have ended the run
  double apart = 0.0;       ///< root mean square over particles
  double farthest = 0.0;    ///< the largest
  double moved = 0.0;       ///< displacement of a particle in the whole step, root mean square
};

/// Takes steps in pieces.  A plan has the members dt, noise_dt, step and may_fail.
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
    PlaceInStep place;
    double force = largest_force(p);
    while (!place.is_over()) force = piece(p, force, plan, place, choice, take);
  }

  /// Collective.  Compares a step with its halves.  The particles end where they were, to
  /// round-off. limit: a longer displacement would end the run.
  template <class Plan, class Take> StepAgainstHalves
  compare_with_halves(Particles &p, const Plan &plan, double limit, const Take &take) const
  {
    StepAgainstHalves found;
    ParticlesInPiece<Vector> whole(p), first(p), second(p);
    if (!is_taken(whole, plan, 1, limit, take)) return found;
    found.moved = mean_length(whole.displacement());
    if (!is_taken(first, plan, 2, limit, take)) return found;
    p.keep(combined(first.displacement(), -1.0, whole.displacement()));
    first.move(execution_, 1.0);
    found.taken = is_taken(second, plan, 3, limit, take);
    if (found.taken) {
      const Vector apart = combined(p.kept(), 1.0, second.displacement());
      found.apart = mean_length(apart);
      found.farthest =
          comm_.greatest(execution_.greatest("bdh::apart", p.size(), LengthOf{apart.data()}));
    }
    first.move(execution_, -1.0);
    return found;
  }

 private:
  /// Collective.  Root mean square over particles.
  double mean_length(const Vector &v) const
  {
    const long n = ssize(v) / 3;
    const double all = comm_.sum(n);
    const double sum = comm_.sum(execution_.sum("bdh::moved", n, SquareOfLength{v.data()}));
    return all > 0.0 ? std::sqrt(sum / all) : 0.0;
  }
  /// a + c b
  Vector combined(const Vector &a, double c, const Vector &b) const
  {
    Vector to;
    to.resize(a.size());
    combine(execution_, 1.0, a.data(), c, b.data(), to);
    return to;
  }
  /// Collective.  Takes the piece of the step at a node of the tree; it is kept and moves nothing.
  template <class Plan, class Take> bool is_taken(ParticlesInPiece<Vector> &in, const Plan &plan,
                                                  uint64_t node, double limit,
                                                  const Take &take) const
  {
    Plan part = plan;
    if (node > 1) part.dt *= 0.5;
    part.step = piece_of_step(plan.step, node);
    part.may_fail = true;
    const bool lost = !take(in, part) || in.is_beyond(execution_, limit);
    return !any_rank(comm_, lost);
  }

  /// Collective.
  double largest_force(Particles &p) const
  {
    return comm_.greatest(execution_.greatest("bdh::force", p.size(), LengthOf{p.force()}));
  }
  /// Takes the next piece.  force: the largest now; returns that after the piece, unless it is the
  /// last one.
  template <class Plan, class Take> double piece(Particles &p, double force, const Plan &plan,
                                                 PlaceInStep &place, PieceChoice &choice,
                                                 const Take &take) const
  {
    constexpr int most = PlaceInStep::most_halvings;
    for (int depth = place.fit(choice.depth(force, most));; ++depth) {
      ParticlesInPiece<Vector> in(p);
      Plan part = plan;
      part.dt = std::ldexp(plan.dt, -depth);
      part.noise_dt = std::ldexp(plan.dt, -PlaceInStep::halvings_of_noise(depth));
      part.may_fail = depth < most;
      part.step = piece_of_step(plan.step, place.node(depth));
      p.begin_piece(std::ldexp(1.0, -depth));
      const bool lost = !take(in, part) || in.is_beyond(execution_, choice.longest_move());
      const bool may_retry = part.may_fail && !in.moved();
      if (any_rank(comm_, lost) && may_retry) {
        choice.retry();
        continue;
      }
      PlaceInStep next = place;
      next.pass(depth);
      double after = force;
      if (next.is_over()) {
        in.end_step();    // the forces then are known only when LAMMPS has computed them
      } else {
        in.end_piece();
        after = largest_force(p);
        if (may_retry && !choice.can_follow(after, most)) {
          in.take_back(execution_);
          choice.retry();
          continue;
        }
      }
      place = next;
      choice.begin(force, part.dt);
      if (!place.is_over()) choice.end(largest_change(p));
      return after;
    }
  }
  /// Collective.  Of the force on a particle within the piece.
  double largest_change(Particles &p) const
  {
    return comm_.greatest(
        execution_.greatest("bdh::change", p.size(), LengthOfChange{p.force_before(), p.force()}));
  }

  Execution execution_;
  Comm comm_;
};

}    // namespace bdh
#endif
