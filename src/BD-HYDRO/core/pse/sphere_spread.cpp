// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/sphere_spread.h"

#include "grid/stencil.h"
#include "pse/moment_kernel.h"
#include "pse/window_choice.h"
#include "pse/window_weights.h"

#include <algorithm>

namespace bdh {

namespace {

/// What a sphere brings to one field, or takes from there: a vector, and by axis what goes with the
/// slopes of the window.
template <class Real> struct FieldLoad {
  Real vector[3], slope[3][3];
  bool turns = true, acts = true;    // false: the slopes are zero, everything is
};

/// The shares of the fields in a load or motion with the coefficient c; a single field has it all.
template <class Real, std::size_t C> struct Shares {
  static constexpr std::size_t fields = C / 3;
  Real of[fields];

  explicit Shares(double c)
  {
    of[0] = fields == 1 ? 1.0 : c;
    if constexpr (fields == 2) of[1] = 1.0 - c;
  }
};

/// shares := what a sphere with these numbers brings to each of the fields.
template <class Real, std::size_t C, class Axes> void share_load(const double *numbers,
                                                                 Moments moments, const Axes &axes,
                                                                 FieldLoad<Real> (&shares)[C / 3])
{
  const double *F = numbers, *T = moments == Moments::none ? nullptr : F + quad;
  const double *S = moments == Moments::stresslet ? T + quad : nullptr;
  double along[3][3];
  for (int d = 0; d < 3; ++d) moment_along(axes[d].data(), T, S, along[d]);
  const Shares<double, C> force(F[dim]), moment(T ? T[dim] : 0.0);
  for (std::size_t g = 0; g < C / 3; ++g) {
    shares[g].turns = moment.of[g] != 0.0;
    shares[g].acts = shares[g].turns || force.of[g] != 0.0;
    for (int c = 0; c < 3; ++c) {
      shares[g].vector[c] = force.of[g] * F[c];
      for (int d = 0; d < 3; ++d) shares[g].slope[d][c] = moment.of[g] * along[d][c];
    }
  }
}

/// motion := that of a sphere, with zeros where its numbers are filled up.
template <class Real, class Axes>
void set_motion(const FieldLoad<Real> &sum, Moments moments, const Axes &axes, double *motion)
{
  for (int c = 0; c < dim; ++c) motion[c] = sum.vector[c];
  motion[dim] = 0.0;
  if (moments == Moments::none) return;
  double slope[3][3];
  for (int d = 0; d < 3; ++d)
    for (int c = 0; c < 3; ++c) slope[d][c] = sum.slope[d][c];
  motion[2 * quad - 1] = 0.0;
  double *const strain = moments == Moments::stresslet ? motion + 2 * quad : nullptr;
  if (strain) std::fill_n(strain, 2 * quad, 0.0);
  motions_of(slope, axes, motion + quad, strain);
}

}    // namespace

/// The loops, compiled once per width.  What they do for one sphere are functions of their own
/// (noinline), so that these are compiled once for any number of fields and kind of moments.
template <class Real> template <int W> struct SphereSpreader<Real>::Loops {
  using Lanes = Columns<Real, W>;

  struct Work {
    WindowWeights<Real, W> axis[3];
    alignas(64) BatchWeights<Real, W> slope[3];
  };

  /// The grid points under a sphere, with weights and slopes of its lines.
  ///
  /// The columns are a vector of a row, or both parts of one that would run over its end.
  struct Point {
    Stencil<Real, W> s;
    Lanes wx, slope_x;
    Real wy[W], wz[W], dy[W] = {}, dz[W] = {};
    long column;    // the first of the vector
    int parts;      // as column_parts()

    [[gnu::always_inline]] Point(const Work &work, int p, const GridLines &lines, bool gradients) :
        s(window_stencil(work.axis, p, lines)), wx{}, slope_x{}, column(s.columns[0]), parts(1)
    {
      for (int i = 0; i < W; ++i) {
        wx.set(i, work.axis[0].weight[i][p]);
        wy[i] = work.axis[1].weight[i][p];
        wz[i] = work.axis[2].weight[i][p];
        if (!gradients) continue;
        slope_x.set(i, work.slope[0][i][p]);
        dy[i] = work.slope[1][i][p];
        dz[i] = work.slope[2][i][p];
      }
      if (!s.whole) parts = column_parts(s);
    }
    /// Goes to a part of the columns of a sphere that is not whole.
    [[gnu::noinline]] void take(int part, const Work &work, int p, bool gradients)
    {
      const ColumnPart here(part, s.columns[0], s.row_columns, W, Lanes::lanes);
      column = here.column;
      Real weight[Lanes::lanes] = {}, slope[Lanes::lanes] = {};
      for (int i = here.begin; i < here.end; ++i) {
        weight[here.lane + i - here.begin] = work.axis[0].weight[i][p];
        if (gradients) slope[here.lane + i - here.begin] = work.slope[0][i][p];
      }
      wx = Lanes::at(weight);
      slope_x = Lanes::at(slope);
    }
  };

  /// Calls action(place, weight, its three slopes) for every point under a sphere.  Without
  /// moments the slopes are zero.
  template <class Action>
  static void for_points(const Work &work, int p, const Point &at, const Action &action)
  {
#pragma GCC unroll 1
    for (int k = 0; k < W; ++k) {
      if (at.s.planes[k] < 0) continue;
#pragma GCC unroll 1
      for (int j = 0; j < W; ++j)
#pragma GCC unroll 1
        for (int i = 0; i < W; ++i) {
          const Real wx = work.axis[0].weight[i][p];
          const Real dw[3] = {at.slope_x[i] * at.wy[j] * at.wz[k], wx * at.dy[j] * at.wz[k],
                              wx * at.wy[j] * at.dz[k]};
          action(at.s.planes[k] + at.s.rows[j] + at.s.columns[i], wx * at.wy[j] * at.wz[k], dw);
        }
    }
  }

  /// Calls action(place in the caller's arrays, work, place in the batch) for every sphere.
  /// gradients: slopes are needed.
  template <std::size_t C, class Action>
  static void for_spheres(const SphereSpreader &me, const std::array<Real *, C> &fields,
                          bool gradients, FieldAccess access, Action action)
  {
    const Real *const coefficient = me.coefficient_.data();
    const int degree = me.window_.degree();
    for_batches<Work>(me.particles_, fields, access, [&](Work &work, long begin, int count) {
      for (int d = 0; d < 3; ++d)
        if (gradients)
          work.axis[d].compute(me.particles_.x(d) + begin, coefficient, degree, work.slope[d]);
        else
          work.axis[d].compute(me.particles_.x(d) + begin, coefficient, degree);
      for (int p = 0; p < count; ++p) action(me.particles_.original(begin + p), work, p);
    });
  }

  /// The sum over planes and rows is nested: what a plane gives to its rows is one vector for their
  /// weights and one for their slopes.
  template <bool rotation> [[gnu::always_inline]] static void
  add_to_field(const Point &at, const FieldLoad<Real> &load, Real *const *field)
  {
    Lanes line[3];
    for (int c = 0; c < 3; ++c) {
      line[c] = load.vector[c] * at.wx;
      if constexpr (rotation) line[c] += load.slope[0][c] * at.slope_x;
    }
    // Planes are many instructions each: unrolled, they leave the instruction cache.
#pragma GCC unroll 1
    for (int k = 0; k < W; ++k) {
      if (at.s.planes[k] < 0) continue;
      Lanes plain[3], slope[3];
      for (int c = 0; c < 3; ++c) {
        plain[c] = at.wz[k] * line[c];
        if constexpr (!rotation) continue;
        plain[c] += (at.dz[k] * load.slope[2][c]) * at.wx;
        slope[c] = (at.wz[k] * load.slope[1][c]) * at.wx;
      }
      for (int j = 0; j < W; ++j)
        for (int c = 0; c < 3; ++c) {
          Real *const to = field[c] + at.s.planes[k] + at.s.rows[j] + at.column;
          Lanes v = Lanes::at(to);
          v += at.wy[j] * plain[c];
          if constexpr (rotation) v += at.dy[j] * slope[c];
          v.store(to);
        }
    }
  }
  /// The same one by one, where the columns are no vector.
  [[gnu::noinline]] static void add_one_by_one(const Work &work, int p, const Point &at,
                                               const FieldLoad<Real> &load, Real *const *field)
  {
    for_points(work, p, at, [&](long place, Real w, const Real *dw) {
      for (int c = 0; c < 3; ++c)
        field[c][place] += load.vector[c] * w + load.slope[0][c] * dw[0] +
                           load.slope[1][c] * dw[1] + load.slope[2][c] * dw[2];
    });
  }
  template <bool rotation> [[gnu::always_inline]] static void
  add_to_fields(const Point &at, const FieldLoad<Real> *loads, Real *const *field, int fields)
  {
    for (int g = 0; g < fields; ++g, field += 3)
      if (rotation && loads[g].turns)
        add_to_field<rotation>(at, loads[g], field);
      else if (loads[g].acts)
        add_to_field<false>(at, loads[g], field);
  }
  /// loads: of each of the fields, which are 3 components each.
  template <bool rotation> [[gnu::noinline]] static void add_sphere(const Work &work, int p,
                                                                    const GridLines &lines,
                                                                    const FieldLoad<Real> *loads,
                                                                    Real *const *field, int fields)
  {
    Point at(work, p, lines, rotation);
    for (int part = 0; part < at.parts; ++part) {
      if (!at.s.whole) at.take(part, work, p, rotation);
      add_to_fields<rotation>(at, loads, field, fields);
    }
    if (at.parts == 0)
      for (int g = 0; g < fields; ++g) add_one_by_one(work, p, at, loads[g], field + 3 * g);
  }

  /// The gradient of the window on the grid is minus that with respect to the position of the
  /// sphere.
  template <std::size_t C> static void spread(const SphereSpreader &me, const double *loads,
                                              Moments moments, const Axes &axes,
                                              const std::array<Real *, C> &fields)
  {
    const int size = sphere_numbers(moments);
    const bool gradients = moments != Moments::none;
    for_spheres(me, fields, gradients, FieldAccess::writes, [&](long i, const Work &work, int p) {
      FieldLoad<Real> shares[C / 3];
      share_load<Real, C>(loads + size * i, moments, axes, shares);
      (gradients ? add_sphere<true> : add_sphere<false>) (work, p, me.particles_.lines(), shares,
                                                          fields.data(), C / 3);
    });
  }

  /// Sums over planes and rows of the components of a field: with weights, with the slopes along y,
  /// and with those along z.
  struct Sums {
    Lanes plain[3] = {}, slope_y[3] = {}, slope_z[3] = {};
  };

  template <bool rotation>
  [[gnu::always_inline]] static Sums sum_of_rows(const Point &at, const Real *const *field)
  {
    Sums sums;
#pragma GCC unroll 1
    for (int k = 0; k < W; ++k) {
      if (at.s.planes[k] < 0) continue;
      Lanes plain[3] = {}, slope[3] = {};
      for (int j = 0; j < W; ++j)
        for (int c = 0; c < 3; ++c) {
          const Lanes v = Lanes::at(field[c] + at.s.planes[k] + at.s.rows[j] + at.column);
          plain[c] += at.wy[j] * v;
          if constexpr (rotation) slope[c] += at.dy[j] * v;
        }
      for (int c = 0; c < 3; ++c) {
        sums.plain[c] += at.wz[k] * plain[c];
        if constexpr (!rotation) continue;
        sums.slope_y[c] += at.wz[k] * slope[c];
        sums.slope_z[c] += at.dz[k] * plain[c];
      }
    }
    return sums;
  }
  /// sum += what the columns of a point give.  force, moment: the shares of each of the fields in
  /// the motion; without any of the moment there is no need for slopes.
  template <bool rotation>
  [[gnu::always_inline]] static void add_sums(const Point &at, const Real *force,
                                              const Real *moment, const Real *const *field,
                                              int fields, FieldLoad<Real> &sum)
  {
    Lanes shift[3] = {};
    Sums turn;
    for (int g = 0; g < fields; ++g, field += 3) {
      const bool turns = rotation && moment[g] != Real(0);
      if (!turns && force[g] == Real(0)) continue;
      const Sums sums = turns ? sum_of_rows<rotation>(at, field) : sum_of_rows<false>(at, field);
      for (int c = 0; c < 3; ++c) {
        shift[c] += force[g] * sums.plain[c];
        if constexpr (!rotation) continue;
        turn.plain[c] += moment[g] * sums.plain[c];
        turn.slope_y[c] += moment[g] * sums.slope_y[c];
        turn.slope_z[c] += moment[g] * sums.slope_z[c];
      }
    }
    for (int c = 0; c < 3; ++c) {
      sum.vector[c] += dot(shift[c], at.wx);
      if constexpr (!rotation) continue;
      sum.slope[0][c] += dot(turn.plain[c], at.slope_x);
      sum.slope[1][c] += dot(turn.slope_y[c], at.wx);
      sum.slope[2][c] += dot(turn.slope_z[c], at.wx);
    }
  }
  /// The same one by one.
  [[gnu::noinline]] static void add_sums_one_by_one(const Work &work, int p, const Point &at,
                                                    Real force, Real moment,
                                                    const Real *const *field, FieldLoad<Real> &sum)
  {
    for_points(work, p, at, [&](long place, Real w, const Real *dw) {
      for (int c = 0; c < 3; ++c) {
        const Real v = field[c][place];
        sum.vector[c] += force * w * v;
        for (int d = 0; d < 3; ++d) sum.slope[d][c] += moment * dw[d] * v;
      }
    });
  }
  template <bool rotation> [[gnu::noinline]] static FieldLoad<Real>
  sum_of_sphere(const Work &work, int p, const GridLines &lines, const Real *force,
                const Real *moment, const Real *const *field, int fields)
  {
    Point at(work, p, lines, rotation);
    FieldLoad<Real> sum{};
    for (int part = 0; part < at.parts; ++part) {
      if (!at.s.whole) at.take(part, work, p, rotation);
      add_sums<rotation>(at, force, moment, field, fields, sum);
    }
    if (at.parts == 0)
      for (int g = 0; g < fields; ++g)
        add_sums_one_by_one(work, p, at, force[g], moment[g], field + 3 * g, sum);
    return sum;
  }

  template <std::size_t C> static void interpolate(const SphereSpreader &me,
                                                   const std::array<Real *, C> &fields,
                                                   Moments moments, const Axes &axes,
                                                   const double *coefficients, double *motions)
  {
    const int size = sphere_numbers(moments);
    const bool gradients = moments != Moments::none;
    for_spheres(me, fields, gradients, FieldAccess::reads, [&](long i, const Work &work, int p) {
      const double *own = coefficients + size * i;
      const Shares<Real, C> force(own[dim]), moment(gradients ? own[2 * quad - 1] : 0.0);
      const FieldLoad<Real> sum =
          (gradients ? sum_of_sphere<true> : sum_of_sphere<false>) (work, p, me.particles_.lines(),
                                                                    force.of, moment.of,
                                                                    fields.data(), C / 3);
      set_motion(sum, moments, axes, motions + size * i);
    });
  }
};

template <class Real> template <std::size_t C>
void SphereSpreader<Real>::spread(const double *loads, Moments moments, const Axes &axes,
                                  const std::array<Real *, C> &fields) const
{
  with_window_width<Real>(this->window_.width(), [&](auto width) {
    Loops<decltype(width)::value>::spread(*this, loads, moments, axes, fields);
  });
}

template <class Real> template <std::size_t C>
void SphereSpreader<Real>::interpolate(const std::array<Real *, C> &fields, Moments moments,
                                       const Axes &axes, const double *coefficients,
                                       double *motions) const
{
  with_window_width<Real>(this->window_.width(), [&](auto width) {
    Loops<decltype(width)::value>::interpolate(*this, fields, moments, axes, coefficients, motions);
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
