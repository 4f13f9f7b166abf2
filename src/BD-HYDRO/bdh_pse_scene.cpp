/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_pse_scene.h"

#include "atom.h"
#include "bdh_conditions.h"
#include "bdh_lammps.h"
#include "bdh_lammps_classes.h"
#include "bdh_scene.h"
#include "domain.h"
#include "error.h"
#include "group.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

/// If the box changes size during the run, the plan may use only this share of the longest possible
/// cutoff.
static constexpr double room_to_shrink = 0.95;

bdh::Cell PseSceneReader::cell() const { return cell_now(*domain); }

bigint PseSceneReader::count() const
{
  sync_atoms(lmp, Host, MASK_MASK | RADIUS_MASK, EMPTY_MASK);
  return group->count(igroup_);
}

Radii PseSceneReader::radii(bigint particles) const
{
  if (options_.radius > 0.0) return Radii::all_equal(options_.radius);
  if (particles == 0) return {};
  const int bit = group->bitmask[igroup_];
  Radii radii = radii_of(*lmp, bit);
  if (!(radii.least > 0.0))
    error->all(FLERR,
               "{}: {} at step {}, but must be > 0 and finite: use set ... diameter, or give one "
               "radius for all as radius a",
               name_, worst_radius(*lmp, bit), update->ntimestep);
  return radii.equal() ? Radii::all_equal(radii.greatest) : radii;
}

/// The shortest of the longest cutoffs over all signs of the cell's tilts [distance]; 0: no limit.
double PseSceneReader::shortest_of_tilts(bdh::Cell cell) const
{
  double shortest = longest_cutoff(lmp, cell);
  for (int flips = 0; flips < 8; ++flips) {
    if (flips & 1) cell.xy = -cell.xy;
    if (flips & 2) cell.xz = -cell.xz;
    if (flips & 4) cell.yz = -cell.yz;
    shortest = MIN(shortest, longest_cutoff(lmp, cell));
  }
  return shortest;
}

bdh::PseScene PseSceneReader::scene_of(bigint particles, const Radii &radii) const
{
  bdh::Cell widest = cell();
  if (domain->box_change_shape) {    // the tilts between two flips
    widest.xy = MAX(std::fabs(widest.xy), 0.5 * widest.lx);
    widest.xz = MAX(std::fabs(widest.xz), 0.5 * widest.lx);
    widest.yz = MAX(std::fabs(widest.yz), 0.5 * widest.ly);
  }
  bdh::PseScene s;
  s.volume = widest.volume();
  for (int d = 0; d < 3; ++d) s.edge[d] = widest.edge(d);
  s.particles = std::max<bigint>(1, particles);
  s.radius = radii.greatest;
  s.least_radius = radii.least;
  s.mean_cube = radii.mean_cube;
  s.classes = radii.classes;
  s.rotation = orientations_.turn() || options_.stresslets;
  s.stresslets = options_.stresslets;
  s.noise = solvent_.may_be_hot();
  s.hydrodynamics = options_.hydrodynamics;
  s.tolerance = options_.tolerance;
  s.xi = options_.xi;
  s.substeps = options_.substeps;
  s.precision = options_.precision;
  s.largest_cutoff = shortest_of_tilts(widest);
  if (domain->box_change_size) s.largest_cutoff *= room_to_shrink;
  return s;
}

bdh::PseConditions PseSceneReader::conditions(double radius) const
{
  return conditions_now(lmp, group->bitmask[igroup_], radius, cell());
}

bool PseSceneReader::has_ghosts_up_to(double cutoff) const
{
  const double longest = longest_cutoff(lmp, cell());
  return !(longest > 0.0) || cutoff <= longest;
}
