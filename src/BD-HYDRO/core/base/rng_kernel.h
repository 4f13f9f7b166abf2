// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Counter-based normal random numbers: pure functions of (seed, stream, step, stage, index).
///
/// The words come from Philox4x32-10 [Salmon et al., SC11 (2011)], as implemented by Random123. The
/// normals come from the Box-Muller map with a logarithm and a sine made of +, *, / and bit
/// operations only: they vectorise, and host and device compute the same numbers to the last bits.
///
/// A step may be taken in pieces, and its noise lies on a Brownian tree: the normals of the two
/// halves of a piece whose own are z are (z + z')/sqrt(2) and (z - z')/sqrt(2), with further
/// normals z' that belong to the piece.  They are independent, and the displacements that the
/// halves draw add up to the one that the piece would draw.  So there is one Brownian path at every
/// resolution, and nothing is stored.  [Gaines and Lyons, SIAM J. Appl. Math. 57, 1455 (1997)]
#ifndef BDH_BASE_RNG_KERNEL_H
#define BDH_BASE_RNG_KERNEL_H

#include "base/constants.h"
#include "base/portable.h"

#include <Random123/philox.h>

#include <cmath>
#include <cstdint>
#include <cstring>

namespace bdh {

/// What a random number is for.  The stream is part of the key, so streams never overlap.
enum class Stream : uint32_t {
  fluid = 1,
  finite_difference = 2,
  lanczos = 3,
  wave_space = 4,
  lanczos_rotation = 5,
  lanczos_strain = 6,
  lanczos_last_strain = 7
};

/// Pieces of a step are nodes of a binary tree: 1 is the whole step, 2 n and 2 n + 1 are the first
/// and the second half of piece n.  A number for step and piece together takes the place of the
/// step's wherever noise is drawn; for a whole step it is the step's.
constexpr int step_bits = 40;
constexpr int deepest_piece = 22;    ///< halvings of a step
BDH_FN uint64_t piece_of_step(uint64_t step, uint64_t node)
{
  const uint64_t number = step & ((uint64_t(1) << step_bits) - 1);
  return node > 1 ? number | node << step_bits : number;
}

/// Names one draw: `index` is a global wave-vector, face or atom number below 2^56, `stage` numbers
/// the draws of a step.
struct NoiseCounter {
  uint32_t seed;
  Stream stream;
  uint64_t step;     // < 2^40, or a piece of one
  uint32_t stage;    // < 256
};

/// The normals of a piece as a sum of weighted draws: those of the whole step, and z' of each piece
/// that contains it, where `counter` gives z' of node n in place of the piece n of the step.
struct TermsOfPiece {
  NoiseCounter piece;
  uint64_t node;
  int depth;    ///< halvings

