// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// The counters of messages, bytes and sums are what MPI is asked to send, exactly, and the
// hand-overs of a grid are those of the scaling model.

#include "support/mpi_traffic.h"

#include "fib/confined.h"
#include "fib/host.h"
#include "fib/step.h"
#include "pse/pse_support.h"

#include <fstream>
#include <sstream>

namespace {

using namespace bdh;
using namespace bdh_test;
using Fluid = FibFluid<FibOnHost>;

/// Particles dealt to the ranks, under no forces.  Nothing is sent for them.
class FreeParticles : public ParticlesOf<FibOnHost::ParticleVector> {
 public:
  using Vector = FibOnHost::ParticleVector;
  explicit FreeParticles(const std::vector<double> &all)
  {
    const Deal deal(all.size() / 3, world());
    x_ = deal.take(all);
    force_.assign(x_.size(), 0.0);
    for (long i : deal.mine) id_.push_back(i);
  }
  long size() const override { return bdh::ssize(id_); }
  const double *x() const override { return x_.data(); }
  const double *force() const override { return force_.data(); }
  const uint64_t *ids() const override { return id_.data(); }
  void move_and_update_forces(Vector &displacement, Vector *) override { move(displacement); }
  void finish(const Vector &displacement, const Vector &) override { move(displacement); }

 private:
  void move(const Vector &displacement)
  {
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] += displacement[i];
  }
  std::vector<double> x_, force_;
  std::vector<uint64_t> id_;
};

StepPlan plan_of(Scheme scheme)
{
  StepPlan plan;
  plan.scheme = scheme;
  plan.dt = 1e-3;
  plan.kT = 0.3;
  plan.crossing = Crossing::redraw;
  return plan;
}

/// Ghosts of other ranks, which a test fills in without sending anything that counts.
class UncountedGhosts : public BruteExchange {
 public:
  using BruteExchange::BruteExchange;
  void forward(float *v, int quads) override { fill(v, quads); }
  void forward(double *v, int quads) override { fill(v, quads); }

 private:
  template <class Real> void fill(Real *v, int quads)
  {
    seen_by_mpi().paused = true;
    BruteExchange::forward(v, quads);
    seen_by_mpi().paused = false;
  }
};

/// A mobility of particles dealt to the ranks, bound to them.
class Mobility {
 public:
  Mobility(const Cell &cell, const std::vector<double> &x, const PsePlan &plan,
           const FftSetup &setup = FftEffort::estimate) :
      deal_(x.size() / 3, world()),
      ghosts_(world(), x.size() / 3, deal_.mine), neighbors_(cell, x, plan.r_cut, deal_.mine),
      x_(deal_.take(x)), u_(x_.size() + 1), M_(make_pse(plan, 200, {world(), setup, &ghosts_}))
  {
    ghosts_.use(neighbors_.foreign());
    for (long i : deal_.mine) id_.push_back(i + 1);
    M_->set_cell(cell);
    M_->set_viscosity(1.0);
  }
  void bind()
  {
    M_->bind(
        {bdh::ssize(id_), x_.data(), id_.data(), neighbors_.view(), neighbors_.all(), nullptr});
  }
  /// Velocities and noise by forces as large as the positions.
  PseReport fluctuate() { return M_->fluctuate({x_.data(), true}, {2.0, 3, 4}, u_.data()); }

 private:
  Deal deal_;
  UncountedGhosts ghosts_;
  BruteNeighbors neighbors_;
  std::vector<double> x_, u_;
  std::vector<uint64_t> id_;
  std::unique_ptr<HostPseMobility> M_;
};

/// Numbers of a line of unittest/reference/traffic.csv.
struct HandOvers {
  std::string fix;
  std::array<long, 3> n;
  double kept;               // radius of the sphere of modes, in indices; 0: all modes
  int ranks, share, rank;    // share: ranks that share each slab
  int64_t messages, bytes;
};

/// Those for this rank.
std::vector<HandOvers> predicted()
{
  std::ifstream in(std::string(BDH_REFERENCE_DIR) + "/traffic.csv");
  std::vector<HandOvers> all;
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    HandOvers h;
    words >> h.fix >> h.n[0] >> h.n[1] >> h.n[2] >> h.kept >> h.ranks >> h.share >> h.rank >>
        h.messages >> h.bytes;
    if (h.ranks == world().size() && h.rank == world().rank()) all.push_back(h);
  }
  return all;
}

}    // namespace

