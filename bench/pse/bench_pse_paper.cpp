// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// The measurements for the figures and the table of the paper [PSE], as CSV on standard output.
// pse_figures.sh runs them.
//
//   bench_pse_paper condition         Fig. 1: condition number of M_r as a function of xi a, for
//                                     several N and phi
//   bench_pse_paper tolerance         Fig. 2: achieved error as a function of the tolerance, for
//                                     several xi
//   bench_pse_paper iterations        error of M_r^(1/2) z as a function of Lanczos iterations, for
//                                     several phi and xi
//   bench_pse_paper splitting N phi [FILE L]
//                                     Figs. 4, 7, 8: time as a function of xi for M F, M F + noise,
//                                     and their parts.  FILE has positions of other particles,
//                                     three numbers per line, in a cube of side L
//   bench_pse_paper root N ...        Figs. 5, 6: time of the noise by PSE compared with M F, and
//                                     with Lanczos for the whole M
//   bench_pse_paper throughput N ...  Table I, and the memory
//   bench_pse_paper points N phi FILE
//                                     writes the positions and prints the plan, for
//                                     compare_finufft.py
//   bench_pse_paper apply N phi       seconds of M F and of its wave-space part at the plan's xi,
//                                     9 times each

#include "oracle/dense_operator.h"
#include "oracle/dense_rpy.h"
#include "pse/pse_scene.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

using namespace bdh;
using namespace bdh_bench;
using bdh_test::DenseOperator;

namespace {

Eigen::MatrixXd real_part(const Scene &s, double xi)
{
  const DenseSplit M = dense_split(s.cell(), s.x.data(), s.n, 1.0, 1.0 / (6.0 * pi), xi);
  return Eigen::Map<const Eigen::MatrixXd>(M.real.data(), 3 * s.n, 3 * s.n);
}

void condition()
{
  std::printf("phi,N,xi_a,condition\n");
  for (double phi : {0.1, 0.3})
    for (long n : {50, 100, 200, 400}) {
      const Scene s(n, phi);
      for (double xi : {0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0, 1.4, 2.0}) {
        const Eigen::VectorXd lambda =
            Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(real_part(s, xi), Eigen::EigenvaluesOnly)
                .eigenvalues();
        std::printf("%g,%ld,%g,%.6g\n", phi, n, xi, lambda(lambda.size() - 1) / lambda(0));
        std::fflush(stdout);
      }
    }
}

void tolerance()
{
  std::printf("xi_a,tolerance,random_forces,equal_forces\n");
  Scene s(5000, 0.2);
  std::vector<double> random = s.force, equal(s.force.size(), 0.0);
  for (long i = 0; i < s.n; ++i) equal[3 * i + 2] = 1.0;
  std::vector<double> exact[2];
  for (double xi : {0.0, 0.3, 0.5, 0.8, 1.2}) {
    for (double t : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8}) {
      double error[2];
      for (int kind = 0; kind < 2; ++kind) {
        s.force = kind ? equal : random;
        if (exact[kind].empty())
          exact[kind] =
              Bound(s, plan_pse(s.pse(1e-10, 0.6, false)), 0.0, FftEffort::estimate).apply();
        error[kind] = relative_difference(
            Bound(s, plan_pse(s.pse(t, xi, false)), 0.0, FftEffort::estimate).apply(), exact[kind]);
      }
      std::printf("%s,%g,%.4g,%.4g\n", xi > 0.0 ? std::to_string(xi).substr(0, 3).c_str() : "auto",
                  t, error[0], error[1]);
      std::fflush(stdout);
    }
  }
}

