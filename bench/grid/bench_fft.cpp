// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Cost of pruned transforms: VectorFft with and without KeptModes, and six plain real transforms
/// of FFTW of the same size.
///
///     bench_fft [n ...]     default: 64 96 128 150 180
///
/// The kept modes are a sphere of radius n/2.6, and change() scales them.  Runs on one rank.  Times
/// are medians over repetitions that alternate between the candidates.
#include "grid/fft.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fftw3.h>
#include <functional>
#include <vector>

using namespace bdh;

namespace {

template <class Real> struct Fftw;
template <> struct Fftw<double> {
  static constexpr auto plan_r2c = fftw_plan_dft_r2c_3d;
  static constexpr auto plan_c2r = fftw_plan_dft_c2r_3d;
  static constexpr auto r2c = fftw_execute_dft_r2c;
  static constexpr auto c2r = fftw_execute_dft_c2r;
  static constexpr auto destroy = fftw_destroy_plan;
  using Complex = fftw_complex;
  using Plan = fftw_plan;
  static constexpr const char *name = "double";
};
template <> struct Fftw<float> {
  static constexpr auto plan_r2c = fftwf_plan_dft_r2c_3d;
  static constexpr auto plan_c2r = fftwf_plan_dft_c2r_3d;
  static constexpr auto r2c = fftwf_execute_dft_r2c;
  static constexpr auto c2r = fftwf_execute_dft_c2r;
  static constexpr auto destroy = fftwf_destroy_plan;
  using Complex = fftwf_complex;
  using Plan = fftwf_plan;
  static constexpr const char *name = "float";
};

/// Three components, transformed in place.
template <class Real> struct VectorField {
  AlignedArray<Real> c[3];
  explicit VectorField(std::size_t size)
  {
    for (auto &a : c) a.assign(size, Real(1e-3));
  }
  std::array<Real *, 3> view() { return {c[0].data(), c[1].data(), c[2].data()}; }
};

/// Six transforms of FFTW: three components forward and backward, in place.
template <class Real> class SixTransforms {
 public:
  explicit SixTransforms(int n, VectorField<Real> &field) : field_(field)
  {
    Real *f = field.c[0].data();
    forward_ = F::plan_r2c(n, n, n, f, complex(f), FFTW_MEASURE);
    backward_ = F::plan_c2r(n, n, n, complex(f), f, FFTW_MEASURE);
  }
  SixTransforms(const SixTransforms &) = delete;
  SixTransforms &operator=(const SixTransforms &) = delete;
  ~SixTransforms()
  {
    F::destroy(forward_);
    F::destroy(backward_);
  }
  void run()
  {
    for (Real *f : field_.view()) F::r2c(forward_, f, complex(f));
    for (Real *f : field_.view()) F::c2r(backward_, complex(f), f);
  }

 private:
  using F = Fftw<Real>;
  static typename F::Complex *complex(Real *f)
  {
    return reinterpret_cast<typename F::Complex *>(f);
  }
  VectorField<Real> &field_;
  typename F::Plan forward_, backward_;
};

double seconds_since(std::chrono::steady_clock::time_point t)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - t).count();
}

/// Median times [ms] of the actions.  They take turns, so that other load on the machine affects
/// all of them alike.
std::vector<double> medians(const std::vector<std::function<void()>> &actions, double seconds)
{
  std::vector<std::vector<double>> times(actions.size());
  const auto start = std::chrono::steady_clock::now();
  for (int round = 0; round < 5 || seconds_since(start) < seconds; ++round)
    for (std::size_t a = 0; a < actions.size(); ++a) {
      const auto t = std::chrono::steady_clock::now();
      actions[a]();
      times[a].push_back(1e3 * seconds_since(t));
    }
  std::vector<double> middle;
  for (auto &t : times) {
    std::nth_element(t.begin(), t.begin() + t.size() / 2, t.end());
    middle.push_back(t[t.size() / 2]);
  }
  return middle;
}

/// The columns of modes within a sphere of this radius.
std::vector<long> sphere(long n, double radius)
{
  std::vector<long> columns(n, 0);
  for (long y = 0; y < n; ++y) {
    const double square = radius * radius - std::pow(std::min(y, n - y), 2);
    if (square >= 0.0) columns[y] = 1.0 + std::sqrt(square);
  }
  return columns;
}

template <class Real> void line(long n)
{
  Grid grid;
  grid.n = {n, n, n};
  const Comm comm(MPI_COMM_WORLD);
  const double radius = n / 2.6;
  const long k = radius;
  const auto start = std::chrono::steady_clock::now();
  VectorFft<Real> pruned(grid, comm, FftEffort::measure, KeptModes{k, k});
  const double planning = seconds_since(start);
  VectorFft<Real> whole(grid, comm, FftEffort::measure);
  pruned.keep(sphere(n, radius));
  VectorField<Real> field(std::max(pruned.allocation(), whole.allocation()));
  SixTransforms<Real> six(n, field);

  // The factor 1/n^3 keeps the numbers unchanged.
  const Real scale = Real(1) / (n * n * n);
  const auto change = [scale](const ModeBlock<Real> &b) {
    for (int c = 0; c < 3; ++c)
      for (long i = 0; i < 2 * b.rows * b.columns; ++i) b.f[c][i] *= scale;
  };
  const auto reset = [&] {
    for (auto &c : field.c) std::fill(c.begin(), c.end(), Real(1e-3));
  };
  reset();
  const std::vector<double> t =
      medians({[&] { pruned.solve(field.view(), change); },
               [&] { pruned.solve(field.view(), change, Input::zero); }, reset,
               [&] { whole.solve(field.view(), change); }, [&] { six.run(); }, reset},
              2.0);
  std::printf("%6s %4ld %8.2f %8.2f %10.2f %8.2f %7.2f %7.2f %9.1f\n", Fftw<Real>::name, n, t[0],
              t[1], t[3], t[4], t[0] / t[4], t[0] / t[3], planning);
  std::fflush(stdout);
}

}    // namespace

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  std::vector<long> sizes;
  for (int a = 1; a < argc; ++a) sizes.push_back(std::atol(argv[a]));
  if (sizes.empty()) sizes = {64, 96, 128, 150, 180};
  std::printf("Median times [ms]; planning of the pruned one [s]\n");
  std::printf("%6s %4s %8s %8s %10s %8s %7s %7s %9s\n", "", "n", "pruned", "noise", "unpruned",
              "6 FFT", "pr./6", "pr./un.", "planning");
  for (const long n : sizes) {
    line<double>(n);
    line<float>(n);
  }
  MPI_Finalize();
}
