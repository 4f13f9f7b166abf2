// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Compares the splitting that the plan chooses with a scan, for dilute, clustered and dense scenes.
//
//   bench_pse_scan [tolerance=1e-3] [seconds=0.2: at least, per measurement] [words of scenes ...]
//
// Runs on one process, with noise.  Times are processor times in seconds, averaged over several
// evaluations, since the number of Lanczos iterations depends on the noise.  The last line of a
// scene compares xi auto with the best xi of the scan.

#include "pse/pse_scene.h"

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

using namespace bdh;
using namespace bdh_bench;

namespace {

std::vector<double> uniform(long n, double L)
{
  std::mt19937_64 engine(11);
  std::uniform_real_distribution<double> place(0.0, L);
  std::vector<double> x(3 * n);
  for (double &c : x) c = place(engine);
  return x;
}

/// n overlapping spheres within a distance R of the middle.
std::vector<double> globule(long n, double R, double L)
{
  std::mt19937_64 engine(12);
  std::uniform_real_distribution<double> place(-R, R);
  std::vector<double> x;
  while (ssize(x) < 3 * n) {
    const double y[3] = {place(engine), place(engine), place(engine)};
    if (y[0] * y[0] + y[1] * y[1] + y[2] * y[2] > R * R) continue;
    for (double c : y) x.push_back(0.5 * L + c);
  }
  return x;
}

/// n spheres that touch one another, grown from the middle without overlap: a branched cluster.
std::vector<double> gel(long n, double L)
{
  std::mt19937_64 engine(13);
  std::normal_distribution<double> normal;
  std::vector<double> x = {0.5 * L, 0.5 * L, 0.5 * L};
  while (ssize(x) < 3 * n) {
    const long from = std::uniform_int_distribution<long>(0, ssize(x) / 3 - 1)(engine);
    double e[3] = {normal(engine), normal(engine), normal(engine)}, y[3];
    const double length = std::sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
    for (int d = 0; d < 3; ++d) y[d] = x[3 * from + d] + 2.02 * e[d] / length;
    bool free = true;
    for (long i = 0; i < ssize(x) / 3 && free; ++i)
      free = std::pow(x[3 * i] - y[0], 2) + std::pow(x[3 * i + 1] - y[1], 2) +
                 std::pow(x[3 * i + 2] - y[2], 2) >=
             4.0;
    if (free) x.insert(x.end(), y, y + 3);
  }
  return x;
}

std::vector<double> joined(std::vector<double> a, const std::vector<double> &b)
{
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

struct Result {
  PsePlan plan;
  double seconds;
};

Result measure(const Scene &s, const PseScene &pse, const PseConditions &conditions, double least)
{
  const PsePlan plan = plan_pse(pse, conditions);
  Bound bound(s, plan, conditions.skin, FftEffort::estimate);
  bound.fluctuate();
  const PhasesSince start;
  const std::clock_t first = std::clock();
  double spent = 0.0, iterations = 0.0;
  int repeats = 0;
  for (; repeats < 5 || (spent < least && repeats < 500); ++repeats) {
    bound.fluctuate();
    iterations += bound.report.iterations;
    const double ticks = std::clock() - first;
    spent = ticks / CLOCKS_PER_SEC;
  }
  const double seconds = spent / repeats, grid_bytes = bound.mobility().grid_memory();
  const auto each = [&](std::initializer_list<Phase> p) { return start.seconds(p) / repeats; };
  std::printf("  %10.3g %10.4g %9.1f %5d %4ld %3d | %3d %4.1f | %9.2e %9.2e %5.2f | %9.2e %9.2e  "
              "%9.2e %9.2e | %9.2e %9.2e\n",
              plan.xi, plan.r_cut, plan.neighbors, static_cast<int>(plan.most_neighbors), plan.n[0],
              plan.window.width, plan.iterations, iterations / repeats, seconds, plan.seconds(),
              plan.seconds() / seconds, each({Phase::pairs, Phase::lanczos}), plan.real_seconds,
              each({Phase::spread, Phase::interpolate, Phase::transform, Phase::modes}),
              plan.wave_seconds, plan.grid_bytes, grid_bytes);
  std::fflush(stdout);
  return {plan, seconds};
}

void scan(const char *name, const Scene &s, double tolerance, double least)
{
  std::printf("%s: %ld in %g, tolerance %g\n", name, s.n, s.L, tolerance);
  std::printf("  %10s %10s %9s %5s %4s %3s | %3s %4s | %9s %9s %5s | %9s %9s  %9s %9s | %9s %9s\n",
              "xi", "r_c", "neighbors", "most", "grid", "W", "it", "is", "seconds", "expected",
              "ratio", "real", "expected", "wave", "expected", "bytes", "are");
  PseScene pse = s.pse(tolerance, 0.0, true);
  const PseConditions conditions = s.conditions();
  const Result chosen = measure(s, pse, conditions, least);
  double best = chosen.seconds, at = chosen.plan.xi;
  for (int i = -5; i <= 5; ++i) {
    pse.xi = chosen.plan.xi * std::pow(1.3, i);
    if (i == 0 || pse.xi > 20.0) continue;
    if (plan_pse(pse, conditions).seconds() > 10.0 * chosen.plan.seconds()) continue;
    const Result r = measure(s, pse, conditions, least);
    if (r.seconds >= best) continue;
    best = r.seconds;
    at = r.plan.xi;
  }
  std::printf("  chosen xi %.3g: %.2e s, expected %.2f of it; best of the scan at %.3g: %.2e s; "
              "ratio %.2f\n",
              chosen.plan.xi, chosen.seconds, chosen.plan.seconds() / chosen.seconds, at, best,
              chosen.seconds / best);
}

}    // namespace

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  const double tolerance = argc > 1 ? std::atof(argv[1]) : 1e-3,
               least = argc > 2 ? std::atof(argv[2]) : 0.2;
  const auto wanted = [&](const std::string &name) {
    bool any = argc <= 3;
    for (int i = 3; i < argc; ++i) any = any || name.find(argv[i]) != std::string::npos;
    return any;
  };
  const auto run = [&](const char *name, double L, auto positions) {
    if (wanted(name)) scan(name, Scene(positions(), L), tolerance, least);
  };
  for (double L : {1e2, 1e3, 2e3, 1e4, 1e5})
    for (long n : {20, 100, 1000}) run("dilute", L, [&] { return uniform(n, L); });
  for (double L : {1e2, 1e3, 1e4})
    for (double R : {18.0, 4.5}) run("globule", L, [&] { return globule(3000, R, L); });
  for (double L : {1.2e2, 1e3, 1e4}) run("gel", L, [&] { return gel(2000, L); });
  run("globule and gas", 200.0,
      [&] { return joined(globule(1000, 12.0, 200.0), hard_spheres(10000, 200.0, 3)); });
  for (double phi : {0.02, 0.1, 0.3}) {
    const double L = Scene::side(20000, phi);
    run("dense", L, [&] { return hard_spheres(20000, L, 1); });
  }
  MPI_Finalize();
}
