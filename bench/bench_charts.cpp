// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Accuracy compared with cost, and where methods fail, as CSV on standard output.  charts.sh runs
// all of these and draws the charts.
//
//   bench_charts accuracy    errors of U, of the noise and of the diffusion coefficient, and the
//                            seconds per step, for bd/pse at all tolerances and precisions, bd/fib
//                            with all kernels, and the dense method
//   bench_charts slit        the same for bd/fib between walls; the reference is the mobility of an
//                            RPY sphere in a slit
//   bench_charts spheres     the same for bd/pse with equal and unequal radii, without and with
//                            rotation; the reference is the dense matrix of all loads
//   bench_charts size N ...  seconds per step as a function of N: bd/pse, bd/fib, and the dense
//                            method up to 1500
//   bench_charts split       smallest eigenvalues of both parts of the classical and of the
//                            positive Ewald splittings
//   bench_charts lanczos     iterations at contact, with overlap and for dense systems, for several
//                            tolerances and xi
//   bench_charts delta       error of the random finite difference as a function of its step
//   bench_charts wall        mobility of each kernel near and beyond a wall
//   bench_charts open_wall   the same above one wall under fluid without end, and that of pairs

#include "fib/host.h"
#include "fib/resting_particles.h"
#include "fib/step.h"
#include "input/grid_choice.h"
#include "oracle/dense_operator.h"
#include "oracle/dense_rpy.h"
#include "oracle/dense_spheres.h"
#include "pse/plan_errors.h"
#include "pse/pse_scene.h"

#include <Eigen/Dense>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

using namespace bdh;
using namespace bdh_bench;

namespace {

using Matrix = Eigen::MatrixXd;

/// A ball cut from an fcc crystal of touching spheres, in the middle of a cube.  Every inner sphere
/// has twelve neighbours at contact.
Scene cluster(long n, double L)
{
  std::vector<std::pair<double, std::array<double, 3>>> sites;
  const double edge = 2.0 * std::sqrt(2.0);
  for (int i = -12; i <= 12; ++i)
    for (int j = -12; j <= 12; ++j)
      for (int k = -12; k <= 12; ++k)
        if ((i + j + k) % 2 == 0) {
          const std::array<double, 3> r{0.5 * edge * i + 0.01, 0.5 * edge * j + 0.02,
                                        0.5 * edge * k + 0.03};
          sites.push_back({r[0] * r[0] + r[1] * r[1] + r[2] * r[2], r});
        }
  std::sort(sites.begin(), sites.end());
  std::vector<double> x;
  for (long i = 0; i < n; ++i)
    for (double r : sites[i].second) x.push_back(0.5 * L + r);
  return Scene(x, L);
}

/// The grid that fix bd/fib chooses for radius 1 in a box with these edges and faces normal to z.
Grid fib_grid(IbKernel kernel, double W, double L, Boundary lower, Boundary upper)
{
  FibOptions o;
  o.kernel = kernel;
  o.radius = 1.0;
  o.walls.face[2][0].kind = lower;
  o.walls.face[2][1].kind = upper;
  return choose_grid(o, 3, {0.0, 0.0, 0.0}, {W, W, L}, {true, true, lower == Boundary::periodic});
}
Grid fib_slit(IbKernel kernel, double W, double L)
{
  return fib_grid(kernel, W, L, Boundary::noslip, Boundary::noslip);
}

/// The fluid of bd/fib with particles, and its steps with force, noise, drift and two
/// interpolations.
class FibScene {
 public:
  FibScene(const Scene &s, IbKernel kernel) :
      FibScene(fib_grid(kernel, s.L, s.L, Boundary::periodic, Boundary::periodic), kernel, s.x,
               s.force)
  {}
  FibScene(const Grid &grid, IbKernel kernel, std::vector<double> x, std::vector<double> force) :
      n_(x.size() / 3), x_(std::move(x)), force_(std::move(force)),
      fluid_(grid, kernel, FftEffort::measure, Comm(MPI_COMM_WORLD)), u_(x_.size())
  {}
  std::vector<double> apply(const std::vector<double> &force) { return velocity(force, false); }
  void step()
  {
    velocity(force_, true);
    fluid_.bind(x_.data(), n_);
    fluid_.interpolate(u_.data());
  }
  FibFluid<FibOnHost> &fluid() { return fluid_; }

