/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The timing table that a fix prints at the end of a run, and what its steps have sent.
#ifndef LMP_BDH_TIMING_H
#define LMP_BDH_TIMING_H

#include "base/phases.h"
#include "base/traffic.h"
#include "pointers.h"

#include <string>

namespace LAMMPS_NS {

/// Seconds of a run by phase, and its messages, on this rank.  LAMMPS includes all of the seconds
/// in Modify.
class TimingTable : protected Pointers {
 public:
  explicit TimingTable(LAMMPS *lmp) : Pointers(lmp) {}
  void clear()
  {
    times_.fill(0.0);
    traffic_ = {};
  }
  /// Adds the time that body() takes: to the phases that it names, and the rest to `other`.  Adds
  /// what it sends.
  template <class Body> void measure(Body body)
  {
    const bdh::PhaseTimes before = bdh::PhaseClock::mine().times();
    const bdh::Traffic sent = bdh::Traffic::mine();
    {
      const bdh::PhaseScope rest(bdh::Phase::other);
      body();
    }
    const bdh::PhaseTimes &after = bdh::PhaseClock::mine().times();
    for (size_t p = 0; p < times_.size(); ++p) times_[p] += after[p] - before[p];
    traffic_.add(bdh::Traffic::mine().since(sent));
  }
  /// Collective.  Prints the table, and on several ranks a line about messages, unless the run or
  /// the timer command turns statistics off.
  void show(const char *id, const char *style) const;

 private:
  bool is_silent_run() const;
  std::string line(int phase, double all) const;
  std::string traffic_line() const;

  bdh::PhaseTimes times_{};
  bdh::Traffic traffic_;
};

}    // namespace LAMMPS_NS
#endif
