// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "fib/spread.h"

#include "base/errors.h"
#include "base/strain_kernel.h"
#include "fib/kernel_choice.h"
#include "grid/stencil.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace bdh {

namespace {

struct KernelFacts {
  IbKernel kernel;
  const char *name;
  int width;
  double radius[2], spread[2];    // 2D, 3D
  const char *turning;            // the kernel of torques
  double rotational[2], rotational_spread[2];
  double shear, stretching;    // radii of stresslets
};

// These numbers come from self-mobilities over the positions in a cell.  test_fib_host measures
// them again (TypedFibRadius, TypedTurningRadius, TypedStresslets).
// The sum of the squared weights of roma3 and peskin4 does not depend on the position, and in 2D
// nothing else enters the rotational radius.
constexpr KernelFacts kernel_facts[] = {
    {IbKernel::roma3,
     "roma3",
     3,
     {0.745, 0.908},
     {0.031, 0.0215},
     "roma3",
     {1.1284, 1.2407},
     {0.0, 0.0054},
     1.266,
     1.207},
    {IbKernel::peskin4,
     "peskin4",
     4,
     {1.042, 1.2544},
     {0.0093, 0.0068},
     "roma3",
     {1.1284, 1.2407},
     {0.0, 0.0054},
     1.266,
     1.207},
    {IbKernel::bkp6,
     "bkp6",
     6,
     {1.227, 1.4685},
     {0.00026, 0.00025},
     "peskin4",
     {1.5045, 1.6543},
     {0.0, 0.00178},
     1.6746,
     1.6261},
};

const KernelFacts &facts(IbKernel kernel) { return kernel_facts[static_cast<int>(kernel)]; }

}    // namespace

/// line_sign() of every line that a kernel may touch.  Weights in corners are products of these.
/// [FIB sec. III A]
struct WallImages {
  WallImages(const Grid &grid, int axis)
  {
    const AxisLines lines = axis_lines(grid, axis);
    for (long i = -GridLines::margin; i <= grid.n[axis] + GridLines::margin; ++i) {
      face.push_back(line_sign(lines, true, i));
      centre.push_back(line_sign(lines, false, i));
    }
  }
  std::vector<double> face, centre;
};

