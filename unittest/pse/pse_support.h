// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Scenes for tests of positively split Ewald: cells, brute-force neighbour lists, and particles
/// dealt to ranks.
#ifndef BDH_TEST_PSE_SUPPORT_H
#define BDH_TEST_PSE_SUPPORT_H

#include "pse/mobility.h"
#include "support/test_support.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace bdh_test {

inline bdh::Cell cubic_cell(double L)
{
  bdh::Cell c;
  c.lx = c.ly = c.lz = L;
  return c;
}

inline std::array<double, 3> edges(const bdh::Cell &c) { return {c.edge(0), c.edge(1), c.edge(2)}; }

inline bdh::PseScene scene_of(const bdh::Cell &cell, long n, double radius, double tolerance)
{
  bdh::PseScene s;
  s.volume = cell.volume();
  s.edge = edges(cell);
  s.particles = n;
  s.radius = radius;
  s.tolerance = tolerance;
  s.noise = false;
  return s;
}

/// The smallest box that holds some points.
class Bounds {
 public:
  explicit Bounds(const std::vector<double> &x)
  {
    for (std::size_t k = 0; k < x.size(); ++k) {
      low_[k % 3] = std::min(low_[k % 3], x[k]);
      high_[k % 3] = std::max(high_[k % 3], x[k]);
    }
  }
  /// No more than the square of the distance from y to any of the points.
  double distance2(const double *y) const
  {
    double r2 = 0.0;
    for (int d = 0; d < 3; ++d) {
      const double r = std::max({low_[d] - y[d], y[d] - high_[d], 0.0});
      r2 += r * r;
    }
    return r2;
  }

 private:
  static constexpr double far = std::numeric_limits<double>::infinity();
  double low_[3] = {far, far, far}, high_[3] = {-far, -far, -far};
};

/// The neighbours that LAMMPS would list with newton off, found by checking all images.
class BruteNeighbors {
 public:
  /// anywhere: 3 n positions of all particles; mine: numbers of this rank's particles, as in Deal.
  /// A ghost that is the image of a particle of this rank is listed as that image.
  BruteNeighbors(const bdh::Cell &cell, const std::vector<double> &anywhere, double r_cut,
                 const std::vector<long> &mine)
  {
    const std::vector<double> x = wrapped(cell, anywhere);
    const long n = x.size() / 3, owned = bdh::ssize(mine);
    std::vector<int> place(n, -1);
    for (long p = 0; p < owned; ++p) place[mine[p]] = p;
    for (long p = 0; p < owned; ++p) add_atom(&x[3 * mine[p]], p, mine[p]);
    const long range[3] = {images(cell.volume() / area(cell, 1, 2), r_cut),
                           images(cell.volume() / area(cell, 2, 0), r_cut),
                           images(cell.volume() / area(cell, 0, 1), r_cut)};
    lists_.resize(owned);
    all_ = owned;
    const Bounds bounds(x_);
    for (long j = 0; j < n; ++j) {
      double shift[3] = {0, 0, 0};    // makes image 0 the nearest to the first particle
      for (long a = -range[0]; a <= range[0]; ++a)
        for (long b = -range[1]; b <= range[1]; ++b)
          for (long c = -range[2]; c <= range[2]; ++c) {
            const double m[3] = {double(a), double(b), double(c)};
            cell.lattice_vector(m, shift);
            const double y[3] = {x[3 * j] + shift[0], x[3 * j + 1] + shift[1],
                                 x[3 * j + 2] + shift[2]};
            if (bounds.distance2(y) > r_cut * r_cut) continue;    // true of most images
            const bool self_image = a || b || c;
            int atom = -1;
            for (long p = 0; p < owned; ++p) {
              const long i = mine[p];
              if (!self_image && (i == j || (place[j] >= 0 && place[j] <= p))) continue;
              double r2 = 0.0;
              for (int d = 0; d < 3; ++d) r2 += (x[3 * i + d] - y[d]) * (x[3 * i + d] - y[d]);
              if (r2 > r_cut * r_cut) continue;
              if (!self_image && place[j] >= 0) atom = place[j];
              if (atom < 0) atom = add_atom(y, place[j] >= 0 ? place[j] : all_++, j);
              lists_[p].push_back(atom);
            }
          }
    }
    for (long p = 0; p < owned; ++p) {
      rows_.push_back(p);
      count_.push_back(lists_[p].size());
      first_.push_back(lists_[p].data());
    }
    view_.rows = owned;
    view_.atom = rows_.data();
    view_.count = count_.data();
    view_.neighbors = first_.data();
    view_.local_atoms = owned;
    view_.x = x_.data();
    view_.particle = particle_.data();
  }

  const bdh::NeighborView &view() const { return view_; }
  long all() const { return all_; }
  long atoms() const { return bdh::ssize(particle_); }
  /// Global numbers of the entries of a vector from `owned` on.
  const std::vector<long> &foreign() const { return foreign_; }

 private:
  static long images(double height, double r_cut) { return std::ceil(r_cut / height) + 1; }
  static std::vector<double> wrapped(const bdh::Cell &cell, std::vector<double> x)
  {
    for (std::size_t i = 0; i < x.size(); i += 3) {
      double s[3], r[3];
      cell.to_fractional(&x[i], s);
      for (double &c : s) c = std::floor(c);
      cell.lattice_vector(s, r);
      for (int d = 0; d < 3; ++d) x[i + d] -= r[d];
    }
    return x;
  }
  static double area(const bdh::Cell &c, int i, int j)
  {
    const double e[3][3] = {{c.lx, 0, 0}, {c.xy, c.ly, 0}, {c.xz, c.yz, c.lz}};
    const double *u = e[i], *v = e[j];
    const double w[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                         u[0] * v[1] - u[1] * v[0]};
    return std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  }
  int add_atom(const double *x, int particle, long global)
  {
    x_.insert(x_.end(), x, x + 3);
    particle_.push_back(particle);
    if (particle >= static_cast<int>(lists_.empty() ? 1 << 30 : lists_.size()))
      foreign_.push_back(global);
    return particle_.size() - 1;
  }

