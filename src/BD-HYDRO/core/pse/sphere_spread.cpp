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

  /// The grid points under a sphere, with weights and slopes of its lines.
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
  };

  /// A row of a component, at the columns under the sphere.  whole: they follow each other.
  template <bool whole> static Lanes load(const Stencil<Real, W> &s, const Real *row)
  {
    if constexpr (whole) return Lanes::at(row + s.columns[0]);
    Real v[Lanes::lanes] = {};
    for (int i = 0; i < W; ++i) v[i] = row[s.columns[i]];
    return Lanes::at(v);
  }
  template <bool whole> static void add(const Stencil<Real, W> &s, const Lanes &more, Real *row)
  {
    if constexpr (whole) {
      Lanes v = Lanes::at(row + s.columns[0]);
      v.v += more.v;
      v.store(row + s.columns[0]);
    } else {
      for (int i = 0; i < W; ++i) row[s.columns[i]] += more.v[i];
    }
  }

  template <std::size_t C, class Action>
  static void for_spheres(const SphereSpreader &me, const std::array<Real *, C> &fields,
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

  /// What a sphere brings to one field: a vector, and by axis what goes with the slopes.
  struct Load {
    Real vector[3], slope[3][3];
  };

  /// The sum over planes and rows is nested: what a plane gives to its rows is one vector for their
  /// weights and one for their slopes.
  template <bool rotation, bool whole>
  static void add_to_field(const Point &at, const Load &load, Real *const *field)
  {
    Lanes line[3];
    for (int c = 0; c < 3; ++c) {
      line[c].v = load.vector[c] * at.s.wx.v;
      if constexpr (rotation) line[c].v += load.slope[0][c] * at.slope_x.v;
    }
    // Planes are many instructions each: unrolled, they leave the instruction cache.
#pragma GCC unroll 1
    for (int k = 0; k < W; ++k) {
      if (at.s.planes[k] < 0) continue;
      Lanes plain[3], slope[3];
      for (int c = 0; c < 3; ++c) {
        plain[c].v = at.wz[k] * line[c].v;
        if constexpr (!rotation) continue;
        plain[c].v += (at.dz[k] * load.slope[2][c]) * at.s.wx.v;
        slope[c].v = (at.wz[k] * load.slope[1][c]) * at.s.wx.v;
      }
      for (int j = 0; j < W; ++j)
        for (int c = 0; c < 3; ++c) {
          Lanes v;
          v.v = at.wy[j] * plain[c].v;
          if constexpr (rotation) v.v += at.dy[j] * slope[c].v;
          add<whole>(at.s, v, field[c] + at.s.planes[k] + at.s.rows[j]);
        }
    }
  }

  /// The gradient of the window on the grid is minus that with respect to the position of the
  /// sphere.
  template <Moments moments, std::size_t C>
  static void spread(const SphereSpreader &me, const double *loads, const Axes &axes,
                     const std::array<Real *, C> &fields)
  {
    constexpr int size = sphere_numbers(moments);
    constexpr bool gradients = moments != Moments::none;
    for_spheres(me, fields, FieldAccess::writes, [&](long i, const Point &at) {
      const double *F = loads + size * i, *T = F + quad;
      const double *S = moments == Moments::stresslet ? T + quad : nullptr;
      double along[3][3] = {};
      if constexpr (gradients)
        for (int d = 0; d < 3; ++d) moment_along(axes[d].data(), T, S, along[d]);
      for (std::size_t g = 0; g < C / 3; ++g) {
        const double force = share<C>(F[dim], g), moment = gradients ? share<C>(T[dim], g) : 0.0;
        Load load;
        for (int c = 0; c < 3; ++c) {
          load.vector[c] = force * F[c];
          for (int d = 0; d < 3; ++d) load.slope[d][c] = moment * along[d][c];
        }
        Real *const *const field = fields.data() + 3 * g;
        if (gradients && moment != 0.0)
          at.s.whole ? add_to_field<gradients, true>(at, load, field)
                     : add_to_field<gradients, false>(at, load, field);
        else
          at.s.whole ? add_to_field<false, true>(at, load, field)
                     : add_to_field<false, false>(at, load, field);
      }
    });
  }

  /// The share of field g in a load or motion with the coefficient c; a single field has it all.
  template <std::size_t C> static double share(double c, std::size_t g)
  {
    return C == 3 ? 1.0 : g == 0 ? c : 1.0 - c;
  }

  static Real dot(const Lanes &a, const Lanes &b)
  {
    Real sum = 0;
    for (int i = 0; i < W; ++i) sum += a.v[i] * b.v[i];
    return sum;
  }

  /// Sums over planes and rows of the components of a field: with weights, with the slopes along y,
  /// and with those along z.
  struct Sums {
    Lanes plain[3] = {}, slope_y[3] = {}, slope_z[3] = {};
  };

  template <bool rotation, bool whole>
  static Sums sum_of_field(const Point &at, const Real *const *field)
  {
    Sums sums;
#pragma GCC unroll 1
    for (int k = 0; k < W; ++k) {
      if (at.s.planes[k] < 0) continue;
      Lanes plain[3] = {}, slope[3] = {};
      for (int j = 0; j < W; ++j)
        for (int c = 0; c < 3; ++c) {
          const Lanes v = load<whole>(at.s, field[c] + at.s.planes[k] + at.s.rows[j]);
          plain[c].v += at.wy[j] * v.v;
          if constexpr (rotation) slope[c].v += at.dy[j] * v.v;
        }
      for (int c = 0; c < 3; ++c) {
        sums.plain[c].v += at.wz[k] * plain[c].v;
        if constexpr (!rotation) continue;
        sums.slope_y[c].v += at.wz[k] * slope[c].v;
        sums.slope_z[c].v += at.dz[k] * plain[c].v;
      }
    }
    return sums;
  }

  template <Moments moments, std::size_t C>
  static void interpolate(const SphereSpreader &me, const std::array<Real *, C> &fields,
                          const Axes &axes, const double *coefficients, double *motions)
  {
    constexpr int size = sphere_numbers(moments);
    constexpr bool gradients = moments != Moments::none;
    for_spheres(me, fields, FieldAccess::reads, [&](long i, const Point &at) {
      const double *own = coefficients + size * i;
      Lanes shift[3] = {};
      Sums turn;
      for (std::size_t g = 0; g < C / 3; ++g) {
        const Real *const *const field = fields.data() + 3 * g;
        const Real force = share<C>(own[dim], g),
                   moment = gradients ? share<C>(own[2 * quad - 1], g) : 0.0;
        const Sums sums = gradients && moment != Real(0)
                              ? (at.s.whole ? sum_of_field<gradients, true>(at, field)
                                            : sum_of_field<gradients, false>(at, field))
                              : (at.s.whole ? sum_of_field<false, true>(at, field)
                                            : sum_of_field<false, false>(at, field));
        for (int c = 0; c < 3; ++c) {
          shift[c].v += force * sums.plain[c].v;
          if constexpr (!gradients) continue;
          turn.plain[c].v += moment * sums.plain[c].v;
          turn.slope_y[c].v += moment * sums.slope_y[c].v;
          turn.slope_z[c].v += moment * sums.slope_z[c].v;
        }
      }
      double *motion = motions + size * i;
      for (int c = 0; c < 3; ++c) motion[c] = dot(shift[c], at.s.wx);
      motion[dim] = 0.0;
      if constexpr (gradients) {
        for (int c = quad; c < size; ++c) motion[c] = 0.0;
        const Lanes *const sums[3] = {turn.plain, turn.slope_y, turn.slope_z};
        double slope[3][3];
        for (int d = 0; d < 3; ++d)
          for (int c = 0; c < 3; ++c) slope[d][c] = dot(sums[d][c], d == 0 ? at.slope_x : at.s.wx);
        motions_of(slope, axes, motion + quad,
                   moments == Moments::stresslet ? motion + 2 * quad : nullptr);
      }
    });
  }
};

