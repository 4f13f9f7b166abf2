// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// What tests of torques and of stresslets share, for any backend: #define TEST_BACKEND before
/// including this.
#ifndef BDH_TEST_TYPED_MOMENTS_H
#define BDH_TEST_TYPED_MOMENTS_H

#include "base/strain_kernel.h"
#include "fib/confined.h"
#include "fib/reference_kernel.h"
#include "fib/step.h"
#include "support/test_support.h"

#include <Eigen/Dense>

namespace {

using namespace bdh;
using namespace bdh_test;
using Backend = TEST_BACKEND;

/// Forces and torques, or velocities and angular velocities: 6 numbers for each particle.  In two
/// dimensions the third, fourth and fifth are not used.
using Motion = std::vector<double>;

/// The kernel of torques that belongs to each kernel of forces.
IbKernel turning_kernel(IbKernel kernel)
{
  return kernel == IbKernel::bkp6 ? IbKernel::peskin4 : IbKernel::roma3;
}

/// Velocities, angular velocities and rates of strain in a field, by their definition.
class Definition {
 public:
  Definition(const Grid &g, IbKernel kernel) : grid_(g), dense_(g), kernel_(kernel) {}
  const DenseOperators &dense() const { return dense_; }

  Motion motion(const Eigen::VectorXd &u, const WallVectors &V, const std::vector<double> &x) const
  {
    Motion m(2 * x.size(), 0.0);
    for (std::size_t i = 0; i < x.size() / 3; ++i)
      for (int d = 0; d < 3; ++d) {
        if (d < grid_.dim)
          m[6 * i + d] = average(kernel_, &x[3 * i], {d == 0, d == 1, d == 2},
                                 [&](const long *at) { return value(u, V, d, at); });
        if (grid_.dim == 3 || d == 2)
          m[6 * i + 3 + d] = average(turning_kernel(kernel_), &x[3 * i], {d != 0, d != 1, d != 2},
                                     [&](const long *at) { return half_curl(u, V, d, at); });
      }
    return m;
  }
  /// In three dimensions, strain_numbers per particle.
  Motion strain(const Eigen::VectorXd &u, const std::vector<double> &x) const
  {
    Motion e(strain_numbers * (x.size() / 3));
    for (std::size_t i = 0; i < x.size() / 3; ++i) {
      double G[3][3];
      for (int c = 0; c < 3; ++c)
        for (int d = 0; d < 3; ++d) {
          const auto at_faces = [c, d](int axis) { return c != d && (axis == c || axis == d); };
          G[c][d] =
              average(turning_kernel(kernel_), &x[3 * i], {at_faces(0), at_faces(1), at_faces(2)},
                      [&](const long *at) { return difference(u, c, d, at); });
        }
      strain_of(G, &e[strain_numbers * i]);
    }
    return e;
  }
  /// The map from fields to motions as a matrix.
  Eigen::MatrixXd matrix(const std::vector<double> &x) const
  {
    return matrix_of([&](const Eigen::VectorXd &u) { return motion(u, WallVectors{}, x); });
  }
  Eigen::MatrixXd strain_matrix(const std::vector<double> &x) const
  {
    return matrix_of([&](const Eigen::VectorXd &u) { return strain(u, x); });
  }

