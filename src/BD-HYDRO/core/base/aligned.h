// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Arrays on cache lines.
#ifndef BDH_BASE_ALIGNED_H
#define BDH_BASE_ALIGNED_H

#include <cstdlib>
#include <new>
#include <vector>

namespace bdh {

/// Allocates on cache lines, which aligned vector loads and FFTW's plans require.
template <class T> struct AlignedAllocator {
  using value_type = T;
  static constexpr std::size_t alignment = 64;
  AlignedAllocator() = default;
  template <class U> AlignedAllocator(const AlignedAllocator<U> &) {}
  T *allocate(std::size_t count)
  {
    const std::size_t bytes = (count * sizeof(T) + alignment - 1) / alignment * alignment;
    if (void *p = std::aligned_alloc(alignment, bytes)) return static_cast<T *>(p);
    throw std::bad_alloc();
  }
  void deallocate(T *p, std::size_t) { std::free(p); }
  template <class U> bool operator==(const AlignedAllocator<U> &) const { return true; }
  template <class U> bool operator!=(const AlignedAllocator<U> &) const { return false; }
};

template <class T> using AlignedArray = std::vector<T, AlignedAllocator<T>>;
using AlignedVector = AlignedArray<double>;

}    // namespace bdh
#endif
