/// Transforms of a staggered vector field, fused with the work in wave space.
///
/// A field has one real array per component, x fastest, in planes of the slow axis (z, in 2D y) that are dealt to the
/// ranks in slabs; rows are padded to 2 (n_x/2 + 1) for the in-place transform.  solve() goes: transform the planes,
/// hand the slow axis over (MPI: a rank gives parts of its planes for all planes of its own part), and then for one
/// block of columns at a time transform the slow axis, let the caller change the modes, and transform back while the
/// block is still in cache.  The slow axis thus costs one pass over memory instead of three; on one core a
/// solve without noise takes 0.9 of FFTW's own six 3D transforms at 128^3 and 1.1 at 64^3 (bench/README.md).
#ifndef BDH_FFT_H
#define BDH_FFT_H

#include "bdh_comm.h"
#include "bdh_types.h"

#include <functional>
#include <memory>

namespace bdh {

/// Modes that lie together: row s holds index s of the slow axis, `columns` modes along x starting at `first_x`.
struct ModeBlock {
  std::array<double *, 3> f;    ///< per component: complex numbers, interleaved, row-major [rows][columns]
  long rows, columns;
  long first_x;                 ///< index along x of column 0
  long y;                       ///< index along y in 3D; in 2D y is the slow axis and this is 0
};

/// `estimate` makes the same plan in every run, so that a run repeats bit for bit; `measure` is faster, up to twice
/// for sizes that are not powers of two, and plans for a second or two.
enum class FftEffort { estimate, measure };

class VectorFft {
 public:
  /// Collective.
  VectorFft(const Grid &grid, const Comm &comm, FftEffort effort);
  ~VectorFft();

  Slab slab() const;
  /// Doubles that each component's array must have (aligned to 64 bytes).
  std::size_t allocation() const;
  /// Collective.  Forward transforms, change(block) for every mode once, backward; not normalised.
  void solve(const std::array<double *, 3> &field, const std::function<void(const ModeBlock &)> &change);
  std::size_t memory() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Smallest integer >= n whose only prime factors are 2, 3, 5, 7: sizes at which FFTW is fast.
long next_fast_size(long n);

}    // namespace bdh
#endif