void iterations()
{
  std::printf("phi,xi_a,error_asked,iterations,error_estimated,error_true\n");
  for (double phi : {0.01, 0.1, 0.3, 0.4}) {
    const Scene s(200, phi > 0.35 ? 0.3 : phi);
    Scene dense = s;
    if (phi > 0.35) {    // overlapping spheres: the same configuration, shrunk by 10 %
      for (double &v : dense.x) v *= 0.9;
      dense.L *= 0.9;
    }
    for (double xi : {0.2, 0.35, 0.5, 0.8, 1.2}) {
      const Eigen::MatrixXd A = real_part(dense, xi);
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A);
      const Eigen::MatrixXd root = eigen.operatorSqrt();
      const AlignedVector z(s.force.begin(), s.force.end());
      const Eigen::VectorXd exact = root * Eigen::Map<const Eigen::VectorXd>(z.data(), 3 * s.n);
      const double length = Eigen::Map<const Eigen::VectorXd>(z.data(), 3 * s.n).norm();
      DenseOperator op(A);
      LanczosRoot<DenseOperator> lanczos;
      AlignedVector y;
      for (double error = 0.3; error > 1e-10; error *= 0.1) {
        const LanczosReport report = lanczos.apply(op, z, {error, 500}, y);
        std::printf("%.3g,%g,%g,%d,%.4g,%.4g\n", dense.phi(), xi, error, report.iterations,
                    report.error,
                    (Eigen::Map<const Eigen::VectorXd>(y.data(), 3 * s.n) - exact).norm() / length);
      }
      std::fflush(stdout);
    }
  }
}

void splitting(const Scene &s)
{
  std::printf("N,phi,tolerance,xi_a,auto,r_c,grid,W,iterations,MF_seconds,noise_seconds,pairs,"
              "lanczos,spread_interpolate,transform\n");
  for (double t : {1e-3, 1e-5})
    for (double xi : {0.0, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.6, 0.7, 0.85, 1.0}) {
      const PsePlan plan = plan_pse(s.pse(t, xi, true));
      if (plan.neighbors * s.n > 6e7 || plan.n[0] * plan.n[1] * plan.n[2] > 4e7) continue;
      Bound bound(s, plan);
      bound.fluctuate();
      const int repeats = repeats_for(plan.seconds());
      const PhasesSince start;
      const double noise = median_time(repeats, [&] { bound.fluctuate(); });
      const double pairs = start.seconds({Phase::pairs}), lanczos = start.seconds({Phase::lanczos}),
                   spread = start.seconds({Phase::spread, Phase::interpolate}),
                   transform = start.seconds({Phase::transform, Phase::modes});
      const double MF = median_time(repeats, [&] { bound.apply(); });
      std::printf("%ld,%.3g,%g,%.4g,%d,%.4g,%ld,%d,%d,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g\n", s.n,
                  s.phi(), t, plan.xi, xi == 0.0, plan.r_cut, plan.n[0], plan.window.width,
                  bound.report.iterations, MF, noise, pairs / repeats, lanczos / repeats,
                  spread / repeats, transform / repeats);
      std::fflush(stdout);
    }
}

/// The whole M as an operator for the Lanczos process.
class WholeOperator {
 public:
  using Vector = AlignedVector;
  /// M must be bound to the scene.  Its viscosity is changed.
  WholeOperator(const Scene &s, HostPseMobility &M) : s_(s), M_(M)
  {
    M_.set_viscosity(1.0 / (6.0 * pi));
  }
  std::size_t size() const { return (3 * s_.n); }
  std::size_t full_size() const { return size(); }
  double sum(double mine) const { return mine; }
  void apply(const Vector &v, Vector &u)
  {
    u.resize(size());
    M_.apply({v.data(), true}, u.data());
  }

 private:
  const Scene &s_;
  HostPseMobility &M_;
};

