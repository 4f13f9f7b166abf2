/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Per-atom numbers of a fix.
#ifndef LMP_BDH_COLUMNS_H
#define LMP_BDH_COLUMNS_H

#include "atom.h"
#include "fix.h"
#include "pointers.h"

#include <vector>

namespace LAMMPS_NS {

/// The place of a fix in one of LAMMPS' lists of those that are called when per-atom data grow or
/// are read from a restart file.
class FixCallback : protected Pointers {
 public:
  /// list: Atom::GROW or Atom::RESTART.
  FixCallback(LAMMPS *lmp, class Fix *owner, int list) : Pointers(lmp), owner_(owner), list_(list)
  {}
  ~FixCallback() noexcept override { remove(); }    // newer releases let that of Pointers throw
  FixCallback(const FixCallback &) = delete;
  FixCallback &operator=(const FixCallback &) = delete;

  /// Call it at the very end of the owner's constructor: if the constructor threw after that,
  /// LAMMPS would call a fix that does not exist.
  void add();
  void remove();

 private:
  Fix *owner_;
  int list_;
  bool added_ = false;
};

/// Numbers per atom in named columns.  They move with the atoms when LAMMPS reorders atoms in
/// memory or sends them to another processor.
///
/// LAMMPS calls the fix, a FixWithColumns, which calls grow(), copy(), pack() and unpack() here.
class AtomColumns : protected Pointers {
 public:
  /// Consecutive numbers of an atom.  A width of 0 means that none are kept.
  struct Column {
    int first = 0, width = 0;
  };
  /// Holds the newest values somewhere else, such as in the memory of a device.
  class Mirror {
   public:
    virtual ~Mirror() = default;
    /// Copies the newest values into the columns.
    virtual void bring_home() = 0;
    /// The columns are about to change, so the mirror's values are no longer valid.
    virtual void expire() = 0;
  };

  AtomColumns(LAMMPS *lmp, class Fix *owner);
  ~AtomColumns() override;

  /// Adds a column.  Call it before attach().
  Column add(int width);
  /// Allocates the columns and has LAMMPS call the owner; see FixCallback::add().
  void attach();
  /// Gives up all columns.  Call it in the owner's constructor, after attach().
  void give_up();
  void set_mirror(Mirror *mirror) { mirror_ = mirror; }

  int width() const { return width_; }
  double *of(const Column &column, int atom) const { return values_[atom] + column.first; }
  /// All numbers, indexed by atom.
  double **array() const { return values_; }
  double bytes() const;

  void grow(int nmax);
  void copy(int from, int to);
  /// Sets all numbers to 0, of one atom or of every atom on this processor.
  void clear(int atom);
  void clear_all();
  /// Sets the numbers of a column to 0, of every atom on this processor.
  void clear(const Column &column);
  /// For each of these atoms, sets three numbers, from `offset` in the column on, to factor * v.
  void set(const Column &column, int offset, const std::vector<int> &atoms,
           const std::vector<double> &v, double factor);
  /// The column that spans all numbers of an atom.
  Column all() const { return {0, width_}; }
  /// Copies the numbers of a column to the buffer, or back from it; returns how many there are.
  int pack(const Column &column, int atom, double *buffer) const;
  int unpack(const Column &column, int atom, const double *buffer);

 private:
  void before_change() const;

  Fix *owner_;
  Mirror *mirror_ = nullptr;
  int width_ = 0, cleared_ = 0;    // cleared_: rows that were set to 0 when added
  double **values_ = nullptr;
  FixCallback callback_;
};

/// The column that is written to restart files, preceded by its length as LAMMPS requires.
class RestartColumn : protected Pointers {
 public:
  RestartColumn(LAMMPS *lmp, Fix *owner, AtomColumns &columns) :
      Pointers(lmp), columns_(columns), callback_(lmp, owner, Atom::RESTART)
  {}
  ~RestartColumn() noexcept override {}    // newer releases let that of Pointers throw

  /// Chooses the column.  Call it before attach().
  void keep(const AtomColumns::Column &column) { column_ = column; }
  /// Has LAMMPS call the owner if a column is kept; see FixCallback::add().
  void attach();
  /// Numbers per atom in a restart file.
  int size() const { return column_.width + 1; }
  int pack(int atom, double *buffer) const;
  /// which: index of the owner among the fixes that have stored per-atom data.  Does nothing if no
  /// column is kept, since a run may continue with a scheme that needs none.
  void unpack(int atom, int which);

 private:
  AtomColumns &columns_;
  AtomColumns::Column column_;
  FixCallback callback_;
};

/// A fix that keeps its per-atom numbers in columns.
class FixWithColumns : public Fix {
 public:
  FixWithColumns(LAMMPS *lmp, int narg, char **arg) :
      Fix(lmp, narg, arg), columns_(lmp, this), restart_column_(lmp, this, columns_)
  {}

  void grow_arrays(int nmax) override;
  void copy_arrays(int i, int j, int) override { columns_.copy(i, j); }
  void set_arrays(int i) override { columns_.clear(i); }
  int pack_exchange(int i, double *buffer) override
  {
    return columns_.pack(columns_.all(), i, buffer);
  }
  int unpack_exchange(int i, double *buffer) override
  {
    return columns_.unpack(columns_.all(), i, buffer);
  }
  int pack_restart(int i, double *buffer) override { return restart_column_.pack(i, buffer); }
  void unpack_restart(int i, int which) override { restart_column_.unpack(i, which); }
  int maxsize_restart() override { return restart_column_.size(); }
  int size_restart(int) override { return restart_column_.size(); }

 protected:
  AtomColumns columns_;
  RestartColumn restart_column_;
};

}    // namespace LAMMPS_NS
#endif
