// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Signed sizes: indices and counts are signed throughout, and sizes join them here.
#ifndef BDH_BASE_SSIZE_H
#define BDH_BASE_SSIZE_H

#include <iterator>

namespace bdh {

/// c.size() as a signed number.
#ifdef __cpp_lib_ssize
using std::ssize;
#else
template <class Container> constexpr long ssize(const Container &c)
{
  return static_cast<long>(c.size());
}
#endif

}    // namespace bdh
#endif
