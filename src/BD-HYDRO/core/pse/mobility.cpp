// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/mobility.h"

#include "base/portable.h"
#include "pse/free_mobility.h"

namespace bdh {

namespace {

/// The host's parts of the mobility, for one kind of particles.
template <template <class> class Kind, template <class> class NumbersOf> class HostPse {
 public:
  using Neighbors = NeighborView;
  template <class Real> using Wave = WaveSpace<Real>;
  template <class Real> using Pairs = RealSpace<Real, Kind<Real>>;
  template <class Real> using Numbers = NumbersOf<Real>;
  using Execution = HostExecution;
  /// Whether strains by stresslets can be had alone.
  static constexpr bool have_strains = Kind<double>::have_strains;

  explicit HostPse(const PseHost &host) : host_(host), execution_(host.workers) {}

  /// Collective.
  template <class Real> std::unique_ptr<WaveSpace<Real>> wave(const PsePlan &plan) const
  {
    return std::make_unique<WaveSpace<Real>>(plan, host_.comm, host_.setup, host_.workers);
  }
  template <class Real> std::unique_ptr<Pairs<Real>> pairs(const PsePlan &plan) const
  {
    return std::make_unique<Pairs<Real>>(plan, host_.workers);
  }
  const HostExecution &execution() const { return execution_; }
  /// Collective.  Fills in the entries of other ranks' particles, which follow those of the owned.
  template <class Real> void fill_ghosts(Real *v, int quads, long /*owned*/, long /*all*/) const
  {
    if (host_.comm.size() > 1) host_.exchange->forward(v, quads);
  }
  /// Collective.  The sum over the ranks.
  double sum(double mine) const { return host_.comm.sum(mine); }

 private:
  PseHost host_;
  HostExecution execution_;
};

template <class Real> using Movers = SizedSpheres<Real, Moments::none>;
template <class Real> using Spinners = SizedSpheres<Real, Moments::torque>;
template <class Real> using MoverNumbers = SizedNumbers<Real, false>;
template <class Real> using SpinnerNumbers = SizedNumbers<Real, true>;

template <class Parts> std::unique_ptr<HostPseMobility>
make_split(const PsePlan &plan, int lanczos_limit, const PseHost &host)
{
  const Parts parts(host);
  if (plan.single) return std::make_unique<SplitEwald<float, Parts>>(plan, lanczos_limit, parts);
  return std::make_unique<SplitEwald<double, Parts>>(plan, lanczos_limit, parts);
}

}    // namespace

std::array<long, 3> roomier_grid(const PsePlan &plan, const Cell &cell)
{
  return pse_grid(plan, {1.05 * cell.edge(0), 1.05 * cell.edge(1), 1.05 * cell.edge(2)});
}

std::unique_ptr<HostPseMobility> make_pse(const PsePlan &plan, int lanczos_limit,
                                          const PseHost &host)
{
  if (!plan.hydrodynamics)
    return std::make_unique<FreeMobility<HostExecution, NeighborView>>(plan,
                                                                       HostExecution(host.workers));
  if (plan.is_plain())
    return make_split<HostPse<EqualSpheres, EqualNumbers>>(plan, lanczos_limit, host);
  if (plan.stresslets)
    return make_split<HostPse<StrainingSpheres, StrainNumbers>>(plan, lanczos_limit, host);
  if (plan.rotation)
    return make_split<HostPse<Spinners, SpinnerNumbers>>(plan, lanczos_limit, host);
  return make_split<HostPse<Movers, MoverNumbers>>(plan, lanczos_limit, host);
}

}    // namespace bdh
