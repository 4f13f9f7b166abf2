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

#include "bdh_pse_plan_report.h"
#include "bdh_pse_plan_search.h"
#include "bdh_pse_restart.h"
#include "bdh_pse_scene.h"
#include "bdh_scene.h"
#include "bdh_solvent.h"
#include "input/options.h"
#include "pointers.h"
#include "pse/plan.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/// Chooses splitting parameter, cutoffs and grid, and decides when another choice is due.
class PsePlanning : protected Pointers {
 public:
  /// name: of the fix, for messages; igroup: its group; scene: will be that of the plan.
  PsePlanning(LAMMPS *lmp, const std::string &name, int igroup, const bdh::PseOptions &options,
              const Solvent &solvent, const Orientations &orientations, Scene &scene) :
      Pointers(lmp),
      name_(name), options_(options), scene_(scene),
      now_(lmp, name, igroup, options, solvent, orientations), search_(options, now_),
      report_(lmp, name, options, solvent)
  {}

  /// Collective, before a run.  Makes a plan if the last one does not serve; true if it has made
  /// one.
  bool prepare();
  /// Collective, when the scene has changed during a run.  Like prepare(), but pairs are only known
  /// up to a distance `reach`.  Logs the new plan.
  bool follow(double reach);
  /// False if the group has been empty so far, and the radius is to be that of its atoms.
  bool is_made() const { return planned_; }
  /// False if the box has changed so much that the plan may no longer serve.
  bool fits_box();

  const bdh::PsePlan &plan() const { return made_.plan; }
  /// What the plan was made for.
  const bdh::PseScene &made_for() const { return made_.made_for; }

  /// The plan, for restart files; restore() accepts it if it was written by this version.
  std::vector<char> save() const;
  void restore(const char *state, std::size_t size);

  /// Adds the lines of the plan.  ghosts: a remark on them, may be empty; grid: its size on this
  /// processor [bytes].
  void describe(PlanText &text, const std::string &ghosts, double grid) const;

 private:
  bool keeps_tolerance(const bdh::PseScene &now) const;
  Radii planned_radii() const;
  bool serves(const bdh::PseScene &now) const;
  void adopt(const bdh::PsePlan &plan, const bdh::PseScene &now);
  bool replace(const bdh::PseScene &now, double reach);
  void watch(bigint particles);
  std::string change_since_planning(const bdh::PseScene &now) const;

  const std::string name_;
  const bdh::PseOptions &options_;
  Scene &scene_;
  PseSceneReader now_;
  PsePlanSearch search_;
  PsePlanReport report_;
  PseRestart made_;
  bool planned_ = false, restored_ = false;
  double logged_radius_ = 0.0;    // for which the log has shown a plan
  bdh::Cell known_;               // a box for which the plan is known to serve
};

}    // namespace LAMMPS_NS
#endif
