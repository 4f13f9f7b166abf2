// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Spreading and interpolation with the window of the non-uniform Fourier transform: S and S^T of
/// PSE sec. II B 2.
#ifndef BDH_PSE_WINDOW_SPREAD_H
#define BDH_PSE_WINDOW_SPREAD_H

#include "grid/sorted_particles.h"
#include "pse/window.h"

#include <array>

namespace bdh {

/// The grid in fractional coordinates, on which a cell of any shape is the unit cube.
Grid fractional_grid(const std::array<long, 3> &n);

/// Moves three components at once between particles and one slab of a grid whose points lie at the
/// corners of the cells.
///
/// Positions are fractional, so that a triclinic cell costs nothing.  interpolate() is the adjoint
/// of spread(): the same weights in the same order, sum_i F_i.(S^T v)_i = sum_points v.(S F). Real:
/// precision of the grid and of the weights; positions, forces and velocities are double.
template <class Real> class WindowSpreader {
 public:
  using View = std::array<Real *, 3>;    ///< layout of VectorFft

  /// n: grid points per axis, at least the window's width.  error: of the window's polynomials,
  /// relative to 1.
  WindowSpreader(const std::array<long, 3> &n, const Slab &slab, const Window &window, double error,
                 const Workers &workers = Workers::one());

  /// Lowest line of an axis that a particle at fractional coordinate s touches, and how many at
  /// most.
  long first_line(int axis, double s) const;
  long reach() const { return window_.width(); }

  /// s: fractional coordinates, 3 n, any periodic image.  Copied.  Throws BadParticle.
  void bind(const double *s, long n);
  /// field_c(m) += sum_i F_ic w(m - x_i)
  void spread(const double *force, const View &field) const;
  /// u_ic (3 n) := sum_m w(m - x_i) field_c(m), this slab's part.
  void interpolate(const View &field, double *velocity) const;

  int degree() const { return window_.degree(); }
  std::size_t memory() const { return particles_.memory(); }

 protected:
  WindowPolynomials window_;
  std::array<Real, 25 * 16> coefficient_;
  GridParticles particles_;

 private:
  template <int W> struct Loops;
  template <class Action> void dispatch(Action action) const;
};

}    // namespace bdh
#endif
