/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_gathered_atoms.h"

#include "atom.h"
#include "domain.h"
#include "fmt/format.h"
#include "force.h"
#include "update.h"

using namespace LAMMPS_NS;

void GatheredAtoms::gather()
{
  local_.clear();
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit_) local_.push_back(i);
  x_.resize(3 * local_.size());
  force_.resize(3 * local_.size());
  id_.resize(local_.size());
  const double to_core = Pointers::force->ftm2v;
  for (size_t p = 0; p < local_.size(); ++p) {
    const int i = local_[p];
    if (unwrap_)
      domain->unmap(atom->x[i], atom->image[i], &x_[3 * p]);
    else
      for (int d = 0; d < 3; ++d) x_[3 * p + d] = atom->x[i][d];
    for (int d = 0; d < 3; ++d) force_[3 * p + d] = to_core * atom->f[i][d];
    id_[p] = atom->tag[i];
  }
  if (orientations_.turn()) orientations_.gather_torques(local_, torque_);
}

std::string GatheredAtoms::describe(long index) const
{
  if (index < 0 || index >= size()) return "an atom of another processor";
  return fmt::format("atom {} at step {}", atom->tag[local_[index]], update->ntimestep);
}

double GatheredAtoms::memory_of_gathered() const
{
  return local_.capacity() * sizeof(int) + id_.capacity() * sizeof(uint64_t) +
         (x_.capacity() + force_.capacity() + torque_.capacity()) * sizeof(double);
}