template <class Real> template <std::size_t C, class Action>
void SphereSpreader<Real>::with_kind(Moments moments, const Action &action) const
{
  with_window_width(this->window_.width(), [&](auto width) {
    using L = Loops<decltype(width)::value>;
    const auto act = [&](auto kind) { action(L(), kind); };
    switch (moments) {
    case Moments::none:
      return act(std::integral_constant < Moments, C == 3 ? Moments::torque : Moments::none > ());
    case Moments::torque: return act(std::integral_constant<Moments, Moments::torque>());
    case Moments::stresslet: return act(std::integral_constant<Moments, Moments::stresslet>());
    }
    throw std::logic_error("unknown moments of spheres");
  });
}

template <class Real> template <std::size_t C>
void SphereSpreader<Real>::spread(const double *loads, Moments moments, const Axes &axes,
                                  const std::array<Real *, C> &fields) const
{
  with_kind<C>(moments, [&](auto loops, auto kind) {
    decltype(loops)::template spread<decltype(kind)::value>(*this, loads, axes, fields);
  });
}

template <class Real> template <std::size_t C>
void SphereSpreader<Real>::interpolate(const std::array<Real *, C> &fields, Moments moments,
                                       const Axes &axes, const double *coefficients,
                                       double *motions) const
{
  with_kind<C>(moments, [&](auto loops, auto kind) {
    decltype(loops)::template interpolate<decltype(kind)::value>(*this, fields, axes, coefficients,
                                                                 motions);
  });
}

#define BDH_FIELDS(Real, components)                                                               \
  template void SphereSpreader<Real>::spread(const double *, Moments, const Axes &,                \
                                             const std::array<Real *, components> &) const;        \
  template void SphereSpreader<Real>::interpolate(const std::array<Real *, components> &, Moments, \
                                                  const Axes &, const double *, double *) const;
BDH_FIELDS(float, 3)
BDH_FIELDS(float, 6)
BDH_FIELDS(double, 3)
BDH_FIELDS(double, 6)

template class SphereSpreader<float>;
template class SphereSpreader<double>;

}    // namespace bdh
