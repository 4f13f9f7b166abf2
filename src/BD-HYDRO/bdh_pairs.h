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

#include "bdh_ghosts.h"
#include "pointers.h"
#include "pse/plan.h"
#include "pse/real_space.h"

#include <string>
#include <utility>
#include <vector>

namespace LAMMPS_NS {

/// The neighbor list of fix bd/pse, which has a cutoff of its own, and its ghosts.
class PairSource : protected Pointers {
 public:
  /// name: of the fix, for messages.
  PairSource(LAMMPS *lmp, class Fix *fix, const std::string &name);

  /// Refuses what would hide pairs, or keep the list from having a cutoff of its own.
  void check(double radius) const;
  /// At init: asks LAMMPS for a list up to r_cut [distance], the skin is added.
  /// instance: the fix's own, which LAMMPS asks for.
  void request(const bdh::PsePlan &plan, double r_cut, int instance);
  /// At init, when nothing is known of the particles to come: asks for a list that is cheap for the
  /// atoms that there are.
  void request_for_strangers(int instance);
  /// Pairs up to this distance are in the list [distance].
  double reach() const { return reach_; }
  /// During a run: from the next build on the list need only reach this far.  It cannot grow.
  void shorten(double r_cut);
  void set_list(class NeighList *list) { list_ = list; }
  /// LAMMPS was not asked for the list, and deletes it.
  void forget_list();
  /// A remark on the cutoff of ghosts for the plan; may be empty.
  const std::string &ghost_note() const { return ghost_note_; }

  /// LAMMPS is about to build lists for the first time in a run.
  virtual void before_lists() const {}
  /// LAMMPS has built the list.
  virtual void list_was_built();
  /// Ghosts := where their atoms are.
  virtual void refresh_ghosts();
  /// False if the list, or the group on this processor, is another one than that of map().
  bool is_current(const std::vector<int> &atoms) const
  {
    return !changed_ && ghosts_.are_of(atoms);
  }
  /// Collective.  Numbers the particles of the list: those of `atoms` first.
  void map(const std::vector<int> &atoms);
  GhostNumbers &ghosts() { return ghosts_; }
  const GhostNumbers &ghosts() const { return ghosts_; }
  /// Pairs that special_bonds keeps out of the list; those of two atoms of this processor once.
  const std::vector<std::pair<int, int>> &unlisted() const { return unlisted_; }
  virtual bdh::NeighborView view() const;

 protected:
  /// A derived class may change what the list is asked for.
  virtual void adjust(struct ListWish &) const {}
  /// Leaves the pairs (i, j), i of this processor, that the list does not hold.
  virtual void drop_listed(std::vector<std::pair<int, int>> &pairs) const;

  class NeighList *list_ = nullptr;

 private:
  void find_unlisted();
  void set_list_cutoff(double cutoff) const;
  bool may_shorten() const;
  void allow_neighbors(const bdh::PsePlan &plan, double cutoff);
  void reach_ghosts(double cutoff);

  class Fix *fix_;
  const std::string name_;
  std::string ghost_note_;
  double cutoff_ = 0.0;       // of the list, with the skin
  double requested_ = 0.0;    // at the beginning of the run
  bool shortened_ = false;
  double reach_ = 0.0;            // without it
  double others_cutoff_ = 0.0;    // of comm_modify, before this fix set it
  double ghost_cutoff_ = 0.0;     // that this fix has set instead; 0: none
  bool changed_ = true;
  std::vector<std::pair<int, int>> unlisted_;
  GhostNumbers ghosts_;
};

}    // namespace LAMMPS_NS
#endif
