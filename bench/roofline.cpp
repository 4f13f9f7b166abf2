// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Where the parts of a step lie below the roofs of this core: arithmetic, and bytes to and from
/// wherever the working set is.
///
///     roofline [n ...]     default: 64 128 1000 10000 100000
///
/// Below 1000, n is the number of cells per axis of bd/fib, otherwise of spheres of bd/pse.  All is
/// in single precision, on one rank and thread.  Flops and bytes are counted from the definitions,
/// not measured; bytes count each time that a part has to go over its array.
///
/// Transforms: six real ones of 2.5 c log2 c flops for c points, in three passes over the grid,
/// each of which reads and writes it: planes, slow axis there and back, planes.  Of bd/pse 0.35
/// plus 0.65 times the share of modes that are kept, since all rows are transformed.
///
/// Spreading: W^3 points of three components, 2 flops each, 4 with the drift of bd/fib.  The grid
/// is read and written once, and in bd/pse cleared before; particles are read.  Interpolation: 2
/// flops each; the grid is read.
///
/// Products of M_r: 28 flops and 24 bytes for each pair, vectors read and written.
///
/// Roofs: multiply-adds of vectors in registers; a loop x := x + a over an array of the same size.
#include "base/registers.h"
#include "fib/step.h"
#include "pse/pse_scene.h"

#include <cstdio>
#include <cstdlib>

using namespace bdh;
using namespace bdh_bench;

namespace {

/// What a part does, and the time that it takes [s].
struct Part {
  const char *name;
  double seconds, flops, bytes;
  double working_set;    // bytes that it goes over
};

double best_time(int repeats, const std::function<void()> &work)
{
  return sorted_times(repeats, work).front();
}

/// Flops per second of multiply-adds that do not wait for each other.
double peak_flops()
{
  constexpr int lanes = lanes_of_register<float>, chains = 12;
  constexpr long rounds = 2000000;
  LanesOf<float, lanes> x[chains] = {}, a{}, b{};
  a += 0.5f;
  b += 1.0f;
  const double seconds = best_time(9, [&] {
    for (long i = 0; i < rounds; ++i)
#pragma GCC unroll 12
      for (auto &v : x) v = v * a + b;
  });
  volatile float used = x[0][0] + x[chains - 1][0];
  (void) used;
  return 2.0 * lanes * chains * rounds / seconds;
}

/// Bytes per second, read and written, of a loop over this many bytes.
double bandwidth(double bytes)
{
  AlignedArray<float> x(std::max(1024.0, bytes / sizeof(float)), 0.0f);
  const long passes = std::max(1.0, 2e8 / (sizeof(float) * x.size()));
  const double seconds = best_time(9, [&] {
    for (long p = 0; p < passes; ++p) {
      float *v = x.data();
      const long n = ssize(x);
      BDH_INDEPENDENT
      for (long i = 0; i < n; ++i) v[i] += 1.0f;
    }
  });
  return 2.0 * sizeof(float) * x.size() * passes / seconds;
}

void print(const Part &p, double flops_roof)
{
  const double by_flops = p.flops / flops_roof, by_bytes = p.bytes / bandwidth(p.working_set),
               limit = std::max(by_flops, by_bytes);
  std::printf("  %-14s %9.3f | %9.2f %9.2f %6.1f %6.1f | %9.3f %9.3f | %s, %3.0f %%\n", p.name,
              1e3 * p.seconds, 1e-6 * p.flops, 1e-6 * p.bytes, 1e-9 * p.flops / p.seconds,
              1e-9 * p.bytes / p.seconds, 1e3 * by_flops, 1e3 * by_bytes,
              by_flops > by_bytes ? "flops" : "bytes", 100.0 * limit / p.seconds);
  std::fflush(stdout);
}

Part transforms(double seconds, double cells)
{
  const double field = 3.0 * sizeof(float) * cells;
  return {"transforms", seconds, 6.0 * 2.5 * cells * std::log2(cells), 3.0 * 2.0 * field, field};
}

/// flops: per point and component; passes: over the grid.
Part through_grid(const char *name, double seconds, double particles, int width, int flops,
                  int passes, double cells)
{
  const double field = 3.0 * sizeof(float) * cells;
  return {name, seconds, 3.0 * flops * std::pow(width, 3) * particles,
          passes * field + 6.0 * sizeof(double) * particles, field};
}

void fib(long n, double flops_roof)
{
  Grid grid;
  grid.n = {n, n, n};
  grid.length.fill(n);
  FibFluid<FibOnHostIn<float>> fluid(grid, IbKernel::peskin4, FftEffort::measure,
                                     Comm(MPI_COMM_SELF));
  const long particles = grid.cells() / 32;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.0, n);
  std::vector<double> x(3 * particles), force(x.size(), 1.0), velocity(x.size());
  for (double &c : x) c = uniform(random);
  fluid.bind(x.data(), particles);
  StokesProblem quiet;
  quiet.stress = {{1.0, 0}};
  constexpr int repeats = 25, width = 4;
  PhaseTimes least;
  least.fill(1e9);
  double spread = 1e9, interpolate = 1e9;
  for (int i = 0; i < repeats; ++i) {
    fluid.clear();
    spread = std::min(spread, best_time(1, [&] { fluid.spread(force.data(), 1.0); }));
    const PhasesSince start;
    fluid.solve(quiet);
    for (Phase p : {Phase::transform, Phase::modes})
      least[int(p)] = std::min(least[int(p)], start.seconds({p}));
    interpolate = std::min(interpolate, best_time(1, [&] { fluid.interpolate(velocity.data()); }));
  }
  const double cells = grid.cells();
  std::printf("bd/fib, %ld^3 cells, %ld particles\n", n, particles);
  print(transforms(least[int(Phase::transform)], cells), flops_roof);
  print(through_grid("spreading", spread, particles, width, 4, 2, cells), flops_roof);
  print(through_grid("interpolation", interpolate, particles, width, 2, 1, cells), flops_roof);
}

