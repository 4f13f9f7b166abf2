// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Arrays of a staggered vector field in single or double precision.
#ifndef BDH_GRID_FIELD_H
#define BDH_GRID_FIELD_H

#include <array>

namespace bdh {

/// The components of a field on this rank's slab, in the layout of VectorFft.
template <class Real> using FieldOf = std::array<Real *, 3>;

}    // namespace bdh
#endif
