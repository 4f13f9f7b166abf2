// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// How crowded it is around the particles of a configuration: others within a distance, counted.
#ifndef BDH_PSE_PAIR_COUNTS_H
#define BDH_PSE_PAIR_COUNTS_H

#include "base/comm.h"
#include "grid/cell_kernel.h"

#include <cstdint>
#include <vector>

namespace bdh {

/// Others within radii[k] of a particle, for radii up to half the cell; all empty: not counted.
struct PairCounts {
  std::vector<double> radii;      ///< ascending [length]
  std::vector<double> mean;       ///< over particles
  std::vector<double> crowded;    ///< over pairs: as many as a particle's neighbors have on average
  std::vector<double> largest;    ///< of any particle; of those that were looked at

  bool empty() const { return radii.empty(); }
};

/// Entry of `counts` (mean, crowded or largest) at distance r [length], where particles have a
/// number density [1/length^3].  Between radii by volume; beyond them the density applies.  Never
/// below that of evenly spread particles: what is together now may part during the run.
double others_within(const PairCounts &counts, const std::vector<double> PairCounts::*entry,
                     double density, double r);

/// Collective.  Counts around particles in a cell.
///
/// x: 3 n positions of this rank's particles, any periodic images; id: their ids, each only once;
/// radius: scale of the distances [length].  All ranks get the same counts, for any number of
/// ranks.  A sample, chosen by id, stands for more than a few thousand particles; their number has
/// no part in the time that this takes, but for a look at each id.  The sample's counts have an
/// error of their own: 10 % for 30 others in a million particles; `largest` leaves out what can be
/// chance.  Positions that are not finite are not counted.
PairCounts count_pairs(const Cell &cell, double radius, const double *x, const uint64_t *id, long n,
                       const Comm &comm);

}    // namespace bdh
#endif
