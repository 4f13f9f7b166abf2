// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/plan_search.h"

#include "base/errors.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

namespace bdh {

namespace {

/// A number for messages.
std::string text(double value)
{
  std::ostringstream out;
  out.precision(3);
  out << value;
  return out.str();
}

std::string box_text(const PseScene &scene)
{
  return "a box of " + text(scene.edge[0]) + " x " + text(scene.edge[1]) + " x " +
         text(scene.edge[2]);
}

/// What a plan takes of the memory.
std::string memory_text(const PseScene &scene, const PsePlan &p, double memory)
{
  const auto gigabytes = [](double bytes) { return text(std::max(0.01, bytes / 1e9)) + " GB"; };
  return "its grid of " + std::to_string(p.n[0]) + " x " + std::to_string(p.n[1]) + " x " +
         std::to_string(p.n[2]) + " points in " + box_text(scene) + " takes " +
         gigabytes(p.grid_bytes) + " and its pairs " + gigabytes(p.pair_bytes) +
         " of memory, but there are " + gigabytes(memory);
}

/// Refuses a user's xi.
void refuse(const PseScene &scene, const Planner &planner, const PsePlan &p, PseLimit limit)
{
  const std::string cutoff = "its cutoff of " + text(p.r_cut);
  if (limit == PseLimit::cutoff)
    throw InvalidOption("xi", scene.xi,
                        cutoff + " exceeds " + text(scene.largest_cutoff) + ", " +
                            planner.conditions().cutoff_reason +
                            "; or xi auto, or an xi of at least " +
                            text(1.005 *
                                 planner.splitting_with_cutoff(scene.largest_cutoff / scene.radius,
                                                               scene.xi * scene.radius) /
                                 scene.radius));
  if (limit == PseLimit::neighbors)
    throw InvalidOption("xi", scene.xi,
                        cutoff + " makes up to " + text(p.most_neighbors) +
                            " neighbors per particle in " + box_text(scene) + ", more than " +
                            text(planner.conditions().most_neighbors) +
                            ": use a larger one, or xi auto");
  if (limit == PseLimit::memory)
    throw InvalidOption("xi", scene.xi,
                        memory_text(scene, p, planner.conditions().memory) + ": use a " +
                            (p.grid_bytes > p.pair_bytes ? "smaller" : "larger") +
                            " one, or xi auto");
}

/// The cheapest plan of a scene.
class Search {
 public:
  Search(const PseScene &scene, const Planner &planner) : scene_(scene), planner_(planner) {}

  PsePlan run()
  {
    // A splitting of 1/L leaves next to nothing to the modes of a box of side L.
    const double edge = *std::max_element(scene_.edge.begin(), scene_.edge.end()) / scene_.radius,
                 lowest = std::max(least_splitting, std::min(0.08, 0.5 / edge));
    for (bool few_modes : {false, true}) {
      for (Splitting splitting : {Splitting::hasimoto, Splitting::kaiser_bessel})
        if (scene_.splitting == Splitting::automatic || scene_.splitting == splitting)
          scan(splitting, lowest, few_modes);
      if (found()) break;
    }
    if (!found()) refuse_all();
    if (excluded_.xi > 0.0 && excluded_.seconds() < best_.seconds())
      best_.limit = planner_.exceeds(excluded_);
    return best_;
  }

 private:
  void scan(Splitting splitting, double lowest, bool few_modes)
  {
    const PsePlan other = std::exchange(best_, none());
    // The grid grows with xi: what it takes alone ends the scan.
    bool useful = true;
    for (double xi = lowest; xi < planner_.greatest_splitting() && useful; xi *= 1.25)
      useful = consider(splitting, xi, few_modes);
    if (found()) refine(best_.xi, splitting, few_modes);
    // Limits count only if they exclude something that costs less than what they allow.
    if (found() && excluded_.xi > 0.0 && excluded_.splitting == splitting)
      refine(excluded_.xi, splitting, few_modes);
    if (other.xi > 0.0 && !(found() && best_.seconds() < other.seconds())) best_ = other;
  }

  void refine(double coarse, Splitting splitting, bool few_modes)
  {
    for (int i = -4; i <= 4; ++i)
      consider(splitting,
               std::min(coarse * scene_.radius * std::pow(1.04, i), planner_.greatest_splitting()),
               few_modes);
  }

  /// False if the grid takes longer than the best plan as a whole.
  bool consider(Splitting splitting, double xi, bool few_modes)
  {
    PsePlan p;
    if (!planner_.plan(splitting, xi, few_modes, p)) return true;
    const bool allowed = planner_.exceeds(p) == PseLimit::none;
    PsePlan &best = allowed ? best_ : excluded_;
    if (best.xi == 0.0 || p.seconds() < best.seconds()) best = p;
    return !found() || p.wave_seconds < 2.0 * best_.seconds();
  }

  [[noreturn]] void refuse_all() const
  {
    const PseLimit limit = excluded_.xi > 0.0 ? planner_.exceeds(excluded_) : PseLimit::none;
    if (limit == PseLimit::substeps)
      throw InvalidOption("substeps", scene_.substeps,
                          "no splitting keeps the far part soft enough in this box: use fewer");
    if (limit == PseLimit::memory)
      throw InvalidOption("xi", "auto",
                          "the cheapest is " + text(excluded_.xi) + ", and " +
                              memory_text(scene_, excluded_, planner_.conditions().memory) +
                              ": use a smaller box, a looser tolerance or more machines");
    if (limit == PseLimit::neighbors)
      throw InvalidOption("xi", "auto",
                          "with the cheapest, " + text(excluded_.xi) + ", a particle has " +
                              text(excluded_.most_neighbors) + " neighbors in " + box_text(scene_) +
                              ": use a smaller radius or a looser tolerance, or set xi");
    if (limit == PseLimit::cutoff)
      throw InvalidOption("xi", "auto",
                          "no cutoff reaches the tolerance within " + text(scene_.largest_cutoff) +
                              ", " + planner_.conditions().cutoff_reason);
    throw InvalidOption("tolerance", scene_.tolerance,
                        "no parameters reach it in " + box_text(scene_) + ": use a looser one");
  }

  const PseScene &scene_;
  const Planner &planner_;
  PsePlan best_ = none(), excluded_ = none();    // xi = 0: none yet

  bool found() const { return best_.xi > 0.0; }
  static PsePlan none()
  {
    PsePlan p;
    p.xi = 0.0;
    return p;
  }
};

}    // namespace

PsePlan plan_for_given_splitting(const PseScene &scene, const Planner &planner)
{
  const double xi = scene.xi * scene.radius;
  require(xi >= least_splitting && xi <= greatest_splitting_of_one_shape, "xi", scene.xi,
          "must be from 1e-6/radius to 20/radius");
  require(
      xi <= planner.greatest_splitting(), "xi", scene.xi,
      "is too large for rotation or more than two radii, whose near part would not be positive: it "
      "must be at most 1.1/(greatest radius)");
  PsePlan plan;
  const Splitting splitting =
      scene.splitting == Splitting::automatic ? Splitting::hasimoto : scene.splitting;
  if (!planner.plan(splitting, xi, true, plan))
    throw InvalidOption("xi", scene.xi,
                        scene.precision == Precision::single_precision
                            ? "precision single does not reach the tolerance with it: use "
                              "precision double, another xi, or xi auto"
                            : "no grid reaches the tolerance with it: use another, or xi auto");
  refuse(scene, planner, plan, planner.exceeds(plan));
  return plan;
}

PsePlan cheapest_plan(const PseScene &scene, const Planner &planner)
{
  return Search(scene, planner).run();
}

}    // namespace bdh
