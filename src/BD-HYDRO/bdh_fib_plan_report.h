/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// What fix bd/fib reports about its plan: lines in the log, and warnings.
#ifndef LMP_BDH_FIB_PLAN_REPORT_H
#define LMP_BDH_FIB_PLAN_REPORT_H

#include "bdh_fib_box.h"
#include "bdh_fib_engine.h"
#include "bdh_given_motions.h"
#include "bdh_orientation.h"
#include "bdh_plan_text.h"
#include "bdh_solvent.h"
#include "input/options.h"
#include "pointers.h"

#include <string>

namespace LAMMPS_NS {

/// What the user chose, as parts of the fix know it.
struct FibChoices {
  const bdh::FibOptions &options;
  const FibBox &box;
  const Solvent &solvent;
  const Orientations &orientations;
  const GivenMotions &given;
};

/// Describes in words what follows from the choices.
class FibPlanReport : protected Pointers {
 public:
  /// name: of the fix, for messages.
  FibPlanReport(LAMMPS *lmp, const std::string &name, const FibChoices &choices) :
      Pointers(lmp), name_(name), o_(choices.options), box_(choices.box), solvent_(choices.solvent),
      orientations_(choices.orientations), given_(choices.given)
  {}
  ~FibPlanReport() noexcept override {}    // newer releases let that of Pointers throw

  /// radius: hydrodynamic radius of the particles; spacing: mean one of the grid [length].
  void describe(PlanText &text, const FibEngine &engine, double radius, double spacing) const;
  /// Warns about spacings that differ, and a radius that is not the requested one.
  void warn_of_cells(double radius) const;
  /// Collective.  Warns once about radii of the atoms, which the fix does not use.
  void warn_of_radii(int groupbit, double radius);

 private:
  void describe_free_particles(PlanText &text, double radius) const;
  void describe_grid(PlanText &text, double radius, double spacing) const;
  void describe_particles(PlanText &text, double radius) const;
  std::string processes_text(const FibEngine &engine) const;
  void describe_walls(PlanText &text) const;
  void describe_scheme(PlanText &text) const;
  void describe_noise(PlanText &text) const;
  void describe_flows(PlanText &text) const;
  void describe_memory(PlanText &text, const FibEngine &engine) const;
  std::string rotation_text() const;

  const std::string name_;
  const bdh::FibOptions &o_;
  const FibBox &box_;
  const Solvent &solvent_;
  const Orientations &orientations_;
  const GivenMotions &given_;
  bool warned_radii_ = false;
};

}    // namespace LAMMPS_NS
#endif
