/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_pieces_of_step.h"

#include "base/rotation_kernel.h"
#include "update.h"

#include <algorithm>

using namespace LAMMPS_NS;

PiecesOfStep::PiecesOfStep(LAMMPS *lmp, AtomColumns &columns, bool turn) :
    Pointers(lmp), columns_(columns), before_(columns.add(3)), moved_(columns.add(3)),
    turned_(columns.add(turn ? 3 : 0)), moved_before_(columns.add(3)),
    turned_before_(columns.add(turn ? 3 : 0))
{}

void PiecesOfStep::begin(const std::vector<int> &group, const std::vector<double> &force,
                         double part)
{
  part_ = part;
  for (size_t p = 0; p < group.size(); ++p)
    std::copy_n(&force[3 * p], 3, columns_.of(before_, group[p]));
}

void PiecesOfStep::add(const std::vector<int> &group, const std::vector<double> &velocity,
                       const std::vector<double> &angular_velocity)
{
  const double time = part_ * update->dt;
  for (size_t p = 0; p < group.size(); ++p) {
    double *moved = columns_.of(moved_, group[p]);
    std::copy_n(moved, moved_.width, columns_.of(moved_before_, group[p]));
    for (int d = 0; d < 3; ++d) moved[d] += time * velocity[3 * p + d];
    if (turned_.width == 0) continue;
    std::copy_n(columns_.of(turned_, group[p]), turned_.width,
                columns_.of(turned_before_, group[p]));
    bdh::turn_further(time, &angular_velocity[3 * p], columns_.of(turned_, group[p]));
  }
}

void PiecesOfStep::forget(const std::vector<int> &group)
{
  for (const int i : group) {
    std::copy_n(columns_.of(moved_before_, i), moved_.width, columns_.of(moved_, i));
    std::copy_n(columns_.of(turned_before_, i), turned_.width, columns_.of(turned_, i));
  }
}

const std::vector<double> &PiecesOfStep::force_before(const std::vector<int> &group)
{
  force_before_.resize(3 * group.size());
  for (size_t p = 0; p < group.size(); ++p)
    std::copy_n(columns_.of(before_, group[p]), 3, &force_before_[3 * p]);
  return force_before_;
}

std::vector<double> PiecesOfStep::whole(const std::vector<int> &group,
                                        const std::vector<double> &velocity)
{
  last_velocity_ = velocity;
  std::vector<double> whole(velocity.size());
  for (size_t p = 0; p < group.size(); ++p) {
    double *moved = columns_.of(moved_, group[p]);
    for (int d = 0; d < 3; ++d)
      whole[3 * p + d] = part_ * velocity[3 * p + d] + moved[d] / update->dt;
    std::fill_n(moved, 3, 0.0);
  }
  return whole;
}

std::vector<double> PiecesOfStep::whole_turn(const std::vector<int> &group,
                                             const std::vector<double> &angular_velocity)
{
  std::vector<double> whole(angular_velocity.size());
  for (size_t p = 0; p < group.size(); ++p) {
    double *turned = columns_.of(turned_, group[p]);
    bdh::turn_further(part_ * update->dt, &angular_velocity[3 * p], turned);
    for (int d = 0; d < 3; ++d) whole[3 * p + d] = turned[d] / update->dt;
    std::fill_n(turned, 3, 0.0);
  }
  return whole;
}
