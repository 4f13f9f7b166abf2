// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// How long the next piece of a step may be, decided before its noise is known.
#ifndef BDH_BASE_PIECE_CHOICE_H
#define BDH_BASE_PIECE_CHOICE_H

#include "base/rng_kernel.h"

#include <algorithm>
#include <cmath>

namespace bdh {

/// What limits a piece, in any consistent set of units.  The same on all ranks.
struct PieceScene {
  double dt = 0.0;              ///< of the whole step [time]
  double kT = 0.0;              ///< [energy]
  double mobility = 0.0;        ///< of the smallest particle alone [velocity/force]
  double radius = 0.0;          ///< its radius [length]
  double longest_move = 0.0;    ///< a longer displacement would end the run [length]
};

/// Keeps the change of forces within a piece small: a time t times the mobility times the change of
/// the force on any particle is to stay below a tolerance [length].
///
/// The change of forces is predicted from that in earlier pieces, in proportion to the distance
/// that particles go.  That distance is s(t) = sqrt(2 kT mu t) + V t, with V the velocity by the
/// largest of the present forces.  Steep forces get stiffer as they grow, so the prediction grows
/// along with V where that is larger than it was.
///
/// **A piece must not be taken back because of its outcome.**  Where the noise depends on the
/// configuration that is a selection, and its bias does not vanish with the time step.  The length
/// of a piece follows from what is known before its noise is.  Exceptions are few and counted:
/// pieces that would end the run, or lead to forces that none could follow.
class PieceChoice {
 public:
  PieceChoice() = default;
  /// tolerance: in radii; 0: steps are taken as a whole.
  explicit PieceChoice(double tolerance) : tolerance_(tolerance) {}

  bool acts() const { return tolerance_ > 0.0; }
  double tolerance() const { return tolerance_; }
  void set_scene(const PieceScene &scene)
  {
    scene_ = scene;
    pieces_ = 0;
  }
  /// A displacement beyond this one would end the run [length].
  double longest_move() const { return scene_.longest_move; }

  /// Halvings of the step for the next piece, at most `most`.  largest_force: of any particle, now.
  int depth(double largest_force, int most) const
  {
    const double V = scene_.mobility * largest_force;
    int depth = 0;
    while (depth < most && !is_short_enough(V, std::ldexp(scene_.dt, -depth))) ++depth;
    return depth;
  }
  /// A piece begins, with a largest force of `largest_force`, and takes `time`.
  void begin(double largest_force, double time)
  {
    state_.open_velocity = scene_.mobility * largest_force;
    state_.open_time = time_ = time;
    ++pieces_;
  }
  /// It has changed the force on a particle by `largest_change`.
  void end(double largest_change)
  {
    const double time = state_.open_time, velocity = state_.open_velocity;
    if (time == 0.0) return;
    state_.open_time = 0.0;
    const double change = scene_.mobility * largest_change, distance = reach(velocity, time);
    seen_.largest = std::max(seen_.largest, change * time / scene_.radius);
    ++seen_.pieces;
    state_.rate = std::max(fade * state_.rate, distance > 0.0 ? change / distance : 0.0);
    state_.velocity = std::max(fade * state_.velocity, velocity);
  }
  /// False if forces are so large that even a piece after `most` halvings would move a particle by
  /// more than the tolerance, or are not finite.
  bool can_follow(double largest_force, int most) const
  {
    const double moved = scene_.mobility * largest_force * std::ldexp(scene_.dt, -most);
    return moved <= tolerance_ * scene_.radius;
  }
  /// A piece could not be taken and will be halved.
  void retry() { ++seen_.retries; }

  /// What the choice remembers: it goes into restart files.
  struct State {
    double rate = 0.0;        ///< velocity by the change of forces, for a distance [1/time]
    double velocity = 0.0;    ///< the largest by forces so far
    /// Of a piece that has begun and not ended; 0 if there is none.
    double open_velocity = 0.0, open_time = 0.0;
  };
  const State &state() const { return state_; }
  void set_state(const State &state) { state_ = state; }

  /// Since clear().
  struct Seen {
    double largest = 0.0;    ///< change of forces times mobility and time, in radii
    double pieces = 0.0;     ///< taken
    double retries = 0.0;    ///< pieces that could not be taken
  };
  const Seen &seen() const { return seen_; }
  void clear() { seen_ = {}; }
  double time() const { return time_; }     ///< of the last piece
  int pieces() const { return pieces_; }    ///< in the last step

 private:
  static constexpr double fade = 0.95;     // per piece
  static constexpr double far = 0.1;       // radii: so far may a particle go at random at once
  static constexpr double growth = 2.0;    // forces that are so much larger than any are new

  /// Distance that a particle goes.
  double reach(double V, double time) const
  {
    return std::sqrt(2.0 * scene_.kT * scene_.mobility * time) + V * time;
  }
  bool is_short_enough(double V, double time) const
  {
    const double most = tolerance_ * scene_.radius;
    if (std::sqrt(2.0 * scene_.kT * scene_.mobility * time) > far * scene_.radius) return false;
    if (V > growth * state_.velocity && V * time > most) return false;
    const double steeper = V > state_.velocity && state_.velocity > 0.0 ? V / state_.velocity : 1.0;
    return time * state_.rate * steeper * reach(V, time) <= most;
  }

  double tolerance_ = 0.0;
  PieceScene scene_;
  double time_ = 0.0;
  int pieces_ = 0;
  State state_;
  Seen seen_;
};

}    // namespace bdh
#endif
