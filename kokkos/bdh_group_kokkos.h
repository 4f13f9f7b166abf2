/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The atoms of a group in the memory of a device, as the core sees them.
#ifndef LMP_BDH_GROUP_KOKKOS_H
#define LMP_BDH_GROUP_KOKKOS_H

#include "atom_kokkos.h"
#include "atom_masks.h"
#include "base/device_kokkos.h"
#include "base/particles.h"
#include "base/phases.h"
#include "base/rotation_kernel.h"
#include "base/ssize.h"
#include "bdh_arrays_kokkos.h"
#include "bdh_forces_kokkos.h"
#include "bdh_move_judge.h"
#include "bdh_orientation.h"
#include "bdh_scene.h"
#include "domain.h"
#include "error.h"
#include "force.h"
#include "update.h"

#include <cmath>
#include <string>

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

/// Moves the atoms by their displacements.  The index is that of a particle.
template <class DeviceType> struct MoveGroup {
  typename Arrays<DeviceType>::Positions x;
  const int *local;
  const double *displacement;
  double wall[3], below_wall[3];    // upper ends of the box if not periodic, else infinity
  KOKKOS_INLINE_FUNCTION void operator()(long p) const
  {
    const int i = local[p];
    for (int d = 0; d < 3; ++d) {
      const double moved = x(i, d) + displacement[3 * p + d];
      x(i, d) = moved >= wall[d] ? below_wall[d] : moved;
    }
  }
};

/// True for a particle that is not the same atom as before.
struct IsAnotherAtom {
  const int *local, *before;
  KOKKOS_INLINE_FUNCTION bool operator()(long p) const { return local[p] != before[p]; }
};

/// True for a particle whose radius is none of the scene.
template <class DeviceType> struct HasOtherRadius {
  typename Arrays<DeviceType>::Radii radius;
  const int *local;
  PlannedRadii planned;
  KOKKOS_INLINE_FUNCTION bool operator()(long p) const { return !planned.have(radius(local[p])); }
};
/// True for a particle that another fix integrates as well.
template <class DeviceType> struct HasBits {
  typename ArrayTypes<DeviceType>::t_int_1d mask;
  const int *local;
  int bits;
  KOKKOS_INLINE_FUNCTION bool operator()(long p) const { return mask(local[p]) & bits; }
};

