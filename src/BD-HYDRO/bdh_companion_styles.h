/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// How LAMMPS' styles treat velocities, forces and boxes, as far as it matters here.
#ifndef LMP_BDH_COMPANION_STYLES_H
#define LMP_BDH_COMPANION_STYLES_H

#include <string>

namespace LAMMPS_NS {

class Fix;
class Force;

/// Something that a style does and that means something else, or nothing, without inertia.  Used in
/// messages of the form "fix ID STYLE <deed>: <effect>, so <remedy>".
struct Deed {
  const char *style;    ///< name; its variants (name/...) do the same
  const char *deed, *effect, *remedy;
};

/// What a fix does with velocities; null if nothing, or nothing that matters.
const Deed *deed_of(const Fix &fix);
/// What a pair style, or a part of pair style hybrid, does with velocities or noise.  `which`
/// counts these deeds from 0; null if there are no more.
const Deed *deed_of_pair(Force &force, int which);
/// True if the fix changes velocities only as a by-product of a legitimate change of positions.
bool may_change_velocities(const Fix &fix);

/// Where a fix is meant to hold atoms by removing forces, for messages: "where they are", "at their
/// z", "in a plane".  Empty if it holds none.
std::string holds_atoms(const Fix &fix);

/// Bit of the group whose atoms a fix carries along when it changes the box; 0 if it carries all
/// atoms, or does not change the box.
int carried_group(const Fix &fix);

}    // namespace LAMMPS_NS
#endif
