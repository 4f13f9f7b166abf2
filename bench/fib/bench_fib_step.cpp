// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Cost of a step of bd/fib compared with six plain real transforms of FFTW of the same size, timed
/// in the same run.
///
///     bench_fib_step                      the tables
///     bench_fib_step stages 64 128        the first table at these sizes
///     mpirun -n 2 bench_fib_step 64 128   wall time of a whole step at these sizes, for comparison
///                                         with -n 1
///
/// The step is the midpoint scheme with noise, drift and the four-point kernel, for one particle
/// per 32 cells, in random order.  Times are medians over repetitions that alternate between the
/// candidates.
#include "fib/step.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fftw3.h>
#include <functional>
#include <memory>
#include <random>
#include <string>

using namespace bdh;

namespace {

constexpr long cells_per_particle = 32;

/// Particles that move under constant forces.
class DrivenParticles : public Particles {
 public:
  /// Places `count` particles at random in this rank's slab.
  DrivenParticles(const Grid &grid, const Slab &slab, long count, unsigned seed)
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (long i = 0; i < count; ++i)
      for (int d = 0; d < 3; ++d) {
        const bool slow = d == grid.slow_axis();
        const double first = slow ? slab.start : 0.0;
        const double lines = slow ? slab.count : grid.n[d];
        x_.push_back(grid.lo[d] + grid.h(d) * (first + lines * uniform(random)));
        force_.push_back(uniform(random) - 0.5);
      }
    for (long i = 0; i < count; ++i) id_.push_back(i + 1);
  }
  long size() const override { return bdh::ssize(x_) / 3; }
  const double *x() const override { return x_.data(); }
  const double *force() const override { return force_.data(); }
  const uint64_t *ids() const override { return id_.data(); }
  void move_and_update_forces(std::vector<double> &displacement, std::vector<double> *) override
  {
    add(displacement);
  }
  void finish(const std::vector<double> &displacement, const std::vector<double> &) override
  {
    add(displacement);
  }

 private:
  void add(const std::vector<double> &displacement)
  {
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] += displacement[i];
  }
  std::vector<double> x_, force_;
  std::vector<uint64_t> id_;
};

/// Six transforms of FFTW: three components forward and backward, in place.
class SixTransforms {
 public:
  explicit SixTransforms(const Grid &grid) : field_(2 * grid.half() * grid.n[1] * grid.n[2])
  {
    const int z = grid.n[2], y = grid.n[1], x = grid.n[0];
    fftw_complex *modes = reinterpret_cast<fftw_complex *>(field_.data());
    forward_.reset(fftw_plan_dft_r2c_3d(z, y, x, field_.data(), modes, FFTW_MEASURE));
    backward_.reset(fftw_plan_dft_c2r_3d(z, y, x, modes, field_.data(), FFTW_MEASURE));
    other_[0] = other_[1] = field_;
  }
  void run()
  {
    double *const fields[3] = {field_.data(), other_[0].data(), other_[1].data()};
    for (double *f : fields)
      fftw_execute_dft_r2c(forward_.get(), f, reinterpret_cast<fftw_complex *>(f));
    for (double *f : fields)
      fftw_execute_dft_c2r(backward_.get(), reinterpret_cast<fftw_complex *>(f), f);
  }
  /// Without this the numbers grow without bound, since the transforms are not normalised.
  void reset()
  {
    for (AlignedVector *f : {&field_, &other_[0], &other_[1]})
      std::fill(f->begin(), f->end(), 1e-3);
  }

 private:
  struct Destroy {
    void operator()(fftw_plan p) const { fftw_destroy_plan(p); }
  };
  using Plan = std::unique_ptr<std::remove_pointer<fftw_plan>::type, Destroy>;
  AlignedVector field_, other_[2];
  Plan forward_, backward_;
};