namespace {

/// Weights of a batch of particles along one axis: on the axis' own faces and on the lines half a
/// spacing away.
template <class Kernel, class Real> struct AxisWeights {
  static constexpr int W = Kernel::width;
  using Weights = BatchWeights<Real, W>;
  alignas(64) Weights face, centre, slope;
  alignas(64) int first_face[batch], first_centre[batch];

  /// `x` has `batch` positions.  `images` is null for a periodic axis.
  void compute(const double *x, bool with_slope, const WallImages *images)
  {
    lines<Kernel::weights>(x, 0.0, first_face, face);
    if (with_slope) lines<Kernel::derivatives>(x, 0.0, first_face, slope);
    lines<Kernel::weights>(x, 0.5, first_centre, centre);
    if (!images) return;
    reflect(images->face, first_face, face);
    if (with_slope) reflect(images->face, first_face, slope);
    reflect(images->centre, first_centre, centre);
  }

 private:
  static void reflect(const std::vector<double> &sign, const int *first, Weights &w)
  {
    for (int i = 0; i < W; ++i)
      for (int p = 0; p < batch; ++p) w[i][p] *= Real(sign[first[p] + i + GridLines::margin]);
  }

  /// Unrolled, so that the weights of a particle stay in registers.
  template <int... i>
  static void store(const double *line, Weights &w, int p, std::integer_sequence<int, i...>)
  {
    ((w[i][p] = Real(line[i])), ...);
  }
  /// The formula is a constant of the compiler, so that the loop over particles is vectorised.
  template <void (*formula)(double, double *)>
  static void lines(const double *x, double shift, int *first, Weights &w)
  {
    BDH_INDEPENDENT
    for (int p = 0; p < batch; ++p) {
      double r, line[W];
      first[p] = static_cast<int>(Kernel::first(x[p] - shift, r));
      formula(r, line);
      store(line, w, p, std::make_integer_sequence<int, W>());
    }
  }
};

/// All weights of a batch of particles, and from them the stencil of each component.
template <class Kernel, int D, class Real> struct Footprints {
  static constexpr int W = Kernel::width;
  AxisWeights<Kernel, Real> axis[D];

  /// `own` has weights along axis C that replace the kernel's face weights.
  template <int C>
  Stencil<Real, W> stencil(int p, const BatchWeights<Real, W> &own, const GridLines &lines) const
  {
    const BatchWeights<Real, W> *w[3] = {};
    long first[3] = {0, 0, 0};
    for (int d = 0; d < D; ++d) {
      w[d] = d == C ? &own : &axis[d].centre;
      first[d] = d == C ? axis[d].first_face[p] : axis[d].first_centre[p];
    }
    return make_stencil<Real, W, D>(p, w, first, lines, C);
  }
};

/// Weights of torques of a batch of particles along one axis.
template <class Kernel, class Number> struct AxisTurning {
  using K = Kernel;
  using Real = Number;
  static constexpr int W = TurningWeights<K>::width;
  using Weights = BatchWeights<Real, W>;
  alignas(64) Weights face, centre, difference;
  alignas(64) long first_face[batch];

  /// `x` has `batch` positions.  `images` is null for a periodic axis.
  void compute(const double *x, double h, const WallImages *images)
  {
    for (int p = 0; p < batch; ++p) set(p, TurningWeights<K>(x[p], h), images);
  }
  /// Weights and first line of a component along its own axis.
  const Weights &own(bool /*normal*/) const { return face; }
  long first_own(int p, bool /*normal*/) const { return first_face[p]; }

 protected:
  void set(int p, const TurningWeights<K> &w, const WallImages *images)
  {
    first_face[p] = w.first_face;
    for (int i = 0; i < W; ++i) {
      const long line = w.first_face + i + GridLines::margin;
      const double at_face = images ? images->face[line] : 1.0;
      const double at_centre = images ? images->centre[line - 1] : 1.0;
      face[i][p] = Real(at_face * w.face[i]);
      centre[i][p] = Real(at_centre * w.centre[i]);
      difference[i][p] = Real(at_centre * w.difference[i]);
    }
  }
};

/// The same for stresslets.
template <class K, class Real> struct AxisStrain : AxisTurning<K, Real> {
  using Base = AxisTurning<K, Real>;
  using Base::W;
  using typename Base::Weights;
  alignas(64) Weights normal;
  alignas(64) long first_normal[batch];

  void compute(const double *x, double h, const WallImages *images)
  {
    for (int p = 0; p < batch; ++p) {
      const StrainWeights<K> w(x[p], h);
      this->set(p, w, images);
      first_normal[p] = w.first_normal;
      for (int i = 0; i < W; ++i)
        normal[i][p] = Real((images ? images->face[w.first_normal + i + GridLines::margin] : 1.0) *
                            w.normal[i]);
    }
  }
  const Weights &own(bool is_normal) const { return is_normal ? normal : this->face; }
  long first_own(int p, bool is_normal) const
  {
    return is_normal ? first_normal[p] : this->first_face[p];
  }
};

/// All of these weights, and from them the stencil of a component with its differences along one
/// axis.  Axis: AxisTurning or AxisStrain.
template <class Axis, int D> struct GradientFootprints {
  static constexpr int W = Axis::W;
  using Real = typename Axis::Real;
  Axis axis[D];

  void compute(const GridParticles &particles, const std::unique_ptr<WallImages> (&images)[3],
               long begin)
  {
    for (int d = 0; d < D; ++d)
      axis[d].compute(particles.x(d) + begin, particles.grid().h(d), images[d].get());
  }
  Stencil<Real, W> stencil(int p, int component, int difference, const GridLines &lines) const
  {
    const BatchWeights<Real, W> *w[3] = {};
    long first[3] = {0, 0, 0};
    for (int d = 0; d < D; ++d) {
      const Axis &along = axis[d];
      const bool normal = component == difference;
      w[d] = d == component    ? &along.own(normal)
             : d == difference ? &along.difference
                               : &along.centre;
      first[d] = d == component ? along.first_own(p, normal) : along.first_face[p] - 1;
    }
    return make_stencil<Real, W, D>(p, w, first, lines, component);
  }
};

/// Calls action(component, term) for the terms that there are in D dimensions.
template <int D, class Action> void for_turning_terms(Action action)
{
  for (int c = 0; c < D; ++c)
    for (int term = 0; term < 2; ++term)
      if (TurningTerm(c, term).difference < D) action(c, TurningTerm(c, term));
}

/// Calls action(component) with the component as a compile-time constant.
template <int D, class Action> void for_components(Action action)
{
  action(std::integral_constant<int, 0>{});
  action(std::integral_constant<int, 1>{});
  if constexpr (D == 3) action(std::integral_constant<int, 2>{});
}

}    // namespace

