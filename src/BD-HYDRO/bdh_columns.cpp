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

#include <algorithm>

using namespace LAMMPS_NS;

AtomColumns::AtomColumns(LAMMPS *lmp, Fix *owner) : Pointers(lmp), owner_(owner) {}

AtomColumns::~AtomColumns()
{
  if (registered_) atom->delete_callback(owner_->id, Atom::GROW);
  if (registered_ && restart_.width) atom->delete_callback(owner_->id, Atom::RESTART);
  memory->destroy(values_);
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
  atom->add_callback(Atom::GROW);
  if (restart_.width) atom->add_callback(Atom::RESTART);
  registered_ = true;
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

void AtomColumns::set(const Column &column, int offset, const std::vector<int> &atoms,
                      const std::vector<double> &v, double factor)
{
  for (size_t p = 0; p < atoms.size(); ++p)
    for (int c = 0; c < 3; ++c) of(column, atoms[p])[offset + c] = factor * v[3 * p + c];
}

int AtomColumns::pack(int i, double *buffer) const
{
  if (mirror_) mirror_->bring_home();
  std::copy_n(values_[i], width_, buffer);
  return width_;
}

int AtomColumns::unpack(int i, const double *buffer)
{
  before_change();
  std::copy_n(buffer, width_, values_[i]);
  return width_;
}

int AtomColumns::pack_restart(int i, double *buffer) const
{
  if (mirror_) mirror_->bring_home();
  buffer[0] = restart_size();
  std::copy_n(of(restart_, i), restart_.width, buffer + 1);
  return restart_size();
}

void AtomColumns::unpack_restart(int i, int which)
{
  if (restart_.width == 0) return;
  before_change();
  const double *values = atom->extra[i];
  for (int k = 0; k < which; ++k) values += static_cast<int>(values[0]);
  std::copy_n(values + 1, restart_.width, of(restart_, i));
}

void FixWithColumns::grow_arrays(int nmax)
{
  columns_.grow(nmax);
  if (peratom_flag) array_atom = columns_.array();
}
