// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/window_spread.h"

#include "grid/stencil.h"
#include "pse/window_choice.h"
#include "pse/window_weights.h"

#include <cmath>

namespace bdh {

Grid fractional_grid(const std::array<long, 3> &n)
{
  Grid g;
  g.n = n;
  return g;
}

/// The loops, compiled once per width.
template <class Real> template <int W> struct WindowSpreader<Real>::Loops {
  struct Work {
    WindowWeights<Real, W> axis[3];
  };

  /// Calls action(place in the caller's arrays, stencil) for every particle.
  template <class Action> static void for_particles(const WindowSpreader &me, const View &field,
                                                    FieldAccess access, Action action)
  {
    for_batches<Work>(me.particles_, field, access, [&](Work &work, long begin, int count) {
      for (int d = 0; d < 3; ++d)
        work.axis[d].compute(me.particles_.x(d) + begin, me.coefficient_.data(),
                             me.window_.degree());
      for (int p = 0; p < count; ++p)
        action(me.particles_.original(begin + p),
               window_stencil(work.axis, p, me.particles_.lines()));
    });
  }

  static void spread(const WindowSpreader &me, const double *force, const View &field)
  {
    Real *const to[3] = {field[0], field[1], field[2]};
    for_particles(me, field, FieldAccess::writes, [&](long i, const Stencil<Real, W> &s) {
      const double *F = force + 3 * i;
      const Real f[3] = {Real(F[0]), Real(F[1]), Real(F[2])};
      add<Real, W, 3, 3>(s, f, to);
    });
  }

  static void interpolate(const WindowSpreader &me, const View &field, double *velocity)
  {
    const Real *const from[3] = {field[0], field[1], field[2]};
    for_particles(me, field, FieldAccess::reads, [&](long i, const Stencil<Real, W> &s) {
      Real u[3];
      gather<Real, W, 3, 3>(s, from, u);
      for (int c = 0; c < 3; ++c) velocity[3 * i + c] = u[c];
    });
  }
};

template <class Real>
WindowSpreader<Real>::WindowSpreader(const std::array<long, 3> &n, const Slab &slab,
                                     const Window &window, double error, const Workers &workers) :
    window_(window, error),
    particles_(fractional_grid(n), slab, window.width, sizeof(Real), workers)
{
  for (std::size_t i = 0; i < window_.coefficients().size(); ++i)
    coefficient_[i] = window_.coefficients()[i];
}

template <class Real> long WindowSpreader<Real>::first_line(int axis, double s) const
{
  const Grid &g = particles_.grid();
  // The same expression that GridParticles has, so that both round alike.
  const double cells = s / g.h(axis), n = g.n[axis];
  return std::ceil(cells - n * std::floor(cells / n) - 0.5 * window_.width());
}

template <class Real> void WindowSpreader<Real>::bind(const double *s, long n)
{
  check_positions(particles_.grid(), s, n);
  particles_.bind(s, n);
}

template <class Real> template <class Action>
void WindowSpreader<Real>::dispatch(Action action) const
{
  with_window_width<Real>(window_.width(),
                          [&](auto width) { action(Loops<decltype(width)::value>{}); });
}

template <class Real>
void WindowSpreader<Real>::spread(const double *force, const View &field) const
{
  dispatch([&](auto loops) { decltype(loops)::spread(*this, force, field); });
}

template <class Real>
void WindowSpreader<Real>::interpolate(const View &field, double *velocity) const
{
  dispatch([&](auto loops) { decltype(loops)::interpolate(*this, field, velocity); });
}

template class WindowSpreader<float>;
template class WindowSpreader<double>;

}    // namespace bdh
