// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Transforms of a vector field on a grid, fused with the work in wave space.
///
/// A field has one real array per component, x fastest, in planes of the slow axis (z, in 2D y)
/// that are dealt to the ranks in slabs; rows are padded to 2 (n_x/2 + 1) for the in-place
/// transform.  solve() goes: transform the planes, hand the slow axis over (MPI: a rank gives parts
/// of its planes for all planes of its own part), and then for one block of columns at a time
/// transform the slow axis, let the caller change the modes, and transform back while the block is
/// still in cache.  The slow axis thus costs one pass over memory instead of three
/// (bench/README.md).
///
/// With KeptModes, columns (x,y) outside a set are neither transformed along y and the slow axis
/// nor sent: a sphere of radius n/2.6 keeps 0.77 of the y transforms and 0.46 of the slow ones.
#ifndef BDH_GRID_FFT_H
#define BDH_GRID_FFT_H

#include "base/aligned.h"
#include "base/comm.h"
#include "base/workers.h"
#include "grid/grid.h"
#include "grid/slabs.h"

#include <functional>
#include <memory>
#include <vector>

namespace bdh {

/// Modes that lie together: row s holds index s of the slow axis, `columns` modes along x starting
/// at `first_x`.
template <class Real> struct ModeBlock {
  /// Complex numbers of each component, interleaved, row-major [rows][columns].
  std::array<Real *, 3> f;
  long rows, columns;
  long first_x;    ///< index along x of column 0
  long y;          ///< index along y in 3D; in 2D y is the slow axis and this is 0
};

/// `estimate` makes the same plan in every run, so that a run repeats bit for bit; `measure` is
/// faster, up to twice for sizes that are not powers of two, and plans for a second or two.
enum class FftEffort { estimate, measure };

/// What solve() finds in the field: data, or anything at all in place of zeros.
enum class Input { field, zero };

/// 3D: the largest |index| along x and y of a mode that may be non-zero.  (Along z nothing is saved
/// by less.)
struct KeptModes {
  long x, y;
};

/// Real: float or double.  In float, sizes with both n_x/2 + 1 and n_y odd (2D: n_x/2 + 1) are
/// slow: every other plane is off the 16 bytes that FFTW's vector code asks for.
template <class Real> class VectorFft {
 public:
  using Change = std::function<void(const ModeBlock<Real> &)>;

  /// Collective.  All modes.
  VectorFft(const Grid &grid, const Comm &comm, FftEffort effort,
            const Workers &workers = Workers::one());
  /// Collective, 3D only.  Modes with |x| <= kept.x, |y| <= kept.y, until keep() says less.
  VectorFft(const Grid &grid, const Comm &comm, FftEffort effort, const KeptModes &kept,
            const Workers &workers = Workers::one());
  ~VectorFft();

  Slab slab() const;
  /// Reals that each component's array must have (aligned to 64 bytes).
  std::size_t allocation() const;

  /// Made with KeptModes only; equal on all ranks.  columns[y], for y index 0 .. n_y - 1: modes x =
  /// 0 .. columns[y] - 1 are kept, at most kept.x + 1, and none in rows with |y| > kept.y.  Cheap,
  /// and needs no new plans.
  void keep(const std::vector<long> &columns);

  /// Collective.  Forward transforms, change(block) for every mode once, backward; not normalised.
  /// A slow axis between walls is not transformed: row s of a block is then plane s. With several
  /// workers change() is called for different blocks at the same time. With KeptModes: change()
  /// sees every kept column and some more (x is rounded up), for all z, and must set to zero what
  /// is not meant to stay.  Modes that it does not see are zero in the backward transform.
  void solve(const std::array<Real *, 3> &field, const Change &change, Input input = Input::field);
  std::size_t memory() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// FFTW's real transforms of dense arrays, in place, on the calling thread, not normalised: what a
/// device whose memory is the host's takes in place of a vendor's library.
template <class Real> class PlainFft {
 public:
  /// n: lengths of `rank` axes, slowest first; rows of the last one are padded to 2 (n/2 + 1).
  /// many: transforms, one after the other.
  PlainFft(int rank, const int *n, long many);
  ~PlainFft();
  /// field: aligned to 64 bytes
  void forward(Real *field) const;
  void backward(Real *field) const;

 private:
  struct Plans;
  std::unique_ptr<Plans> plans_;
};

extern template class PlainFft<float>;
extern template class PlainFft<double>;
extern template class VectorFft<float>;
extern template class VectorFft<double>;

/// Smallest multiple of `multiple` >= n whose only prime factors are 2, 3, 5, 7: sizes at which
/// FFTW is fast.
long next_fast_size(long n, long multiple = 1);

}    // namespace bdh
#endif