  BDH_FN explicit TermsOfPiece(const NoiseCounter &c) :
      piece(c), node(c.step >> step_bits), depth(0)
  {
    while (node >> (depth + 1)) ++depth;
  }
  /// Terms are numbered from 0 to depth.
  BDH_FN NoiseCounter counter(int term) const
  {
    const uint64_t step = piece.step & ((uint64_t(1) << step_bits) - 1);
    const uint64_t above = term == depth ? 0 : node >> (depth - term);
    return {piece.seed, piece.stream, step | above << step_bits, piece.stage};
  }
  BDH_FN double weight(int term) const
  {
    double size = 1.0;    // 2^(-k/2), after k halvings
    for (int k = term == depth ? 0 : term; k < depth; ++k) size *= 0.70710678118654752440;
    const bool second = term < depth && (node >> (depth - term - 1)) & 1;
    return second ? -size : size;
  }
};

/// Four words, uniform on 0 .. 2^32-1.
BDH_FN r123array4x32 random_words(const NoiseCounter &c, uint64_t index)
{
  philox4x32_ctr_t counter;
  counter.v[0] = static_cast<uint32_t>(index);
  counter.v[1] = static_cast<uint32_t>(index >> 32) | (c.stage << 24);
  counter.v[2] = static_cast<uint32_t>(c.step);
  counter.v[3] = static_cast<uint32_t>(c.step >> 32);
  philox4x32_key_t key;
  key.v[0] = c.seed;
  key.v[1] = static_cast<uint32_t>(c.stream);
  return philox4x32_R(10, counter, key);
}

BDH_FN double double_from_bits(uint64_t bits)
{
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

BDH_FN uint64_t bits_from_double(double x)
{
  uint64_t bits;
  memcpy(&bits, &x, sizeof x);
  return bits;
}

/// Exact conversion of an integer below 2^52 (the integer becomes the mantissa of 2^52 + i).
BDH_FN double small_int_to_double(uint64_t i)
{
  return double_from_bits(0x4330000000000000ull | i) - 4503599627370496.0;
}

/// log(x) for normal 0 < x <= 1, relative error below 4e-16.
/// x = 2^e m with m in [sqrt(1/2), sqrt(2)); log m = 2 artanh((m-1)/(m+1)) by its series, next term
/// below 1e-17.
BDH_FN double log_unit(double x)
{
  const uint64_t sqrt_half = 0x3FE6A09E667F3BCDull;
  const uint64_t bits = bits_from_double(x);
  const uint64_t shifted = bits - sqrt_half;
  const double m = double_from_bits(bits - (shifted & 0xFFF0000000000000ull));
  const double e = small_int_to_double(((shifted >> 52) + 1024) & 0xFFF) - 1024.0;
  const double s = (m - 1.0) / (m + 1.0), z = s * s;
  double p = 2.0 / 19.0;
  p = p * z + 2.0 / 17.0;
  p = p * z + 2.0 / 15.0;
  p = p * z + 2.0 / 13.0;
  p = p * z + 2.0 / 11.0;
  p = p * z + 2.0 / 9.0;
  p = p * z + 2.0 / 7.0;
  p = p * z + 2.0 / 5.0;
  p = p * z + 2.0 / 3.0;
  return e * 0.693147180559945309417 + (2.0 * s + s * z * p);
}

/// sin and cos of an angle that the word w cuts off a full turn; absolute error below 1e-15.
/// Two bits choose the quadrant, thirty the angle within [-pi/4, pi/4].
BDH_FN void sincos_turn(uint32_t w, double &sine, double &cosine)
{
  const double to_radian = two_pi / 4294967296.0;
  const double x = (small_int_to_double(w & 0x3FFFFFFFu) - 536870911.5) * to_radian, z = x * x;
  double s = -1.0 / 1307674368000.0;
  s = s * z + 1.0 / 6227020800.0;
  s = s * z - 1.0 / 39916800.0;
  s = s * z + 1.0 / 362880.0;
  s = s * z - 1.0 / 5040.0;
  s = s * z + 1.0 / 120.0;
  s = s * z - 1.0 / 6.0;
  s = x + x * z * s;
  double c = 1.0 / 20922789888000.0;
  c = c * z - 1.0 / 87178291200.0;
  c = c * z + 1.0 / 479001600.0;
  c = c * z - 1.0 / 3628800.0;
  c = c * z + 1.0 / 40320.0;
  c = c * z - 1.0 / 720.0;
  c = c * z + 1.0 / 24.0;
  c = c * z - 0.5;
  c = 1.0 + z * c;
  // A branch here would stop vectorisation, so masks exchange and negate.
  const uint64_t quarter = (static_cast<uint64_t>(w) >> 30) & 1,
                 half = (static_cast<uint64_t>(w) >> 31) << 63;
  uint64_t sb = bits_from_double(s), cb = bits_from_double(c);
  const uint64_t exchange = (sb ^ cb) & (0 - quarter);
  sb ^= exchange;
  cb ^= exchange;
  sine = double_from_bits(sb ^ half);
  cosine = double_from_bits(cb ^ half ^ (quarter << 63));
}

/// Box-Muller: two independent N(0,1) from two words.  |z| < 6.77, the largest that 32 bits allow.
BDH_FN void normal_pair(uint32_t radius_word, uint32_t angle_word, double &z0, double &z1)
{
  // u = (w + 1/2) / 2^32
  const double u = (small_int_to_double(radius_word) + 0.5) * 2.3283064365386963e-10;
  const double r = std::sqrt(-2.0 * log_unit(u));
  double s, c;
  sincos_turn(angle_word, s, c);
  z0 = r * c;
  z1 = r * s;
}

/// Four independent N(0,1).
BDH_FN void normal4(const NoiseCounter &c, uint64_t index, double &z0, double &z1, double &z2,
                    double &z3)
{
  if (c.step >> step_bits == 0) {    // loops over whole steps vectorise
    const r123array4x32 w = random_words(c, index);
    normal_pair(w.v[0], w.v[1], z0, z1);
    normal_pair(w.v[2], w.v[3], z2, z3);
    return;
  }
  const TermsOfPiece terms(c);
  z0 = z1 = z2 = z3 = 0.0;
  for (int m = 0; m <= terms.depth; ++m) {
    const r123array4x32 w = random_words(terms.counter(m), index);
    const double weight = terms.weight(m);
    double a, b;
    normal_pair(w.v[0], w.v[1], a, b);
    z0 += weight * a;
    z1 += weight * b;
    normal_pair(w.v[2], w.v[3], a, b);
    z2 += weight * a;
    z3 += weight * b;
  }
}

}    // namespace bdh
#endif
