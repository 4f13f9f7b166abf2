/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifndef LMP_FIX_BD_H
#define LMP_FIX_BD_H

#include "base/particles.h"
#include "base/phases.h"
#include "fix.h"
#include "input/options.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/// What all integrators of Brownian dynamics with hydrodynamic interactions share: temperature,
/// viscosity and seed, units, the particles of the group as the core sees them, checks at setup and
/// at every step, and the output.
///
/// A derived class builds its mobility in build() and takes one step in step().
class FixBD : public Fix {
 public:
  FixBD(class LAMMPS *, int, char **);
  ~FixBD() override;

  int setmask() override;
  void init() override;
  void setup(int) override;
  void initial_integrate(int) override;
  void post_run() override;
  double compute_scalar() override;
  double compute_vector(int) override;
  void *extract(const char *, int &) override;
  double memory_usage() override;

  void grow_arrays(int) override;
  void copy_arrays(int, int, int) override;
  int pack_exchange(int, double *) override;
  int unpack_exchange(int, double *) override;

 protected:
  class GroupParticles;
  friend class GroupParticles;

  /// Figures of the last step, in the order in which compute_vector() shows them.
  struct Figures {
    double solver_iterations = 0.0, lanczos_iterations = 0.0, error_estimate = 0.0;
    double radius = 0.0, spacing = 0.0, temperature = 0.0, viscosity = 0.0, long_moves = 0.0;
  };

  /// At init: refuses boxes, and changes of the box during the run, that the method cannot follow.
  virtual void check_box() const = 0;
  /// Collective, at init: the box is known.  Makes the mobility.
  virtual void build() = 0;
  /// Lines for screen and log file: what was chosen and why.  Shown whenever they differ from the
  /// last ones.
  virtual std::string plan_text() const = 0;
  /// Collective: one step.
  virtual void step(bdh::Particles &particles) = 0;
  /// Collective: looks at the atoms as they are, and takes a step with them.
  virtual void take_step();
  /// Displacement in one step beyond which the user is warned [distance], and its name in the
  /// message.
  virtual double longest_move() const = 0;
  virtual const char *longest_move_name() const = 0;
  /// Threads of the mobility.
  virtual const bdh::Workers &workers() const { return bdh::Workers::one(); }
  /// Bytes of the mobility on this rank.
  virtual double mobility_memory() const = 0;
  /// True if the scheme evaluates forces within the step.
  virtual bool uses_midpoint_forces() const = 0;
  /// Its name, and that of a scheme that does not, for messages.
  virtual const char *midpoint_scheme() const { return "improved"; }
  virtual const char *other_scheme() const { return "midpoint"; }
  /// Numbers per atom that go along when atoms migrate within a step.
  virtual int carried_columns() const { return uses_midpoint_forces() ? midpoint_columns : 0; }
  /// Background flow needs positions that are not wrapped.
  virtual bool uses_unwrapped_positions() const = 0;
  /// True if the mobility needs one, whether or not there is a pair style.
  virtual bool keeps_neighbor_list() const { return false; }

  /// Another way of evaluating forces within the step; in a derived class's constructor.
  void take_forces_from(std::unique_ptr<class MidpointForces> forces);
  /// Takes over the quantities that every style has; the last act of a derived class's constructor.
  void set_common(const bdh::Quantity &temperature, const bdh::Quantity &viscosity, uint32_t seed);
  /// Collective.  Least and greatest radius of the group's atoms, infinity and -infinity without
  /// any; the atom style must have radii.
  std::array<double, 2> radius_range() const;
  /// Positions and forces as they are now.
  bdh::Particles &gather_particles();
  /// Atoms of the particles of this step, in the core's order.
  const std::vector<int> &group_atoms() const;
  /// atom id and step, for messages about the particle at place `index` of the core's arrays.
  virtual std::string describe(long index) const;
  /// Of a step, on this rank: the longest displacement [distance], whose it is (-1: no particle has
  /// moved), and how many were longer than longest_move().  Stops or warns when they are too long.
  void judge_moves(double longest, long farthest, double long_moves);

  const std::string name_;    // style as the user wrote it, for messages: "fix bd/fib"
  bdh::Quantity temperature_, viscosity_;
  uint32_t seed_ = 0;
  double kT_ = 0.0;                // of this step, in mass length^2/time^2
  double core_viscosity_ = 0.0;    // of this step, in mass/(length time)
  Figures figures_;
  double **carried_ = nullptr;    // carried_columns() numbers per atom
  // The first ones, of schemes with forces within the step: displacement, and force and torque at
  // its beginning.
  static constexpr int midpoint_columns = 9;

 private:
  void refuse_second_integrator() const;
  void check_companions() const;
  void check_neighbor_settings() const;
  void watch_neighbor_builds();
  void watch_step_number();
  void judge_longest(long index, double longest);
  void warn_of_lost_atoms(long index, double longest);
  void save_start_of_step();
  void restore_start_of_step() const;
  double evaluate(const bdh::Quantity &quantity, const char *what) const;
  void update_quantities();
  bool is_silent_run() const;
  void show_times() const;
  std::string timing_line(int phase, double all) const;

  std::unique_ptr<GroupParticles> particles_;
  std::unique_ptr<class MidpointForces> midpoint_forces_;
  bool registered_ = false;    // for callbacks of LAMMPS
  std::string plan_;
  bdh::PhaseTimes times_{};    // of this run, on this rank
  double longest_ = 0.0;       // of the last step, on this rank [distance]
  bool built_ = false;         // build() has been called
  bool warned_long_move_ = false, warned_danger_ = false, warned_replay_ = false,
       warned_lost_ = false;
  bigint known_danger_ = 0, last_step_ = -1;
};

}    // namespace LAMMPS_NS
#endif
