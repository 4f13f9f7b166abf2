/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_neighbor_settings.h"

#include "atom.h"
#include "bdh_exclusions.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix.h"
#include "group.h"
#include "neighbor.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

namespace {

/// LAMMPS makes the group of comm_modify group accessible only to classes derived from Comm.
struct BorderGroup : Comm {
  static int Comm::*of_comm() { return &BorderGroup::bordergroup; }
};

}    // namespace

const char *NeighborSettings::group_name(int number) const { return group->names[number]; }

void NeighborSettings::check(double radius) const
{
  check_list_style(radius);
  check_communication();
  check_hidden_pairs();
}

void NeighborSettings::check_list_style(double radius) const
{
  if (neighbor->style != Neighbor::BIN)
    error->all(FLERR,
               "{}: neighbor style must be bin, the only one whose lists may have a cutoff of "
               "their own: use neighbor {} bin",
               name_, neighbor->skin);
  // LAMMPS' default skin in units si is 1 mm.
  const double longest = MAX(MAX(domain->prd[0], domain->prd[1]), domain->prd[2]);
  if (neighbor->skin > longest)
    error->all(FLERR,
               "{}: neighbor skin = {}, but must be at most the longest edge of the box, {}: use "
               "neighbor {:.1g} bin",
               name_, neighbor->skin, longest, 0.3 * radius);
  if (neighbor->build_once)
    error->all(FLERR,
               "{}: neigh_modify once yes keeps the neighbor lists of the first step: use once no",
               name_);
  if (atom->molecular == Atom::TEMPLATE)
    error->all(FLERR,
               "{}: atom_style template is not supported: use atom_style bond, angle, molecular "
               "or full",
               name_);
}

void NeighborSettings::check_communication() const
{
  if (comm->mode != Comm::SINGLE)
    error->all(FLERR,
               "{}: ghosts must reach equally far for all atoms: use comm_modify mode "
               "single",
               name_);
  const int with_ghosts = comm->*BorderGroup::of_comm(), own = fix_.igroup;
  if (with_ghosts && with_ghosts != own)
    error->all(FLERR,
               "{}: comm_modify group {} keeps ghosts of other atoms from the fix: use "
               "comm_modify group {}",
               name_, group_name(with_ghosts), group_name(own));
}

void NeighborSettings::check_hidden_pairs() const
{
  const char *own = group_name(fix_.igroup);
  const std::string excluded = Exclusions(lmp, fix_.groupbit).of_the_group();
  if (!excluded.empty())
    error->all(FLERR,
               "{}: neigh_modify exclude keeps pairs out of all neighbor lists, but they interact "
               "through the fluid: use neigh_modify exclude none, and set the interactions to "
               "zero in the pair style (exclude {} is for atoms of group {})",
               name_, excluded, own);
  if (neighbor->includegroup && neighbor->includegroup != fix_.igroup)
    error->all(FLERR,
               "{}: neigh_modify include keeps atoms of group {} out of the neighbor lists: use "
               "include {}",
               name_, own, own);
}

/// LAMMPS' default limit is meant for pair styles.  The new limit allows for touching spheres or
/// for twice the largest count that the plan found anywhere, whichever is more, but not for more
/// neighbors than exist.  It is at least 100 000, since during the run particles may be added or
/// cluster, and the box may shrink.
void NeighborSettings::allow_neighbors(const bdh::PsePlan &plan, double cutoff) const
{
  const double touching = 0.74 * std::pow(cutoff / plan.radius, 3.0),
               counted = plan.most_neighbors * std::pow(cutoff / plan.r_cut, 3.0);
  double everybody = atom->natoms;
  for (double edge : {domain->prd[0], domain->prd[1], domain->prd[2]})
    everybody *= 1.0 + std::floor(2.0 * cutoff / edge);
  const double wanted = std::min(std::max(touching, 2.0 * counted + 200.0), everybody);
  const int most = std::clamp(wanted, 1e5, 1e7);
  if (neighbor->oneatom < most) neighbor->oneatom = most;
  if (neighbor->pgsize < 10 * neighbor->oneatom) neighbor->pgsize = 10 * neighbor->oneatom;
}
