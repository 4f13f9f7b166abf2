// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Spreading and interpolation between particles and the staggered grid: FIB sec. III A, S and J.
#ifndef BDH_FIB_SPREAD_H
#define BDH_FIB_SPREAD_H

#include "base/portable.h"
#include "grid/field.h"
#include "grid/slabs.h"
#include "grid/sorted_particles.h"

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace bdh {

enum class IbKernel { roma3, peskin4, bkp6 };

/// Grid lines per axis under a particle: 3, 4 or 6.
int kernel_width(IbKernel kernel);
/// Rows that a grid needs beyond an open face of the box: under the kernel of a particle at the
/// face, or up to half a spacing beyond it, and half a row that no kernel may touch.
int rows_beyond(IbKernel kernel);
const char *kernel_name(IbKernel kernel);
/// Throws InvalidOption for an unknown name.
IbKernel kernel_from_name(const std::string &name);
/// Hydrodynamic radius a over spacing, mean over positions in the cell.  It follows from the
/// self-mobility in large periodic boxes of side L,
///     mu = (1 - 2.8373 a/L + 4.19 (a/L)^3 - 27.4 (a/L)^6)/(6 pi eta a),
///     mu = ln(L/3.708 a)/(4 pi eta) in 2D.
double radius_over_spacing(IbKernel kernel, int dim);
/// Hydrodynamic radius [length] of the kernel at the geometric mean of the spacings.
double hydrodynamic_radius(IbKernel kernel, const Grid &grid);
/// Half the spread of that radius over positions, relative to the radius.
double radius_spread(IbKernel kernel, int dim);
/// The same for the rotational radius, from the mobility in a periodic box of volume V,
///     mu = (1/a^3 - 4 pi/(3 V))/(8 pi eta),      mu = (1/a^2 - pi/V)/(4 pi eta) in 2D.
double rotational_radius_over_spacing(IbKernel kernel, int dim);
double rotational_radius(IbKernel kernel, const Grid &grid);
double rotational_radius_spread(IbKernel kernel, int dim);
/// The radii of the spheres whose resistance to strain is that of a particle, from the mobility
/// E = 3 S/(20 pi eta a^3) in a large periodic box.  A grid resists shear along its axes a little
/// less than stretching.
struct StressletRadii {
  double shear, stretching;
  /// That of the mean mobility of the five modes, three of which are shears.
  double mean() const;
};
StressletRadii stresslet_radii(IbKernel kernel, const Grid &grid);
/// Name of the kernel of torques and angular velocities; see fib/turning_kernel.h.
const char *turning_kernel_name(IbKernel kernel);

/// Lines per axis that kernels of particles span, the one of torques included where it is used.
int kernel_span(IbKernel kernel, bool turns);

/// The lowest line of an axis that a particle touches: the first one of the centres.  Those of the
/// faces begin there or one later, so that a kernel of `span` lines reaches span + 1 lines.
struct FirstLine {
  const double *x;    ///< positions (3 n), of any periodic image
  int axis;
  double lo, h, below;
  FirstLine(const Grid &grid, int line_axis, int span, const double *positions) :
      x(positions), axis(line_axis), lo(grid.lo[axis]), h(grid.h(axis)), below(0.5 * (span - 1))
  {}
  BDH_FN long operator()(long i) const
  {
    return static_cast<long>(std::floor((x[3 * i + axis] - lo) / h - below));
  }
};

/// The same for the planes of the slow axis and the rows along y.
inline FirstLines<FirstLine, FirstLine> first_lines(const Grid &grid, int span, const double *x)
{
  return {{grid, grid.slow_axis(), span, x}, {grid, 1, span, x}};
}

struct WallImages;

/// J and S on one slab, for a set of particles.
///
/// A kernel that reaches over a wall is folded back by images.  The weight is that minus the
/// mirrored weight at a no-slip wall, so that M goes to 0 there.  At a free-slip wall it is the sum
/// for the tangential components, as in the mirrored periodic box.  spread() is the exact adjoint
/// of interpolate(): the same weights in the same order, sum_i F_i.(J v)_i = dV sum_faces v.(S F).
///
/// Real: the type of the grid's numbers and of the weights, which come from positions within a cell
/// in double.  Everything of particles is double.
template <class Real> class HostSpreader {
 public:
  /// turns: torques and angular velocities are wanted, too, or stresslets and rates of strain.
  HostSpreader(const Grid &grid, const Slab &slab, IbKernel kernel,
               const Workers &workers = Workers::one(), bool turns = false);
  ~HostSpreader();

  /// The lowest lines that particles at x (3 n) touch, and the largest number of planes, or rows,
  /// that one touches.
  FirstLines<FirstLine, FirstLine> first_lines(const double *x) const
  {
    return bdh::first_lines(grid_, width_, x);
  }
  long reach() const { return width_ + 1; }

  /// Copies the positions x (3 n).  They may be anywhere in space along a periodic axis, and
  /// between the walls along others.  Requires check_positions().
  void bind(const double *x, long n) { particles_.bind(x, n); }
  /// field += S F + kT div_q S, with F in `force` (3 n) [force] and kT in drift_kT [energy], where
  /// 0 leaves the thermal drift out.  The drift is exact: S is diagonal in the component, so on
  /// faces of component d it is kT times the derivative along d of the particle's weight (in place
  /// of FIB eq. (37)).
  void spread(const double *force, double drift_kT, const FieldOf<Real> &field) const;
  /// field += the divergence of S with energies of each particle's own, 3 n of them; for particles
  /// of which some do not move.
  void spread_drift(const double *kT, const FieldOf<Real> &field) const;
  /// velocity (3 n) := this slab's part of J v.
  void interpolate(const FieldOf<Real> &field, double *velocity) const;
  /// field += half the discrete curl of the kernel times the torques (3 n) [force length]; see
  /// fib/turning_kernel.h.
  void spread_torque(const double *torque, const FieldOf<Real> &field) const;
  /// omega (3 n) := this slab's part of the angular velocities [1/time]; in 2D the first two
  /// numbers are 0.  The exact adjoint of spread_torque().
  void angular_velocity(const FieldOf<Real> &field, double *omega) const;
  /// In 3D.  field -= divergence of the kernel times the stresslets (strain_numbers per particle,
  /// first moments of the force on the fluid) [force length].
  void spread_stresslet(const double *stresslet, const FieldOf<Real> &field) const;
  /// strain (strain_numbers per particle) := this slab's part of the average rates of strain
  /// [1/time], the exact adjoint of spread_stresslet(); omega (3 n) := what angular_velocity()
  /// gives, from the same differences.
  void gradient(const FieldOf<Real> &field, double *strain, double *omega) const;

  std::size_t memory() const { return particles_.memory(); }

 private:
  struct Impl;

  Grid grid_;
  IbKernel kernel_;
  int width_;
  GridParticles particles_;
  std::unique_ptr<WallImages> images_[3];    // null: periodic
};

extern template class HostSpreader<double>;

}    // namespace bdh
#endif
