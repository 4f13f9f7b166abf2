/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_group.h"

#include "atom.h"
#include "base/phases.h"
#include "bdh_lammps.h"
#include "bdh_lammps_classes.h"
#include "domain.h"
#include "update.h"

#include <cmath>

using namespace LAMMPS_NS;

namespace {

/// The coordinate where an atom ends its step.  LAMMPS' boxes exclude their upper end and would
/// lose an atom on an upper wall, so it is moved just below the wall.  A face that is
/// shrink-wrapped goes along with the atoms.
double inside(const Domain &box, int d, double x)
{
  const bool fixed = box.boundary[d][1] == 1;
  return fixed && x >= box.boxhi[d] ? std::nextafter(box.boxhi[d], box.boxlo[d]) : x;
}

}    // namespace

/* ----------------------------------------------------------------------
   the beginning of a step
------------------------------------------------------------------------- */

void StartOfStep::add_columns(bool turn)
{
  displacement_ = columns_.add(3);
  rotation_ = columns_.add(turn ? 3 : 0);
  force_ = columns_.add(3);
  torque_ = columns_.add(3);
  mask_ = columns_.add(1);
}

void StartOfStep::save(const std::vector<int> &group, const std::vector<double> &displacement,
                       const std::vector<double> *rotation)
{
  for (int i = 0; i < atom->nlocal; ++i) {
    columns_.of(mask_, i)[0] = atom->mask[i];
    for (int d = 0; d < 3; ++d) {
      columns_.of(displacement_, i)[d] = 0.0;
      columns_.of(force_, i)[d] = atom->f[i][d];
      columns_.of(torque_, i)[d] = atom->torque_flag ? atom->torque[i][d] : 0.0;
    }
  }
  put(displacement_, group, displacement);
  if (rotation) put(rotation_, group, *rotation);
}

void StartOfStep::restore_groups() const
{
  for (int i = 0; i < atom->nlocal; ++i) atom->mask[i] = std::lround(columns_.of(mask_, i)[0]);
  sync_atoms(lmp, Host, EMPTY_MASK, MASK_MASK);
}

void StartOfStep::restore(const std::vector<int> &group, std::vector<double> &displacement,
                          std::vector<double> *rotation) const
{
  for (int i = 0; i < atom->nlocal; ++i)
    for (int d = 0; d < 3; ++d) {
      atom->f[i][d] = columns_.of(force_, i)[d];
      if (atom->torque_flag) atom->torque[i][d] = columns_.of(torque_, i)[d];
    }
  sync_atoms(lmp, Host, EMPTY_MASK, atom->torque_flag ? F_MASK | TORQUE_MASK : F_MASK);
  get(displacement_, group, displacement);
  if (rotation) get(rotation_, group, *rotation);
}

void StartOfStep::put(const AtomColumns::Column &column, const std::vector<int> &group,
                      const std::vector<double> &v)
{
  for (size_t p = 0; p < group.size(); ++p)
    for (int d = 0; d < 3; ++d) columns_.of(column, group[p])[d] = v[3 * p + d];
}

void StartOfStep::get(const AtomColumns::Column &column, const std::vector<int> &group,
                      std::vector<double> &v) const
{
  v.resize(3 * group.size());
  for (size_t p = 0; p < group.size(); ++p)
    for (int d = 0; d < 3; ++d) v[3 * p + d] = columns_.of(column, group[p])[d];
}

/* ----------------------------------------------------------------------
   the group
------------------------------------------------------------------------- */

void AtomGroup::need_forces_within_step(ForcesFor use)
{
  if (use == ForcesFor::pieces)
    pieces_ = std::make_unique<PiecesOfStep>(lmp, columns_, orientations_.turn());
  if (use == ForcesFor::halves) kept_ = columns_.add(3);
  if (forces_) return;
  forces_ = std::make_unique<MidpointForces>(lmp);
  start_.add_columns(orientations_.turn());
}

bool AtomGroup::matches_scene() const
{
  bool matches = true;
  int bits = 0;
  for (int i : local_) {
    bits |= atom->mask[i];
    if (scene_.looks_at_radii() && !scene_.radii.have(atom->radius[i])) matches = false;
  }
  if (!(bits & scene_.other_integrators)) return matches;
  for (int i : local_)
    refuse_other_integrator(lmp, name_, scene_.other_integrators, atom->tag[i], atom->mask[i]);
  return matches;
}

void AtomGroup::move_and_update_forces(std::vector<double> &displacement,
                                       std::vector<double> *rotation)
{
  judge_.judge(displacement);
  start_.save(local_, displacement, rotation);
  move(displacement);
  if (rotation) orientations_.rotate(local_, *rotation);
  {
    const bdh::PhaseScope forces(bdh::Phase::forces);
    forces_->update();
  }
  start_.restore_groups();
  gather();
  start_.restore(local_, displacement, rotation);
}

void AtomGroup::end_piece(std::vector<double> &displacement, const std::vector<double> &velocity,
                          std::vector<double> *rotation,
                          const std::vector<double> &angular_velocity)
{
  pieces_->add(local_, velocity, angular_velocity);
  move_and_update_forces(displacement, rotation);
}

void AtomGroup::keep(const std::vector<double> &numbers)
{
  for (size_t p = 0; p < local_.size(); ++p)
    std::copy_n(&numbers[3 * p], 3, columns_.of(kept_, local_[p]));
}

std::vector<double> AtomGroup::kept()
{
  std::vector<double> numbers(3 * local_.size());
  for (size_t p = 0; p < local_.size(); ++p)
    std::copy_n(columns_.of(kept_, local_[p]), 3, &numbers[3 * p]);
  return numbers;
}

void AtomGroup::finish(const std::vector<double> &displacement,
                       const std::vector<double> &last_velocity)
{
  const std::vector<double> velocity =
      pieces_ ? pieces_->whole(local_, last_velocity) : last_velocity;
  // Each piece is judged by itself: LAMMPS has seen the particles in between.
  moves_.resize(velocity.size());
  for (size_t k = 0; k < moves_.size(); ++k)
    moves_[k] = pieces_ ? displacement[k] : velocity[k] * update->dt;
  judge_.judge(moves_);
  move(displacement);
  for (size_t p = 0; p < local_.size(); ++p)
    for (int d = 0; d < 3; ++d) atom->v[local_[p]][d] = velocity[3 * p + d];
}

void AtomGroup::turn(const std::vector<double> &rotation,
                     const std::vector<double> &angular_velocity)
{
  orientations_.rotate(local_, rotation);
  orientations_.set_omega(local_, pieces_ ? pieces_->whole_turn(local_, angular_velocity)
                                          : angular_velocity);
}

void AtomGroup::move(const std::vector<double> &displacement)
{
  for (size_t p = 0; p < local_.size(); ++p)
    for (int d = 0; d < 3; ++d) {
      double &x = atom->x[local_[p]][d];
      x = inside(*domain, d, x + displacement[3 * p + d]);
    }
}

double AtomGroup::memory() const
{
  return memory_of_gathered() + moves_.capacity() * sizeof(double);
}
