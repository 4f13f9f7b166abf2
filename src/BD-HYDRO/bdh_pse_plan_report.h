/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// What fix bd/pse reports about its plan: lines in the log, and warnings.
#ifndef LMP_BDH_PSE_PLAN_REPORT_H
#define LMP_BDH_PSE_PLAN_REPORT_H

#include "bdh_plan_text.h"
#include "bdh_solvent.h"
#include "input/options.h"
#include "pointers.h"
#include "pse/plan.h"

#include <string>

namespace LAMMPS_NS {

/// Where a plan comes from, and what else its lines in the log mention.
struct PsePlanDetails {
  bool restored = false;       ///< from a restart file
  double split_price = 0.0;    ///< of scheme split with xi auto: bdh::pse_split_price()
  std::string ghosts;          ///< a remark about ghosts; may be empty
  double grid_memory = 0.0;    ///< on this processor [bytes]
};

/// Describes a plan in words.
class PsePlanReport : protected Pointers {
 public:
  /// name: of the fix, for messages.
  PsePlanReport(LAMMPS *lmp, const std::string &name, const bdh::PseOptions &options,
                const Solvent &solvent) :
      Pointers(lmp),
      name_(name), options_(options), solvent_(solvent)
  {}

  void describe(PlanText &text, const bdh::PsePlan &plan, const PsePlanDetails &details) const;
  /// The line for a group without atoms, for which there is no plan yet.
  void describe_waiting(PlanText &text) const;
  /// Warns about a splitting that makes steps slow or unstable.
  void warn(const bdh::PsePlan &plan) const;
  /// Logs that another plan has been made during a run, and why.
  void log_change(const bdh::PsePlan &plan, bool is_first, const std::string &reason) const;

 private:
  void describe_free_particles(PlanText &text, const bdh::PsePlan &plan) const;
  void describe_accuracy(PlanText &text, const bdh::PsePlan &plan, bool restored) const;
  void describe_steps(PlanText &text, const bdh::PsePlan &plan) const;
  void describe_surroundings(PlanText &text, const std::string &ghosts) const;
  void describe_cost(PlanText &text, const bdh::PsePlan &plan, const PsePlanDetails &details) const;

  const std::string name_;
  const bdh::PseOptions &options_;
  const Solvent &solvent_;
};

}    // namespace LAMMPS_NS
#endif
