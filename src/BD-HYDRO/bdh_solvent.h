/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Temperature and viscosity of the solvent in a step.
#ifndef LMP_BDH_SOLVENT_H
#define LMP_BDH_SOLVENT_H

#include "input/words.h"
#include "pointers.h"

#include <cstdint>
#include <string>

namespace LAMMPS_NS {

/// A number that the user gave, or the value of the variable that stands for it.  `what` names it
/// in messages of the fix.
double evaluate_quantity(LAMMPS &lmp, const std::string &fix, const bdh::Quantity &quantity,
                         const std::string &what);

/// The solvent, which is the source of the noise, as the user describes it, in LAMMPS' units and in
/// those of the core.
class Solvent : protected Pointers {
 public:
  /// name: of the fix, for messages.
  Solvent(LAMMPS *lmp, const std::string &name) : Pointers(lmp), name_(name) {}
  /// seed: of the noise.
  void set(const bdh::Quantity &temperature, const bdh::Quantity &viscosity, uint32_t seed);

  /// Sets the values for this step.  Evaluates variables, which may call computes.
  void update();
  /// At init: the values from the last run are out of date.
  void expire() { expired_ = true; }
  /// The temperature imposed in this step [temperature], for computes, which may be called during
  /// setup before update() is.
  double imposed_temperature() const
  {
    return expired_ ? evaluate(temperature_, "temperature") : now_[0];
  }

  double kT() const { return kT_; }                  ///< [mass length^2/time^2]
  double viscosity() const { return viscosity_; }    ///< [mass/(length time)]
  uint32_t seed() const { return seed_; }
  double user_temperature() const { return now_[0]; }
  double user_viscosity() const { return now_[1]; }
  bool has_variables() const;
  /// False if the temperature is 0 throughout.
  bool may_be_hot() const { return temperature_.is_variable() || temperature_.value > 0.0; }
  /// A number by its name, or null.  Temperature, viscosity, and LAMMPS' names for a thermostat's
  /// temperature, t_start and t_stop, are available unless they are variables.  t_target always is;
  /// for a variable it is the value of the last step.
  double *find(const char *name);
  /// Sets the temperature, which must not be a variable [temperature], for replica exchange.
  void reset_temperature(double T);

 private:
  double evaluate(const bdh::Quantity &quantity, const char *what) const;

  const std::string name_;
  bdh::Quantity temperature_, viscosity_user_;
  uint32_t seed_ = 0;
  double kT_ = 0.0, viscosity_ = 0.0;
  double now_[2] = {0.0, 0.0};    // temperature and viscosity in LAMMPS' units
  bool expired_ = true;
};

}    // namespace LAMMPS_NS
#endif
