/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Warns if the kinetic part of a pressure is computed from velocities, or missing for a barostat.
#ifndef LMP_BDH_PRESSURE_CHECK_H
#define LMP_BDH_PRESSURE_CHECK_H

#include "pointers.h"

#include <set>
#include <string>

namespace LAMMPS_NS {

/// Velocities are displacement/dt here, so a kinetic part computed from them is meaningless.
///
/// Thermo output does not tell which computes it uses, and each fix uses them in its own way.  But
/// any compute that is used gets evaluated, and that can be seen.
class PressureCheck : protected Pointers {
 public:
  /// name: of the fix, for messages.
  PressureCheck(LAMMPS *lmp, class Fix *fix, const std::string &name) :
      Pointers(lmp), fix_(fix), name_(name)
  {}

  /// At init, since computes may have been given another temperature.
  void begin() { seen_.clear(); }
  /// Collective.  Looks at the computes that have been evaluated since.
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
