// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The system's library fmt for the headers of an installed LAMMPS, which may call a function of an
/// older fmt.
#ifndef BDH_INSTALLED_FMT_FORMAT_H
#define BDH_INSTALLED_FMT_FORMAT_H

#include_next <fmt/format.h>

#include <type_traits>

#if FMT_VERSION >= 90000
namespace fmt {

/// Without the check: fmt checks when the message is made.
template <class... Args, class Format>
auto make_args_checked(const Format &, const std::remove_reference_t<Args> &...args)
{
  return make_format_args(args...);
}

}    // namespace fmt
#endif
#endif
