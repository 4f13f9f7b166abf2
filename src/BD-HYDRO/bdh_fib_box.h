/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The box of fix bd/fib: its grid, its walls, and the flow that these drive.
#ifndef LMP_BDH_FIB_BOX_H
#define LMP_BDH_FIB_BOX_H

#include "base/strain_kernel.h"
#include "fib/moving_walls.h"
#include "grid/grid.h"
#include "input/options.h"
#include "pointers.h"

#include <array>
#include <string>

namespace LAMMPS_NS {

/// Makes the grid for LAMMPS' box, which may then no longer change, and the walls on its faces.
class FibBox : protected Pointers {
 public:
  /// name: of the fix, for messages.
  FibBox(LAMMPS *lmp, const std::string &name, const bdh::FibOptions &options) :
      Pointers(lmp), name_(name), options_(options)
  {}
  ~FibBox() noexcept override {}    // newer releases let that of Pointers throw

  /// At init.  Refuses boxes that a grid cannot fill, and fixes that change the box.
  void check() const;
  /// At init.  Makes the grid and the walls of the box as it is.  True if the grid differs from the
  /// one before.  Refuses walls whose flow is not known but has to be.
  bool fit();
  /// In each step.  Stops the run if the box is no longer that of the grid, as in a run with pre
  /// no.
  void check_unchanged() const;

  const bdh::Grid &grid() const { return grid_; }
  const bdh::WallMotion &walls() const { return walls_; }
  /// Rate of strain of the background: keyword shear, or moving walls of a slit [1/time].
  bdh::Symmetric<double> strain() const;
  /// A component of the force of the background flow on the wall at a face, in the core's units.
  /// The solver of slits takes the walls to be at rest, and their known flow adds a uniform shear
  /// stress.
  double background_force(int axis, int side, int component, double viscosity) const;

 private:
  bool may_follow_atoms(int axis, int side) const;
  bdh::Grid grid_of_box() const;
  void check_flow() const;
  void check_stresslets() const;

  const std::string name_;
  const bdh::FibOptions &options_;
  bdh::Grid grid_;
  std::array<std::array<double, 2>, 3> faces_{};    // of the box that the grid was made for
  bdh::WallMotion walls_;
};

}    // namespace LAMMPS_NS
#endif
