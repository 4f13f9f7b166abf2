// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Cost of an evaluation of positively split Ewald, part by part, compared with the cost model.
//
//   bench_pse_step [phi=0.1] [tolerance=1e-3] [xi=auto in units of 1/a, or a list a,b,c] [N ...]
//
// Runs on one process, with random hard spheres and a skin of 0.5 a.  Prints medians of several
// evaluations in ms; real and wave are what the cost model expects of both parts.

#include "pse/pse_scene.h"

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

using namespace bdh;
using namespace bdh_bench;

namespace {

void measure(const Scene &s, double tolerance, double xi, bool noise)
{
  const PsePlan plan = plan_pse(s.pse(tolerance, xi, noise), s.conditions());
  Bound bound(s, plan);
  const auto work = [&] { noise ? bound.fluctuate() : bound.apply(); };
  work();
  const int repeats = std::max(repeats_for(plan.seconds(), 3.0), int(0.3 / plan.seconds()));
  const PhasesSince start;
  const double total = median_time(repeats, work),
               bytes = bound.mobility().grid_memory() + bound.mobility().particle_memory();
  const auto each = [&](std::initializer_list<Phase> p) {
    return 1e3 * start.seconds(p) / repeats;
  };
  std::printf(
      "%8ld %5.2f %7.0e %-5s %6.3f %6.2f %4ld %3d %4.0f %3d %8.3f %8.3f | %8.3f %8.3f %8.3f %8.3f "
      "%8.3f %8.3f | %8.3f %8.3f | %8.1f %7.3f %5.0f\n",
      s.n, s.phi(), tolerance, noise ? "noise" : "M F", plan.xi, plan.r_cut, plan.n[0],
      plan.window.width, plan.neighbors, bound.report.iterations, 1e3 * total, 1e3 * plan.seconds(),
      each({Phase::pairs}), each({Phase::lanczos}), each({Phase::spread}), each({Phase::transform}),
      each({Phase::modes}), each({Phase::interpolate}), 1e3 * plan.real_seconds,
      1e3 * plan.wave_seconds, 1.0 / total, 1e-6 * s.n / total, bytes / s.n);
  std::fflush(stdout);
}

}    // namespace

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  const double phi = argc > 1 ? std::atof(argv[1]) : 0.1,
               tolerance = argc > 2 ? std::atof(argv[2]) : 1e-3;
  std::vector<double> splittings;
  std::istringstream list(argc > 3 ? argv[3] : "auto");
  for (std::string word; std::getline(list, word, ',');)
    splittings.push_back(word == "auto" ? 0.0 : std::atof(word.c_str()));
  std::vector<long> sizes;
  for (int i = 4; i < argc; ++i) sizes.push_back(std::atol(argv[i]));
  if (sizes.empty()) sizes = {10000, 100000};
  std::printf("%8s %5s %7s %-5s %6s %6s %4s %3s %4s %3s %8s %8s | %8s %8s %8s %8s %8s %8s | %8s "
              "%8s | %8s %7s %5s\n",
              "N", "phi", "tol", "what", "xi a", "r_c/a", "grid", "W", "nbr", "it", "ms",
              "expected", "pairs", "lanczos", "spread", "transf.", "modes", "interp.", "real",
              "wave", "1/s", "1e6 p/s", "B/p");
  for (long n : sizes) {
    const Scene s(n, phi);
    for (double xi : splittings)
      for (bool noise : {false, true}) measure(s, tolerance, xi, noise);
  }
  MPI_Finalize();
}
