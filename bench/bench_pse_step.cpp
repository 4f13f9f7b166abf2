// What an evaluation of positively split Ewald costs, part by part, beside what the cost model expects.
//
//   bench_pse_step [phi=0.1] [tolerance=1e-3] [xi=auto in units of 1/a, or a list a,b,c] [N ...]
//
// One process.  Random hard spheres, skin 0.5 a.  Medians of several evaluations, in seconds.

#include "bdh_pse.h"
#include "cell_neighbors.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <sstream>
#include <string>

using namespace bdh;

namespace {

constexpr double pi = 3.14159265358979323846;

double median_time(int repeats, const std::function<void()> &work)
{
  std::vector<double> t;
  for (int i = 0; i < repeats; ++i) {
    double sum = 0.0;
    {
      const Stopwatch watch(sum);
      work();
    }
    t.push_back(sum);
  }
  std::sort(t.begin(), t.end());
  return t[t.size() / 2];
}

struct Scene {
  long n;
  double L;
  std::vector<double> x, force;
  std::vector<uint64_t> id;

  Scene(long count, double phi) : n(count), L(std::cbrt(4.0 / 3.0 * pi * static_cast<double>(count) / phi))
  {
    x = bdh_bench::hard_spheres(n, L, 1);
    std::mt19937_64 engine(2);
    std::normal_distribution<double> normal;
    for (long i = 0; i < 3 * n; ++i) force.push_back(normal(engine));
    for (long i = 0; i < n; ++i) id.push_back(static_cast<uint64_t>(i + 1));
  }
};

PseTimes difference(const PseTimes &a, const PseTimes &b)
{
  return {a.pairs - b.pairs, a.lanczos - b.lanczos, a.sort - b.sort, a.spread - b.spread, a.transform - b.transform,
          a.interpolate - b.interpolate};
}

void measure(const Scene &s, double phi, double tolerance, double xi, bool noise)
{
  PseScene scene;
  scene.volume = s.L * s.L * s.L;
  scene.edge = {s.L, s.L, s.L};
  scene.particles = s.n;
  scene.tolerance = tolerance;
  scene.noise = noise;
  scene.xi = xi;
  const PsePlan plan = plan_pse(scene);
  const bdh_bench::CellNeighbors neighbors(s.x, s.L, plan.r_cut + 0.5);
  const Comm comm(MPI_COMM_WORLD);
  const auto M = PseMobility::make(plan, comm, FftEffort::measure, 200, nullptr);
  Cell cell;
  cell.lx = cell.ly = cell.lz = s.L;
  M->set_cell(cell);
  std::vector<double> u(s.force.size());
  uint64_t step = 0;
  PseReport report;
  const auto work = [&] {
    M->bind(s.x.data(), s.n, neighbors.view(), s.n);
    if (noise)
      report = M->fluctuate(true, s.force.data(), {1.0, 7, ++step}, s.id, 1.0, u.data());
    else
      M->apply(s.force.data(), 1.0, u.data());
  };
  work();
  const PseTimes before = M->times();
  const int repeats = std::max(3, static_cast<int>(std::min(15.0, 3.0 / plan.seconds())));
  const double total = median_time(repeats, work);
  const PseTimes t = difference(M->times(), before);
  const double r = repeats;
  std::printf("%8ld %5.2f %7.0e %-5s %6.3f %6.2f %4ld %3d %4.0f %3d %9.4f %9.4f | %8.4f %8.4f %8.4f %8.4f %8.4f %8.4f | %8.4f %8.4f | %7.3f %5.0f\n",
              s.n, phi, tolerance, noise ? "noise" : "M F", plan.xi, plan.r_cut, plan.n[0], plan.window.width,
              plan.neighbors, report.iterations, total, plan.seconds(), t.pairs / r, t.lanczos / r, t.sort / r,
              t.spread / r, t.transform / r, t.interpolate / r, plan.real_seconds, plan.wave_seconds,
              1e-6 * static_cast<double>(s.n) / total,
              static_cast<double>(M->grid_memory() + M->particle_memory()) / static_cast<double>(s.n));
  std::fflush(stdout);
}

}    // namespace

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  const double phi = argc > 1 ? std::atof(argv[1]) : 0.1, tolerance = argc > 2 ? std::atof(argv[2]) : 1e-3;
  std::vector<double> splittings;
  std::istringstream list(argc > 3 ? argv[3] : "auto");
  for (std::string word; std::getline(list, word, ',');) splittings.push_back(word == "auto" ? 0.0 : std::atof(word.c_str()));
  std::vector<long> sizes;
  for (int i = 4; i < argc; ++i) sizes.push_back(std::atol(argv[i]));
  if (sizes.empty()) sizes = {10000, 100000};
  std::printf("%8s %5s %7s %-5s %6s %6s %4s %3s %4s %3s %9s %9s | %8s %8s %8s %8s %8s %8s | %8s %8s | %7s %5s\n", "N", "phi", "tol",
              "what", "xi a", "r_c/a", "grid", "W", "nbr", "it", "seconds", "expected", "pairs", "lanczos", "sort", "spread",
              "transf.", "interp.", "real", "wave", "1e6 p/s", "B/p");
  for (long n : sizes) {
    const Scene s(n, phi);
    for (double xi : splittings)
      for (bool noise : {false, true}) measure(s, phi, tolerance, xi, noise);
  }
  MPI_Finalize();
}
