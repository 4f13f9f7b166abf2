/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Keyword check: the error that is actually achieved.
#ifndef LMP_BDH_TOLERANCE_CHECK_H
#define LMP_BDH_TOLERANCE_CHECK_H

#include "bdh_pse_engine.h"
#include "pointers.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/// Compares the mobility and the noise of fix bd/pse with those of a much more accurate solve, for
/// the present particles.
class ToleranceCheck : protected Pointers {
 public:
  /// name: of the fix, for messages.
  ToleranceCheck(LAMMPS *lmp, const std::string &name) : Pointers(lmp), name_(name) {}

  /// Plans the reference solve, to a hundredth of the tolerance.  It uses pairs within the neighbor
  /// list of `plan` if possible, else within a longer one.
  void prepare(const bdh::PsePlan &plan, bdh::PseScene scene);
  /// True after prepare().
  bool is_ready() const { return ready_; }
  /// The plan has changed.
  void expire() { ready_ = false; }
  /// Cutoff that the neighbor list must have for the reference solve [distance].
  double cutoff() const { return reference_.r_cut; }
  /// Collective.  Prints the errors, and warns if one of them exceeds the tolerance. step: the
  /// present one; its kT is 0 at temperature 0.
  void run(PseEngine &engine, AtomGroup &group, const bdh::PseStepPlan &step);

 private:
  double norm(const std::vector<double> &v) const;
  double difference(std::vector<double> u, const std::vector<double> &exact) const;
  void compare(const std::string &what, const std::vector<double> &u,
               const std::vector<double> &exact);
  void report(const std::string &what, double achieved);
  std::vector<double> present_loads(const AtomGroup &group) const;
  std::vector<double> random_loads(const AtomGroup &group, uint32_t seed) const;

  const std::string name_;
  bdh::PsePlan plan_, reference_;
  bool turns_ = false;
  std::string text_;
  double worst_ = 0.0;
  bool ready_ = false;
};

}    // namespace LAMMPS_NS
#endif
