/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_solvent.h"

#include "error.h"
#include "force.h"
#include "input.h"
#include "modify.h"
#include "update.h"
#include "variable.h"

#include <cmath>

using namespace LAMMPS_NS;

void Solvent::set(const bdh::Quantity &temperature, const bdh::Quantity &viscosity, uint32_t seed)
{
  seed_ = seed;
  temperature_ = temperature;
  viscosity_user_ = viscosity;
}

bool Solvent::has_variables() const
{
  return temperature_.is_variable() || viscosity_user_.is_variable();
}

double LAMMPS_NS::evaluate_quantity(LAMMPS &lmp, const std::string &fix,
                                    const bdh::Quantity &quantity, const std::string &what)
{
  Variable &variables = *lmp.input->variable;
  if (!quantity.is_variable()) return quantity.value;
  const int index = variables.find(quantity.variable.c_str());
  if (index < 0)
    lmp.error->all(FLERR,
                   "{}: {} = v_{}, but there is no variable of that name: define it before the run",
                   fix, what, quantity.variable);
  if (!variables.equalstyle(index))
    lmp.error->all(FLERR, "{}: {} = v_{}, but the variable must be of style equal", fix, what,
                   quantity.variable);
  return variables.compute_equal(index);
}

double Solvent::evaluate(const bdh::Quantity &quantity, const char *what) const
{
  return evaluate_quantity(*lmp, name_, quantity, what);
}

void Solvent::update()
{
  Update &now = *Pointers::update;
  if (!(now.dt > 0.0)) error->all(FLERR, "{}: timestep = {}, but must be > 0", name_, now.dt);
  const bool variable = has_variables();
  if (variable) modify->clearstep_compute();
  const double T = evaluate(temperature_, "temperature");
  const double eta = evaluate(viscosity_user_, "viscosity");
  if (variable) modify->addstep_compute(now.ntimestep + 1);
  if (!(T >= 0.0) || !std::isfinite(T))
    error->all(FLERR, "{}: temperature = {} at step {}, but must be >= 0", name_, T, now.ntimestep);
  if (!(eta > 0.0) || !std::isfinite(eta))
    error->all(FLERR, "{}: viscosity = {} at step {}, but must be > 0", name_, eta, now.ntimestep);
  now_[0] = T;
  now_[1] = eta;
  expired_ = false;
  kT_ = force->boltz * T / force->mvv2e;
  viscosity_ = eta * force->vxmu2f * force->ftm2v;
}

double *Solvent::find(const char *name)
{
  const std::string what = name;
  const bool T =
      what == "temperature" || what == "t_target" || what == "t_start" || what == "t_stop";
  if (T && !temperature_.is_variable()) return &temperature_.value;
  if (what == "t_target") return &now_[0];
  if (what == "viscosity" && !viscosity_user_.is_variable()) return &viscosity_user_.value;
  return nullptr;
}

void Solvent::reset_temperature(double T)
{
  if (temperature_.is_variable())
    error->all(FLERR,
               "{}: temperature = v_{}, but replica exchange sets the temperature itself: give a "
               "number",
               name_, temperature_.variable);
  temperature_.value = T;
}
