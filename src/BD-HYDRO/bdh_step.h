/// Time steps of Brownian dynamics with the fluctuating immersed boundary method.          [FIB sec. IV]
///
///     dq = M F dt + kT (div M) dt + sqrt(2 kT) M^(1/2) dW
///
/// Written once for every backend, as sequences of spread, solve and interpolate.
#ifndef BDH_STEP_H
#define BDH_STEP_H

#include "bdh_errors.h"
#include "bdh_fib.h"
#include "bdh_moving_walls.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace bdh {

enum class Scheme { midpoint, improved, euler, trapezoidal };
enum class Drift { no, exact, finite_difference };

/// What happens when a step would take a particle over a wall.  error: BadParticle.  reflect: its end is mirrored at the
/// wall.  redraw: the whole step is taken again with other random numbers (not with the improved scheme).
enum class Crossing { error, reflect, redraw };

/// Throw InvalidOption for an unknown name.
Scheme scheme_from_name(const std::string &name);
const char *scheme_name(Scheme scheme);

/// The particles as the steps see them.  All arrays have 3 size() entries, x, y, z interleaved.
class Particles {
 public:
  virtual ~Particles() = default;
  virtual long size() const = 0;
  /// Unwrapped: a shear flow needs y, not its periodic image.
  virtual const double *x() const = 0;
  virtual const double *force() const = 0;
  /// Identity of particle i, the same on every rank and in every run.
  virtual uint64_t id(long i) const = 0;
  /// Collective.  x += displacement, then force := at the new x.  Particles may change rank and order; displacement
  /// goes with them (resized).
  virtual void move_and_update_forces(std::vector<double> &displacement) = 0;
  /// x += displacement: the end of the step.  velocity is (total displacement of the step)/dt.
  virtual void finish(const std::vector<double> &displacement, const std::vector<double> &velocity) = 0;
};

/// Throws BadParticle for a force that is not a finite number.
inline void check_finite_forces(const Particles &p)
{
  const double *f = p.force();
  for (long i = 0; i < 3 * p.size(); ++i)
    if (!std::isfinite(f[i]))
      throw BadParticle(i / 3, "the force on it is not a finite number: atoms may overlap, or a fix adds such a force");
}

/// What one step needs to know.  Units: any consistent set.
struct StepPlan {
  Scheme scheme = Scheme::midpoint;
  Drift drift = Drift::exact;
  bool corrector = true;      ///< midpoint only: false takes J at the beginning of the step (exact without noise and flow)
  double dt = 0.0;            ///< [time]
  double kT = 0.0;            ///< [energy]; 0: no noise, no drift
  double viscosity = 1.0;     ///< [mass/(length time)]
  double shear_rate = 0.0;    ///< background flow u = rate y e_x [1/time]
  WallMotion walls;           ///< walls that move
  std::array<double, 3> body_force{0.0, 0.0, 0.0};    ///< on the fluid [force/volume]
  double tolerance = 1e-8;    ///< relative residual of a solver that iterates
  Crossing crossing = Crossing::error;
  double delta = 1e-6;        ///< step of the random finite difference, in units of h
  uint32_t seed = 0;
  uint64_t step = 0;
};

