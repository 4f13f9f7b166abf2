/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Warns where a pressure takes its kinetic part from velocities, and of barostats without one.
#ifndef LMP_BDH_PRESSURE_CHECK_H
#define LMP_BDH_PRESSURE_CHECK_H

#include "pointers.h"

#include <set>
#include <string>

namespace LAMMPS_NS {

/// Velocities are displacement/dt here, so a kinetic part made of them means nothing.
///
/// Thermo output does not tell which computes it uses, and fixes do so each in its own way.  What
/// they use, they evaluate, and that can be seen.
class PressureCheck : protected Pointers {
 public:
  /// name: of the fix, for messages.
  PressureCheck(LAMMPS *lmp, class Fix *fix, const std::string &name) :
      Pointers(lmp), fix_(fix), name_(name)
  {}

  /// At init: computes may have been given another temperature.
  void begin() { seen_.clear(); }
  /// Collective.  Looks at the computes that were evaluated since.
  void watch();

 private:
  bool misleads(const class Compute *) const;
  void check_barostats();
  std::string list_of_fixes() const;
  std::string remedy(const std::string &id) const;
  void warn(const std::string &computes, const std::string &remedies) const;

  class Fix *fix_;
  const std::string name_;
  std::set<std::string> seen_;      // ids of computes, in this run
  std::set<std::string> warned_;    // ids of computes and of barostats, in all runs
};

}    // namespace LAMMPS_NS
#endif