 private:
  const std::vector<double> &velocity(const std::vector<double> &force, bool noise)
  {
    StokesProblem p;
    if (noise) {
      p.kT_over_dt = 1.0;
      p.stress = {{1.0, 0}};
      p.step = ++count_;
    }
    fluid_.bind(x_.data(), n_);
    fluid_.clear();
    fluid_.spread(force.data(), noise ? 1.0 : 0.0);
    fluid_.solve(p);
    fluid_.interpolate(u_.data());
    return u_;
  }
  long n_;
  std::vector<double> x_, force_;
  FibFluid<FibOnHost> fluid_;
  std::vector<double> u_;
  uint64_t count_ = 0;
};

/// Median time of a call in seconds, after one call that is not counted.
double timed(const std::function<void()> &work)
{
  const double first = median_time(1, work);
  return median_time(repeats_for(first), work);
}

/// Diagonal entries of M for some particles and directions: U_i for F_i = 1 and no other force.
template <class Apply> std::vector<double> diagonal(const Scene &s, Apply apply)
{
  std::vector<double> d;
  for (long c = 0; c < 24; ++c) {
    const std::size_t place = 3 * (c * (s.n / 24)) + c % 3;
    std::vector<double> unit(s.x.size(), 0.0);
    unit[place] = 1.0;
    d.push_back(apply(unit)[place]);
  }
  return d;
}

double error_of_mean(const std::vector<double> &a, const std::vector<double> &b)
{
  double sa = 0.0, sb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sa += a[i];
    sb += b[i];
  }
  return std::fabs(sa / sb - 1.0);
}

std::string text(double v)
{
  char s[32];
  std::snprintf(s, sizeof s, "%g", v);
  return s;
}

void accuracy_of(const char *name, Scene s)
{
  const auto row = [&](const char *method, const std::string &setting, double U, double noise,
                       double D, double MF, double whole) {
    std::printf("%s,%ld,%s,%s,%.4g,%.4g,%.4g,%.4g,%.4g\n", name, s.n, method, setting.c_str(), U,
                noise, D, MF, whole);
    std::fflush(stdout);
  };
  // The reference is dense RPY; the times are those of one product and one Cholesky factorisation.
  const std::vector<double> dense = dense_mobility(s.cell(), s.x.data(), s.n, 1.0, 1.0);
  const Eigen::Map<const Matrix> M(dense.data(), 3 * s.n, 3 * s.n);
  const auto product = [&](const std::vector<double> &f) {
    const Eigen::VectorXd u = M * Eigen::Map<const Eigen::VectorXd>(f.data(), 3 * s.n);
    return std::vector<double>(u.data(), u.data() + u.size());
  };
  const std::vector<double> exact = product(s.force), exact_diagonal = diagonal(s, product);
  const double multiply = timed([&] { product(s.force); });
  const double root = median_time(1, [&] { Eigen::LLT<Matrix> L(M); });
  row("dense", "Cholesky", 1e-14, 1e-14, 1e-14, multiply, root + multiply);
  for (const Precision precision : {Precision::single_precision, Precision::double_precision})
    for (double t : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
      if (precision == Precision::single_precision && t < 3e-6) continue;    // the fix refuses this
      PseScene scene = s.pse(t, 0.0, true);
      scene.precision = precision;
      PsePlan plan = plan_pse(scene);
      Bound bound(s, plan);
      const double U = relative_difference(bound.apply(), exact);
      const double MF = timed([&] { bound.apply(); }), whole = timed([&] { bound.fluctuate(); });
      // The reference for the square root is the same operator with the same random numbers, to
      // 1e-12 (in single precision, as accurate as possible).
      plan.root_tolerance = precision == Precision::single_precision ? 1e-7 : 1e-12;
      Bound tight(s, plan), loose(s, bound.mobility().plan());
      const double root_error = relative_difference(loose.fluctuate(), tight.fluctuate());
      const std::vector<double> saved = s.force;
      const std::vector<double> d = diagonal(s, [&](const std::vector<double> &f) {
        s.force = f;
        return bound.apply();
      });
      s.force = saved;
      row(precision == Precision::single_precision ? "pse single" : "pse double", text(t), U,
          std::hypot(U, root_error), error_of_mean(d, exact_diagonal), MF, whole);
    }
  for (const IbKernel kernel : {IbKernel::roma3, IbKernel::peskin4, IbKernel::bkp6}) {
    FibScene fib(s, kernel);
    const double U = relative_difference(fib.apply(s.force), exact);
    // To round-off, the covariance of the noise is the M of the method itself.
    const double D = error_of_mean(
        diagonal(s, [&](const std::vector<double> &f) { return fib.apply(f); }), exact_diagonal);
    row("fib", kernel_name(kernel), U, U, D, timed([&] { fib.apply(s.force); }),
        timed([&] { fib.step(); }));
  }
}

