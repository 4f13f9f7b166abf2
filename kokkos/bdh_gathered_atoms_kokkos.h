/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The atoms of a group in the memory of a device, gathered for the core.
#ifndef LMP_BDH_GATHERED_ATOMS_KOKKOS_H
#define LMP_BDH_GATHERED_ATOMS_KOKKOS_H

#include "atom_kokkos.h"
#include "atom_masks.h"
#include "base/device_kokkos.h"
#include "base/particles.h"
#include "base/ssize.h"
#include "bdh_arrays_kokkos.h"
#include "domain.h"
#include "force.h"
#include "update.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/// local := atoms of the group in their order; the body of a scan.
template <class DeviceType> struct SelectGroup {
  typename ArrayTypes<DeviceType>::t_int_1d mask;
  int groupbit;
  int *local;
  KOKKOS_INLINE_FUNCTION void operator()(int i, int &count, bool last) const
  {
    if (!(mask(i) & groupbit)) return;
    if (last) local[count] = i;
    ++count;
  }
};

/// Collects positions, forces and ids of the group.  The index is that of a particle.
template <class DeviceType> struct GatherGroup {
  using AT = ArrayTypes<DeviceType>;
  typename Arrays<DeviceType>::Positions x;
  typename Arrays<DeviceType>::Forces f;
  typename AT::t_imageint_1d image;
  typename AT::t_tagint_1d tag;
  const int *local;
  bool unwrap;
  double period[3], to_core;
  double *to_x, *to_force;
  uint64_t *id;
  KOKKOS_INLINE_FUNCTION void operator()(long p) const
  {
    const int i = local[p];
    const imageint boxes = image(i);
    const imageint box[3] = {(boxes & IMGMASK) - IMGMAX, (boxes >> IMGBITS & IMGMASK) - IMGMAX,
                             (boxes >> IMG2BITS) - IMGMAX};
    for (int d = 0; d < 3; ++d) {
      to_x[3 * p + d] = unwrap ? x(i, d) + box[d] * period[d] : x(i, d);
      to_force[3 * p + d] = to_core * f(i, d);
    }
    id[p] = tag(i);
  }
};

/// Torques of the group in the units of the core, and its angular velocities.  The index is that of
/// a particle.
template <class DeviceType> struct GatherTorques {
  typename Arrays<DeviceType>::Forces torque;
  const int *local;
  double to_core;
  double *to;
  KOKKOS_INLINE_FUNCTION void operator()(long p) const
  {
    for (int d = 0; d < 3; ++d) to[3 * p + d] = to_core * torque(local[p], d);
  }
};

/// True for a particle that is not the same atom as before.
struct IsAnotherAtom {
  const int *local, *before;
  KOKKOS_INLINE_FUNCTION bool operator()(long p) const { return local[p] != before[p]; }
};

