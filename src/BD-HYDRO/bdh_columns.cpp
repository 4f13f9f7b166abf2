/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_columns.h"

#include "atom.h"
#include "memory.h"
#include "modify.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

void FixCallback::add()
{
  atom->add_callback(list_);
  added_ = true;
}

/// Atom::delete_callback() does not find a fix before its constructor has ended, nor if that has
/// thrown: its place among the fixes is empty then.
void FixCallback::remove()
{
  if (!added_) return;
  added_ = false;
  Fix **const end = modify->fix + modify->nfix;
  if (std::find(modify->fix, end, owner_) != end) return atom->delete_callback(owner_->id, list_);
  const int number = std::find(modify->fix, end, nullptr) - modify->fix;
  int *const list = list_ == Atom::GROW ? atom->extra_grow : atom->extra_restart;
  int &count = list_ == Atom::GROW ? atom->nextra_grow : atom->nextra_restart;
  count = std::remove(list, list + count, number) - list;
}

AtomColumns::AtomColumns(LAMMPS *lmp, Fix *owner) :
    Pointers(lmp), owner_(owner), callback_(lmp, owner, Atom::GROW)
{}

AtomColumns::~AtomColumns() { memory->destroy(values_); }

void AtomColumns::give_up()
{
  callback_.remove();
  memory->destroy(values_);
  owner_->maxexchange = width_ = 0;
}

AtomColumns::Column AtomColumns::add(int width)
{
  const Column column{width_, width};
  width_ += width;
  return column;
}

void AtomColumns::attach()
{
  if (width_ == 0) return;
  owner_->maxexchange = width_;
  owner_->grow_arrays(atom->nmax);
  callback_.add();
}

double AtomColumns::bytes() const { return values_ ? width_ * sizeof(double) * atom->nmax : 0.0; }

void AtomColumns::grow(int nmax)
{
  memory->grow(values_, nmax, width_, "bd-hydro:columns");
  for (; cleared_ < nmax; ++cleared_) std::fill_n(values_[cleared_], width_, 0.0);
}

void AtomColumns::before_change() const
{
  if (!mirror_) return;
  mirror_->bring_home();
  mirror_->expire();
}

void AtomColumns::copy(int from, int to)
{
  before_change();
  std::copy_n(values_[from], width_, values_[to]);
}

void AtomColumns::clear(int i)
{
  if (!values_) return;
  before_change();
  std::fill_n(values_[i], width_, 0.0);
}

void AtomColumns::clear_all()
{
  for (int i = 0; i < atom->nlocal; ++i) clear(i);
}

void AtomColumns::clear(const Column &column)
{
  for (int i = 0; i < atom->nlocal; ++i) std::fill_n(of(column, i), column.width, 0.0);
}

void AtomColumns::set(const Column &column, int offset, const std::vector<int> &atoms,
                      const std::vector<double> &v, double factor)
{
  for (size_t p = 0; p < atoms.size(); ++p)
    for (int c = 0; c < 3; ++c) of(column, atoms[p])[offset + c] = factor * v[3 * p + c];
}

int AtomColumns::pack(const Column &column, int i, double *buffer) const
{
  if (mirror_) mirror_->bring_home();
  std::copy_n(of(column, i), column.width, buffer);
  return column.width;
}

int AtomColumns::unpack(const Column &column, int i, const double *buffer)
{
  before_change();
  std::copy_n(buffer, column.width, of(column, i));
  return column.width;
}

void RestartColumn::attach()
{
  if (column_.width > 0) callback_.add();
}

int RestartColumn::pack(int i, double *buffer) const
{
  buffer[0] = size();
  return 1 + columns_.pack(column_, i, buffer + 1);
}

void RestartColumn::unpack(int i, int which)
{
  if (column_.width == 0) return;
  const double *values = atom->extra[i];
  for (int k = 0; k < which; ++k) values += std::lround(values[0]);
  columns_.unpack(column_, i, values + 1);
}

void FixWithColumns::grow_arrays(int nmax)
{
  columns_.grow(nmax);
  if (peratom_flag) array_atom = columns_.array();
}
