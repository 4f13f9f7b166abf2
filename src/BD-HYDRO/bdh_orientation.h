/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The orientations of a group's atoms, and what turns them.
#ifndef LMP_BDH_ORIENTATION_H
#define LMP_BDH_ORIENTATION_H

#include "input/options.h"
#include "pointers.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/// Torques, angular velocities, dipoles and quaternions of atoms in the memory of the host.
///
/// An engine knows none of these.  Where particles turn, AtomGroup hands it torques as three
/// numbers per particle beside the forces, and takes rotation vectors [radians] beside the
/// displacements, also three per particle: bdh::ParticlesOf::torque(), turn() and
/// move_and_update_forces().  An engine of fix bd/fib or bd/pse needs nothing else in order to turn
/// particles.
class Orientations : protected Pointers {
 public:
  /// name: of the fix, for messages.
  Orientations(LAMMPS *lmp, const std::string &name) : Pointers(lmp), name_(name) {}
  ~Orientations() noexcept override {}    // newer releases let that of Pointers throw

  /// In the constructor of the fix: whether the fix turns its particles.  Stops with an error if it
  /// is to do so, but the atom style leaves out what this takes.
  void choose(bdh::Rotation choice);
  bool turn() const { return turn_; }
  /// Whether the plan has a line about rotation: it has none where nothing could turn.
  bool matter() const { return turn_ || choice_ == bdh::Rotation::no; }
  /// For the plan: the choice and its reason.
  std::string text() const;

  /// Torques of these atoms in the units of the core, 3 per atom; 0 where atoms have none.
  void gather_torques(const std::vector<int> &atoms, std::vector<double> &torque) const;
  /// Turns dipoles and ellipsoids by rotation vectors, 3 per atom.  The KOKKOS package's copies are
  /// brought to the host, and marked as modified there.
  void rotate(const std::vector<int> &atoms, const std::vector<double> &rotation) const;
  /// omega := these angular velocities [radians/time], if atoms have it.
  void set_omega(const std::vector<int> &atoms, const std::vector<double> &omega) const;

 private:
  bool have_orientation() const;
  std::string what_is_missing() const;

  const std::string name_;
  bdh::Rotation choice_ = bdh::Rotation::automatic;
  bool turn_ = false;
};

}    // namespace LAMMPS_NS
#endif
