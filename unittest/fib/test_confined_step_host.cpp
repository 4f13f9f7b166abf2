// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Equilibrium between walls: FIB sec. V C 2, Fig. 4 and Table I.

#include "fib/confined.h"
#include "fib/host.h"
#include "fib/step.h"
#include "support/reference_json.h"
#include "support/suspension.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <vector>

namespace {

using namespace bdh;
using namespace bdh_test;

/// The channel of Table I: kT = eta = h = 1, 8 x 64 (2D), springs of stiffness 6 at either wall.
/// With the range of Table I, 7 h, the springs would keep particles 5 h away from the wall.  There
/// the mobility, and with it the biased law, differs from that in the middle by only 1 %.  With a
/// range of 3 h the bias is 50 % at H = 2.  (Soft springs would not do: 1/mu cannot be integrated
/// up to the wall.)
constexpr double stiffness = 6.0, range = 3.0;

double wall_force(double H) { return H < range ? stiffness * (range - H) : 0.0; }
double wall_energy(double H)
{
  return H < range ? 0.5 * stiffness * (range - H) * (range - H) : 0.0;
}

/// Independent particles in the channel, whose positions are updated in place.
class ChannelParticles : public Particles {
 public:
  ChannelParticles(std::vector<double> x, double height) : x_(std::move(x)), height_(height)
  {
    update();
  }
  long size() const override { return x_.size() / 3; }
  const double *x() const override { return x_.data(); }
  const double *force() const override { return f_.data(); }
  const uint64_t *ids() const override { return id_.data(); }
  void move_and_update_forces(std::vector<double> &displacement, std::vector<double> *) override
  {
    finish(displacement, displacement);
  }
  void finish(const std::vector<double> &displacement, const std::vector<double> &) override
  {
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] += displacement[i];
    update();
  }

 private:
  void update()
  {
    f_.assign(x_.size(), 0.0);
    for (std::size_t i = 1; i < x_.size(); i += 3)
      f_[i] = wall_force(x_[i]) - wall_force(height_ - x_[i]);
  }
  std::vector<double> x_, f_;
  std::vector<uint64_t> id_ = counted(x_.size() / 3);
  double height_;
};

struct Channel {
  double height;
  std::vector<double> edges;    ///< bin edges for the distance to the nearer wall
  Grid grid() const
  {
    return with_walls(make_grid({8, static_cast<long>(height)}, {1.0}, 0.0), {"p", "nn"});
  }
};

/// Mobility of one particle at H, averaged over positions in x: along the channel (d = 0) or across
/// it (d = 1).
double mobility(const Channel &channel, double H, int d)
{
  Suspension<FibOnHost> s(channel.grid(), IbKernel::peskin4, self(), {0.0, H, 0.0});
  double sum = 0.0;
  for (double x : {0.0, 0.25, 0.25, 0.5}) {
    s.bind({x, H, 0.0});
    std::vector<double> unit(3, 0.0);
    unit[d] = 1.0;
    sum += 0.25 * s.velocity(unit, quiet(1.0))[d];
  }
  return sum;
}

/// Perpendicular mobility, tabulated at every h/8 and interpolated linearly.
class Mobility {
 public:
  explicit Mobility(const Channel &channel)
  {
    for (double H = 0.0; H <= 0.5 * channel.height; H += 0.125)
      mu_.push_back(mobility(channel, H, 1));
  }
  double operator()(double H) const
  {
    const std::size_t i = std::min(static_cast<std::size_t>(8.0 * H), mu_.size() - 2);
    const double t = 8.0 * H - i;
    return (1.0 - t) * mu_[i] + t * mu_[i + 1];
  }

 private:
  std::vector<double> mu_;
};

// The bins are fine where the springs act.
const Channel wide{64.0,
                   {0.0, 1.8, 2.1, 2.4, 2.7, 3.0, 3.5, 4.0, 5.0, 7.0, 10.0, 15.0, 22.0, 32.0}};
const Channel narrow{12.0, {0.0, 1.8, 2.0, 2.2, 2.4, 2.6, 2.8, 3.0, 3.4, 3.8, 4.3, 4.8, 5.4, 6.0}};

/// Probability of each bin for a density of H that need not be normalised.
std::vector<double> shares(const std::vector<double> &edges,
                           const std::function<double(double)> &density)
{
  std::vector<double> p;
  double sum = 0.0;
  for (std::size_t b = 0; b + 1 < edges.size(); ++b) {
    const int points = 400;
    double integral = 0.0;
    for (int i = 0; i < points; ++i)
      integral += density(edges[b] + (edges[b + 1] - edges[b]) * (i + 0.5) / points);
    p.push_back(integral * (edges[b + 1] - edges[b]) / points);
    sum += p.back();
  }
  for (double &v : p) v /= sum;
  return p;
}

