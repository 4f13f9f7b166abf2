// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Hasimoto's splitting and that of Kaiser and Bessel, each with the parameters that are cheapest by
// the cost model: modes, neighbors, achieved error, and processor time in turns.
//
//   bench_pse_splitting [phi=0.1] [N=10000] [tolerance ...]
//
// One process, random hard spheres.  `error` is that of M F, relative to a plan whose tolerance is
// a thousandth with the other splitting; `ratio` is the median of the ratios of neighboring turns.

#include "pse/pse_scene.h"

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>

using namespace bdh;
using namespace bdh_bench;

namespace {

constexpr Splitting kinds[] = {Splitting::hasimoto, Splitting::kaiser_bessel};

PsePlan plan_of(const Scene &s, Splitting kind, double tolerance, bool noise)
{
  PseScene scene = s.pse(tolerance, 0.0, noise);
  scene.splitting = kind;
  return plan_pse(scene, s.conditions());
}

double processor_time(const std::function<void()> &work)
{
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

double median(std::vector<double> v)
{
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

double error_of(const Scene &s, const PsePlan &plan, Splitting other)
{
  Bound exact(s, plan_of(s, other, std::max(1e-3 * plan.tolerance, 1e-11), false)), own(s, plan);
  return relative_difference(own.apply(), exact.apply());
}

void compare(const Scene &s, double tolerance, bool noise)
{
  std::unique_ptr<Bound> bound[2];
  std::vector<double> times[2], ratios;
  PsePlan plans[2];
  for (int i = 0; i < 2; ++i) {
    plans[i] = plan_of(s, kinds[i], tolerance, noise);
    bound[i] = std::make_unique<Bound>(s, plans[i]);
  }
  const auto work = [&](int i) { noise ? bound[i]->fluctuate() : bound[i]->apply(); };
  for (int i : {0, 1}) work(i);
  for (int turn = 0; turn < 2 * repeats_for(plans[0].seconds(), 2.0) + 1; ++turn) {
    for (int i : {0, 1}) times[i].push_back(processor_time([&] { work(i); }));
    ratios.push_back(times[0].back() / times[1].back());
  }
  for (int i : {0, 1})
    std::printf("%8ld %5.2f %7.0e %-5s %-9s %6.3f %6.2f %6.2f %4ld %3d %8.0f %5.0f %3d %7.2f "
                "%9.5f %9.5f %6.2f\n",
                s.n, s.phi(), tolerance, noise ? "noise" : "M F", i ? "kaiser" : "hasimoto",
                plans[i].xi, plans[i].r_cut, plans[i].k_cut, plans[i].n[0], plans[i].window.width,
                plans[i].modes, plans[i].neighbors, bound[i]->report.iterations,
                error_of(s, plans[i], kinds[1 - i]) / tolerance, plans[i].seconds(),
                median(times[i]), i ? median(ratios) : 1.0);
  std::fflush(stdout);
}

}    // namespace

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  const Scene s(argc > 2 ? std::atol(argv[2]) : 10000, argc > 1 ? std::atof(argv[1]) : 0.1);
  std::vector<double> tolerances;
  for (int i = 3; i < argc; ++i) tolerances.push_back(std::atof(argv[i]));
  if (tolerances.empty()) tolerances = {1e-2, 1e-3, 1e-4, 1e-6};
  std::printf("%8s %5s %7s %-5s %-9s %6s %6s %6s %4s %3s %8s %5s %3s %7s %9s %9s %6s\n", "N", "phi",
              "tol", "what", "splitting", "xi a", "r_c/a", "k_c a", "grid", "W", "modes", "nbr",
              "it", "err/tol", "expected", "seconds", "ratio");
  for (double tolerance : tolerances)
    for (bool noise : {false, true}) compare(s, tolerance, noise);
  MPI_Finalize();
}
