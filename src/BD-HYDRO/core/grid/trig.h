// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Transforms that diagonalise the Laplacian of each velocity component between any walls.
///
/// The Laplacian of a component is a sum over the axes, and on each axis a real transform
/// diagonalises it: Fourier (periodic), sine (the component's own faces between walls; no-slip),
/// cosine (free-slip) or the mixed ones.  The transforms of different components differ, so
/// pressure and velocity do not decouple here: see stokes/box.h.
#ifndef BDH_GRID_TRIG_H
#define BDH_GRID_TRIG_H

#include "base/comm.h"
#include "base/workers.h"
#include "grid/fft.h"
#include "grid/grid.h"

#include <functional>
#include <memory>
#include <vector>

namespace bdh {

/// Modes of one axis, by their place in the transformed array.
struct AxisModes {
  /// Eigenvalue of minus the second difference [1/length^2].
  std::vector<double> eigenvalue;
  /// Squared norm of the basis vector relative to that of most; 0 where there is no unknown.
  std::vector<double> weight;
};

AxisModes axis_modes(const Grid &grid, int component, int axis);

/// The transforms along one axis as matrices: out[k] = sum over j of m[j * n + k] in[j].  Entries
/// without an unknown are 0.
struct AxisMatrices {
  std::vector<double> forward, backward;
};
AxisMatrices axis_matrices(const Grid &grid, int component, int axis);

/// The factor by which forward and backward transforms of all axes multiply a field.
double transform_norm(const Grid &grid);

/// The transforms of a field with walls.  Its layout is that of VectorFft: rows padded to 2
/// grid.half(), planes of the slow axis in slabs.  In mode space a component is [n of the slow
/// axis][columns of this rank], where a column is a place of a padded plane.
class WalledTransforms {
 public:
  static constexpr long widest = 64;    ///< most columns of a block
  using Change = std::function<void(const Slab &)>;

  /// Collective.
  WalledTransforms(const Grid &grid, const Comm &comm, FftEffort effort,
                   const Workers &workers = Workers::one());
  ~WalledTransforms();

  /// Slabs.
  const GridParts &parts() const;
  std::size_t allocation() const;
  /// Places of a plane that this rank has in mode space.
  Slab columns() const;
  const AxisModes &modes(int component, int axis) const;
  /// Collective.  In place: transforms all components forward, calls change(block) for blocks that
  /// make up the columns of this rank (from 0), each of at most `widest` columns with all their
  /// planes, and transforms backward; not normalised. With several workers change() is called for
  /// different blocks at the same time.
  void solve(const std::array<double *, 3> &field, const Change &change);
  std::size_t memory() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}    // namespace bdh
#endif
