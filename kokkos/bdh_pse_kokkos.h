/// Positively split Ewald on a device: velocities M F and random velocities of covariance 2 kT M/dt.     [PSE sec. II]
#ifndef BDH_PSE_KOKKOS_H
#define BDH_PSE_KOKKOS_H

#include "bdh_lanczos.h"
#include "bdh_pse.h"
#include "bdh_real_space_kokkos.h"
#include "bdh_step_kernel.h"
#include "bdh_wave_space_kokkos.h"

#include <memory>
#include <vector>

namespace bdh {

/// w -= a v + b u
template <class Real> struct SubtractTwo {
  Real a;
  const Real *v;
  Real b;
  const Real *u;
  Real *w;
  BDH_FN void operator()(long i) const { w[i] -= a * v[i] + b * u[i]; }
};
template <class Real> struct Product {
  const Real *x, *y;
  BDH_FN void operator()(long i, double &sum) const { sum += static_cast<double>(x[i]) * static_cast<double>(y[i]); }
};
/// y := sum over m of f[m] x[m]
template <class Real> struct CombineAll {
  static constexpr int most = 8;
  int count;
  bool add;    ///< to what is there
  Real f[most];
  const Real *x[most];
  Real *y;
  BDH_FN void operator()(long i) const
  {
    Real sum = add ? y[i] : Real(0);
    for (int m = 0; m < count; ++m) sum += f[m] * x[m][i];
    y[i] = sum;
  }
};

/// What LanczosRoot does with vectors, on a device; sums come to the host.
template <class RealType, class Exec> struct DeviceAlgebra {
  using Real = RealType;
  double dot(const Real *x, const Real *y, std::size_t size) const
  {
    return device_sum<Exec>("bdh::dot", static_cast<long>(size), Product<Real>{x, y});
  }
  void scale(Real f, const Real *x, Real *y, std::size_t size) const
  {
    device_for<Exec>("bdh::scale", static_cast<long>(size), Scale<Real>{f, x, y});
  }
  void subtract(Real a, const Real *v, Real b, const Real *u, Real *w, std::size_t size) const
  {
    device_for<Exec>("bdh::subtract", static_cast<long>(size), SubtractTwo<Real>{a, v, b, u, w});
  }
  template <class Vector>
  void combine(const std::vector<double> &factor, const std::vector<Vector> &vector, Real *y, std::size_t size) const
  {
    for (std::size_t first = 0; first < factor.size(); first += CombineAll<Real>::most) {
      CombineAll<Real> c{0, first > 0, {}, {}, y};
      for (std::size_t m = first; m < factor.size() && c.count < CombineAll<Real>::most; ++m) {
        c.f[c.count] = static_cast<Real>(factor[m]);
        c.x[c.count++] = vector[m].data();
      }
      device_for<Exec>("bdh::combine_all", static_cast<long>(size), c);
    }
  }
};

/// The device's parts of the mobility, as HostPse; one process, and nothing but the sums of Lanczos leaves it.
template <class Exec> class DevicePse {
 public:
  using Neighbors = DeviceNeighbors;
  template <class Real> using Wave = DeviceWaveSpace<Real, Exec>;
  template <class Real> using Pairs = DeviceRealSpace<Real, Exec>;
  template <class Real> using Algebra = DeviceAlgebra<Real, Exec>;

  explicit DevicePse(SpreadBy by) : by_(by) {}

  template <class Real> std::unique_ptr<Wave<Real>> wave(const PsePlan &plan) const { return std::make_unique<Wave<Real>>(plan, by_); }
  template <class Real> Pairs<Real> pairs(const PsePlan &plan) const { return {plan.radius, plan.xi, plan.r_cut, plan.table_error}; }
  template <class Real> Algebra<Real> algebra() const { return {}; }

  template <class Action> void for_each(const char *name, long n, const Action &action) const { device_for<Exec>(name, n, action); }
  template <class Real> void fill_ghosts(Real *) const {}
  double sum(double all) const { return all; }
  void fence() const { Exec().fence(); }

 private:
  SpreadBy by_;
};

using DevicePseMobility = PseMobilityOf<DeviceNeighbors>;

/// In the plan's precision.  All pointers that the mobility gets are those of the device, and positions are finite.
template <class Exec>
std::unique_ptr<DevicePseMobility> make_device_pse(const PsePlan &plan, int lanczos_limit, SpreadBy by = SpreadBy::automatic)
{
  const DevicePse<Exec> parts(by);
  if (plan.single) return std::make_unique<PseMobilityOn<float, DevicePse<Exec>>>(plan, lanczos_limit, parts);
  return std::make_unique<PseMobilityOn<double, DevicePse<Exec>>>(plan, lanczos_limit, parts);
}

}    // namespace bdh
#endif
