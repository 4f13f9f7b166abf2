/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_rheology.h"

#include "bdh_lammps.h"
#include "compute.h"
#include "domain.h"
#include "force.h"
#include "modify.h"
#include "update.h"

using namespace LAMMPS_NS;

Rheology::Rheology(LAMMPS *lmp, const std::string &fix, bool stresslets) : Pointers(lmp)
{
  if (!stresslets) return;
  virial_ = fix + "_virial";
  modify->add_compute(virial_ + " all pressure NULL virial");
}

Rheology::~Rheology()
{
  if (virial()) modify->delete_compute(virial_);
}

/// Null without stresslets, or if the user has deleted it.
Compute *Rheology::virial() const
{
  const int number = virial_.empty() ? -1 : modify->find_compute(virial_);
  return number < 0 ? nullptr : modify->compute[number];
}

void Rheology::announce(bigint step)
{
  if (Compute *pressure = virial()) pressure->addstep(step);
}

double Rheology::volume() const { return domain->xprd * domain->yprd * domain->zprd; }

double Rheology::sum(double mine) const
{
  double all = 0.0;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return all;
}

double Rheology::hydrodynamic(int n) const
{
  return -sum(found_.stresslets.component(n)) / volume() / force->ftm2v * force->nktv2p;
}

double Rheology::interparticle(int n)
{
  Compute *const pressure = virial();
  if (!pressure) return 0.0;
  if (pressure->invoked_vector != update->ntimestep) pressure->compute_vector();
  return -pressure->vector[n];
}

/// 1 + stress : E/(2 viscosity E : E)
double Rheology::relative_viscosity()
{
  double work = 0.0, squares = 0.0;
  for (int n = 0; n < 6; ++n) {
    const double E = found_.strain.component(n), twice = n < 3 ? 1.0 : 2.0;
    work += twice * E * (hydrodynamic(n) + interparticle(n));
    squares += twice * E * E;
  }
  if (squares == 0.0) return 0.0;
  const double viscosity = found_.viscosity / force->ftm2v * force->nktv2p;
  return 1.0 + work / (2.0 * viscosity * squares);
}

double Rheology::figure(int n)
{
  if (n == 0) return found_.iterations;
  if (n < 7) return hydrodynamic(n - 1);
  if (n < 13) return interparticle(n - 7);
  if (n == 13) return -sum(found_.particles) * found_.kT / volume() / force->ftm2v * force->nktv2p;
  if (n == 14) return relative_viscosity();
  return sum(found_.force_on_held[n - 15]) / force->ftm2v;
}
