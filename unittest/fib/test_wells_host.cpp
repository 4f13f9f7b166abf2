// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Steps in pieces where the mobility depends on the position: a double well between stiff walls in
// a slit.  Steps as a whole end such runs.

#include "base/pieces.h"
#include "fib/confined.h"
#include "fib/host.h"
#include "fib/step.h"
#include "support/particles_in_field.h"
#include "support/suspension.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace {

using namespace bdh;
using namespace bdh_test;

constexpr double height = 12.0, middle = 6.0, well = 2.0, barrier = 1.0;    // kT = eta = h = 1
constexpr double stiffness = 60.0, range = 2.0;                             // of the walls
/// A tolerance of 0.03 h.  The radius is twice the true one, which allows pieces to be longer.
constexpr double radius = 2.0, tolerance = 0.015, dt = 0.5;

double energy(double y)
{
  const double s = (y - middle) * (y - middle) / (well * well) - 1.0;
  const double H = std::min(y, height - y), in_wall = std::max(0.0, range - H);
  return barrier * s * s + 0.5 * stiffness * in_wall * in_wall;
}
double force(double y)
{
  const double s = (y - middle) * (y - middle) / (well * well) - 1.0;
  return -4.0 * barrier * s * (y - middle) / (well * well) +
         stiffness * (std::max(0.0, range - y) - std::max(0.0, range - (height - y)));
}

Grid slit()
{
  return with_walls(make_grid({8, static_cast<long>(height)}, {1.0}, 0.0), {"p", "nn"});
}

/// Particles in the wells.
class Wells : public ParticlesInField {
 public:
  explicit Wells(std::vector<double> x) : ParticlesInField(std::move(x)) { Wells::update(); }

 private:
  void update() override
  {
    for (std::size_t k = 1; k < x_.size(); k += 3) force_[k] = ::force(x_[k]);
  }
};

/// Steps of particles in the slit, in pieces if the tolerance is not 0.
class SlitRun {
 public:
  SlitRun(std::vector<double> x, double tolerance, uint32_t seed, double step = dt) :
      fluid_(slit(), IbKernel::peskin4, FftEffort::estimate, self()), step_(fluid_),
      particles(std::move(x)), choice(tolerance)
  {
    plan_.kT = 1.0;
    plan_.dt = step;
    plan_.seed = seed;
    Suspension<FibOnHost> alone(slit(), IbKernel::peskin4, self(), {0.0, middle, 0.0});
    scene_.mobility = alone.velocity({1.0, 0.0, 0.0}, quiet(1.0))[0];
    scene_.dt = step;
    scene_.kT = 1.0;
    scene_.radius = radius;
    scene_.longest_move = 1e9;
  }
  void take()
  {
    choice.set_scene(scene_);
    pieces_.step(particles, plan_, choice,
                 [this](Particles &p, const StepPlan &part) { return step_.take(p, part); });
    if (choice.acts()) choice.end(particles.largest_change());
    ++plan_.step;
  }

 private:
  FibFluid<FibOnHost> fluid_;
  BrownianStep<FibOnHost> step_;
  const StepInPieces<HostExecution> pieces_{HostExecution(), self()};
  StepPlan plan_;
  PieceScene scene_;

 public:
  Wells particles;
  PieceChoice choice;
};

/// Integral over [from, to] by the midpoint rule.
double integral(double from, double to, const std::function<double(double)> &f)
{
  const int points = 2000;
  double sum = 0.0;
  for (int i = 0; i < points; ++i) sum += f(from + (to - from) * (i + 0.5) / points);
  return sum * (to - from) / points;
}

/// Mobility of one particle across the slit, averaged over its place in a cell, from velocities.
class MobilityAcross {
 public:
  MobilityAcross() : table_(1, 0.0)
  {
    Suspension<FibOnHost> alone(slit(), IbKernel::peskin4, self(), {0.0, middle, 0.0});
    for (double y = spacing; y < height; y += spacing) {
      double mean = 0.0;
      for (const double x : {0.0, 0.25, 0.5, 0.75}) {
        alone.bind({x, y, 0.0});
        mean += 0.25 * alone.velocity({0.0, 1.0, 0.0}, quiet(1.0))[1];
      }
      table_.push_back(mean);
    }
    table_.push_back(0.0);
  }
  double operator()(double y) const
  {
    const double at = y / spacing;
    const long i = std::min(static_cast<long>(at), ssize(table_) - 2);
    return table_[i] + (at - i) * (table_[i + 1] - table_[i]);
  }

 private:
  static constexpr double spacing = 0.25;
  std::vector<double> table_;
};