/// Fraction of particles in each bin, for runs that are independent of each other.
struct Histogram {
  std::vector<std::vector<double>> share;    // [run][bin]

  /// Hotelling's T^2: the squared deviation in units of the scatter between runs, summed over all
  /// bins except the last, which the others determine.
  double chi2(const std::vector<double> &expected) const
  {
    const long runs = bdh::ssize(share), bins = bdh::ssize(expected) - 1;
    Eigen::MatrixXd x(runs, bins);
    for (long r = 0; r < runs; ++r)
      for (long b = 0; b < bins; ++b) x(r, b) = share[r][b];
    const Eigen::RowVectorXd mean = x.colwise().mean();
    const Eigen::MatrixXd c = x.rowwise() - mean;
    const Eigen::MatrixXd covariance = c.transpose() * c / double(runs - 1) / double(runs);
    Eigen::VectorXd d(bins);
    for (long b = 0; b < bins; ++b) d[b] = mean[b] - expected[b];
    // T^2 has an F distribution; with this factor it becomes chi-squared for many runs.
    return d.dot(covariance.ldlt().solve(d)) * double(runs - bins) / double(runs - 1);
  }
};

/// Independent runs of `particles` that start in equilibrium, by rejection sampling from the
/// density.  beta = 2 chi dt/h^2 with the largest chi, which is kT times the parallel mobility at
/// mid-channel.  In so short a channel without a mean pressure gradient it is much larger than the
/// perpendicular mobility, and the random shear limits the step.
Histogram sample(const Channel &channel, Scheme scheme, double beta, long particles, int runs,
                 int steps, const std::function<double(double)> &density)
{
  FibFluid<FibOnHost> fluid(channel.grid(), IbKernel::peskin4, FftEffort::estimate, self());
  BrownianStep<FibOnHost> step(fluid);
  StepPlan plan;
  plan.scheme = scheme;
  plan.drift = scheme == Scheme::euler ? Drift::no : Drift::exact;
  plan.kT = 1.0;
  plan.dt = 0.5 * beta / mobility(channel, 0.5 * channel.height, 0);
  const std::vector<double> &edges = channel.edges;
  double top = 0.0;
  for (double H = 0.5; H < edges.back(); H += 0.01) top = std::max(top, density(H));
  Histogram h;
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> uniform;
  for (int run = 0; run < runs; ++run) {
    std::vector<double> x;
    while (bdh::ssize(x) < 3 * particles) {
      const double H = channel.height * uniform(engine), near = std::min(H, channel.height - H);
      if (near > 0.5 && uniform(engine) * top < density(near))
        x.insert(x.end(), {8.0 * uniform(engine), H, 0.0});
    }
    ChannelParticles p(x, channel.height);
    std::vector<double> count(edges.size() - 1, 0.0);
    plan.seed = 100 + run;
    for (int s = 0; s < steps; ++s) {
      plan.step = s;
      step.take(p, plan);
      for (long i = 0; i < particles; ++i) {
        const double y = p.x()[3 * i + 1], near = std::min(y, channel.height - y);
        const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, near);
        count[above - edges.begin() - 1] += 1.0 / double(steps * particles);
      }
    }
    h.share.push_back(count);
  }
  return h;
}

/// Particles without forces that stay in place and record the velocity of the step.
class RestingParticles : public Particles {
 public:
  explicit RestingParticles(std::vector<double> x) : x_(std::move(x)), f_(x_.size(), 0.0) {}
  long size() const override { return x_.size() / 3; }
  const double *x() const override { return x_.data(); }
  const double *force() const override { return f_.data(); }
  const uint64_t *ids() const override { return id_.data(); }
  void move_and_update_forces(std::vector<double> &, std::vector<double> *) override {}
  void finish(const std::vector<double> &, const std::vector<double> &v) override
  {
    velocity = Eigen::Map<const Eigen::VectorXd>(v.data(), bdh::ssize(v));
  }
  Eigen::VectorXd velocity;

 private:
  std::vector<double> x_, f_;
  std::vector<uint64_t> id_ = counted(x_.size() / 3);
};

double boltzmann(double H) { return std::exp(-wall_energy(H)); }

}    // namespace

