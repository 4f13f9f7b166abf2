// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The styles of this package, for a LAMMPS library that was built without them.
#ifndef BDH_INSTALLED_STYLES_H
#define BDH_INSTALLED_STYLES_H

#include <string>

namespace LAMMPS_NS {
class Compute;
class Fix;
class LAMMPS;
class Pair;
}    // namespace LAMMPS_NS

namespace bdh {

using NewFix = LAMMPS_NS::Fix *(*) (LAMMPS_NS::LAMMPS *, int, char **);
using NewCompute = LAMMPS_NS::Compute *(*) (LAMMPS_NS::LAMMPS *, int, char **);
using NewPair = LAMMPS_NS::Pair *(*) (LAMMPS_NS::LAMMPS *);

/// Takes one style after the other, under the name that a script uses.
class StyleTaker {
 public:
  virtual ~StyleTaker() = default;
  virtual void take_fix(const char *name, NewFix create) = 0;
  virtual void take_compute(const char *name, NewCompute create) = 0;
  virtual void take_pair(const char *name, NewPair create) = 0;
};

/// Gives all styles of the package to the taker.
void give_styles(StyleTaker &taker);

/// Classes of LAMMPS differ from release to release, so the library must be of the release that the
/// package was compiled for.  Returns an empty string if it is, else a message that names both.
/// program: what would run, for the message.
std::string other_release(LAMMPS_NS::LAMMPS *lmp, const std::string &program);

}    // namespace bdh
#endif
