// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Positively split Ewald on a Kokkos execution space, compared with the host, the reference and the
// dense oracle.  -D BDH_TEST_EXEC=Kokkos::OpenMP, ... selects the space.

#include "oracle/dense_rpy.h"
#include "pse/mobility_kokkos.h"
#include "pse/pse_support.h"
#include "pse/sphere_support.h"
#include "support/reference_json.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

using namespace bdh_test;
using bdh::Cell;
using bdh::Moments;
using bdh::PseNoise;
using bdh::PsePlan;
using bdh::SpreadBy;
using Exec = BDH_TEST_EXEC;
using Vector = std::vector<double>;

namespace {

/// Full lists of the neighbours that BruteNeighbors finds, stored by columns or by rows.
class FullNeighbors {
 public:
  FullNeighbors(const bdh::NeighborView &half, long particles, bool by_columns) :
      count_(particles, 0), rows_(count_.size())
  {
    std::vector<std::vector<int>> full(rows_.size());
    for (long p = 0; p < particles; ++p)
      for (int k = 0; k < half.count[p]; ++k) {
        const int j = half.neighbors[p][k];
        full[p].push_back(j);
        if (j < half.local_atoms) full[j].push_back(p);
      }
    std::size_t most = 0;
    for (const auto &f : full) most = std::max(most, f.size());
    const long n = particles;
    view_.atom_stride = by_columns ? 1 : most;
    view_.neighbor_stride = by_columns ? n : 1;
    list_.resize(rows_.size() * most);
    for (long p = 0; p < n; ++p) {
      rows_[p] = p;
      count_[p] = full[p].size();
      for (std::size_t k = 0; k < full[p].size(); ++k)
        list_[p * view_.atom_stride + k * view_.neighbor_stride] = full[p][k];
    }
    view_.rows = n;
    view_.atom = rows_.data();
    view_.count = count_.data();
    view_.neighbors = list_.data();
    view_.most = most;
    view_.x = half.x;
    view_.particle = half.particle;
  }
  const bdh::DeviceNeighbors &view() const { return view_; }

