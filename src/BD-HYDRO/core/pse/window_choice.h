// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// From the width of a window to a constant of the compiler: the only place that lists the widths.
#ifndef BDH_PSE_WINDOW_CHOICE_H
#define BDH_PSE_WINDOW_CHOICE_H

#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

namespace bdh {

constexpr int least_window = 2, greatest_window = 16;    // grid points per axis

/// Calls action(std::integral_constant<int, width>).  Throws std::logic_error for a width outside
/// of least_window .. greatest_window.
template <int W = least_window, class Action> void with_window_width(int width, Action action)
{
  if constexpr (W > greatest_window) {
    throw std::logic_error("no loops for a window of " + std::to_string(width) + " points");
  } else {
    if (width == W) return action(std::integral_constant<int, W>{});
    with_window_width<W + 1>(width, std::move(action));
  }
}

}    // namespace bdh
#endif
