// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Particles in a fluid without time steps: the mobility, column by column, and its divergence.
#ifndef BDH_TEST_SUSPENSION_H
#define BDH_TEST_SUSPENSION_H

#include "fib/fluid.h"
#include "support/test_support.h"

#include <Eigen/Dense>
#include <vector>

namespace bdh_test {

inline bdh::StokesProblem quiet(double viscosity, double tolerance = 1e-8)
{
  bdh::StokesProblem p;
  p.viscosity = viscosity;
  p.tolerance = tolerance;
  return p;
}

/// A fluid with particles that J and S are bound to.  All arguments and results are whole arrays of
/// 3 n numbers, the same on every rank.
template <class Backend> class Suspension {
 public:
  Suspension(const bdh::Grid &g, bdh::IbKernel kernel, const bdh::Comm &comm,
             const std::vector<double> &x) :
      n_(x.size() / 3),
      comm_(comm), deal_(n_, comm), fluid_(g, kernel, bdh::FftEffort::estimate, comm)
  {
    bind(x);
  }
  void bind(const std::vector<double> &x)
  {
    const std::vector<double> mine = deal_.take(x);
    fluid_.bind(mine.data(), bdh::ssize(deal_.mine));
  }
  /// J (L^-1/eta (S F + kT div S) + noise)
  std::vector<double> velocity(const std::vector<double> &force, const bdh::StokesProblem &problem,
                               double kT = 0.0)
  {
    fluid_.clear();
    fluid_.spread(deal_.take(force).data(), kT);
    fluid_.solve(problem);
    return interpolated();
  }
  std::vector<double> interpolated()
  {
    std::vector<double> u(3 * deal_.mine.size(), NAN);
    fluid_.interpolate(u.data());
    return deal_.gather(u, n_, comm_);
  }
  bdh::FibFluid<Backend> &fluid() { return fluid_; }

 private:
  long n_;
  bdh::Comm comm_;
  Deal deal_;
  bdh::FibFluid<Backend> fluid_;
};

/// M as a matrix with dim n rows.
template <class Backend> Eigen::MatrixXd dense_mobility(const bdh::Grid &g, bdh::IbKernel kernel,
                                                        const std::vector<double> &x,
                                                        double viscosity = 1.0,
                                                        double tolerance = 1e-8)
{
  const long n = x.size() / 3, size = g.dim * n;
  Suspension<Backend> s(g, kernel, world(), x);
  Eigen::MatrixXd M(size, size);
  for (long column = 0; column < size; ++column) {
    std::vector<double> unit(x.size(), 0.0);
    unit[3 * (column / g.dim) + column % g.dim] = 1.0;
    const std::vector<double> u = s.velocity(unit, quiet(viscosity, tolerance));
    for (long row = 0; row < size; ++row) M(row, column) = u[3 * (row / g.dim) + row % g.dim];
  }
  return M;
}

/// (div M)_id = sum_je d M_id,je / d q_je by the chain rule, without the thermal drift of a step.
/// J L^-1 div S is exact; the derivative of J is a central difference at fixed flow.
template <class Backend>
std::vector<double> divergence_of_mobility(const bdh::Grid &g, bdh::IbKernel kernel,
                                           double viscosity, const std::vector<double> &x,
                                           double tolerance = 1e-8)
{
  const double step = 1e-5 * g.h(0);
  Suspension<Backend> s(g, kernel, world(), x);
  std::vector<double> none(x.size(), 0.0);
  std::vector<double> div = s.velocity(none, quiet(viscosity, tolerance), 1.0);
  for (std::size_t je = 0; je < x.size(); ++je) {
    if (int(je % 3) >= g.dim) continue;
    std::vector<double> unit = none, moved = x;
    unit[je] = 1.0;
    s.bind(x);
    s.velocity(unit, quiet(viscosity, tolerance));
    moved[je] += step;
    s.bind(moved);
    const std::vector<double> up = s.interpolated();
    moved[je] -= 2.0 * step;
    s.bind(moved);
    const std::vector<double> down = s.interpolated();
    const std::size_t j = je / 3;
    for (std::size_t d = 0; d < 3; ++d)
      div[3 * j + d] += (up[3 * j + d] - down[3 * j + d]) / (2.0 * step);
  }
  return div;
}

}    // namespace bdh_test
#endif