int kernel_width(IbKernel kernel) { return facts(kernel).width; }
int rows_beyond(IbKernel kernel) { return (kernel_width(kernel) + 1) / 2 + 1; }
const char *kernel_name(IbKernel kernel) { return facts(kernel).name; }
double radius_over_spacing(IbKernel kernel, int dim) { return facts(kernel).radius[dim - 2]; }

double hydrodynamic_radius(IbKernel kernel, const Grid &grid)
{
  return radius_over_spacing(kernel, grid.dim) * std::pow(grid.cell_volume(), 1.0 / grid.dim);
}
double radius_spread(IbKernel kernel, int dim) { return facts(kernel).spread[dim - 2]; }

double rotational_radius_over_spacing(IbKernel kernel, int dim)
{
  return facts(kernel).rotational[dim - 2];
}
double rotational_radius(IbKernel kernel, const Grid &grid)
{
  return rotational_radius_over_spacing(kernel, grid.dim) *
         std::pow(grid.cell_volume(), 1.0 / grid.dim);
}
double rotational_radius_spread(IbKernel kernel, int dim)
{
  return facts(kernel).rotational_spread[dim - 2];
}
double StressletRadii::mean() const
{
  const double a = 1.0 / (shear * shear * shear), b = 1.0 / (stretching * stretching * stretching);
  return std::cbrt(5.0 / (3.0 * a + 2.0 * b));
}
StressletRadii stresslet_radii(IbKernel kernel, const Grid &grid)
{
  const double h = std::cbrt(grid.cell_volume());
  return {facts(kernel).shear * h, facts(kernel).stretching * h};
}
const char *turning_kernel_name(IbKernel kernel) { return facts(kernel).turning; }

IbKernel kernel_from_name(const std::string &name)
{
  for (const KernelFacts &f : kernel_facts)
    if (name == f.name) return f.kernel;
  throw InvalidOption("kernel", name, "must be roma3, peskin4 or bkp6");
}

/// The loops, compiled once per kernel and dimension.
template <class Real> struct HostSpreader<Real>::Impl {
  /// What is spread: forces (null: none), with an energy times the divergence of S, which is kT of
  /// all particles, or energy[] of each.
  struct Loads {
    const double *force;
    double kT;
    const double *energy;
  };
  template <class Kernel, int D>
  static void spread(const HostSpreader &, const Loads &, const FieldOf<Real> &);
  template <class Kernel, int D>
  static void interpolate(const HostSpreader &, const FieldOf<Real> &, double *);
  template <class K, int D>
  static void spread_torque(const HostSpreader &, const double *, const FieldOf<Real> &);
  template <class K, int D>
  static void angular_velocity(const HostSpreader &, const FieldOf<Real> &, double *);
  template <class K>
  static void spread_stresslet(const HostSpreader &, const double *, const FieldOf<Real> &);
  template <class K>
  static void gradient(const HostSpreader &, const FieldOf<Real> &, double *, double *);
};

template <class Real> template <class Kernel, int D>
void HostSpreader<Real>::Impl::spread(const HostSpreader &me, const Loads &loads,
                                      const FieldOf<Real> &field)
{
  constexpr int W = Kernel::width;
  const double inv_volume = 1.0 / me.grid_.cell_volume();
  const bool drift = loads.energy || loads.kT != 0.0;
  using Prints = Footprints<Kernel, D, Real>;
  for_batches<Prints>(
      me.particles_, field, FieldAccess::writes, [&](Prints &prints, long begin, int count) {
        for (int d = 0; d < D; ++d)
          prints.axis[d].compute(me.particles_.x(d) + begin, drift, me.images_[d].get());
        for_components<D>([&](auto c) {
          // The weight along the component's own axis is F phi + kT phi'/h.
          alignas(64) BatchWeights<Real, W> own;
          Real f[batch] = {}, t[batch];
          std::fill_n(t, batch, Real(inv_volume * loads.kT / me.grid_.h(c)));
          for (int p = 0; p < count; ++p) {
            const long number = 3L * me.particles_.original(begin + p) + c;
            if (loads.force) f[p] = Real(inv_volume * loads.force[number]);
            if (loads.energy) t[p] = Real(inv_volume * loads.energy[number] / me.grid_.h(c));
          }
          for (int i = 0; i < W; ++i)
            for (int p = 0; p < batch; ++p)
              own[i][p] = f[p] * prints.axis[c].face[i][p] +
                          (drift ? t[p] * prints.axis[c].slope[i][p] : Real(0));
          Real *const component[1] = {field[c]};
          for (int p = 0; p < count; ++p)
            add<Real, W, D, 1>(prints.template stencil<c>(p, own, me.particles_.lines()), {Real(1)},
                               component);
        });
      });
}

