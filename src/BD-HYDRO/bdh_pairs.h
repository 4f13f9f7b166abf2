/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Pairs of particles from a neighbor list of LAMMPS.
#ifndef LMP_BDH_PAIRS_H
#define LMP_BDH_PAIRS_H

#include "bdh_ghost_cutoff.h"
#include "bdh_ghosts.h"
#include "pointers.h"
#include "pse/real_space.h"

#include <string>
#include <utility>
#include <vector>

namespace LAMMPS_NS {

/// The cutoffs that lists of other styles have beside their requests.
class OtherCutoffs {
 public:
  /// False at the first call.
  bool have_changed(double skin, const class Pair *pair);

 private:
  double skin_ = -1.0, of_pairs_ = 0.0;    // -1: none yet
};

/// The neighbor list of fix bd/pse, which has a cutoff of its own, and its ghosts.
class PairSource : protected Pointers {
 public:
  PairSource(LAMMPS *lmp, class Fix *fix) :
      Pointers(lmp), fix_(fix), ghost_cutoff_(lmp), ghosts_(lmp, fix)
  {}

  /// At init: asks LAMMPS for a list up to r_cut [distance]; the skin is added.
  /// instance: the number of the fix, by which LAMMPS knows it.
  void request(double r_cut, int instance);
  /// The list holds all pairs up to this distance [distance].
  double reach() const { return reach_; }
  /// During a run: from the next build on, the list need only reach this far.  It cannot grow.
  void shorten(double r_cut);
  void set_list(class NeighList *list) { list_ = list; }
  /// LAMMPS was not asked for the list, and deletes it.
  void forget_list();

  /// A remark on the cutoff of ghosts for the plan; may be empty.
  const std::string &ghost_note() const { return ghost_cutoff_.note(); }

  /// At the beginning of a run, before lists are built.  Newer releases may take other lists from
  /// the longer one of the fix, and cut those without a cutoff of their own at a distance of 0:
  /// pair styles would have no pairs.  Gives them the cutoff of pair styles, or stops the run where
  /// that is out of reach.
  void keep_pairs_of_others() const;
  /// LAMMPS may build lists with another stencil than the last time: at the beginning of a run, or
  /// because the box has changed.
  virtual void before_lists() const {}
  /// LAMMPS has built the list.
  virtual void list_was_built();
  /// Brings positions of ghosts up to date.
  virtual void refresh_ghosts();
  /// False if the list, or the group on this processor, has changed since map().
  bool is_current(const std::vector<int> &atoms) const
  {
    return !changed_ && ghosts_.are_of(atoms);
  }
  /// Collective.  Numbers the particles of the list: those of `atoms` come first.
  void map(const std::vector<int> &atoms);
  GhostNumbers &ghosts() { return ghosts_; }
  /// Pairs that special_bonds keeps out of the list; those of two atoms of this processor once.
  const std::vector<std::pair<int, int>> &unlisted() const { return unlisted_; }
  virtual bdh::NeighborView view() const;

 protected:
  /// A derived class may change what the list is asked for.
  virtual void adjust(struct ListWish &) const {}
  /// Drops the pairs (i, j), i of this processor, that the list holds.
  virtual void drop_listed(std::vector<std::pair<int, int>> &pairs) const;

  class NeighList *list_ = nullptr;

 private:
  void set_list_cutoff(double cutoff) const;
  bool may_shorten() const;

  class Fix *fix_;
  GhostCutoff ghost_cutoff_;
  GhostNumbers ghosts_;
  double reach_ = 0.0;        // of the list, without the skin
  double cutoff_ = 0.0;       // with it
  double requested_ = 0.0;    // at the beginning of the run, with it
  bool shortened_ = false;
  bool changed_ = true;
  OtherCutoffs others_;
  bool is_other_request_ = false;
  std::vector<std::pair<int, int>> unlisted_;
};

}    // namespace LAMMPS_NS
#endif
