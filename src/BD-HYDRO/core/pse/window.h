// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The Kaiser-Bessel window of the non-uniform Fourier transform, and its transform.
///
///     w(u)      = I_0(beta sqrt(1 - (2u/W)^2)) / I_0(beta),  |u| <= W/2
///
///     w^(kappa) = W sinh(s) / (s I_0(beta)),  s = sqrt(beta^2 - (kappa W/2)^2)
///
/// with u in units of the grid spacing and kappa in their inverse.  Its transform is known in
/// closed form, so the deconvolution is exact; among windows of W lines it is within a few per cent
/// of the best [Jackson et al., IEEE Trans. Med. Imaging 10, 473 (1991)].  It ends with a step of
/// 1/I_0(beta) at |u| = W/2, which the gradient of a torque would turn into an error of that size.
/// The continuous window is without it: I_0(beta) - 1 takes the place of I_0(beta), sinh(s)/s -
/// sin(kappa W/2)/(kappa W/2) that of sinh(s)/s, and so on.
#ifndef BDH_PSE_WINDOW_H
#define BDH_PSE_WINDOW_H

#include "base/aligned.h"

#include <vector>

namespace bdh {

struct Window {
  int width = 4;        ///< W: grid lines per axis under a particle, least .. greatest()
  double beta = 8.0;    ///< larger: faster decay beyond the first aliases, wider main lobe
  bool continuous = false;

  static constexpr int least = 2;
  /// single: on a grid in single precision, whose rounding exceeds the error of wider windows.
  static constexpr int greatest(bool single) { return single ? 12 : 16; }
  /// Above 8 points only even ones: each width takes seconds to compile, and there the step from
  /// one to the next is small.
  static constexpr bool is_width(int width, bool single)
  {
    return width >= least && width <= greatest(single) && (width <= 8 || width % 2 == 0);
  }
  double value(double u) const;
  /// kappa: wavenumber times spacing
  double transform(double kappa) const;
  /// transform() up to a factor, which ratios do not need: w^(kappa + 2 pi m)/w^(kappa) is the
  /// error of mode kappa by its image at kappa + 2 pi m.
  double shape(double kappa) const;

 private:
  double step() const { return continuous ? 1.0 : 0.0; }
};

/// The window as one polynomial per line: what the spreading loops evaluate.
///
/// A particle at x (in spacings) touches the lines first .. first + W - 1 with first = ceil(x -
/// W/2); with t = 2 (first - x + W/2) - 1 in [-1, 1) the weight of line first + i is sum_k
/// coefficient(k, i) t^k.
class WindowPolynomials {
 public:
  /// error: largest difference from the window that is allowed, relative to its maximum 1.
  WindowPolynomials(const Window &window, double error);
  int width() const { return width_; }
  int degree() const { return degree_; }
  /// Coefficients of all lines, highest power first: [degree + 1][W].
  const std::vector<double> &coefficients() const { return coefficients_; }
  /// Largest difference that was found.
  double error() const { return error_; }

 private:
  void fit(const Window &window, int degree);

  int width_, degree_ = 0;
  double error_ = 0.0;
  std::vector<double> coefficients_;
};

}    // namespace bdh
#endif