template <class Real> template <class Kernel, int D>
void HostSpreader<Real>::Impl::interpolate(const HostSpreader &me, const FieldOf<Real> &field,
                                           double *velocity)
{
  constexpr int W = Kernel::width;
  using Prints = Footprints<Kernel, D, Real>;
  for_batches<Prints>(
      me.particles_, field, FieldAccess::reads, [&](Prints &prints, long begin, int count) {
        for (int d = 0; d < D; ++d)
          prints.axis[d].compute(me.particles_.x(d) + begin, false, me.images_[d].get());
        for (int p = 0; p < count; ++p) {
          double *u = velocity + 3L * me.particles_.original(begin + p);
          u[2] = 0.0;
          for_components<D>([&](auto c) {
            const Real *const component[1] = {field[c]};
            Real total[1];
            gather<Real, W, D, 1>(
                prints.template stencil<c>(p, prints.axis[c].face, me.particles_.lines()),
                component, total);
            u[c] = total[0];
          });
        }
      });
}

template <class Real> template <class K, int D>
void HostSpreader<Real>::Impl::spread_torque(const HostSpreader &me, const double *torque,
                                             const FieldOf<Real> &field)
{
  constexpr int W = TurningWeights<K>::width;
  const double inv_volume = 1.0 / me.grid_.cell_volume();
  using Prints = GradientFootprints<AxisTurning<K, Real>, D>;
  for_batches<Prints>(
      me.particles_, field, FieldAccess::writes, [&](Prints &prints, long begin, int count) {
        prints.compute(me.particles_, me.images_, begin);
        for (int p = 0; p < count; ++p) {
          const double *T = torque + 3L * me.particles_.original(begin + p);
          for_turning_terms<D>([&](int c, const TurningTerm &term) {
            Real *const component[1] = {field[c]};
            add<Real, W, D, 1>(prints.stencil(p, c, term.difference, me.particles_.lines()),
                               {Real(inv_volume * term.factor * T[term.torque])}, component);
          });
        }
      });
}

template <class Real> template <class K, int D>
void HostSpreader<Real>::Impl::angular_velocity(const HostSpreader &me, const FieldOf<Real> &field,
                                                double *omega)
{
  constexpr int W = TurningWeights<K>::width;
  using Prints = GradientFootprints<AxisTurning<K, Real>, D>;
  for_batches<Prints>(
      me.particles_, field, FieldAccess::reads, [&](Prints &prints, long begin, int count) {
        prints.compute(me.particles_, me.images_, begin);
        for (int p = 0; p < count; ++p) {
          double *w = omega + 3L * me.particles_.original(begin + p);
          for (int d = 0; d < 3; ++d) w[d] = 0.0;
          for_turning_terms<D>([&](int c, const TurningTerm &term) {
            const Real *const component[1] = {field[c]};
            Real total[1];
            gather<Real, W, D, 1>(prints.stencil(p, c, term.difference, me.particles_.lines()),
                                  component, total);
            w[term.torque] += term.factor * total[0];
          });
        }
      });
}

template <class Real> template <class K>
void HostSpreader<Real>::Impl::spread_stresslet(const HostSpreader &me, const double *stresslet,
                                                const FieldOf<Real> &field)
{
  constexpr int W = TurningWeights<K>::width;
  const double inv_volume = 1.0 / me.grid_.cell_volume();
  using Prints = GradientFootprints<AxisStrain<K, Real>, 3>;
  for_batches<Prints>(
      me.particles_, field, FieldAccess::writes, [&](Prints &prints, long begin, int count) {
        prints.compute(me.particles_, me.images_, begin);
        for (int p = 0; p < count; ++p) {
          const auto S = Symmetric<double>::of(
              stresslet + strain_numbers * static_cast<long>(me.particles_.original(begin + p)));
          for (int c = 0; c < 3; ++c)
            for (int d = 0; d < 3; ++d) {
              Real *const component[1] = {field[c]};
              add<Real, W, 3, 1>(prints.stencil(p, c, d, me.particles_.lines()),
                                 {Real(inv_volume * S.at(c, d))}, component);
            }
        }
      });
}

