/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_velocity_watch.h"

#include "atom.h"
#include "bdh_companion_styles.h"
#include "bdh_lammps.h"
#include "bdh_lammps_classes.h"
#include "comm.h"
#include "error.h"
#include "fix_bd.h"
#include "modify.h"
#include "universe.h"
#include "update.h"

#include <cmath>

using namespace LAMMPS_NS;
using namespace FixConst;

namespace {

constexpr int enough_looks = 2;

/// A pseudo-random number from 0 to 2^31 - 1 (the finalizer of splitmix64).
uint64_t mixed(uint64_t n)
{
  n += 0x9e3779b97f4a7c15;
  n = (n ^ (n >> 30)) * 0xbf58476d1ce4e5b9;
  n = (n ^ (n >> 27)) * 0x94d049bb133111eb;
  return (n ^ (n >> 31)) >> 33;
}

}    // namespace

/// With several partitions, commands such as temper change velocities themselves, so nothing is
/// watched.
void VelocityWatch::begin_run()
{
  suspects_.clear();
  if (universe->nworlds > 1) return;
  for (int f = 0; f < modify->nfix; ++f)
    if (is_in_question(f)) looks_.emplace(modify->fix[f]->id, 0);
}

bool VelocityWatch::is_in_question(int f) const
{
  const Fix &fix = *modify->fix[f];
  const int hooks = POST_INTEGRATE | PRE_EXCHANGE | PRE_NEIGHBOR | POST_NEIGHBOR | PRE_FORCE |
                    PRE_REVERSE | POST_FORCE | FINAL_INTEGRATE | END_OF_STEP;
  return (modify->fmask[f] & hooks) && !fix.time_integrate && !deed_of(fix) &&
         !may_change_velocities(fix);
}

/// True if any fix in question acts in this step.
bool VelocityWatch::due()
{
  suspects_.clear();
  if (warned_ || looks_.empty()) return false;
  for (int f = 0; f < modify->nfix; ++f) {
    const Fix &fix = *modify->fix[f];
    const auto known = looks_.find(fix.id);
    if (known == looks_.end() || known->second >= enough_looks || !is_in_question(f)) continue;
    if (fix.nevery > 0 && update->ntimestep % fix.nevery) continue;
    ++known->second;
    suspects_ += fmt::format("{}fix {} {}", suspects_.empty() ? "" : " or ", fix.id, fix.style);
  }
  return !suspects_.empty();
}

VelocityWatch::Sums VelocityWatch::sums() const
{
  sync_atoms(lmp, Host, V_MASK | TAG_MASK | MASK_MASK, EMPTY_MASK);
  double mine[4] = {0.0, 0.0, 0.0, 0.0}, all[4];
  for (int i = 0; i < atom->nlocal; ++i) {
    if (!(atom->mask[i] & fix_->groupbit)) continue;
    const uint64_t id = 4ULL * atom->tag[i];
    for (int d = 0; d < 3; ++d) {
      const double weighted = (mixed(id + d) * 0x1p-30 - 1.0) * atom->v[i][d];
      mine[0] += weighted;
      mine[1] += std::fabs(weighted);
    }
    mine[2] += mixed(id + 3) >> 11;    // exact for any number of atoms
    mine[3] += 1.0;
  }
  MPI_Allreduce(mine, all, 4, MPI_DOUBLE, MPI_SUM, world);
  return {all[0], all[1], all[2], all[3]};
}

/// Only after its step do the device's copies count as changed by the fix, so this marks them now.
void VelocityWatch::after_step()
{
  if (!due()) return;
  sync_atoms(lmp, fix_->execution_space, EMPTY_MASK, V_MASK);
  before_ = sums();
}

/// Before the first step of a run nothing is compared: the user may have changed velocities.
void VelocityWatch::before_step()
{
  if (suspects_.empty() || update->ntimestep == update->firststep + 1) return;
  const Sums now = sums();
  const bool same_atoms = now.count == before_.count && now.members == before_.members;
  if (!same_atoms || std::fabs(now.velocity - before_.velocity) <= 1e-9 * before_.size) return;
  warned_ = true;
  if (comm->me == 0)
    error->warning(FLERR,
                   "{}: {} changed velocities at step {}, but velocities here are displacement/dt "
                   "and move no particle: remove the fix if its purpose is to move particles",
                   name_, suspects_, update->ntimestep - 1);
}