// With the same random stresses, a step with drift differs from one without only by J L^-1 kT div
// S. The mean of the random finite differences must equal the exact derivative, and either of them
// plus the derivative of J must equal div M of the reference.  The exact derivative does not
// scatter; the random differences do, by ten times the drift itself.
TEST(StatisticsConfined, RandomFiniteDifferenceHasTheMeanOfTheExactDrift)
{
  const int samples = 400;
  double chi2 = 0.0, scatter = 0.0, size = 0.0;
  long freedom = 0, cases = 0;
  const nlohmann::json all = json_reference("fib_divM.json");
  for (const nlohmann::json &c : all["cases"]) {
    const std::vector<double> h{c["h"].get<double>()};
    const Grid g = with_walls(make_grid(c["n"].get<std::vector<long>>(), h, 0.0),
                              c["bc"].get<std::vector<std::string>>());
    if (g.walled_axes() == 0) continue;
    const IbKernel kernel = c["kernel"] == 3 ? IbKernel::roma3 : IbKernel::peskin4;
    const std::vector<double> x = flatten_to_3d(c["x"]), reference = flatten_to_3d(c["div_M"]);
    FibFluid<FibOnHost> fluid(g, kernel, FftEffort::estimate, self());
    BrownianStep<FibOnHost> step(fluid);
    RestingParticles p(x);
    StepPlan plan;
    plan.scheme = Scheme::euler;
    plan.kT = 1.0;
    plan.viscosity = c["eta"];
    plan.dt = 1e-4;
    plan.tolerance = 1e-12;
    const auto velocity = [&](Drift drift) {
      plan.drift = drift;
      step.take(p, plan);
      return p.velocity;
    };
    const std::vector<double> total =
        divergence_of_mobility<FibOnHost>(g, kernel, plan.viscosity, x, 1e-13);
    const Eigen::VectorXd exact = velocity(Drift::exact) - velocity(Drift::no);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(exact.size()), squares = sum;
    for (int s = 0; s < samples; ++s) {
      plan.step = s;
      const Eigen::VectorXd d = velocity(Drift::finite_difference) - velocity(Drift::no);
      sum += d;
      squares += d.cwiseAbs2();
    }
    const Eigen::VectorXd mean = sum / samples, variance = squares / samples - mean.cwiseAbs2();
    for (long i = 0; i < mean.size(); ++i) {
      if (i % 3 >= g.dim) continue;
      const double derivative_of_J = total[i] - exact[i];
      const double off = mean[i] + derivative_of_J - reference[i];
      chi2 += off * off / (variance[i] / (samples - 1));
      scatter += variance[i];
      size += exact[i] * exact[i];
      ++freedom;
    }
    ++cases;
  }
  std::printf("drift by random finite difference: chi2 %.1f for %ld components; its scatter %.2f "
              "of the drift\n",
              chi2, freedom, std::sqrt(scatter / size));
  EXPECT_EQ(cases, 20);
  // 4 standard deviations of chi-squared on either side.
  EXPECT_LT(std::fabs(chi2 - freedom), 4.0 * std::sqrt(2.0 * freedom));
}

// With 12 degrees of freedom chi2 exceeds 40.5 for 6e-5 of all seeds.  The same bound must reject
// the biased law.
TEST(StatisticsConfined, MidpointIsGibbsBoltzmann)
{
  const Mobility mu(wide);
  const Histogram h = sample(wide, Scheme::midpoint, 0.45, 100, 120, 1500, boltzmann);
  const double right = h.chi2(shares(wide.edges, boltzmann));
  const double wrong =
      h.chi2(shares(wide.edges, [&](double H) { return H > 0.5 ? boltzmann(H) / mu(H) : 0.0; }));
  std::printf(
      "midpoint, beta 0.45: chi2 of 12 bins %.1f for Gibbs-Boltzmann, %.0f for the biased law\n",
      right, wrong);
  EXPECT_LT(right, 40.5);
  EXPECT_GT(wrong, 40.5);
}

// FIB eq. (47) is exact for small steps and one particle.  Runs start from this law and last a few
// relaxation times across the narrow channel, long enough for any other law to show.  The bound
// must reject Gibbs-Boltzmann.
TEST(StatisticsConfined, EulerIsBiasedByTheMobility)
{
  const Mobility mu(narrow);
  const auto biased = [&](double H) { return H > 0.5 ? boltzmann(H) / mu(H) : 0.0; };
  const Histogram h = sample(narrow, Scheme::euler, 0.1, 1, 100, 20000, biased);
  const double right = h.chi2(shares(narrow.edges, biased)),
               wrong = h.chi2(shares(narrow.edges, boltzmann));
  std::printf(
      "Euler, beta 0.1: chi2 of 12 bins %.1f for the biased law, %.0f for Gibbs-Boltzmann\n", right,
      wrong);
  EXPECT_LT(right, 40.5);
  EXPECT_GT(wrong, 40.5);
}
