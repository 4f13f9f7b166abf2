// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Lanczos process for the square root of a symmetric positive definite operator.
/// [Chow & Saad, SIAM J. Sci. Comput. 36]
///
///     A V = V T + ...,   A^(1/2) z ~ |z| V T^(1/2) e_1
///
/// V is orthonormal, so the change from one iteration to the next is known from T alone: the stop
/// rule costs no vector operation, and the result does not depend on earlier calls.
#ifndef BDH_BASE_LANCZOS_H
#define BDH_BASE_LANCZOS_H

#include "base/bytes_of.h"
#include "base/errors.h"
#include "base/execution.h"
#include "base/portable.h"
#include "base/ssize.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace bdh {

struct LanczosOptions {
  /// |A^(1/2) z - result| may be at most |z| times this.  It has the units of A^(1/2).
  double error = 1e-3;
  int limit = 100;    ///< iterations; reaching it throws NotConverged
  /// Eigenvalues down to -slack * largest are errors of the operator, and count as 0.
  double slack = 0.0;
};

struct LanczosReport {
  int iterations = 0;
  double error = 0.0;    ///< the estimate of LanczosOptions::error
};

/// The tridiagonal matrix T of the process, and T^(1/2) e_1.
class Tridiagonal {
 public:
  void clear();
  /// alpha is the next diagonal entry.  beta is the entry next to it, in the next column.
  void add(double alpha, double beta);
  int size() const { return alpha_.size(); }
  double beta(int i) const { return beta_[i]; }
  /// coefficients := T^(1/2) e_1.  Eigenvalues below 0 by no more than slack * largest count as 0,
  /// and others throw NotConverged: the operator is not positive.
  void root(double slack, std::vector<double> &coefficients) const;

 private:
  std::vector<double> alpha_, beta_;
};

/// Vectors of the process are kept from call to call, so that steps allocate nothing.
///
/// Operator is the type of A and has
///     apply(v, u)    u := A v; it may change v beyond size()
///     size()         the entries of a vector on this rank
///     full_size()    the same with room for ghosts
///     sum(double)    the sum over all ranks
///     Vector         a contiguous vector with data() and resize()
/// Execution is that of the place where the vectors are (base/execution.h).
template <class Operator, class Execution = HostExecution> class LanczosRoot {
 public:
  using Vector = typename Operator::Vector;
  using Real = typename Vector::value_type;

  explicit LanczosRoot(const Execution &execution = Execution()) : execution_(execution) {}

  /// Collective.  result := A^(1/2) z.  Both have size() entries.
  LanczosReport apply(Operator &A, const Vector &z, const LanczosOptions &options, Vector &result)
  {
    const std::size_t size = A.size();
    T_.clear();
    const double length = std::sqrt(A.sum(execution_.dot(z.data(), z.data(), size)));
    result.resize(size);
    if (length == 0.0) {
      execution_.scale(Real(1), z.data(), result.data(), size);
      return {};
    }
    LanczosReport report;
    execution_.scale(static_cast<Real>(1.0 / length), z.data(), basis(0, A.full_size()).data(),
                     size);
    std::vector<double> now, before;
    double last_change = 0.0, last_ratio = 0.0;
    while (true) {
      const int m = T_.size();
      if (m == options.limit) throw NotConverged("Lanczos", m, report.error, options.error);
      step(A, m);
      before.swap(now);
      // Particles at the same place give an eigenvalue 0, which is computed with the errors of the
      // operator.
      T_.root(std::max({options.error, options.slack, 1000.0 * rounding}), now);
      const double change = distance(now, before);
      report.iterations = m + 1;
      // Changes fall about geometrically.  The error is the sum of those that are still to come,
      // estimated as a geometric series with the slower one of the last two ratios, and doubled,
      // since the ratios rise towards the end.
      const double ratio = m > 0 && last_change > 0.0 ? std::min(0.99, change / last_change) : 0.9;
      const double slow = std::max(ratio, m > 1 ? last_ratio : ratio);
      report.error = T_.beta(m) == 0.0 ? 0.0 : 2.0 * change * slow / (1.0 - slow);
      last_change = change;
      last_ratio = ratio;
      if (m > 0 && report.error <= options.error) break;
      if (T_.beta(m) == 0.0) break;
    }
    for (double &c : now) c *= length;
    execution_.combine(now, basis_, result.data(), size);
    return report;
  }

  std::size_t memory() const { return bytes_of(basis_, product_); }

 private:
  /// Computes column m of T and vector m + 1 of the basis.
  void step(Operator &A, int m)
  {
    const std::size_t size = A.size();
    A.apply(basis_[m], product_);
    Real *w = product_.data();
    const Real *v = basis_[m].data(), *u = m > 0 ? basis_[m - 1].data() : v;
    const double alpha = A.sum(execution_.dot(v, w, size)), last = m > 0 ? T_.beta(m - 1) : 0.0;
    execution_.subtract(static_cast<Real>(alpha), v, static_cast<Real>(last), u, w, size);
    // What is left of an invariant subspace is round-off.
    const double beta = std::sqrt(A.sum(execution_.dot(w, w, size))),
                 scale_of_T = std::fabs(alpha) + last;
    const bool finished = beta <= 8.0 * rounding * scale_of_T;
    T_.add(alpha, finished ? 0.0 : beta);
    if (!finished)
      execution_.scale(static_cast<Real>(1.0 / beta), w, basis(m + 1, A.full_size()).data(), size);
  }

  Vector &basis(int m, std::size_t full_size)
  {
    if (ssize(basis_) <= m) basis_.resize(m + 1);
    basis_[m].resize(full_size);
    return basis_[m];
  }

  /// |a - b|, where zeros follow the shorter one.
  static double distance(const std::vector<double> &a, const std::vector<double> &b)
  {
    double s = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double d = a[i] - (i < b.size() ? b[i] : 0.0);
      s += d * d;
    }
    return std::sqrt(s);
  }

  static constexpr double rounding = sizeof(Real) == 4 ? 6e-8 : 1.1e-16;
  Execution execution_;
  Tridiagonal T_;
  std::vector<Vector> basis_;
  Vector product_;
};

}    // namespace bdh
#endif
