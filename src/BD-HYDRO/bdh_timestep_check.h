/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Keyword check dt of a fix: its first step compared with two halves of it.
#ifndef LMP_BDH_TIMESTEP_CHECK_H
#define LMP_BDH_TIMESTEP_CHECK_H

#include "base/pieces.h"
#include "bdh_group.h"
#include "pointers.h"

#include <string>

namespace LAMMPS_NS {

/// Decides when a step is compared with its halves, and reports how far apart they end.
class TimestepCheck : protected Pointers {
 public:
  /// name: of the fix, for messages.
  TimestepCheck(LAMMPS *lmp, const std::string &name) : Pointers(lmp), name_(name) {}
  ~TimestepCheck() noexcept override {}    // newer releases let that of Pointers throw

  /// Makes the comparison at the beginning of each run.  Call it before the columns of the group
  /// are attached.
  void ask(AtomGroup &group);
  bool is_asked() const { return asked_; }
  void begin_run() { due_ = asked_; }
  /// True once in a run: at its first step, not at setup, since thermo output at the beginning of a
  /// run needs the energies of the last forces that LAMMPS has computed.
  bool is_due();
  /// radius: the least of the particles.
  void report(const bdh::StepAgainstHalves &found, double radius) const;

 private:
  const std::string name_;
  bool asked_ = false, due_ = false;
};

}    // namespace LAMMPS_NS
#endif
