/// Positively split Ewald: velocities M F and random velocities of covariance 2 kT M/dt.   [PSE sec. II]
///
///     M = M_r + M_w,   M^(1/2) dW = M_r^(1/2) dW_1 + M_w^(1/2) dW_2                        (14), (18)
#ifndef BDH_PSE_H
#define BDH_PSE_H

#include "bdh_comm.h"
#include "bdh_fft.h"
#include "bdh_lanczos.h"
#include "bdh_pse_plan.h"
#include "bdh_real_space.h"
#include "bdh_step.h"
#include "bdh_wave_space.h"

#include <memory>
#include <vector>

namespace bdh {

/// What one evaluation did.
struct PseReport {
  int iterations = 0;            ///< of Lanczos; 0 without noise
  double root_error = 0.0;       ///< estimated error of the noise by Lanczos, relative to the whole noise
};

/// The plan's grid with some room for this cell, so that a box that grows or leans does not ask for a new one at every step.
std::array<long, 3> roomier_grid(const PsePlan &plan, const Cell &cell);
/// The whole noise of a particle has variance (2 kT/dt) M_ii: what errors are to be small beside, in units of
/// sqrt((2 kT/dt)/(6 pi viscosity a)).
double whole_noise(const PsePlan &plan, double volume);
LanczosOptions root_options(const PsePlan &plan, double volume, int limit);

/// The mobility at fixed positions.  Precision is hidden behind this interface: make() chooses by the plan.
class PseMobility {
 public:
  /// Collective.  exchange is used when the run has several ranks, and must outlive the mobility.
  static std::unique_ptr<PseMobility> make(const PsePlan &plan, const Comm &comm, FftEffort effort, int lanczos_limit,
                                           GhostExchange *exchange, const Workers &workers = Workers::one());
  virtual ~PseMobility() = default;

  virtual const PsePlan &plan() const = 0;
  /// Collective.  The cell as it is now.  Makes a new grid, and returns true, when the old one is too coarse for it.
  virtual bool set_cell(const Cell &cell) = 0;

  /// Collective.  Positions of the particles (3 n), and the neighbours as seen from the same positions; `all` counts
  /// those of other ranks too.
  virtual void bind(const double *x, long n, const NeighborView &neighbors, long all) = 0;
  /// Collective.  velocity (3 n) := M force.
  virtual void apply(const double *force, double viscosity, double *velocity) = 0;
  /// Collective.  velocity (3 n) := M force + noise; forces: false (on all ranks) leaves the force out.  The noise of
  /// particle i in real space is a function of id[i], noise.seed and noise.step.
  virtual PseReport fluctuate(bool forces, const double *force, const PseNoise &noise, const std::vector<uint64_t> &id, double viscosity,
                              double *velocity) = 0;

  /// Collective.  The far part alone, after bind(): velocity (3 n) := M_w force + noise, if kT_over_dt > 0.
  virtual void far(bool forces, const double *force, const PseNoise &noise, double viscosity, double *velocity) = 0;
  /// As bind(), for near() alone.
  virtual void bind_near(long n, const NeighborView &neighbors, long all) = 0;
  /// Collective.  The near part alone: drift (3 n) := M_r force, or 0 without forces, and random (3 n) := M_r^(1/2) z
  /// in units of the mobility's root, if kT_over_dt > 0.  z is a function of id, seed, step and stage.
  virtual PseReport near(bool forces, const double *force, const PseNoise &noise, uint32_t stage, const std::vector<uint64_t> &id,
                         double viscosity, double *drift, double *random) = 0;

  virtual PseTimes times() const = 0;                 ///< spent since it was made
  virtual double pairs() const = 0;                   ///< kept by the last evaluation with noise, on this rank
  virtual std::size_t grid_memory() const = 0;        ///< bytes on this rank
  virtual std::size_t particle_memory() const = 0;
};

}    // namespace bdh
#endif
