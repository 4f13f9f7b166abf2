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

#include "grid/cell_kernel.h"
#include "lmptype.h"

#include <array>
#include <cmath>
#include <string>

namespace LAMMPS_NS {

/// Properties that LAMMPS commands may change during a run: radii, number and integrators of the
/// particles.
///
/// The group checks each of its atoms when it collects them.  The engine checks their number in a
/// reduction that each step has anyway.
struct Scene {
  double radius = 0.0;                    ///< of every atom of the group; 0: any radius
  bigint fewest = 0, most = MAXBIGINT;    ///< particles of the group on all processors
  int other_integrators = 0;              ///< group bits of other integrators

  bool looks_at_radii() const { return radius > 0.0; }
  bool has_other_radius(double r) const { return !(std::fabs(r - radius) <= 3e-10 * radius); }
  bool has_room_for(bigint particles) const { return particles >= fewest && particles <= most; }
};

/// Thrown when the scene has changed, on all processors alike, before anything has moved in this
/// step.
struct SceneChanged {};

/// The periodic cell as it is now.
bdh::Cell cell_now(const class Domain &domain);

/// Collective.  Smallest and largest radius of the atoms of a group; infinity and -infinity if
/// there are none.  The atom style must have radii.
std::array<double, 2> radius_range(const class LAMMPS &lmp, int groupbit);
/// Collective.  The smallest id of the atoms with this radius.
tagint first_with_radius(const class LAMMPS &lmp, int groupbit, double radius);

/// Stops the run because another fix integrates an atom with this id and these group bits.  Since
/// the beginning of the run the atom has come to belong to both fixes. name: of our fix.
void refuse_other_integrator(class LAMMPS *lmp, const std::string &name, int others, tagint id,
                             int mask);

}    // namespace LAMMPS_NS
#endif
