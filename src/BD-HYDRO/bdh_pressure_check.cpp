/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_pressure_check.h"

#include "bdh_lammps.h"
#include "bdh_lammps_classes.h"
#include "comm.h"
#include "compute_temp_brownian.h"
#include "error.h"
#include "fix_bd.h"
#include "modify.h"
#include "update.h"

#include <cstring>

using namespace LAMMPS_NS;

namespace {

/// True for the temperature that LAMMPS defines for thermo output.
bool is_temperature_of_thermo(const Compute *c) { return strcmp(c->id, "thermo_temp") == 0; }

/// Gives access to the protected members of a pressure.
struct PressureParts : ComputePressure {
  static const char *temperature_of(const ComputePressure *c)
  {
    return c->*(&PressureParts::keflag) ? c->*(&PressureParts::id_temp) : nullptr;
  }
};

/// Id of the temperature that a compute is or takes its kinetic part from; null if there is none.
const char *temperature_of(const Compute *c)
{
  if (is_temperature_of_thermo(c)) return c->id;
  const ComputePressure *pressure = dynamic_cast<const ComputePressure *>(c);
  return pressure ? PressureParts::temperature_of(pressure) : nullptr;
}

void append(std::string &list, const std::string &word)
{
  if (!list.empty()) list += ", ";
  list += word;
}

}    // namespace

/// All ranks evaluate the same computes, so they warn about the same ones.
void PressureCheck::watch()
{
  if (update->whichflag == 2) return;    // minimize takes no steps
  std::string computes, remedies;
  for (const bool pressures :
       {true, false})    // the warning about a pressure names its temperature, too
    for (int c = 0; c < modify->ncompute; ++c) {
      const Compute *one = modify->compute[c];
      if (pressures ? !one->pressflag : !is_temperature_of_thermo(one)) continue;
      if (one->invoked_scalar < 0 && one->invoked_vector < 0) continue;
      if (!seen_.insert(one->id).second || !misleads(one) || !warned_.insert(one->id).second)
        continue;
      append(computes, one->id);
      append(remedies, remedy(one->id));
      if (!pressures) continue;
      computes += fmt::format(" (temperature {})", temperature_of(one));
      warned_.insert(temperature_of(one));
    }
  if (!computes.empty()) warn(computes, remedies);
  check_barostats();
}

/// A barostat does not tell which pressure it uses.  But if none of the pressures that were
/// evaluated has a kinetic part, neither has the barostat's.  Barostats act at the end of a step,
/// so this is known from the second step on.
void PressureCheck::check_barostats()
{
  if (update->ntimestep != update->firststep + 2) return;
  bool any = false;
  for (int c = 0; c < modify->ncompute; ++c) {
    const Compute *one = modify->compute[c];
    if (!one->pressflag || (one->invoked_scalar < 0 && one->invoked_vector < 0)) continue;
    any = true;
    if (temperature_of(one)) return;
  }
  for (int f = 0; any && f < modify->nfix; ++f) {
    const Fix *barostat = modify->fix[f];
    if (!is_style(barostat->style, {"press"})) continue;
    if (!warned_.insert(std::string("fix ") + barostat->id).second) continue;
    if (comm->me == 0)
      error->warning(FLERR,
                     "{}: the pressure that fix {} {} controls lacks the ideal term N kT/V: use "
                     "compute T all temp/brownian{}, compute P all pressure T, and fix_modify {} "
                     "press P",
                     name_, barostat->id, barostat->style, list_of_fixes(), barostat->id);
  }
}

/// Ids of all fixes that impose a temperature, for the arguments of one compute; each after a
/// blank.
std::string PressureCheck::list_of_fixes() const
{
  std::string ids;
  for (int f = 0; f < modify->nfix; ++f)
    if (dynamic_cast<const FixBD *>(modify->fix[f])) ids += std::string(" ") + modify->fix[f]->id;
  return ids;
}

/// Collective.  True if velocities of the fix's atoms contribute to a temperature or pressure.
bool PressureCheck::misleads(const Compute *c) const
{
  const char *id = temperature_of(c);
  const int t = id ? modify->find_compute(id) : -1;
  if (t < 0) return false;
  const ComputeTempBrownian *imposed = dynamic_cast<ComputeTempBrownian *>(modify->compute[t]);
  if (imposed && imposed->is_of(fix_)) return false;
  return count_in_both(lmp, fix_->groupbit, modify->compute[t]->groupbit) > 0;
}

/// How to give a compute the temperature T.
std::string PressureCheck::remedy(const std::string &id) const
{
  if (id == "thermo_temp") return "thermo_modify temp T";
  if (id == "thermo_press")
    return "thermo_modify temp T (or compute P all pressure T and thermo_modify press P)";
  const std::string end = "_press";    // LAMMPS' barostats name their own pressures so
  if (id.size() > end.size() && id.compare(id.size() - end.size(), end.size(), end) == 0) {
    const std::string owner = id.substr(0, id.size() - end.size());
    if (modify->find_fix(owner) >= 0) return "fix_modify " + owner + " temp T";
  }
  return "compute " + id + " all pressure T";
}

void PressureCheck::warn(const std::string &computes, const std::string &remedies) const
{
  if (comm->me) return;
  error->warning(FLERR,
                 "{}: the kinetic part of compute {} comes from velocities, which here are "
                 "displacement/dt and have nothing to do with the temperature: use compute T all "
                 "temp/brownian{}, and {}",
                 name_, computes, list_of_fixes(), remedies);
}
