/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Exchanges numbers of particles with other processors.
#ifndef LMP_BDH_GHOSTS_H
#define LMP_BDH_GHOSTS_H

#include "pointers.h"
#include "pse/real_space.h"

#include <vector>

namespace LAMMPS_NS {

/// Numbers this processor's particles and the neighbors that belong to other processors, and sends
/// the latter their entries of the core's vectors.
///
/// This processor's particles are numbered as in the fix's group; those of other processors follow.
class GhostNumbers : public bdh::GhostExchange, protected Pointers {
 public:
  GhostNumbers(LAMMPS *lmp, class Fix *fix) : Pointers(lmp), fix_(fix) {}
  ~GhostNumbers() noexcept override {}    // newer releases let that of Pointers throw

  /// Collective.  Numbers the particles, those of `atoms` first.
  void map(const std::vector<int> &atoms);
  /// True if map() was last called for exactly these atoms.
  bool are_of(const std::vector<int> &atoms) const { return atoms == mapped_; }
  /// Number of particles, including those of other processors.
  long all() const { return all_; }
  /// Index of the particle of each atom and ghost; -1 if it is none.
  const std::vector<int> &particle_of() const { return particle_of_; }

  void forward(float *vector, int quads) override;
  void forward(double *vector, int quads) override;
  /// The fix calls these from its methods for forward communication.  What LAMMPS then sends to
  /// other processors is counted.
  int pack(int n, const int *list, double *buffer);
  void unpack(int n, int first, const double *buffer);

 private:
  /// A set of numbers that is sent from atoms to their ghosts.
  class Message;
  class Owners;
  template <class Real> class Vector;

  void send(Message &message, int width);

  class Fix *fix_;
  std::vector<int> mapped_, particle_of_, owner_;
  long all_ = 0;
  Message *message_ = nullptr;    // being sent
  // Where the last numbers were packed, and not yet seen to be this processor's own.
  const double *packed_ = nullptr;
  int packed_bytes_ = 0;
};

}    // namespace LAMMPS_NS
#endif
