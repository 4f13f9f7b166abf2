// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// From the width of a window to a constant of the compiler: the only place that lists the widths.
#ifndef BDH_PSE_WINDOW_CHOICE_H
#define BDH_PSE_WINDOW_CHOICE_H

#include "pse/window.h"

#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

namespace bdh {

/// Calls action(std::integral_constant<int, width>) for a grid of numbers of type Real.  Throws
/// std::logic_error for a width that Window does not allow for them.
template <class Real, int W = Window::least, class Action>
void with_window_width(int width, Action action)
{
  constexpr bool single = sizeof(Real) == sizeof(float);
  if constexpr (W > Window::greatest(single)) {
    throw std::logic_error("no loops for a window of " + std::to_string(width) + " points");
  } else {
    if constexpr (Window::is_width(W, single))
      if (width == W) return action(std::integral_constant<int, W>{});
    with_window_width<Real, W + 1>(width, std::move(action));
  }
}

}    // namespace bdh
#endif