void accuracy()
{
  std::printf("scene,N,method,setting,error_U,error_noise,error_D,MF_seconds,step_seconds\n");
  accuracy_of("dilute", Scene(500, 0.01));
  accuracy_of("dense", Scene(500, 0.3));
  accuracy_of("cluster", cluster(500, 60.0));
}

/// Equal and unequal radii, with and without rotation, against the dense matrix of all loads.
void spheres()
{
  std::printf("radii,rotation,N,tolerance,error_U,error_omega,MF_seconds,step_seconds\n");
  for (const bool equal : {true, false}) {
    Scene s(200, 0.1);
    if (!equal) s.set_radii(4.0, 10);
    const std::vector<double> dense = dense_spheres(s.cell(), s.x, s.radius, 1.0);
    const Eigen::Map<const Matrix> M(dense.data(), 6 * s.n, 6 * s.n);
    for (const bool rotation : {false, true}) {
      s.rotation = rotation;
      std::vector<double> loads = s.force;
      for (const double torque : s.torque) loads.push_back(rotation ? torque : 0.0);
      const Eigen::VectorXd exact = M * Eigen::Map<const Eigen::VectorXd>(loads.data(), 6 * s.n);
      const std::vector<double> U(exact.data(), exact.data() + 3 * s.n),
          omega(exact.data() + 3 * s.n, exact.data() + 6 * s.n);
      for (double t : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
        Bound bound(s, plan_pse(s.pse(t, 0.0, true), s.conditions()));
        const double error = relative_difference(bound.apply(), U);
        const double of_omega = rotation ? relative_difference(bound.angular(), omega) : 0.0;
        std::printf("%s,%s,%ld,%g,%.4g,%.4g,%.4g,%.4g\n", equal ? "equal" : "1:4",
                    rotation ? "yes" : "no", s.n, t, error, of_omega, timed([&] { bound.apply(); }),
                    timed([&] { bound.fluctuate(); }));
        std::fflush(stdout);
      }
    }
  }
}

std::vector<std::vector<double>> csv_rows(const char *file)
{
  std::ifstream in(std::string(BDH_REFERENCE_DIR) + "/" + file);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || (line[0] != '-' && (line[0] < '0' || line[0] > '9'))) continue;
    std::istringstream fields(line);
    rows.emplace_back();
    for (std::string f; std::getline(fields, f, ',');)
      rows.back().push_back(std::strtod(f.c_str(), nullptr));
  }
  return rows;
}

