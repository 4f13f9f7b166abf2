/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_pairs.h"

#include "atom.h"
#include "bdh_lammps.h"
#include "bdh_lammps_classes.h"
#include "comm.h"
#include "error.h"
#include "fix.h"
#include "force.h"
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

bool is_within(double distance, const double *x, const double *y)
{
  const double r[3] = {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
  return r[0] * r[0] + r[1] * r[1] + r[2] * r[2] <= distance * distance;
}

/// Bonded pairs within a cutoff whose special_bonds factor is 0: the list may lack them.  It does
/// so if they are nearest images, and the KOKKOS package takes other images for the nearest than
/// LAMMPS does.
std::vector<std::pair<int, int>> pairs_without_weight(Atom &atom, const int *special_flag,
                                                      double cutoff)
{
  std::vector<std::pair<int, int>> pairs;
  if (atom.molecular == Atom::ATOMIC) return pairs;
  double *const *const x = atom.x;
  for (int i = 0; i < atom.nlocal; ++i)
    for (int level = 0, k = 0; level < 3; ++level)
      for (; k < atom.nspecial[i][level]; ++k) {
        if (special_flag[level + 1] != 0) continue;
        for (int j = atom.map(atom.special[i][k]); j >= 0; j = atom.sametag[j])
          if ((j >= atom.nlocal || i < j) && is_within(cutoff, x[i], x[j]))
            pairs.emplace_back(i, j);
      }
  return pairs;
}

}    // namespace

void PairSource::request(double r_cut, int instance)
{
  // If the request is the same as in the last run, LAMMPS keeps that list.
  if (shortened_) set_list_cutoff(requested_);
  shortened_ = false;
  // So it does where the skin or the cutoffs of pair styles have changed, which may be taken from
  // the list: then the request differs by round-off.
  if (others_.have_changed(neighbor->skin, force->pair)) is_other_request_ = !is_other_request_;
  ListWish wish;
  wish.reach = reach_ = is_other_request_ ? r_cut * (1.0 + 1e-12) : r_cut;
  cutoff_ = requested_ = reach_ + neighbor->skin;
  adjust(wish);
  request_list(*neighbor, fix_, instance, wish);
  ghost_cutoff_.reach(cutoff_);
}

bool OtherCutoffs::have_changed(double skin, const Pair *pair)
{
  const double of_pairs = pair ? pair->cutforce : 0.0;
  const bool changed = skin_ >= 0.0 && (skin_ != skin || of_pairs_ != of_pairs);
  skin_ = skin;
  of_pairs_ = of_pairs;
  return changed;
}

namespace {

// The first one is for releases that trim lists.
template <class List> auto is_trimmed(const List &list, int) -> decltype(list.trim != 0)
{
  return list.trim != 0;
}
template <class List> bool is_trimmed(const List &, long) { return false; }

}    // namespace

#ifdef BDH_INSTALLED_LAMMPS

// The list stays as long as it was requested, which only costs time.
void PairSource::set_list_cutoff(double) const {}
bool PairSource::may_shorten() const { return false; }

// From 22 Jul 2025 on, lists of the host without a cutoff of their own keep all pairs.
void PairSource::keep_pairs_of_others() const
{
  if (BDH_LAMMPS_DATE >= 20250722) return;
  for (int i = 0; i < neighbor->nlist; ++i) {
    const NeighList &list = *neighbor->lists[i];
    const NeighList *const parent = list.listskip ? list.listskip : list.listcopy;
    if (parent == list_ && is_trimmed(list, 0))
      error->all(FLERR,
                 "fix {}: this release of LAMMPS would take the pairs of another style from the "
                 "longer neighbor list of this fix, and lose them: use newton on, or build LAMMPS "
                 "from source with this package",
                 fix_->style);
  }
}

#else

/// A list with a cutoff of its own has bins and a stencil of its own, which LAMMPS makes again when
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

void PairSource::keep_pairs_of_others() const
{
  // The KOKKOS package keeps the square of some of these cutoffs as an integer.
  const double most = neighbor->cutneighmax, cutoff = std::sqrt(std::ceil(most * most) + 0.5);
  for (int i = 0; i < neighbor->nlist; ++i) {
    const NeighList &list = *neighbor->lists[i];
    if (is_trimmed(list, 0) && list.np && list.np->cutoff_custom == 0.0)
      list.np->cutoff_custom = cutoff;
  }
}

/// False if another style uses this list, too.
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
  // A slightly shorter list would gain little, and would be too short if the scene changed back.
  if (r_cut >= reach_ || (r_cut > 0.7 * reach_ && comm->style != 1)) return;
  if (!may_shorten()) return;
  reach_ = r_cut;
  cutoff_ = r_cut + neighbor->skin;
  set_list_cutoff(cutoff_);
  shortened_ = true;
  ghost_cutoff_.shorten(cutoff_);
}

void PairSource::forget_list()
{
  list_ = nullptr;
  shortened_ = false;
}

/// Atoms are still where they were when the list was built.
void PairSource::list_was_built()
{
  if (!list_) return;
  changed_ = true;
  unlisted_ = pairs_without_weight(*atom, neighbor->special_flag, cutoff_);
  drop_listed(unlisted_);
}

void PairSource::refresh_ghosts() { comm->forward_comm(); }

void PairSource::map(const std::vector<int> &atoms)
{
  ghosts_.map(atoms);
  changed_ = false;
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