/// Everything needed for one size.  Real: the type of the grid's numbers.
template <class Real> struct Scene {
  using Fluid = FibFluid<FibOnHostIn<Real>>;
  Grid grid;
  Fluid fluid;
  DrivenParticles particles;
  BrownianStep<FibOnHost, Fluid> step;
  StepPlan plan;
  std::vector<double> velocity;

  Scene(const Grid &g, long count, const Comm &comm) :
      grid(g), fluid(g, IbKernel::peskin4, FftEffort::measure, comm),
      particles(g, fluid.slab(), count / comm.size(), comm.rank() + 1), step(fluid),
      velocity(3 * particles.size())
  {
    plan.dt = 1e-3;
    plan.kT = 1.0;
    plan.seed = 1;
  }
  void take_step()
  {
    ++plan.step;
    step.take(particles, plan);
  }
  StokesProblem problem(bool noise) const
  {
    StokesProblem p;
    p.kT_over_dt = noise ? plan.kT / plan.dt : 0.0;
    p.step = plan.step;
    p.stress = {{1.0, 0}};
    return p;
  }
};

Grid cube(long n)
{
  Grid g;
  g.n = {n, n, n};
  g.length.fill(n);
  return g;
}

Grid slit(long n)
{
  Grid g = cube(n);
  g.boundary[2].fill(Boundary::noslip);
  return g;
}

/// Median times [ms] of the actions.  They take turns, so that other load on the machine affects
/// all of them alike.
std::vector<double> medians(const std::vector<std::function<void()>> &actions, double seconds)
{
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point t) {
    return std::chrono::duration<double>(Clock::now() - t).count();
  };
  std::vector<std::vector<double>> times(actions.size());
  const auto start = Clock::now();
  for (int round = 0; round < 5 || since(start) < seconds; ++round)
    for (std::size_t a = 0; a < actions.size(); ++a) {
      const auto t = Clock::now();
      actions[a]();
      times[a].push_back(1e3 * since(t));
    }
  std::vector<double> middle;
  for (auto &t : times) {
    std::nth_element(t.begin(), t.begin() + t.size() / 2, t.end());
    middle.push_back(t[t.size() / 2]);
  }
  return middle;
}

/// Medians [ms] of FFTW, of the step, and of its parts.
struct StageTimes {
  double fft, step, bind, clear, spread, solve, noisy_solve, interpolate;
};

template <class Real> StageTimes time_stages(Scene<Real> &s)
{
  SixTransforms six(s.grid);
  const StokesProblem noisy = s.problem(true), quiet = s.problem(false);
  const auto clear = [&] { s.fluid.clear(); };
  const auto spread = [&] { s.fluid.spread(s.particles.force(), s.plan.kT); };
  const std::vector<double> t =
      medians({[&] { six.run(); }, [&] { s.take_step(); },
               [&] { s.fluid.bind(s.particles.x(), s.particles.size()); }, clear, spread,
               [&] { s.fluid.solve(quiet); }, clear, spread, [&] { s.fluid.solve(noisy); },
               [&] { s.fluid.interpolate(s.velocity.data()); }, [&] { six.reset(); }},
              4.0);
  return {t[0], t[1], t[2], t[3], t[4], t[5], t[8], t[9]};
}

/// The step compared with FFTW, and the parts of the step.
template <class Real> void stage_line(const Grid &grid, const Comm &comm)
{
  Scene<Real> s(grid, grid.cells() / cells_per_particle, comm);
  const StageTimes t = time_stages(s);
  const double percent = 100.0 / t.step;
  const double grid_memory = s.fluid.grid_memory(), per_cell = grid_memory / s.grid.cells();
  const double particle_memory = s.fluid.particle_memory() + s.step.memory(),
               per_particle = particle_memory / s.particles.size();
  std::printf("%5ld %-8s %-6s %8.2f %8.2f %6.2f | ", grid.n[0],
              grid.walled(2) ? "slit" : "periodic",
              sizeof(Real) == sizeof(float) ? "single" : "double", t.fft, t.step, t.step / t.fft);
  std::printf("%5.1f %5.1f %6.1f %5.1f %5.1f %6.1f | ", 2.0 * t.bind * percent, t.clear * percent,
              t.spread * percent, t.solve * percent, (t.noisy_solve - t.solve) * percent,
              2.0 * t.interpolate * percent);
  std::printf("%6.1f %6.1f\n", per_cell, per_particle);
  std::fflush(stdout);
}

