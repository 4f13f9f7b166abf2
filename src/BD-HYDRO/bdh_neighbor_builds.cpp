/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_neighbor_builds.h"

#include "comm.h"
#include "error.h"
#include "force.h"
#include "neighbor.h"
#include "update.h"

using namespace LAMMPS_NS;

bool NeighborBuilds::uses_lists() const { return force->pair || needs_list_; }

void NeighborBuilds::begin_run(bool needs_list)
{
  needs_list_ = needs_list;
  known_danger_ = 0;
  if (!uses_lists() || comm->me) return;
  if (neighbor->delay > 0 || neighbor->every > 1)
    error->warning(FLERR,
                   "{}: neighbor lists are first checked {} steps after they were built (every "
                   "{} delay {}), but Brownian steps are long: use neigh_modify every 1 delay 0 "
                   "check yes",
                   name_, MAX(neighbor->delay, neighbor->every), neighbor->every, neighbor->delay);
}

/// If a list was rebuilt at the first step at which this was allowed, it may have been due earlier.
void NeighborBuilds::begin_step()
{
  const bool each_step = neighbor->delay == 0 && neighbor->every == 1;
  if (uses_lists() && !each_step && neighbor->ndanger > known_danger_ && !warned_ &&
      comm->me == 0) {
    warned_ = true;
    error->warning(FLERR,
                   "{}: dangerous neighbor list build before step {}: atoms had moved more than "
                   "half the skin {} and pairs may have been missed; use neigh_modify every 1 "
                   "delay 0 check yes",
                   name_, update->ntimestep, neighbor->skin);
  }
  known_danger_ = neighbor->ndanger;
}
