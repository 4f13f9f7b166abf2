// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The random numbers of a Stokes problem for a strip of modes.
#ifndef BDH_STOKES_NOISE_H
#define BDH_STOKES_NOISE_H

#include "base/constants.h"
#include "stokes/mode_strip.h"
#include "stokes/solver.h"

#include <algorithm>

namespace bdh {

/// Normals for the modes index(0) .. index(count - 1), and for some more that pad the strip.  All
/// draws of the problem are already combined in them.
template <class Index, class Real>
void draw_strip(const StokesProblem &p, Index index, long count, StripNormals<Real> &out)
{
  for (auto &part : out.z) std::fill_n(part, padded(count), Real(0));
  if (!p.noisy()) return;
  for (const StressDraw &draw : p.stress) {
    if (!p.normals) {
      add_normals({p.seed, Stream::fluid, p.step, draw.stage}, draw.weight, index, count, out);
      continue;
    }
    for (long i = 0; i < count; ++i) {
      double z[4];
      p.normals->get(draw.stage, index(i), z);
      for (int m = 0; m < 4; ++m) out.z[m][i] += draw.weight * root_half * z[m];
    }
  }
}

}    // namespace bdh
#endif
