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
#include "grid/fft.h"

#include <string>

namespace LAMMPS_NS {

/// Has one line for each choice: what was chosen, and why.
class PlanText {
 public:
  /// name: of the fix; width: of the column with the names of the choices.
  PlanText(const std::string &name, int width) :
      width_(width), text_(fmt::format("{}: plan (BD-HYDRO {})\n", name, package_version()))
  {}
  void line(const char *what, const std::string &choice) { add(text_, what, choice); }
  /// A line that changes from step to step.  It is printed below the others, but does not make
  /// another plan.
  void state(const char *what, const std::string &now) { add(state_, what, now); }
  const std::string &text() const { return text_; }
  const std::string &state_text() const { return state_; }

 private:
  void add(std::string &text, const char *what, const std::string &choice) const
  {
    text += fmt::format("  {:<{}} {}\n", what, width_, choice);
  }

  int width_;
  std::string text_, state_;
};

/// How the grid of so many processes is dealt to them.  grid: with the axes in the solver's order.
inline std::string layout_text(const bdh::Grid &grid, const bdh::FftSetup &fft, int processes)
{
  const int share =
      fft.share == bdh::GridParts::automatic ? bdh::best_share(grid, processes) : fft.share;
  return share == 1 ? "the grid in slabs"
                    : fmt::format("the grid in pencils, {} in each slab of planes", share);
}

inline double megabytes(double bytes) { return bytes / 1048576.0; }

}    // namespace LAMMPS_NS
#endif