/// Velocities of the last of n particles under a unit force on the first, in its direction, in
/// units of 1/(6 pi eta), averaged over positions of both together in a cell.
std::array<double, 3> mobility(FibFluid<FibOnHost> &fluid, const std::vector<double> &x)
{
  std::array<double, 3> mu{0.0, 0.0, 0.0};
  const double h = fluid.grid().h(0);
  const double places[] = {0.0, 0.25, 0.5};
  for (double px : places)
    for (double py : places)
      for (std::size_t d = 0; d < 3; ++d) {
        std::vector<double> moved = x, f(x.size(), 0.0), u(x.size());
        for (std::size_t i = 0; i < x.size(); i += 3) {
          moved[i] += px * h;
          moved[i + 1] += py * h;
        }
        f[d] = 1.0;
        fluid.bind(moved.data(), bdh::ssize(x) / 3);
        fluid.clear();
        fluid.spread(f.data(), 0.0);
        fluid.solve(StokesProblem());
        fluid.interpolate(u.data());
        mu[d] += 6.0 * pi * u[u.size() - 3 + d] / 9.0;
      }
  return mu;
}

/// Of one particle at height H over the middle of a wall of width W: along the wall and across.
std::array<double, 2> mobility_at(FibFluid<FibOnHost> &fluid, double W, double H)
{
  const std::array<double, 3> mu = mobility(fluid, {0.5 * W, 0.5 * W, H});
  return {mu[0], mu[2]};
}

/// Slits with L = 8 and W = 64, for which the reference has data at H >= 1.
void slit()
{
  std::printf("kernel,h,radius,H,par,perp,par_exact,perp_exact,step_seconds\n");
  for (const IbKernel kernel : {IbKernel::roma3, IbKernel::peskin4, IbKernel::bkp6}) {
    const Grid g = fib_slit(kernel, 64.0, 8.0);
    std::mt19937_64 engine(3);
    std::uniform_real_distribution<double> uniform;
    std::vector<double> x;
    for (int i = 0; i < 500; ++i)
      x.insert(x.end(),
               {64.0 * uniform(engine), 64.0 * uniform(engine), 1.0 + 6.0 * uniform(engine)});
    FibScene scene(g, kernel, x, std::vector<double>(x.size(), 1.0));
    const double seconds = timed([&] { scene.step(); });
    for (const std::vector<double> &r : csv_rows("slit_rpy.csv")) {
      if (r[0] != 8.0) continue;
      const auto mu = mobility_at(scene.fluid(), 64.0, r[1]);
      std::printf("%s,%.4g,%.5g,%g,%.6g,%.6g,%.6g,%.6g,%.4g\n", kernel_name(kernel), g.h(2),
                  hydrodynamic_radius(kernel, g), r[1], mu[0], mu[1], r[4], r[5], seconds);
      std::fflush(stdout);
    }
  }
}

void wall()
{
  std::printf("kernel,H,par,perp\n");
  for (const IbKernel kernel : {IbKernel::roma3, IbKernel::peskin4, IbKernel::bkp6}) {
    FibFluid<FibOnHost> fluid(fib_slit(kernel, 32.0, 8.0), kernel, FftEffort::estimate,
                              Comm(MPI_COMM_WORLD));
    for (double H = 0.0; H <= 3.001; H += 0.1) {
      const auto mu = mobility_at(fluid, 32.0, H);
      std::printf("%s,%.3g,%.6g,%.6g\n", kernel_name(kernel), H, mu[0], mu[1]);
    }
    std::fflush(stdout);
  }
}

/// Heights in steps that are no multiple of h average over positions across.  r = 0: one particle;
/// else a pair at the same height, with the force along the line of centres, along the wall, and
/// across.
void open_wall()
{
  const double W = 64.0;
  std::printf("kernel,H,r,line,along,across\n");
  for (const IbKernel kernel : {IbKernel::roma3, IbKernel::peskin4, IbKernel::bkp6}) {
    const Grid g = fib_grid(kernel, W, 8.0, Boundary::noslip, Boundary::open);
    FibFluid<FibOnHost> fluid(g, kernel, FftEffort::estimate, Comm(MPI_COMM_WORLD));
    const auto row = [&](double H, double r) {
      std::vector<double> x = {0.5 * W, 0.5 * W, H};
      if (r > 0.0) x.insert(x.end(), {0.5 * W + r, 0.5 * W, H});
      const auto mu = mobility(fluid, x);
      std::printf("%s,%.3g,%.4g,%.6g,%.6g,%.6g\n", kernel_name(kernel), H, r, mu[0], mu[1], mu[2]);
    };
    for (int i = 0; i <= 40; ++i) row(0.2 * i, 0.0);
    for (double H : {1.5, 3.0})
      for (double r : {2.1, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0, 10.0, 13.0, 16.0}) row(H, r);
    std::fflush(stdout);
  }
}

