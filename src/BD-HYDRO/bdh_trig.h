/// Transforms that diagonalise the Laplacian of each velocity component between any walls.
///
/// The Laplacian of a component is a sum over the axes, and on each axis a real transform diagonalises it: Fourier
/// (periodic), sine (the component's own faces between walls; no-slip), cosine (free-slip) or the mixed ones.  The
/// transforms of different components differ, so pressure and velocity do not decouple here: see bdh_box.h.
#ifndef BDH_TRIG_H
#define BDH_TRIG_H

#include "bdh_comm.h"
#include "bdh_fft.h"
#include "bdh_types.h"

#include <memory>
#include <vector>

namespace bdh {

/// Modes of one axis, by their place in the transformed array.
struct AxisModes {
  std::vector<double> eigenvalue;    ///< of minus the second difference [1/length^2]
  std::vector<double> weight;        ///< squared norm of the basis vector over that of most; 0: no unknown here
};

/// Fields as VectorFft has them: rows padded to 2 grid.half(), planes of the slow axis in slabs.  In mode space a
/// component is [n of the slow axis][columns of this rank], a column being a place of a padded plane.
class WalledTransforms {
 public:
  /// Collective.
  WalledTransforms(const Grid &grid, const Comm &comm, FftEffort effort);
  ~WalledTransforms();

  Slab slab() const;
  std::size_t allocation() const;
  /// Places of a plane that this rank has in mode space.
  Slab columns() const;
  const AxisModes &modes(int component, int axis) const;
  /// What backward(forward(f)) multiplies f by.
  double norm() const;
  /// Collective.  In place, not normalised.
  void forward(int component, double *field);
  void backward(int component, double *field);
  std::size_t memory() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}    // namespace bdh
#endif
