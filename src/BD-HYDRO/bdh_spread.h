/// Spreading and interpolation between particles and the staggered grid: FIB sec. III A, S and J.
#ifndef BDH_SPREAD_H
#define BDH_SPREAD_H

#include "bdh_types.h"

#include <array>
#include <string>
#include <vector>

namespace bdh {

enum class IbKernel { roma3, peskin4, bkp6 };

/// Grid lines per axis under a particle: 3, 4 or 6.
int kernel_width(IbKernel kernel);
const char *kernel_name(IbKernel kernel);
/// Throws InvalidOption for an unknown name.
IbKernel kernel_from_name(const std::string &name);
/// Hydrodynamic radius over spacing, mean over positions in the cell: from the self-mobility in large periodic boxes,
/// mu = (1 - 2.8373 a/L + 4.19 (a/L)^3 - 27.4 (a/L)^6)/(6 pi eta a), in 2D mu = ln(L/3.708 a)/(4 pi eta).
double radius_over_spacing(IbKernel kernel, int dim);
/// Half the spread of that radius over positions, relative.
double radius_spread(IbKernel kernel, int dim);

/// Arrays of a staggered vector field on this rank's slab; layout of VectorFft.
using FieldView = std::array<double *, 3>;

/// Throws BadParticle for the first position (of 3 n) that is not finite or too far away to have a cell.
void check_positions(const Grid &grid, const double *x, long n);

/// Where the grid lines of each axis begin in this rank's arrays, also for lines that are periodic images.
class GridLines {
 public:
  GridLines(const Grid &grid, const Slab &slab);
  /// Offsets of line i and of those after it; -1: not in this slab.
  const long *at(int axis, long i) const { return offset_[axis].data() + i + margin; }
  long columns() const { return columns_; }
  /// Doubles from one row, one plane to the next.  In 2D a plane of the slow axis is one row.
  long row() const { return row_; }
  long plane() const { return plane_; }

  /// Lines beyond either end of an axis: what a kernel of six points, shifted by half a spacing, may touch.
  static constexpr long margin = 4;

 private:
  std::vector<long> offset_[3];
  long columns_, row_, plane_;
};

/// J and S on one slab, for a set of particles.
///
/// bind() sorts the particles into tiles of rows, plane after plane, so that the loops below walk through the grid
/// once with the planes under the kernel in the second-level cache.
/// spread() is the exact adjoint of interpolate(): the same weights in the same order,
/// sum_i F_i.(J v)_i = dV sum_faces v.(S F).
class HostSpreader {
 public:
  HostSpreader(const Grid &grid, const Slab &slab, IbKernel kernel);

  /// Lowest plane of the slow axis that a particle at coordinate x touches, and how many at most.
  long first_plane(double x_slow) const;
  long plane_reach() const { return width_ + 1; }

  /// x: 3 n, anywhere in space (periodic).  Copied.  Requires check_positions().
  void bind(const double *x, long n);
  /// field += S F + kT div_q S: force 3 n [force]; drift_kT [energy], 0 leaves the thermal drift out.
  /// The drift is exact: S is diagonal in the component, so on faces of component d it is kT times the derivative
  /// along d of the particle's weight (in place of FIB eq. (37)).
  void spread(const double *force, double drift_kT, const FieldView &field) const;
  /// velocity: 3 n, := this slab's part of J v.
  void interpolate(const FieldView &field, double *velocity) const;

  std::size_t memory() const;

 private:
  struct Impl;
  struct ReadAhead;
  void scale(const double *x, long n);
  void count_keys(long n);

  Grid grid_;
  Slab slab_;
  IbKernel kernel_;
  int width_;
  GridLines lines_;
  long tile_rows_;
  AlignedVector scaled_[3];     // in units of the spacing from the lower corner, within the box
  AlignedVector x_[3];          // the same, sorted
  std::vector<int> original_;   // place in the caller's arrays
  std::vector<int> key_, bin_;  // work space of the sort
};

}    // namespace bdh
#endif
