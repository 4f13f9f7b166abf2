// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Steps in pieces: the bias of taking steps back, and its absence where pieces are chosen
// beforehand.
//
// Particles on circles, dx = D'(x) dt + sqrt(2 D(x)) dW with D = 1 + 0.8 cos x, whose distribution
// must become uniform, with <cos x> = 0.

#include "base/execution.h"
#include "base/pieces.h"
#include "support/particles_in_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace bdh;

namespace {

double D(double x) { return 1.0 + 0.8 * std::cos(x); }
double slope(double x) { return -0.8 * std::sin(x); }

/// Three circles a particle.
class Circles : public bdh_test::ParticlesInField {
 public:
  explicit Circles(long particles) : ParticlesInField(around(3 * particles)) { Circles::update(); }
  double mean_cosine() const
  {
    double sum = 0.0;
    for (double x : x_) sum += std::cos(x);
    return sum / x_.size();
  }

 private:
  static std::vector<double> around(size_t numbers)
  {
    std::vector<double> x(numbers);
    for (size_t k = 0; k < numbers; ++k) x[k] = 2.0 * M_PI * k / numbers;
    return x;
  }
  /// Does not move anything: it is only what the choice of pieces looks at.
  void update() override
  {
    for (size_t k = 0; k < x_.size(); ++k) force_[k] = 20.0 * std::sin(x_[k]);
  }
};

/// A particle whose force is not finite beyond x = 1.
class Edge : public bdh_test::ParticlesInField {
 public:
  explicit Edge(double beyond) : ParticlesInField({0.0, 0.0, 0.0}), beyond_(beyond) {}
  void forget_piece() override { ++forgotten_; }
  int forgotten() const { return forgotten_; }

 private:
  void update() override
  {
    for (size_t k = 0; k < 3; ++k) force_[k] = x_[k] > 1.0 ? beyond_ : 0.0;
  }
  double beyond_;
  int forgotten_ = 0;
};

struct Plan {
  double dt = 0.0, noise_dt = 0.0;
  uint64_t step = 0;
  bool may_fail = false;
};

/// Particles in harmonic traps of stiffness k.
class Traps : public Particles {
 public:
  Traps(long particles, double k) : k_(k), x_(3 * particles, 0.0), force_(x_), before_(x_)
  {
    for (long i = 0; i < particles; ++i) id_.push_back(i + 1);
  }
  long size() const override { return ssize(id_); }
  const double *x() const override { return x_.data(); }
  const double *force() const override { return force_.data(); }
  const uint64_t *ids() const override { return id_.data(); }
  const double *force_before() const override { return before_.data(); }
  void begin_piece(double) override { before_ = force_; }
  void move_and_update_forces(std::vector<double> &d, std::vector<double> *) override { move(d); }
  void end_piece(std::vector<double> &d, const std::vector<double> &, std::vector<double> *,
                 const std::vector<double> &) override
  {
    move(d);
  }
  void finish(const std::vector<double> &d, const std::vector<double> &) override { move(d); }
  /// One Euler-Maruyama step.
  bool take(Particles &p, const Plan &plan) const
  {
    std::vector<double> moved(x_.size()), velocity(x_.size());
    for (long i = 0; i < size(); ++i) {
      double z[4];
      normal4({7, Stream::lanczos, plan.step, 0}, id_[i], z[0], z[1], z[2], z[3]);
      for (int c = 0; c < 3; ++c)
        moved[3 * i + c] = force_[3 * i + c] * plan.dt + std::sqrt(2.0 * plan.dt) * z[c];
    }
    p.finish(moved, velocity);
    return true;
  }
  double largest_change() const
  {
    double largest = 0.0;
    for (long i = 0; i < size(); ++i)
      largest = std::max(largest, LengthOfChange{before_.data(), force_.data()}(i));
    return largest;
  }

