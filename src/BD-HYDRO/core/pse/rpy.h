// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The real-space part of the split RPY mobility: exact values, and a table for inner loops.
#ifndef BDH_PSE_RPY_H
#define BDH_PSE_RPY_H

#include "pse/rpy_kernel.h"
#include "pse/splitting_kernel.h"

#include <cstddef>
#include <vector>

namespace bdh {

/// F and G of PSE (A1), normalised by 1/(6 pi viscosity a).
/// \param r   distance [length], 0 gives the self term
/// \param a   radius [length];  xi: splitting parameter [1/length]
/// Errors, measured against 70 digits for xi a = 1e-6 ... 20: at most 1.1e-15 for every r >= 0, and
/// where xi (r - 2a) > 2 also at most 5e-9 of the value itself, so that tails can be summed and
/// integrated.
RpyPair real_space_exact(double r, double a, double xi);

/// The real-space part with either splitting, for r up to the cutoff; normalised as above.
class RealSpacePart {
 public:
  /// Hasimoto's, whose part goes on beyond any cutoff.  a [length];  xi [1/length]
  RealSpacePart(double a, double xi) : a_(a), xi_(xi) {}
  /// r_cut [length].  Errors: at most 5e-15 for r < 2 r_cut.
  RealSpacePart(double a, const KaiserBesselSplit &split, double r_cut);

  /// r >= 0 [length], 0 gives the self term.
  RpyPair operator()(double r) const;
  double self() const { return (*this)(0.0).transverse; }
  double radius() const { return a_; }

 private:
  double a_, xi_ = 0.0;
  /// Wave numbers of a quadrature [1/a], and 3/pi W dk.
  std::vector<double> k_, weight_;
};

/// The table of RealSpaceTable as loops read it; in the memory of a device, when it is copied
/// there.
template <class Real> struct RealSpacePolynomials {
  const Real *coefficients;    ///< of intervals: F and G - F by turns, highest power first, of u =
                               ///< r/width - i - 1/2
  Real inv_width;
  /// From here on intervals are wider, with u = (r - near_end)/width - i - 1/2.
  Real near_end, inv_far_width;
  int near_intervals;
  int degree;    ///< low_degree or high_degree

  // With both functions, 4 and 8 coefficients fill 32, 64 or 128 bytes: no interval straddles a
  // cache line.
  static constexpr int low_degree = 3, high_degree = 7;

  /// transverse := F(r), difference := G(r) - F(r), for 0 <= r <= r_cut, which is not checked.
  BDH_FN void evaluate(Real r, Real &transverse, Real &difference) const
  {
    const Real place =
        r < near_end ? r * inv_width : near_intervals + (r - near_end) * inv_far_width;
    const int interval = static_cast<int>(place);
    const Real u = place - interval - Real(0.5);
    if (degree == low_degree)
      horner<low_degree>(interval, u, transverse, difference);
    else
      horner<high_degree>(interval, u, transverse, difference);
  }

 private:
  template <int D>
  BDH_FN void horner(long interval, Real u, Real &transverse, Real &difference) const
  {
    const Real *c = coefficients + interval * 2 * (D + 1);
    Real p = c[0], q = c[1];
    for (int m = 1; m <= D; ++m) {
      p = p * u + c[2 * m];
      q = q * u + c[2 * m + 1];
    }
    transverse = p;
    difference = q;
  }
};

/// F and G - F as functions of r in [0, r_cut]: polynomials on intervals of equal width, one of
/// whose ends is 2a, where the second derivative of F jumps and the third of G.  Those of a long
/// cutoff are wider far away, where both functions change over distances like r.  Immutable;
/// `evaluate` may be called by many threads.
template <class Real> class RealSpaceTable {
 public:
  /// \param a, r_cut  [length];  xi [1/length]
  /// \param error     largest absolute error of F and of G - F, normalised by 1/(6 pi viscosity a);
  /// round-off of
  ///                  `evaluate` included, that of r itself not.  At least smallest_error().
  RealSpaceTable(double a, double xi, double r_cut, double error);
  RealSpaceTable(const RealSpacePart &part, double r_cut, double error);

  /// See RealSpacePolynomials.
  void evaluate(Real r, Real &transverse, Real &difference) const
  {
    polynomials().evaluate(r, transverse, difference);
  }
  RealSpacePolynomials<Real> polynomials() const
  {
    return {lines_.front().c, inv_width_, near_end_, inv_far_width_, near_intervals_, degree_};
  }
  /// Numbers behind polynomials().coefficients.
  std::size_t coefficient_count() const { return lines_.size() * (sizeof(Line) / sizeof(Real)); }

  double cutoff() const { return cutoff_; }
  int degree() const { return degree_; }
  int intervals() const { return intervals_; }
  /// Bytes of the coefficients.
  std::size_t memory() const { return lines_.size() * sizeof(Line); }
  static constexpr double smallest_error() { return sizeof(Real) < sizeof(double) ? 5e-7 : 1e-14; }

 private:
  static constexpr int low_degree = RealSpacePolynomials<Real>::low_degree,
                       high_degree = RealSpacePolynomials<Real>::high_degree;
  struct alignas(64) Line {
    Real c[64 / sizeof(Real)];
  };

  bool build(const RealSpacePart &part, double error, int degree, std::size_t limit);

  std::vector<Line> lines_;
  Real inv_width_ = 0, near_end_ = 0, inv_far_width_ = 0;
  int degree_ = low_degree, near_intervals_ = 0, intervals_ = 0;
  double cutoff_ = 0.0;
};

extern template class RealSpaceTable<float>;
extern template class RealSpaceTable<double>;

}    // namespace bdh
#endif