void sizes(const std::vector<long> &counts)
{
  std::printf("N,method,MF_seconds,step_seconds\n");
  for (long n : counts) {
    const Scene s(n, 0.1);
    {
      Bound mean(s, plan_pse(s.pse(1e-3, 0.0, false))), noisy(s, plan_pse(s.pse(1e-3, 0.0, true)));
      std::printf("%ld,pse 1e-3,%.4g,%.4g\n", n, timed([&] { mean.apply(); }),
                  timed([&] { noisy.fluctuate(); }));
    }
    if (n <= 320000) {
      FibScene fib(s, IbKernel::peskin4);
      std::printf("%ld,fib peskin4,%.4g,%.4g\n", n, timed([&] { fib.apply(s.force); }),
                  timed([&] { fib.step(); }));
    }
    if (n <= 1500) {
      const std::vector<double> dense = dense_mobility(s.cell(), s.x.data(), n, 1.0, 1.0);
      const Eigen::Map<const Matrix> M(dense.data(), 3 * n, 3 * n);
      const Eigen::Map<const Eigen::VectorXd> f(s.force.data(), 3 * n);
      Eigen::VectorXd u;
      const double multiply = timed([&] { u = M * f; }),
                   root = timed([&] { u = Eigen::LLT<Matrix>(M).matrixL() * f; });
      std::printf("%ld,dense without its sums,%.4g,%.4g\n", n, multiply, multiply + root);
    }
    std::fflush(stdout);
  }
}

