// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Carries spheres in the memory of a device to the ranks whose planes they touch, and back.
#ifndef BDH_PSE_SPHERE_EXCHANGE_KOKKOS_H
#define BDH_PSE_SPHERE_EXCHANGE_KOKKOS_H

#include "base/bytes_of.h"
#include "base/moments_kernel.h"
#include "grid/slabs_kokkos.h"
#include "pse/particles.h"

namespace bdh {

/// Carries positions, radii and loads to the slabs, and motions back.  On one rank nothing is
/// copied.  moments: what the spheres have besides forces.
template <class Exec> class DeviceSphereExchange {
 public:
  DeviceSphereExchange(const GridParts &slabs, Moments moments) :
      moments_(moments), positions_(slabs, dim), vectors_(positions_, dim), turns_(positions_, dim),
      radii_(positions_, 1), tensors_(positions_, strain_numbers)
  {}

  /// Collective.  See DeviceSlabExchange.
  template <class First> void plan(long spheres, const First &first, long reach)
  {
    spheres_ = spheres;
    positions_.plan(spheres, first, reach);
  }
  long count() const { return positions_.count(); }

  /// Collective.  What they return is valid until the next call of the same one.
  const double *positions(const double *mine) { return positions_.bring(mine); }
  const double *radii(const double *mine) { return radii_.bring(mine); }
  PseForces bring(const PseForces &mine)
  {
    if (positions_.alone()) return mine;
    PseForces f = mine;
    f.values = vectors_.bring(mine.values);
    if (have_torques()) f.torques = turns_.bring(or_zeros(mine.torques, dim));
    if (have_stresslets()) f.stresslets = tensors_.bring(or_zeros(mine.stresslets, strain_numbers));
    return f;
  }
  /// Arrays for this slab's parts of the motions, before take_back().
  PseVelocities parts(const PseVelocities &mine)
  {
    if (positions_.alone()) return mine;
    return {vectors_.parts(mine.linear), have_torques() ? turns_.parts(mine.angular) : nullptr,
            have_stresslets() ? tensors_.parts(mine.strain) : nullptr};
  }
  /// Collective.
  void take_back(const PseVelocities &mine)
  {
    if (positions_.alone()) return;
    vectors_.take_back(mine.linear);
    if (have_torques()) turns_.take_back(mine.angular);
    if (!have_stresslets()) return;
    if (!mine.strain) unread_.resize(strain_numbers * spheres_);
    tensors_.take_back(mine.strain ? mine.strain : unread_.data());
  }

  std::size_t memory() const
  {
    return positions_.memory() + vectors_.memory() + turns_.memory() + radii_.memory() +
           tensors_.memory() + bytes_of(zeros_, unread_);
  }

 private:
  bool have_torques() const { return moments_ != Moments::none; }
  bool have_stresslets() const { return moments_ == Moments::stresslet; }
  /// A rank may have no array where others have one, and all take part in the messages.
  const double *or_zeros(const double *values, int width)
  {
    if (values) return values;
    zeros_.resize(width * spheres_);
    zeros_.clear_values();
    return zeros_.data();
  }

  Moments moments_;
  long spheres_ = 0;
  DeviceSlabExchange<Exec> positions_, vectors_, turns_, radii_, tensors_;
  DeviceArray<double, Exec> zeros_;
  DeviceArray<double, Exec> unread_;    // strains that nobody asked for
};

}    // namespace bdh
#endif
