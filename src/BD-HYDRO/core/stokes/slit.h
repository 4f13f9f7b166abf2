// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Fluctuating Stokes equations between two parallel walls or open faces: exact, without iteration.
#ifndef BDH_STOKES_SLIT_H
#define BDH_STOKES_SLIT_H

#include "grid/fft.h"
#include "stokes/slit_kernel.h"
#include "stokes/solver.h"

#include <memory>
#include <mutex>
#include <vector>

namespace bdh {

/// The parameters that all modes of a solve share.  Walls and open faces must be on the grid's slow
/// axis.
SlitChannel slit_channel(const Grid &grid, const StokesProblem &problem);

/// The slow axis ends at walls, each no-slip or free-slip, or at open faces with fluid without end
/// behind them; the other directions are periodic.
///
/// After Fourier transforms along the walls, every mode gets a banded Cholesky factorisation across
/// the channel (stokes/slit_kernel.h).  The same factor gives the random velocity from two complex
/// normals per mode and line (one in 2D).  Its covariance is that of a stochastic stress with
/// variance 2 on edges in a no-slip wall, 0 in a free-slip wall, and 1 elsewhere.
///
/// There is no mean pressure gradient: the walls carry the net force.  Between two free-slip walls
/// the mean velocity is zero.  With an open face and no no-slip wall, the common velocity of all
/// rows along the faces is a convention: see mean_term() and solve_unbounded_mean_flow().
///
/// Grid, transforms and random numbers are in Real.  The factorisation is in double whatever Real
/// is: its condition grows with the fourth power of the number of rows.
template <class Real> class SlitStokes : public StokesSolver<Real> {
 public:
  /// Collective.
  SlitStokes(const Grid &grid, const Comm &comm, const FftSetup &setup,
             const Workers &workers = Workers::one());
  ~SlitStokes() override;
  const GridParts &parts() const override { return fft_.parts(); }
  std::size_t allocation() const override { return fft_.allocation(); }
  SolveReport solve(const FieldOf<Real> &field, const StokesProblem &problem) override;
  std::size_t memory() const override;

 private:
  struct Work;
  template <int D> class Strip;

  template <int D> void solve_block(const SlitChannel &channel, const StokesProblem &problem,
                                    const ModeBlock<Real> &block, Work &work,
                                    WallVectors &wall_force) const;
  template <int D> static void solve_mean(const SlitChannel &channel, const StokesProblem &problem,
                                          std::array<std::vector<double>, D> &mode,
                                          WallVectors &wall_force);

  std::unique_ptr<Work> take_buffers();
  void give_back(std::unique_ptr<Work> work);

  Grid grid_;
  VectorFft<Real> fft_;
  std::vector<AxisSymbol> symbols_x_;    // of k_x = 0 .. n_x/2
  std::mutex mutex_;
  std::vector<std::unique_ptr<Work>> idle_;    // buffers that no worker is using
};

extern template class SlitStokes<float>;
extern template class SlitStokes<double>;

}    // namespace bdh
#endif
