/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_exclusions.h"

#include "atom.h"
#include "bdh_lammps.h"
#include "bdh_lammps_classes.h"
#include "group.h"
#include "neighbor.h"

#include <algorithm>
#include <vector>

using namespace LAMMPS_NS;

std::string Exclusions::of_the_group() const
{
  if (!neighbor->nex_type && !neighbor->nex_group && !neighbor->nex_mol) return "";
  sync_atoms(lmp, Host, MASK_MASK | TYPE_MASK | MOLECULE_MASK, EMPTY_MASK);
  for (int k = 0; k < neighbor->nex_type; ++k)
    if (any_of_types(neighbor->ex1_type[k], neighbor->ex2_type[k]))
      return fmt::format("type {} {}", neighbor->ex1_type[k], neighbor->ex2_type[k]);
  for (int k = 0; k < neighbor->nex_group; ++k) {
    const int a = neighbor->ex1_group[k], b = neighbor->ex2_group[k];
    if (any(group->bitmask[a], group->bitmask[b]))
      return fmt::format("group {} {}", group->names[a], group->names[b]);
  }
  for (int k = 0; k < neighbor->nex_mol; ++k) {
    const int g = neighbor->ex_mol_group[k];
    if (any_in_molecules(group->bitmask[g], neighbor->ex_mol_intra[k]))
      return fmt::format("molecule/{} {}", neighbor->ex_mol_intra[k] ? "intra" : "inter",
                         group->names[g]);
  }
  return "";
}

bool Exclusions::somewhere(bool here) const
{
  int mine = here, all = 0;
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MAX, world);
  return all;
}

/// A single atom in both groups already forms a pair: with its own image.
bool Exclusions::any(int group_a, int group_b) const
{
  const auto has = [&](int bit) {
    return somewhere(std::any_of(atom->mask, atom->mask + atom->nlocal,
                                 [&](int mask) { return (mask & groupbit_) && (mask & bit); }));
  };
  return has(group_a) && has(group_b);
}

bool Exclusions::any_of_types(int a, int b) const
{
  const auto has = [&](int type) {
    bool here = false;
    for (int i = 0; i < atom->nlocal; ++i)
      here |= (atom->mask[i] & groupbit_) && atom->type[i] == type;
    return somewhere(here);
  };
  return has(a) && has(b);
}

/// Pairs in the same molecule if `same`, else in different ones.
bool Exclusions::any_in_molecules(int groupbit, bool same) const
{
  std::vector<tagint> mine;
  for (int i = 0; i < atom->nlocal; ++i)
    if ((atom->mask[i] & groupbit_) && (atom->mask[i] & groupbit))
      mine.push_back(atom->molecule[i]);
  if (same) return somewhere(!mine.empty());
  const auto range = std::minmax_element(mine.begin(), mine.end());
  tagint ends[2] = {-MAXTAGINT, -MAXTAGINT}, all[2];    // minus the least, and the greatest
  if (!mine.empty()) {
    ends[0] = -*range.first;
    ends[1] = *range.second;
  }
  MPI_Allreduce(ends, all, 2, MPI_LMP_TAGINT, MPI_MAX, world);
  return all[1] > -MAXTAGINT && -all[0] != all[1];
}
