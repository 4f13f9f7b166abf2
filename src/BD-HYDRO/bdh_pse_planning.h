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

#include "bdh_plan_text.h"
#include "bdh_scene.h"
#include "bdh_solvent.h"
#include "input/options.h"
#include "pointers.h"
#include "pse/plan.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/// Chooses splitting parameter, cutoffs and grid, and says what was chosen.
class PsePlanning : protected Pointers {
 public:
  /// name: of the fix, for messages; igroup: its group; scene: will be that of the plan.
  PsePlanning(LAMMPS *lmp, const std::string &name, int igroup, const bdh::PseOptions &options,
              const Solvent &solvent, Scene &scene) :
      Pointers(lmp),
      name_(name), igroup_(igroup), options_(options), solvent_(solvent), scene_(scene)
  {}

  /// Collective, before a run.  Makes a plan, unless the last one serves; true if it has made one.
  bool prepare();
  /// Collective, when the scene has changed during a run.  As prepare(), but pairs are only known
  /// up to a distance `reach`.  Says so in the log.
  bool follow(double reach);
  /// False if the group has been empty so far, and the radius is to be that of its atoms.
  bool is_made() const { return planned_; }
  /// False if the box has changed so much that the plan may no longer serve.
  bool fits_box();

  const bdh::PsePlan &plan() const { return plan_; }
  /// What the plan was made for.
  const bdh::PseScene &made_for() const { return made_for_; }

  /// The plan, for restart files; restore() takes it up if it is one of this version.
  std::vector<char> save() const;
  void restore(const char *state, std::size_t size);

  /// Lines of the plan.  ghosts: remark on them, may be empty; grid: its bytes on this processor.
  void describe(PlanText &text, const std::string &ghosts, double grid) const;

 private:
  /// What is kept in restart files.
  struct State;

  bigint count() const;
  double common_radius(bigint particles) const;
  bdh::PseScene scene_of(bigint particles, double radius) const;
  bdh::PsePlan plan_now(const bdh::PseScene &now, double *split_price = nullptr) const;
  bool keeps_tolerance(const bdh::PseScene &now) const;
  bool serves(const bdh::PseScene &now) const;
  bool is_too_long() const;
  void adopt(const bdh::PsePlan &plan, const bdh::PseScene &now);
  void watch(bigint particles);
  bdh::PsePlan search(bdh::PseScene now);
  std::string change_since_planning(const bdh::PseScene &now) const;
  void warn() const;
  void describe_free_particles(PlanText &text) const;

  const std::string name_;
  int igroup_;
  const bdh::PseOptions &options_;
  const Solvent &solvent_;
  Scene &scene_;
  bdh::PsePlan plan_;
  bdh::PseScene made_for_;
  bool planned_ = false, restored_ = false;
  bool narrow_ = false;             // the list of a run has kept the plan from being another one
  double searched_radius_ = 0.0;    // of the last search for the splitting
  double logged_radius_ = 0.0;      // for which the log has shown a plan
  bdh::Cell known_;                 // a box for which the plan is known to serve
  double split_price_ = 0.0;    // if the splitting was chosen for scheme split: pse_split_price()
};

}    // namespace LAMMPS_NS
#endif
