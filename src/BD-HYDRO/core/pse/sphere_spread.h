// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Spreading and interpolation of spheres of any radii, which may rotate and bear stress, on the
/// grids of one or two shape functions (pse/shapes_kernel.h).
#ifndef BDH_PSE_SPHERE_SPREAD_H
#define BDH_PSE_SPHERE_SPREAD_H

#include "pse/layout.h"
#include "pse/window_spread.h"

namespace bdh {

/// Numbers of a sphere.
constexpr int sphere_numbers(Moments moments)
{
  return moments == Moments::none ? quad : moments == Moments::torque ? 2 * quad : 4 * quad;
}

/// A sphere with force F, torque T and stresslet S gives the two fields
///
///     f_1 = c_t F w + c_r m,   f_2 = (1 - c_t) F w + (1 - c_r) m,   m = (grad w) x T/2 - S grad w
///
/// with w and its gradient at the points of the grid.  Interpolation is the adjoint: velocities of
/// both fields by w, and their gradient, W = v x (grad w)/2 and E = -sym (grad w) v.  A single
/// field has all of a sphere, whatever c.  The numbers of a sphere are a quad (F, c_t), with
/// moments followed by (T, c_r), with stresslets followed by two quads with the five numbers of S;
/// those of its motion are in the same places.
template <class Real> class SphereSpreader : public WindowSpreader<Real> {
 public:
  /// Gradients of the grid's coordinates, in spacings, along its axes [1/length].
  using Axes = std::array<std::array<double, 3>, 3>;

  using WindowSpreader<Real>::WindowSpreader;

  /// fields += those of all spheres.  C: the components of one field, whose spheres rotate, or of
  /// both.
  template <std::size_t C> void spread(const double *loads, Moments moments, const Axes &axes,
                                       const std::array<Real *, C> &fields) const;
  /// Sets the velocity, and with moments the angular velocity and rate of strain, of all spheres by
  /// this slab's part of the fields.  coefficients: loads, of which c_t and c_r are used.
  template <std::size_t C> void interpolate(const std::array<Real *, C> &fields, Moments moments,
                                            const Axes &axes, const double *coefficients,
                                            double *motions) const;

 private:
  template <int W> struct Loops;
};

}    // namespace bdh
#endif