/// One time step for any backend.
template <class Backend> class BrownianStep {
 public:
  explicit BrownianStep(FibFluid<Backend> &fluid) : fluid_(fluid) {}

  /// Collective.  Throws BadParticle when a position or a force is not a finite number.
  void take(Particles &particles, const StepPlan &plan)
  {
    plan_ = plan;
    attempt_ = 0;
    if (plan.scheme == Scheme::improved)
      improved(particles);
    else
      while (!one_solve(particles)) next_attempt(particles);
  }

  /// Particles that were mirrored at a wall, and steps that were taken again because of one, on this rank.
  double crossings() const { return crossings_; }

  std::size_t memory() const { return (u_.capacity() + v_.capacity() + x_.capacity() + w_.capacity()) * sizeof(double); }

 private:
  /// (33)-(35), (43), (44): one solve at q^n, then one or two interpolations.  False, and nothing has moved, if a
  /// particle would cross a wall and the step is to be drawn again.
  bool one_solve(Particles &p)
  {
    const std::size_t size = 3 * static_cast<std::size_t>(p.size());
    resize(size);
    fluid_.bind(p.x(), p.size());
    fluid_.clear();
    spread_forces(p, plan_.drift == Drift::exact);
    if (plan_.drift == Drift::finite_difference) {
      spread_finite_difference(p, p.x());
      fluid_.bind(p.x(), p.size());
    }
    fluid_.solve(problem({{1.0, 0}}));
    particle_velocity(p.x(), u_);
    if (plan_.scheme == Scheme::trapezoidal) {
      positions_after(p.x(), plan_.dt);
      if (!confine(p, x_)) return false;
      second_velocity(p);
      for (std::size_t i = 0; i < size; ++i) u_[i] = 0.5 * (u_[i] + v_[i]);
    } else if (plan_.scheme == Scheme::midpoint && plan_.corrector) {
      positions_after(p.x(), 0.5 * plan_.dt);
      if (!confine(p, x_)) return false;
      second_velocity(p);
      u_.swap(v_);
    }
    w_.resize(size);
    positions_after(p.x(), plan_.dt);
    if (!confine(p, x_)) return false;
    // The difference of positions would add their roundings to the displacement, so only walls may change it.
    for (std::size_t i = 0; i < size; ++i) w_[i] = mirrored_[i] ? x_[i] - p.x()[i] : plan_.dt * u_[i];
    p.finish(w_, u_);
    return true;
  }

  /// (38): a solve at q^n predicts q^(n+1/2), where forces and a second solve are taken.  With the exact derivative the
  /// thermal drift goes along with the forces at q^(n+1/2), which the paper finds as accurate as q^n.
  void improved(Particles &p)
  {
    const double root2 = std::sqrt(2.0);
    resize(3 * static_cast<std::size_t>(p.size()));
    fluid_.bind(p.x(), p.size());
    fluid_.clear();
    spread_forces(p, false);
    fluid_.solve(problem({{root2, 0}}));
    particle_velocity(p.x(), u_);
    std::vector<double> half_step(u_);
    for (double &d : half_step) d *= 0.5 * plan_.dt;
    confine_displacement(p, half_step);
    p.move_and_update_forces(half_step);

    const std::size_t size = 3 * static_cast<std::size_t>(p.size());
    resize(size);
    fluid_.clear();
    if (plan_.drift == Drift::finite_difference) {
      for (std::size_t i = 0; i < size; ++i) x_[i] = p.x()[i] - half_step[i];
      spread_finite_difference(p, x_.data());
    }
    fluid_.bind(p.x(), p.size());
    spread_forces(p, plan_.drift == Drift::exact);
    fluid_.solve(problem({{1.0 / root2, 0}, {1.0 / root2, 1}}));
    particle_velocity(p.x(), u_);
    for (std::size_t i = 0; i < size; ++i) half_step[i] = plan_.dt * u_[i] - half_step[i];
    confine_displacement(p, half_step);
    p.finish(half_step, u_);
  }

  /// Takes positions x that a step leads to back between the walls, as the plan says.  Collective when the plan
  /// says redraw: false on all ranks if any particle is outside.
  bool confine(const Particles &p, std::vector<double> &x)
  {
    mirrored_.assign(x.size(), 0);
    const Grid &g = fluid_.grid();
    if (g.walled_axes() == 0) return true;
    if (plan_.crossing == Crossing::redraw) return !fluid_.any(first_outside(p, x) >= 0);
    for (long i = 0; i < p.size(); ++i)
      for (int d = 0; d < g.dim && plan_.crossing == Crossing::reflect; ++d) mirror(g, d, x[3 * i + d], 3 * i + d);
    if (first_outside(p, x) >= 0) check_positions(g, x.data(), p.size());
    return true;
  }

  void mirror(const Grid &g, int d, double &x, long place)
  {
    const double lo = g.lo[d], hi = lo + g.length[d];
    if (!g.walled(d) || (x >= lo && x <= hi)) return;
    x = x < lo ? 2.0 * lo - x : 2.0 * hi - x;
    mirrored_[static_cast<std::size_t>(place)] = 1;
    crossings_ += 1.0;
  }

  long first_outside(const Particles &p, const std::vector<double> &x) const
  {
    const Grid &g = fluid_.grid();
    for (long i = 0; i < p.size(); ++i)
      for (int d = 0; d < g.dim; ++d)
        if (g.walled(d) && !(x[3 * i + d] >= g.lo[d] && x[3 * i + d] <= g.lo[d] + g.length[d])) return i;
    return -1;
  }

  void confine_displacement(const Particles &p, std::vector<double> &displacement)
  {
    x_.resize(displacement.size());
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] = p.x()[i] + displacement[i];
    confine(p, x_);
    for (std::size_t i = 0; i < x_.size(); ++i)
      if (mirrored_[i]) displacement[i] = x_[i] - p.x()[i];
  }

  /// Collective.  After so many tries the time step is too long for redrawing to be a small correction.
  void next_attempt(const Particles &p)
  {
    constexpr uint32_t most = 20;
    crossings_ += 1.0;
    if (++attempt_ <= most) return;
    const long i = first_outside(p, x_);    // none here: another rank has it, and stops the run
    if (i >= 0) throw BadParticle(i, "it would cross a wall in each of 20 attempts: use a smaller timestep");
  }

  void resize(std::size_t size)
  {
    u_.resize(size);
    v_.resize(size);
    x_.resize(size);
  }

  StokesProblem problem(std::vector<StressDraw> stress) const
  {
    StokesProblem s;
    s.viscosity = plan_.viscosity;
    s.kT_over_dt = plan_.kT / plan_.dt;
    s.seed = plan_.seed;
    s.step = plan_.step;
    s.body_force = plan_.body_force;
    s.wall_velocity = plan_.walls.left_to_solver();
    s.tolerance = plan_.tolerance;
    for (StressDraw &draw : stress) draw.stage += stages * attempt_;
    if (plan_.kT > 0.0) s.stress = std::move(stress);
    return s;
  }

  void spread_forces(const Particles &p, bool drift)
  {
    check_finite_forces(p);
    fluid_.spread(p.force(), drift ? plan_.kT : 0.0);
  }

  /// f += kT/delta [S(q + delta/2 W) - S(q - delta/2 W)] W, eq. (33) second line.  Leaves the fluid bound elsewhere.
  void spread_finite_difference(const Particles &p, const double *q)
  {
    const long n = p.size();
    const double h = fluid_.grid().h(0), delta = plan_.delta * h, strength = plan_.kT / delta;
    const NoiseCounter counter{plan_.seed, Stream::finite_difference, plan_.step, 0};
    std::vector<double> shifted(3 * static_cast<std::size_t>(n));
    w_.resize(shifted.size());
    for (long i = 0; i < n; ++i) {
      double spare;
      normal4(counter, p.id(i), w_[3 * i], w_[3 * i + 1], w_[3 * i + 2], spare);
    }
    for (const double sign : {1.0, -1.0}) {
      for (std::size_t k = 0; k < shifted.size(); ++k) shifted[k] = q[k] + sign * 0.5 * delta * w_[k];
      fluid_.bind(shifted.data(), n, 1.0);    // it may step over a wall, where the kernel's formula still holds
      for (std::size_t k = 0; k < shifted.size(); ++k) shifted[k] = sign * strength * w_[k];
      fluid_.spread(shifted.data(), 0.0);
    }
  }

  /// u := J v + background flow at q (which J leaves as it is: the kernels are symmetric) + motion of the walls.
  void particle_velocity(const double *q, std::vector<double> &u)
  {
    fluid_.interpolate(u.data());
    if (plan_.shear_rate != 0.0)
      for (std::size_t i = 0; i < u.size(); i += 3) u[i] += plan_.shear_rate * q[i + 1];
    plan_.walls.add(q, static_cast<long>(u.size() / 3), u.data());
  }

  void positions_after(const double *q, double time)
  {
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] = q[i] + time * u_[i];
  }

  /// v_ := velocity at x_ in the fluid velocity of this step.
  void second_velocity(const Particles &p)
  {
    fluid_.bind(x_.data(), p.size());
    particle_velocity(x_.data(), v_);
  }

  FibFluid<Backend> &fluid_;
  StepPlan plan_;
  std::vector<double> u_, v_, x_, w_;
  std::vector<char> mirrored_;      // of the positions of the last confine()
  static constexpr uint32_t stages = 4;    // draws of one attempt
  uint32_t attempt_ = 0;
  double crossings_ = 0.0;
};

}    // namespace bdh
#endif
