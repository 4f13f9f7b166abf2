/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The particles of a fix on a device: moved, judged, and with forces within a step.
#ifndef LMP_BDH_GROUP_KOKKOS_H
#define LMP_BDH_GROUP_KOKKOS_H

#include "atom_kokkos.h"
#include "atom_masks.h"
#include "base/constraint_kernel.h"
#include "base/device_kokkos.h"
#include "base/phases.h"
#include "base/pieces.h"
#include "base/rotation_kernel.h"
#include "base/ssize.h"
#include "bdh_arrays_kokkos.h"
#include "bdh_forces_kokkos.h"
#include "bdh_gathered_atoms_kokkos.h"
#include "bdh_move_judge.h"
#include "bdh_orientation.h"
#include "bdh_scene.h"
#include "domain.h"
#include "error.h"
#include "update.h"

#include <cmath>
#include <string>

namespace LAMMPS_NS {

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
    copy(1.0, moved_, moved_before_);
    copy(1.0, turned_, turned_before_);
    add_motion(velocity, dt);
    if (turn) add_turn(angular, dt);
  }
  /// Takes away what the last piece has added.
  void forget()
  {
    copy(1.0, moved_before_, moved_);
    copy(1.0, turned_before_, turned_);
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
                          bdh::AddScaledNumber{part_ * dt, velocity.data(), moved_.data()});
  }
  void add_turn(const Vector &angular, double dt)
  {
    make(turned_, angular.size());
    bdh::device_for<Exec>("bdh::add_turn", bdh::ssize(angular) / 3,
                          bdh::AddTurn{part_ * dt, angular.data(), turned_.data()});
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
  Vector moved_before_, turned_before_;    // the last piece
};

/// Square of a displacement velocity * dt.
struct SquareOfMove {
  bdh::SquareOfLength square;
  double dt;
  KOKKOS_INLINE_FUNCTION double operator()(long p) const { return dt * dt * square(p); }
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

/// The data leaves the device only for messages, and for host styles that evaluate forces within
/// the step.  These are evaluated on one process only: atoms neither migrate nor change their order
/// within a step, and LAMMPS leaves the group as it is.
template <class DeviceType> class DeviceGroup : public GatheredOnDevice<DeviceType> {
 public:
  using Base = GatheredOnDevice<DeviceType>;
  using Base::size;
  using typename Base::Exec;
  using typename Base::Vector;

  /// name: of the fix, for messages.  orientations: null if particles do not turn.
  DeviceGroup(LAMMPS *lmp, const std::string &name, int groupbit, const Scene &scene,
              MoveJudge &judge, bool unwrap = false, const Orientations *orientations = nullptr) :
      Base(lmp, groupbit, unwrap, orientations && orientations->turn()),
      name_(name), scene_(scene), judge_(judge), orientations_(orientations), forces_(lmp)
  {}

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
    this->collect();
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
  void forget_piece() override { pieces_.forget(); }
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

  double memory() const { return this->memory_of_gathered() + start_.memory(); }

 private:
  using Base::atoms;
  using Base::force_;
  using Base::id_;
  using Base::lmp_;
  using Base::local_;
  using Base::space;

  int mask_of(long p) const
  {
    atoms().sync(Host, MASK_MASK);
    return atoms().mask[local_.to_host()[p]];
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
    const SquareOfMove square{{velocity.data()}, dt};
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

  const std::string name_;
  const Scene &scene_;
  MoveJudge &judge_;
  const Orientations *orientations_;    // null: nothing turns
  KokkosForces forces_;
  Vector kept_;
  PiecesOnDevice<Exec> pieces_;
  StartOfStepOnDevice<DeviceType> start_;    // used by schemes that evaluate forces within the step
};

}    // namespace LAMMPS_NS
#endif
