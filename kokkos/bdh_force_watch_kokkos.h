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
#include "base/execution_kokkos.h"
#include "bdh_arrays_kokkos.h"
#include "bdh_group_kokkos.h"
#include "bdh_stiffness.h"
#include "force.h"

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

/// For one process, whose atoms may change their order between the two calls.  The fix keeps no
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

  SeenStiffness compare(const bdh::StiffnessScale &scale, bool radii) override
  {
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
                               kept_tag_.data(), places(n), lmp_->force->ftm2v, before_.data(),
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
  /// Where the atom of each tag was; null if all are where they were.
  const int *places(long n)
  {
    const long kept = bdh::ssize(kept_tag_);
    if (n == kept && bdh::device_first<Exec>("bdh::has_moved", n,
                                             HasMoved<DeviceType>{tags(), kept_tag_.data()}) < 0)
      return nullptr;
    const double greatest =
        bdh::device_greatest<Exec>("bdh::greatest_tag", n, TagOf<DeviceType>{tags()});
    const double before =
        bdh::device_greatest<Exec>("bdh::greatest_tag", kept, KeptTag{kept_tag_.data()});
    place_.resize(1 + static_cast<long>(greatest > before ? greatest : before));
    bdh::device_for<Exec>("bdh::places", bdh::ssize(place_), SetPlace{place_.data()});
    bdh::device_for<Exec>("bdh::places", kept, FindPlace{kept_tag_.data(), place_.data()});
    return place_.data();
  }
  LAMMPS *lmp_;
  int groupbit_;
  const DeviceGroup<DeviceType> &group_;
  bdh::DeviceArray<double, Exec> kept_, kept_velocity_, before_, after_, velocity_, radius_;
  bdh::DeviceArray<tagint, Exec> kept_tag_;
  bdh::DeviceArray<int, Exec> place_;
};

}    // namespace LAMMPS_NS
#endif
