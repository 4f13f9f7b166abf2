// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/sphere_spread.h"

#include "grid/stencil.h"
#include "pse/moment_kernel.h"
#include "pse/window_choice.h"
#include "pse/window_weights.h"

#include <stdexcept>
#include <type_traits>

namespace bdh {

/// The loops, compiled once per width.
template <class Real> template <int W> struct SphereSpreader<Real>::Loops {
  using Lanes = Columns<Real, W>;

  struct Work {
    WindowWeights<Real, W> axis[3];
    alignas(64) BatchWeights<Real, W> slope[3];
  };

  /// The grid points under a sphere, with the weights of one row and plane.
  struct Point {
    Stencil<Real, W> s;
    Lanes slope_x;
    Real wy[W], wz[W], dy[W], dz[W];

    Point(const Work &work, int p, const GridLines &lines) :
        s(window_stencil(work.axis, p, lines)), slope_x{}
    {
      for (int i = 0; i < W; ++i) {
        slope_x.v[i] = work.slope[0][i][p];
        wy[i] = work.axis[1].weight[i][p];
        wz[i] = work.axis[2].weight[i][p];
        dy[i] = work.slope[1][i][p];
        dz[i] = work.slope[2][i][p];
      }
    }
    /// Calls action(offset of a row, weight, weight with the slope along y, along z).
    template <class Action> void for_rows(const Action &action) const
    {
      for (int k = 0; k < W; ++k) {
        if (s.planes[k] < 0) continue;
        for (int j = 0; j < W; ++j)
          action(s.planes[k] + s.rows[j], wy[j] * wz[k], dy[j] * wz[k], wy[j] * dz[k]);
      }
    }
  };

  /// A row of a component, at the columns under the sphere.
  static Lanes load(const Stencil<Real, W> &s, const Real *row)
  {
    if (s.whole) return Lanes::at(row + s.columns[0]);
    Lanes v{};
    for (int i = 0; i < W; ++i) v.v[i] = row[s.columns[i]];
    return v;
  }
  static void add(const Stencil<Real, W> &s, const Lanes &more, Real *row)
  {
    if (s.whole) {
      Lanes v = Lanes::at(row + s.columns[0]);
      v.v += more.v;
      v.store(row + s.columns[0]);
    } else {
      for (int i = 0; i < W; ++i) row[s.columns[i]] += more.v[i];
    }
  }

  template <class Action> static void for_spheres(const SphereSpreader &me, const Fields &fields,
                                                  FieldAccess access, Action action)
  {
    for_batches<Work>(me.particles_, fields, access, [&](Work &work, long begin, int count) {
      for (int d = 0; d < 3; ++d)
        work.axis[d].compute(me.particles_.x(d) + begin, me.coefficient_.data(),
                             me.window_.degree(), work.slope[d]);
      for (int p = 0; p < count; ++p)
        action(me.particles_.original(begin + p), Point(work, p, me.particles_.lines()));
    });
  }

  /// The gradient of the window on the grid is minus that with respect to the position of the
  /// sphere.
  template <Moments moments> static void spread(const SphereSpreader &me, const double *loads,
                                                const Axes &axes, const Fields &fields)
  {
    constexpr int size = sphere_numbers(moments);
    constexpr bool has_moments = moments != Moments::none;
    for_spheres(me, fields, FieldAccess::writes, [&](long i, const Point &at) {
      const double *load = loads + size * i, *F = load;
      const Real ct[2] = {Real(load[dim]), Real(1.0 - load[dim])};
      Real A[3][3] = {}, cr[2] = {};
      if constexpr (has_moments) {
        const double *T = load + quad;
        cr[0] = T[dim];
        cr[1] = 1.0 - T[dim];
        const double *S = moments == Moments::stresslet ? load + 2 * quad : nullptr;
        for (int d = 0; d < 3; ++d) {
          double a[3];
          moment_along(axes[d].data(), T, S, a);
          for (int c = 0; c < 3; ++c) A[d][c] = a[c];
        }
      }
      for (int g = 0; g < 2; ++g) {
        Lanes line[3];
        Real along_y[3], along_z[3];
        for (int c = 0; c < 3; ++c) {
          line[c].v = (ct[g] * Real(F[c])) * at.s.wx.v;
          if constexpr (has_moments) line[c].v += (cr[g] * A[0][c]) * at.slope_x.v;
          along_y[c] = cr[g] * A[1][c];
          along_z[c] = cr[g] * A[2][c];
        }
        at.for_rows([&](long row, Real w, Real wy, Real wz) {
          for (int c = 0; c < 3; ++c) {
            Lanes v;
            v.v = w * line[c].v;
            if constexpr (has_moments) v.v += (wy * along_y[c] + wz * along_z[c]) * at.s.wx.v;
            add(at.s, v, fields[3 * g + c] + row);
          }
        });
      }
    });
  }

  static Real dot(const Lanes &a, const Lanes &b)
  {
    Real sum = 0;
    for (int i = 0; i < W; ++i) sum += a.v[i] * b.v[i];
    return sum;
  }

  template <Moments moments> static void interpolate(const SphereSpreader &me, const Fields &fields,
                                                     const Axes &axes, const double *coefficients,
                                                     double *motions)
  {
    constexpr int size = sphere_numbers(moments);
    constexpr bool has_moments = moments != Moments::none;
    for_spheres(me, fields, FieldAccess::reads, [&](long i, const Point &at) {
      const double *own = coefficients + size * i;
      const Real ct[2] = {Real(own[dim]), Real(1.0 - own[dim])};
      Real cr[2] = {};
      if constexpr (has_moments) {
        cr[0] = own[quad + dim];
        cr[1] = 1.0 - own[quad + dim];
      }
      Lanes shift[3] = {}, turn[3] = {}, turn_y[3] = {}, turn_z[3] = {};
      at.for_rows([&](long row, Real w, Real wy, Real wz) {
        for (int c = 0; c < 3; ++c) {
          const Lanes one = load(at.s, fields[c] + row), two = load(at.s, fields[3 + c] + row);
          shift[c].v += w * (ct[0] * one.v + ct[1] * two.v);
          if constexpr (has_moments) {
            const auto v = cr[0] * one.v + cr[1] * two.v;
            turn[c].v += w * v;
            turn_y[c].v += wy * v;
            turn_z[c].v += wz * v;
          }
        }
      });
      double *motion = motions + size * i;
      for (int c = 0; c < 3; ++c) motion[c] = dot(shift[c], at.s.wx);
      motion[dim] = 0.0;
      if constexpr (has_moments) {
        const Lanes *const sums[3] = {turn, turn_y, turn_z};
        double slope[3][3];
        for (int d = 0; d < 3; ++d)
          for (int c = 0; c < 3; ++c) slope[d][c] = dot(sums[d][c], d == 0 ? at.slope_x : at.s.wx);
        for (int c = quad; c < size; ++c) motion[c] = 0.0;
        motions_of(slope, axes, motion + quad,
                   moments == Moments::stresslet ? motion + 2 * quad : nullptr);
      }
    });
  }
};

template <class Real> template <class Action>
void SphereSpreader<Real>::with_kind(Moments moments, const Action &action) const
{
  with_window_width(this->window_.width(), [&](auto width) {
    using L = Loops<decltype(width)::value>;
    switch (moments) {
    case Moments::none: return action(L(), std::integral_constant<Moments, Moments::none>());
    case Moments::torque: return action(L(), std::integral_constant<Moments, Moments::torque>());
    case Moments::stresslet:
      return action(L(), std::integral_constant<Moments, Moments::stresslet>());
    }
    throw std::logic_error("unknown moments of spheres");
  });
}

template <class Real> void SphereSpreader<Real>::spread(const double *loads, Moments moments,
                                                        const Axes &axes,
                                                        const Fields &fields) const
{
  with_kind(moments, [&](auto loops, auto kind) {
    decltype(loops)::template spread<decltype(kind)::value>(*this, loads, axes, fields);
  });
}

template <class Real>
void SphereSpreader<Real>::interpolate(const Fields &fields, Moments moments, const Axes &axes,
                                       const double *coefficients, double *motions) const
{
  with_kind(moments, [&](auto loops, auto kind) {
    decltype(loops)::template interpolate<decltype(kind)::value>(*this, fields, axes, coefficients,
                                                                 motions);
  });
}

template class SphereSpreader<float>;
template class SphereSpreader<double>;

}    // namespace bdh
