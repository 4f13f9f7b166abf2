// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Strips of Fourier modes and their random numbers, shared by all loops over modes.
#ifndef BDH_STOKES_MODE_STRIP_H
#define BDH_STOKES_MODE_STRIP_H

#include "base/normal_strip.h"

namespace bdh {

/// Real and imaginary parts of all components in a strip of modes.
template <class Real> struct StripField {
  alignas(64) Real re[3][strip], im[3][strip];
};

/// Adds weight * normals of one noise to `out` for the modes index(0) .. index(count - 1), and for
/// some more that pad the strip.  E|z|^2 = 1 per complex number: each part has variance 1/2.
template <class Index, class Real> void add_normals(const NoiseCounter &counter, double weight,
                                                    Index index, long count,
                                                    StripNormals<Real> &out)
{
  add_draws(counter, weight * root_half, index, count, out);
}

}    // namespace bdh
#endif
