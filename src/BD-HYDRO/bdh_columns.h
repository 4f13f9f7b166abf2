/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Numbers that a fix keeps for each atom.
#ifndef LMP_BDH_COLUMNS_H
#define LMP_BDH_COLUMNS_H

#include "pointers.h"

namespace LAMMPS_NS {

/// Numbers per atom in named columns, which go along when atoms change their place or processor.
///
/// LAMMPS calls the fix, and the fix calls grow(), copy(), pack() and unpack() here.
class AtomColumns : protected Pointers {
 public:
  /// Consecutive numbers of an atom; width 0: not kept.
  struct Column {
    int first = 0, width = 0;
  };
  /// Keeps the newest values somewhere else, such as in the memory of a device.
  class Mirror {
   public:
    virtual ~Mirror() = default;
    /// Brings the newest values to the columns.
    virtual void bring_home() = 0;
    /// The columns are about to change: the mirror's values become worthless.
    virtual void expire() = 0;
  };

  AtomColumns(LAMMPS *lmp, class Fix *owner);
  ~AtomColumns() override;
  AtomColumns(const AtomColumns &) = delete;
  AtomColumns &operator=(const AtomColumns &) = delete;

  /// Before attach().
  Column add(int width);
  /// Allocates, and registers the owner for LAMMPS' calls; in_restart: for those of restart files,
  /// too.  This is the last act of the owner's constructor: one that throws afterwards would leave
  /// LAMMPS a call to a fix that does not exist.
  void attach(bool in_restart);
  void set_mirror(Mirror *mirror) { mirror_ = mirror; }

  int width() const { return width_; }
  double *of(const Column &column, int atom) const { return values_[atom] + column.first; }
  /// All numbers, by atom.
  double **array() const { return values_; }
  double bytes() const;

  void grow(int nmax);
  void copy(int from, int to);
  /// Every number of an atom := 0.
  void clear(int atom);
  int pack(int atom, double *buffer) const;
  int unpack(int atom, const double *buffer);
  /// For restart files: one column, with the length in front, as LAMMPS stores it.
  int pack_restart(const Column &column, int atom, double *buffer) const;
  /// which: number of the owner among the fixes that have stored something.
  void unpack_restart(const Column &column, int atom, int which);

 private:
  void before_change() const;

  Fix *owner_;
  Mirror *mirror_ = nullptr;
  int width_ = 0, cleared_ = 0;    // cleared_: atoms that there has been room for so far
  double **values_ = nullptr;
  bool registered_ = false, in_restart_ = false;
};

}    // namespace LAMMPS_NS
#endif
