// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Vector registers of the processor that is compiled for.
#ifndef BDH_BASE_REGISTERS_H
#define BDH_BASE_REGISTERS_H

namespace bdh {

/// Bytes of one.  g++ 12 keeps longer vectors in memory where several live at once, and takes
/// shuffles of them apart.
#if defined(__AVX512F__)
constexpr int register_bytes = 64;
#elif defined(__AVX__)
constexpr int register_bytes = 32;
#else
constexpr int register_bytes = 16;
#endif

}    // namespace bdh
#endif
