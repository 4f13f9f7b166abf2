// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/pair_counts.h"

#include "base/constants.h"
#include "base/portable.h"
#include "base/ssize.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace bdh {

namespace {

// All pairs of a sample take this number squared times 2 ns.
constexpr double sample_size = 3000.0;

/// Squared distances are binned by the leading bits of single precision: four bins for each factor
/// of 2, from 1/4 to 2^42.
constexpr int per_factor = 4, bins = 44 * per_factor, discarded_bits = 21;

int key(float square)
{
  uint32_t bits;
  std::memcpy(&bits, &square, sizeof bits);
  return bits >> discarded_bits;
}

int bin(float square)
{
  static const int first = key(0.25f);
  return std::clamp(key(square) - first, 0, bins - 1);
}

/// The square from which the bins after b begin.
double upper_edge(int b)
{
  return std::ldexp(1.0 + (b % per_factor + 1.0) / per_factor, b / per_factor - 2);
}

/// A number without pattern, from 0 to 1, for each id.
double lot(uint64_t id)
{
  id = (id ^ (id >> 30)) * 0xbf58476d1ce4e5b9ULL + 0x9e3779b97f4a7c15ULL;
  id = (id ^ (id >> 27)) * 0x94d049bb133111ebULL;
  id = (id ^ (id >> 30)) * 0xbf58476d1ce4e5b9ULL;
  return std::ldexp(static_cast<double>((id ^ (id >> 31)) >> 11), -53);
}

/// Fractional coordinates of the sample, by axis, on all ranks.
using Sample = std::array<std::vector<double>, 3>;

Sample gather_sample(const Cell &cell, const double *x, const uint64_t *id, long n, double share,
                     const Comm &comm)
{
  std::vector<double> mine;
  for (long i = 0; i < n; ++i) {
    if (share < 1.0 && lot(id[i]) >= share) continue;
    double s[3];
    cell.to_fractional(x + 3 * i, s);
    if (!std::isfinite(s[0] + s[1] + s[2])) continue;
    for (double c : s) mine.push_back(c - std::floor(c));
  }
  int count = mine.size();
  std::vector<int> counts(comm.size()), begin(comm.size() + 1, 0);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, comm.handle());
  for (int r = 0; r < comm.size(); ++r) begin[r + 1] = begin[r] + counts[r];
  std::vector<double> all(begin.back());
  MPI_Allgatherv(mine.data(), count, MPI_DOUBLE, all.data(), counts.data(), begin.data(),
                 MPI_DOUBLE, comm.handle());
  Sample sample;
  for (std::size_t i = 0; i < all.size(); ++i) sample[i % 3].push_back(all[i]);
  return sample;
}

/// To the nearest image, of a difference between -1 and 1.  A difference and its negative give the
/// same distance.
inline double nearest(double ds) { return ds - (ds > 0.5 ? 1.0 : 0.0) + (ds < -0.5 ? 1.0 : 0.0); }

/// squares := squared distances of the sample's particles from particle i [radius^2]
void squares_from(const Cell &cell, double radius, const Sample &sample, long i,
                  std::vector<float> &squares)
{
  const double *s0 = sample[0].data(), *s1 = sample[1].data(), *s2 = sample[2].data();
  const double i0 = s0[i], i1 = s1[i], i2 = s2[i], lx = cell.lx / radius, ly = cell.ly / radius,
               lz = cell.lz / radius, xy = cell.xy / radius, xz = cell.xz / radius,
               yz = cell.yz / radius;
  float *to = squares.data();
  const long count = ssize(squares);
  BDH_INDEPENDENT
  for (long j = 0; j < count; ++j) {
    const double a = nearest(s0[j] - i0), b = nearest(s1[j] - i1), c = nearest(s2[j] - i2);
    const double dx = a * lx + b * xy + c * xz, dy = b * ly + c * yz, dz = c * lz;
    to[j] = dx * dx + dy * dy + dz * dz;
  }
}

/// Sums over the sample's particles, of the numbers of others up to the end of each bin: whole
/// numbers, which are the same in any order.
struct Sums {
  std::vector<double> others = std::vector<double>(bins, 0.0);
  std::vector<double> products = others;    // of a number and that number less 1
  std::vector<double> greatest = others;

  void add(const std::array<int, bins> &histogram)
  {
    double within = -1.0;    // itself
    for (int b = 0; b < bins; ++b) {
      within += histogram[b];
      others[b] += within;
      products[b] += within * (within - 1.0);
      greatest[b] = std::max(greatest[b], within);
    }
  }
  void over_ranks(const Comm &comm)
  {
    MPI_Allreduce(MPI_IN_PLACE, others.data(), bins, MPI_DOUBLE, MPI_SUM, comm.handle());
    MPI_Allreduce(MPI_IN_PLACE, products.data(), bins, MPI_DOUBLE, MPI_SUM, comm.handle());
    MPI_Allreduce(MPI_IN_PLACE, greatest.data(), bins, MPI_DOUBLE, MPI_MAX, comm.handle());
  }
};

}    // namespace

PairCounts count_pairs(const Cell &cell, double radius, const double *x, const uint64_t *id, long n,
                       const Comm &comm)
{
  const double all = comm.sum(static_cast<double>(n));
  const bool whole = all <= sample_size;
  const Sample sample = gather_sample(cell, x, id, n, whole ? 1.0 : sample_size / all, comm);
  const long count = ssize(sample[0]);
  PairCounts counts;
  if (count < 2) return counts;

  Sums sums;
  std::vector<float> squares(count);
  for (long i = comm.rank(); i < count; i += comm.size()) {
    squares_from(cell, radius, sample, i, squares);
    std::array<int, bins> histogram{};
    for (float square : squares) ++histogram[bin(square)];
    sums.add(histogram);
  }
  sums.over_ranks(comm);

  const double scale = whole ? 1.0 : (all - 1.0) / (count - 1.0),
               reach = 0.5 * std::min({cell.height(0), cell.height(1), cell.height(2)});
  for (int b = 0; b < bins; ++b) {
    const double r = radius * std::sqrt(upper_edge(b));
    if (r > reach) break;
    counts.radii.push_back(r);
    counts.mean.push_back(scale * sums.others[b] / count);
    // A sample sees each of a particle's neighbors by chance, which this ratio does not notice.
    counts.crowded.push_back(sums.others[b] > 0.0 ? 1.0 + scale * sums.products[b] / sums.others[b]
                                                  : 0.0);
    const double most = sums.greatest[b], chance = whole ? 0.0 : 3.0 * std::sqrt(most);
    counts.largest.push_back(std::max(scale * (most - chance), counts.mean.back()));
  }
  return counts;
}

double others_within(const PairCounts &counts, const std::vector<double> PairCounts::*entry,
                     double density, double r)
{
  const auto volume = [](double radius) { return 4.0 / 3.0 * pi * radius * radius * radius; };
  const double even = density * volume(r);
  if (counts.empty()) return even;
  const std::vector<double> &radii = counts.radii, &n = counts.*entry;
  const long k = std::lower_bound(radii.begin(), radii.end(), r) - radii.begin();
  if (k == ssize(radii))
    return std::max(even, n.back() + density * (volume(r) - volume(radii.back())));
  const double inner = k > 0 ? radii[k - 1] : 0.0, at_inner = k > 0 ? n[k - 1] : 0.0;
  const double share = (volume(r) - volume(inner)) / (volume(radii[k]) - volume(inner));
  return std::max(even, at_inner + share * (n[k] - at_inner));
}

}    // namespace bdh
