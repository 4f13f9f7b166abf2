/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The plan that a fix prints at the beginning of a run.
#ifndef LMP_BDH_PLAN_TEXT_H
#define LMP_BDH_PLAN_TEXT_H

#include "bdh_lammps.h"

#include <string>

namespace LAMMPS_NS {

/// Has one line for each choice: what was chosen, and why.
class PlanText {
 public:
  /// name: of the fix; width: of the column with the names of the choices.
  PlanText(const std::string &name, int width) :
      width_(width), text_(fmt::format("{}: plan (BD-HYDRO {})\n", name, package_version()))
  {}
  void line(const char *what, const std::string &choice)
  {
    text_ += fmt::format("  {:<{}} {}\n", what, width_, choice);
  }
  const std::string &text() const { return text_; }

 private:
  int width_;
  std::string text_;
};

inline double megabytes(double bytes) { return bytes / 1048576.0; }

}    // namespace LAMMPS_NS
#endif
