/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Checks for displacements that are too long for one step.
#ifndef LMP_BDH_MOVE_JUDGE_H
#define LMP_BDH_MOVE_JUDGE_H

#include "pointers.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace LAMMPS_NS {

/// Stops the run or warns when particles move too far in one step, and keeps count.
class MoveJudge : protected Pointers {
 public:
  /// name: of the fix; describe(index): names the particle at that index of the core's arrays.
  MoveJudge(LAMMPS *lmp, const std::string &name, std::function<std::string(long)> describe) :
      Pointers(lmp), name_(name), describe_(std::move(describe))
  {}

  /// Displacements beyond `limit` [distance] are counted and reported; what: its name in messages.
  void set_limit(double limit, const char *what);
  double limit() const { return limit_; }
  /// Of the edges of the box that do not go along with the atoms [distance].
  double shortest_edge() const;

  /// Forgets the longest displacement at the beginning of a step.
  void begin_step() { longest_ = 0.0; }
  /// Takes the longest displacement on this rank [distance], the particle that made it (-1: none
  /// has moved), and the number of displacements longer than limit().
  void judge(double longest, long farthest, double long_moves);
  /// The same, from the displacements of all particles on this rank, 3 numbers each.
  void judge(const std::vector<double> &displacements);

  double longest() const { return longest_; }          ///< in the last step, on this rank
  double long_moves() const { return long_moves_; }    ///< since the beginning, on this rank

 private:
  void warn_of_lost_atoms(long index, double longest);

  const std::string name_;
  std::function<std::string(long)> describe_;
  double limit_ = 0.0, longest_ = 0.0, long_moves_ = 0.0;
  const char *limit_name_ = "";
  bool warned_long_ = false, warned_lost_ = false;
};

}    // namespace LAMMPS_NS
#endif
