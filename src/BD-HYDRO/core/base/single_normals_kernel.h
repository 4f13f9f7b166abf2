// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The normal random numbers of base/rng_kernel.h in single precision: from the same words the same
/// numbers, but for round-off.
#ifndef BDH_BASE_SINGLE_NORMALS_KERNEL_H
#define BDH_BASE_SINGLE_NORMALS_KERNEL_H

#include "base/rng_kernel.h"

namespace bdh {

BDH_FN float float_from_bits(uint32_t bits)
{
  float x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

BDH_FN uint32_t bits_from_float(float x)
{
  uint32_t bits;
  memcpy(&bits, &x, sizeof x);
  return bits;
}

/// log u of u = (w + 1/2) / 2^32 in single precision, by the series of log_unit(); next term below
/// 1e-8.  Near u = 1 it takes 1 - u from the word, since rounding u would lose the result.
BDH_FN float log_of_word(uint32_t w)
{
  // Conversions of signed integers vectorise everywhere.
  const float u = (static_cast<float>(static_cast<int32_t>(w >> 16)) * 65536.0f +
                   (static_cast<float>(static_cast<int32_t>(w & 0xFFFFu)) + 0.5f)) *
                  2.3283064e-10f;
  const float rest = (static_cast<float>(static_cast<int32_t>(~w & 0x7FFFFFFFu)) + 0.5f) *
                     2.3283064e-10f;    // 1 - u where e = 0
  const uint32_t sqrt_half = 0x3F3504F3u, bits = bits_from_float(u), shifted = bits - sqrt_half;
  const float m = float_from_bits(bits - (shifted & 0xFF800000u));
  const int32_t e = static_cast<int32_t>(shifted) >> 23;
  // A branch here would stop vectorisation, so a mask selects.
  const uint32_t near_one = 0u - static_cast<uint32_t>(e == 0),
                 above = (bits_from_float(-rest) & near_one) |
                         (bits_from_float(m - 1.0f) & ~near_one);    // m - 1
  const float s = float_from_bits(above) / (m + 1.0f), z = s * s;
  float p = 2.0f / 9.0f;
  p = p * z + 2.0f / 7.0f;
  p = p * z + 2.0f / 5.0f;
  p = p * z + 2.0f / 3.0f;
  return static_cast<float>(e) * 0.69314718f + (2.0f * s + s * z * p);
}

/// sincos_turn() in single precision; absolute error below 2e-7.
BDH_FN void sincos_turn(uint32_t w, float &sine, float &cosine)
{
  const float to_radian = 1.4629180792671596e-9f;    // 2 pi / 2^32
  const int32_t centred = static_cast<int32_t>(w & 0x3FFFFFFFu) - 536870912;
  const float x = (static_cast<float>(centred) + 0.5f) * to_radian, z = x * x;
  float s = 1.0f / 362880.0f;
  s = s * z - 1.0f / 5040.0f;
  s = s * z + 1.0f / 120.0f;
  s = s * z - 1.0f / 6.0f;
  s = x + x * z * s;
  float c = -1.0f / 3628800.0f;
  c = c * z + 1.0f / 40320.0f;
  c = c * z - 1.0f / 720.0f;
  c = c * z + 1.0f / 24.0f;
  c = c * z - 0.5f;
  c = 1.0f + z * c;
  const uint32_t quarter = (w >> 30) & 1, half = w & 0x80000000u;
  uint32_t sb = bits_from_float(s), cb = bits_from_float(c);
  const uint32_t exchange = (sb ^ cb) & (0 - quarter);
  sb ^= exchange;
  cb ^= exchange;
  sine = float_from_bits(sb ^ half);
  cosine = float_from_bits(cb ^ half ^ (quarter << 31));
}

/// normal_pair() in single precision; errors below 4e-7 of the length of the pair.
BDH_FN void normal_pair(uint32_t radius_word, uint32_t angle_word, float &z0, float &z1)
{
  const float r = std::sqrt(-2.0f * log_of_word(radius_word));
  float s, c;
  sincos_turn(angle_word, s, c);
  z0 = r * c;
  z1 = r * s;
}

}    // namespace bdh
#endif