 private:
  std::vector<int> count_, rows_, list_;
  bdh::DeviceNeighbors view_;
};

/// All particles of a scene, on one process.
bdh::PseParticles<bdh::DeviceNeighbors> everything(const Vector &x, const std::vector<uint64_t> &id,
                                                   const bdh::DeviceNeighbors &neighbors)
{
  const long n = bdh::ssize(x) / bdh::dim;
  return {n, x.data(), id.data(), neighbors, n};
}

/// A mobility on the device, on all ranks of the test.  All vectors hold all particles.
class DeviceHarness {
 public:
  DeviceHarness(const Cell &cell, const Vector &x, const PsePlan &plan,
                SpreadBy by = SpreadBy::automatic, bool by_columns = true,
                const Vector &radius = {}) :
      n_(bdh::ssize(x) / 3),
      deal_(n_, comm_), mine_(bdh::ssize(deal_.mine)), x_(deal_.take(x)), moments_(plan.moments()),
      brute_(cell, x, plan.r_cut, deal_.mine), full_(brute_.view(), mine_, by_columns),
      exchange_(comm_, n_, deal_.mine),
      M_(bdh::make_device_pse<Exec>(plan, 200, {comm_, &exchange_, by}))
  {
    exchange_.use(brute_.foreign());
    for (long i : deal_.mine) id_.push_back(i + 1);
    if (!radius.empty()) {
      radius_ = deal_.take(radius, 1);
      for (long i : brute_.foreign()) radius_.push_back(radius[i]);
    }
    M_->set_cell(cell);
    particles_ = {mine_, x_.data(), id_.data(), full_.view(), brute_.all(), radius_.data()};
    M_->bind(particles_);
  }
  Vector apply(const Vector &force, double viscosity)
  {
    const Vector f = deal_.take(force);
    Vector u(f.size(), NAN);
    M_->set_viscosity(viscosity);
    M_->apply({f.data(), true}, u.data());
    return gather(u);
  }
  Motions apply(const Motions &load, double viscosity)
  {
    const Motions here = take(load);
    Motions u = nothing();
    M_->set_viscosity(viscosity);
    M_->apply({here.linear.data(), true, here.angular.data(), here.strain.data()}, to(u));
    return gather(u);
  }
  Motions random(const PseNoise &noise, double viscosity)
  {
    Motions u = nothing();
    M_->set_viscosity(viscosity);
    M_->fluctuate({}, noise, to(u));
    return gather(u);
  }
  /// Motions under known loads and a constraint, whose unknown loads go to `unknown`; on one rank.
  Motions constrained(const Motions &load, const bdh::Constraint &constraint, double viscosity,
                      double tolerance, Motions &unknown)
  {
    bdh::PseConstraintSolver<bdh::DeviceExecution<Exec>, bdh::DeviceNeighbors> solver;
    bdh::MomentVectors<bdh::DeviceArray<double, Exec>> motion;
    motion.resize(mine_, moments_);
    M_->set_viscosity(viscosity);
    M_->keep_pairs();
    M_->apply({load.linear.data(), true, load.angular.data(), load.strain.data()},
              bdh::motions_of(motion));
    const auto problem = solver.problem(*M_, particles_, constraint, {tolerance, viscosity, 100});
    report.constraint_iterations = solver
                                       .solve(
                                           problem, *M_, [](double all) { return all; }, motion)
                                       .iterations;
    unknown = on_host(solver.loads());
    return on_host(motion);
  }
  Vector fluctuate(const Vector &force, const PseNoise &noise, double viscosity)
  {
    const Vector f = force.empty() ? force : deal_.take(force);
    Vector u(bdh::dof * mine_, NAN);
    M_->set_viscosity(viscosity);
    report = M_->fluctuate({f.data(), !force.empty()}, noise, u.data());
    return gather(u);
  }
  Vector in_parts(const Vector &force, const PseNoise &noise, double viscosity)
  {
    const Vector f = deal_.take(force);
    M_->set_viscosity(viscosity);
    return gather(far_and_near(*M_, {f.data(), true}, noise, mine_));
  }
  bdh::DevicePseMobility &mobility() { return *M_; }
  double pairs() const { return comm_.sum(M_->pairs()); }
  bdh::PseReport report;

 private:
  Vector gather(const Vector &u, long width = 3) const { return deal_.gather(u, n_, comm_, width); }
  Motions gather(const Motions &u) const
  {
    return {gather(u.linear), moments_ >= Moments::torque ? gather(u.angular) : Vector(),
            moments_ >= Moments::stresslet ? gather(u.strain, bdh::strain_numbers) : Vector()};
  }
  Motions take(const Motions &all) const
  {
    return {deal_.take(all.linear), deal_.take(all.angular),
            deal_.take(all.strain, bdh::strain_numbers)};
  }
  Motions nothing() const
  {
    const auto numbers = [this](Moments least, long width) {
      return Vector(moments_ >= least ? width * mine_ : 0, NAN);
    };
    return {numbers(Moments::none, bdh::dim), numbers(Moments::torque, bdh::dim),
            numbers(Moments::stresslet, bdh::strain_numbers)};
  }
  static bdh::PseVelocities to(Motions &u)
  {
    return {u.linear.data(), u.angular.data(), u.strain.data()};
  }
  static Motions on_host(const bdh::MomentVectors<bdh::DeviceArray<double, Exec>> &v)
  {
    return {v.linear.to_host(), v.angular.to_host(), v.strain.to_host()};
  }
  bdh::Comm comm_ = world();
  long n_;
  Deal deal_;
  long mine_;
  Vector x_, radius_;
  Moments moments_;
  BruteNeighbors brute_;
  FullNeighbors full_;
  BruteExchange exchange_;
  std::unique_ptr<bdh::DevicePseMobility> M_;
  std::vector<uint64_t> id_;
  bdh::PseParticles<bdh::DeviceNeighbors> particles_;
};

Cell tilted_cell()
{
  Cell c;
  c.lo[0] = -1.3;
  c.lo[1] = 0.4;
  c.lo[2] = 2.0;
  c.lx = 9.0;
  c.ly = 8.0;
  c.lz = 10.0;
  c.xy = 2.5;
  c.xz = -1.7;
  c.yz = 3.1;
  return c;
}

/// n random positions in the cell and up to two boxes around it; the last two overlap.
Vector positions(const Cell &cell, long n, unsigned seed)
{
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> uniform(-2.0, 2.0);
  Vector x;
  for (long i = 0; i < n; ++i) {
    const double m[3] = {uniform(engine), uniform(engine), uniform(engine)};
    double r[3];
    cell.lattice_vector(m, r);
    for (int d = 0; d < 3; ++d) x.push_back(cell.lo[d] + r[d]);
  }
  if (n > 1)
    for (int d = 0; d < 3; ++d) x[3 * (n - 1) + d] = x[3 * (n - 2) + d] + 0.3;
  return x;
}

}    // namespace

