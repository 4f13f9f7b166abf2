// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The wave-space part of positively split Ewald: M_w F and M_w^(1/2) dW in one set of transforms.
///
///     M_w = S^T F^-1 B F S,   B(k) = sinc^2(ka) H(k) (I - k k^T/k^2) / (eta V k^2 w^(k)^2)
///
/// S spreads with the window, whose transform w^ is divided out exactly; F is the discrete Fourier
/// transform.  See PSE (9), (19)-(21).  Spheres of several radii spread two fields, one for each
/// shape function (pse/shapes_kernel.h), which one velocity for each term of the weight answers.
#ifndef BDH_PSE_WAVE_SPACE_H
#define BDH_PSE_WAVE_SPACE_H

#include "base/aligned.h"
#include "base/comm.h"
#include "base/phases.h"
#include "grid/cell_kernel.h"
#include "grid/fft.h"
#include "grid/grid.h"
#include "grid/slabs.h"
#include "pse/particles.h"
#include "pse/plan.h"
#include "pse/sphere_loads.h"
#include "pse/sphere_spread.h"
#include "pse/wave_kernel.h"

#include <array>
#include <memory>
#include <mutex>
#include <vector>

namespace bdh {

/// 1/w^ of the indices 0 .. (n - 1)/2 of an axis of n points.
std::vector<double> inverse_window(const Window &window, long n);
/// True if the plan's grid resolves the modes inside k_cut of this cell.
bool grid_fits(const PsePlan &plan, const Cell &cell);

/// The modes of one y that are kept, in rows of z = -most .. most.  Empty until it is needed.
template <class Real> struct WaveTable {
  std::vector<std::array<long, 2>> kept;    ///< x of the first one in a row, and behind the last
  /// Roots of WaveWeight over w^, in columns of x = 0 .. most: of each shape, and of both in the
  /// second term.
  AlignedArray<Real> root[3];
};

/// Real: precision of the grid, its transforms and the weights.
template <class Real> class WaveSpace {
 public:
  /// Collective.  The grid is plan.n.
  WaveSpace(const PsePlan &plan, const Comm &comm, const FftSetup &setup,
            const Workers &workers = Workers::one());

  /// The cell as it is now; the plan's grid must be fine enough for it (fits()).  Cheap if nothing
  /// has changed.
  void set_cell(const Cell &cell);
  bool fits(const Cell &cell) const { return grid_fits(plan_, cell); }
  /// The radii of this plan from now on.  The grid and its transforms stay.
  void set_radii(const PsePlan &plan);

  /// Collective.  Positions are any periodic images.  Throws BadParticle.
  template <class Neighbors> void bind(const PseParticles<Neighbors> &particles)
  {
    radius_ = particles.radius;
    bind(particles.x, particles.count);
  }
  /// Collective.  velocity := M_w forces + its noise.
  void apply(const PseForces &forces, const PseNoise &noise, double viscosity,
             const PseVelocities &velocity);
  /// Collective.  velocity.strain := that of M_w forces, where stresslets alone act; the rest of
  /// `velocity` is arbitrary.  Equal spheres do this with the first shape alone.
  void apply_stresslets(const PseForces &forces, double viscosity, const PseVelocities &velocity);

  std::size_t grid_memory() const;
  std::size_t particle_memory() const;

 private:
  struct Modes;

  void bind(const double *x, long n);
  std::array<Real *, dim> view();
  std::array<Real *, 2 * dim> fields();
  /// shapes: how many are used.
  void spread(const double *loads, int shapes);
  void transform(const PseForces &forces, const PseNoise &noise, double viscosity, int shapes);
  void interpolate(const double *loads, const PseVelocities &velocity, int shapes);
  void keep_columns();
  void fill_table(long y);
  long signed_index(long i, int d) const { return bdh::signed_index(i, grid_.n[d]); }

  PsePlan plan_;
  Comm comm_;
  const Workers &workers_;
  Grid grid_;    // in fractional coordinates
  Cell cell_;
  bool has_cell_ = false;
  std::array<long, dim> most_;    // largest |index| that the grid can take
  bool plain_;                    // equal spheres that translate alone
  int shapes_;                    // functions, and fields
  int terms_;                     // of WaveWeight
  VectorFft<Real> fft_;
  SphereSpreader<Real> spreader_;
  ParticleExchange positions_, exchange_;        // the second one carries loads and motions
  AlignedArray<Real> field_[2 * dim];            // of the shapes
  std::vector<double> deconvolution_[dim];       // 1/w^ by |index|
  std::vector<WaveTable<Real>> table_;           // by y
  std::unique_ptr<std::mutex[]> table_mutex_;    // by y: two workers may need the same one
  std::vector<double> fractional_;
  const double *radius_ = nullptr;
  SphereLoads loads_;
};

extern template class WaveSpace<float>;
extern template class WaveSpace<double>;

}    // namespace bdh
#endif