  bdh::NeighborView view_;
  long all_ = 0;
  std::vector<double> x_;
  std::vector<int> particle_, rows_, count_;
  std::vector<std::vector<int>> lists_;
  std::vector<const int *> first_;
  std::vector<long> foreign_;
};

/// Exchanges ghosts of other ranks through a vector of all particles.
class BruteExchange : public bdh::GhostExchange {
 public:
  BruteExchange(const bdh::Comm &comm, long n, const std::vector<long> &mine) :
      comm_(comm), n_(n), mine_(mine)
  {}
  void use(const std::vector<long> &foreign) { foreign_ = foreign; }
  void forward(float *v, int quads) override { fill(v, quads); }
  void forward(double *v, int quads) override { fill(v, quads); }

 private:
  template <class Real> void fill(Real *v, int quads)
  {
    const long slots = bdh::quad * quads;
    std::vector<double> all(slots * n_, 0.0);
    for (std::size_t p = 0; p < mine_.size(); ++p)
      for (long c = 0; c < slots; ++c) all[slots * mine_[p] + c] = v[slots * p + c];
    sum_over_ranks(all, comm_);
    for (std::size_t g = 0; g < foreign_.size(); ++g)
      for (long c = 0; c < slots; ++c)
        v[slots * (mine_.size() + g) + c] = all[slots * foreign_[g] + c];
  }
  bdh::Comm comm_;
  long n_;
  std::vector<long> mine_, foreign_;
};

/// M force + noise by the far and the near part of a bound mobility, each on its own.
template <class Mobility>
std::vector<double> far_and_near(Mobility &M, const bdh::PseForces &forces,
                                 const bdh::PseNoise &noise, std::size_t particles)
{
  std::vector<double> far(bdh::dof * particles, NAN), by_forces = far, by_noise = far;
  M.far(forces, noise, far.data());
  M.near(forces, noise, {by_forces.data(), by_noise.data()});
  for (std::size_t k = 0; k < far.size(); ++k) far[k] += by_forces[k] + by_noise[k];
  return far;
}

/// A mobility bound to positions, on one rank or several.  All vectors hold all particles.
class PseHarness {
 public:
  PseHarness(const bdh::Cell &cell, const std::vector<double> &x, const bdh::PsePlan &plan,
             const bdh::Comm &comm = self(), int limit = 200,
             const bdh::Workers &workers = bdh::Workers::one()) :
      comm_(comm),
      deal_(x.size() / 3, comm), n_(x.size() / 3), exchange_(comm, n_, deal_.mine),
      neighbors_(cell, x, plan.r_cut, deal_.mine),
      M_(bdh::make_pse(plan, limit, {comm, bdh::FftEffort::estimate, &exchange_, workers})),
      mine_(deal_.take(x))
  {
    exchange_.use(neighbors_.foreign());
    for (long i : deal_.mine) id_.push_back(i + 1);
    M_->set_cell(cell);
    M_->bind(
        {bdh::ssize(deal_.mine), mine_.data(), id_.data(), neighbors_.view(), neighbors_.all()});
  }

  std::vector<double> apply(const std::vector<double> &force, double viscosity)
  {
    const std::vector<double> f = deal_.take(force);
    std::vector<double> u(f.size(), NAN);
    M_->set_viscosity(viscosity);
    M_->apply({f.data(), true}, u.data());
    return deal_.gather(u, n_, comm_);
  }
  /// No force: none acts.
  std::vector<double> fluctuate(const std::vector<double> &force, const bdh::PseNoise &noise,
                                double viscosity)
  {
    const std::vector<double> f = force.empty() ? force : deal_.take(force);
    std::vector<double> u(bdh::dof * deal_.mine.size(), NAN);
    M_->set_viscosity(viscosity);
    report = M_->fluctuate({f.data(), !force.empty()}, noise, u.data());
    return deal_.gather(u, n_, comm_);
  }
  std::vector<double> in_parts(const std::vector<double> &force, const bdh::PseNoise &noise,
                               double viscosity)
  {
    const std::vector<double> f = deal_.take(force);
    M_->set_viscosity(viscosity);
    return deal_.gather(far_and_near(*M_, {f.data(), true}, noise, deal_.mine.size()), n_, comm_);
  }
  /// The real-space part of velocities alone.
  std::vector<double> near(const std::vector<double> &force, double viscosity)
  {
    const std::vector<double> f = deal_.take(force);
    std::vector<double> u(f.size(), NAN);
    M_->set_viscosity(viscosity);
    M_->near({f.data(), true}, {}, {u.data(), nullptr});
    return deal_.gather(u, n_, comm_);
  }
  bdh::HostPseMobility &mobility() { return *M_; }
  bdh::PseReport report;

 private:
  bdh::Comm comm_;
  Deal deal_;
  long n_;
  BruteExchange exchange_;
  BruteNeighbors neighbors_;
  std::unique_ptr<bdh::HostPseMobility> M_;
  std::vector<double> mine_;
  std::vector<uint64_t> id_;
};

inline double relative_error(const std::vector<double> &u, const std::vector<double> &exact)
{
  return difference(u, exact) / norm(exact);
}

}    // namespace bdh_test
#endif
