// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Modes of positively split Ewald that are solved together, whatever rows they lie in: rows inside
/// k_cut are shorter than a strip, and of different lengths.
#ifndef BDH_PSE_WAVE_STRIP_H
#define BDH_PSE_WAVE_STRIP_H

#include "grid/fft.h"
#include "pse/particles.h"
#include "pse/wave_kernel.h"
#include "stokes/mode_strip.h"

#include <algorithm>
#include <cmath>

namespace bdh {

/// Modes that follow each other along x in a block.
template <class Real> struct WaveRow {
  long place;        ///< of the first one in the block
  long n[dim];       ///< its indices
  double k[dim];     ///< its wave vector, and
  double dk[dim];    ///< the step to the next one [1/length]
  /// Of WaveWeight over w^: of each shape, and of both in the second term; null for what there is
  /// not.
  const Real *root[3];
};

/// What the modes of one evaluation share.
struct WaveWork {
  WaveStrength strength;
  const PseNoise &noise;
};

/// used: shapes whose fields the block has; terms: of the weight that act on them apart.  A single
/// shape has the root of the whole weight.  Real: precision of the block; all else is double.
template <class Real, int used, int terms> class WaveStrip {
 public:
  WaveStrip(const ModeBlock<Real> &block, const WaveWork &work) : block_(block), work_(work) {}

  long room() const { return strip - count_; }

  /// count: modes of the row, at most room()
  void append(const WaveRow<Real> &row, long count)
  {
    const uint64_t number = wave_number(row.n[0], row.n[1], row.n[2]);
    for (long i = 0; i < count; ++i) {
      const double t = i;
      for (int d = 0; d < dim; ++d) k_[d][count_ + i] = row.k[d] + t * row.dk[d];
      side_[count_ + i] = 1.0;
      number_[count_ + i] = number + i;
    }
    if (is_conjugate(row.n[0], row.n[1], row.n[2])) {
      side_[count_] = -1.0;
      number_[count_] = drawn_wave(row.n[0], row.n[1], row.n[2]);
    }
    for (int r = 0; r < roots; ++r)
      if (row.root[r]) std::copy_n(row.root[r], count, root_[r] + count_);
    if (used == 1 && row.root[common])
      for (long i = 0; i < count; ++i) {
        double &root = root_[0][count_ + i];
        const double both = row.root[common][i];
        root = std::sqrt(root * root + both * both);
      }
    parts_[part_count_++] = {row.place, count_, count};
    count_ += count;
  }

  /// The velocities of all modes take the place of their forces in the block.  Empties the strip.
  void solve()
  {
    if (count_ == 0) return;
    pad();
    StripField<double> force[used], velocity[used];
    load(force);
    for (int term = 0; term < terms; ++term) {
      StripField<double> v;
      add_up(force, term, v);
      solve_term(term, v);
      give(v, term, velocity);
    }
    store(velocity);
    count_ = part_count_ = 0;
  }

 private:
  // The second term's root is behind those of the shapes.
  static constexpr int roots = used == 2 ? 3 : 1, common = 2;

  struct Part {
    long place, first, count;
  };

  /// Fills up what loops run over beyond the last mode.
  void pad()
  {
    for (long i = count_; i < padded(count_); ++i) {
      for (int d = 0; d < dim; ++d) k_[d][i] = 1.0;
      side_[i] = 1.0;
      number_[i] = 0;
      for (int r = 0; r < roots; ++r) root_[r][i] = 0.0;
    }
  }
  template <class Action> void for_parts(const Action &action) const
  {
    for (long p = 0; p < part_count_; ++p) action(parts_[p]);
  }
  void load(StripField<double> *force) const
  {
    for (int s = 0; s < used; ++s)
      for (int d = 0; d < dim; ++d) {
        double *const re = force[s].re[d], *const im = force[s].im[d];
        const Real *const from = block_.f[dim * s + d];
        for_parts([=](const Part &part) {
          for (long i = 0; i < part.count; ++i) {
            re[part.first + i] = from[2 * (part.place + i)];
            im[part.first + i] = from[2 * (part.place + i) + 1];
          }
        });
        std::fill(re + count_, re + padded(count_), 0.0);
        std::fill(im + count_, im + padded(count_), 0.0);
      }
  }
  void store(const StripField<double> *velocity) const
  {
    for (int s = 0; s < used; ++s)
      for (int d = 0; d < dim; ++d) {
        const double *const re = velocity[s].re[d], *const im = velocity[s].im[d];
        Real *const to = block_.f[dim * s + d];
        for_parts([=](const Part &part) {
          for (long i = 0; i < part.count; ++i) {
            to[2 * (part.place + i)] = re[part.first + i];
            to[2 * (part.place + i) + 1] = im[part.first + i];
          }
        });
      }
  }
  /// The root of shape s in a term.
  const double *root(int term, int s) const { return term == 0 ? root_[s] : root_[common]; }

  /// v := the force of a single shape, or those of two, each with its root.
  void add_up(const StripField<double> *force, int term, StripField<double> &v) const
  {
    const double *const first = root(term, 0), *const second = root(term, used - 1);
    for (int d = 0; d < dim; ++d)
      for (long i = 0; i < padded(count_); ++i)
        if constexpr (used == 1) {
          v.re[d][i] = force[0].re[d][i];
          v.im[d][i] = force[0].im[d][i];
        } else {
          v.re[d][i] = first[i] * force[0].re[d][i] + second[i] * force[1].re[d][i];
          v.im[d][i] = first[i] * force[0].im[d][i] + second[i] * force[1].im[d][i];
        }
  }
  /// The adjoint: velocity := or += v as a single shape reads it, or each of two.
  void give(const StripField<double> &v, int term, StripField<double> *velocity) const
  {
    for (int s = 0; s < used; ++s) {
      const double *const r = root(term, s);
      for (int d = 0; d < dim; ++d)
        for (long i = 0; i < padded(count_); ++i) {
          const double w = used == 1 ? 1.0 : r[i], re = w * v.re[d][i], im = w * v.im[d][i];
          velocity[s].re[d][i] = term == 0 ? re : velocity[s].re[d][i] + re;
          velocity[s].im[d][i] = term == 0 ? im : velocity[s].im[d][i] + im;
        }
    }
  }

  void draw(int term, StripNormals<double> &normals) const
  {
    for (auto &part : normals.z) std::fill_n(part, padded(count_), 0.0);
    if (!work_.noise.acts()) return;
    add_normals(
        work_.noise.counter(Stream::wave_space), 1.0,
        [this, term](long i) { return term == 1 ? common_draw(number_[i]) : number_[i]; }, count_,
        normals);
  }
  /// Velocities by their forces, in place.
  void solve_term(int term, StripField<double> &v) const
  {
    StripNormals<double> normals;
    draw(term, normals);
    const WaveStrength strength = work_.strength;
    const long count = padded(count_);
    BDH_INDEPENDENT
    for (long i = 0; i < count; ++i) {
      const Wave wave{{k_[0][i], k_[1][i], k_[2][i]}, side_[i], weight(term, i)};
      const double z[4] = {normals.z[0][i], normals.z[1][i], normals.z[2][i], normals.z[3][i]};
      double re[dim] = {v.re[0][i], v.re[1][i], v.re[2][i]},
             im[dim] = {v.im[0][i], v.im[1][i], v.im[2][i]};
      solve_wave(wave, strength, z, re, im);
      for (int d = 0; d < dim; ++d) {
        v.re[d][i] = re[d];
        v.im[d][i] = im[d];
      }
    }
  }
  /// Of a single shape the root of the whole weight, of two whether the mode is kept.
  double weight(int term, long i) const
  {
    if constexpr (used == 1) return root_[0][i];
    return root(term, 0)[i] != 0.0 || root(term, 1)[i] != 0.0 ? 1.0 : 0.0;
  }

  const ModeBlock<Real> &block_;
  const WaveWork &work_;
  long count_ = 0, part_count_ = 0;
  Part parts_[strip];
  alignas(64) double k_[dim][strip], side_[strip], root_[roots][strip];
  alignas(64) uint64_t number_[strip];
};

}    // namespace bdh
#endif