void pse(long n, double flops_roof)
{
  const Scene scene(n, 0.1);
  const PsePlan plan = plan_pse(scene.pse(1e-3, 0.0, true), scene.conditions());
  Bound bound(scene, plan);
  bound.fluctuate();
  PhaseTimes least;
  least.fill(1e9);
  const int repeats = std::max(9, int(0.5 / plan.seconds()));
  for (int i = 0; i < repeats; ++i) {
    const PhasesSince start;
    bound.fluctuate();
    for (int p = 0; p < phase_count; ++p) least[p] = std::min(least[p], start.seconds({Phase(p)}));
  }
  const auto seconds = [&](Phase p) { return least[int(p)]; };
  const double cells = 1.0 * plan.n[0] * plan.n[1] * plan.n[2], pairs = bound.mobility().pairs(),
               vectors = 4.0 * sizeof(float) * n, products = bound.report.iterations;
  const int width = plan.window.width;
  std::printf("bd/pse, %ld spheres, phi = 0.1, tolerance 1e-3\n"
              "  %ld^3 points, window %d, %.1f pairs per sphere, %g products\n",
              n, plan.n[0], width, pairs / n, products);
  Part fft = transforms(seconds(Phase::transform), cells);
  const double kept = 0.35 + 0.65 * plan.modes / cells;
  fft.flops *= kept;
  fft.bytes *= kept;
  print(fft, flops_roof);
  print(through_grid("spreading", seconds(Phase::spread), n, width, 2, 3, cells), flops_roof);
  print(through_grid("interpolation", seconds(Phase::interpolate), n, width, 2, 1, cells),
        flops_roof);
  const double kept_pairs = 24.0 * pairs;
  print({"products", seconds(Phase::lanczos), products * 28.0 * pairs,
         products * (kept_pairs + 3.0 * vectors), kept_pairs},
        flops_roof);
}

}    // namespace

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  std::vector<long> sizes;
  for (int a = 1; a < argc; ++a) sizes.push_back(std::atol(argv[a]));
  if (sizes.empty()) sizes = {64, 128, 1000, 10000, 100000};
  const double roof = peak_flops();
  std::printf("multiply-adds in registers: %.0f Gflop/s; loops over", 1e-9 * roof);
  for (double megabytes : {0.02, 1.0, 16.0, 256.0})
    std::printf(" %g MB: %.0f", megabytes, 1e-9 * bandwidth(1e6 * megabytes));
  std::printf(" GB/s\n  %-14s %9s | %9s %9s %6s %6s | %9s %9s | limit, attained\n", "part", "ms",
              "Mflop", "MB", "Gfl/s", "GB/s", "flops ms", "bytes ms");
  for (const long n : sizes) n < 1000 ? fib(n, roof) : pse(n, roof);
  MPI_Finalize();
}
