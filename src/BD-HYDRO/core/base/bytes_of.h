// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// What arrays take of the memory.
#ifndef BDH_BASE_BYTES_OF_H
#define BDH_BASE_BYTES_OF_H

#include <cstddef>
#include <type_traits>
#include <utility>

namespace bdh {

/// True for a container of numbers, but not for a container of such containers.
template <class Array, class = void> struct HoldsNumbers : std::false_type {};
template <class Array>
struct HoldsNumbers<Array, std::void_t<decltype(std::declval<const Array &>().capacity())>>
    : std::bool_constant<!std::is_class_v<typename Array::value_type> ||
                         std::is_trivially_copyable_v<typename Array::value_type>> {};

/// Bytes allocated for the numbers in arrays: vectors, arrays of a device, or containers of them.
template <class Array> std::size_t bytes_of(const Array &array)
{
  if constexpr (HoldsNumbers<Array>::value) {
    return array.capacity() * sizeof(typename Array::value_type);
  } else {
    std::size_t bytes = 0;
    for (const auto &part : array) bytes += bytes_of(part);
    return bytes;
  }
}

template <class First, class Second, class... Others>
std::size_t bytes_of(const First &first, const Second &second, const Others &...others)
{
  return bytes_of(first) + bytes_of(second, others...);
}

}    // namespace bdh
#endif
