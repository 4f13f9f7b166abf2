// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Shared by the benchmarks of positively split Ewald: random hard spheres, plans, timing.
#ifndef BDH_BENCH_PSE_SCENE_H
#define BDH_BENCH_PSE_SCENE_H

#include "base/constants.h"
#include "base/phases.h"
#include "pse/cell_neighbors.h"
#include "pse/mobility.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <random>
#include <vector>

namespace bdh_bench {

using bdh::pi;

/// Times of the calls in seconds, sorted.
inline std::vector<double> sorted_times(int repeats, const std::function<void()> &work)
{
  std::vector<double> t(repeats, 0.0);
  for (double &seconds : t) {
    const auto start = std::chrono::steady_clock::now();
    work();
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  std::sort(t.begin(), t.end());
  return t;
}

inline double median_time(int repeats, const std::function<void()> &work)
{
  const std::vector<double> t = sorted_times(repeats, work);
  return t[t.size() / 2];
}

/// The time that this thread has spent in phases since the object was made.
class PhasesSince {
 public:
  double seconds(std::initializer_list<bdh::Phase> phases) const
  {
    double sum = 0.0;
    for (const bdh::Phase phase : phases) {
      const int p = static_cast<int>(phase);
      sum += bdh::PhaseClock::mine().times()[p] - start_[p];
    }
    return sum;
  }

 private:
  bdh::PhaseTimes start_ = bdh::PhaseClock::mine().times();
};

/// Number of calls for a median if one call takes `seconds`: 3 to 15, about `all` seconds together.
inline int repeats_for(double seconds, double all = 2.0)
{
  return std::clamp(all / seconds, 3.0, 15.0);
}

/// |a - b|/|b|
inline double relative_difference(const std::vector<double> &a, const std::vector<double> &b)
{
  double s = 0.0, scale = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    s += (a[i] - b[i]) * (a[i] - b[i]);
    scale += b[i] * b[i];
  }
  return std::sqrt(s / scale);
}

/// Spheres in a cube, under random forces and torques.
struct Scene {
  long n;
  double L;
  std::vector<double> x, force, torque;
  std::vector<double> radius;    ///< 1, unless set_radii() is called
  bool rotation = false;
  std::vector<uint64_t> id;

  /// Hard spheres at volume fraction phi.
  Scene(long count, double phi) : Scene(hard_spheres(count, side(count, phi), 1), side(count, phi))
  {}
  Scene(std::vector<double> positions, double box) :
      n(positions.size() / 3), L(box), x(std::move(positions))
  {
    std::mt19937_64 engine(2);
    std::normal_distribution<double> normal;
    for (long i = 0; i < 3 * n; ++i) force.push_back(normal(engine));
    for (long i = 0; i < 3 * n; ++i) torque.push_back(normal(engine));
    for (long i = 0; i < n; ++i) id.push_back(i + 1);
    radius.assign(n, 1.0);
  }
  /// Radii of as many classes, from 1/ratio to 1 at equal steps of the logarithm, at random places.
  void set_radii(double ratio, int classes)
  {
    std::mt19937_64 engine(3);
    std::uniform_int_distribution<int> some(0, classes - 1);
    for (double &a : radius) a = std::pow(ratio, -some(engine) / std::max(1.0, classes - 1.0));
  }
  static double side(long n, double phi) { return std::cbrt(4.0 / 3.0 * pi * n / phi); }
  double phi() const { return 4.0 / 3.0 * pi * n / (L * L * L); }

  bdh::Cell cell() const
  {
    bdh::Cell c;
    c.lx = c.ly = c.lz = L;
    return c;
  }
  /// What plans depend on in addition to pse().  skin: of the neighbor list.
  bdh::PseConditions conditions(double skin = 0.5) const
  {
    bdh::PseConditions c;
    c.counts = bdh::count_pairs(cell(), 1.0, x.data(), id.data(), n, bdh::Comm(MPI_COMM_SELF));
    c.skin = skin;
    return c;
  }
  /// xi = 0 chooses the cheapest one.
  bdh::PseScene pse(double tolerance, double xi, bool noise) const
  {
    bdh::PseScene s;
    s.volume = L * L * L;
    s.edge = {L, L, L};
    s.particles = n;
    s.tolerance = tolerance;
    s.noise = noise;
    s.xi = xi;
    s.rotation = rotation;
    s.least_radius = *std::min_element(radius.begin(), radius.end());
    for (double a : radius) s.mean_cube += a * a * a / n;
    if (s.least_radius < s.radius)
      for (double a : radius) s.classes.add(a, s.least_radius, s.radius);
    return s;
  }
};

/// A mobility bound to a scene on one process.  skin: of the neighbor list [a]
class Bound {
 public:
  Bound(const Scene &scene, const bdh::PsePlan &plan, double skin = 0.5,
        bdh::FftEffort effort = bdh::FftEffort::measure) :
      scene_(scene),
      neighbors_(scene.x, scene.L, plan.r_cut + skin),
      M_(bdh::make_pse(plan, 1000, {bdh::Comm(MPI_COMM_WORLD), effort})), u_(scene.force.size()),
      w_(u_)
  {
    M_->set_cell(scene.cell());
    M_->set_viscosity(1.0);
  }
  /// M F at the positions of the scene, including everything that a step does.
  const std::vector<double> &apply()
  {
    bind();
    M_->apply(loads(), {u_.data(), w_.data()});
    return u_;
  }
  /// M F + noise.
  const std::vector<double> &fluctuate()
  {
    bind();
    report = M_->fluctuate(loads(), {2.0, 7, ++step_}, {u_.data(), w_.data()});
    return u_;
  }
  bdh::HostPseMobility &mobility() { return *M_; }
  void bind()
  {
    M_->bind({scene_.n, scene_.x.data(), scene_.id.data(), neighbors_.view(), scene_.n,
              scene_.radius.data()});
  }
  const std::vector<double> &angular() const { return w_; }
  bdh::PseReport report;

 private:
  bdh::PseForces loads() const
  {
    return {scene_.force.data(), true, scene_.rotation ? scene_.torque.data() : nullptr};
  }

  const Scene &scene_;
  CellNeighbors neighbors_;
  std::unique_ptr<bdh::HostPseMobility> M_;
  std::vector<double> u_, w_;
  uint64_t step_ = 0;
};

}    // namespace bdh_bench
#endif