// The response to forces and the noise agree to round-off.  Velocities are sums of some thousand
// terms, and the noise takes some ten Lanczos iterations.  A wrong or missing contribution is at
// least 1e-3.
TEST(DevicePse, EqualsTheHost)
{
  for (const Cell &cell : {cubic_cell(10.0), tilted_cell()})
    for (long n : {1L, 2L, 40L, 400L})
      for (double tolerance : {1e-2, 1e-3, 1e-7}) {
        const PsePlan plan = bdh::plan_pse(scene_of(cell, n, 1.0, tolerance));
        const double bound = plan.single ? 2e-6 : 1e-13;
        const Vector x = positions(cell, n, 7), f = random_numbers(3 * n, 3);
        const PseNoise noise{1.4, 4711, 12345678901};
        PseHarness host(cell, x, plan);
        for (SpreadBy by : {SpreadBy::automatic, SpreadBy::particles, SpreadBy::tiles}) {
          SCOPED_TRACE("n " + std::to_string(n) + " tolerance " + std::to_string(tolerance) +
                       " by " + std::to_string(int(by)));
          DeviceHarness device(cell, x, plan, by, by != SpreadBy::tiles);
          EXPECT_LT(relative_error(device.apply(f, 1.3), host.apply(f, 1.3)), bound);
          const Vector both = host.fluctuate(f, noise, 1.3),
                       random = host.fluctuate({}, noise, 1.3);
          EXPECT_LT(relative_error(device.fluctuate(f, noise, 1.3), both), 10.0 * bound);
          EXPECT_LT(relative_error(device.in_parts(f, noise, 1.3), both), 10.0 * bound);
          EXPECT_LT(relative_error(device.fluctuate({}, noise, 1.3), random), 10.0 * bound);
          EXPECT_EQ(device.report.iterations, host.report.iterations);
          EXPECT_EQ(device.pairs(), host.mobility().pairs());
        }
      }
}

// The independent reference, at tolerances that use both precisions.
TEST(DevicePse, ReferenceCases)
{
  const auto cases = json_reference("rpy_periodic.json")["cases"];
  ASSERT_GT(cases.size(), 5u);
  for (const auto &c : cases) {
    const Cell cell = cell_of(c["box"]);
    const Vector x = flatten(c["x"]), f = flatten(c["f"]), expected = flatten(c["u"]);
    for (double tolerance : {1e-3, 1e-5, 1e-10}) {
      const PsePlan plan = bdh::plan_pse(scene_of(cell, x.size() / 3, c["a"], tolerance));
      DeviceHarness device(cell, x, plan);
      EXPECT_LT(relative_error(device.apply(f, c["eta"]), expected), tolerance)
          << c["id"] << " at " << tolerance;
    }
  }
}

