// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The random words of base/rng_kernel.h for many indices at once.
#ifndef BDH_BASE_RANDOM_STRIP_H
#define BDH_BASE_RANDOM_STRIP_H

#include "base/rng_kernel.h"

#if defined(__AVX512F__) && !defined(__CUDACC__)
#include <immintrin.h>
#define BDH_PHILOX_BY_EIGHTS
#endif

namespace bdh {

/// w[m][i] := word m of random_words(counter, index[i]) for i < count, a multiple of 8.
///
/// With AVX-512, g++ takes vpmullq for products of 32-bit words, which is three times as slow as
/// vpmuludq.  Here each word lies in the lower half of a 64-bit lane, the only one that vpmuludq
/// reads; what is in the upper half does not matter until the words are stored.
#ifdef BDH_PHILOX_BY_EIGHTS
inline void random_words_of(const NoiseCounter &counter, const uint64_t *index, long count,
                            uint32_t *const (&w)[4])
{
  const auto all = [](uint32_t word) { return _mm512_set1_epi64(word); };
  const __m512i stage = all(counter.stage << 24), step = all(uint32_t(counter.step)),
                step_high = all(uint32_t(counter.step >> 32));
  const __m512i multiplier[2] = {all(PHILOX_M4x32_0), all(PHILOX_M4x32_1)};
  for (long i = 0; i < count; i += 8) {
    const __m512i n = _mm512_loadu_si512(index + i);
    __m512i x[4] = {n, _mm512_or_si512(_mm512_srli_epi64(n, 32), stage), step, step_high};
    uint32_t key[2] = {counter.seed, static_cast<uint32_t>(counter.stream)};
    for (int round = 0; round < 10; ++round) {
      const __m512i p = _mm512_mul_epu32(x[0], multiplier[0]),
                    q = _mm512_mul_epu32(x[2], multiplier[1]);
      constexpr int exclusive_or = 0x96;
      x[0] = _mm512_ternarylogic_epi64(_mm512_srli_epi64(q, 32), x[1], all(key[0]), exclusive_or);
      x[1] = q;
      x[2] = _mm512_ternarylogic_epi64(_mm512_srli_epi64(p, 32), x[3], all(key[1]), exclusive_or);
      x[3] = p;
      key[0] += PHILOX_W32_0;
      key[1] += PHILOX_W32_1;
    }
    for (int m = 0; m < 4; ++m)
      _mm256_storeu_si256(reinterpret_cast<__m256i *>(w[m] + i), _mm512_cvtepi64_epi32(x[m]));
  }
}
#else
inline void random_words_of(const NoiseCounter &counter, const uint64_t *index, long count,
                            uint32_t *const (&w)[4])
{
  BDH_INDEPENDENT
  for (long i = 0; i < count; ++i) {
    const r123array4x32 r = random_words(counter, index[i]);
    w[0][i] = r.v[0];
    w[1][i] = r.v[1];
    w[2][i] = r.v[2];
    w[3][i] = r.v[3];
  }
}
#endif

}    // namespace bdh
#endif