/// Both parts of the Ewald sum of Beenakker, J. Chem. Phys. 85, 1581 (1986), for non-overlapping
/// spheres and viscosity 1.
std::pair<Matrix, Matrix> classical_split(const Scene &s, double xi)
{
  const double a = 1.0, a3 = 1.0, root_pi = std::sqrt(pi), mu0 = 1.0 / (6.0 * pi);
  const double x3 = xi * xi * xi, x5 = x3 * xi * xi, x7 = x5 * xi * xi;
  Matrix near = Matrix::Zero(3 * s.n, 3 * s.n), far = near;
  const int boxes = 1.0 + 7.0 / (xi * s.L);
  for (long i = 0; i < s.n; ++i)
    for (long j = 0; j < s.n; ++j)
      for (int p = -boxes; p <= boxes; ++p)
        for (int q = -boxes; q <= boxes; ++q)
          for (int w = -boxes; w <= boxes; ++w) {
            const Eigen::Vector3d d(s.x[3 * i] - s.x[3 * j] + p * s.L,
                                    s.x[3 * i + 1] - s.x[3 * j + 1] + q * s.L,
                                    s.x[3 * i + 2] - s.x[3 * j + 2] + w * s.L);
            const double r = d.norm(), r2 = r * r, g = std::exp(-xi * xi * r2) / root_pi,
                         e = std::erfc(xi * r);
            if (r < 1e-9) {
              near.block<3, 3>(3 * i, 3 * j) +=
                  mu0 * (1.0 - 6.0 / root_pi * xi * a + 40.0 / (3.0 * root_pi) * x3 * a3) *
                  Eigen::Matrix3d::Identity();
              continue;
            }
            const double I =
                e * (0.75 * a / r + 0.5 * a3 / (r2 * r)) +
                g * (4.0 * x7 * a3 * r2 * r2 + 3.0 * x3 * a * r2 - 20.0 * x5 * a3 * r2 -
                     4.5 * xi * a + 14.0 * x3 * a3 + xi * a3 / r2);
            const double R =
                e * (0.75 * a / r - 1.5 * a3 / (r2 * r)) +
                g * (-4.0 * x7 * a3 * r2 * r2 - 3.0 * x3 * a * r2 + 16.0 * x5 * a3 * r2 +
                     1.5 * xi * a - 2.0 * x3 * a3 - 3.0 * xi * a3 / r2);
            near.block<3, 3>(3 * i, 3 * j) +=
                mu0 * (I * Eigen::Matrix3d::Identity() + R * d * d.transpose() / r2);
          }
  const double unit = 2.0 * pi / s.L;
  const int most = 1.0 + 13.0 * xi / unit;
  for (int p = -most; p <= most; ++p)
    for (int q = -most; q <= most; ++q)
      for (int w = -most; w <= most; ++w) {
        const Eigen::Vector3d k(unit * p, unit * q, unit * w);
        const double k2 = k.squaredNorm(), t = k2 / (4.0 * xi * xi);
        if (k2 == 0.0 || t > 40.0) continue;
        const double m = (a - a3 * k2 / 3.0) * (1.0 + t + 2.0 * t * t) * 6.0 * pi / k2 *
                         std::exp(-t) * mu0 / (s.L * s.L * s.L);
        const Eigen::Matrix3d P = m * (Eigen::Matrix3d::Identity() - k * k.transpose() / k2);
        Eigen::VectorXcd phase(s.n);
        for (long i = 0; i < s.n; ++i)
          phase[i] =
              std::polar(1.0, k.dot(Eigen::Vector3d(s.x[3 * i], s.x[3 * i + 1], s.x[3 * i + 2])));
        for (long i = 0; i < s.n; ++i)
          for (long j = 0; j < s.n; ++j)
            far.block<3, 3>(3 * i, 3 * j) += (phase[i] * std::conj(phase[j])).real() * P;
      }
  return {near, far};
}

Eigen::Vector3d vector(double x, double y, double z) { return {x, y, z}; }

/// M_r of the Kaiser-Bessel splitting for radius and viscosity 1; with the pairs beyond r_cut,
/// which are left out elsewhere, up to three times as far.
Matrix kaiser_bessel_near(const Scene &s, const KaiserBesselSplit &split, double r_cut)
{
  const RealSpacePart part(1.0, split, 3.0 * r_cut);
  Matrix near = Matrix::Zero(3 * s.n, 3 * s.n);
  const int boxes = 1.0 + 3.0 * r_cut / s.L;
  for (int p = -boxes; p <= boxes; ++p)
    for (int q = -boxes; q <= boxes; ++q)
      for (int w = -boxes; w <= boxes; ++w)
        for (long i = 0; i < 3 * s.n; i += 3)
          for (long j = 0; j < 3 * s.n; j += 3) {
            const Eigen::Vector3d d = vector(s.x[i], s.x[i + 1], s.x[i + 2]) -
                                      vector(s.x[j], s.x[j + 1], s.x[j + 2]) +
                                      s.L * vector(p, q, w);
            const double r = d.norm();
            if (r > 3.0 * r_cut) continue;
            const RpyPair m = part(r);
            const Eigen::Vector3d e = d / std::max(r, 1e-300);
            near.block<3, 3>(i, j) += (m.transverse * Eigen::Matrix3d::Identity() +
                                       (m.longitudinal - m.transverse) * e * e.transpose()) /
                                      (6.0 * pi);
          }
  return near;
}

