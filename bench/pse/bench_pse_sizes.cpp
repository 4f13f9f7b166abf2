// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Cost of unequal radii and of rotation in positively split Ewald, over that of equal spheres under
// forces alone.
//
//   bench_pse_sizes [N=10000] [phi=0.1] [tolerance=1e-3] [rounds=5]
//
// Runs on one process, with hard spheres of radius 1 whose radii are then made smaller, and a skin
// of 0.5.  All cases take turns for several rounds; ratios are medians of those within a round.
// Times are processor times in ms, and parts are in % of them.

#include "pse/pse_scene.h"

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <numeric>

using namespace bdh;
using namespace bdh_bench;

namespace {

struct Case {
  double ratio;
  int classes;
  bool rotation;
};

const Case cases[] = {{1, 1, false},    {2, 2, false},  {4, 2, false},   {4, 10, false},
                      {4, 1000, false}, {10, 2, false}, {10, 10, false}, {1, 1, true},
                      {2, 2, true},     {4, 2, true},   {4, 1000, true}, {10, 10, true}};

/// One case, ready to be evaluated.
struct Run {
  Scene scene;
  PsePlan plan;
  std::unique_ptr<Bound> bound;
  std::vector<double> seconds;

  Run(const Scene &equal, const Case &c, double tolerance, bool noise) : scene(equal)
  {
    scene.set_radii(c.ratio, c.classes);
    scene.rotation = c.rotation;
    plan = plan_pse(scene.pse(tolerance, 0.0, noise), scene.conditions());
    bound = std::make_unique<Bound>(scene, plan);
  }
};

/// Processor time of three evaluations, each.
double seconds_of(Bound &bound, bool noise)
{
  const std::clock_t start = std::clock();
  for (int i = 0; i < 3; ++i) noise ? bound.fluctuate() : bound.apply();
  const double ticks = std::clock() - start;
  return ticks / CLOCKS_PER_SEC / 3.0;
}

double median(std::vector<double> v)
{
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

void measure(const Scene &equal, double tolerance, int rounds, bool noise)
{
  std::vector<std::unique_ptr<Run>> runs;
  for (const Case &c : cases) runs.push_back(std::make_unique<Run>(equal, c, tolerance, noise));
  std::vector<PhaseTimes> parts(runs.size(), PhaseTimes{});
  for (int round = 0; round <= rounds; ++round)
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const PhaseTimes before = PhaseClock::mine().times();
      const double t = seconds_of(*runs[i]->bound, noise);
      if (round == 0) continue;    // tables are filled
      runs[i]->seconds.push_back(t);
      for (std::size_t p = 0; p < parts[i].size(); ++p)
        parts[i][p] += PhaseClock::mine().times()[p] - before[p];
    }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Run &r = *runs[i];
    std::vector<double> over;
    for (int k = 0; k < rounds; ++k) over.push_back(r.seconds[k] / runs[0]->seconds[k]);
    const double all = std::accumulate(parts[i].begin(), parts[i].end(), 0.0);
    const auto part = [&](Phase p) { return 100.0 * parts[i][static_cast<int>(p)] / all; };
    std::printf("%g,%d,%s,%s,%.3f,%.2f,%ld,%d,%.0f,%d,%.2f,%.2f,%.2f,%.0f,%.0f,%.0f,%.0f,%.0f\n",
                cases[i].ratio, cases[i].classes, cases[i].rotation ? "yes" : "no",
                noise ? "yes" : "no", r.plan.xi, r.plan.r_cut, r.plan.n[0], r.plan.window.width,
                r.plan.neighbors, r.bound->report.iterations, 1e3 * median(r.seconds),
                1e3 * r.plan.seconds(), median(over), part(Phase::pairs), part(Phase::lanczos),
                part(Phase::spread), part(Phase::transform) + part(Phase::modes),
                part(Phase::interpolate));
  }
  std::fflush(stdout);
}

}    // namespace

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  const long n = argc > 1 ? std::atol(argv[1]) : 10000;
  const double phi = argc > 2 ? std::atof(argv[2]) : 0.1,
               tolerance = argc > 3 ? std::atof(argv[3]) : 1e-3;
  const int rounds = argc > 4 ? std::atoi(argv[4]) : 5;
  std::fprintf(stderr, "N %ld, phi %g of radii 1, tolerance %g\n", n, phi, tolerance);
  std::printf(
      "ratio,classes,rotation,noise,xi,r_cut,grid,window,neighbors,iterations,ms,expected_ms,"
      "over_equal,pairs,lanczos,spreading,transforms,interpolation\n");
  const Scene equal(n, phi);
  for (bool noise : {false, true}) measure(equal, tolerance, rounds, noise);
  MPI_Finalize();
}