// A cell that has outgrown the grid gets a new grid, and the mobility is that of the new cell.
TEST(DevicePse, GridFollowsTheCell)
{
  const Cell small = cubic_cell(10.0), large = cubic_cell(14.0);
  const Vector x = positions(small, 30, 8), f = random_numbers(90, 4);
  const PsePlan plan = bdh::plan_pse(scene_of(small, 30, 1.0, 1e-5));
  const auto M = bdh::make_device_pse<Exec>(plan, 200, {self()});
  EXPECT_FALSE(M->set_cell(small));
  EXPECT_TRUE(M->set_cell(large));
  EXPECT_FALSE(M->set_cell(large));
  std::vector<long> all(30);
  std::iota(all.begin(), all.end(), 0L);
  const BruteNeighbors brute(large, x, plan.r_cut, all);
  const FullNeighbors full(brute.view(), 30, true);
  const std::vector<uint64_t> id = counted(30);
  M->bind(everything(x, id, full.view()));
  M->set_viscosity(1.0);
  Vector u(90), exact(90);
  M->apply({f.data(), true}, u.data());
  bdh::dense_apply(large, x.data(), 30, 1.0, 1.0, f.data(), exact.data());
  EXPECT_LT(relative_error(u, exact), 1e-5);
}

// Grid and transforms stay.
TEST(DevicePse, RadiusChanges)
{
  const Cell cell = cubic_cell(12.0);
  const Vector x = positions(cell, 30, 8), f = random_numbers(90, 4);
  const PseNoise noise{1.4, 4711, 17};
  PsePlan plan = bdh::plan_pse(scene_of(cell, 30, 1.0, 1e-5));
  DeviceHarness device(cell, x, plan);
  PseHarness host(cell, x, plan);
  ASSERT_TRUE(bdh::change_radius(plan, scene_of(cell, 30, 1.05, 1e-5)));
  ASSERT_TRUE(device.mobility().change_radius(plan));
  ASSERT_TRUE(host.mobility().change_radius(plan));
  EXPECT_LT(relative_error(device.apply(f, 1.3), host.apply(f, 1.3)), 1e-13);
  EXPECT_LT(relative_error(device.fluctuate(f, noise, 1.3), host.fluctuate(f, noise, 1.3)), 1e-12);
  Vector exact(90);
  bdh::dense_apply(cell, x.data(), 30, 1.05, 1.3, f.data(), exact.data());
  EXPECT_LT(relative_error(device.apply(f, 1.3), exact), 1e-5);
}

// Pairs that the list leaves out, as LAMMPS leaves out bonded atoms.
TEST(DevicePse, ExtraPairs)
{
  const Cell cell = cubic_cell(12.0);
  const Vector x = {1.0, 1.0, 1.0, 2.5, 1.0, 1.0, 6.0, 6.0, 6.0}, f = random_numbers(9, 5);
  const PsePlan plan = bdh::plan_pse(scene_of(cell, 3, 1.0, 1e-7));
  DeviceHarness whole(cell, x, plan);
  const std::vector<long> all = {0, 1, 2};
  const BruteNeighbors brute(cell, x, plan.r_cut, all);
  FullNeighbors full(brute.view(), 3, true);
  // Takes the pair (0, 1) out of the list and adds it as an extra pair.
  const bdh::NeighborView &half = brute.view();
  bool there = false;
  for (int k = 0; k < half.count[0]; ++k) there |= half.neighbors[0][k] == 1;
  ASSERT_TRUE(there);
  std::vector<std::vector<int>> rows(3);
  for (int p = 0; p < 3; ++p)
    for (int k = 0; k < full.view().count[p]; ++k) {
      const int j =
          full.view().neighbors[p * full.view().atom_stride + k * full.view().neighbor_stride];
      if (!((p == 0 && j == 1) || (p == 1 && j == 0))) rows[p].push_back(j);
    }
  std::size_t most = 1;
  for (const auto &r : rows) most = std::max(most, r.size());
  std::vector<int> list(3 * most), count(3);
  for (std::size_t p = 0; p < 3; ++p) {
    count[p] = rows[p].size();
    std::copy(rows[p].begin(), rows[p].end(), list.begin() + p * most);
  }
  bdh::DeviceNeighbors view = full.view();
  view.count = count.data();
  view.neighbors = list.data();
  view.atom_stride = most;
  view.neighbor_stride = 1;
  view.most = most;
  const std::vector<int> extra_begin = {0, 1, 2, 2}, extra = {1, 0};
  const auto M = bdh::make_device_pse<Exec>(plan, 200, {self()});
  M->set_cell(cell);
  M->set_viscosity(1.0);
  const std::vector<uint64_t> id = counted(3);
  Vector u(9), without(9);
  M->bind(everything(x, id, view));
  M->apply({f.data(), true}, without.data());
  view.extra_begin = extra_begin.data();
  view.extra = extra.data();
  view.most_extra = 1;
  M->bind(everything(x, id, view));
  M->apply({f.data(), true}, u.data());
  EXPECT_GT(relative_error(without, whole.apply(f, 1.0)), 1e-3);
  EXPECT_LT(relative_error(u, whole.apply(f, 1.0)), 1e-14);
}

