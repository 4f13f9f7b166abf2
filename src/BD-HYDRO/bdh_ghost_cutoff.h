/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The distance up to which LAMMPS keeps ghosts for the neighbor list of a fix.
#ifndef LMP_BDH_GHOST_CUTOFF_H
#define LMP_BDH_GHOST_CUTOFF_H

#include "pointers.h"

#include <string>

namespace LAMMPS_NS {

/// Raises the distance set by comm_modify cutoff, and later undoes only what it has raised itself.
class GhostCutoff : protected Pointers {
 public:
  explicit GhostCutoff(LAMMPS *lmp) : Pointers(lmp) {}
  /// Undoes it, unless another fix may rely on it.
  ~GhostCutoff() noexcept override;

  /// At init.  Makes LAMMPS keep ghosts at least this far [distance].
  void reach(double cutoff);
  /// During a run.  From now on ghosts up to `cutoff` suffice, unless another fix may rely on more.
  void shorten(double cutoff);
  /// A line for the plan if nothing else in the input needs ghosts this far away, else empty.
  const std::string &note() const { return note_; }

 private:
  bool is_own() const;
  bool may_lower() const;

  double others_ = 0.0;    // the value before this object changed it
  double own_ = 0.0;       // the value that it set instead; 0: none
  std::string note_;
};

}    // namespace LAMMPS_NS
#endif
