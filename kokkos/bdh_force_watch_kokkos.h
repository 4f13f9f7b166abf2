/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The forces at the beginning of a step in the memory of a device.
#ifndef LMP_BDH_FORCE_WATCH_KOKKOS_H
#define LMP_BDH_FORCE_WATCH_KOKKOS_H

#include "atom_kokkos.h"
#include "base/comm.h"
#include "base/execution_kokkos.h"
#include "bdh_arrays_kokkos.h"
#include "bdh_group_kokkos.h"
#include "bdh_stiffness.h"
#include "comm.h"
#include "force.h"

#include <cmath>
#include <vector>

namespace LAMMPS_NS {

/// Forces of the group, zeros of other atoms, and who they are; by atom.
template <class DeviceType> struct KeepGroupForces {
  typename Arrays<DeviceType>::Forces f;
  typename ArrayTypes<DeviceType>::t_int_1d mask;
  typename ArrayTypes<DeviceType>::t_tagint_1d tag;
  int groupbit;
  double *kept;
  tagint *kept_tag;    // 0: not of the group
  KOKKOS_INLINE_FUNCTION void operator()(long i) const
  {
    for (int d = 0; d < 3; ++d) kept[3 * i + d] = f(i, d);
    kept_tag[i] = mask(i) & groupbit ? tag(i) : 0;
  }
};
/// The same of a piece of the step, by particle, with the velocity in that piece.
struct KeepPiece {
  const int *local;
  const double *before, *velocity;
  double from_core;
  double *kept, *kept_velocity;
  KOKKOS_INLINE_FUNCTION void operator()(long p) const
  {
    for (int d = 0; d < 3; ++d) {
      kept[3 * local[p] + d] = from_core * before[3 * p + d];
      kept_velocity[3 * local[p] + d] = velocity[3 * p + d];
    }
  }
};
template <class DeviceType> struct TagOf {
  typename ArrayTypes<DeviceType>::t_tagint_1d tag;
  KOKKOS_INLINE_FUNCTION double operator()(long i) const { return tag(i); }
};
struct KeptTag {
  const tagint *tag;
  KOKKOS_INLINE_FUNCTION double operator()(long i) const { return tag[i]; }
};
/// True for an atom of the group that was at another place, or is new.
template <class DeviceType> struct HasMoved {
  typename ArrayTypes<DeviceType>::t_tagint_1d tag;
  const tagint *kept_tag;
  KOKKOS_INLINE_FUNCTION bool operator()(long i) const
  {
    return kept_tag[i] != 0 && kept_tag[i] != tag(i);
  }
};
struct SetPlace {
  int *place;
  KOKKOS_INLINE_FUNCTION void operator()(long tag) const { place[tag] = -1; }
};
struct FindPlace {
  const tagint *kept_tag;
  int *place;
  KOKKOS_INLINE_FUNCTION void operator()(long i) const
  {
    if (kept_tag[i] > 0) place[kept_tag[i]] = i;
  }
};
template <class DeviceType> struct MarkHere {
  typename ArrayTypes<DeviceType>::t_tagint_1d tag;
  char *here;
  KOKKOS_INLINE_FUNCTION void operator()(long i) const { here[tag(i)] = 1; }
};
/// 1 for an atom of the group that is no longer on this processor, else 0.
struct HasLeft {
  const tagint *kept_tag;
  const char *here;
  KOKKOS_INLINE_FUNCTION double operator()(long i) const
  {
    return kept_tag[i] != 0 && !here[kept_tag[i]];
  }
};
/// Numbers of an atom that has left: its tag and its force.
constexpr int record = 4;
struct PackLeft {
  HasLeft left;
  const double *kept;
  int *counter;
  double *records;
  KOKKOS_INLINE_FUNCTION void operator()(long i) const
  {
    if (left(i) == 0.0) return;
    double *const to = records + record * Kokkos::atomic_fetch_add(counter, 1);
    to[0] = left.kept_tag[i];
    for (int d = 0; d < 3; ++d) to[1 + d] = kept[3 * i + d];
  }
};
/// What was kept, and records behind it; those of atoms that are not here do no harm.
struct AppendLeft {
  long before;
  const tagint *kept_tag;
  const double *kept, *records;
  tagint *tag;
  double *force;
  KOKKOS_INLINE_FUNCTION void operator()(long i) const
  {
    const double *const from = records + record * (i - before);
    tag[i] = i < before ? kept_tag[i] : static_cast<tagint>(from[0]);
    for (int d = 0; d < 3; ++d) force[3 * i + d] = i < before ? kept[3 * i + d] : from[1 + d];
  }
};
/// Both forces and the velocity of an atom; zeros if it was not of the group.
template <class DeviceType> struct BothForces {
  typename Arrays<DeviceType>::Forces f;
  typename Arrays<DeviceType>::Velocities v;
  typename ArrayTypes<DeviceType>::t_tagint_1d tag;
  const double *kept, *kept_velocity;    // kept_velocity: or null
  const tagint *kept_tag;
  const int *place;    // of each tag, or null
  double to_core;
  double *before, *after, *velocity;
  KOKKOS_INLINE_FUNCTION void operator()(long i) const
  {
    const long was = place ? place[tag(i)] : i;
    const bool mine = was >= 0 && kept_tag[was] == tag(i);
    for (int d = 0; d < 3; ++d) {
      before[3 * i + d] = mine ? to_core * kept[3 * was + d] : 0.0;
      after[3 * i + d] = mine ? to_core * f(i, d) : 0.0;
      velocity[3 * i + d] = !kept_velocity ? v(i, d) : mine ? kept_velocity[3 * was + d] : 0.0;
    }
  }
};
template <class DeviceType> struct CopyRadius {
  typename Arrays<DeviceType>::Radii radius;
  double *to;
  KOKKOS_INLINE_FUNCTION void operator()(long i) const { to[i] = radius(i); }
};

/// Atoms may change their order and their processors between the two calls.  The fix keeps no
/// numbers by atom for this, since LAMMPS would take them along on the host.
template <class DeviceType> class DeviceForceWatch : public ForceWatch {
 public:
  using Exec = typename DeviceType::execution_space;

  DeviceForceWatch(LAMMPS *lmp, int groupbit, const DeviceGroup<DeviceType> &group) :
      lmp_(lmp), groupbit_(groupbit), group_(group)
  {}

  void keep() override
  {
    const long n = atoms().nlocal;
    kept_.resize(3 * n);
    kept_tag_.resize(n);
    bdh::device_for<Exec>("bdh::keep_forces", n,
                          KeepGroupForces<DeviceType>{atoms().k_f.template view<DeviceType>(),
                                                      atoms().k_mask.template view<DeviceType>(),
                                                      tags(), groupbit_, kept_.data(),
                                                      kept_tag_.data()});
    kept_velocity_.resize(0);
    if (group_.pieces().any()) keep_piece(n);
  }

  /// Collective on several processes.
  SeenStiffness compare(const bdh::StiffnessScale &scale, bool radii) override
  {
    if (lmp_->comm->nprocs > 1) follow_migrants();
    const long n = atoms().nlocal;
    before_.resize(3 * n);
    after_.resize(3 * n);
    velocity_.resize(3 * n);
    radius_.resize(radii ? n : 0);
    bdh::device_for<Exec>(
        "bdh::both_forces", n,
        BothForces<DeviceType>{atoms().k_f.template view<DeviceType>(),
                               atoms().k_v.template view<DeviceType>(), tags(), kept_.data(),
                               kept_velocity_.empty() ? nullptr : kept_velocity_.data(),
                               kept_tag_.data(), places(), lmp_->force->ftm2v, before_.data(),
                               after_.data(), velocity_.data()});
    if (radii)
      bdh::device_for<Exec>(
          "bdh::copy_radius", n,
          CopyRadius<DeviceType>{atoms().k_radius.template view<DeviceType>(), radius_.data()});
    SeenStiffness seen;
    seen.step = bdh::stiffness_of_step(
        bdh::DeviceExecution<Exec>(), n,
        {scale, before_.data(), after_.data(), velocity_.data(), radii ? radius_.data() : nullptr});
    if (seen.step.stiffest >= 0) seen.atom = tag_of(seen.step.stiffest);
    return seen;
  }

 private:
  bool all_are_where_they_were() const
  {
    const long n = atoms().nlocal;
    return n == bdh::ssize(kept_tag_) &&
           bdh::device_first<Exec>("bdh::has_moved", n,
                                   HasMoved<DeviceType>{tags(), kept_tag_.data()}) < 0;
  }
  /// Appends what is kept of atoms that have left their processors, which are few and do so only
  /// when neighbor lists are built.  On several processes steps are not taken in pieces.
  void follow_migrants()
  {
    if (!bdh::any_rank(bdh::Comm(lmp_->world), !all_are_where_they_were())) return;
    const long kept = bdh::ssize(kept_tag_);
    here_.resize(1 + greatest_tag());
    here_.clear_values();
    bdh::device_for<Exec>("bdh::mark_here", atoms().nlocal,
                          MarkHere<DeviceType>{tags(), here_.data()});
    const HasLeft left{kept_tag_.data(), here_.data()};
    const bdh::DeviceExecution<Exec> execution;
    records_.resize(record * std::lround(execution.sum("bdh::has_left", kept, left)));
    counter_.resize(1);
    counter_.clear_values();
    bdh::device_for<Exec>("bdh::pack_left", kept,
                          PackLeft{left, kept_.data(), counter_.data(), records_.data()});
    const std::vector<double> all = of_all_ranks(records_.to_host());
    records_.assign(all.data(), all.size());
    const long more = bdh::ssize(all) / record;
    bdh::DeviceArray<tagint, Exec> tag;
    bdh::DeviceArray<double, Exec> force;
    tag.resize(kept + more);
    force.resize(3 * (kept + more));
    bdh::device_for<Exec>("bdh::append_left", kept + more,
                          AppendLeft{kept, kept_tag_.data(), kept_.data(), records_.data(),
                                     tag.data(), force.data()});
    kept_tag_.swap(tag);
    kept_.swap(force);
  }
  std::vector<double> of_all_ranks(const std::vector<double> &mine) const
  {
    const int ranks = lmp_->comm->nprocs, count = mine.size();
    std::vector<int> counts(ranks);
    MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, lmp_->world);
    const bdh::MessageSizes sizes(counts, 1);
    std::vector<double> all(sizes.total());
    MPI_Allgatherv(mine.data(), count, MPI_DOUBLE, all.data(), sizes.count.data(),
                   sizes.offset.data(), MPI_DOUBLE, lmp_->world);
    return all;
  }
  void keep_piece(long atoms)
  {
    kept_velocity_.resize(3 * atoms);
    const PiecesOnDevice<Exec> &pieces = group_.pieces();
    bdh::device_for<Exec>("bdh::keep_piece", group_.size(),
                          KeepPiece{group_.local(), pieces.before().data(),
                                    pieces.last_velocity().data(), 1.0 / lmp_->force->ftm2v,
                                    kept_.data(), kept_velocity_.data()});
  }
  AtomKokkos &atoms() const { return *lmp_->atomKK; }
  auto tags() const { return atoms().k_tag.template view<DeviceType>(); }
  tagint tag_of(long i) const
  {
    tagint tag = 0;
    Kokkos::deep_copy(tag, Kokkos::subview(tags(), i));
    return tag;
  }
  /// Of the atoms here, and of those that were.
  long greatest_tag() const
  {
    const double now =
        bdh::device_greatest<Exec>("bdh::greatest_tag", atoms().nlocal, TagOf<DeviceType>{tags()});
    const double before = bdh::device_greatest<Exec>("bdh::greatest_tag", bdh::ssize(kept_tag_),
                                                     KeptTag{kept_tag_.data()});
    return static_cast<long>(now > before ? now : before);
  }
  /// Where the atom of each tag was; null if all are where they were.
  const int *places()
  {
    const long kept = bdh::ssize(kept_tag_);
    if (all_are_where_they_were()) return nullptr;
    place_.resize(1 + greatest_tag());
    bdh::device_for<Exec>("bdh::places", bdh::ssize(place_), SetPlace{place_.data()});
    bdh::device_for<Exec>("bdh::places", kept, FindPlace{kept_tag_.data(), place_.data()});
    return place_.data();
  }
  LAMMPS *lmp_;
  int groupbit_;
  const DeviceGroup<DeviceType> &group_;
  bdh::DeviceArray<double, Exec> kept_, kept_velocity_, before_, after_, velocity_, radius_;
  bdh::DeviceArray<double, Exec> records_;
  bdh::DeviceArray<tagint, Exec> kept_tag_;
  bdh::DeviceArray<int, Exec> place_, counter_;
  bdh::DeviceArray<char, Exec> here_;
};

}    // namespace LAMMPS_NS
#endif
