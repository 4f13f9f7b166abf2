// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Compares integrators of Brownian dynamics for the collapsing cluster of examples/cluster, in
/// free space with dense matrices and no Ewald sums.  Prints lines with time, mean radius of
/// gyration and its standard error, over all trajectories (A) and over those that end as one
/// cluster (R), and a histogram of bond lengths (H).
///
///     build/bench/bench_schemes SCHEME dt xi*a trajectories duration [numbers of the scheme]
///
///     em | lm | trap     Euler-Maruyama; Leimkuhler-Matthews; predictor-corrector with the mean
///     force lie n averaged     a far step, then n near ones of Euler-Maruyama (averaged = 0) or
///                        Leimkuhler-Matthews (averaged = 1)
///     const n averaged   far velocity, drift and noise are kept constant over n near steps
///     sk | sklag  stages damping shift held fresh
///                        Chebyshev stages of Abdulle, Almuslimani and Vilmart (SK-ROCK);
///                        sklag: mobility at the observed positions; held = 1: the far drift is
///                        kept constant; fresh = 1: the mobility is updated at each stage
#include "pair/asakura_oosawa_kernel.h"
#include "pse/rpy.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace {

constexpr int N = 13;
using Vector = Eigen::Matrix<double, 3 * N, 1>;
using Matrix = Eigen::Matrix<double, 3 * N, 3 * N>;

constexpr double a = 3.2, eta = 1.0, kT = 12.3, eps = 10.0, sigma = 6.4, D = 7.183757109179987,
                 c_ao = 17.852783203125;
const double mu0 = 1.0 / (6.0 * M_PI * eta * a);

void force(const Vector &x, Vector &F)
{
  F.setZero();
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < i; ++j) {
      const Eigen::Vector3d d = x.segment<3>(3 * i) - x.segment<3>(3 * j);
      const double r2 = d.squaredNorm();
      if (r2 >= D * D) continue;
      const double s6 = std::pow(sigma * sigma / r2, 3.0);
      const double f =
          48.0 * eps * s6 * (s6 - 0.5) / r2 + bdh::ao_force_over_r(std::sqrt(r2), c_ao, D);
      F.segment<3>(3 * i) += f * d;
      F.segment<3>(3 * j) -= f * d;
    }
}

double xi = 0.5;    // in units of 1/a

/// The parts of the mobility.
struct Mobility {
  Matrix near, all;
  void set(const Vector &x, bool want_near, bool want_all)
  {
    const double self = bdh::real_space_self(xi);
    near.setZero();
    all.setZero();
    for (int i = 0; i < 3 * N; ++i) {
      near(i, i) = mu0 * self;
      all(i, i) = mu0;
    }
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < i; ++j) {
        Eigen::Vector3d e = (x.segment<3>(3 * i) - x.segment<3>(3 * j)) / a;
        const double r = e.norm();
        e /= r;
        const auto block = [&](bdh::RpyPair m) {
          return Eigen::Matrix3d(mu0 * (m.transverse * Eigen::Matrix3d::Identity() +
                                        (m.longitudinal - m.transverse) * e * e.transpose()));
        };
        if (want_near)
          near.block<3, 3>(3 * i, 3 * j) = near.block<3, 3>(3 * j, 3 * i) =
              block(bdh::real_space_closed_form(r, xi));
        if (!want_all) continue;
        const Eigen::Matrix3d m = block(bdh::free_space_rpy(r));
        all.block<3, 3>(3 * i, 3 * j) = all.block<3, 3>(3 * j, 3 * i) = m;
      }
  }
};

struct Random {
  std::mt19937_64 engine;
  std::normal_distribution<double> normal;
  Vector draw()
  {
    Vector z;
    for (int i = 0; i < 3 * N; ++i) z[i] = normal(engine);
    return z;
  }
  /// A normal vector of covariance M.
  Vector with(const Matrix &M)
  {
    const Eigen::LLT<Matrix> root(M);
    if (root.info() != Eigen::Success) std::fprintf(stderr, "a matrix is not positive definite\n");
    return root.matrixL() * draw();
  }
};