/// Sets the velocities of the group.  The index is that of a particle.
template <class DeviceType> struct SetVelocities {
  typename Arrays<DeviceType>::Velocities v;
  const int *local;
  const double *velocity;
  KOKKOS_INLINE_FUNCTION void operator()(long p) const
  {
    for (int d = 0; d < 3; ++d) v(local[p], d) = velocity[3 * p + d];
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

/// Saves forces or torques of all atoms, or puts them back.  The index is that of an atom.
template <class DeviceType> struct KeepForces {
  typename Arrays<DeviceType>::Forces f;
  double *kept;
  KOKKOS_INLINE_FUNCTION void operator()(long i) const
  {
    for (int d = 0; d < 3; ++d) kept[3 * i + d] = f(i, d);
  }
};
template <class DeviceType> struct PutForcesBack {
  typename Arrays<DeviceType>::Forces f;
  const double *kept;
  KOKKOS_INLINE_FUNCTION void operator()(long i) const
  {
    for (int d = 0; d < 3; ++d) f(i, d) = kept[3 * i + d];
  }
};

/// The same for the groups of all atoms.
template <class DeviceType> struct KeepGroups {
  typename ArrayTypes<DeviceType>::t_int_1d mask;
  int *kept;
  KOKKOS_INLINE_FUNCTION void operator()(long i) const { kept[i] = mask(i); }
};
template <class DeviceType> struct PutGroupsBack {
  typename ArrayTypes<DeviceType>::t_int_1d mask;
  const int *kept;
  KOKKOS_INLINE_FUNCTION void operator()(long i) const { mask(i) = kept[i]; }
};

/// The counterpart of StartOfStep for groups, forces and torques.  They are saved before forces are
/// evaluated within the step and put back afterwards, since other integrators may still need them.
template <class DeviceType> class StartOfStepOnDevice {
 public:
  using Exec = typename DeviceType::execution_space;

  void save(AtomKokkos &atoms)
  {
    atoms.sync(space, F_MASK | TORQUE_MASK | MASK_MASK);
    mask_.resize(atoms.nlocal);
    bdh::device_for<Exec>(
        "bdh::keep", atoms.nlocal,
        KeepGroups<DeviceType>{atoms.k_mask.template view<DeviceType>(), mask_.data()});
    keep(atoms.k_f, atoms.nlocal, force_);
    if (atoms.torque_flag) keep(atoms.k_torque, atoms.nlocal, torque_);
  }
  /// Does nothing if atoms were lost.
  void restore_groups(AtomKokkos &atoms) const
  {
    if (bdh::ssize(mask_) != atoms.nlocal) return;
    atoms.sync(space, MASK_MASK);
    bdh::device_for<Exec>(
        "bdh::put_back", atoms.nlocal,
        PutGroupsBack<DeviceType>{atoms.k_mask.template view<DeviceType>(), mask_.data()});
    atoms.modified(space, MASK_MASK);
  }
  void restore(AtomKokkos &atoms) const
  {
    put_back(force_, atoms.k_f, atoms.nlocal);
    atoms.modified(space, F_MASK);
    if (!atoms.torque_flag) return;
    put_back(torque_, atoms.k_torque, atoms.nlocal);
    atoms.modified(space, TORQUE_MASK);
  }
  std::size_t memory() const
  {
    return (force_.capacity() + torque_.capacity()) * sizeof(double) +
           mask_.capacity() * sizeof(int);
  }

 private:
  using Vector = bdh::DeviceArray<double, Exec>;
  using Forces = DualArrays::DualForces;
  static constexpr ExecutionSpace space = ExecutionSpaceFromDevice<DeviceType>::space;

  static void keep(const Forces &f, long atoms, Vector &kept)
  {
    kept.resize(3 * atoms);
    bdh::device_for<Exec>("bdh::keep", atoms,
                          KeepForces<DeviceType>{f.template view<DeviceType>(), kept.data()});
  }
  static void put_back(const Vector &kept, const Forces &f, long atoms)
  {
    bdh::device_for<Exec>("bdh::put_back", atoms,
                          PutForcesBack<DeviceType>{f.template view<DeviceType>(), kept.data()});
  }

  Vector force_, torque_;
  bdh::DeviceArray<int, Exec> mask_;
};

/// moved += time velocity, by number.
struct AddMotion {
  double time;
  const double *velocity;
  double *moved;
  KOKKOS_INLINE_FUNCTION void operator()(long k) const { moved[k] += time * velocity[k]; }
};
/// turned := the rotation vector of that rotation followed by time times the angular velocity, by
/// particle.
struct AddTurn {
  double time;
  const double *angular;
  double *turned;
  KOKKOS_INLINE_FUNCTION void operator()(long p) const
  {
    double turn[3];
    for (int d = 0; d < 3; ++d) turn[d] = time * angular[3 * p + d];
    bdh::Turn::both(bdh::Turn::by(turned + 3 * p), bdh::Turn::by(turn)).vector(turned + 3 * p);
  }
};

/// The counterpart of PiecesOfStep: by particle, whose order is the same throughout a step.
template <class Exec> class PiecesOnDevice {
 public:
  using Vector = bdh::DeviceArray<double, Exec>;

  bool any() const { return any_; }
  void begin(const Vector &force, double part)
  {
    any_ = true;
    part_ = part;
    copy(1.0, force, before_);
  }
  void add(const Vector &velocity, const Vector &angular, bool turn, double dt)
  {
    add_motion(velocity, dt);
    if (turn) add_turn(angular, dt);
  }
  /// velocity over the whole step whose last piece has this one; forgets the earlier pieces.
  Vector whole(const Vector &velocity, double dt)
  {
    copy(1.0, velocity, last_velocity_);
    add_motion(velocity, dt);
    Vector whole;
    copy(1.0 / dt, moved_, whole);
    moved_.resize(0);
    return whole;
  }
  Vector whole_turn(const Vector &angular, double dt)
  {
    add_turn(angular, dt);
    Vector whole;
    copy(1.0 / dt, turned_, whole);
    turned_.resize(0);
    return whole;
  }
  const Vector &before() const { return before_; }
  const Vector &last_velocity() const { return last_velocity_; }

 private:
  static void copy(double factor, const Vector &from, Vector &to)
  {
    to.resize(from.size());
    bdh::device_for<Exec>("bdh::scale", bdh::ssize(from),
                          bdh::Scale<double>{factor, from.data(), to.data()});
  }
  void add_motion(const Vector &velocity, double dt)
  {
    make(moved_, velocity.size());
    bdh::device_for<Exec>("bdh::add_motion", bdh::ssize(velocity),
                          AddMotion{part_ * dt, velocity.data(), moved_.data()});
  }
  void add_turn(const Vector &angular, double dt)
  {
    make(turned_, angular.size());
    bdh::device_for<Exec>("bdh::add_turn", bdh::ssize(angular) / 3,
                          AddTurn{part_ * dt, angular.data(), turned_.data()});
  }
  static void make(Vector &v, std::size_t size)
  {
    if (v.size() == size) return;
    v.resize(size);
    v.clear_values();
  }

  bool any_ = false;
  double part_ = 1.0;
  Vector before_, moved_, turned_, last_velocity_;
};

/// Square of a displacement velocity * dt.
struct SquareOfMove {
  const double *velocity;
  double dt;
  KOKKOS_INLINE_FUNCTION double operator()(long p) const
  {
    const double u[3] = {dt * velocity[3 * p], dt * velocity[3 * p + 1], dt * velocity[3 * p + 2]};
    return u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
  }
};
struct LongestMove {
  SquareOfMove square;
  KOKKOS_INLINE_FUNCTION void operator()(long p, double &longest2) const
  {
    const double move2 = square(p);
    if (move2 > longest2) longest2 = move2;
  }
};
struct CountMovesBeyond {
  SquareOfMove square;
  double limit2;
  KOKKOS_INLINE_FUNCTION void operator()(long p, double &count) const
  {
    if (square(p) > limit2) count += 1.0;
  }
};
struct IsMoveOf {
  SquareOfMove square;
  double move2;
  KOKKOS_INLINE_FUNCTION bool operator()(long p) const { return square(p) >= move2; }
};

/// The data leaves the device only for messages, and for host styles that evaluate forces within
/// the step.  There is one process: atoms neither migrate nor change their order within a step, and
/// LAMMPS leaves the group as it is.
template <class DeviceType> class DeviceGroup
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

  /// name: of the fix, for messages.  orientations: null if particles do not turn.
  DeviceGroup(LAMMPS *lmp, const std::string &name, int groupbit, const Scene &scene,
              MoveJudge &judge, bool unwrap = false, const Orientations *orientations = nullptr) :
      lmp_(lmp),
      name_(name), groupbit_(groupbit), scene_(scene), judge_(judge), unwrap_(unwrap),
      orientations_(orientations && orientations->turn() ? orientations : nullptr), forces_(lmp)
  {}

  /// Collects the group as it is at the beginning of a step.
  void gather()
  {
    see_new_groups();
    collect();
  }

  /// See AtomGroup::matches_scene().
  bool matches_scene() const
  {
    const AtomKokkos &atom = atoms();
    if (scene_.other_integrators) {
      const HasBits<DeviceType> both{atom.k_mask.template view<DeviceType>(), local_.data(),
                                     scene_.other_integrators};
      const long p = bdh::device_first<Exec>("bdh::integrators", size(), both);
      if (p >= 0)
        refuse_other_integrator(lmp_, name_, scene_.other_integrators, id_.to_host()[p],
                                mask_of(p));
    }
    if (!scene_.looks_at_radii()) return true;
    const HasOtherRadius<DeviceType> other{atom.k_radius.template view<DeviceType>(), local_.data(),
                                           scene_.radii};
    return bdh::device_first<Exec>("bdh::radii", size(), other) < 0;
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

  void move_and_update_forces(Vector &displacement, Vector *rotation) override
  {
    judge_moves(displacement, 1.0);
    const long n = size(), all = atoms().nlocal;
    start_.save(atoms());
    move(displacement);
    if (rotation) rotate(*rotation);
    {
      const bdh::PhaseScope forces(bdh::Phase::forces);
      forces_.update(space);
    }
    start_.restore_groups(atoms());
    collect();
    if (atoms().nlocal != all || size() != n)
      lmp_->error->one(
          FLERR,
          "{}: {} atoms, {} of them of the group, have become {} and {} within step {}: if atoms "
          "are lost, or a fix adds or deletes some when neighbor lists are built, use .../kk/host",
          name_, all, n, atoms().nlocal, size(), lmp_->update->ntimestep);
    start_.restore(atoms());
    Exec().fence();
  }
  void begin_piece(double part) override { pieces_.begin(force_, part); }
  void end_piece(Vector &displacement, const Vector &velocity, Vector *rotation,
                 const Vector &angular_velocity) override
  {
    pieces_.add(velocity, angular_velocity, rotation, lmp_->update->dt);
    move_and_update_forces(displacement, rotation);
  }
  const double *force_before() const override { return pieces_.before().data(); }
  void keep(const Vector &numbers) override { kept_ = numbers; }
  Vector kept() override { return kept_; }    // the order has not changed
  const PiecesOnDevice<Exec> &pieces() const { return pieces_; }
  void finish(const Vector &displacement, const Vector &last_velocity) override
  {
    const Vector velocity =
        pieces_.any() ? pieces_.whole(last_velocity, lmp_->update->dt) : last_velocity;
    // Each piece is judged by itself: LAMMPS has seen the particles in between.
    if (pieces_.any())
      judge_moves(displacement, 1.0);
    else
      judge_moves(velocity, lmp_->update->dt);
    move(displacement);
    bdh::device_for<Exec>("bdh::velocities", size(),
                          SetVelocities<DeviceType>{atoms().k_v.template view<DeviceType>(),
                                                    local_.data(), velocity.data()});
    Exec().fence();
  }

  void turn(const Vector &rotation, const Vector &last_angular_velocity) override
  {
    const Vector angular_velocity =
        pieces_.any() ? pieces_.whole_turn(last_angular_velocity, lmp_->update->dt)
                      : last_angular_velocity;
    rotate(rotation);
    if (!atoms().omega_flag) return;
    bdh::device_for<Exec>("bdh::omega", size(),
                          SetVelocities<DeviceType>{atoms().k_omega.template view<DeviceType>(),
                                                    local_.data(), angular_velocity.data()});
    Exec().fence();
  }

  /// Atom id and step, for messages about a particle.
  std::string describe(long index) const
  {
    if (index < 0 || index >= size()) return "an atom of another processor";
    return fmt::format("atom {} at step {}", id_.to_host()[index], lmp_->update->ntimestep);
  }
  double memory() const
  {
    return local_.capacity() * sizeof(int) + id_.capacity() * sizeof(uint64_t) +
           (x_.capacity() + force_.capacity() + torque_.capacity()) * sizeof(double) +
           start_.memory();
  }

 private:
  static constexpr ExecutionSpace space = ExecutionSpaceFromDevice<DeviceType>::space;

  AtomKokkos &atoms() const { return *lmp_->atomKK; }

  int mask_of(long p) const
  {
    atoms().sync(Host, MASK_MASK);
    return atoms().mask[local_.to_host()[p]];
  }

  /// The commands group and set change the host's masks and radii without marking them as modified.
  /// At the beginning of a run both copies are equal, so the host's are then taken.
  void see_new_groups() const
  {
    if (lmp_->update->ntimestep > lmp_->update->firststep + 1) return;
    const AtomMask changed = atoms().radius_flag ? MASK_MASK | RADIUS_MASK : MASK_MASK;
    atoms().modified(Host, changed);
    atoms().sync(space, changed);
  }

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
    if (orientations_) {
      torque_.resize(force_.size());
      bdh::device_for<Exec>("bdh::gather_torques", size(),
                            GatherTorques<DeviceType>{atom.k_torque.template view<DeviceType>(),
                                                      local_.data(), lmp_->force->ftm2v,
                                                      torque_.data()});
    }
    Exec().fence();
  }

  /// Dipoles and quaternions turn on the host, where all releases keep them.
  void rotate(const Vector &rotation) const
  {
    if (atoms().mu_flag || atoms().ellipsoid_flag)
      orientations_->rotate(local_.to_host(), rotation.to_host());
  }

  /// x += displacement.  LAMMPS' boxes exclude their upper end, so an atom on an upper wall is put
  /// just below it.
  void move(const Vector &displacement) const
  {
    const Domain &box = *lmp_->domain;
    MoveGroup<DeviceType> move{
        atoms().k_x.template view<DeviceType>(), local_.data(), displacement.data(), {}, {}};
    for (int d = 0; d < 3; ++d) {
      move.wall[d] = box.boundary[d][1] == 1 ? box.boxhi[d] : HUGE_VAL;
      move.below_wall[d] = std::nextafter(box.boxhi[d], box.boxlo[d]);
    }
    bdh::device_for<Exec>("bdh::move", size(), move);
    Exec().fence();
  }

  /// Judges the displacements velocity * dt.
  void judge_moves(const Vector &velocity, double dt) const
  {
    const SquareOfMove square{velocity.data(), dt};
    const long lost = bdh::device_first<Exec>("bdh::lost", size(), bdh::NotFinite{velocity.data()});
    if (lost >= 0) judge_.judge(NAN, lost, 0.0);
    double longest2 = 0.0;
    if (size() > 0)
      Kokkos::parallel_reduce("bdh::longest",
                              Kokkos::RangePolicy<Exec, Kokkos::IndexType<long>>(0, size()),
                              LongestMove{square}, Kokkos::Max<double>(longest2));
    long farthest = -1;
    double long_moves = 0.0;
    const double limit2 = judge_.limit() * judge_.limit();
    if (longest2 > limit2) {
      farthest = bdh::device_first<Exec>("bdh::farthest", size(), IsMoveOf{square, longest2});
      long_moves =
          bdh::device_sum<Exec>("bdh::long_moves", size(), CountMovesBeyond{square, limit2});
    }
    judge_.judge(std::sqrt(longest2), farthest, long_moves);
  }

  LAMMPS *lmp_;
  std::string name_;
  int groupbit_;
  const Scene &scene_;
  MoveJudge &judge_;
  bool unwrap_;                         // gather unwrapped positions
  const Orientations *orientations_;    // null: nothing turns
  KokkosForces forces_;
  bdh::DeviceArray<int, Exec> local_;
  bdh::DeviceArray<uint64_t, Exec> id_;
  Vector x_, force_, torque_, kept_;
  PiecesOnDevice<Exec> pieces_;
  StartOfStepOnDevice<DeviceType> start_;    // used by schemes that evaluate forces within the step
};

}    // namespace LAMMPS_NS
#endif