 private:
  void move(const std::vector<double> &d)
  {
    for (size_t k = 0; k < x_.size(); ++k) {
      x_[k] += d[k];
      force_[k] = -k_ * x_[k];
    }
  }
  double k_;
  std::vector<double> x_, force_, before_;
  std::vector<uint64_t> id_;
};

/// Displacement of circle k in a step or piece.
double displacement(const Plan &plan, const Circles &p, long k)
{
  double z[4];
  normal4({7, Stream::lanczos, plan.step, 0}, p.ids()[k / 3], z[0], z[1], z[2], z[3]);
  return slope(p.x()[k]) * plan.dt + std::sqrt(2.0 * D(p.x()[k]) * plan.dt) * z[k % 3];
}

/// One Euler-Maruyama step of all circles.
bool take(Particles &p, const Plan &plan, const Circles &circles)
{
  std::vector<double> moved(3 * p.size()), velocity(moved.size());
  for (long k = 0; k < ssize(moved); ++k) {
    moved[k] = displacement(plan, circles, k);
    velocity[k] = moved[k] / plan.dt;
  }
  p.finish(moved, velocity);
  return true;
}

constexpr double dt = 0.02;
constexpr int steps = 4000, settle = 400;
constexpr long particles = 600;

/// <cos x> with a rule for steps: rule(circles, plan) takes one step of a single particle.
template <class Rule> double mean_cosine(Rule rule)
{
  std::vector<Circles> all(particles, Circles(1));
  double sum = 0.0;
  long count = 0;
  for (int s = 0; s < steps; ++s)
    for (long i = 0; i < particles; ++i) {
      rule(all[i], Plan{dt, 0.0, uint64_t(s * particles + i), false});
      if (s < settle) continue;
      sum += all[i].mean_cosine();
      ++count;
    }
  return sum / count;
}

/// Takes a piece; where it goes farther than a limit it is taken back and halved, `left` times.
void halve_by_outcome(Circles &p, const Plan &plan, uint64_t node, int depth, int left)
{
  Plan part = plan;
  part.dt = std::ldexp(plan.dt, -depth);
  part.step = piece_of_step(plan.step, node);
  bool far = false;
  for (long k = 0; k < 3; ++k) far |= std::fabs(displacement(part, p, k)) > 0.25;
  if (!far || left == 0) {
    take(p, part, p);
    return;
  }
  halve_by_outcome(p, plan, 2 * node, depth + 1, left - 1);
  halve_by_outcome(p, plan, 2 * node + 1, depth + 1, left - 1);
}

}    // namespace

// A relaxation takes a time of 1, so that 1800 circles over a time of 72 have some 65000
// independent values of cos x, and their mean has a standard error of 0.0028.
TEST(StatisticsPieces, TakingStepsBackByTheirOutcomeIsBiased)
{
  const double biased =
      mean_cosine([](Circles &p, const Plan &plan) { halve_by_outcome(p, plan, 1, 0, 3); });
  EXPECT_GT(biased, 0.03);
}

TEST(StatisticsPieces, ThoseChosenBeforehandAreNot)
{
  const StepInPieces<HostExecution> pieces{HostExecution(), Comm(MPI_COMM_SELF)};
  std::vector<PieceChoice> choice(particles, PieceChoice(0.12));
  long k = 0, taken = 0, whole = 0;
  const double mean = mean_cosine([&](Circles &p, const Plan &plan) {
    PieceChoice &own = choice[k++ % particles];
    PieceScene scene;
    scene.dt = plan.dt;
    scene.mobility = 1.0;
    scene.kT = 1e-4;    // so that only forces limit pieces
    scene.radius = 1.0;
    scene.longest_move = 1e9;
    own.set_scene(scene);
    pieces.step(p, plan, own, [&](Particles &in, const Plan &part) { return take(in, part, p); });
    double change = 0.0;
    for (int c = 0; c < 3; ++c)
      change = std::max(change, std::fabs(p.force()[c] - p.force_before()[c]));
    own.end(change);
    taken += own.pieces();
    whole += own.pieces() == 1;
  });
  // Both whole and divided steps occur.
  EXPECT_GT(taken, 1.2 * steps * particles);
  EXPECT_GT(whole, 0.1 * steps * particles);
  EXPECT_NEAR(mean, 0.0, 0.014) << taken << " " << whole;
}

// A piece that cannot be taken is halved on the same path; the others are taken once.
TEST(Pieces, AreHalvedWhereAStepWouldFail)
{
  const StepInPieces<HostExecution> pieces{HostExecution(), Comm(MPI_COMM_SELF)};
  Circles whole(5), halved(5);
  PieceChoice choice(0.5);
  PieceScene scene;
  scene.dt = 1.0;
  scene.mobility = 1e-9;
  scene.kT = 1e-9;
  scene.radius = 1.0;
  scene.longest_move = 1e9;
  choice.set_scene(scene);
  // Without slope and with D = 1 halves add up exactly.
  const auto free = [](Particles &p, const Plan &plan, double limit) {
    std::vector<double> moved(3 * p.size()), velocity(moved.size());
    for (long i = 0; i < p.size(); ++i) {
      double z[4];
      normal4({7, Stream::lanczos, plan.step, 0}, p.ids()[i], z[0], z[1], z[2], z[3]);
      for (int c = 0; c < 3; ++c) moved[3 * i + c] = std::sqrt(plan.dt) * z[c];
    }
    if (plan.dt > limit) return false;
    p.finish(moved, velocity);
    return true;
  };
  free(whole, Plan{1.0, 0.0, 3, false}, 2.0);
  std::vector<double> times;
  pieces.step(halved, Plan{1.0, 0.0, 3, false}, choice, [&](Particles &p, const Plan &plan) {
    const bool done = free(p, plan, 0.3);
    if (done) times.push_back(plan.dt);
    return done;
  });
  EXPECT_EQ(times, std::vector<double>(4, 0.25));
  EXPECT_GT(choice.seen().retries, 0.0);
  for (long k = 0; k < 15; ++k) EXPECT_NEAR(whole.x()[k], halved.x()[k], 1e-14);
}

