// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/plan_estimates.h"

#include "base/constants.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace bdh {

namespace {

class EqualEstimates : public PlanEstimates {
 public:
  explicit EqualEstimates(const Suspension &suspension) : suspension_(suspension) {}
  double real_space(double xi, double r) const override
  {
    return real_space_error(suspension_, xi, r);
  }
  double wave_space(double xi, double k) const override
  {
    return wave_space_error(suspension_, xi, k);
  }
  OfWindow window(double xi, double k_cut) const override
  {
    return WindowError(suspension_, k_cut, [xi](double k) { return mode_weight(k, xi); });
  }
  double kaiser_bessel(double reach, double k_cut) const override
  {
    return tails_.try_emplace(reach, reach).first->second(suspension_, k_cut);
  }
  OfWindow kaiser_bessel_window(double reach, double k_cut) const override
  {
    const KaiserBesselSplit split = kaiser_bessel_split(k_cut, reach / k_cut, 1.0);
    return WindowError(suspension_, k_cut, [split](double k) { return split.weight(k); });
  }
  bool two_shapes() const override { return false; }
  double least_motion() const override { return suspension_.equal_velocity(); }

 private:
  Suspension suspension_;
  mutable std::map<double, KaiserBesselTail> tails_;    // by reach
};

class SphereEstimates : public PlanEstimates {
 public:
  explicit SphereEstimates(const SphereSuspension &suspension) : pairs_(suspension) {}
  double real_space(double xi, double r) const override { return errors(xi).real_space(r); }
  double wave_space(double xi, double k) const override { return errors(xi).wave_space(k); }
  OfWindow window(double xi, double k_cut) const override
  {
    return SphereWindowError(suspension(), {false, xi, {}}, k_cut);
  }
  double kaiser_bessel(double reach, double k_cut) const override
  {
    return tails_.try_emplace(reach, reach).first->second(pairs_, k_cut);
  }
  OfWindow kaiser_bessel_window(double reach, double k_cut) const override
  {
    const KaiserBesselSplit split = kaiser_bessel_split(k_cut, reach / k_cut, 1.0, two_shapes());
    return SphereWindowError(suspension(), {true, 0.0, split}, k_cut);
  }
  bool two_shapes() const override { return !pairs_.basis().single(); }
  double least_motion() const override
  {
    const double equal = suspension().equal_velocity();
    return suspension().rotation ? std::min(equal, suspension().coupled()) : equal;
  }

 private:
  /// Those of the last splitting are kept.
  const SphereErrors &errors(double xi) const
  {
    if (!errors_ || xi != xi_) errors_.emplace(pairs_, xi);
    xi_ = xi;
    return *errors_;
  }

  const SphereSuspension &suspension() const { return pairs_.suspension(); }

  SpherePairs pairs_;
  mutable std::optional<SphereErrors> errors_;
  mutable double xi_ = 0.0;
  mutable std::map<double, SphereTail> tails_;    // by reach
};

}    // namespace

std::unique_ptr<PlanEstimates> estimates_for(const PseScene &scene)
{
  const double a = scene.radius, n = scene.particles;
  const double density = n * a * a * a / scene.volume;
  if (scene.is_plain()) return std::make_unique<EqualEstimates>(Suspension{density, n});
  const double mean_cube = scene.mean_cube > 0.0 ? scene.mean_cube : a * a * a;
  const double phi = 4.0 / 3.0 * pi * n * mean_cube / scene.volume;
  std::vector<RadiusClass> classes = classes_of(scene.classes, a);
  for (RadiusClass &c : classes) c.radius /= a;
  return std::make_unique<SphereEstimates>(SphereSuspension{density, n, scene.smallest_radius() / a,
                                                            phi, std::move(classes), scene.rotation,
                                                            scene.stresslets});
}

}    // namespace bdh
