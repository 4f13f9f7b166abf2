/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// What a fix with constraints puts out: numbers of its atoms, and its figures.
#ifndef LMP_BDH_CONSTRAINT_OUTPUT_H
#define LMP_BDH_CONSTRAINT_OUTPUT_H

#include "bdh_columns.h"
#include "bdh_given_motions.h"
#include "bdh_rheology.h"

#include <array>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/// Stresslets in Batchelor's sign, so that they add to the stress, angular velocities, and what the
/// fluid does to atoms that are held, in LAMMPS' units.
class ConstraintOutput : protected Pointers {
 public:
  /// Adds columns of the fix, and the figures of Rheology to its vector.  Call it before the
  /// columns are attached.
  ConstraintOutput(LAMMPS *lmp, class Fix &fix, AtomColumns &columns,
                   const bdh::MotionOptions &options);
  ~ConstraintOutput() noexcept override {}    // newer releases let that of Pointers throw

  /// At init.
  void announce();
  /// The flow in which the particles are.
  struct Flow {
    bdh::Symmetric<double> strain;       ///< rate of strain [1/time]
    std::array<double, 3> angular{};     ///< added to the angular velocities [1/time]
    double viscosity = 0.0, kT = 0.0;    ///< in the core's units
  };
  /// Keeps what the constraint of this step did to these atoms.
  void keep(const ConstrainedMotion &motion, const std::vector<int> &atoms,
            const std::vector<char> &held, const Flow &flow, int iterations);
  /// Collective.  Number n of the figures.
  double figure(int n) { return rheology_.figure(n); }

 private:
  AtomColumns &columns_;
  AtomColumns::Column rigid_,
      held_;    // rigid_: stresslet and angular velocity; held_: force, torque
  Rheology rheology_;
};

}    // namespace LAMMPS_NS
#endif
