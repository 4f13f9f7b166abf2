#include "bdh_pse.h"

#include "bdh_rng_kernel.h"

#include <algorithm>
#include <cmath>

namespace bdh {

namespace {

/// M_r as Lanczos sees it.
template <class Real> class RealSpaceOperator {
 public:
  using Vector = typename RealSpace<Real>::Vector;
  RealSpaceOperator(const RealSpace<Real> &pairs, const Comm &comm, GhostExchange *exchange) :
      pairs_(pairs), comm_(comm), exchange_(exchange)
  {
  }
  std::size_t size() const { return static_cast<std::size_t>(4 * pairs_.owned()); }
  std::size_t full_size() const { return static_cast<std::size_t>(4 * pairs_.all()); }
  void apply(Vector &v, Vector &u)
  {
    if (comm_.size() > 1) exchange_->forward(v.data());
    pairs_.apply(v, u);
  }
  double sum(double mine) const { return comm_.sum(mine); }

 private:
  const RealSpace<Real> &pairs_;
  const Comm &comm_;
  GhostExchange *exchange_;
};

template <class Real> class Mobility : public PseMobility {
 public:
  Mobility(const PsePlan &plan, const Comm &comm, FftEffort effort, int lanczos_limit, GhostExchange *exchange,
           const Workers &workers) :
      workers_(workers), plan_(plan), comm_(comm), effort_(effort), limit_(lanczos_limit), exchange_(exchange),
      wave_(std::make_unique<WaveSpace<Real>>(plan, comm, effort, workers)),
      pairs_(plan.radius, plan.xi, plan.r_cut, plan.table_error, workers), root_(HostAlgebra<Real>(workers))
  {
  }

  const PsePlan &plan() const override { return plan_; }

  bool set_cell(const Cell &cell) override
  {
    const bool too_coarse = !wave_->fits(cell);
    if (too_coarse) {
      plan_.n = roomier_grid(plan_, cell);
      wave_.reset();
      wave_ = std::make_unique<WaveSpace<Real>>(plan_, comm_, effort_, workers_);
    }
    wave_->set_cell(cell);
    volume_ = cell.volume();
    return too_coarse;
  }

  void bind(const double *x, long n, const NeighborView &neighbors, long all) override
  {
    neighbors_ = neighbors;
    owned_ = n;
    all_ = all;
    wave_->bind(x, n);
  }

  void apply(const double *force, double viscosity, double *velocity) override
  {
    wave_->apply(true, force, nullptr, viscosity, velocity);
    const Stopwatch watch(times_.pairs);
    const PhaseScope phase(Phase::pairs);
    load(force);
    pairs_.bind_and_apply(neighbors_, owned_, all_, force_, product_);
    add(product_, self_mobility(viscosity), velocity);
  }

  PseReport fluctuate(bool forces, const double *force, const PseNoise &noise, const std::vector<uint64_t> &id, double viscosity,
                      double *velocity) override
  {
    wave_->apply(forces, force, &noise, viscosity, velocity);
    apply_pairs(forces, force, viscosity, velocity);
    return apply_root(noise, 0, id, viscosity, velocity);
  }

  void far(bool forces, const double *force, const PseNoise &noise, double viscosity, double *velocity) override
  {
    wave_->apply(forces, force, noise.kT_over_dt > 0.0 ? &noise : nullptr, viscosity, velocity);
  }

  void bind_near(long n, const NeighborView &neighbors, long all) override
  {
    neighbors_ = neighbors;
    owned_ = n;
    all_ = all;
  }

  PseReport near(bool forces, const double *force, const PseNoise &noise, uint32_t stage, const std::vector<uint64_t> &id,
                 double viscosity, double *drift, double *random) override
  {
    std::fill_n(drift, 3 * owned_, 0.0);
    apply_pairs(forces, force, viscosity, drift);
    if (!(noise.kT_over_dt > 0.0)) return {};    // random is null on a rank without particles
    std::fill_n(random, 3 * owned_, 0.0);
    return apply_root({0.5, noise.seed, noise.step}, stage, id, viscosity, random);
  }

  PseTimes times() const override
  {
    PseTimes t = wave_->times();
    t.pairs = times_.pairs;
    t.lanczos = times_.lanczos;
    return t;
  }
  double pairs() const override { return pairs_.pairs(); }
  std::size_t grid_memory() const override { return wave_->grid_memory(); }
  std::size_t particle_memory() const override
  {
    return wave_->particle_memory() + pairs_.memory() + root_.memory() +
        (force_.capacity() + product_.capacity() + random_.capacity()) * sizeof(Real);
  }

 private:
  using Vector = typename RealSpace<Real>::Vector;

  /// Keeps the pairs for Lanczos; velocity += M_r force.
  void apply_pairs(bool forces, const double *force, double viscosity, double *velocity)
  {
    const Stopwatch watch(times_.pairs);
    const PhaseScope phase(Phase::pairs);
    pairs_.bind(neighbors_, owned_, all_);
    if (!forces) return;
    load(force);
    pairs_.apply(force_, product_);
    add(product_, self_mobility(viscosity), velocity);
  }

  /// velocity += sqrt(2 kT/dt) M_r^(1/2) z
  PseReport apply_root(const PseNoise &noise, uint32_t stage, const std::vector<uint64_t> &id, double viscosity, double *velocity)
  {
    const Stopwatch watch(times_.lanczos);
    const PhaseScope phase(Phase::lanczos);
    draw(noise, stage, id);
    RealSpaceOperator<Real> M(pairs_, comm_, exchange_);
    const LanczosReport root = root_.apply(M, random_, root_options(plan_, volume_, limit_), product_);
    add(product_, std::sqrt(2.0 * noise.kT_over_dt * self_mobility(viscosity)), velocity);
    return {root.iterations, root.error / whole_noise(plan_, volume_)};
  }

  double self_mobility(double viscosity) const { return free_mobility(plan_.radius, viscosity); }

  /// force_ := force, with ghosts
  void load(const double *force)
  {
    force_.resize(static_cast<std::size_t>(4 * all_));
    workers_.for_ranges(owned_, [&](long begin, long end) {
      for (long i = begin; i < end; ++i) {
        for (int c = 0; c < 3; ++c) force_[4 * i + c] = static_cast<Real>(force[3 * i + c]);
        force_[4 * i + 3] = Real(0);
      }
    });
    if (comm_.size() > 1) exchange_->forward(force_.data());
  }

  void draw(const PseNoise &noise, uint32_t stage, const std::vector<uint64_t> &id)
  {
    random_.resize(static_cast<std::size_t>(4 * owned_));
    const NoiseCounter counter{noise.seed, Stream::lanczos, noise.step, stage};
    workers_.for_ranges(owned_, [&](long begin, long end) {
      BDH_INDEPENDENT
      for (long i = begin; i < end; ++i) {
        double z[4];
        normal4(counter, id[i], z[0], z[1], z[2], z[3]);
        for (int c = 0; c < 3; ++c) random_[4 * i + c] = static_cast<Real>(z[c]);
        random_[4 * i + 3] = Real(0);
      }
    });
  }

  void add(const Vector &from, double factor, double *velocity) const
  {
    workers_.for_ranges(owned_, [&](long begin, long end) {
      for (long i = begin; i < end; ++i)
        for (int c = 0; c < 3; ++c) velocity[3 * i + c] += factor * static_cast<double>(from[4 * i + c]);
    });
  }

  const Workers &workers_;
  PsePlan plan_;
  Comm comm_;
  FftEffort effort_;
  int limit_;
  GhostExchange *exchange_;
  std::unique_ptr<WaveSpace<Real>> wave_;
  RealSpace<Real> pairs_;
  LanczosRoot<RealSpaceOperator<Real>> root_;
  NeighborView neighbors_;
  long owned_ = 0, all_ = 0;
  double volume_ = 1.0;
  Vector force_, product_, random_;
  PseTimes times_;
};

}    // namespace

std::array<long, 3> roomier_grid(const PsePlan &plan, const Cell &cell)
{
  return pse_grid(plan, {1.05 * cell.edge(0), 1.05 * cell.edge(1), 1.05 * cell.edge(2)});
}

double whole_noise(const PsePlan &plan, double volume) { return std::sqrt(periodic_self_mobility(plan.radius, volume)); }

LanczosOptions root_options(const PsePlan &plan, double volume, int limit)
{
  return {0.7 * plan.root_tolerance * whole_noise(plan, volume), limit, plan.tolerance};
}

std::unique_ptr<PseMobility> PseMobility::make(const PsePlan &plan, const Comm &comm, FftEffort effort,
                                               int lanczos_limit, GhostExchange *exchange, const Workers &workers)
{
  if (plan.single) return std::make_unique<Mobility<float>>(plan, comm, effort, lanczos_limit, exchange, workers);
  return std::make_unique<Mobility<double>>(plan, comm, effort, lanczos_limit, exchange, workers);
}

}    // namespace bdh
