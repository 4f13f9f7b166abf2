/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The stress of a suspension with constraints, and the force on what is held.
#ifndef LMP_BDH_RHEOLOGY_H
#define LMP_BDH_RHEOLOGY_H

#include "base/strain_kernel.h"
#include "pointers.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/// What constraints bring to a fix's vector.  Stresses are those of the particles, in LAMMPS' units
/// of pressure, positive for tension, and add to 2 viscosity times the rate of strain:
///
///     hydrodynamic   -(1/V) sum of S, with its Brownian part; S is what a sphere does to the fluid
///     interparticle  minus the virial part of the pressure, -(1/V) sum of x F
///     ideal          -n kT
class Rheology : protected Pointers {
 public:
  /// Numbers in the vector: iterations, two tensors xx yy zz xy xz yz, the ideal stress, the
  /// relative viscosity, and the force of the fluid on all that is held.
  static constexpr int figures = 1 + 6 + 6 + 1 + 1 + 3;

  /// Adds a compute of the virial if there are stresslets.
  Rheology(LAMMPS *lmp, const std::string &fix, bool stresslets);
  ~Rheology() override;
  Rheology(const Rheology &) = delete;
  Rheology &operator=(const Rheology &) = delete;

  /// At init, and in every step: the virial will be asked for at the next forces.
  void announce(bigint step);

  /// What a step found, of this rank's particles.
  struct Found {
    int iterations = 0;
    bdh::Symmetric<double> stresslets;            ///< sum, in the core's units
    double force_on_held[3] = {0.0, 0.0, 0.0};    ///< likewise
    bdh::Symmetric<double> strain;                ///< of the flow [1/time]
    double viscosity = 0.0, kT = 0.0;             ///< in the core's units
    double particles = 0.0;                       ///< on this rank
  };
  void set(const Found &found) { found_ = found; }
  /// Collective.  Number n of the vector.
  double figure(int n);

 private:
  class Compute *virial() const;
  double volume() const;
  double sum(double mine) const;
  /// Component n of a tensor.
  double hydrodynamic(int n) const;
  double interparticle(int n);
  double relative_viscosity();

  std::string virial_;
  Found found_;
};

}    // namespace LAMMPS_NS
#endif
