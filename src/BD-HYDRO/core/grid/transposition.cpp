// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "grid/transposition.h"

#include "base/bytes_of.h"
#include "base/phases.h"
#include "grid/slabs.h"

#include <algorithm>
#include <complex>

namespace bdh {

namespace {

MPI_Datatype mpi_type(double) { return MPI_DOUBLE; }
MPI_Datatype mpi_type(std::complex<float>) { return MPI_C_FLOAT_COMPLEX; }
MPI_Datatype mpi_type(std::complex<double>) { return MPI_C_DOUBLE_COMPLEX; }

long total(const std::vector<PlanePart> &parts)
{
  long sum = 0;
  for (const PlanePart &part : parts) sum += part.count;
  return sum;
}

}    // namespace

template <class Element> Transposition<Element>::Transposition(const Comm &comm, long planes,
                                                               long size, PartsOfRanks parts) :
    comm_(comm),
    planes_(planes), size_(size), slab_(equal_part(planes, comm.rank(), comm.size()))
{
  deal(std::move(parts));
  if (comm.size() > 1) parcel_.resize(slab_.count * size);
}

template <class Element> void Transposition<Element>::deal(PartsOfRanks parts)
{
  parts_ = std::move(parts);
  const bool alone = comm_.size() == 1;
  pitch_ = alone ? size_ : total(own_parts());
  for (auto *v : {&parcel_counts_, &parcel_offsets_, &array_counts_, &array_offsets_}) v->clear();
  long start = 0;
  for (int r = 0; r < comm_.size(); ++r) {
    long after = 0;
    for (PlanePart &part : parts_[r]) {
      part.after = alone ? part.before : after;
      after += part.count;
    }
    const Slab theirs = equal_part(planes_, r, comm_.size());
    parcel_counts_.push_back(slab_.count * after);
    parcel_offsets_.push_back(slab_.count * start);
    array_counts_.push_back(theirs.count * pitch_);
    array_offsets_.push_back(theirs.start * pitch_);
    start += after;
  }
}

/// Calls action(place in an array, number of elements) for everything in the parcel, in its order:
/// by rank, plane and part.
template <class Element> template <class Action>
void Transposition<Element>::for_parcel(Action action) const
{
  for (const std::vector<PlanePart> &theirs : parts_)
    for (long p = 0; p < slab_.count; ++p)
      for (const PlanePart &part : theirs) action(p * size_ + part.before, part.count);
}

template <class Element> void Transposition<Element>::hand_over(Element *array)
{
  if (comm_.size() == 1) return;
  const PhaseScope handing(Phase::communicate);
  Element *to = parcel_.data();
  for_parcel([&](long place, long count) { to = std::copy_n(array + place, count, to); });
  MPI_Alltoallv(parcel_.data(), parcel_counts_.data(), parcel_offsets_.data(), mpi_type(Element()),
                array, array_counts_.data(), array_offsets_.data(), mpi_type(Element()),
                comm_.handle());
}

template <class Element> void Transposition<Element>::hand_back(Element *array)
{
  if (comm_.size() == 1) return;
  const PhaseScope handing(Phase::communicate);
  MPI_Alltoallv(array, array_counts_.data(), array_offsets_.data(), mpi_type(Element()),
                parcel_.data(), parcel_counts_.data(), parcel_offsets_.data(), mpi_type(Element()),
                comm_.handle());
  const Element *from = parcel_.data();
  for_parcel([&](long place, long count) {
    std::copy_n(from, count, array + place);
    from += count;
  });
}

template <class Element> std::size_t Transposition<Element>::memory() const
{
  return bytes_of(parcel_);
}

template class Transposition<double>;
template class Transposition<std::complex<float>>;
template class Transposition<std::complex<double>>;

}    // namespace bdh
