// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Transforms of a vector field on a grid, fused with the work in wave space.
///
/// A field has one real array per component, x fastest, in planes of the slow axis (z, in 2D y)
/// that are dealt to the ranks in slabs or, as whole planes of which each rank uses its rows, in
/// pencils (grid/parts.h); rows are padded to 2 (n_x/2 + 1) for the in-place transform.  solve()
/// transforms the planes, where those that share them hand over rows for columns, and hands the
/// slow axis over (with MPI a rank gives parts of its planes for all planes of its own part). Then,
/// for one block of columns at a time, it transforms the slow axis, lets the caller change the
/// modes, and transforms back while the block is still in cache.  The slow axis thus costs one pass
/// over memory instead of three (bench/README.md).
///
/// With KeptModes, columns (x,y) outside a set are neither transformed along y and the slow axis
/// nor sent: a sphere of radius n/2.6 keeps 0.77 of the y transforms and 0.46 of the slow ones.
#ifndef BDH_GRID_FFT_H
#define BDH_GRID_FFT_H

#include "base/aligned.h"
#include "base/comm.h"
#include "base/workers.h"
#include "grid/grid.h"
#include "grid/parts.h"

#include <functional>
#include <memory>
#include <vector>

namespace bdh {

/// Modes that lie together: row s holds index s of the slow axis, `columns` modes along x starting
/// at `first_x`.
template <class Real> struct ModeBlock {
  /// Complex numbers of each component, interleaved, row-major [rows][columns].  Fields that are
  /// transformed together follow each other.
  std::array<Real *, 6> f;
  long rows, columns;
  long first_x;    ///< index along x of column 0
  long y;          ///< index along y in 3D; in 2D y is the slow axis and this is 0
};

/// `estimate` makes the same plan in every run, so that a run repeats bit for bit.  `measure` takes
/// a second or two to plan, a few for large grids, and is up to twice as fast for sizes that are
/// not powers of two.
enum class FftEffort { estimate, measure };

/// How transforms are made.  share: ranks that share each slab, see GridParts.
struct FftSetup {
  FftEffort effort;
  int share;
  // An effort alone says enough for most.
  FftSetup(FftEffort e, int s = GridParts::automatic) : effort(e), share(s) {}
};

/// What solve() finds in the field: data, or arbitrary numbers that stand for zeros.
enum class Input { field, zero };

/// The largest |index| along x and y of a mode that may be non-zero, in 3D.  (A limit along z would
/// save nothing.)
struct KeptModes {
  long x, y;
};

template <class Real> class VectorFft {
 public:
  using Change = std::function<void(const ModeBlock<Real> &)>;

  /// Collective.  Keeps all modes.
  VectorFft(const Grid &grid, const Comm &comm, const FftSetup &setup,
            const Workers &workers = Workers::one());
  /// Collective, 3D only.  Keeps the modes with |x| <= kept.x, |y| <= kept.y, until keep() chooses
  /// fewer.  fields: the most vector fields that are transformed together, 1 or 2.
  VectorFft(const Grid &grid, const Comm &comm, const FftSetup &setup, const KeptModes &kept,
            const Workers &workers = Workers::one(), int fields = 1);
  ~VectorFft();

  const GridParts &parts() const;
  Slab slab() const { return parts().planes(); }
  /// Reals that each component's array must have (aligned to 64 bytes).
  std::size_t allocation() const;

  /// Keeps the modes x = 0 .. columns[y] - 1 of each row y = 0 .. n_y - 1: at most kept.x + 1, and
  /// none in rows with |y| > kept.y.  Only for an object that was made with KeptModes.  `columns`
  /// is equal on all ranks.  This is cheap and needs no new plans.
  void keep(const std::vector<long> &columns);

  /// Collective.  Transforms forward, calls change(block) for blocks that contain every mode once,
  /// and transforms backward; not normalised.  A slow axis between walls is not transformed: row s
  /// of a block is then plane s.  With several workers change() is called for different blocks at
  /// the same time.  With KeptModes, change() sees every kept column and some more (x is rounded
  /// up), for all z, and must set to zero what is not meant to stay.  Modes that it does not see
  /// are zero in the backward transform.  With pencils, rows of other ranks that are near this
  /// rank's own ones are zero afterwards (GridParts::margin), and the others are arbitrary.
  void solve(const std::array<Real *, 3> &field, const Change &change, Input input = Input::field);
  /// The same with two fields, whose six components change() sees together.  Only for an object
  /// that was made for two.
  void solve(const std::array<Real *, 6> &fields, const Change &change, Input input = Input::field);
  std::size_t memory() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// FFTW's real transforms of dense arrays, in place, on the calling thread, not normalised.  A
/// device whose memory is the host's uses them in place of a vendor's library.
template <class Real> class PlainFft {
 public:
  /// `n` has the lengths of `rank` axes, slowest first; rows of the last one are padded to
  /// 2 (n/2 + 1).  `many` transforms lie one after the other.
  PlainFft(int rank, const int *n, long many);
  ~PlainFft();
  /// `field` is aligned to 64 bytes.
  void forward(Real *field) const;
  void backward(Real *field) const;

 private:
  struct Plans;
  std::unique_ptr<Plans> plans_;
};

/// FFTW's complex transforms of the first axis of an array [length][many], in the same manner.
template <class Real> class PlainLines {
 public:
  PlainLines(int length, int many);
  ~PlainLines();
  /// `field` is aligned to 64 bytes.
  void forward(Real *field) const;
  void backward(Real *field) const;

 private:
  struct Plans;
  std::unique_ptr<Plans> plans_;
};

extern template class PlainLines<float>;
extern template class PlainLines<double>;
extern template class PlainFft<float>;
extern template class PlainFft<double>;
extern template class VectorFft<float>;
extern template class VectorFft<double>;

/// Smallest multiple of `multiple` >= n whose only prime factors are 2, 3, 5, 7.  FFTW is fast at
/// such sizes.
long next_fast_size(long n, long multiple = 1);

}    // namespace bdh
#endif
