// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Takes the noise of a step out of the loads that a constraint reports.
///
/// With the slip psi of the step that begins at x, the control variate
///
///     c_0 = -M_cc^-1(x) psi_c
///
/// has the mean 0 whatever x is, since psi has.  So c - c_0 has the mean of c with its Brownian
/// part, but not the white noise of c, whose variance grows with 1/dt.
///
/// The loads c themselves are found as they are without c_0.  If their solve began with c_0, it
/// would end before it has found what is left in the mean, which is small beside the noise that
/// c_0 makes up for.
#ifndef BDH_BASE_NOISE_LOADS_H
#define BDH_BASE_NOISE_LOADS_H

#include "base/constraint.h"

namespace bdh {

/// Residual to which c_0 is found.  Its mean is 0 however far this is from the solution: conjugate
/// gradients turn -psi into -c_0, and both are as probable.  About this share of the noise is left.
constexpr double noise_loads_tolerance = 0.01;

template <class Execution> class NoiseLoads {
 public:
  using Moved = MomentVectors<typename Execution::ParticleVector>;

  explicit NoiseLoads(const Execution &execution) : execution_(execution) {}

  /// There is no c_0 in this step.
  void forget() { kept_ = false; }
  /// Keeps c_0.
  void keep(const Moved &loads, long particles, Moments moments)
  {
    rest_.resize(particles, moments);
    for_parts(loads, [this](const auto &from, auto &to) {
      execution_.scale(1.0, from.data(), to.data(), ssize(to));
    });
    kept_ = true;
  }
  bool kept() const { return kept_; }
  /// From now on rest() is c - c_0.
  void take_from(const Moved &loads)
  {
    for_parts(loads, [this](const auto &c, auto &rest) {
      execution_.for_each("bdh::without_noise", ssize(rest),
                          Combine{1.0, c.data(), -1.0, rest.data(), rest.data()});
    });
  }
  const Moved &rest() const { return rest_; }
  std::size_t memory() const { return rest_.memory(); }

 private:
  template <class Action> void for_parts(const Moved &from, const Action &action)
  {
    action(from.linear, rest_.linear);
    action(from.angular, rest_.angular);
    action(from.strain, rest_.strain);
  }

  Execution execution_;
  Moved rest_;
  bool kept_ = false;
};

}    // namespace bdh
#endif