TEST(Traffic, StepsOfFib)
{
  const Grid cube = make_grid({12, 10, 8}, {1.0});
  for (const Grid &g : {cube, make_grid({16, 12}, {1.0}), with_walls(cube, {"p", "p", "nn"}),
                        with_walls(cube, {"p", "p", "no"}), with_walls(cube, {"nn", "nn", "sn"}),
                        make_grid({12, 8, 3}, {1.0})}) {
    Fluid fluid(g, IbKernel::roma3, FftEffort::estimate, world());
    for (Scheme scheme : {Scheme::midpoint, Scheme::improved, Scheme::trapezoidal}) {
      FreeParticles p(random_positions(g, 30, 3, 0.4));
      BrownianStep<FibOnHost> step(fluid);
      const Traffic sent = sent_by(wall_names(g) + " " + scheme_name(scheme),
                                   [&] { step.take(p, plan_of(scheme)); });
      EXPECT_GT(sent.messages, 0);
      EXPECT_GT(sent.bytes, 4 * sent.messages);
      EXPECT_EQ(sent.sums > 0, g.walled_axes() > 0) << wall_names(g);    // on crossings
    }
  }
}

TEST(Traffic, MobilityOfPse)
{
  const Cell cell = cubic_cell(18.0);
  for (double tolerance : {1e-3, 1e-8}) {
    const long n = 90;
    std::vector<double> x = random_numbers(3 * n, 12);
    for (double &c : x) c *= 7.0;
    Mobility M(cell, x, bdh::plan_pse(scene_of(cell, n, 1.0, tolerance)));
    PseReport report;
    const Traffic sent = sent_by("tolerance " + std::to_string(tolerance), [&] {
      M.bind();
      report = M.fluctuate();
    });
    EXPECT_GT(sent.messages, 0);
    // The length of the random vector, and two products in each iteration.
    EXPECT_EQ(sent.sums, 1 + 2 * report.iterations);
  }
}

// Without particles a step sends nothing but the hand-overs, and that there are no particles.
TEST(Traffic, HandOversAreThoseOfTheScalingModel)
{
  // Where particles are dealt to parts of the grid, each rank tells each other one an int, here
  // that it gets none: twice in a step of bd/fib, once in one of bd/pse.
  const int64_t others = world().size() - 1;
  int cases[2] = {0, 0};
  for (const HandOvers &h : predicted()) {
    Traffic sent;
    const std::string what = h.fix + " " + std::to_string(h.n[0]) + " " + std::to_string(h.n[1]) +
                             " " + std::to_string(h.n[2]) + " share " + std::to_string(h.share);
    const FftSetup setup(FftEffort::estimate, h.share);
    if (h.fix == "fib") {
      Fluid fluid(make_grid({h.n[0], h.n[1], h.n[2]}, {1.0}), IbKernel::peskin4, setup, world());
      FreeParticles none({});
      BrownianStep<FibOnHost> step(fluid);
      sent = sent_by(what, [&] { step.take(none, plan_of(Scheme::midpoint)); });
    } else {
      const Cell cell = cubic_cell(20.0);
      PsePlan plan = bdh::plan_pse(scene_of(cell, 100, 1.0, 1e-3));
      ASSERT_TRUE(plan.single);
      plan.n = h.n;
      plan.k_cut = two_pi * h.kept / cell.lx;
      plan.spacing = cell.lx / *std::min_element(h.n.begin(), h.n.end());
      Mobility M(cell, {}, plan, setup);
      sent = sent_by(what, [&] {
        M.bind();
        M.fluctuate();
      });
    }
    ++cases[h.fix == "pse"];
    const int64_t deals = (h.fix == "fib" ? 2 : 1) * others;
    EXPECT_EQ(sent.messages - deals, h.messages) << what;
    EXPECT_EQ(sent.bytes - 4 * deals, h.bytes) << what;
  }
  EXPECT_GE(cases[0], 8);
  EXPECT_GE(cases[1], 8);
}
