// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Linear combinations of arrays of numbers, wherever an execution has them.
#ifndef BDH_BASE_VECTORS_H
#define BDH_BASE_VECTORS_H

#include "base/ssize.h"
#include "base/vector_kernel.h"

namespace bdh {

/// to := ca a + cb b, for all numbers of `to`.
template <class Execution, class Vector> void combine(const Execution &execution, double ca,
                                                      const double *a, double cb, const double *b,
                                                      Vector &to)
{
  execution.for_each("bdh::combine", ssize(to), Combine{ca, a, cb, b, to.data()});
}

/// to := c from, for all numbers of `to`.
template <class Execution, class Vector>
void scale(const Execution &execution, double c, const Vector &from, Vector &to)
{
  execution.for_each("bdh::scale", ssize(to), Scale<double>{c, from.data(), to.data()});
}

}    // namespace bdh
#endif
