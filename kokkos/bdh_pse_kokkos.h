/// Positively split Ewald on a device: velocities M F and random velocities of covariance 2 kT M/dt.     [PSE sec. II]
#ifndef BDH_PSE_KOKKOS_H
#define BDH_PSE_KOKKOS_H

#include "bdh_algebra_kokkos.h"
#include "bdh_lanczos.h"
#include "bdh_phases.h"
#include "bdh_pse.h"
#include "bdh_real_space_kokkos.h"
#include "bdh_step_kernel.h"
#include "bdh_wave_space_kokkos.h"

#include <cmath>
#include <memory>
#include <vector>

namespace bdh {

/// to (4 per particle) := from (3 per particle), by particle.
template <class Real> struct LoadVector {
  const double *from;
  Real *to;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < 3; ++c) to[4 * p + c] = static_cast<Real>(from[3 * p + c]);
    to[4 * p + 3] = Real(0);
  }
};
/// to (3) += factor * from (4), by particle.
template <class Real> struct AddVector {
  double factor;
  const Real *from;
  double *to;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < 3; ++c) to[3 * p + c] += factor * static_cast<double>(from[4 * p + c]);
  }
};
/// to (4) := three normals, by particle.
template <class Real> struct DrawVector {
  NoiseCounter counter;
  const uint64_t *id;
  Real *to;
  BDH_FN void operator()(long p) const
  {
    double z[4];
    normal4(counter, id[p], z[0], z[1], z[2], z[3]);
    for (int c = 0; c < 3; ++c) to[4 * p + c] = static_cast<Real>(z[c]);
    to[4 * p + 3] = Real(0);
  }
};

/// The mobility at fixed positions, as PseMobility; one process.  All pointers are those of the device, and nothing leaves
/// it but the sums of Lanczos.  Precision is hidden behind this interface: make() chooses by the plan.
class DevicePse {
 public:
  virtual ~DevicePse() = default;
  template <class Exec>
  static std::unique_ptr<DevicePse> make(const PsePlan &plan, int lanczos_limit, SpreadBy by = SpreadBy::automatic);

  virtual const PsePlan &plan() const = 0;
  /// The cell as it is now.  Makes a new grid, and returns true, when the old one is too coarse for it.
  virtual bool set_cell(const Cell &cell) = 0;
  /// Positions of the particles (3 n), and the neighbours as seen from the same positions; all are finite.
  virtual void bind(const double *x, long n, const DeviceNeighbors &neighbors) = 0;
  /// velocity (3 n) := M force
  virtual void apply(const double *force, double viscosity, double *velocity) = 0;
  /// velocity (3 n) := M force + noise; forces: false leaves the force out.
  virtual PseReport fluctuate(bool forces, const double *force, const PseNoise &noise, const uint64_t *id, double viscosity,
                              double *velocity) = 0;
  /// The parts of scheme split, as PseMobility: far() after bind(), near() after bind_near().
  virtual void far(bool forces, const double *force, const PseNoise &noise, double viscosity, double *velocity) = 0;
  virtual void bind_near(long n, const DeviceNeighbors &neighbors) = 0;
  virtual PseReport near(bool forces, const double *force, const PseNoise &noise, uint32_t stage, const uint64_t *id, double viscosity,
                         double *drift, double *random) = 0;

  virtual PseTimes times() const = 0;
  virtual double pairs() const = 0;
  virtual std::size_t grid_memory() const = 0;
  virtual std::size_t particle_memory() const = 0;
};

