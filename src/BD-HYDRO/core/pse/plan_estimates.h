// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The error estimates that a plan is made with: those of equal spheres that translate, or the more
/// general ones.
#ifndef BDH_PSE_PLAN_ESTIMATES_H
#define BDH_PSE_PLAN_ESTIMATES_H

#include "pse/plan.h"
#include "pse/plan_errors.h"
#include "pse/plan_sphere_errors.h"

#include <cmath>
#include <functional>
#include <memory>

namespace bdh {

/// Lengths are in units of the greatest radius, errors relative to |U| and to the norm of the
/// angular velocities.
class PlanEstimates {
 public:
  /// Of a window at a spacing of the grid.
  using OfWindow = std::function<double(const Window &, double)>;

  virtual ~PlanEstimates() = default;
  virtual double real_space(double xi, double r) const = 0;
  virtual double wave_space(double xi, double k) const = 0;
  virtual OfWindow window(double xi, double k_cut) const = 0;
  /// Of a Kaiser-Bessel splitting; reach: k_cut r_cut.
  virtual double kaiser_bessel(double reach, double k_cut) const = 0;
  virtual OfWindow kaiser_bessel_window(double reach, double k_cut) const = 0;
  /// Wave space has two shape functions (pse/shapes_kernel.h).
  virtual bool two_shapes() const = 0;
  /// The least of the motions that errors are relative to, over that of a free sphere.
  virtual double least_motion() const = 0;
};

std::unique_ptr<PlanEstimates> estimates_for(const PseScene &scene);

}    // namespace bdh
#endif
