/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// What a step in pieces keeps by atom from one piece to the next.
#ifndef LMP_BDH_PIECES_OF_STEP_H
#define LMP_BDH_PIECES_OF_STEP_H

#include "bdh_columns.h"
#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {

/// The forces at the beginning of a piece, and how far the earlier pieces have brought the atoms of
/// a group.  Vectors have 3 numbers for each atom of the group.
class PiecesOfStep : protected Pointers {
 public:
  PiecesOfStep(LAMMPS *lmp, AtomColumns &columns, bool turn);
  ~PiecesOfStep() noexcept override {}    // newer releases let that of Pointers throw

  /// A piece begins that lasts `part` of the step, with these forces.
  void begin(const std::vector<int> &group, const std::vector<double> &force, double part);
  /// Adds what a piece has done, with velocities over its own time.
  void add(const std::vector<int> &group, const std::vector<double> &velocity,
           const std::vector<double> &angular_velocity);
  /// Takes away what the last piece has added.
  void forget(const std::vector<int> &group);
  /// The forces at the beginning of the last piece, of the atoms that are here now.
  const std::vector<double> &force_before(const std::vector<int> &group);
  /// Velocity over the whole step whose last piece has this one; forgets the earlier pieces.
  std::vector<double> whole(const std::vector<int> &group, const std::vector<double> &velocity);
  std::vector<double> whole_turn(const std::vector<int> &group,
                                 const std::vector<double> &angular_velocity);
  /// Of the last piece of a step, over its own time.
  const std::vector<double> &last_velocity() const { return last_velocity_; }

 private:
  AtomColumns &columns_;
  AtomColumns::Column before_, moved_, turned_;    // forces before the piece, and the way so far
  AtomColumns::Column moved_before_, turned_before_;
  double part_ = 1.0;
  std::vector<double> force_before_, last_velocity_;
};

}    // namespace LAMMPS_NS
#endif
