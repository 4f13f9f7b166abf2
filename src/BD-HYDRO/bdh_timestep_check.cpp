/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_timestep_check.h"

#include "comm.h"
#include "error.h"
#include "update.h"

using namespace LAMMPS_NS;

void TimestepCheck::ask(AtomGroup &group)
{
  asked_ = true;
  group.need_forces_within_step(AtomGroup::ForcesFor::halves);
}

bool TimestepCheck::is_due()
{
  const bool due = due_;
  due_ = false;
  return due;
}

void TimestepCheck::report(const bdh::StepAgainstHalves &found, double radius) const
{
  if (comm->me) return;
  if (!found.taken) {
    error->warning(FLERR,
                   "{}: check of the timestep {:g}: the step or one of its halves would end the "
                   "run: use a smaller timestep, or adapt",
                   name_, update->dt);
    return;
  }
  utils::logmesg(lmp,
                 "{}: check of the timestep {:g} against two halves on the same Brownian path\n"
                 "  particles move by {:.2g} radii and end {:.2g} radii apart (root mean square), "
                 "{:.2g} at most\n",
                 name_, update->dt, found.moved / radius, found.apart / radius,
                 found.farthest / radius);
  if (found.farthest > 0.1 * radius)
    error->warning(FLERR,
                   "{}: a step of {:g} and its halves end {:.2g} radii apart: use a smaller "
                   "timestep, or adapt",
                   name_, update->dt, found.farthest / radius);
}