 private:
  template <class Map> Eigen::MatrixXd matrix_of(Map map) const
  {
    Eigen::MatrixXd P;
    for (long k = 0; k < dense_.size(); ++k) {
      Eigen::VectorXd unit = Eigen::VectorXd::Zero(dense_.size());
      unit[k] = 1.0;
      const Motion m = map(unit);
      if (k == 0) P.resize(bdh::ssize(m), dense_.size());
      P.col(k) = Eigen::Map<const Eigen::VectorXd>(m.data(), bdh::ssize(m));
    }
    return P;
  }
  /// D_d v_c: at the centre of the cell `at`, or on the edge at its lower faces.
  double difference(const Eigen::VectorXd &u, int c, int d, const long *at) const
  {
    const WallVectors rest{};
    long other[3] = {at[0], at[1], at[2]};
    other[d] += c == d ? 1 : -1;
    const double step = value(u, rest, c, other) - value(u, rest, c, at);
    return (c == d ? step : -step) / grid_.h(d);
  }
  double value(const Eigen::VectorXd &u, const WallVectors &V, int d, const long *at) const
  {
    return dense_.extended(u, V, d, at[0], at[1], at[2]);
  }
  /// On the edge along d at the lower faces of the cell `at`.
  double half_curl(const Eigen::VectorXd &u, const WallVectors &V, int d, const long *at) const
  {
    const int a = (d + 1) % 3, b = (d + 2) % 3;
    const auto slope = [&](int component, int along) {
      long below[3] = {at[0], at[1], at[2]};
      --below[along];
      return (value(u, V, component, at) - value(u, V, component, below)) / grid_.h(along);
    };
    return 0.5 * (slope(b, a) - slope(a, b));
  }
  /// Sum of phi times f over lines of faces or of centres along each axis.
  template <class F>
  double average(IbKernel kernel, const double *q, const std::array<bool, 3> &faces, F f) const
  {
    long first[3] = {0, 0, 0}, end[3] = {1, 1, 1};
    for (int a = 0; a < grid_.dim; ++a) {
      first[a] = std::lround((q[a] - grid_.lo[a]) / grid_.h(a)) - 4;
      end[a] = first[a] + 9;
    }
    double sum = 0.0;
    for (long k = first[2]; k < end[2]; ++k)
      for (long j = first[1]; j < end[1]; ++j)
        for (long i = first[0]; i < end[0]; ++i) {
          const long at[3] = {i, j, k};
          double w = 1.0;
          for (int a = 0; a < grid_.dim; ++a)
            w *= phi(kernel,
                     (q[a] - grid_.lo[a]) / grid_.h(a) - (double(at[a]) + (faces[a] ? 0.0 : 0.5)));
          if (w != 0.0) sum += w * f(at);
        }
    return sum;
  }

  Grid grid_;
  DenseOperators dense_;
  IbKernel kernel_;
};

/// Two particles, the first of which is close to the lower corner.
std::vector<double> corner_and_middle(const Grid &g)
{
  std::vector<double> x = random_positions(g, 2, 31, 0.9);
  for (int d = 0; d < 3; ++d) x[d] = g.lo[d] + (0.2 + 0.31 * d) * g.h(d);
  return x;
}

/// Particles that stay where they are and note what a step does to them.
class Noting : public ParticlesOf<Backend::ParticleVector> {
 public:
  using Vector = Backend::ParticleVector;

  /// Without `force` there are no forces.
  Noting(const std::vector<double> &x, const std::vector<double> &torque,
         const std::vector<double> &force = {}) :
      n_(bdh::ssize(x) / 3),
      id_(counted(x.size() / 3))
  {
    Access<Backend>::put(x, x_);
    Access<Backend>::put(force.empty() ? std::vector<double>(x.size(), 0.0) : force, force_);
    Access<Backend>::put(torque, torque_);
  }
  long size() const override { return n_; }
  const double *x() const override { return x_.data(); }
  const double *force() const override { return force_.data(); }
  const double *torque() const override { return torque_.data(); }
  const uint64_t *ids() const override { return id_.data(); }
  void move_and_update_forces(Vector &displacement, Vector *rotation) override
  {
    half_turn = rotation ? Access<Backend>::get(*rotation) : std::vector<double>();
    start_ = Access<Backend>::get(x_);
    std::vector<double> x = start_, moved = Access<Backend>::get(displacement);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += moved[i];
    Access<Backend>::put(x, x_);
  }
  void finish(const Vector &, const Vector &of_step) override
  {
    velocity = Access<Backend>::get(of_step);
    if (!start_.empty()) Access<Backend>::put(start_, x_);
  }
  void turn(const Vector &rotation, const Vector &angular_velocity) override
  {
    last_turn = Access<Backend>::get(rotation);
    omega = Access<Backend>::get(angular_velocity);
  }

  std::vector<double> velocity, half_turn, last_turn, omega;

 private:
  long n_;
  std::vector<uint64_t> id_;
  Vector x_, force_, torque_;
  std::vector<double> start_;
};

}    // namespace

#endif