/// The counterpart of GatheredAtoms.  The data leaves the device only for messages.
template <class DeviceType> class GatheredOnDevice
    : public bdh::ParticlesOf<bdh::DeviceArray<double, typename DeviceType::execution_space>> {
 public:
  using Exec = typename DeviceType::execution_space;
  using Vector = bdh::DeviceArray<double, Exec>;

  /// V_MASK: the velocities of other atoms must not be lost when those of the group are set.
  static constexpr AtomMask datamask_read =
      X_MASK | V_MASK | F_MASK | MASK_MASK | TAG_MASK | IMAGE_MASK | RADIUS_MASK;
  static constexpr AtomMask datamask_modify = X_MASK | V_MASK;

  /// What is read and modified in addition where particles turn.
  static constexpr AtomMask turning_reads = TORQUE_MASK | OMEGA_MASK;
  static constexpr AtomMask turning_modifies = OMEGA_MASK;

  /// unwrap: positions are unwrapped; turn: particles turn.
  GatheredOnDevice(LAMMPS *lmp, int groupbit, bool unwrap, bool turn) :
      lmp_(lmp), groupbit_(groupbit), unwrap_(unwrap), turn_(turn)
  {}

  /// Collects the group as it is at the beginning of a step.
  void gather()
  {
    see_new_groups();
    collect();
  }

  long size() const override { return bdh::ssize(local_); }
  const double *x() const override { return x_.data(); }
  const double *force() const override { return force_.data(); }
  const double *torque() const override { return torque_.data(); }
  const uint64_t *ids() const override { return id_.data(); }
  /// Indices of the particles' atoms.
  const int *local() const { return local_.data(); }
  /// The same on the host, whose masks are then those of the device.
  std::vector<int> atoms_on_host() const
  {
    atoms().sync(Host, MASK_MASK);
    return local_.to_host();
  }
  /// True if the particles are these atoms, in this order.
  bool consists_of(const bdh::DeviceArray<int, Exec> &atoms) const
  {
    return local_.size() == atoms.size() &&
           bdh::device_first<Exec>("bdh::group", size(),
                                   IsAnotherAtom{local_.data(), atoms.data()}) < 0;
  }

  /// Atom id and step, for messages about a particle.
  std::string describe(long index) const
  {
    if (index < 0 || index >= size()) return "an atom of another processor";
    return fmt::format("atom {} at step {}", id_.to_host()[index], lmp_->update->ntimestep);
  }

 protected:
  static constexpr ExecutionSpace space = ExecutionSpaceFromDevice<DeviceType>::space;

  AtomKokkos &atoms() const { return *lmp_->atomKK; }
  /// Collects the group as it is within a step.
  void collect()
  {
    const AtomKokkos &atom = atoms();
    local_.resize(atom.nlocal);
    int count = 0;
    Kokkos::parallel_scan(
        "bdh::group", Kokkos::RangePolicy<Exec>(0, atom.nlocal),
        SelectGroup<DeviceType>{atom.k_mask.template view<DeviceType>(), groupbit_, local_.data()},
        count);
    local_.resize(count);
    x_.resize(3 * local_.size());
    force_.resize(3 * local_.size());
    id_.resize(local_.size());
    const double *period = lmp_->domain->prd;
    bdh::device_for<Exec>("bdh::gather", size(),
                          GatherGroup<DeviceType>{atom.k_x.template view<DeviceType>(),
                                                  atom.k_f.template view<DeviceType>(),
                                                  atom.k_image.template view<DeviceType>(),
                                                  atom.k_tag.template view<DeviceType>(),
                                                  local_.data(),
                                                  unwrap_,
                                                  {period[0], period[1], period[2]},
                                                  lmp_->force->ftm2v,
                                                  x_.data(),
                                                  force_.data(),
                                                  id_.data()});
    if (turn_) {
      torque_.resize(force_.size());
      bdh::device_for<Exec>("bdh::gather_torques", size(),
                            GatherTorques<DeviceType>{atom.k_torque.template view<DeviceType>(),
                                                      local_.data(), lmp_->force->ftm2v,
                                                      torque_.data()});
    }
    Exec().fence();
  }
  /// Bytes.
  double memory_of_gathered() const
  {
    return local_.capacity() * sizeof(int) + id_.capacity() * sizeof(uint64_t) +
           (x_.capacity() + force_.capacity() + torque_.capacity()) * sizeof(double);
  }

  LAMMPS *lmp_;
  bdh::DeviceArray<int, Exec> local_;
  bdh::DeviceArray<uint64_t, Exec> id_;
  Vector x_, force_, torque_;

 private:
  /// The commands group and set change the host's masks and radii without marking them as modified.
  /// At the beginning of a run both copies are equal, so the host's are then taken.
  void see_new_groups() const
  {
    if (lmp_->update->ntimestep > lmp_->update->firststep + 1) return;
    const AtomMask changed = atoms().radius_flag ? MASK_MASK | RADIUS_MASK : MASK_MASK;
    atoms().modified(Host, changed);
    atoms().sync(space, changed);
  }

  int groupbit_;
  bool unwrap_, turn_;
};

}    // namespace LAMMPS_NS
#endif