/// M_w of it.
Matrix kaiser_bessel_far(const Scene &s, const KaiserBesselSplit &split)
{
  Matrix far = Matrix::Zero(3 * s.n, 3 * s.n);
  const int most = split.k_cut * s.L / (2.0 * pi);
  for (int p = -most; p <= most; ++p)
    for (int q = -most; q <= most; ++q)
      for (int w = -most; w <= most; ++w) {
        const Eigen::Vector3d k = 2.0 * pi / s.L * vector(p, q, w);
        const double k2 = k.squaredNorm();
        if (k2 == 0.0 || k2 > split.k_cut * split.k_cut) continue;
        const Eigen::Matrix3d P = split.weight(std::sqrt(k2)) / (k2 * s.L * s.L * s.L) *
                                  (Eigen::Matrix3d::Identity() - k * k.transpose() / k2);
        Eigen::VectorXcd phase(s.n);
        for (long i = 0; i < s.n; ++i)
          phase[i] = std::polar(1.0, k.dot(vector(s.x[3 * i], s.x[3 * i + 1], s.x[3 * i + 2])));
        for (long i = 0; i < s.n; ++i)
          for (long j = 0; j < s.n; ++j)
            far.block<3, 3>(3 * i, 3 * j) += (phase[i] * std::conj(phase[j])).real() * P;
      }
  return far;
}

double smallest(const Matrix &M)
{
  return 6.0 * pi *
         Eigen::SelfAdjointEigenSolver<Matrix>(M, Eigen::EigenvaluesOnly).eigenvalues()(0);
}

void split()
{
  std::printf("xi_a,classical_near,classical_far,positive_near,positive_far,difference_of_sums,"
              "kaiser_near,kaiser_far,kaiser_excess,kaiser_difference\n");
  const Scene s(30, 0.2);
  const std::vector<double> whole = dense_mobility(s.cell(), s.x.data(), s.n, 1.0, 1.0);
  const Eigen::Map<const Matrix> M(whole.data(), 3 * s.n, 3 * s.n);
  for (double xi : {0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 1.0, 1.2, 1.5, 2.0}) {
    const auto classical = classical_split(s, xi);
    const DenseSplit d = dense_split(s.cell(), s.x.data(), s.n, 1.0, 1.0, xi);
    // That of a tolerance of 1e-3; the choice of parameters goes no further than an excess of 0.
    const double reach = 10.0, k_cut = 2.0 * xi *
                                       std::sqrt(KaiserBesselSplit::decline(
                                           kaiser_bessel_split(1.0, reach, 1.0).beta));
    const KaiserBesselSplit kaiser = kaiser_bessel_split(k_cut, reach / k_cut, 1.0);
    const Matrix near = kaiser_bessel_near(s, kaiser, reach / k_cut),
                 far = kaiser_bessel_far(s, kaiser);
    std::printf("%g,%.6g,%.6g,%.6g,%.6g,%.2g,%.6g,%.6g,%.2g,%.2g\n", xi, smallest(classical.first),
                smallest(classical.second),
                smallest(Eigen::Map<const Matrix>(d.real.data(), 3 * s.n, 3 * s.n)),
                smallest(Eigen::Map<const Matrix>(d.wave.data(), 3 * s.n, 3 * s.n)),
                (classical.first + classical.second - M).norm() / M.norm(), smallest(near),
                smallest(far), kaiser_bessel_excess(kaiser), (near + far - M).norm() / M.norm());
    std::fflush(stdout);
  }
}

