// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Real transforms of the rows of a plane by complex ones of two rows at once.
#ifndef BDH_GRID_ROW_TRANSFORMS_H
#define BDH_GRID_ROW_TRANSFORMS_H

#include "base/aligned.h"
#include "base/bytes_of.h"
#include "base/registers.h"
#include "grid/fftw.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace bdh {

/// Real transforms of rows of n numbers, in place in rows padded to 2 (n/2 + 1), not normalised.
///
/// Rows a and b are transformed as z = a + i b, from which their modes are
///
///     A_k = (Z_k + Z*_(n-k))/2,   B_k = (Z_k - Z*_(n-k))/(2i).
///
/// FFTW has vector code for complex lines, but not for the first radix pass of real ones: in float
/// these take three times as long (bench/README.md).  In double the gain is less than what zipping
/// and splitting cost.
template <class Real> class RowTransforms {
 public:
  /// Whether they are faster than FFTW's real transforms.
  static constexpr bool pay(long n) { return sizeof(Real) == sizeof(float) && n >= 16; }

  /// workers: how many call forward() and backward() at the same time.
  RowTransforms(long n, long rows, FftEffort effort, int workers) :
      n_(n), half_(n / 2 + 1), rows_(rows), pitch_((n + 2) / 2 * 2), pairs_((rows + 1) / 2),
      together_(std::clamp(tile_bytes / (2 * pitch_ * long(sizeof(Real))), 1L, pairs_)),
      tiles_(workers)
  {
    for (auto &tile : tiles_) tile.assign(2 * pitch_ * together_, Real(0));
    const unsigned how = planner_flag(effort, n <= patient_length_in_planes);
    whole_ = line_plans(n, together_, pitch_, tiles_[0].data(), how);
    if (pairs_ % together_)
      rest_ = line_plans(n, pairs_ % together_, pitch_, tiles_[0].data(), how);
  }

  void forward(Real *plane, int worker)
  {
    for_tiles(worker, [&](Real *tile, long first, long count) {
      for_pairs(plane, first, count, tile, [&](Real *a, Real *b, Real *z) { zip(a, b, z); });
      execute(plans_of(count).forward, tile);
      for_pairs(plane, first, count, tile, [&](Real *a, Real *b, Real *z) { split(z, a, b); });
    });
  }

  void backward(Real *plane, int worker)
  {
    for_tiles(worker, [&](Real *tile, long first, long count) {
      for_pairs(plane, first, count, tile, [&](Real *a, Real *b, Real *z) { merge(a, b, z); });
      execute(plans_of(count).backward, tile);
      for_pairs(plane, first, count, tile, [&](Real *a, Real *b, Real *z) { unzip(z, a, b); });
    });
  }

  std::size_t memory() const
  {
    std::size_t bytes = 0;
    for (const auto &tile : tiles_) bytes += bytes_of(tile);
    return bytes;
  }

 private:
  // Half of a first-level cache.
  static constexpr long tile_bytes = 1 << 14;
  static constexpr int lanes = lanes_of_register<Real>;
  using Lanes = LanesOf<Real, lanes>;
  static Lanes at(const Real *p) { return lanes_at<Real, lanes>(p); }

  /// Calls action(tile, first pair, how many) for all rows.
  template <class Action> void for_tiles(int worker, const Action &action)
  {
    for (long first = 0; first < pairs_; first += together_)
      action(tiles_[worker].data(), first, std::min(together_, pairs_ - first));
  }
  /// Calls action(row a, row b, line of the tile).  A last row without another is both.
  template <class Action>
  void for_pairs(Real *plane, long first, long count, Real *tile, const Action &action) const
  {
    for (long p = 0; p < count; ++p) {
      const long a = 2 * (first + p), b = std::min(a + 1, rows_ - 1);
      action(plane + 2 * half_ * a, plane + 2 * half_ * b, tile + 2 * pitch_ * p);
    }
  }
  const FftwPlanPair<Real> &plans_of(long count) const
  {
    return count == together_ ? whole_ : rest_;
  }
  static void execute(const FftwPlan<Real> &plan, Real *tile)
  {
    auto *const z = as_fftw_complex(tile);
    Fftw<Real>::execute(plan.get(), z, z);
  }

  /// z := a + i b
  void zip(const Real *a, const Real *b, Real *z) const
  {
    long i = 0;
    for (; i + lanes <= n_; i += lanes) {
      const Lanes p = at(a + i), q = at(b + i);
      put_lanes<Real, lanes>(zipped<0>(p, q, Numbers()), z + 2 * i);
      put_lanes<Real, lanes>(zipped<lanes / 2>(p, q, Numbers()), z + 2 * i + lanes);
    }
    for (; i < n_; ++i) {
      z[2 * i] = a[i];
      z[2 * i + 1] = b[i];
    }
  }
  void unzip(const Real *z, Real *a, Real *b) const
  {
    long i = 0;
    for (; i + lanes <= n_; i += lanes) {
      const Lanes low = at(z + 2 * i), high = at(z + 2 * i + lanes);
      put_lanes<Real, lanes>(every_second<0>(low, high, Numbers()), a + i);
      put_lanes<Real, lanes>(every_second<1>(low, high, Numbers()), b + i);
    }
    for (; i < n_; ++i) {
      a[i] = z[2 * i];
      b[i] = z[2 * i + 1];
    }
  }
  /// The modes of both rows from those of z.  z_n := z_0
  void split(Real *z, Real *a, Real *b) const
  {
    std::copy_n(z, 2, z + 2 * n_);
    long k = 0;
    for (; k + lanes / 2 <= half_; k += lanes / 2) {
      const Lanes p = at(z + 2 * k), q = conjugate(reversed(at(z + 2 * (n_ - k + 1) - lanes)));
      put_lanes<Real, lanes>(Real(0.5) * (p + q), a + 2 * k);
      put_lanes<Real, lanes>(Real(0.5) * conjugate(swapped(p - q)), b + 2 * k);
    }
    for (; k < half_; ++k) {
      const Real *const p = z + 2 * k, *const q = z + 2 * (n_ - k);
      const Real re = p[0], im = p[1], re2 = q[0], im2 = q[1];
      a[2 * k] = Real(0.5) * (re + re2);
      a[2 * k + 1] = Real(0.5) * (im - im2);
      b[2 * k] = Real(0.5) * (im + im2);
      b[2 * k + 1] = Real(0.5) * (re2 - re);
    }
  }
  /// Z_k = A_k + i B_k, where the modes of real rows at n - k are conjugate to those at k
  void merge(const Real *a, const Real *b, Real *z) const
  {
    long k = 0;
    for (; k + lanes / 2 <= half_; k += lanes / 2) {
      const Lanes p = at(a + 2 * k), iq = conjugate(swapped(at(b + 2 * k)));
      put_lanes<Real, lanes>(p - iq, z + 2 * k);
      put_lanes<Real, lanes>(reversed(conjugate(p + iq)), z + 2 * (n_ - k + 1) - lanes);
    }
    for (; k < half_; ++k) {
      const Real re = a[2 * k], im = a[2 * k + 1], re2 = b[2 * k], im2 = b[2 * k + 1];
      z[2 * k] = re - im2;
      z[2 * k + 1] = im + re2;
      z[2 * (n_ - k)] = re + im2;
      z[2 * (n_ - k) + 1] = re2 - im;
    }
    real_mode(a, b, 0, z);
    if (n_ % 2 == 0) real_mode(a, b, n_ / 2, z);
  }
  using Numbers = std::make_integer_sequence<int, lanes>;

  /// Numbers of a and b in turn, from number `first` on.
  template <int first, int... i>
  static Lanes zipped(Lanes a, Lanes b, std::integer_sequence<int, i...>)
  {
    return __builtin_shufflevector(a, b, (first + i / 2 + i % 2 * lanes)...);
  }
  template <int first, int... i>
  static Lanes every_second(Lanes low, Lanes high, std::integer_sequence<int, i...>)
  {
    return __builtin_shufflevector(low, high, (first + 2 * i)...);
  }
  /// The complex numbers in the opposite order, and with real and imaginary parts swapped.
  static Lanes reversed(Lanes v) { return reversed(v, Numbers()); }
  static Lanes swapped(Lanes v) { return swapped(v, Numbers()); }
  template <int... i> static Lanes reversed(Lanes v, std::integer_sequence<int, i...>)
  {
    return __builtin_shufflevector(v, v, (lanes - 2 - i / 2 * 2 + i % 2)...);
  }
  template <int... i> static Lanes swapped(Lanes v, std::integer_sequence<int, i...>)
  {
    return __builtin_shufflevector(v, v, (i ^ 1)...);
  }
  static Lanes conjugate(Lanes v) { return v * signs(Numbers()); }
  template <int... i> static Lanes signs(std::integer_sequence<int, i...>)
  {
    return Lanes{(i % 2 ? Real(-1) : Real(1))...};
  }
  /// A mode that is its own conjugate is real: as FFTW does, what is imaginary there is left out.
  static void real_mode(const Real *a, const Real *b, long k, Real *z)
  {
    z[2 * k] = a[2 * k];
    z[2 * k + 1] = b[2 * k];
  }

  long n_, half_, rows_, pitch_, pairs_;
  long together_;                            // pairs in a tile
  FftwPlanPair<Real> whole_, rest_;          // of a whole tile, and of the last one
  std::vector<AlignedArray<Real>> tiles_;    // by worker
};

}    // namespace bdh
#endif
