// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Spreading and interpolation of spheres of any radii, which may rotate and bear stress, on a
/// device: the counterpart of pse/sphere_spread.h.  By particle, with atomic additions to the grid.
#ifndef BDH_PSE_SPHERE_SPREAD_KOKKOS_H
#define BDH_PSE_SPHERE_SPREAD_KOKKOS_H

#include "pse/moment_kernel.h"
#include "pse/particles.h"
#include "pse/shapes_kernel.h"
#include "pse/window_spread_kokkos.h"

#include <type_traits>

namespace bdh {

/// One or two fields of dim components on the corners of a periodic grid, the window, and the
/// gradients of the grid's coordinates, in spacings [1/length].  A single field has all of a
/// sphere.
template <class Real> struct SphereWindow {
  DeviceWindow<Real> first;
  Real *second[dim];    ///< of two
  double axes[dim][dim];
  ShapeBasis basis;

  /// Component c of field g.
  BDH_FN Real *component(int g, int c) const { return g == 0 ? first.component[c] : second[c]; }
};

/// Weights of a particle along one axis, and their slopes in inverse spacings.
template <class Real, int W> struct WindowSlopes : WindowLines<Real, W> {
  Real slope[W];
  BDH_FN WindowSlopes(const DeviceWindow<Real> &g, double x) : WindowLines<Real, W>(g, x)
  {
    double t;
    first_window_line(x, W, t);
    for (int i = 0; i < W; ++i) slope[i] = window_slope_at(g.coefficient, W, g.degree, i, Real(t));
  }
};

/// fields += those of the spheres.  The index is (particle, plane under it), the last one fastest.
template <class Real, int W, Moments moments, int fields> struct SpreadSpheres {
  SphereWindow<Real> grid;
  const double *x, *radius, *force, *torque, *stresslet;    ///< the last two may be null

  /// along := what the moments have along each axis of the grid.
  BDH_FN void moments_along(long p, Real (&along)[dim][dim]) const
  {
    const bool strained = moments == Moments::stresslet && stresslet;
    for (int d = 0; d < dim; ++d) {
      double a[dim];
      moment_along(grid.axes[d], torque ? torque + dim * p : nullptr,
                   strained ? stresslet + strain_numbers * p : nullptr, a);
      for (int c = 0; c < dim; ++c) along[d][c] = a[c];
    }
  }
  BDH_FN void operator()(long index) const
  {
    const long p = index / W;
    const int k = index % W;
    const double a2 = radius[p] * radius[p], ct = grid.basis.coefficient(a2),
                 cr = grid.basis.coefficient(grid.basis.moment * a2);
    const WindowSlopes<Real, W> wx(grid.first, x[dim * p]), wy(grid.first, x[dim * p + 1]),
        wz(grid.first, x[dim * p + 2]);
    const long plane = grid.first.place_of_plane(wz.first + k);
    if (plane < 0) return;
    Real A[dim][dim] = {};
    if (moments != Moments::none) moments_along(p, A);
    for (int j = 0; j < W; ++j) {
      const long row = plane + wrap_line(wy.first + j, grid.first.n[1]) * grid.first.row;
      const Real w = wy.w[j] * wz.w[k], w_y = wy.slope[j] * wz.w[k], w_z = wy.w[j] * wz.slope[k];
      for (int c = 0; c < dim; ++c) {
        const Real shift = w * Real(force[dim * p + c]);
        // The gradient of the window on the grid is minus that with respect to the position.
        const Real turn_x = w * A[0][c], turn = w_y * A[1][c] + w_z * A[2][c];
        for (int i = 0; i < W; ++i) {
          const long at = row + wrap_line(wx.first + i, grid.first.n[0]);
          const Real t = shift * wx.w[i], r = turn_x * wx.slope[i] + turn * wx.w[i];
          const Real one = fields == 1 ? t + r : Real(ct) * t + Real(cr) * r;
          Kokkos::atomic_add(grid.first.component[c] + at, one);
          if (fields == 1) continue;
          Kokkos::atomic_add(grid.second[c] + at, Real(1.0 - ct) * t + Real(1.0 - cr) * r);
        }
      }
    }
  }
};

/// Velocities, and with moments angular velocities and rates of strain, := the adjoint of
/// spreading.  The index is that of a particle.
template <class Real, int W, Moments moments, int fields> struct GatherSpheres {
  SphereWindow<Real> grid;
  const double *x, *radius;
  PseVelocities velocity;
  BDH_FN void operator()(long p) const
  {
    const double a2 = radius[p] * radius[p], ct = grid.basis.coefficient(a2),
                 cr = grid.basis.coefficient(grid.basis.moment * a2);
    const WindowSlopes<Real, W> wx(grid.first, x[dim * p]), wy(grid.first, x[dim * p + 1]),
        wz(grid.first, x[dim * p + 2]);
    Real shift[dim] = {}, turn[dim][dim] = {};
    for (int k = 0; k < W; ++k) {
      const long plane = grid.first.place_of_plane(wz.first + k);
      if (plane < 0) continue;
      for (int j = 0; j < W; ++j) {
        const long row = plane + wrap_line(wy.first + j, grid.first.n[1]) * grid.first.row;
        const Real w = wy.w[j] * wz.w[k], w_y = wy.slope[j] * wz.w[k], w_z = wy.w[j] * wz.slope[k];
        for (int c = 0; c < dim; ++c) {
          Real moved = 0, turned = 0, turned_x = 0;
          for (int i = 0; i < W; ++i) {
            const long at = row + wrap_line(wx.first + i, grid.first.n[0]);
            const Real one = grid.first.component[c][at],
                       two = fields == 1 ? one : grid.second[c][at];
            moved += wx.w[i] * (fields == 1 ? one : Real(ct) * one + Real(1.0 - ct) * two);
            if (moments == Moments::none) continue;
            const Real v = fields == 1 ? one : Real(cr) * one + Real(1.0 - cr) * two;
            turned += wx.w[i] * v;
            turned_x += wx.slope[i] * v;
          }
          shift[c] += w * moved;
          turn[0][c] += w * turned_x;
          turn[1][c] += w_y * turned;
          turn[2][c] += w_z * turned;
        }
      }
    }
    for (int c = 0; c < dim; ++c) velocity.linear[dim * p + c] = shift[c];
    if (moments == Moments::none) return;
    double slope[dim][dim];
    for (int d = 0; d < dim; ++d)
      for (int c = 0; c < dim; ++c) slope[d][c] = turn[d][c];
    motions_of(slope, grid.axes, velocity.angular + dim * p,
               moments == Moments::stresslet && velocity.strain
                   ? velocity.strain + strain_numbers * p
                   : nullptr);
  }
};

/// Both ways for spheres of one radius that translate, and for any others.
template <class Real, class Exec> class DeviceSphereSpreader
    : public DeviceWindowSpreader<Real, Exec> {
 public:
  using DeviceWindowSpreader<Real, Exec>::DeviceWindowSpreader;
  using DeviceWindowSpreader<Real, Exec>::window;

  /// fields += those of the spheres.  One field is for spheres with torques.
  template <int fields> void spread_spheres(const SphereWindow<Real> &grid, const double *radius,
                                            Moments moments, const PseForces &forces)
  {
    with_kind<fields>(moments, [&](auto width, auto kind) {
      constexpr int W = decltype(width)::value;
      device_for<Exec>(
          "bdh::spread_spheres", this->particles_ * W,
          SpreadSpheres<Real, W, decltype(kind)::value, fields>{
              grid, this->x_.data(), radius, forces.values, forces.torques, forces.stresslets});
    });
  }
  template <int fields> void interpolate_spheres(const SphereWindow<Real> &grid,
                                                 const double *radius, Moments moments,
                                                 const PseVelocities &velocity) const
  {
    with_kind<fields>(moments, [&](auto width, auto kind) {
      device_for<Exec>("bdh::interpolate_spheres", this->particles_,
                       GatherSpheres<Real, decltype(width)::value, decltype(kind)::value, fields>{
                           grid, this->x_.data(), radius, velocity});
    });
  }

 private:
  template <Moments moments> using Kind = std::integral_constant<Moments, moments>;

  /// Calls action(the window's width, the moments) with constants of the compiler.
  template <int fields, class Action> void with_kind(Moments moments, const Action &action) const
  {
    this->dispatch([&](auto width) {
      if constexpr (fields == 1) {
        action(width, Kind<Moments::torque>());
      } else {
        if (moments == Moments::none) action(width, Kind<Moments::none>());
        if (moments == Moments::torque) action(width, Kind<Moments::torque>());
        if (moments == Moments::stresslet) action(width, Kind<Moments::stresslet>());
      }
    });
  }
};

}    // namespace bdh
#endif
