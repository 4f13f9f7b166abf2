/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_move_judge.h"

#include "domain.h"
#include "error.h"
#include "neighbor.h"

#include <cmath>

using namespace LAMMPS_NS;

void MoveJudge::set_limit(double limit, const char *what)
{
  limit_ = limit;
  limit_name_ = what;
}

double MoveJudge::shortest_edge() const
{
  double shortest = HUGE_VAL;
  for (int d = 0; d < domain->dimension; ++d)
    if (domain->boundary[d][0] <= 1 && domain->boundary[d][1] <= 1)
      shortest = MIN(shortest, domain->prd[d]);
  return shortest;
}

void MoveJudge::judge(double longest, long farthest, double long_moves)
{
  longest_ = MAX(longest_, longest);
  long_moves_ += long_moves;
  if (farthest < 0) return;
  if (!std::isfinite(longest))
    error->one(FLERR, "{}: {}: its displacement is not a finite number: use a smaller timestep",
               name_, describe_(farthest));
  if (longest > 0.5 * shortest_edge())
    error->one(FLERR,
               "{}: {} moved by {:.3g} in one step, which is more than half the box: use a smaller "
               "timestep",
               name_, describe_(farthest), longest);
  warn_of_lost_atoms(farthest, longest);
  if (longest <= limit_ || warned_long_) return;
  warned_long_ = true;
  error->warning(FLERR,
                 "{}: {} moved by {:.3g} in one step, which is more than {} = {:.3g}: use a "
                 "smaller timestep if forces change over that distance (further cases are counted "
                 "in the fix's output)",
                 name_, describe_(farthest), longest, limit_name_, limit_);
}

void MoveJudge::judge(const std::vector<double> &displacements)
{
  const double limit2 = limit_ * limit_;
  double longest2 = 0.0, long_moves = 0.0;
  long farthest = -1;
  for (size_t p = 0; 3 * p < displacements.size(); ++p) {
    const double *u = &displacements[3 * p];
    const double move2 = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    if (move2 > limit2) long_moves += 1.0;
    if (!(move2 <= longest2)) {    // true for NaN as well
      longest2 = move2;
      farthest = p;
    }
  }
  judge(std::sqrt(longest2), farthest, long_moves);
}

/// LAMMPS wraps atoms back into a periodic box, by one period, only at steps at which it may build
/// neighbor lists.
void MoveJudge::warn_of_lost_atoms(long index, double longest)
{
  const int apart = MAX(neighbor->delay, neighbor->every);
  if (apart <= 1 || apart * longest < shortest_edge() || warned_lost_) return;
  warned_lost_ = true;
  error->warning(FLERR,
                 "{}: {} moved by {:.3g} in one step, but LAMMPS wraps atoms back into the box "
                 "only every {} steps (neigh_modify every {} delay {}) and loses those that have "
                 "gone farther than a box length: use neigh_modify every 1 delay 0 check yes",
                 name_, describe_(index), longest, apart, neighbor->every, neighbor->delay);
}
