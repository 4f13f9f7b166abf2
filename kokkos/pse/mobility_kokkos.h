// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Positively split Ewald on a device: velocities M F and random velocities of covariance
/// 2 kT M/dt.  See PSE sec. II.
#ifndef BDH_PSE_MOBILITY_KOKKOS_H
#define BDH_PSE_MOBILITY_KOKKOS_H

#include "base/execution_kokkos.h"
#include "base/lanczos.h"
#include "base/vector_kernel.h"
#include "pse/free_mobility.h"
#include "pse/ghosts_kokkos.h"
#include "pse/mobility.h"
#include "pse/real_space_kokkos.h"
#include "pse/sphere_real_space_kokkos.h"
#include "pse/wave_space_kokkos.h"

#include <memory>
#include <type_traits>
#include <vector>

namespace bdh {

/// What a mobility on a device works with; the counterpart of PseHost.
struct PseDevice {
  Comm comm;
  GhostExchange *exchange = nullptr;    ///< needed with several ranks; must outlive the mobility
  SpreadBy by = SpreadBy::automatic;
};

/// The device's parts of the mobility, the counterpart of HostPse.  On one rank only the sums of
/// the Lanczos process leave the device.  Kind: of the particles.
template <class Exec, class Kind> class DevicePse {
 public:
  using Neighbors = DeviceNeighbors;
  template <class Real> using Wave = DeviceWaveSpace<Real, Kind::shapes, Exec>;
  static constexpr bool have_strains = false;
  template <class Real> using Pairs = typename Kind::template Pairs<Real, Exec>;
  template <class Real> using Numbers = typename Kind::template Numbers<Real>;
  using Execution = DeviceExecution<Exec>;

  explicit DevicePse(const PseDevice &device) : device_(device) {}

  /// Collective.
  template <class Real> std::unique_ptr<Wave<Real>> wave(const PsePlan &plan) const
  {
    return std::make_unique<Wave<Real>>(plan, device_.comm, device_.by);
  }
  template <class Real> std::unique_ptr<Pairs<Real>> pairs(const PsePlan &plan) const
  {
    return std::make_unique<Pairs<Real>>(plan);
  }
  Execution execution() const { return {}; }

  template <class Real> void fill_ghosts(Real *v, int quads, long owned, long all) const
  {
    if (device_.comm.size() > 1) bdh::fill_ghosts<Exec>(*device_.exchange, v, quads, owned, all);
  }
  double sum(double mine) const { return device_.comm.sum(mine); }

 private:
  PseDevice device_;
};

/// Spheres of one radius that translate, and all others: on two fields unless they have one radius.
struct EqualOnDevice {
  static constexpr int shapes = 1;
  template <class Real, class Exec> using Pairs = DeviceRealSpace<Real, Exec>;
  template <class Real> using Numbers = EqualNumbers<Real>;
};
template <Moments moments, int fields = 2> struct SpheresOnDevice {
  static constexpr int shapes = fields;
  template <class Real, class Exec> using Pairs = DeviceSphereRealSpace<Real, moments, Exec>;
  template <class Real> using Numbers =
      std::conditional_t<moments == Moments::stresslet, StrainNumbers<Real>,
                         SizedNumbers<Real, moments == Moments::torque>>;
};

using DevicePseMobility = PseMobility<DeviceNeighbors>;

/// Collective.  Makes a mobility on the device, in the plan's precision.  All pointers given to it
/// are device pointers, and positions must be finite.
template <class Exec> std::unique_ptr<DevicePseMobility>
make_device_pse(const PsePlan &plan, int lanczos_limit, const PseDevice &device)
{
  if (!plan.hydrodynamics)
    return std::make_unique<FreeMobility<DeviceExecution<Exec>, DeviceNeighbors>>(plan);
  const auto make = [&](auto kind) -> std::unique_ptr<DevicePseMobility> {
    using Parts = DevicePse<Exec, decltype(kind)>;
    if (plan.single)
      return std::make_unique<SplitEwald<float, Parts>>(plan, lanczos_limit, Parts(device));
    return std::make_unique<SplitEwald<double, Parts>>(plan, lanczos_limit, Parts(device));
  };
  if (plan.is_plain()) return make(EqualOnDevice());
  switch (plan.moments()) {
  case Moments::torque:
    return plan.basis().single() ? make(SpheresOnDevice<Moments::torque, 1>())
                                 : make(SpheresOnDevice<Moments::torque>());
  case Moments::stresslet: return make(SpheresOnDevice<Moments::stresslet>());
  default: return make(SpheresOnDevice<Moments::none>());
  }
}

}    // namespace bdh
#endif
