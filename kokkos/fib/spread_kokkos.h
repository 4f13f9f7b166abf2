// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Spreading and interpolation of the immersed boundary method on a device, S and J of FIB sec. III
/// A.
///
/// Spreading is parallel over particles, with atomic additions to the grid.  There is one thread
/// for each line of the slow axis under a component of a particle.  Tiles in fast memory, as used
/// for the non-uniform transform, would save nothing here.  The kernels are as narrow as the
/// spheres: even at a volume fraction of 0.3 a tile of 8^3 cells has only 13 to 50 particles (roma3
/// .. bkp6 have 0.09 to 0.02 per cell), each of which touches 27 to 216 faces.  Adding the tile
/// with its rim, 11^3 to 14^3 faces, to the grid would take as many atomic operations as adding the
/// particles themselves.
#ifndef BDH_FIB_SPREAD_KOKKOS_H
#define BDH_FIB_SPREAD_KOKKOS_H

#include "base/bytes_of.h"
#include "base/device_kokkos.h"
#include "base/strain_kernel.h"
#include "fib/kernel_choice.h"
#include "fib/spread.h"
#include "grid/lines_kernel.h"

#include <type_traits>

namespace bdh {

/// An axis of a grid with the lines that this rank has: those of its planes, or all.
struct RankLines : AxisLines {
  long first, count;
};

/// Weight 0, and a line that exists, if the rank does not have the line; else its place among those
/// that it has.
BDH_FN void keep_to_rank(const RankLines &axis, double &weight, long &line)
{
  line -= axis.first;
  if (line >= 0 && line < axis.count) return;
  weight = 0.0;
  line = 0;
}

/// A staggered field on this rank's planes, as kernels see it.
struct DeviceField {
  RankLines axis[3];
  double *component[3];
  long row, plane;    ///< elements from row to row and from plane to plane; in 2D a plane is a row
};

/// Weights of a particle on the lines under it along one axis, and where those lines are.
template <class Kernel> struct LineWeights {
  double w[Kernel::width];
  long line[Kernel::width];

  /// `x` is in spacings.  `faces` chooses the lines of the axis' own faces, or else of its cell
  /// centres.
  BDH_FN LineWeights(const RankLines &axis, bool faces, double x, double force, double slope)
  {
    double r, dw[Kernel::width];
    const long first = static_cast<long>(Kernel::first(faces ? x : x - 0.5, r));
    Kernel::weights(r, w);
    if (slope != 0.0) Kernel::derivatives(r, dw);
    for (int i = 0; i < Kernel::width; ++i) {
      const double weight = slope != 0.0 ? force * w[i] + slope * dw[i] : force * w[i];
      w[i] = weight * line_sign(axis, faces, first + i);
      line[i] = stored_line(axis, faces, first + i);
      keep_to_rank(axis, w[i], line[i]);
    }
  }
};

/// The weights of one component of one particle along all axes; `force` and `slope` multiply those
/// of its own axis.
template <class Kernel, int D> struct Footprint {
  LineWeights<Kernel> x, y, z;    // in 2D z is not used
  BDH_FN Footprint(const DeviceField &f, int c, const double *q, double force, double slope) :
      x(f.axis[0], c == 0, q[0], c == 0 ? force : 1.0, c == 0 ? slope : 0.0),
      y(f.axis[1], c == 1, q[1], c == 1 ? force : 1.0, c == 1 ? slope : 0.0),
      z(f.axis[D - 1], c == D - 1, q[D - 1], D == 3 && c == 2 ? force : 1.0,
        D == 3 && c == 2 ? slope : 0.0)
  {}
};

/// field += S F + kT div S.  The index is (particle, component, line of the slow axis), the last
/// one fastest.
template <class Kernel, int D> struct SpreadLine {
  static constexpr int W = Kernel::width;
  DeviceField field;
  const double *x, *force;        // positions in spacings; [force], null: none
  double inv_volume, drift[3];    // drift is kT/h_c
  const double *energy;           // kT by number, with drift = 1/h_c; null: the same for all
  BDH_FN void operator()(long index) const
  {
    const long p = index / (D * W);
    const long c = index / W % D, k = index % W;
    const double of_energy = energy ? energy[3 * p + c] : 1.0;
    const Footprint<Kernel, D> f(field, c, x + 3 * p, force ? inv_volume * force[3 * p + c] : 0.0,
                                 inv_volume * drift[c] * of_energy);
    if ((D == 3 ? f.z.w[k] : f.y.w[k]) == 0.0) return;
    double *const to = field.component[c];
    if (D == 3) {
      for (int j = 0; j < W; ++j)
        for (int i = 0; i < W; ++i)
          Kokkos::atomic_add(to + f.z.line[k] * field.plane + f.y.line[j] * field.row + f.x.line[i],
                             f.z.w[k] * f.y.w[j] * f.x.w[i]);
    } else {
      for (int i = 0; i < W; ++i)
        Kokkos::atomic_add(to + f.y.line[k] * field.row + f.x.line[i], f.y.w[k] * f.x.w[i]);
    }
  }
};

/// velocity := J v.  The index is (particle, component), the last one fastest.  In 2D the third
/// component is 0.
template <class Kernel, int D> struct Interpolate {
  static constexpr int W = Kernel::width;
  DeviceField field;
  const double *x;
  double *velocity;
  BDH_FN void operator()(long index) const
  {
    const long p = index / 3;
    const long c = index % 3;
    double sum = 0.0;
    if (c < D) {
      const Footprint<Kernel, D> f(field, c, x + 3 * p, 1.0, 0.0);
      const double *const from = field.component[c];
      for (int k = 0; k < (D == 3 ? W : 1); ++k)
        for (int j = 0; j < W; ++j) {
          const double *row =
              from + (D == 3 ? f.z.line[k] * field.plane : 0) + f.y.line[j] * field.row;
          double of_row = 0.0;
          for (int i = 0; i < W; ++i) of_row += f.x.w[i] * row[f.x.line[i]];
          sum += (D == 3 ? f.z.w[k] : 1.0) * f.y.w[j] * of_row;
        }
    }
    velocity[index] = sum;
  }
};

/// Weights of torques of a particle on the lines under it along one axis, and where those are.
template <class K> struct TurningLine {
  static constexpr int W = TurningWeights<K>::width;
  double w[W];
  long line[W];

  /// For component c with its differences along an axis; `d` is the axis of the lines.
  BDH_FN TurningLine(const RankLines &axis, int d, int c, int difference, double x)
  {
    const StrainWeights<K> of(x, axis.h);
    const bool faces = d == c;
    const double *const weights = faces && c == difference ? of.normal
                                  : faces                  ? of.face
                                  : d == difference        ? of.difference
                                                           : of.centre;
    const long first = faces && c == difference ? of.first_normal
                       : faces                  ? of.first_face
                                                : of.first_centre();
    for (int i = 0; i < W; ++i) {
      w[i] = weights[i] * line_sign(axis, faces, first + i);
      line[i] = stored_line(axis, faces, first + i);
      keep_to_rank(axis, w[i], line[i]);
    }
  }
};

/// The same along all axes.
template <class K, int D> struct TurningPrint {
  TurningLine<K> x, y, z;    // in 2D z is not used
  BDH_FN TurningPrint(const DeviceField &f, int c, int difference, const double *q) :
      x(f.axis[0], 0, c, difference, q[0]), y(f.axis[1], 1, c, difference, q[1]),
      z(f.axis[D - 1], D - 1, c, difference, q[D - 1])
  {}
};

/// The adjoint of average_difference(), on one line of the slow axis, the k-th one under the
/// particle: component c of the field += strength times the weights.
template <class K, int D> BDH_FN void add_difference(const DeviceField &field, int c,
                                                     int difference, int k, const double *q,
                                                     double strength)
{
  constexpr int W = TurningWeights<K>::width;
  const TurningPrint<K, D> f(field, c, difference, q);
  if ((D == 3 ? f.z.w[k] : f.y.w[k]) == 0.0) return;
  double *const to = field.component[c];
  if (D == 3) {
    for (int j = 0; j < W; ++j)
      for (int i = 0; i < W; ++i)
        Kokkos::atomic_add(to + f.z.line[k] * field.plane + f.y.line[j] * field.row + f.x.line[i],
                           strength * f.z.w[k] * f.y.w[j] * f.x.w[i]);
  } else {
    for (int i = 0; i < W; ++i)
      Kokkos::atomic_add(to + f.y.line[k] * field.row + f.x.line[i],
                         strength * f.y.w[k] * f.x.w[i]);
  }
}

/// field += half the curl of the kernel times torques.  The index is (particle, component, term,
/// line of the slow axis), the last one fastest.
template <class K, int D> struct SpreadTorqueLine {
  static constexpr int W = TurningWeights<K>::width;
  DeviceField field;
  const double *x, *torque;    // positions in spacings; [force length]
  double inv_volume;
  BDH_FN void operator()(long index) const
  {
    const long p = index / (D * 2 * W);
    const int c = index / (2 * W) % D, k = index % W;
    const TurningTerm term(c, index / W % 2);
    if (term.difference >= D) return;
    add_difference<K, D>(field, c, term.difference, k, x + 3 * p,
                         inv_volume * term.factor * torque[3 * p + term.torque]);
  }
};

/// The average of the difference of component c along an axis, around a particle at q.
template <class K, int D>
BDH_FN double average_difference(const DeviceField &field, int c, int difference, const double *q)
{
  constexpr int W = TurningWeights<K>::width;
  const TurningPrint<K, D> f(field, c, difference, q);
  double sum = 0.0;
  for (int k = 0; k < (D == 3 ? W : 1); ++k)
    for (int j = 0; j < W; ++j) {
      const double *row =
          field.component[c] + (D == 3 ? f.z.line[k] * field.plane : 0) + f.y.line[j] * field.row;
      double of_row = 0.0;
      for (int i = 0; i < W; ++i) of_row += f.x.w[i] * row[f.x.line[i]];
      sum += (D == 3 ? f.z.w[k] : 1.0) * f.y.w[j] * of_row;
    }
  return sum;
}

/// omega := half the average of the curl.  The index is (particle, component of omega), the last
/// one fastest.  In 2D only the third is not 0.
template <class K, int D> struct InterpolateCurl {
  static constexpr int W = TurningWeights<K>::width;
  DeviceField field;
  const double *x;
  double *omega;
  BDH_FN void operator()(long index) const
  {
    const int axis = index % 3;
    double sum = 0.0;
    for (int t = 0; t < 2; ++t) {
      const int c = (axis + 2 - t) % 3;    // the component whose term t this axis turns
      const TurningTerm term(c, t);
      if (c < D && term.difference < D)
        sum +=
            term.factor * average_difference<K, D>(field, c, term.difference, x + 3 * (index / 3));
    }
    omega[index] = sum;
  }
};

/// field -= divergence of the kernel times stresslets, in 3D.  The index is (particle, component,
/// axis of the difference, line of the slow axis), the last one fastest.
template <class K> struct SpreadStressletLine {
  static constexpr int W = TurningWeights<K>::width;
  DeviceField field;
  const double *x, *stresslet;    // positions in spacings; [force length]
  double inv_volume;
  BDH_FN void operator()(long index) const
  {
    const long p = index / (9 * W);
    const int c = index / (3 * W) % 3, d = index / W % 3, k = index % W;
    const auto S = Symmetric<double>::of(stresslet + strain_numbers * p);
    add_difference<K, 3>(field, c, d, k, x + 3 * p, inv_volume * S.at(c, d));
  }
};

/// strain := average rates of strain, omega := half the average of the curl, in 3D; by particle.
template <class K> struct InterpolateGradient {
  DeviceField field;
  const double *x;
  double *strain, *omega;
  BDH_FN void operator()(long p) const
  {
    double gradient[3][3];
    for (int c = 0; c < 3; ++c)
      for (int d = 0; d < 3; ++d) gradient[c][d] = average_difference<K, 3>(field, c, d, x + 3 * p);
    strain_of(gradient, strain + strain_numbers * p);
    half_curl_of(gradient, omega + 3 * p);
  }
};

/// Turns coordinates into spacings.  The index is that of the array.
struct ScalePositions {
  AxisLines axis[3];
  int dim;
  const double *from;
  double *to;
  BDH_FN void operator()(long index) const
  {
    const long d = index % 3;
    to[index] = d < dim ? cells_from_end(axis[d], from[index]) : 0.0;
  }
};

/// HostSpreader on a device.  All pointers are device pointers.
template <class Exec> class DeviceSpreader {
 public:
  DeviceSpreader(const Grid &grid, const Slab &slab, IbKernel kernel,
                 const Workers & = Workers::one(), bool turns = false) :
      grid_(grid),
      slab_(slab), kernel_(kernel), span_(kernel_span(kernel, turns))
  {}

  FirstLines<FirstLine, FirstLine> first_lines(const double *x) const
  {
    return bdh::first_lines(grid_, span_, x);
  }
  long reach() const { return span_ + 1; }

  void bind(const double *x, long n)
  {
    n_ = n;
    x_.resize(3 * n);
    ScalePositions scale{{}, grid_.dim, x, x_.data()};
    for (int d = 0; d < grid_.dim; ++d) scale.axis[d] = axis_lines(grid_, d);
    device_for<Exec>("bdh::bind", 3 * n, scale);
    Exec().fence();
  }

  void spread(const double *force, double drift_kT, const FieldView &field) const
  {
    spread_loads(force, drift_kT, nullptr, field);
  }
  void spread_drift(const double *kT, const FieldView &field) const
  {
    spread_loads(nullptr, 1.0, kT, field);
  }

  void interpolate(const FieldView &field, double *velocity) const
  {
    with_kernel(kernel_, grid_.dim, [&](auto kernel, auto dim) {
      device_for<Exec>("bdh::interpolate", 3 * n_,
                       Interpolate<decltype(kernel), decltype(dim)::value>{device_field(field),
                                                                           x_.data(), velocity});
    });
    Exec().fence();
  }

  void spread_torque(const double *torque, const FieldView &field) const
  {
    with_turning_kernel(kernel_, grid_.dim, [&](auto kernel, auto dim) {
      using Line = SpreadTorqueLine<decltype(kernel), decltype(dim)::value>;
      device_for<Exec>("bdh::spread_torque", n_ * grid_.dim * 2 * Line::W,
                       Line{device_field(field), x_.data(), torque, 1.0 / grid_.cell_volume()});
    });
    Exec().fence();
  }

  void angular_velocity(const FieldView &field, double *omega) const
  {
    with_turning_kernel(kernel_, grid_.dim, [&](auto kernel, auto dim) {
      device_for<Exec>("bdh::angular_velocity", 3 * n_,
                       InterpolateCurl<decltype(kernel), decltype(dim)::value>{device_field(field),
                                                                               x_.data(), omega});
    });
    Exec().fence();
  }

  void spread_stresslet(const double *stresslet, const FieldView &field) const
  {
    with_turning_kernel(kernel_, 3, [&](auto kernel, auto) {
      using Line = SpreadStressletLine<decltype(kernel)>;
      device_for<Exec>("bdh::spread_stresslet", n_ * 9 * Line::W,
                       Line{device_field(field), x_.data(), stresslet, 1.0 / grid_.cell_volume()});
    });
    Exec().fence();
  }

  void gradient(const FieldView &field, double *strain, double *omega) const
  {
    with_turning_kernel(kernel_, 3, [&](auto kernel, auto) {
      device_for<Exec>(
          "bdh::gradient", n_,
          InterpolateGradient<decltype(kernel)>{device_field(field), x_.data(), strain, omega});
    });
    Exec().fence();
  }

  std::size_t memory() const { return bytes_of(x_); }

 private:
  void spread_loads(const double *force, double drift_kT, const double *energy,
                    const FieldView &field) const
  {
    with_kernel(kernel_, grid_.dim, [&](auto kernel, auto dim) {
      using Kernel = decltype(kernel);
      constexpr int D = decltype(dim)::value;
      SpreadLine<Kernel, D> s{device_field(field),       x_.data(),       force,
                              1.0 / grid_.cell_volume(), {0.0, 0.0, 0.0}, energy};
      for (int d = 0; d < D; ++d) s.drift[d] = drift_kT / grid_.h(d);
      device_for<Exec>("bdh::spread", n_ * D * Kernel::width, s);
    });
    Exec().fence();
  }

  DeviceField device_field(const FieldView &field) const
  {
    DeviceField f{};
    for (int d = 0; d < grid_.dim; ++d) {
      const bool slow = d == grid_.slow_axis();
      f.axis[d] = {axis_lines(grid_, d), slow ? slab_.start : 0, slow ? slab_.count : grid_.n[d]};
      f.component[d] = field[d];
    }
    f.row = 2 * grid_.half();
    f.plane = grid_.dim == 3 ? f.row * grid_.n[1] : f.row;
    return f;
  }

  Grid grid_;
  Slab slab_;
  IbKernel kernel_;
  int span_;
  long n_ = 0;
  DeviceArray<double, Exec> x_;
};

}    // namespace bdh
#endif
