/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The scene that a fix was set up for, asked at every step whether it is still the same.
#ifndef LMP_BDH_SCENE_H
#define LMP_BDH_SCENE_H

#include "grid/cell_kernel.h"
#include "lmptype.h"

#include <array>
#include <cmath>
#include <string>

namespace LAMMPS_NS {

/// What LAMMPS commands may change during a run: radii, number and integrators of the particles.
///
/// The group asks it for each of its atoms while it collects them, and the engine for their number
/// in a reduction that each step has anyway.
struct Scene {
  double radius = 0.0;                    ///< of every atom of the group; 0: may be any
  bigint fewest = 0, most = MAXBIGINT;    ///< particles of the group on all processors
  int other_integrators = 0;              ///< bits of their groups

  bool looks_at_radii() const { return radius > 0.0; }
  bool has_other_radius(double r) const { return !(std::fabs(r - radius) <= 3e-10 * radius); }
  bool has_room_for(bigint particles) const { return particles >= fewest && particles <= most; }
};

/// The scene is another one: nothing has been moved in this step yet.  Known to all processors
/// alike.
struct SceneChanged {};

/// The periodic cell as it is now.
bdh::Cell cell_now(const class Domain &domain);

/// Collective.  Least and greatest radius of the atoms of a group, infinity and -infinity without
/// any; the atom style must have radii.
std::array<double, 2> radius_range(const class LAMMPS &lmp, int groupbit);
/// Collective.  The least id of those with this radius.
tagint first_with_radius(const class LAMMPS &lmp, int groupbit, double radius);

/// Ends the run: another fix integrates an atom with this id and these bits of groups, which since
/// the beginning of the run belongs to both.  name: of our fix.
void refuse_other_integrator(class LAMMPS *lmp, const std::string &name, int others, tagint id,
                             int mask);

}    // namespace LAMMPS_NS
#endif