/// Coefficients of the stabilised scheme with s stages.
struct Chebyshev {
  std::vector<double> mu, nu, kappa;
  double shift, limit;
  Chebyshev(int s, double damping, double shift_factor) : mu(s + 1), nu(s + 1), kappa(s + 1)
  {
    const double w0 = 1.0 + damping / (s * s);
    std::vector<double> T(s + 1), dT(s + 1);
    T[0] = 1.0;
    T[1] = w0;
    dT[0] = 0.0;
    dT[1] = 1.0;
    for (int i = 2; i <= s; ++i) {
      T[i] = 2.0 * w0 * T[i - 1] - T[i - 2];
      dT[i] = 2.0 * T[i - 1] + 2.0 * w0 * dT[i - 1] - dT[i - 2];
    }
    const double w1 = T[s] / dT[s];
    mu[1] = w1 / w0;
    kappa[1] = s * w1 / w0;
    for (int i = 2; i <= s; ++i) {
      mu[i] = 2.0 * w1 * T[i - 1] / T[i];
      nu[i] = 2.0 * w0 * T[i - 1] / T[i];
      kappa[i] = -T[i - 2] / T[i];
    }
    shift = shift_factor * 0.5 * s * w1;
    limit = (1.0 + w0) / w1;
  }
};

struct State {
  Vector x;    // positions for forces and observables
  Vector q;    // pending noise
  bool started = false;
  Random random;
};

using Step = std::function<void(State &, double)>;

Mobility m;
Vector F;

/// u: velocity of the far part
void near_step(State &s, double h, bool averaged, bool moved, const Vector &u)
{
  if (moved) {
    m.set(s.x, true, false);
    force(s.x, F);
  }
  const Vector q = std::sqrt(2.0 * kT * h) * s.random.with(m.near);
  if (!s.started) s.q = q;
  s.started = true;
  s.x += h * (m.near * F + u) + (averaged ? 0.5 * (s.q + q) : q);
  s.q = q;
}

void euler_maruyama(State &s, double h)
{
  m.set(s.x, false, true);
  force(s.x, F);
  s.x += h * m.all * F + std::sqrt(2.0 * kT * h) * s.random.with(m.all);
}

/// With the mobility at the positions of the forces.
void leimkuhler_matthews(State &s, double h)
{
  m.set(s.x, false, true);
  force(s.x, F);
  if (!s.started) s.q = std::sqrt(2.0 * kT * h) * s.random.with(m.all);
  s.started = true;
  const Vector q = std::sqrt(2.0 * kT * h) * s.random.with(m.all);
  s.x += h * m.all * F + 0.5 * (s.q + q);
  s.q = q;
}

/// Predictor-corrector with the mean force, and the noise and mobility of the initial positions.
void trapezoidal(State &s, double h)
{
  m.set(s.x, false, true);
  force(s.x, F);
  const Vector q = std::sqrt(2.0 * kT * h) * s.random.with(m.all), f0 = F;
  force(s.x + h * m.all * F + q, F);
  s.x += 0.5 * h * m.all * (F + f0) + q;
}

Matrix far_mobility() { return m.all - m.near + 1e-12 * mu0 * Matrix::Identity(); }

/// A far step, then n near ones.  p: n, and whether the noise is averaged.
Step far_then_near(const std::vector<double> &p)
{
  const int n = p[0];
  const bool averaged = p.size() > 1 && p[1] > 0;
  return [n, averaged](State &s, double H) {
    const double h = H / n;
    m.set(s.x, true, true);
    force(s.x, F);
    const Matrix far = far_mobility();
    s.x += H * far * F + std::sqrt(2.0 * kT * H) * s.random.with(far);
    for (int i = 0; i < n; ++i) near_step(s, h, averaged, true, Vector::Zero());
  };
}

