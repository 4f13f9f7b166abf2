/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The scene that a fix was set up for.  Every step checks whether it still holds.
#ifndef LMP_BDH_SCENE_H
#define LMP_BDH_SCENE_H

#include "base/portable.h"
#include "base/strain_kernel.h"
#include "grid/cell_kernel.h"
#include "lmptype.h"
#include "pse/radii.h"

#include <array>
#include <cmath>
#include <string>

namespace LAMMPS_NS {

/// The radii that a plan was made for [distance].
struct PlannedRadii {
  double least = 0.0, greatest = 0.0;
  bool two = false;    ///< none between them

  BDH_FN bool have(double r) const
  {
    constexpr double about = 3e-10;
    const bool within = r >= (1.0 - about) * least && r <= (1.0 + about) * greatest;
    return within && !(two && r > (1.0 + about) * least && r < (1.0 - about) * greatest);
  }
};

/// Properties that LAMMPS commands may change during a run: radii, number and integrators of the
/// particles.
///
/// The group checks each of its atoms when it collects them.  The engine checks their number in a
/// reduction that each step has anyway.
struct Scene {
  PlannedRadii radii;                     ///< of the atoms of the group; greatest 0: any
  bigint fewest = 0, most = MAXBIGINT;    ///< particles of the group on all processors
  int other_integrators = 0;              ///< group bits of other integrators

  bool looks_at_radii() const { return radii.greatest > 0.0; }
  bool has_room_for(bigint particles) const { return particles >= fewest && particles <= most; }
};

/// Thrown when the scene has changed, on all processors alike, before anything has moved in this
/// step.
struct SceneChanged {};

/// The periodic cell as it is now.
bdh::Cell cell_now(const class Domain &domain);

/// The flow that deforms the box and carries particles along, u = (dH/dt) H^-1 x, where the columns
/// of H are the edges of the box: its gradient d u_a/d x_b, which is upper triangular [1/time].
struct BoxFlow {
  double xx = 0.0, yy = 0.0, zz = 0.0, yz = 0.0, xz = 0.0, xy = 0.0;

  /// The rate of strain.
  bdh::Symmetric<double> strain() const { return {xx, yy, zz, 0.5 * xy, 0.5 * xz, 0.5 * yz}; }
  /// The angular velocity of particles that turn with the flow.
  std::array<double, 3> half_curl() const { return {-0.5 * yz, 0.5 * xz, -0.5 * xy}; }
};
BoxFlow flow_now(const Domain &domain);

/// The radii of some particles [distance].
struct Radii {
  double least = 0.0, greatest = 0.0;
  double mean_cube = 0.0;        ///< [distance^3]
  bdh::RadiusClasses classes;    ///< unless they are equal

  static Radii all_equal(double a) { return {a, a, a * a * a, {}}; }
  bool any() const { return greatest > 0.0; }
  bool equal() const { return greatest - least <= 1e-10 * greatest; }
  /// True if both describe about the same radii.
  bool is_like(const Radii &o) const
  {
    return std::fabs(least - o.least) <= 1e-10 * least &&
           std::fabs(greatest - o.greatest) <= 1e-10 * greatest;
  }
};

/// Collective.  The radii of the atoms of a group, of which there is at least one.  The atom style
/// must have radii.
Radii radii_of(const class LAMMPS &lmp, int groupbit);
/// Collective.  Names the first atom whose radius is not positive and finite, as in "atom 3 has
/// radius 0".
std::string worst_radius(const class LAMMPS &lmp, int groupbit);

/// Stops the run because another fix integrates an atom with this id and these group bits.  Since
/// the beginning of the run the atom has come to belong to both fixes. name: of our fix.
void refuse_other_integrator(class LAMMPS *lmp, const std::string &name, int others, tagint id,
                             int mask);

}    // namespace LAMMPS_NS
#endif