// A piece that leads to forces that are not finite is taken back, and the particles with it.
TEST(Pieces, AreHalvedWhereForcesWouldNotBeFinite)
{
  for (const double beyond : {HUGE_VAL, std::nan("")}) {
    Edge edge(beyond);
    const StepInPieces<HostExecution> pieces{HostExecution(), Comm(MPI_COMM_SELF)};
    PieceChoice choice(0.5);
    PieceScene scene;
    scene.dt = 1.0;
    scene.mobility = 1.0;
    scene.kT = 0.008;    // half a step is short enough for random motion
    scene.radius = 1.0;
    scene.longest_move = 1e9;
    choice.set_scene(scene);
    std::vector<double> times;
    pieces.step(edge, Plan{1.0, 0.0, 3, false}, choice, [&](Particles &p, const Plan &plan) {
      times.push_back(plan.dt);
      std::vector<double> moved(3, times.size() == 1 ? 2.0 : 0.125);
      p.finish(moved, moved);
      return true;
    });
    EXPECT_EQ(times, (std::vector<double>{0.5, 0.25, 0.25, 0.5}));
    EXPECT_EQ(choice.seen().retries, 1.0);
    EXPECT_EQ(choice.pieces(), 3);
    EXPECT_EQ(edge.forgotten(), 1);
    EXPECT_EQ(edge.x()[0], 0.375);
  }
}

// Particles in harmonic traps, dx = -k x dt + sqrt(2) dW, on one Brownian path at all tolerances.
// The change of forces in a piece of length t is k sqrt(2 t) for the random motion and k^2 x t for
// the rest, so that t is proportional to the power 2/3 or 1/2 of the tolerance; with additive noise
// the error of the path is of first order in t.  Lengths are powers of 2, hence the bounds.
TEST(Pieces, ConvergeWithTheTolerance)
{
  const double k = 50.0, dt_of_step = 0.05;
  const int steps_taken = 40;
  const auto end_of = [&](double tolerance) {
    Traps traps(100, k);
    const StepInPieces<HostExecution> pieces{HostExecution(), Comm(MPI_COMM_SELF)};
    PieceChoice choice(tolerance);
    PieceScene scene;
    scene.dt = dt_of_step;
    scene.mobility = scene.kT = 1.0;
    scene.radius = 1.0;
    scene.longest_move = 1e9;
    for (int s = 0; s < steps_taken; ++s) {
      choice.set_scene(scene);
      pieces.step(traps, Plan{dt_of_step, 0.0, uint64_t(s), false}, choice,
                  [&](Particles &p, const Plan &plan) { return traps.take(p, plan); });
      choice.end(traps.largest_change());
    }
    return std::vector<double>(traps.x(), traps.x() + 3 * traps.size());
  };
  const std::vector<double> exact = end_of(0.0002);
  const auto error = [&](double tolerance) {
    const std::vector<double> x = end_of(tolerance);
    double sum = 0.0;
    for (size_t i = 0; i < x.size(); ++i) sum += (x[i] - exact[i]) * (x[i] - exact[i]);
    return std::sqrt(sum / x.size());
  };
  const double coarse = error(0.08), fine = error(0.01);
  EXPECT_LT(coarse, 0.1 / std::sqrt(k));
  EXPECT_GT(std::log(coarse / fine) / std::log(8.0), 0.4);
  EXPECT_LT(std::log(coarse / fine) / std::log(8.0), 0.9);
}

TEST(PieceChoice, FollowsTheTolerance)
{
  PieceScene scene;
  scene.dt = 1.0;
  scene.kT = 1e-4;
  scene.mobility = 1.0;
  scene.radius = 1.0;
  for (const double tolerance : {0.2, 0.05, 0.0125}) {
    PieceChoice choice(tolerance);
    choice.set_scene(scene);
    choice.set_state({4.0, 1.0});
    // dt rate (sqrt(2 kT mu dt) + V dt) <= tolerance, with V = 0.5
    int depth = 0;
    const auto change = [](double t) { return 4.0 * t * (std::sqrt(2e-4 * t) + 0.5 * t); };
    while (change(std::ldexp(1.0, -depth)) > tolerance) ++depth;
    EXPECT_EQ(choice.depth(0.5, 62), depth) << tolerance;
    // Forces that have never been as large count as new: they may move by the tolerance alone.
    EXPECT_GE(std::ldexp(1.0, choice.depth(8.0, 62)), 8.0 / tolerance);
  }
}
