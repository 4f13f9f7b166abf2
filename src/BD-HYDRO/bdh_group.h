/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The particles of a fix on the host: moved, judged, and with forces within a step.
#ifndef LMP_BDH_GROUP_H
#define LMP_BDH_GROUP_H

#include "bdh_columns.h"
#include "bdh_gathered_atoms.h"
#include "bdh_lammps.h"
#include "bdh_move_judge.h"
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

/// The particles of a fix on the host: moves them, judges their moves, and evaluates forces on them
/// within a step.
class AtomGroup : public GatheredAtoms {
 public:
  /// name: of the fix, for messages.
  AtomGroup(LAMMPS *lmp, const std::string &name, int groupbit, const Scene &scene,
            MoveJudge &judge, AtomColumns &columns) :
      GatheredAtoms(lmp, name, groupbit),
      scene_(scene), judge_(judge), columns_(columns), start_(lmp, columns)
  {}
  ~AtomGroup() noexcept override {}    // newer releases let that of Pointers throw

  /// What forces are evaluated within the step for: a scheme, steps in pieces, or a comparison of a
  /// step with its halves, which keeps numbers of the particles.
  enum class ForcesFor { scheme, pieces, halves };
  /// Forces will be evaluated within the step.  Call it before the columns are attached.
  void need_forces_within_step(ForcesFor use);
  /// Replaces the object that evaluates forces within the step, if there is one.
  void take_forces_from(std::unique_ptr<MidpointForces> forces)
  {
    if (forces_) forces_ = std::move(forces);
  }
  PiecesOfStep *pieces() const { return pieces_.get(); }    ///< null: steps are taken as a whole
  const MidpointForces *midpoint_forces() const { return forces_.get(); }

  /// Checks the atoms of this processor after gather().  False if a radius differs from that of the
  /// scene.  Stops the run if another fix integrates one of them.
  bool matches_scene() const;
  const Scene &scene() const { return scene_; }
  double memory() const;

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
  void forget_piece() override { pieces_->forget(local_); }
  void keep(const std::vector<double> &numbers) override;
  std::vector<double> kept() override;

 private:
  void move(const std::vector<double> &displacement);

  const Scene &scene_;
  MoveJudge &judge_;
  AtomColumns &columns_;
  AtomColumns::Column kept_;
  std::unique_ptr<MidpointForces> forces_;
  std::unique_ptr<PiecesOfStep> pieces_;
  StartOfStep start_;
  std::vector<double> moves_;
};

}    // namespace LAMMPS_NS
#endif
