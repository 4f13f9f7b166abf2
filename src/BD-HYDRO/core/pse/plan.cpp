// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/plan.h"

#include "base/constants.h"
#include "base/errors.h"
#include "grid/fft.h"
#include "pse/plan_cost.h"
#include "pse/plan_search.h"
#include "pse/planner.h"
#include "pse/recent_plans.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

namespace bdh {

Precision precision_from_name(const std::string &name)
{
  if (name == "auto") return Precision::automatic;
  if (name == "single") return Precision::single_precision;
  if (name == "double") return Precision::double_precision;
  throw InvalidOption("precision", name, "must be auto, single or double");
}

double pse_far_share(const RealSpacePart &near)
{
  const double whole = 1.0 - free_space_rpy(2.0).longitudinal;
  return 1.0 - (near.self() - near(2.0 * near.radius()).longitudinal) / whole;
}

double pse_far_share(double xi) { return pse_far_share(RealSpacePart(1.0, xi)); }

double pse_far_share(const PsePlan &plan)
{
  return pse_far_share(plan.real_space_part(plan.radius));
}

double pse_far_stiffness(const PsePlan &plan, int substeps)
{
  const double share = pse_far_share(plan);
  return substeps * share / (1.0 - share);
}

/// Of spheres of radius a.
static KaiserBesselSplit split_of(const PsePlan &plan, double a)
{
  return kaiser_bessel_split(plan.k_cut, plan.r_cut, a, !plan.basis().single());
}

WaveWeight PsePlan::wave_weight() const
{
  return {splitting == Splitting::kaiser_bessel, xi, split_of(*this, radius)};
}

RealSpacePart PsePlan::real_space_part(double a) const
{
  if (splitting == Splitting::kaiser_bessel) return {a, split_of(*this, a), r_cut};
  return {a, xi};
}

std::array<long, 3> pse_largest_index(double k_cut, const std::array<double, 3> &edge)
{
  std::array<long, 3> n;
  for (int d = 0; d < 3; ++d) n[d] = std::floor(k_cut * edge[d] / (2.0 * pi) * (1.0 + 1e-12));
  return n;
}

std::array<long, 3> pse_grid(const PsePlan &plan, const std::array<double, 3> &edge)
{
  const std::array<long, 3> most = pse_largest_index(plan.k_cut, edge);
  std::array<long, 3> n;
  for (int d = 0; d < 3; ++d) {
    const long fine = std::ceil(edge[d] / plan.spacing * (1.0 - 1e-12));
    const long least = std::max<long>({fine, 2 * most[d] + 1, plan.window.width});
    // Sizes that are not multiples of 4 take 1.4 to 1.9 times as long per point.
    n[d] = least > 16 ? cheapest_fft_size(least) : next_fast_size(least, 2);
  }
  return n;
}

namespace {

PsePlan plan_without_hydrodynamics(const PseScene &scene)
{
  PsePlan plan;
  plan.hydrodynamics = false;
  plan.radius = scene.radius;
  plan.least_radius = scene.smallest_radius();
  plan.rotation = scene.rotation;
  plan.stresslets = scene.stresslets;
  plan.volume = scene.volume;
  plan.tolerance = scene.tolerance;
  plan.r_cut = plan.k_cut = 0.0;
  return plan;
}

PsePlan search_plan(const PseScene &scene, const PseConditions &conditions)
{
  require(scene.tolerance >= 1e-12 && scene.tolerance <= 0.5, "tolerance", scene.tolerance,
          "must be from 1e-12 to 0.5");
  require(scene.precision != Precision::single_precision || scene.tolerance >= 1e-5, "tolerance",
          scene.tolerance, "precision single reaches only 1e-5: use precision auto or double");
  const auto edge = std::minmax_element(scene.edge.begin(), scene.edge.end());
  // The mobility exists for spheres that overlap their own images, too.
  require(scene.radius <= *edge.first, "radius", scene.radius,
          "a sphere must not be twice as wide as the box: use a smaller radius, or a box of more "
          "than " +
              std::to_string(scene.radius) + " along each edge");
  require(*edge.second <= 1e6 * scene.radius, "radius", scene.radius,
          "the box is more than a million radii long: use a larger radius or a smaller box");
  const Planner planner(scene, conditions);
  return scene.xi > 0.0 ? plan_for_given_splitting(scene, planner) : cheapest_plan(scene, planner);
}

}    // namespace

PsePlan plan_pse(const PseScene &scene, const PseConditions &conditions)
{
  thread_local RecentPlans recent;
  if (!scene.hydrodynamics) return plan_without_hydrodynamics(scene);
  if (const PsePlan *known = recent.find(scene, conditions)) return *known;
  const PsePlan plan = search_plan(scene, conditions);
  recent.add(scene, conditions, plan);
  return plan;
}

bool pse_plan_holds(const PsePlan &plan, const PseScene &scene)
{
  const PseConditions none;
  if (scene.hydrodynamics != plan.hydrodynamics) return false;
  if (scene.radius != plan.radius || scene.smallest_radius() != plan.least_radius ||
      scene.rotation != plan.rotation || scene.stresslets != plan.stresslets)
    return false;
  return !plan.hydrodynamics || Planner(scene, none).holds(plan);
}

bool change_radius(PsePlan &plan, const PseScene &scene)
{
  if (scene.hydrodynamics != plan.hydrodynamics) return false;
  if (scene.rotation != plan.rotation || scene.stresslets != plan.stresslets) return false;
  PsePlan changed = plan;
  changed.radius = scene.radius;
  changed.least_radius = scene.smallest_radius();
  // One shape function or two take different grids.
  if (changed.basis().single() != plan.basis().single()) return false;
  if (plan.hydrodynamics) {
    const PseConditions none;
    const Planner planner(scene, none);
    if (!planner.holds(changed) || planner.exceeds(changed) != PseLimit::none) return false;
    changed.errors = planner.errors(changed);
  }
  plan = changed;
  return true;
}

bool same_but_for_radius(const PsePlan &a, const PsePlan &b)
{
  const auto words = [](const PsePlan &p) {
    return std::make_tuple(p.hydrodynamics, p.rotation, p.stresslets, p.basis().single(),
                           p.tolerance, p.root_tolerance, p.splitting, p.xi, p.r_cut, p.k_cut,
                           p.spacing, p.window.width, p.window.beta, p.window.continuous,
                           p.window_error, p.table_error, p.single);
  };
  return words(a) == words(b);
}

double pse_split_price(const PsePlan &split, PseScene scene, const PseConditions &conditions)
{
  if (!split.hydrodynamics) return 1.0;
  const int substeps = scene.substeps;
  scene.substeps = 0;
  scene.xi = 0.0;
  return split.seconds() / (substeps * plan_pse(scene, conditions).seconds());
}

}    // namespace bdh
