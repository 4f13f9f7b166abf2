/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_pairs.h"

#include "atom.h"
#include "bdh_exclusions.h"
#include "bdh_lammps.h"
#include "bdh_lammps_classes.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix.h"
#include "force.h"
#include "group.h"
#include "modify.h"
#include "neigh_list.h"
#include "neighbor.h"
#include "pair.h"

#ifndef BDH_INSTALLED_LAMMPS
#include "nbin.h"
#include "npair.h"
#include "nstencil.h"
#endif

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

namespace {

/// The group of comm_modify group, which LAMMPS shows to its own derived classes only.
struct BorderGroup : Comm {
  static int Comm::*of_comm() { return &BorderGroup::bordergroup; }
};

bool is_within(double distance, const double *x, const double *y)
{
  const double r[3] = {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
  return r[0] * r[0] + r[1] * r[1] + r[2] * r[2] <= distance * distance;
}

}    // namespace

/* ---------------------------------------------------------------------- */

PairSource::PairSource(LAMMPS *lmp, Fix *fix, const std::string &name) :
    Pointers(lmp), fix_(fix), name_(name), ghosts_(lmp, fix)
{}

void PairSource::check(double radius) const
{
  if (neighbor->style != Neighbor::BIN)
    error->all(FLERR,
               "{}: neighbor style must be bin, which alone allows lists with a cutoff of their "
               "own: use neighbor {} bin",
               name_, neighbor->skin);
  if (comm->mode != Comm::SINGLE)
    error->all(FLERR,
               "{}: ghosts are needed up to one distance for all atoms: use comm_modify mode "
               "single",
               name_);
  const int with_ghosts = comm->*BorderGroup::of_comm(), own = fix_->igroup;
  if (with_ghosts && with_ghosts != own)
    error->all(FLERR,
               "{}: comm_modify group {} keeps ghosts of other atoms from the fix: use "
               "comm_modify group {}",
               name_, group->names[with_ghosts], group->names[own]);
  // LAMMPS' own is a millimetre in units si.
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
  const std::string excluded = Exclusions(lmp, fix_->groupbit).of_the_group();
  if (!excluded.empty())
    error->all(FLERR,
               "{}: neigh_modify exclude keeps pairs out of all neighbor lists, but they interact "
               "through the fluid: use neigh_modify exclude none, and set the interactions to "
               "zero in the pair style (exclude {} is for atoms of group {})",
               name_, excluded, group->names[own]);
  if (neighbor->includegroup && neighbor->includegroup != own)
    error->all(FLERR,
               "{}: neigh_modify include keeps atoms of group {} out of the neighbor lists: use "
               "include {}",
               name_, group->names[own], group->names[own]);
  if (atom->molecular == Atom::TEMPLATE)
    error->all(FLERR,
               "{}: atom_style template is not supported: use atom_style bond, angle, molecular "
               "or full",
               name_);
}

void PairSource::request(const bdh::PsePlan &plan, double r_cut, int instance)
{
  // LAMMPS keeps the list of the last run if it is asked for the same again.
  if (shortened_) set_list_cutoff(requested_);
  shortened_ = false;
  ListWish wish;
  wish.reach = reach_ = r_cut;
  cutoff_ = requested_ = r_cut + neighbor->skin;
  adjust(wish);
  request_list(*neighbor, fix_, instance, wish);
  allow_neighbors(plan, cutoff_);
  reach_ghosts(cutoff_);
}

/// About a hundred neighbors, or half the box.
void PairSource::request_for_strangers(int instance)
{
  const double shortest = MIN(MIN(domain->prd[0], domain->prd[1]), domain->prd[2]);
  const double atoms = MAX(atom->natoms, static_cast<bigint>(1));
  const double volume = domain->prd[0] * domain->prd[1] * domain->prd[2];
  bdh::PsePlan plan;
  plan.r_cut = MIN(0.5 * shortest, std::cbrt(30.0 * volume / atoms));
  plan.radius = 0.1 * plan.r_cut;
  request(plan, plan.r_cut, instance);
}

#ifdef BDH_INSTALLED_LAMMPS

// The list stays as long as it was requested, which costs time and nothing else.
void PairSource::set_list_cutoff(double) const {}
bool PairSource::may_shorten() const { return false; }

#else

/// LAMMPS gives lists with a cutoff of their own bins and a stencil of their own, which follow when
/// the box changes, and with it the ghosts.
void PairSource::set_list_cutoff(double cutoff) const
{
  NPair &builder = *list_->np;
  builder.cutoff_custom = builder.nb->cutoff_custom = builder.ns->cutoff_custom = cutoff;
  builder.nb->copy_neighbor_info();
  builder.ns->copy_neighbor_info();
  builder.copy_neighbor_info();
  before_lists();    // a derived class may have told the builder something else
}

/// Not if somebody else uses this list, too.
bool PairSource::may_shorten() const
{
  if (list_->copy || !list_->np->nb || !list_->np->ns) return false;
  for (int i = 0; i < neighbor->nlist; ++i) {
    const NeighList &other = *neighbor->lists[i];
    if (other.listcopy == list_ || other.listfull == list_ || other.listskip == list_) return false;
  }
  return true;
}

#endif

void PairSource::shorten(double r_cut)
{
  // A little shorter would gain little, and be missed when the scene changes back.
  if (r_cut >= reach_ || (r_cut > 0.7 * reach_ && comm->style != 1)) return;
  if (!may_shorten()) return;
  reach_ = r_cut;
  cutoff_ = r_cut + neighbor->skin;
  set_list_cutoff(cutoff_);
  shortened_ = true;
  int fixes = 0;    // another one may rely on these ghosts
  for (int f = 0; f < modify->nfix; ++f) fixes += is_style(modify->fix[f]->style, pse_styles);
  if (fixes == 1 && comm->cutghostuser == ghost_cutoff_)    // else this fix has not set it
    comm->cutghostuser = ghost_cutoff_ = MAX(cutoff_, others_cutoff_);
}

/// Ghosts are kept as far as the list reaches.
void PairSource::reach_ghosts(double cutoff)
{
  if (comm->cutghostuser == ghost_cutoff_) comm->cutghostuser = others_cutoff_;
  others_cutoff_ = comm->cutghostuser;
  ghost_cutoff_ = 0.0;
  ghost_note_.clear();
  if (others_cutoff_ >= cutoff) return;
  ghost_cutoff_ = cutoff;
  const double others =
      MAX(others_cutoff_, force->pair ? force->pair->cutforce + neighbor->skin : 0.0);
  if (others < cutoff)
    ghost_note_ = fmt::format("kept within {:.4g} of each process' domain (the pair style and "
                              "comm_modify ask for {:.4g})",
                              cutoff, others);
  comm->cutghostuser = cutoff;
}

/// LAMMPS' own limit of neighbors per atom is meant for pair styles: room for spheres that touch,
/// or twice as many as the plan has counted anywhere, though not for more than there are; and
/// always for 100 000, since particles may come or gather, and the box may shrink, during the run.
void PairSource::allow_neighbors(const bdh::PsePlan &plan, double cutoff)
{
  const double touching = 0.74 * std::pow(cutoff / plan.radius, 3.0),
               counted = plan.most_neighbors * std::pow(cutoff / plan.r_cut, 3.0);
  double everybody = static_cast<double>(atom->natoms);
  for (double edge : {domain->prd[0], domain->prd[1], domain->prd[2]})
    everybody *= 1.0 + std::floor(2.0 * cutoff / edge);
  const double wanted = std::min(std::max(touching, 2.0 * counted + 200.0), everybody);
  const int most = static_cast<int>(std::min(std::max(wanted, 1e5), 1e7));
  if (neighbor->oneatom < most) neighbor->oneatom = most;
  if (neighbor->pgsize < 10 * neighbor->oneatom) neighbor->pgsize = 10 * neighbor->oneatom;
}

void PairSource::forget_list()
{
  list_ = nullptr;
  shortened_ = false;
}

void PairSource::list_was_built()
{
  if (!list_) return;
  changed_ = true;
  find_unlisted();
}

void PairSource::refresh_ghosts() { comm->forward_comm(); }

void PairSource::map(const std::vector<int> &atoms)
{
  ghosts_.map(atoms);
  changed_ = false;
}

/// Bonded atoms with special_bonds 0 are missing in the list as far as they are nearest images, of
/// which the plain and the KOKKOS package have different notions: hence the look into the list.  To
/// be called at the positions of the list.
void PairSource::find_unlisted()
{
  unlisted_.clear();
  if (atom->molecular == Atom::ATOMIC) return;
  double *const *const x = atom->x;
  for (int i = 0; i < atom->nlocal; ++i)
    for (int level = 0, k = 0; level < 3; ++level)
      for (; k < atom->nspecial[i][level]; ++k) {
        if (neighbor->special_flag[level + 1] != 0) continue;
        for (int j = atom->map(atom->special[i][k]); j >= 0; j = atom->sametag[j])
          if ((j >= atom->nlocal || i < j) && is_within(cutoff_, x[i], x[j]))
            unlisted_.emplace_back(i, j);
      }
  drop_listed(unlisted_);
}

void PairSource::drop_listed(std::vector<std::pair<int, int>> &pairs) const
{
  if (pairs.empty()) return;
  const bdh::NeighborView list = view();
  const auto holds = [&](int i, int j) {
    const int *row = list.neighbors[i], *end = row + list.count[i];
    return std::any_of(row, end, [&](int entry) { return (entry & list.mask) == j; });
  };
  const auto is_listed = [&](const std::pair<int, int> &p) {
    return holds(p.first, p.second) || (p.second < list.local_atoms && holds(p.second, p.first));
  };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), is_listed), pairs.end());
}

bdh::NeighborView PairSource::view() const
{
  bdh::NeighborView v;
  if (!list_) return v;
  v.rows = list_->inum;
  v.atom = list_->ilist;
  v.count = list_->numneigh;
  v.neighbors = list_->firstneigh;
  v.mask = NEIGHMASK;
  v.local_atoms = atom->nlocal;
  v.x = atom->nlocal + atom->nghost ? atom->x[0] : nullptr;
  v.particle = ghosts_.particle_of().data();
  v.extra = &unlisted_;
  return v;
}
