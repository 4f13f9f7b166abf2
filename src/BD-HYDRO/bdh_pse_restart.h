/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// What fix bd/pse keeps in restart files.
#ifndef LMP_BDH_PSE_RESTART_H
#define LMP_BDH_PSE_RESTART_H

#include "pse/plan.h"

#include <vector>

namespace LAMMPS_NS {

/// The plan, and what else is known about it.
struct PseRestart {
  bdh::PsePlan plan;
  bdh::PseScene made_for;
  double split_price = 0.0;
  bool narrow = false;    ///< the neighbor list of a run ruled out a better plan
};

/// The bytes of all numbers, one after the other.  Equal values give equal bytes, since the padding
/// of structures is left out.
std::vector<char> bytes_of(const PseRestart &restart);
/// False, and `restart` is unchanged, if the bytes do not represent a valid plan of this version.
bool from_bytes(const char *bytes, std::size_t size, PseRestart &restart);

}    // namespace LAMMPS_NS
#endif