TEST(DevicePse, LanczosThatDoesNotConvergeIsAnError)
{
  const Cell cell = cubic_cell(10.0);
  const Vector x = positions(cell, 40, 7);
  const PsePlan plan = bdh::plan_pse(scene_of(cell, 40, 1.0, 1e-7));
  const std::vector<long> all = [] {
    std::vector<long> v(40);
    std::iota(v.begin(), v.end(), 0L);
    return v;
  }();
  const BruteNeighbors brute(cell, x, plan.r_cut, all);
  const FullNeighbors full(brute.view(), 40, true);
  const auto M = bdh::make_device_pse<Exec>(plan, 3, {self()});
  M->set_cell(cell);
  M->set_viscosity(1.0);
  const std::vector<uint64_t> id = counted(40);
  M->bind(everything(x, id, full.view()));
  Vector u(120);
  EXPECT_THROW(M->fluctuate({}, {2.0, 1, 1}, u.data()), bdh::NotConverged);
}

namespace {

/// n spheres, some of which overlap, with radii from 0.25 to 1.
Spheres unequal_spheres(long n, Moments moments)
{
  const Cell cell = tilted_cell();
  Spheres s{
      cell, positions(cell, n, 3), {}, moments != Moments::none, moments == Moments::stresslet};
  for (long i = 0; i < n; ++i) s.radius.push_back(0.25 + 0.75 * i / (n - 1));
  return s;
}

DeviceHarness device_of(const Spheres &s, const PsePlan &plan)
{
  return DeviceHarness(s.cell, s.x, plan, SpreadBy::automatic, true, s.radius);
}

/// The greatest relative difference of velocities, angular velocities and rates of strain.
double difference(const Motions &u, const Motions &exact)
{
  EXPECT_EQ(u.angular.size(), exact.angular.size());
  EXPECT_EQ(u.strain.size(), exact.strain.size());
  double greatest = relative_error(u.linear, exact.linear);
  if (!exact.angular.empty())
    greatest = std::max(greatest, relative_error(u.angular, exact.angular));
  if (!exact.strain.empty()) greatest = std::max(greatest, relative_error(u.strain, exact.strain));
  return greatest;
}

Motions random_loads(long n)
{
  return {random_numbers(3 * n, 5), random_numbers(3 * n, 6),
          random_numbers(bdh::strain_numbers * n, 7)};
}

}    // namespace

