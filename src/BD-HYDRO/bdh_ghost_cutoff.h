/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// How far LAMMPS keeps ghosts for the neighbor list of a fix.
#ifndef LMP_BDH_GHOST_CUTOFF_H
#define LMP_BDH_GHOST_CUTOFF_H

#include "pointers.h"

#include <string>

namespace LAMMPS_NS {

/// Raises the distance that comm_modify cutoff sets, and takes back only what it has raised.
class GhostCutoff : protected Pointers {
 public:
  explicit GhostCutoff(LAMMPS *lmp) : Pointers(lmp) {}

  /// At init: ghosts are kept at least this far [distance].
  void reach(double cutoff);
  /// During a run: this far is enough from now on, unless another fix may rely on these ghosts.
  void shorten(double cutoff);
  /// A line for the plan if no other part of the input needs ghosts this far away, else empty.
  const std::string &note() const { return note_; }

 private:
  bool is_own() const;

  double others_ = 0.0;    // of comm_modify, before this object set it
  double own_ = 0.0;       // that it has set instead; 0: none
  std::string note_;
};

}    // namespace LAMMPS_NS
#endif
