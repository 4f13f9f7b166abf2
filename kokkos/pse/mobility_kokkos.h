// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Positively split Ewald on a device: velocities M F and random velocities of covariance
/// 2 kT M/dt.  See PSE sec. II.
#ifndef BDH_PSE_MOBILITY_KOKKOS_H
#define BDH_PSE_MOBILITY_KOKKOS_H

#include "base/execution_kokkos.h"
#include "base/lanczos.h"
#include "base/vector_kernel.h"
#include "pse/free_mobility.h"
#include "pse/mobility.h"
#include "pse/real_space_kokkos.h"
#include "pse/wave_space_kokkos.h"

#include <memory>
#include <vector>

namespace bdh {

/// The device's parts of the mobility, the counterpart of HostPse.  There is one process.  Only the
/// sums of the Lanczos process leave the device.
template <class Exec> class DevicePse {
 public:
  using Neighbors = DeviceNeighbors;
  template <class Real> using Wave = DeviceWaveSpace<Real, Exec>;
  template <class Real> using Pairs = DeviceRealSpace<Real, Exec>;
  template <class Real> using Numbers = EqualNumbers<Real>;
  using Execution = DeviceExecution<Exec>;

  explicit DevicePse(SpreadBy by) : by_(by) {}

  template <class Real> std::unique_ptr<Wave<Real>> wave(const PsePlan &plan) const
  {
    return std::make_unique<Wave<Real>>(plan, by_);
  }
  template <class Real> std::unique_ptr<Pairs<Real>> pairs(const PsePlan &plan) const
  {
    return std::make_unique<Pairs<Real>>(plan);
  }
  Execution execution() const { return {}; }

  template <class Real> void fill_ghosts(Real *, int) const {}
  double sum(double all) const { return all; }

 private:
  SpreadBy by_;
};

using DevicePseMobility = PseMobility<DeviceNeighbors>;

/// Makes a mobility on the device, in the plan's precision.  All pointers given to it are device
/// pointers, and positions must be finite.
template <class Exec> std::unique_ptr<DevicePseMobility>
make_device_pse(const PsePlan &plan, int lanczos_limit, SpreadBy by = SpreadBy::automatic)
{
  if (!plan.hydrodynamics)
    return std::make_unique<FreeMobility<DeviceExecution<Exec>, DeviceNeighbors>>(plan);
  const DevicePse<Exec> parts(by);
  if (plan.single)
    return std::make_unique<SplitEwald<float, DevicePse<Exec>>>(plan, lanczos_limit, parts);
  return std::make_unique<SplitEwald<double, DevicePse<Exec>>>(plan, lanczos_limit, parts);
}

}    // namespace bdh
#endif
