// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// What a face of the box is.
#ifndef BDH_GRID_BOUNDARY_H
#define BDH_GRID_BOUNDARY_H

namespace bdh {

/// Joined to the opposite face (periodic), a wall with friction (noslip) or without (slip), or
/// open: fluid without end lies behind it, with no particles and no walls in it.
enum class Boundary { periodic, noslip, slip, open };

}    // namespace bdh
#endif
