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

BoxFlow LAMMPS_NS::flow_now(const Domain &domain)
{
  if (!domain.deform_flag) return {};
  const double *rate = domain.h_rate, *inverse = domain.h_inv;    // xx, yy, zz, yz, xz, xy
  return {rate[0] * inverse[0],
          rate[1] * inverse[1],
          rate[2] * inverse[2],
          rate[1] * inverse[3] + rate[3] * inverse[2],
          rate[0] * inverse[4] + rate[5] * inverse[3] + rate[4] * inverse[2],
          rate[0] * inverse[5] + rate[5] * inverse[1]};
}

/// Collective.
static bdh::RadiusClasses classes_in(const LAMMPS &lmp, int groupbit, const Radii &range)
{
  bdh::RadiusClasses mine, all;
  for (int i = 0; i < lmp.atom->nlocal; ++i)
    if (lmp.atom->mask[i] & groupbit) mine.add(lmp.atom->radius[i], range.least, range.greatest);
  constexpr int n = bdh::radius_classes;
  MPI_Allreduce(mine.count.data(), all.count.data(), n, MPI_DOUBLE, MPI_SUM, lmp.world);
  MPI_Allreduce(mine.greatest.data(), all.greatest.data(), n, MPI_DOUBLE, MPI_MAX, lmp.world);
  MPI_Allreduce(&mine.between, &all.between, 1, MPI_DOUBLE, MPI_SUM, lmp.world);
  return all;
}

Radii LAMMPS_NS::radii_of(const LAMMPS &lmp, int groupbit)
{
  const Atom *atom = lmp.atom;
  double range[2] = {-HUGE_VAL, -HUGE_VAL}, ends[2];    // minus the least, and the greatest
  double sums[2] = {0.0, 0.0}, all[2];                  // cubes, and atoms
  bool numbers = true;
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) {
      const double a = atom->radius[i];
      numbers = numbers && std::isfinite(a);
      range[0] = MAX(range[0], -a);
      range[1] = MAX(range[1], a);
      sums[0] += a * a * a;
      sums[1] += 1.0;
    }
  // The least of radii that are not all numbers is not one.
  if (!numbers) range[0] = HUGE_VAL;
  MPI_Allreduce(range, ends, 2, MPI_DOUBLE, MPI_MAX, lmp.world);
  MPI_Allreduce(sums, all, 2, MPI_DOUBLE, MPI_SUM, lmp.world);
  Radii radii{-ends[0], ends[1], all[0] / all[1], {}};
  if (radii.least > 0.0 && !radii.equal()) radii.classes = classes_in(lmp, groupbit, radii);
  return radii;
}

std::string LAMMPS_NS::worst_radius(const LAMMPS &lmp, int groupbit)
{
  const Atom *atom = lmp.atom;
  tagint mine = MAXTAGINT, first = 0;
  double radius = -HUGE_VAL, named = 0.0;
  for (int i = 0; i < atom->nlocal; ++i)
    if ((atom->mask[i] & groupbit) && !(atom->radius[i] > 0.0 && std::isfinite(atom->radius[i])) &&
        atom->tag[i] < mine) {
      mine = atom->tag[i];
      radius = atom->radius[i];
    }
  MPI_Allreduce(&mine, &first, 1, MPI_LMP_TAGINT, MPI_MIN, lmp.world);
  const double of_first = mine == first && !std::isnan(radius) ? radius : -HUGE_VAL;
  MPI_Allreduce(&of_first, &named, 1, MPI_DOUBLE, MPI_MAX, lmp.world);
  return fmt::format("atom {} has radius {}", first, named == -HUGE_VAL ? NAN : named);
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
