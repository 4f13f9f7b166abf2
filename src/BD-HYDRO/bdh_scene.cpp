/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_scene.h"

#include "error.h"
#include "fix.h"
#include "lammps.h"
#include "modify.h"
#include "update.h"

using namespace LAMMPS_NS;

int LAMMPS_NS::bits_of_other_integrators(const Modify &modify, const Fix *fix)
{
  int bits = 0;
  for (int f = 0; f < modify.nfix; ++f)
    if (modify.fix[f] != fix && modify.fix[f]->time_integrate) bits |= modify.fix[f]->groupbit;
  return bits;
}

void LAMMPS_NS::refuse_other_integrator(LAMMPS *lmp, const std::string &name, int others, tagint id,
                                        int mask)
{
  for (int f = 0; f < lmp->modify->nfix; ++f) {
    const Fix *fix = lmp->modify->fix[f];
    if (fix->time_integrate && (fix->groupbit & mask & others))
      lmp->error->one(FLERR,
                      "{}: atom {} is also integrated by fix {} {} at step {}: its groups have "
                      "changed during the run, so keep the groups of the two fixes apart",
                      name, id, fix->id, fix->style, lmp->update->ntimestep);
  }
}
