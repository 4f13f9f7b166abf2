/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Settings of LAMMPS that affect a neighbor list with a cutoff of its own.
#ifndef LMP_BDH_NEIGHBOR_SETTINGS_H
#define LMP_BDH_NEIGHBOR_SETTINGS_H

#include "pointers.h"
#include "pse/plan.h"

#include <string>

namespace LAMMPS_NS {

/// Checks, and adjusts where possible, the settings of the commands neighbor, neigh_modify,
/// comm_modify and atom_style for the neighbor list of a fix.
class NeighborSettings : protected Pointers {
 public:
  /// name: of the fix, for messages.
  NeighborSettings(LAMMPS *lmp, const class Fix &fix, const std::string &name) :
      Pointers(lmp), fix_(fix), name_(name)
  {}

  /// Collective.  Refuses settings that would hide pairs, or would prevent the list from having a
  /// cutoff of its own. radius: of the particles, for the advice on the skin [distance].
  void check(double radius) const;
  /// Raises LAMMPS' limit on neighbors per atom for a list with this cutoff [distance].
  void allow_neighbors(const bdh::PsePlan &plan, double cutoff) const;

 private:
  void check_list_style(double radius) const;
  void check_communication() const;
  void check_hidden_pairs() const;
  const char *group_name(int number) const;

  const Fix &fix_;
  const std::string name_;
};

}    // namespace LAMMPS_NS
#endif
