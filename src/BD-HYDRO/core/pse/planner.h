// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Plans of positively split Ewald for given splittings: cutoffs, grid and window from the error
/// estimates, and what they cost.
#ifndef BDH_PSE_PLANNER_H
#define BDH_PSE_PLANNER_H

#include "pse/plan.h"
#include "pse/plan_cost.h"
#include "pse/plan_estimates.h"

#include <memory>

namespace bdh {

/// The splittings that are considered [1/radius]; the greatest is that of one shape function.
constexpr double least_splitting = 1e-6, greatest_splitting_of_one_shape = 20.0;

/// Plans for given splittings of a scene; xi is in units of 1/a here, with the greatest radius a.
/// The scene and the conditions must outlive it.
class Planner {
 public:
  Planner(const PseScene &scene, const PseConditions &conditions);

  /// p := the plan.  few_modes: plans with fewer modes than the estimates need are filled up to
  /// them.  False if no grid reaches the tolerance, or this splitting is not for the scene.
  bool plan(Splitting splitting, double xi, bool few_modes, PsePlan &p) const;
  /// See pse_plan_holds().
  bool holds(const PsePlan &p) const;
  /// Estimates for a plan that was made for another scene.
  PseErrors errors(const PsePlan &p) const;
  /// The largest xi up to `from` whose cutoff is r [a] or longer: from there on shorter ones.
  double splitting_with_cutoff(double r, double from) const;
  /// What of the scene's limits a plan exceeds.
  PseLimit exceeds(const PsePlan &p) const;

  const PseConditions &conditions() const { return conditions_; }
  /// The greatest xi that is considered: its near part is positive.
  double greatest_splitting() const;

 private:
  double share_of_window() const;
  bool cut_hasimoto(double xi, bool few_modes, PsePlan &p) const;
  bool cut_kaiser_bessel(double xi, bool few_modes, PsePlan &p) const;
  bool may_be_kaiser_bessel(double reach, double k_cut) const;
  PlanEstimates::OfWindow window_error(const PsePlan &p) const;
  bool has_modes(const PsePlan &p) const { return p.k_cut * a_ >= (1.0 - 1e-9) * least_k_cut(); }
  /// The estimates are integrals over modes: a small box has too few for them, and costs little
  /// anyway.
  double least_k_cut() const;
  double rounding_of_pairs(double r_cut) const;
  double rounding(const PsePlan &p) const;
  double real_space_cutoff(double xi) const;
  /// False if the scene's precision is too low.
  bool choose_precision(PsePlan &p) const;
  /// Window, grid and price.  False if no window reaches the tolerance.
  bool choose_window(PsePlan &p) const;

  const PseScene &scene_;
  const PseConditions &conditions_;
  Surroundings around_;
  double a_, tolerance_;
  std::unique_ptr<PlanEstimates> estimates_;
  bool single_;
};

}    // namespace bdh
#endif
