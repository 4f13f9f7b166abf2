/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The search for a plan of fix bd/pse, which is repeated only when it may find a cheaper one.
#ifndef LMP_BDH_PSE_PLAN_SEARCH_H
#define LMP_BDH_PSE_PLAN_SEARCH_H

#include "bdh_pse_restart.h"
#include "bdh_pse_scene.h"
#include "input/options.h"
#include "pse/plan.h"

namespace LAMMPS_NS {

/// True if neither number exceeds the other by more than a factor.
inline bool is_within(double factor, double a, double b)
{
  return a <= factor * b && b <= factor * a;
}
/// A plan is kept while the number of particles and the volume are within this factor of those it
/// was made for.  Outside of that range another plan would be cheaper.
constexpr double wide = 2.0;

/// Searches for the cheapest splitting, or takes over that of the plan in use.
class PsePlanSearch {
 public:
  /// now: reads the scene for which plans are made.
  PsePlanSearch(const bdh::PseOptions &options, const PseSceneReader &now) :
      options_(options), now_(now)
  {}

  /// Collective.  The cheapest plan.  split_price: of scheme split, see bdh::pse_split_price(); may
  /// be null.
  bdh::PsePlan cheapest(const bdh::PseScene &now, double *split_price);
  /// Collective.  A plan within a run, in place of the one in use (null: there is none).  A search
  /// takes 0.1 s, so radii that grow step by step keep the plan for a while, and the splitting for
  /// longer; so do boxes that change.  A splitting that the user gives is kept as long as its pairs
  /// are within the list.
  bdh::PsePlan again(const PseRestart *in_use, bdh::PseScene now);
  /// The plan in use was searched for in this scene.
  void remember(const bdh::PseScene &scene) { searched_ = scene; }

 private:
  bdh::PsePlan plan_for(const bdh::PseScene &now, double *split_price = nullptr) const;
  bool is_like_last(const PseRestart *in_use, const bdh::PseScene &now) const;

  const bdh::PseOptions &options_;
  const PseSceneReader &now_;
  bdh::PseScene searched_;    // that of the last search for the splitting
};

}    // namespace LAMMPS_NS
#endif
