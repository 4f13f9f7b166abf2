/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_scene.h"

#include "atom.h"
#include "domain.h"
#include "error.h"
#include "fix.h"
#include "lammps.h"
#include "modify.h"
#include "update.h"

using namespace LAMMPS_NS;

bdh::Cell LAMMPS_NS::cell_now(const Domain &domain)
{
  bdh::Cell c;
  for (int d = 0; d < 3; ++d) c.lo[d] = domain.boxlo[d];
  c.lx = domain.prd[0];
  c.ly = domain.prd[1];
  c.lz = domain.prd[2];
  if (domain.triclinic) {
    c.xy = domain.xy;
    c.xz = domain.xz;
    c.yz = domain.yz;
  }
  return c;
}

std::array<double, 2> LAMMPS_NS::radius_range(const LAMMPS &lmp, int groupbit)
{
  const Atom *atom = lmp.atom;
  double range[2] = {-HUGE_VAL, -HUGE_VAL}, all[2];    // minus the least, and the greatest
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      range[0] = MAX(range[0], -atom->radius[i]);
      range[1] = MAX(range[1], atom->radius[i]);
    }
  MPI_Allreduce(range, all, 2, MPI_DOUBLE, MPI_MAX, lmp.world);
  return {-all[0], all[1]};
}

tagint LAMMPS_NS::first_with_radius(const LAMMPS &lmp, int groupbit, double radius)
{
  const Atom *atom = lmp.atom;
  tagint mine = MAXTAGINT, first = 0;
  for (int i = 0; i < atom->nlocal; ++i)
    if ((atom->mask[i] & groupbit) && atom->radius[i] == radius) mine = MIN(mine, atom->tag[i]);
  MPI_Allreduce(&mine, &first, 1, MPI_LMP_TAGINT, MPI_MIN, lmp.world);
  return first;
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