/// Mean first passage time from the bottom of the left well to that of the right one: the double
/// integral of exp(U(y)/kT)/(kT mu(y)) exp(-U(z)/kT) over z < y.
///
/// Particles are seen once a step only.  Those that are seen at a bottom are beyond it by 0.583
/// times the random displacement of a step on average, and first seen as much later
/// (Siegmund, Sequential Analysis (1985), sec. 10.2).
double passage_time(const MobilityAcross &mobility)
{
  const double beyond = 0.583 * std::sqrt(2.0 * dt * mobility(middle - well));
  const auto weight = [](double y) { return std::exp(-energy(y)); };
  return integral(middle - well - beyond, middle + well + beyond,
                  [&](double y) { return integral(0.0, y, weight) / weight(y) / mobility(y); });
}

}    // namespace

TEST(Wells, EndARunOfWholeSteps)
{
  std::vector<double> x;
  for (int i = 0; i < 20; ++i) x.insert(x.end(), {0.4 * i, i % 2 ? 3.0 : 9.0, 0.0});
  const double longer = 4.0 * dt;
  SlitRun whole(x, 0.0, 3, longer), pieces(x, tolerance, 3, longer);
  EXPECT_THROW(for (int s = 0; s < 400; ++s) whole.take(), BadParticle);
  for (int s = 0; s < 400; ++s) pieces.take();
  EXPECT_EQ(pieces.choice.seen().retries, 0.0);
  EXPECT_GT(pieces.choice.seen().pieces, 400.0);
}

// P(y) of 20 particles that meet only in the fluid, in 9 bins of the
// distance to the nearer wall: blocks of 100 time units
// are independent, and T^2 of Hotelling becomes chi-squared of 8 degrees of freedom with a scatter
// of 4.  The bound is exceeded by 1e-5 of seeds.
TEST(StatisticsWells, ArePopulatedByBoltzmann)
{
  std::vector<double> x;
  for (int i = 0; i < 20; ++i) x.insert(x.end(), {0.4 * i, i % 2 ? 3.5 : 8.5, 0.0});
  SlitRun run(x, tolerance, 17);
  const std::vector<double> edges{0.0, 2.2, 2.7, 3.2, 3.7, 4.2, 4.7, 5.2, 5.6, 6.0};
  const long bins = ssize(edges) - 1;
  std::vector<double> exact;
  const auto weight = [](double y) { return std::exp(-energy(y)); };
  for (long b = 0; b < bins; ++b)
    exact.push_back(integral(edges[b], edges[b + 1], weight) / integral(0.0, middle, weight));
  const int blocks = 60, steps = 400;
  Eigen::MatrixXd share = Eigen::MatrixXd::Zero(blocks, bins);
  for (int s = 0; s < 200; ++s) run.take();
  for (int block = 0; block < blocks; ++block)
    for (int s = 0; s < steps; ++s) {
      run.take();
      for (long i = 0; i < 20; ++i) {
        const double y = run.particles.x()[3 * i + 1], H = std::min(y, height - y);
        const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, H);
        share(block, above - edges.begin() - 1) += 1.0 / (20.0 * steps);
      }
    }
  const long free = bins - 1;
  const Eigen::MatrixXd some = share.leftCols(free);
  const Eigen::RowVectorXd mean = some.colwise().mean();
  const Eigen::MatrixXd off = some.rowwise() - mean;
  const Eigen::MatrixXd covariance = off.transpose() * off / double(blocks - 1) / double(blocks);
  const Eigen::VectorXd d =
      mean.transpose() - Eigen::Map<const Eigen::VectorXd>(exact.data(), free);
  const double chi2 =
      d.dot(covariance.ldlt().solve(d)) * double(blocks - free) / double(blocks - 1);
  std::printf("wells: T^2 of %ld bins %.1f, %.2f pieces a step, largest change %.3f radii\n", free,
              chi2, run.choice.seen().pieces / (200.0 + blocks * steps), run.choice.seen().largest);
  EXPECT_LT(chi2, 37.0);
  // Much less would be needed to see a drift of the wrong size: the statistics resolve per cents.
  for (long b = 0; b < free; ++b)
    EXPECT_LT(std::sqrt(covariance(b, b)), 0.05 * exact[b] + 0.002) << b;
}

// One particle, since others resist the flow across the slit.  Passages are independent, and about
// exponentially distributed.
TEST(StatisticsWells, AreLeftInTheRightTime)
{
  SlitRun run({0.3, middle - well, 0.0}, tolerance, 23);
  Mean time;
  long begin = 0;
  int side = -1;
  for (long s = 1; time.n < 150.0; ++s) {
    run.take();
    if (side * (run.particles.x()[1] - middle) > -well) continue;
    time.add(dt * (s - begin));
    begin = s;
    side = -side;
  }
  const double expected = passage_time(MobilityAcross());
  std::printf("wells: mean first passage time %.0f(%.0f), quadrature %.0f\n", time.mean,
              time.error(), expected);
  EXPECT_LT(std::fabs(time.z(expected)), 4.0);
  EXPECT_LT(time.error(), 0.1 * expected);
}
