/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_parts_output.h"

#include "fix.h"

using namespace LAMMPS_NS;

PartsOutput::PartsOutput(Fix &fix, AtomColumns &columns, bool turn) :
    columns_(columns), parts_(columns.add(turn ? 4 * bdh::dof : 2 * bdh::dof))
{
  fix.peratom_flag = fix.create_attribute = fix.peratom_freq = 1;
  fix.size_peratom_cols = parts_.width;
}

void PartsOutput::keep(const AtomGroup &group, const PseEngine &engine, double dt)
{
  const std::vector<int> &atoms = group.atoms();
  const bdh::PseVelocityParts parts = engine.parts();
  columns_.clear_all();    // atoms may have left the group
  columns_.set(parts_, 0, atoms, parts.by_forces, dt);
  columns_.set(parts_, bdh::dof, atoms, parts.by_noise, dt);
  if (!group.orientations().turn()) return;
  columns_.set(parts_, 2 * bdh::dof, atoms, parts.turned_by_forces, dt);
  columns_.set(parts_, 3 * bdh::dof, atoms, parts.turned_by_noise, dt);
}
