/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The atoms of a fix's group on this rank, as the core sees them.
#ifndef LMP_BDH_GROUP_H
#define LMP_BDH_GROUP_H

#include "base/particles.h"
#include "bdh_columns.h"
#include "bdh_lammps.h"
#include "bdh_move_judge.h"
#include "bdh_orientation.h"
#include "bdh_pieces_of_step.h"
#include "bdh_scene.h"
#include "pointers.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/// Keeps, by atom, what must survive an evaluation of forces within a step.  The forces within the
/// step are for this fix alone.  Those from the beginning of the step are put back afterwards,
/// since other integrators may still need them.
class StartOfStep : protected Pointers {
 public:
  StartOfStep(LAMMPS *lmp, AtomColumns &columns) : Pointers(lmp), columns_(columns) {}
  /// Call it before the columns are attached.  turn: whether particles turn.
  void add_columns(bool turn);
  /// Saves the groups, the force and torque of every atom, and the displacements of the group's
  /// atoms, 3 numbers each, and their rotations, if they turn.
  void save(const std::vector<int> &group, const std::vector<double> &displacement,
            const std::vector<double> *rotation);
  /// Puts the groups back that the atoms were in.  In some releases dynamic groups change whenever
  /// forces are evaluated, but a step is one of the same particles.
  void restore_groups() const;
  /// Puts forces and torques back, and sets displacements and rotations to those of the atoms that
  /// are in the group on this processor now.
  void restore(const std::vector<int> &group, std::vector<double> &displacement,
               std::vector<double> *rotation) const;

 private:
  void put(const AtomColumns::Column &column, const std::vector<int> &group,
           const std::vector<double> &v);
  void get(const AtomColumns::Column &column, const std::vector<int> &group,
           std::vector<double> &v) const;

  AtomColumns &columns_;
  AtomColumns::Column displacement_, rotation_, force_, torque_, mask_;
};

/// Particles in the order of LAMMPS' atoms, in the memory of the host.
class AtomGroup : public bdh::Particles, protected Pointers {
 public:
  /// name: of the fix, for messages.
  AtomGroup(LAMMPS *lmp, const std::string &name, int groupbit, const Scene &scene,
            MoveJudge &judge, AtomColumns &columns) :
      Pointers(lmp),
      name_(name), groupbit_(groupbit), scene_(scene), judge_(judge), columns_(columns),
      start_(lmp, columns), orientations_(lmp, name)
  {}
  ~AtomGroup() noexcept override {}    // newer releases let that of Pointers throw

  /// Whether particles turn, and with what; see Orientations.  Choose before anything else.
  Orientations &orientations() { return orientations_; }
  const Orientations &orientations() const { return orientations_; }
  /// Call it before the columns are attached.  forces: evaluates the forces within the step.
  void keep_start_of_step(std::unique_ptr<MidpointForces> forces);
  /// Replaces the object that evaluates forces within the step, if there is one.
  void take_forces_from(std::unique_ptr<MidpointForces> forces)
  {
    if (forces_) forces_ = std::move(forces);
  }
  /// Steps are taken in pieces.  Call it before the columns are attached.
  void take_pieces()
  {
    pieces_ = std::make_unique<PiecesOfStep>(lmp, columns_, orientations_.turn());
  }
  PiecesOfStep *pieces() const { return pieces_.get(); }    ///< null: steps are taken as a whole
  const MidpointForces *midpoint_forces() const { return forces_.get(); }
  /// Whether positions are unwrapped, as a background flow requires.
  void unwrap(bool yes) { unwrap_ = yes; }
  bool unwraps() const { return unwrap_; }

  /// Collects positions and forces of the group as they are now.
  void gather();
  /// Checks the atoms of this processor after gather().  False if a radius differs from that of the
  /// scene.  Stops the run if another fix integrates one of them.
  bool matches_scene() const;
  const Scene &scene() const { return scene_; }
  /// Local indices of the atoms, in the core's order.
  const std::vector<int> &atoms() const { return local_; }
  /// Atom id and step, for messages about the particle at an index of the core's arrays.
  std::string describe(long index) const;
  double memory() const;

  long size() const override { return local_.size(); }
  const double *x() const override { return x_.data(); }
  const double *force() const override { return force_.data(); }
  const double *torque() const override { return torque_.data(); }
  const uint64_t *ids() const override { return id_.data(); }
  void move_and_update_forces(std::vector<double> &displacement,
                              std::vector<double> *rotation) override;
  void finish(const std::vector<double> &displacement,
              const std::vector<double> &velocity) override;
  void turn(const std::vector<double> &rotation,
            const std::vector<double> &angular_velocity) override;
  void begin_piece(double part) override { pieces_->begin(local_, force_, part); }
  void end_piece(std::vector<double> &displacement, const std::vector<double> &velocity,
                 std::vector<double> *rotation,
                 const std::vector<double> &angular_velocity) override;
  const double *force_before() const override { return pieces_->force_before(local_).data(); }

 private:
  void move(const std::vector<double> &displacement);
  void judge(const double *displacement) const;

  const std::string name_;
  int groupbit_;
  const Scene &scene_;
  MoveJudge &judge_;
  AtomColumns &columns_;
  std::unique_ptr<MidpointForces> forces_;
  std::unique_ptr<PiecesOfStep> pieces_;
  StartOfStep start_;
  Orientations orientations_;
  bool unwrap_ = false;
  std::vector<int> local_;
  std::vector<uint64_t> id_;
  std::vector<double> x_, force_, torque_, moves_;
};

}    // namespace LAMMPS_NS
#endif