void root(const std::vector<long> &sizes)
{
  std::printf(
      "N,tolerance,MF_seconds,pse_noise_seconds,lanczos_noise_seconds,lanczos_iterations\n");
  for (long n : sizes)
    for (double t : {1e-3, 1e-5}) {
      const Scene s(n, 0.1);
      Bound mean(s, plan_pse(s.pse(t, 0.0, false))), noisy(s, plan_pse(s.pse(t, 0.0, true)));
      mean.apply();
      noisy.fluctuate();
      const int repeats = repeats_for(mean.mobility().plan().seconds());
      const double MF = median_time(repeats, [&] { mean.apply(); });
      const double pse = median_time(repeats, [&] { noisy.fluctuate(); });
      WholeOperator M(s, mean.mobility());
      LanczosRoot<WholeOperator> lanczos;
      const AlignedVector z(s.force.begin(), s.force.end());
      AlignedVector y;
      LanczosReport report;
      const double whole = median_time(1, [&] { report = lanczos.apply(M, z, {t, 1000}, y); });
      std::printf("%ld,%g,%.4g,%.4g,%.4g,%d\n", n, t, MF, pse, whole, report.iterations);
      std::fflush(stdout);
    }
}

void throughput(const std::vector<long> &sizes)
{
  std::printf("N,MF_seconds,noise_seconds,MF_million_per_second,noise_million_per_second,xi_a_MF,"
              "xi_a_noise,bytes_per_particle\n");
  for (long n : sizes) {
    const Scene s(n, 0.1);
    Bound mean(s, plan_pse(s.pse(1e-3, 0.0, false))), noisy(s, plan_pse(s.pse(1e-3, 0.0, true)));
    mean.apply();
    noisy.fluctuate();
    const int repeats = repeats_for(mean.mobility().plan().seconds());
    const double MF = median_time(repeats, [&] { mean.apply(); }),
                 noise = median_time(repeats, [&] { noisy.fluctuate(); }),
                 bytes = noisy.mobility().grid_memory() + noisy.mobility().particle_memory();
    std::printf("%ld,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.0f\n", n, MF, noise, 1e-6 * n / MF,
                1e-6 * n / noise, mean.mobility().plan().xi, noisy.mobility().plan().xi, bytes / n);
    std::fflush(stdout);
  }
}

void points(const Scene &s, const char *file)
{
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char *>(s.x.data()), s.x.size() * sizeof(double));
  const PsePlan plan = plan_pse(s.pse(1e-3, 0.0, false));
  const auto most = pse_largest_index(plan.k_cut, {s.L, s.L, s.L});
  std::printf("{\"L\": %.17g, \"modes\": %ld, \"grid\": %ld, \"xi\": %g}\n", s.L, 2 * most[0] + 1,
              plan.n[0], plan.xi);
}

void apply(const Scene &s)
{
  Bound bound(s, plan_pse(s.pse(1e-3, 0.0, false)));
  bound.apply();
  for (int i = 0; i < 9; ++i) {
    const PhasesSince start;
    const double whole = median_time(1, [&] { bound.apply(); });
    std::printf("%.6g %.6g\n", whole, whole - start.seconds({Phase::pairs}));
  }
}

Scene scene_from(const char *file, double L)
{
  std::ifstream in(file);
  std::vector<double> x;
  for (double v; in >> v;) x.push_back(v);
  return Scene(x, L);
}

}    // namespace

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  const std::string what = argc > 1 ? argv[1] : "";
  std::vector<long> sizes;
  for (int i = 2; i < argc; ++i) sizes.push_back(std::atol(argv[i]));
  if (what == "condition")
    condition();
  else if (what == "tolerance")
    tolerance();
  else if (what == "iterations")
    iterations();
  else if (what == "splitting" && argc == 6)
    splitting(scene_from(argv[4], std::atof(argv[5])));
  else if (what == "splitting" && argc == 4)
    splitting(Scene(sizes[0], std::atof(argv[3])));
  else if (what == "root")
    root(sizes);
  else if (what == "throughput")
    throughput(sizes);
  else if (what == "points" && argc == 5)
    points(Scene(sizes[0], std::atof(argv[3])), argv[4]);
  else if (what == "apply" && argc == 4)
    apply(Scene(sizes[0], std::atof(argv[3])));
  else
    std::fprintf(stderr, "usage: see the top of bench_pse_paper.cpp\n");
  MPI_Finalize();
}
