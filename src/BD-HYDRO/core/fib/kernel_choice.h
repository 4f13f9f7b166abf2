// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// From the name of a kernel to its type: the only place that lists the kernels.
#ifndef BDH_FIB_KERNEL_CHOICE_H
#define BDH_FIB_KERNEL_CHOICE_H

#include "fib/ib_kernel.h"
#include "fib/spread.h"
#include "fib/turning_kernel.h"

#include <stdexcept>
#include <type_traits>

namespace bdh {

/// Calls action(kernel) with an object of the kernel's type.  Throws std::logic_error for a kernel
/// that has no type here.
template <class Action> void with_kernel(IbKernel kernel, Action action)
{
  switch (kernel) {
  case IbKernel::roma3: return action(Roma3{});
  case IbKernel::peskin4: return action(Peskin4{});
  case IbKernel::bkp6: return action(BaoKayePeskin6{});
  }
  throw std::logic_error("an immersed-boundary kernel is missing in with_kernel()");
}

/// Calls action(kernel, dimension), the latter a std::integral_constant<int, 2 or 3>.
template <class Action> void with_kernel(IbKernel kernel, int dim, Action action)
{
  with_kernel(kernel, [&](auto chosen) {
    if (dim == 3) return action(chosen, std::integral_constant<int, 3>{});
    if (dim == 2) return action(chosen, std::integral_constant<int, 2>{});
    throw std::logic_error("immersed-boundary kernels are for two or three dimensions");
  });
}

/// The same with the kernel of torques that belongs to a kernel of forces.
template <class Action> void with_turning_kernel(IbKernel kernel, int dim, Action action)
{
  with_kernel(kernel, dim, [&](auto chosen, auto dimension) {
    action(typename TurningKernel<decltype(chosen)>::Type{}, dimension);
  });
}

}    // namespace bdh
#endif
