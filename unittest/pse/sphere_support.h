// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Spheres of any radii that may rotate, for tests of positively split Ewald.
#ifndef BDH_TEST_SPHERE_SUPPORT_H
#define BDH_TEST_SPHERE_SUPPORT_H

#include "pse/mobility_constraint.h"
#include "pse/pse_support.h"

#include <algorithm>

namespace bdh_test {

/// Forces, torques and stresslets, or velocities, angular velocities and rates of strain: 3, 3 and
/// strain_numbers per sphere.
struct Motions {
  std::vector<double> linear, angular, strain{};
};

/// Spheres in a cell.
struct Spheres {
  bdh::Cell cell;
  std::vector<double> x, radius;
  bool rotation = false, stresslets = false;

  long count() const { return bdh::ssize(radius); }
  bdh::PseScene scene(double tolerance) const
  {
    const auto range = std::minmax_element(radius.begin(), radius.end());
    bdh::PseScene s = scene_of(cell, count(), *range.second, tolerance);
    s.least_radius = *range.first;
    for (double a : radius) s.mean_cube += a * a * a / count();
    if (s.least_radius < s.radius)
      for (double a : radius) s.classes.add(a, s.least_radius, s.radius);
    s.rotation = rotation;
    s.stresslets = stresslets;
    return s;
  }
};

/// A mobility bound to spheres, on one rank or several.  All vectors hold all particles.
class SphereHarness {
 public:
  SphereHarness(const Spheres &s, const bdh::PsePlan &plan, const bdh::Comm &comm = self(),
                const bdh::Workers &workers = bdh::Workers::one()) :
      comm_(comm),
      rotation_(plan.rotation), stresslets_(plan.stresslets), deal_(s.count(), comm), n_(s.count()),
      exchange_(comm, n_, deal_.mine), neighbors_(s.cell, s.x, plan.r_cut, deal_.mine),
      M_(bdh::make_pse(plan, 400, {comm, bdh::FftEffort::estimate, &exchange_, workers})),
      mine_(deal_.take(s.x))
  {
    exchange_.use(neighbors_.foreign());
    for (long i : deal_.mine) {
      id_.push_back(i + 1);
      radius_.push_back(s.radius[i]);
    }
    for (long i : neighbors_.foreign()) radius_.push_back(s.radius[i]);
    M_->set_cell(s.cell);
    particles_ = {bdh::ssize(deal_.mine), mine_.data(),     id_.data(),
                  neighbors_.view(),      neighbors_.all(), radius_.data()};
    M_->bind(particles_);
  }

  Motions apply(const Motions &loads, double viscosity)
  {
    const Motions mine = take(loads);
    Motions u = nothing();
    M_->set_viscosity(viscosity);
    M_->apply(forces(mine), velocities(u));
    return gather(u);
  }
  Motions random(const bdh::PseNoise &noise, double viscosity)
  {
    Motions u = nothing();
    M_->set_viscosity(viscosity);
    report = M_->fluctuate({}, noise, velocities(u));
    return gather(u);
  }
  /// M loads by the far and the near part, each on its own.
  Motions far(const Motions &loads, const bdh::PseNoise &noise)
  {
    const Motions mine = take(loads);
    Motions u = nothing();
    M_->set_viscosity(1.0);
    M_->far(forces(mine), noise, velocities(u));
    return gather(u);
  }
  Motions near(const Motions &loads)
  {
    const Motions mine = take(loads);
    Motions u = nothing();
    M_->set_viscosity(1.0);
    M_->near(forces(mine), {}, {velocities(u), {}});
    return gather(u);
  }
  /// Motions under known loads and a constraint, whose unknown loads go to `unknown`.
  /// guess: whether unknown loads are guessed first.
  Motions constrained(const Motions &loads, const bdh::Constraint &constraint, double viscosity,
                      double tolerance, Motions &unknown, bool guess = false)
  {
    Motions mine = take(loads);
    const bdh::Moments moments = M_->plan().moments();
    bdh::MomentVectors<std::vector<double>> motion;
    motion.resize(bdh::ssize(deal_.mine), moments);
    M_->set_viscosity(viscosity);
    M_->keep_pairs();
    const bdh::ConstraintProblem problem =
        solver_.problem(*M_, particles_, constraint, {tolerance, viscosity, 100});
    const auto sum = [this](double mine) { return comm_.sum(mine); };
    if (guess && solver_.guess(problem, sum, motion)) {
      add(solver_.loads().linear, mine.linear);
      add(solver_.loads().angular, mine.angular);
      add(solver_.loads().strain, mine.strain);
    }
    M_->apply(forces(mine), bdh::motions_of(motion));
    report.constraint_iterations = solver_.solve(problem, *M_, sum, motion).iterations;
    const auto &c = solver_.loads();
    unknown = gather({c.linear, c.angular, c.strain});
    return gather({motion.linear, motion.angular, motion.strain});
  }
  bdh::PseReport report;

 private:
  static void add(const std::vector<double> &from, std::vector<double> &to)
  {
    to.resize(from.size());
    for (std::size_t k = 0; k < to.size(); ++k) to[k] += from[k];
  }
  Motions take(const Motions &loads) const
  {
    const auto part = [this](const std::vector<double> &v, long width) {
      return v.empty() ? v : deal_.take(v, width);
    };
    return {part(loads.linear, 3), part(loads.angular, 3), part(loads.strain, bdh::strain_numbers)};
  }
  static bdh::PseForces forces(const Motions &loads)
  {
    const auto at = [](const std::vector<double> &v) { return v.empty() ? nullptr : v.data(); };
    return {loads.linear.data(), true, at(loads.angular), at(loads.strain)};
  }
  static bdh::PseVelocities velocities(Motions &u)
  {
    return {u.linear.data(), u.angular.data(), u.strain.data()};
  }
  Motions nothing() const
  {
    const std::vector<double> none(3 * deal_.mine.size(), NAN),
        strain(bdh::strain_numbers * deal_.mine.size(), NAN);
    return {none, rotation_ ? none : std::vector<double>(),
            stresslets_ ? strain : std::vector<double>()};
  }
  Motions gather(const Motions &u) const
  {
    const auto whole = [this](const std::vector<double> &v, long width, bool there) {
      return there ? deal_.gather(v, n_, comm_, width) : std::vector<double>();
    };
    return {whole(u.linear, 3, true), whole(u.angular, 3, rotation_),
            whole(u.strain, bdh::strain_numbers, stresslets_)};
  }

  bdh::Comm comm_;
  bool rotation_, stresslets_;
  Deal deal_;
  long n_;
  BruteExchange exchange_;
  BruteNeighbors neighbors_;
  std::unique_ptr<bdh::HostPseMobility> M_;
  std::vector<double> mine_, radius_;
  std::vector<uint64_t> id_;
  bdh::PseParticles<bdh::NeighborView> particles_;
  bdh::PseConstraintSolver<bdh::HostExecution, bdh::NeighborView> solver_;
};

}    // namespace bdh_test
#endif
