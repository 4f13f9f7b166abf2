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
#include "comm.h"

using namespace LAMMPS_NS;

class GhostNumbers::Message {
 public:
  virtual ~Message() = default;
  /// Numbers of an atom; returns how many.
  virtual int pack(int atom, double *buffer) const = 0;
  virtual int unpack(int ghost, const double *buffer) = 0;
};

/// Rank and number of a particle.  A ghost of a ghost may have come home again, so the owner is
/// passed on with it.
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

/// Three components of a vector of the core, which has a fourth, 0, for each particle.
template <class Real> class GhostNumbers::Vector : public GhostNumbers::Message {
 public:
  Vector(const GhostNumbers &numbers, Real *v) : numbers_(numbers), v_(v) {}
  int pack(int i, double *buffer) const override
  {
    const int p = numbers_.particle_of_[i];
    for (int c = 0; c < 3; ++c) buffer[c] = p < 0 ? 0.0 : v_[4L * p + c];
    return 3;
  }
  int unpack(int i, const double *buffer) override
  {
    const int p = numbers_.particle_of_[i];
    if (p < bdh::ssize(numbers_.mapped_)) return 3;    // an image of a particle of this processor
    for (int c = 0; c < 3; ++c) v_[4L * p + c] = buffer[c];
    v_[4L * p + 3] = Real(0);
    return 3;
  }

 private:
  const GhostNumbers &numbers_;
  Real *v_;
};

void GhostNumbers::send(Message &message, int width)
{
  const bdh::PhaseScope forwarding(bdh::Phase::communicate);
  message_ = &message;
  comm->forward_comm_fix(fix_, width);
  message_ = nullptr;
}

void GhostNumbers::forward(float *v)
{
  Vector<float> message(*this, v);
  send(message, 3);
}

void GhostNumbers::forward(double *v)
{
  Vector<double> message(*this, v);
  send(message, 3);
}

int GhostNumbers::pack(int n, const int *list, double *buffer) const
{
  int m = 0;
  for (int k = 0; k < n; ++k) m += message_->pack(list[k], buffer + m);
  return m;
}

void GhostNumbers::unpack(int n, int first, const double *buffer)
{
  int m = 0;
  for (int i = first; i < first + n; ++i) m += message_->unpack(i, buffer + m);
}

/// Images of this processor's particles get the particle's own place, the others places after them.
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