/// Far velocity, drift and noise are kept constant over n near steps.  p: as above.
Step constant_far(const std::vector<double> &p)
{
  const int n = p[0];
  const bool averaged = p.size() > 1 && p[1] > 0;
  return [n, averaged](State &s, double H) {
    const double h = H / n;
    m.set(s.x, true, true);
    force(s.x, F);
    const Matrix far = far_mobility();
    const Vector u = far * F + std::sqrt(2.0 * kT / H) * s.random.with(far);
    for (int i = 0; i < n; ++i) near_step(s, h, averaged, i > 0, u);
  };
}

/// Stabilized stages.  p: stages, damping, shift factor, whether the far flow is held, and whether
/// the mobility is that of each stage.  lag: the noise is that of the step before.
Step stabilized(const std::vector<double> &p, bool lag)
{
  const Chebyshev c(p[0], p[1], p[2]);
  const bool hold = p[3] > 0, fresh = p.size() > 4 && p[4] > 0;
  std::fprintf(stderr, "limit of h lambda %g, shift %g\n", c.limit, c.shift);
  return [c, hold, lag, fresh](State &s, double h) {
    if (!s.started) {
      m.set(s.x, true, true);
      s.q = std::sqrt(2.0 * kT * h) * s.random.with(m.all);
      if (!lag) s.x += c.shift * s.q;
      s.started = true;
    }
    const Vector X = s.x - c.shift * s.q;
    m.set(lag ? s.x : X, hold, true);
    Vector q;
    if (lag) q = std::sqrt(2.0 * kT * h) * s.random.with(m.all);
    force(s.x, F);
    const Matrix &M = hold ? m.near : m.all;
    const Vector u = hold ? Vector((m.all - m.near) * F) : Vector::Zero();
    Vector before = X, now = X + c.mu[1] * h * (M * F + u) + c.kappa[1] * s.q;
    for (std::size_t i = 2; i < c.mu.size(); ++i) {
      force(now, F);
      if (fresh) m.set(now, hold, true);
      const Vector next = c.mu[i] * h * (M * F + u) + c.nu[i] * now + c.kappa[i] * before;
      before = now;
      now = next;
    }
    if (!lag) {
      m.set(now, hold, true);
      q = std::sqrt(2.0 * kT * h) * s.random.with(m.all);
    }
    s.q = q;
    s.x = now + c.shift * q;
  };
}

Step make(const std::string &name, const std::vector<double> &p)
{
  if (name == "em") return euler_maruyama;
  if (name == "lm") return leimkuhler_matthews;
  if (name == "trap") return trapezoidal;
  if (name == "lie") return far_then_near(p);
  if (name == "const") return constant_far(p);
  if (name == "sk" || name == "sklag") return stabilized(p, name == "sklag");
  std::fprintf(stderr, "unknown scheme %s\n", name.c_str());
  std::exit(1);
}

Vector start()
{
  const double p = 5.8249223595, q = 3.6;
  const double v[12][3] = {{0, q, p}, {0, q, -p}, {0, -q, p}, {0, -q, -p},
                           {p, 0, q}, {-p, 0, q}, {p, 0, -q}, {-p, 0, -q},
                           {q, p, 0}, {q, -p, 0}, {-q, p, 0}, {-q, -p, 0}};
  Vector x = Vector::Zero();
  for (int i = 0; i < 12; ++i)
    for (int d = 0; d < 3; ++d) x[3 * (i + 1) + d] = v[i][d];
  return x;
}

double gyration(const Vector &x)
{
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  for (int i = 0; i < N; ++i) c += x.segment<3>(3 * i) / N;
  double s = 0.0;
  for (int i = 0; i < N; ++i) s += (x.segment<3>(3 * i) - c).squaredNorm() / N;
  return std::sqrt(s);
}

