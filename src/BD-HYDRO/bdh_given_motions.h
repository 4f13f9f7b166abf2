/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Motions that the user gives: of rigid spheres in a flow (keyword stresslet), and of atoms that
/// are held (keyword hold).
#ifndef LMP_BDH_GIVEN_MOTIONS_H
#define LMP_BDH_GIVEN_MOTIONS_H

#include "base/bytes_of.h"
#include "base/constraint_kernel.h"
#include "input/options.h"
#include "pointers.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/// Loads and motions of the particles of a step with constraints, on the host.
struct ConstrainedMotion {
  std::vector<double> force, torque, stresslet;    ///< unknown loads on the fluid
  std::vector<double> angular;                     ///< angular velocities
};

/// What a step with constraints leaves behind.
template <class Step> ConstrainedMotion motion_of(const Step &step)
{
  const auto &loads = step.loads();
  return {Step::to_host(loads.linear), Step::to_host(loads.angular), Step::to_host(loads.strain),
          Step::to_host(step.angular())};
}

/// Finds, in each step, which particles are held, how they move, and the flow's rate of strain.
class GivenMotions : protected Pointers {
 public:
  /// name: of the fix, for messages.
  GivenMotions(LAMMPS *lmp, const std::string &name, const bdh::MotionOptions &options) :
      Pointers(lmp), name_(name), options_(options)
  {}
  ~GivenMotions() noexcept override {}    // newer releases let that of Pointers throw

  /// Whether there are any.
  bool act() const { return options_.give_motions(); }
  /// At init: groups and the box.  Stops with an error for what cannot work.
  void check() const;
  /// At the beginning of a step: velocities, which may be variables, and the flow.
  void update();
  /// Of these atoms, in this order.
  void gather(const std::vector<int> &atoms);

  /// By particle, and one number more.  Empty on all processes if no group is held.
  const std::vector<char> &held() const { return held_; }
  const std::vector<double> &velocity() const { return velocity_; }
  /// The constraint, without its arrays.
  bdh::Constraint constraint() const { return constraint_; }
  /// Rate of strain of the flow that deforms the box.
  bdh::Symmetric<double> strain() const { return strain_; }
  /// For the plan: groups that are held, and what is done about the noise of loads.
  std::string text() const;
  std::string control_variate_text(double kT) const;

 private:
  double evaluate(const bdh::Quantity &quantity, const std::string &group) const;

  const std::string name_;
  const bdh::MotionOptions &options_;
  bdh::Constraint constraint_;
  bdh::Symmetric<double> strain_;
  std::vector<double> now_;    // velocities of the holds, 3 each
  std::vector<char> held_;
  std::vector<double> velocity_;
};

/// The constraint of a step, with its arrays where an execution has its own.
template <class Execution> class ConstraintOn {
 public:
  /// Finds which of these atoms are held, and how they move.  The result is valid until the next
  /// call.
  bdh::Constraint of(GivenMotions &given, const std::vector<int> &atoms)
  {
    given.gather(atoms);
    held_ = Execution::from_host(given.held());
    velocity_ = Execution::from_host(given.velocity());
    bdh::Constraint constraint = given.constraint();
    if (given.held().empty()) return constraint;
    constraint.held = held_.data();
    constraint.velocity = velocity_.data();
    return constraint;
  }
  std::size_t memory() const { return bdh::bytes_of(held_, velocity_); }

 private:
  typename Execution::Flags held_;
  typename Execution::ParticleVector velocity_;
};

}    // namespace LAMMPS_NS
#endif