template <class Real, class Exec> class DevicePseOf : public DevicePse {
 public:
  DevicePseOf(const PsePlan &plan, int lanczos_limit, SpreadBy by) :
      plan_(plan), limit_(lanczos_limit), by_(by), wave_(std::make_unique<DeviceWaveSpace<Real, Exec>>(plan, by)),
      pairs_(plan.radius, plan.xi, plan.r_cut, plan.table_error)
  {
  }

  const PsePlan &plan() const override { return plan_; }

  bool set_cell(const Cell &cell) override
  {
    const bool too_coarse = !wave_->fits(cell);
    if (too_coarse) {
      plan_.n = roomier_grid(plan_, cell);
      wave_.reset();
      wave_ = std::make_unique<DeviceWaveSpace<Real, Exec>>(plan_, by_);
    }
    wave_->set_cell(cell);
    volume_ = cell.volume();
    return too_coarse;
  }

  void bind(const double *x, long n, const DeviceNeighbors &neighbors) override
  {
    wave_->bind(x, n);
    bind_near(n, neighbors);
  }

  void bind_near(long n, const DeviceNeighbors &neighbors) override
  {
    n_ = n;
    const Stopwatch watch(times_.pairs);
    const PhaseScope phase(Phase::pairs);
    pairs_.bind(neighbors, n);
    Exec().fence();
  }

  void apply(const double *force, double viscosity, double *velocity) override
  {
    wave_->apply(true, force, nullptr, viscosity, velocity);
    apply_pairs(force, viscosity, velocity);
  }

  PseReport fluctuate(bool forces, const double *force, const PseNoise &noise, const uint64_t *id, double viscosity,
                      double *velocity) override
  {
    wave_->apply(forces, force, &noise, viscosity, velocity);
    if (forces) apply_pairs(force, viscosity, velocity);
    return apply_root(noise, 0, id, viscosity, velocity);
  }

  void far(bool forces, const double *force, const PseNoise &noise, double viscosity, double *velocity) override
  {
    wave_->apply(forces, force, noise.kT_over_dt > 0.0 ? &noise : nullptr, viscosity, velocity);
  }

  PseReport near(bool forces, const double *force, const PseNoise &noise, uint32_t stage, const uint64_t *id, double viscosity,
                 double *drift, double *random) override
  {
    device_for<Exec>("bdh::clear", 3 * n_, Clear{drift});
    if (forces) apply_pairs(force, viscosity, drift);
    if (!(noise.kT_over_dt > 0.0)) return {};
    device_for<Exec>("bdh::clear", 3 * n_, Clear{random});
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
  using Vector = typename DeviceRealSpace<Real, Exec>::Vector;

  /// M_r as Lanczos sees it.
  struct PairsOperator {
    using Vector = typename DevicePseOf::Vector;
    const DeviceRealSpace<Real, Exec> &pairs;
    std::size_t size() const { return static_cast<std::size_t>(4 * pairs.particles()); }
    std::size_t full_size() const { return size(); }
    void apply(const Vector &v, Vector &u) const { pairs.apply(v, u); }
    double sum(double all) const { return all; }
  };

  /// velocity += M_r force
  void apply_pairs(const double *force, double viscosity, double *velocity)
  {
    const Stopwatch watch(times_.pairs);
    const PhaseScope phase(Phase::pairs);
    force_.resize(static_cast<std::size_t>(4 * n_));
    device_for<Exec>("bdh::load", n_, LoadVector<Real>{force, force_.data()});
    pairs_.apply(force_, product_);
    add(free_mobility(plan_.radius, viscosity), velocity);
  }
  /// velocity += sqrt(2 kT/dt) M_r^(1/2) z
  PseReport apply_root(const PseNoise &noise, uint32_t stage, const uint64_t *id, double viscosity, double *velocity)
  {
    const Stopwatch watch(times_.lanczos);
    const PhaseScope phase(Phase::lanczos);
    random_.resize(static_cast<std::size_t>(4 * n_));
    device_for<Exec>("bdh::draw", n_, DrawVector<Real>{{noise.seed, Stream::lanczos, noise.step, stage}, id, random_.data()});
    PairsOperator M{pairs_};
    const LanczosReport root = root_.apply(M, random_, root_options(plan_, volume_, limit_), product_);
    add(std::sqrt(2.0 * noise.kT_over_dt * free_mobility(plan_.radius, viscosity)), velocity);
    return {root.iterations, root.error / whole_noise(plan_, volume_)};
  }
  void add(double factor, double *velocity) const
  {
    device_for<Exec>("bdh::add", n_, AddVector<Real>{factor, product_.data(), velocity});
    Exec().fence();
  }

  PsePlan plan_;
  int limit_;
  SpreadBy by_;
  std::unique_ptr<DeviceWaveSpace<Real, Exec>> wave_;
  DeviceRealSpace<Real, Exec> pairs_;
  LanczosRoot<PairsOperator, DeviceAlgebra<Real, Exec>> root_;
  long n_ = 0;
  double volume_ = 1.0;
  Vector force_, product_, random_;
  PseTimes times_;
};

template <class Exec> std::unique_ptr<DevicePse> DevicePse::make(const PsePlan &plan, int lanczos_limit, SpreadBy by)
{
  if (plan.single) return std::make_unique<DevicePseOf<float, Exec>>(plan, lanczos_limit, by);
  return std::make_unique<DevicePseOf<double, Exec>>(plan, lanczos_limit, by);
}

}    // namespace bdh
#endif
