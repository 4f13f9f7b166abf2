/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The atoms of a group on this rank, gathered for the core.
#ifndef LMP_BDH_GATHERED_ATOMS_H
#define LMP_BDH_GATHERED_ATOMS_H

#include "base/particles.h"
#include "bdh_orientation.h"
#include "pointers.h"

#include <cstdint>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/// What the core reads of particles, in the order of LAMMPS' atoms, in the memory of the host and
/// in the core's units.  A derived class moves them.
class GatheredAtoms : public bdh::Particles, protected Pointers {
 public:
  /// name: of the fix, for messages.
  GatheredAtoms(LAMMPS *lmp, const std::string &name, int groupbit) :
      Pointers(lmp), name_(name), orientations_(lmp, name), groupbit_(groupbit)
  {}
  ~GatheredAtoms() noexcept override {}    // newer releases let that of Pointers throw

  /// Whether particles turn, and with what; see Orientations.  Choose before anything else.
  Orientations &orientations() { return orientations_; }
  const Orientations &orientations() const { return orientations_; }
  /// Whether positions are unwrapped, as a background flow requires.
  void unwrap(bool yes) { unwrap_ = yes; }
  bool unwraps() const { return unwrap_; }

  /// Collects positions, forces and torques of the group as they are now.
  void gather();
  /// Local indices of the atoms, in the core's order.
  const std::vector<int> &atoms() const { return local_; }
  const std::vector<int> &atoms_on_host() const { return local_; }    ///< see DeviceGroup
  /// Atom id and step, for messages about the particle at an index of the core's arrays.
  std::string describe(long index) const;

  long size() const override { return local_.size(); }
  const double *x() const override { return x_.data(); }
  const double *force() const override { return force_.data(); }
  const double *torque() const override { return torque_.data(); }
  const uint64_t *ids() const override { return id_.data(); }

 protected:
  /// Bytes.
  double memory_of_gathered() const;

  const std::string name_;
  Orientations orientations_;
  std::vector<int> local_;
  std::vector<double> x_, force_, torque_;

 private:
  int groupbit_;
  bool unwrap_ = false;
  std::vector<uint64_t> id_;
};

}    // namespace LAMMPS_NS
#endif