/// Lines for periodic boxes and slits of these sizes, in double and in single precision.
void stage_table(const std::vector<long> &sizes, const Comm &comm)
{
  std::printf("Midpoint step, %ld cells per particle [ms]; FFTW's transforms in double; "
              "parts in %% of the step\n",
              cells_per_particle);
  std::printf("%5s %-8s %-6s %8s %8s %6s | %5s %5s %6s %5s %5s %6s | %6s %6s\n", "n", "box", "grid",
              "6 FFT", "step", "ratio", "bind", "clear", "spread", "solve", "noise", "interp",
              "B/cell", "B/part");
  for (const long n : sizes)
    for (const Grid &grid : {cube(n), slit(n)}) {
      stage_line<double>(grid, comm);
      stage_line<float>(grid, comm);
    }
}

/// Shows that the time is linear in the number of particles: same cells, more particles.
void particle_table(const Comm &comm)
{
  const Grid grid = cube(64);
  std::printf("\n64^3 cells in single precision, more particles\n%10s %9s %22s\n", "particles",
              "step [ms]", "[ns per extra particle]");
  double first = 0.0;
  for (const long count : {0L, 8192L, 16384L, 32768L, 65536L, 131072L}) {
    Scene<float> s(grid, count, comm);
    const double step = medians({[&] { s.take_step(); }}, 2.0)[0];
    if (count == 0) first = step;
    std::printf("%10ld %9.2f", count, step);
    if (count) std::printf(" %22.0f", 1e6 * (step - first) / count);
    std::printf("\n");
  }
}

/// Shows that the time is linear in the number of cells: same density, larger boxes whose sizes
/// have no prime factors above 7.
void cell_table(const Comm &comm)
{
  std::printf("\n%ld cells per particle, larger boxes in single precision\n%5s %9s %16s\n",
              cells_per_particle, "n", "step [ms]", "step [ns/cell]");
  for (const long n :
       {48L, 56L, 60L, 64L, 70L, 80L, 90L, 96L, 108L, 112L, 120L, 128L, 144L, 160L}) {
    Scene<float> s(cube(n), cube(n).cells() / cells_per_particle, comm);
    const double step = medians({[&] { s.take_step(); }}, 2.0)[0];
    std::printf("%5ld %9.2f %16.1f\n", n, step, 1e6 * step / s.grid.cells());
  }
}

/// Wall time of a whole step on these ranks.  It is the minimum over many steps, since
/// anything that interrupts one rank delays all of them.
void rank_table(const std::vector<long> &sizes, const Comm &comm)
{
  if (comm.rank() == 0) std::printf("%d ranks\n%5s %9s\n", comm.size(), "n", "step [ms]");
  for (const long n : sizes) {
    Scene<float> s(cube(n), cube(n).cells() / cells_per_particle, comm);
    double least = HUGE_VAL;
    for (int round = 0; round < 60; ++round) {
      MPI_Barrier(comm.handle());
      const double start = MPI_Wtime();
      s.take_step();
      MPI_Barrier(comm.handle());
      least = std::min(least, 1e3 * (MPI_Wtime() - start));
    }
    if (comm.rank() == 0) std::printf("%5ld %9.2f\n", n, least);
  }
}

}    // namespace

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  {
    const Comm comm(MPI_COMM_WORLD);
    std::vector<long> sizes;
    const bool stages = argc > 1 && std::string(argv[1]) == "stages";
    for (int a = stages ? 2 : 1; a < argc; ++a) sizes.push_back(std::atol(argv[a]));
    if (stages) {
      stage_table(sizes, comm);
    } else if (comm.size() > 1 || !sizes.empty()) {
      rank_table(sizes.empty() ? std::vector<long>{64, 128} : sizes, comm);
    } else {
      stage_table({32, 64, 96, 128}, comm);
      particle_table(comm);
      cell_table(comm);
    }
  }
  MPI_Finalize();
}