void lanczos()
{
  std::printf("scene,phi,xi_a,tolerance,iterations,condition\n");
  std::vector<std::pair<const char *, Scene>> scenes{{"hard spheres", Scene(200, 0.1)},
                                                     {"hard spheres", Scene(200, 0.3)},
                                                     {"touching ball", cluster(200, 24.0)}};
  Scene overlapping = scenes[1].second;
  for (double &v : overlapping.x) v *= 0.84;    // phi 0.51, many overlaps
  overlapping.L *= 0.84;
  scenes.push_back({"overlapping", overlapping});
  // 4 x 4 x 4 cells of an fcc crystal with phi = 0.5, displaced at random by less than the gaps.
  std::vector<double> x;
  const double edge = std::cbrt(4.0 * 4.0 / 3.0 * pi / 0.5), L = 4.0 * edge;
  std::mt19937_64 engine(4);
  std::uniform_real_distribution<double> shake(-0.05, 0.05);
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      for (int k = 0; k < 8; ++k)
        if ((i + j + k) % 2 == 0)
          for (int c : {i, j, k}) x.push_back(0.5 * edge * c + shake(engine));
  scenes.push_back({"shaken crystal", Scene(x, L)});
  for (const auto &named : scenes) {
    const Scene &s = named.second;
    for (double xi : {0.2, 0.5, 1.0, 2.0}) {
      const DenseSplit d = dense_split(s.cell(), s.x.data(), s.n, 1.0, 1.0 / (6.0 * pi), xi);
      const Matrix A = Eigen::Map<const Matrix>(d.real.data(), 3 * s.n, 3 * s.n);
      const Eigen::VectorXd lambda =
          Eigen::SelfAdjointEigenSolver<Matrix>(A, Eigen::EigenvaluesOnly).eigenvalues();
      bdh_test::DenseOperator op(A);
      LanczosRoot<bdh_test::DenseOperator> root;
      const AlignedVector z(s.force.begin(), s.force.end());
      AlignedVector y;
      for (double t : {1e-1, 1e-3, 1e-6, 1e-9})
        std::printf("%s,%.3g,%g,%g,%d,%.4g\n", named.first, s.phi(), xi, t,
                    root.apply(op, z, {t, 2000}, y).iterations,
                    lambda(lambda.size() - 1) / lambda(0));
      std::fflush(stdout);
    }
  }
}

/// J L^-1 of the random finite difference, compared with that for delta = 1e-4 h and the same
/// random numbers.
void delta()
{
  std::printf("scene,kernel,delta,error\n");
  for (int walled : {0, 1})
    for (const IbKernel kernel : {IbKernel::roma3, IbKernel::peskin4, IbKernel::bkp6}) {
      Grid g;
      g.n = {16, 16, 16};
      g.length = {16.0, 16.0, 16.0};
      if (walled) g.boundary[2] = {Boundary::noslip, Boundary::noslip};
      std::mt19937_64 engine(6);
      std::uniform_real_distribution<double> uniform(1.0, 15.0);
      std::vector<double> x;
      for (int i = 0; i < 300; ++i) x.push_back(uniform(engine));
      FibFluid<FibOnHost> fluid(g, kernel, FftEffort::estimate, Comm(MPI_COMM_WORLD));
      BrownianStep<FibOnHost> step(fluid);
      RestingParticles p(x, 0.0);
      StepPlan plan;
      plan.scheme = Scheme::euler;
      plan.kT = 1.0;
      plan.dt = 1e-6;
      const auto drift = [&](double d) {
        plan.delta = d;
        plan.drift = Drift::no;
        step.take(p, plan);
        std::vector<double> none = p.velocity;
        plan.drift = Drift::finite_difference;
        step.take(p, plan);
        for (std::size_t i = 0; i < none.size(); ++i) none[i] = p.velocity[i] - none[i];
        return none;
      };
      const std::vector<double> best = drift(1e-4);
      for (int e = 1; e <= 12; ++e)
        std::printf("%s,%s,1e-%02d,%.4g\n", walled ? "slit" : "periodic", kernel_name(kernel), e,
                    relative_difference(drift(std::pow(10.0, -e)), best));
      std::fflush(stdout);
    }
}

}    // namespace

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  const std::string what = argc > 1 ? argv[1] : "";
  std::vector<long> counts;
  for (int i = 2; i < argc; ++i) counts.push_back(std::atol(argv[i]));
  if (what == "accuracy")
    accuracy();
  else if (what == "slit")
    slit();
  else if (what == "spheres")
    spheres();
  else if (what == "size")
    sizes(counts);
  else if (what == "split")
    split();
  else if (what == "lanczos")
    lanczos();
  else if (what == "delta")
    delta();
  else if (what == "wall")
    wall();
  else if (what == "open_wall")
    open_wall();
  else
    std::fprintf(stderr, "usage: see the top of bench_charts.cpp\n");
  MPI_Finalize();
}
