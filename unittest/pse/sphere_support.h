// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Spheres of any radii that may rotate, for tests of positively split Ewald.
#ifndef BDH_TEST_SPHERE_SUPPORT_H
#define BDH_TEST_SPHERE_SUPPORT_H

#include "pse/pse_support.h"

#include <algorithm>

namespace bdh_test {

/// Forces and torques, or velocities and angular velocities, 3 numbers per sphere each.
struct Motions {
  std::vector<double> linear, angular;
};

/// Spheres in a cell.
struct Spheres {
  bdh::Cell cell;
  std::vector<double> x, radius;
  bool rotation = false;

  long count() const { return bdh::ssize(radius); }
  bdh::PseScene scene(double tolerance) const
  {
    const auto range = std::minmax_element(radius.begin(), radius.end());
    bdh::PseScene s = scene_of(cell, count(), *range.second, tolerance);
    s.least_radius = *range.first;
    for (double a : radius) s.mean_cube += a * a * a / count();
    s.rotation = rotation;
    return s;
  }
};

/// A mobility bound to spheres, on one rank or several.  All vectors hold all particles.
class SphereHarness {
 public:
  SphereHarness(const Spheres &s, const bdh::PsePlan &plan, const bdh::Comm &comm = self(),
                const bdh::Workers &workers = bdh::Workers::one()) :
      comm_(comm),
      rotation_(plan.rotation), deal_(s.count(), comm), n_(s.count()),
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
    M_->bind({bdh::ssize(deal_.mine), mine_.data(), id_.data(), neighbors_.view(), neighbors_.all(),
              radius_.data()});
  }

  Motions apply(const Motions &loads, double viscosity)
  {
    const std::vector<double> f = deal_.take(loads.linear), t = torques(loads);
    Motions u = nothing();
    M_->set_viscosity(viscosity);
    M_->apply({f.data(), true, t.empty() ? nullptr : t.data()},
              {u.linear.data(), u.angular.data()});
    return gather(u);
  }
  Motions random(const bdh::PseNoise &noise, double viscosity)
  {
    Motions u = nothing();
    M_->set_viscosity(viscosity);
    report = M_->fluctuate({}, noise, {u.linear.data(), u.angular.data()});
    return gather(u);
  }
  /// M loads by the far and the near part, each on its own.
  Motions far(const Motions &loads, const bdh::PseNoise &noise)
  {
    const std::vector<double> f = deal_.take(loads.linear), t = torques(loads);
    Motions u = nothing();
    M_->set_viscosity(1.0);
    M_->far({f.data(), true, t.empty() ? nullptr : t.data()}, noise,
            {u.linear.data(), u.angular.data()});
    return gather(u);
  }
  Motions near(const Motions &loads)
  {
    const std::vector<double> f = deal_.take(loads.linear), t = torques(loads);
    Motions u = nothing();
    M_->set_viscosity(1.0);
    M_->near({f.data(), true, t.empty() ? nullptr : t.data()}, {},
             {{u.linear.data(), u.angular.data()}, {}});
    return gather(u);
  }
  bdh::PseReport report;

 private:
  std::vector<double> torques(const Motions &loads) const
  {
    return loads.angular.empty() ? loads.angular : deal_.take(loads.angular);
  }
  Motions nothing() const
  {
    const std::vector<double> none(3 * deal_.mine.size(), NAN);
    return {none, rotation_ ? none : std::vector<double>()};
  }
  Motions gather(const Motions &u) const
  {
    return {deal_.gather(u.linear, n_, comm_),
            rotation_ ? deal_.gather(u.angular, n_, comm_) : std::vector<double>()};
  }

  bdh::Comm comm_;
  bool rotation_;
  Deal deal_;
  long n_;
  BruteExchange exchange_;
  BruteNeighbors neighbors_;
  std::unique_ptr<bdh::HostPseMobility> M_;
  std::vector<double> mine_, radius_;
  std::vector<uint64_t> id_;
};

}    // namespace bdh_test
#endif