bool bound(const Vector &x)
{
  std::vector<char> in(N, 0);
  in[0] = 1;
  for (int pass = 0; pass < N; ++pass)
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j)
        if (in[i] && !in[j] && (x.segment<3>(3 * i) - x.segment<3>(3 * j)).norm() < D) in[j] = 1;
  for (char b : in)
    if (!b) return false;
  return true;
}

constexpr double interval = 0.5;    // between frames
constexpr int bins = 60;
constexpr double low = 4.8, high = 7.2;    // of the histogram of distances

/// A trajectory: gyration radius by frame, and distances of its last three quarters.
struct Trajectory {
  std::vector<double> curve;
  std::vector<double> bonds = std::vector<double>(bins);
  bool finite = true, is_bound = false;
};

void count_bonds(const Vector &x, std::vector<double> &bonds)
{
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < i; ++j) {
      const double r = (x.segment<3>(3 * i) - x.segment<3>(3 * j)).norm();
      if (!(r > low && r < high)) continue;
      const int bin = (r - low) / (high - low) * bins;
      bonds[bin] += 1.0;
    }
}

Trajectory run(const Step &step, double h, int frames, unsigned seed)
{
  const long per_frame = std::lround(interval / h);
  State s;
  s.x = start();
  s.random.engine.seed(seed);
  Trajectory t;
  t.curve.push_back(gyration(s.x));
  for (int f = 1; f <= frames && t.finite; ++f) {
    for (long k = 0; k < per_frame; ++k) step(s, h);
    t.curve.push_back(gyration(s.x));
    t.finite = std::isfinite(t.curve.back()) && t.curve.back() < 1e3;
    if (f >= 0.25 * frames) count_bonds(s.x, t.bonds);
  }
  t.is_bound = t.finite && bound(s.x);
  return t;
}

/// Sums over trajectories, by frame.
struct Sums {
  explicit Sums(int frames) : sum(frames + 1), square(frames + 1) {}
  void add(const std::vector<double> &curve)
  {
    ++count;
    for (std::size_t f = 0; f < sum.size(); ++f) {
      sum[f] += curve[f];
      square[f] += curve[f] * curve[f];
    }
  }
  void print(char name) const
  {
    for (std::size_t f = 0; f < sum.size(); ++f) {
      const double mean = sum[f] / count,
                   variance = std::fmax(0.0, square[f] / count - mean * mean);
      std::printf("%c %g %.6f %.6f\n", name, f * interval, mean, std::sqrt(variance / count));
    }
  }
  std::vector<double> sum, square;
  int count = 0;
};

}    // namespace

int main(int argc, char **argv)
{
  if (argc < 6) return 1;
  const std::string name = argv[1];
  const double h = std::atof(argv[2]);
  xi = std::atof(argv[3]);
  const int trajectories = std::atoi(argv[4]);
  const double duration = std::atof(argv[5]);
  std::vector<double> p;
  for (int i = 6; i < argc; ++i) p.push_back(std::atof(argv[i]));
  const Step step = make(name, p);
  const int frames = std::lround(duration / interval);
  Sums all(frames), kept(frames);
  std::vector<double> histogram(bins);
  const auto t0 = std::chrono::steady_clock::now();
  for (int t = 0; t < trajectories; ++t) {
    const Trajectory one = run(step, h, frames, t + 12345u);
    if (one.finite) all.add(one.curve);
    if (!one.is_bound) continue;
    kept.add(one.curve);
    for (int b = 0; b < bins; ++b) histogram[b] += one.bonds[b];
  }
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count();
  std::printf("# %s dt %g xi %g trajectories %d bound %d exploded %d seconds %.1f\n", name.c_str(),
              h, xi, trajectories, kept.count, trajectories - all.count, seconds);
  all.print('A');
  kept.print('R');
  const double samples = kept.count * (frames - static_cast<int>(0.25 * frames) + 1.0);
  for (int b = 0; b < bins; ++b)
    std::printf("H %g %.6f\n", low + (b + 0.5) * (high - low) / bins, histogram[b] / samples);
  return 0;
}
