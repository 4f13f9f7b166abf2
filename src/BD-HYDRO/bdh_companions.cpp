/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_companions.h"

#include "atom.h"
#include "bdh_lammps.h"
#include "comm.h"
#include "error.h"
#include "fix_bd.h"
#include "force.h"
#include "group.h"
#include "modify.h"
#include "neighbor.h"
#include "update.h"

using namespace LAMMPS_NS;

void Companions::check(bool needs_list)
{
  needs_list_ = needs_list;
  if (utils::strmatch(update->integrate_style, "^respa"))
    error->all(FLERR, "{}: run_style respa has no meaning without inertia: use run_style verlet",
               name_);
  refuse_second_integrator();
  check_fixes();
  check_neighbor_settings();
  known_danger_ = 0;
}

/// An atom that two fixes move would move too far, at the wrong temperature.
void Companions::refuse_second_integrator() const
{
  const int mine = fix_->groupbit;
  for (int f = 0; f < modify->nfix; ++f) {
    const Fix *other = modify->fix[f];
    if (other == fix_ || !other->time_integrate) continue;
    bigint shared = 0, total = 0;
    for (int i = 0; i < atom->nlocal; ++i)
      if ((atom->mask[i] & mine) && (atom->mask[i] & other->groupbit)) ++shared;
    MPI_Allreduce(&shared, &total, 1, MPI_LMP_BIGINT, MPI_SUM, world);
    if (total)
      error->all(FLERR,
                 "{}: {} atoms of group {} are also integrated by fix {} {}: unfix it or separate "
                 "the groups",
                 name_, total, group->names[fix_->igroup], other->id, other->style);
    const FixBD *fluid = dynamic_cast<const FixBD *>(other);
    if (fluid && fluid->seed() == seed_)
      error->all(FLERR,
                 "{}: fix {} {} has the same seed {}, so their particles would get the same "
                 "noise: give another",
                 name_, other->id, other->style, seed_);
    if (fluid && comm->me == 0)
      error->warning(FLERR,
                     "{}: fix {} {} has a fluid of its own: particles of the two do not interact "
                     "through it",
                     name_, other->id, other->style);
  }
}

/// Fixes and pair styles that take the velocity for more than displacement/dt.
void Companions::check_fixes() const
{
  for (int f = 0; f < modify->nfix; ++f) {
    const Fix *other = modify->fix[f];
    if (is_style(other->style, {"shake", "rattle"}))
      error->all(FLERR,
                 "{}: fix {} {} predicts positions from velocities, which have no inertia here: "
                 "use stiff bonds",
                 name_, other->id, other->style);
    if (is_style(other->style, {"langevin", "viscous", "gle", "gld", "drag", "qtb", "temp", "heat",
                                "ehex", "momentum", "thermal/conductivity"}) &&
        comm->me == 0)
      error->warning(FLERR,
                     "{}: fix {} {} acts on velocities, which here are displacement/dt: friction "
                     "and noise come from the fluid, so remove it",
                     name_, other->id, other->style);
  }
  if (comm->ghost_velocity && comm->me == 0)
    error->warning(FLERR,
                   "{}: velocities of ghost atoms are communicated for a pair style that uses "
                   "them; here they are displacement/dt",
                   name_);
}

bool Companions::uses_lists() const { return force->pair || needs_list_; }

void Companions::check_neighbor_settings() const
{
  if (!uses_lists() || comm->me) return;
  if (neighbor->delay > 0 || neighbor->every > 1)
    error->warning(FLERR,
                   "{}: neighbor lists are only looked at {} steps after they were built (every "
                   "{} delay {}); Brownian steps are long, so use neigh_modify every 1 delay 0 "
                   "check yes",
                   name_, MAX(neighbor->delay, neighbor->every), neighbor->every, neighbor->delay);
}

void Companions::watch()
{
  watch_neighbor_builds();
  watch_step_number();
}

/// A build at the first step at which it was allowed may have come too late.
void Companions::watch_neighbor_builds()
{
  const bool each_step = neighbor->delay == 0 && neighbor->every == 1;
  if (uses_lists() && !each_step && neighbor->ndanger > known_danger_ && !warned_danger_ &&
      comm->me == 0) {
    warned_danger_ = true;
    error->warning(FLERR,
                   "{}: dangerous neighbor list build before step {}: atoms had moved more than "
                   "half the skin {} and pairs may have been missed; use neigh_modify every 1 "
                   "delay 0 check yes",
                   name_, update->ntimestep, neighbor->skin);
  }
  known_danger_ = neighbor->ndanger;
}

/// The noise is a function of the step.
void Companions::watch_step_number()
{
  if (update->ntimestep <= last_step_ && !warned_replay_ && comm->me == 0) {
    warned_replay_ = true;
    error->warning(FLERR,
                   "{}: step {} was taken before (reset_timestep?): the same noise is drawn again, "
                   "unless the fix is defined anew with another seed",
                   name_, update->ntimestep);
  }
  last_step_ = update->ntimestep;
}
