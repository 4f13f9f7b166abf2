/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// How stiff the forces are for the time step, seen in every step.
#ifndef LMP_BDH_STIFFNESS_H
#define LMP_BDH_STIFFNESS_H

#include "base/execution.h"
#include "base/stiffness.h"
#include "bdh_columns.h"
#include "bdh_group.h"
#include "pointers.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/// What a rank has seen of a step.
struct SeenStiffness {
  bdh::StepStiffness step;
  tagint atom = 0;    ///< the stiffest one
};

/// The forces at the beginning of a step, to compare with those at its end.
class ForceWatch {
 public:
  virtual ~ForceWatch() = default;
  /// Takes the forces on the group when the group has moved, before there are new ones: those at
  /// the beginning of the step, or of its last piece.
  virtual void keep() = 0;
  /// With the forces at the end of the step.  radii: the mobility is that of the atoms' radii.
  virtual SeenStiffness compare(const bdh::StiffnessScale &scale, bool radii) = 0;
};

/// In the memory of the host, by atom.
class HostForceWatch : public ForceWatch, protected Pointers {
 public:
  /// Adds a column.
  HostForceWatch(LAMMPS *lmp, int groupbit, const AtomGroup &group, AtomColumns &columns) :
      Pointers(lmp), groupbit_(groupbit), group_(group), columns_(columns),
      column_(columns.add(group.pieces() ? 7 : width))
  {}
  ~HostForceWatch() noexcept override {}    // newer releases let that of Pointers throw
  /// A force, and 1 if there is one; where steps are taken in pieces, followed by the velocity in
  /// the last piece.
  static constexpr int width = 4;
  void keep() override;
  SeenStiffness compare(const bdh::StiffnessScale &scale, bool radii) override;

 private:
  void keep_piece();

  int groupbit_;
  const AtomGroup &group_;
  AtomColumns &columns_;
  AtomColumns::Column column_;
  std::vector<double> before_, after_, velocity_, radius_;
  std::vector<int> local_;
};

/// By how much the variance of a distance is too large, relative to the exact one, for a harmonic
/// force of number p.
using ExcessOfVariance = double (*)(double p);
double excess_of_euler(double p);       ///< all schemes that take forces where a step begins
double excess_of_improved(double p);    ///< the improved midpoint scheme
double excess_of_split(double p);       ///< near steps of Leimkuhler and Matthews

/// Adds up what is seen in the steps of a run, reports it at the end, and warns once.
class StiffnessMonitor : protected Pointers {
 public:
  /// name: of the fix, for messages.
  StiffnessMonitor(LAMMPS *lmp, const std::string &name) : Pointers(lmp), name_(name) {}
  void set_scheme(ExcessOfVariance excess, int pieces)
  {
    excess_ = excess;
    pieces_ = pieces;
  }
  void set_pieces(bool yes) { in_pieces_ = yes; }    ///< steps are taken in pieces
  int pieces() const { return pieces_; }             ///< in which forces act in a step

  /// Forgets the run so far; the last step remains.
  void begin_run();
  /// Collective every hundred steps, when it may warn.
  void add(const SeenStiffness &seen);
  /// Collective.  The line at the end of a run; nothing if no force has changed.
  void show();
  /// Collective.  p of the last step: on average over contacts, and the largest.
  double mean() const;
  double largest() const;

 private:
  /// What counts of a number of steps.
  struct Sums {
    double reaction = 0.0, work = 0.0, largest = 0.0;
    double atom = 0.0, step = 0.0;    // of the largest
    void add(const SeenStiffness &seen, bigint step);
  };
  Sums over_ranks(const Sums &mine) const;
  std::string advice(double p) const;
  void warn();

  const std::string name_;
  ExcessOfVariance excess_ = excess_of_euler;
  int pieces_ = 1;
  Sums last_, lately_, run_;
  int steps_lately_ = 0;
  bool warned_ = false, in_pieces_ = false;
};

}    // namespace LAMMPS_NS
#endif
