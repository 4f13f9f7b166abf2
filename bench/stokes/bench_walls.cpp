// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Cost of walls: a midpoint step in a slit compared with a periodic one on the same grid, and the
// iterations of a closed box on grids from 16^3 to 96^3, in units of the transforms of one velocity
// solve.
//
//   bench_walls                          all of these on one rank, about a minute
//   mpirun -n 2 bench_walls 64 96 128    slits of these sizes on all ranks, alternating with the
//                                        first rank alone
//   bench_walls threads 2 32 64          closed boxes of these sizes on two threads, alternating
//                                        with one (requires a build with Kokkos)

#include "fib/host.h"
#include "fib/resting_particles.h"
#include "fib/step.h"
#include "grid/trig.h"
#ifdef BDH_BENCH_KOKKOS
#include "base/workers_kokkos.h"
#include "support/kokkos_threads.h"
#endif

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <mpi.h>
#include <random>
#include <vector>

namespace {

using namespace bdh;

double seconds_of(const std::function<void()> &work)
{
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> v)
{
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

Grid cube(long n, int walled_axes)
{
  Grid g;
  for (int d = 0; d < 3; ++d) {
    g.n[d] = n;
    g.length[d] = n;
    if (d >= 3 - walled_axes) g.boundary[d] = {Boundary::noslip, Boundary::noslip};
  }
  return g;
}

/// One particle per 32 cells, all under the same force.  This rank has the particles in layer
/// `part` of `parts` equal layers along z, which fill the box up to n times `height`.
bdh_bench::RestingParticles resting(long n, int parts = 1, int part = 0, double height = 1.0)
{
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> uniform(0.05, 0.95);
  std::vector<double> x(3 * (n * n * n / 32 / parts));
  for (double &v : x) v = n * uniform(engine);
  for (std::size_t i = 2; i < x.size(); i += 3) x[i] = height * (x[i] + n * part) / parts;
  return bdh_bench::RestingParticles(x, 0.1);
}

StepPlan short_step(uint64_t step)
{
  StepPlan p;
  p.dt = 1e-4;
  p.kT = 1.0;
  p.seed = 7;
  p.step = step;
  return p;
}

void slit_against_periodic(long n)
{
  const Comm comm(MPI_COMM_WORLD);
  FibFluid<FibOnHost> periodic(cube(n, 0), IbKernel::peskin4, FftEffort::measure, comm);
  FibFluid<FibOnHost> slit(cube(n, 1), IbKernel::peskin4, FftEffort::measure, comm);
  BrownianStep<FibOnHost> step[2] = {BrownianStep<FibOnHost>(periodic),
                                     BrownianStep<FibOnHost>(slit)};
  auto particles = resting(n);
  std::vector<double> t[2];
  for (uint64_t i = 0; i < 21; ++i)
    for (int k = 0; k < 2; ++k)
      t[k].push_back(seconds_of([&] { step[k].take(particles, short_step(i)); }));
  std::printf("%4ld  periodic step %8.2f ms  slit step %8.2f ms  ratio %.2f\n", n,
              1e3 * median(t[0]), 1e3 * median(t[1]), median(t[1]) / median(t[0]));
}

/// A grid of n rows above one wall, against one of as many rows between two.
void open_face_against_slit(long n)
{
  const Comm comm(MPI_COMM_WORLD);
  const long beyond = rows_beyond(IbKernel::peskin4);
  Grid box = cube(n, 1);
  box.n[2] -= beyond;
  box.length[2] -= beyond;
  box.boundary[2] = {Boundary::noslip, Boundary::open};
  FibFluid<FibOnHost> slit(cube(n, 1), IbKernel::peskin4, FftEffort::measure, comm);
  FibFluid<FibOnHost> open(beyond_open_faces(box, beyond), IbKernel::peskin4, FftEffort::measure,
                           comm);
  BrownianStep<FibOnHost> step[2] = {BrownianStep<FibOnHost>(slit), BrownianStep<FibOnHost>(open)};
  auto particles = resting(n, 1, 0, box.length[2] / double(n));
  std::vector<double> t[2];
  for (uint64_t i = 0; i < 41; ++i)
    for (int k = 0; k < 2; ++k)
      t[k].push_back(seconds_of([&] { step[k].take(particles, short_step(i)); }));
  std::printf("%4ld  slit step %8.2f ms  step above one wall %8.2f ms  ratio %.3f (least %.3f)\n",
              n, 1e3 * median(t[0]), 1e3 * median(t[1]), median(t[1]) / median(t[0]),
              *std::min_element(t[1].begin(), t[1].end()) /
                  *std::min_element(t[0].begin(), t[0].end()));
}

/// Wall time of a step on all ranks, alternating with the first rank alone while the others wait.
void slit_on_ranks(long n)
{
  const Comm all(MPI_COMM_WORLD), self(MPI_COMM_SELF);
  FibFluid<FibOnHost> together(cube(n, 1), IbKernel::peskin4, FftEffort::measure, all);
  BrownianStep<FibOnHost> shared(together);
  auto part = resting(n, all.size(), all.rank()), whole = resting(n);
  std::unique_ptr<FibFluid<FibOnHost>> alone;
  std::unique_ptr<BrownianStep<FibOnHost>> single;
  if (all.rank() == 0) {
    alone.reset(new FibFluid<FibOnHost>(cube(n, 1), IbKernel::peskin4, FftEffort::measure, self));
    single.reset(new BrownianStep<FibOnHost>(*alone));
  }
  std::vector<double> t[2];
  for (uint64_t i = 0; i < 41; ++i) {
    const auto timed = [&](const std::function<void()> &work) {
      MPI_Barrier(all.handle());
      return seconds_of([&] {
        work();
        MPI_Barrier(all.handle());
      });
    };
    t[0].push_back(timed([&] {
      if (single) single->take(whole, short_step(i));
    }));
    t[1].push_back(timed([&] { shared.take(part, short_step(i)); }));
  }
  if (all.rank() == 0) {
    const double least[2] = {*std::min_element(t[0].begin(), t[0].end()),
                             *std::min_element(t[1].begin(), t[1].end())};
    std::printf("%4ld  1 rank %8.2f ms (least %8.2f)  %d ranks %8.2f ms (least %8.2f)  ratio %.2f "
                "(least %.2f)\n",
                n, 1e3 * median(t[0]), 1e3 * least[0], all.size(), 1e3 * median(t[1]),
                1e3 * least[1], median(t[0]) / median(t[1]), least[0] / least[1]);
  }
}

void box(long n)
{
  const Comm comm(MPI_COMM_WORLD);
  FibFluid<FibOnHost> fluid(cube(n, 3), IbKernel::peskin4, FftEffort::measure, comm);
  BrownianStep<FibOnHost> step(fluid);
  auto particles = resting(n);
  WalledTransforms transforms(cube(n, 3), comm, FftEffort::measure);
  std::vector<AlignedVector> field(3, AlignedVector(transforms.allocation(), 0.0));
  const FieldView view{field[0].data(), field[1].data(), field[2].data()};
  std::vector<double> t, six;
  for (uint64_t i = 0; i < 3; ++i) {
    t.push_back(seconds_of([&] { step.take(particles, short_step(i)); }));
    six.push_back(seconds_of([&] { transforms.solve(view, [](const Slab &) {}); }));
  }
  const int iterations = fluid.report().iterations;
  std::printf("%4ld  iterations %3d  residual %.1e  step %9.2f ms  iteration %.2f of six "
              "transforms (%.2f ms)\n",
              n, iterations, fluid.report().residual, 1e3 * median(t),
              median(t) / iterations / median(six), 1e3 * median(six));
}

#ifdef BDH_BENCH_KOKKOS
/// Wall time of a step on all threads, alternating with one thread.
void box_on_threads(long n)
{
  const Comm comm(MPI_COMM_WORLD);
  FibFluid<FibOnHost> alone(cube(n, 3), IbKernel::peskin4, FftEffort::measure, comm);
  FibFluid<FibOnHost> together(cube(n, 3), IbKernel::peskin4, FftEffort::measure, comm,
                               host_workers());
  BrownianStep<FibOnHost> step[2] = {BrownianStep<FibOnHost>(alone),
                                     BrownianStep<FibOnHost>(together)};
  auto particles = resting(n);
  std::vector<double> t[2];
  for (uint64_t i = 0; i < 15; ++i)
    for (int k = 0; k < 2; ++k)
      t[k].push_back(seconds_of([&] { step[k].take(particles, short_step(i)); }));
  std::printf(
      "%4ld  1 thread %9.2f ms  %d threads %9.2f ms  ratio %.2f (least %.2f)\n", n,
      1e3 * median(t[0]), host_workers().count(), 1e3 * median(t[1]), median(t[0]) / median(t[1]),
      *std::min_element(t[0].begin(), t[0].end()) / *std::min_element(t[1].begin(), t[1].end()));
}

void boxes_on_threads(int argc, char **argv)
{
  bdh_test::initialize_kokkos(std::atoi(argv[2]));
  for (int a = 3; a < argc; ++a) box_on_threads(std::atol(argv[a]));
  Kokkos::finalize();
}
#else
void boxes_on_threads(int, char **)
{
  std::fprintf(stderr, "bench_walls threads: built without Kokkos\n");
}
#endif

}    // namespace

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (argc > 2 && std::strcmp(argv[1], "threads") == 0) {
    boxes_on_threads(argc, argv);
  } else if (ranks > 1) {
    for (int a = 1; a < argc; ++a) slit_on_ranks(std::atol(argv[a]));
  } else {
    std::printf("slit: two no-slip walls, one particle per 32 cells, peskin4, noise and drift\n");
    for (long n : {32L, 64L}) slit_against_periodic(n);
    std::printf("above one wall, with an open face instead of the other wall\n");
    for (long n : {32L, 64L}) open_face_against_slit(n);
    std::printf("closed box: six no-slip walls, tolerance 1e-8\n");
    for (long n : {16L, 32L, 48L, 64L, 96L}) box(n);
  }
  MPI_Finalize();
}