template <class Real> template <class K>
void HostSpreader<Real>::Impl::gradient(const HostSpreader &me, const FieldOf<Real> &field,
                                        double *strain, double *omega)
{
  constexpr int W = TurningWeights<K>::width;
  using Prints = GradientFootprints<AxisStrain<K, Real>, 3>;
  for_batches<Prints>(me.particles_, field, FieldAccess::reads,
                      [&](Prints &prints, long begin, int count) {
                        prints.compute(me.particles_, me.images_, begin);
                        for (int p = 0; p < count; ++p) {
                          double gradient[3][3];
                          for (int c = 0; c < 3; ++c)
                            for (int d = 0; d < 3; ++d) {
                              const Real *const component[1] = {field[c]};
                              Real total[1];
                              gather<Real, W, 3, 1>(prints.stencil(p, c, d, me.particles_.lines()),
                                                    component, total);
                              gradient[c][d] = total[0];
                            }
                          const long particle = me.particles_.original(begin + p);
                          strain_of(gradient, strain + strain_numbers * particle);
                          half_curl_of(gradient, omega + 3 * particle);
                        }
                      });
}

int kernel_span(IbKernel kernel, bool turns)
{
  int span = kernel_width(kernel);
  if (turns)
    with_turning_kernel(kernel, 3, [&span](auto turning, auto) {
      span = std::max(span, TurningWeights<decltype(turning)>::width);
    });
  return span;
}

template <class Real>
HostSpreader<Real>::HostSpreader(const Grid &grid, const Slab &slab, IbKernel kernel,
                                 const Workers &workers, bool turns) :
    grid_(grid),
    kernel_(kernel), width_(kernel_span(kernel, turns)),
    particles_(grid, slab, width_, sizeof(Real), workers)
{
  for (int d = 0; d < grid.dim; ++d)
    if (grid.walled(d)) images_[d] = std::make_unique<WallImages>(grid, d);
}

template <class Real> HostSpreader<Real>::~HostSpreader() {}

template <class Real> void HostSpreader<Real>::spread(const double *force, double drift_kT,
                                                      const FieldOf<Real> &field) const
{
  with_kernel(kernel_, grid_.dim, [&](auto kernel, auto dim) {
    Impl::template spread<decltype(kernel), decltype(dim)::value>(*this, {force, drift_kT, nullptr},
                                                                  field);
  });
}

template <class Real>
void HostSpreader<Real>::spread_drift(const double *kT, const FieldOf<Real> &field) const
{
  with_kernel(kernel_, grid_.dim, [&](auto kernel, auto dim) {
    Impl::template spread<decltype(kernel), decltype(dim)::value>(*this, {nullptr, 0.0, kT}, field);
  });
}

template <class Real>
void HostSpreader<Real>::interpolate(const FieldOf<Real> &field, double *velocity) const
{
  with_kernel(kernel_, grid_.dim, [&](auto kernel, auto dim) {
    Impl::template interpolate<decltype(kernel), decltype(dim)::value>(*this, field, velocity);
  });
}

template <class Real>
void HostSpreader<Real>::spread_torque(const double *torque, const FieldOf<Real> &field) const
{
  with_turning_kernel(kernel_, grid_.dim, [&](auto kernel, auto dim) {
    Impl::template spread_torque<decltype(kernel), decltype(dim)::value>(*this, torque, field);
  });
}

template <class Real>
void HostSpreader<Real>::angular_velocity(const FieldOf<Real> &field, double *omega) const
{
  with_turning_kernel(kernel_, grid_.dim, [&](auto kernel, auto dim) {
    Impl::template angular_velocity<decltype(kernel), decltype(dim)::value>(*this, field, omega);
  });
}

template <class Real>
void HostSpreader<Real>::spread_stresslet(const double *stresslet, const FieldOf<Real> &field) const
{
  with_turning_kernel(kernel_, 3, [&](auto kernel, auto) {
    Impl::template spread_stresslet<decltype(kernel)>(*this, stresslet, field);
  });
}

template <class Real>
void HostSpreader<Real>::gradient(const FieldOf<Real> &field, double *strain, double *omega) const
{
  with_turning_kernel(kernel_, 3, [&](auto kernel, auto) {
    Impl::template gradient<decltype(kernel)>(*this, field, strain, omega);
  });
}

template class HostSpreader<double>;

// Everything but what constraints need: their iterations are in double.
template HostSpreader<float>::HostSpreader(const Grid &, const Slab &, IbKernel, const Workers &,
                                           bool);
template HostSpreader<float>::~HostSpreader();
template void HostSpreader<float>::spread(const double *, double, const FieldOf<float> &) const;
template void HostSpreader<float>::interpolate(const FieldOf<float> &, double *) const;
template void HostSpreader<float>::spread_torque(const double *, const FieldOf<float> &) const;
template void HostSpreader<float>::angular_velocity(const FieldOf<float> &, double *) const;

}    // namespace bdh
