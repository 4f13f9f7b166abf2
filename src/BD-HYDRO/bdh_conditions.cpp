/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_conditions.h"

#include "atom.h"
#include "base/comm.h"
#include "bdh_lammps.h"
#include "bdh_lammps_classes.h"
#include "comm.h"
#include "fmt/format.h"
#include "lammps.h"
#include "neighbor.h"

#include <algorithm>
#include <cstring>
#include <unistd.h>
#include <vector>

using namespace LAMMPS_NS;

namespace {

/// Most neighbors that a list may hold for one atom.  The pages of all lists have room for ten
/// times as many.
constexpr double most_neighbors = 1e6;
/// The fraction of a machine's memory that the plan may use.
constexpr double usable = 0.8;

/// Collective.  Total memory of the machines that the processes run on, each counted once [bytes].
double memory_of_machines(MPI_Comm world, int processors)
{
  char name[MPI_MAX_PROCESSOR_NAME] = {};
  int length = 0;
  MPI_Get_processor_name(name, &length);
  std::vector<char> names(sizeof name * processors);
  MPI_Allgather(name, sizeof name, MPI_CHAR, names.data(), sizeof name, MPI_CHAR, world);
  int here = 0;
  for (int p = 0; p < processors; ++p) here += !strcmp(name, &names[sizeof name * p]);
  const double pages = sysconf(_SC_PHYS_PAGES);
  double own = pages * sysconf(_SC_PAGESIZE) / here, all = 0.0;
  MPI_Allreduce(&own, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

bool is_tiled(const Comm &comm) { return comm.style == 1; }

}    // namespace

bdh::PseConditions LAMMPS_NS::conditions_now(LAMMPS *lmp, int groupbit, double radius,
                                             const bdh::Cell &cell)
{
  const Atom &atom = *lmp->atom;
  sync_atoms(lmp, Host, X_MASK | TAG_MASK | MASK_MASK, EMPTY_MASK);
  std::vector<double> x;
  std::vector<uint64_t> ids;
  for (int i = 0; i < atom.nlocal; ++i) {
    if (!(atom.mask[i] & groupbit)) continue;
    x.insert(x.end(), atom.x[i], atom.x[i] + 3);
    ids.push_back(atom.tag[i]);
  }
  bdh::PseConditions c;
  c.counts =
      bdh::count_pairs(cell, radius, x.data(), ids.data(), ids.size(), bdh::Comm(lmp->world));
  c.skin = lmp->neighbor->skin;
  c.most_neighbors = most_neighbors;
  c.memory = usable * memory_of_machines(lmp->world, lmp->comm->nprocs);
  if (is_tiled(*lmp->comm))
    c.cutoff_reason = fmt::format("the shortest height of the box less the neighbor skin of {}, up "
                                  "to which comm_style tiled keeps ghosts: use comm_style brick",
                                  lmp->neighbor->skin);
  return c;
}

double LAMMPS_NS::longest_cutoff(LAMMPS *lmp, const bdh::Cell &cell)
{
  if (!is_tiled(*lmp->comm)) return 0.0;
  const double shortest = std::min({cell.height(0), cell.height(1), cell.height(2)});
  const double longest = (1.0 - 1e-9) * shortest - lmp->neighbor->skin;
  return std::max(longest, 1e-9 * shortest);    // 0 would mean no limit
}
