/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The plan of fix bd/pse for the box and the group as LAMMPS has them.
#ifndef LMP_BDH_PSE_PLANNING_H
#define LMP_BDH_PSE_PLANNING_H

#include "bdh_group.h"
#include "bdh_plan_text.h"
#include "bdh_solvent.h"
#include "input/options.h"
#include "pointers.h"
#include "pse/plan.h"

#include <string>

namespace LAMMPS_NS {

/// Chooses splitting parameter, cutoffs and grid, and says what was chosen.
class PsePlanning : protected Pointers {
 public:
  /// name: of the fix, for messages; igroup: its group.
  PsePlanning(LAMMPS *lmp, const std::string &name, int igroup, const bdh::PseOptions &options,
              const AtomGroup &group, const Solvent &solvent) :
      Pointers(lmp),
      name_(name), igroup_(igroup), options_(options), group_(group), solvent_(solvent)
  {}

  /// Collective.  The radius of all particles, given or of the atoms [distance].
  double common_radius() const;
  /// Collective.  Plans for particles of this radius; true if the mobility of the last plan, if
  /// any, does not fit.
  bool replan(double radius);
  const bdh::PsePlan &plan() const { return plan_; }
  /// The cell as it is now.
  bdh::Cell cell() const;
  /// What the plan depends on.
  bdh::PseScene scene() const;
  /// Lines of the plan.  ghosts: remark on them, may be empty; grid: its bytes on this processor.
  void describe(PlanText &text, const std::string &ghosts, double grid) const;

 private:
  void warn() const;
  double far_stiffness() const;
  std::string precision_reason() const;
  std::string scheme_text() const;

  const std::string name_;
  int igroup_;
  const bdh::PseOptions &options_;
  const AtomGroup &group_;
  const Solvent &solvent_;
  double radius_ = 0.0;
  bdh::PsePlan plan_;
  bool planned_ = false;
  double split_price_ = 0.0;    // if the splitting was chosen for scheme split: pse_split_price()
};

}    // namespace LAMMPS_NS
#endif
