/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// What a plan of fix bd/pse is made for: the present particles and box of LAMMPS.
#ifndef LMP_BDH_PSE_SCENE_H
#define LMP_BDH_PSE_SCENE_H

#include "bdh_orientation.h"
#include "bdh_scene.h"
#include "bdh_solvent.h"
#include "grid/cell_kernel.h"
#include "input/options.h"
#include "pointers.h"
#include "pse/plan.h"

#include <string>

namespace LAMMPS_NS {

/// Determines the scene that a plan is made for.
class PseSceneReader : protected Pointers {
 public:
  /// name: of the fix, for messages; igroup: its group.
  PseSceneReader(LAMMPS *lmp, const std::string &name, int igroup, const bdh::PseOptions &options,
                 const Solvent &solvent, const Orientations &orientations) :
      Pointers(lmp),
      name_(name), igroup_(igroup), options_(options), solvent_(solvent),
      orientations_(orientations)
  {}

  /// Collective.  The number of particles in the group.
  bigint count() const;
  /// Collective.  The radii of all particles, as given by the user or by the atoms; none if there
  /// are no particles.
  Radii radii(bigint particles) const;
  /// The scene with this number of particles of these radii, in the present box.
  bdh::PseScene scene_of(bigint particles, const Radii &radii) const;
  /// Collective.  How crowded the particles are at present, and what limits a plan.
  bdh::PseConditions conditions(double radius) const;
  bdh::Cell cell() const;
  /// True if LAMMPS keeps ghosts up to this cutoff in the present box.
  bool has_ghosts_up_to(double cutoff) const;

 private:
  double shortest_of_tilts(bdh::Cell cell) const;

  const std::string name_;
  int igroup_;
  const bdh::PseOptions &options_;
  const Solvent &solvent_;
  const Orientations &orientations_;
};

}    // namespace LAMMPS_NS
#endif
