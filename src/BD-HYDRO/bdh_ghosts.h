/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Numbers of particles on other processors.
#ifndef LMP_BDH_GHOSTS_H
#define LMP_BDH_GHOSTS_H

#include "pointers.h"
#include "pse/real_space.h"

#include <vector>

namespace LAMMPS_NS {

/// Numbers the particles and those of other processors that are neighbors, and sends vectors of the
/// core to them.
///
/// Particles are numbered as in the fix's group; those of other processors follow.
class GhostNumbers : public bdh::GhostExchange, protected Pointers {
 public:
  GhostNumbers(LAMMPS *lmp, class Fix *fix) : Pointers(lmp), fix_(fix) {}
  ~GhostNumbers() noexcept override {}    // that of Pointers may throw in newer releases

  /// Collective.  Numbers the particles: those of `atoms` first.
  void map(const std::vector<int> &atoms);
  /// True if the particles of map() were these atoms.
  bool are_of(const std::vector<int> &atoms) const { return atoms == mapped_; }
  /// Particles, with those of other processors.
  long all() const { return all_; }
  /// Places of atoms and ghosts among the particles; -1: none.
  const std::vector<int> &particle_of() const { return particle_of_; }

  void forward(float *vector) override;
  void forward(double *vector) override;
  /// The fix calls these in its methods of the same names.
  int pack(int n, const int *list, double *buffer) const;
  void unpack(int n, int first, const double *buffer);

 private:
  /// Numbers that go from atoms to their ghosts.
  class Message;
  class Owners;
  template <class Real> class Vector;

  void send(Message &message, int width);

  class Fix *fix_;
  std::vector<int> mapped_, particle_of_, owner_;
  long all_ = 0;
  Message *message_ = nullptr;    // on its way
};

}    // namespace LAMMPS_NS
#endif
