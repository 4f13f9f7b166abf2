/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_ghosts.h"

#include "atom.h"
#include "base/phases.h"
#include "base/ssize.h"
#include "base/traffic.h"
#include "bdh_lammps.h"
#include "comm.h"

#include <algorithm>

using namespace LAMMPS_NS;

class GhostNumbers::Message {
 public:
  virtual ~Message() = default;
  /// Packs the numbers of an atom; returns how many there are.
  virtual int pack(int atom, double *buffer) const = 0;
  virtual int unpack(int ghost, const double *buffer) = 0;
};

/// Rank and number of a particle.  The owner's rank is included because the ghost of a ghost may be
/// back on its own processor.
class GhostNumbers::Owners : public GhostNumbers::Message {
 public:
  explicit Owners(GhostNumbers &numbers) : numbers_(numbers) {}
  int pack(int i, double *buffer) const override
  {
    buffer[0] = numbers_.owner_[i];
    buffer[1] = numbers_.particle_of_[i];
    return 2;
  }
  int unpack(int i, const double *buffer) override
  {
    numbers_.owner_[i] = buffer[0];
    numbers_.particle_of_[i] = buffer[1];
    return 2;
  }

 private:
  GhostNumbers &numbers_;
};

/// The numbers of the particles in a vector of the core.
template <class Real> class GhostNumbers::Vector : public GhostNumbers::Message {
 public:
  Vector(const GhostNumbers &numbers, Real *v, int quads) : numbers_(numbers), v_(v), quads_(quads)
  {}
  /// A quad has three numbers, but those of a stresslet are full.
  int width() const { return is_full() ? quads_ * bdh::quad : bdh::dim * quads_; }
  int pack(int i, double *buffer) const override
  {
    const int p = numbers_.particle_of_[i];
    for (int k = 0; k < width(); ++k) buffer[k] = p < 0 ? 0.0 : number(p, k);
    return width();
  }
  int unpack(int i, const double *buffer) override
  {
    const int p = numbers_.particle_of_[i];
    // Images of this processor's own particles share the entries of the original.
    if (p < bdh::ssize(numbers_.mapped_)) return width();
    Real *const all = v_ + static_cast<long>(p) * quads_ * bdh::quad;
    std::fill_n(all, quads_ * bdh::quad, Real(0));
    for (int k = 0; k < width(); ++k) number(p, k) = buffer[k];
    return width();
  }

 private:
  bool is_full() const { return quads_ * bdh::quad == bdh::strain_slots; }
  /// Number k of a particle.
  Real &number(long p, int k) const
  {
    return v_[p * quads_ * bdh::quad + (is_full() ? k : k / 3 * bdh::quad + k % 3)];
  }

  const GhostNumbers &numbers_;
  Real *v_;
  int quads_;
};

void GhostNumbers::send(Message &message, int width)
{
  const bdh::PhaseScope forwarding(bdh::Phase::communicate);
  message_ = &message;
  forward_numbers(*comm, fix_, width);
  message_ = nullptr;
}

void GhostNumbers::forward(float *v, int quads)
{
  Vector<float> message(*this, v, quads);
  send(message, message.width());
}

void GhostNumbers::forward(double *v, int quads)
{
  Vector<double> message(*this, v, quads);
  send(message, message.width());
}

int GhostNumbers::pack(int n, const int *list, double *buffer)
{
  int m = 0;
  for (int k = 0; k < n; ++k) m += message_->pack(list[k], buffer + m);
  packed_ = buffer;
  packed_bytes_ = m * sizeof(double);
  if (m > 0) bdh::Traffic::mine().add_message(packed_bytes_);
  return m;
}

/// LAMMPS does not send what a processor packs for itself: it unpacks that next, from where it is.
void GhostNumbers::unpack(int n, int first, const double *buffer)
{
  if (buffer == packed_ && packed_bytes_ > 0) bdh::Traffic::mine().remove_message(packed_bytes_);
  packed_ = nullptr;
  int m = 0;
  for (int i = first; i < first + n; ++i) m += message_->unpack(i, buffer + m);
}

/// Images of this processor's particles get the particle's own index; all other ghosts get the
/// indices that follow.
void GhostNumbers::map(const std::vector<int> &atoms)
{
  mapped_ = atoms;
  particle_of_.assign(atom->nlocal + atom->nghost, -1);
  for (size_t p = 0; p < atoms.size(); ++p) particle_of_[atoms[p]] = p;
  owner_.assign(particle_of_.size(), comm->me);
  Owners message(*this);
  send(message, 2);
  all_ = bdh::ssize(mapped_);
  for (int i = atom->nlocal; i < atom->nlocal + atom->nghost; ++i)
    if (particle_of_[i] >= 0 && owner_[i] != comm->me) particle_of_[i] = all_++;
}