// Spheres of any radii with forces, torques and stresslets, of one radius with torques, and of two
// radii: what loads do, and noise, in either precision.
TEST(DevicePse, SpheresMoveAsOnTheHost)
{
  const long n = 40;
  std::vector<Spheres> scenes;
  for (Moments moments : {Moments::none, Moments::torque, Moments::stresslet})
    scenes.push_back(unequal_spheres(n, moments));
  Spheres equal = unequal_spheres(n, Moments::torque), two = unequal_spheres(n, Moments::none);
  std::fill(equal.radius.begin(), equal.radius.end(), 1.0);
  for (double &a : two.radius) a = a < 0.8 ? 0.25 : 1.0;
  scenes.insert(scenes.end(), {equal, two});
  for (const Spheres &s : scenes)
    for (double tolerance : {1e-3, 1e-8}) {
      SCOPED_TRACE(std::to_string(&s - scenes.data()) + " at " + std::to_string(tolerance));
      const PsePlan plan = bdh::plan_pse(s.scene(tolerance));
      SphereHarness host(s, plan);
      DeviceHarness device = device_of(s, plan);
      const double bound = plan.single ? 2e-5 : 1e-11;
      const Motions load = random_loads(n);
      EXPECT_LE(difference(device.apply(load, 1.3), host.apply(load, 1.3)), bound);
      const PseNoise noise{2.0, 8, 9};
      EXPECT_LE(difference(device.random(noise, 1.3), host.random(noise, 1.3)), bound);
    }
}

// All blocks of the mobility of forces, torques and stresslets, one by one: a block that is wrong
// by itself could hide in a sum.
TEST(DevicePse, MatrixWithStressletsIsThatOfTheHost)
{
  const long n = 4;
  const Spheres s = unequal_spheres(n, Moments::stresslet);
  const PsePlan plan = bdh::plan_pse(s.scene(1e-8));
  SphereHarness host(s, plan);
  DeviceHarness device = device_of(s, plan);
  const Motions zero{Vector(3 * n, 0.0), Vector(3 * n, 0.0), Vector(bdh::strain_numbers * n, 0.0)};
  for (std::size_t k = 0; k < 11 * n; ++k) {
    Motions load = zero;
    Vector &v = k < 3 * n ? load.linear : k < 6 * n ? load.angular : load.strain;
    v[k < 3 * n ? k : k < 6 * n ? k - 3 * n : k - 6 * n] = 1.0;
    EXPECT_LE(difference(device.apply(load, 1.3), host.apply(load, 1.3)), 1e-11) << k;
  }
}

// Rigid spheres in a flow, of which some are held, and held spheres that turn or only move.  The
// residual of the constraint is so small that another number of iterations does not matter.
TEST(DevicePse, ConstrainedMotionIsThatOfTheHost)
{
  if (world().size() > 1) GTEST_SKIP() << "this harness solves constraints on one rank";
  const long n = 12;
  const Vector velocity = random_numbers(3 * n, 8);
  std::vector<char> held(n, 0);
  held[2] = held[7] = 1;
  for (Moments moments : {Moments::none, Moments::torque, Moments::stresslet}) {
    SCOPED_TRACE(int(moments));
    const Spheres s = unequal_spheres(n, moments);
    const PsePlan plan = bdh::plan_pse(s.scene(1e-8));
    SphereHarness host(s, plan);
    DeviceHarness device = device_of(s, plan);
    bdh::Constraint c;
    c.rigid = moments == Moments::stresslet;
    c.flow[0] = 0.7;
    c.flow[4] = -0.2;
    c.held = held.data();
    c.velocity = velocity.data();
    Motions load = random_loads(n), loads_there, loads_here;
    if (moments != Moments::stresslet) load.strain.clear();
    const Motions there = device.constrained(load, c, 1.3, 1e-11, loads_there),
                  here = host.constrained(load, c, 1.3, 1e-11, loads_here);
    EXPECT_GT(device.report.constraint_iterations, 3);
    EXPECT_EQ(device.report.constraint_iterations, host.report.constraint_iterations);
    EXPECT_LE(difference(there, here), 1e-9);
    EXPECT_LE(difference(loads_there, loads_here), 1e-9);
    for (int d = 0; d < 3; ++d) EXPECT_NEAR(there.linear[6 + d], velocity[6 + d], 1e-8);
  }
}
