/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_given_motions.h"

#include "atom.h"
#include "bdh_scene.h"
#include "bdh_solvent.h"
#include "domain.h"
#include "error.h"
#include "group.h"
#include "modify.h"
#include "update.h"

#include <cmath>

using namespace LAMMPS_NS;

void GivenMotions::check() const
{
  for (const bdh::Hold &hold : options_.holds) {
    if (group->find(hold.group) < 0)
      error->all(FLERR, "{}: hold {}: there is no group of that name: define it with group", name_,
                 hold.group);
    if (domain->box_change)
      error->all(FLERR,
                 "{}: hold {}: the box changes during the run and would carry held atoms along: "
                 "drive the flow by atoms that are held and moved, or remove hold",
                 name_, hold.group);
  }
}

double GivenMotions::evaluate(const bdh::Quantity &quantity, const std::string &group) const
{
  const double v = evaluate_quantity(*lmp, name_, quantity, "hold " + group);
  if (!std::isfinite(v))
    error->all(FLERR, "{}: hold {}: velocity = {} at step {}, but must be finite", name_, group, v,
               Pointers::update->ntimestep);
  return v;
}

void GivenMotions::update()
{
  bool variable = false;
  for (const bdh::Hold &hold : options_.holds)
    for (const bdh::Quantity &v : hold.velocity) variable = variable || v.is_variable();
  if (variable) modify->clearstep_compute();
  now_.clear();
  for (const bdh::Hold &hold : options_.holds)
    for (const bdh::Quantity &v : hold.velocity) now_.push_back(evaluate(v, hold.group));
  if (variable) modify->addstep_compute(Pointers::update->ntimestep + 1);
  constraint_.rigid = options_.stresslets;
  strain_ = flow_now(*domain).strain();
  strain_.numbers(constraint_.flow);
}

void GivenMotions::gather(const std::vector<int> &atoms)
{
  held_.clear();
  velocity_.clear();
  if (options_.holds.empty()) return;
  // A process without atoms has an array, too: what all do together depends on whether there is
  // one.
  const size_t size = atoms.size() + 1;
  held_.resize(size, 0);
  velocity_.resize(bdh::dof * size, 0.0);
  for (size_t h = 0; h < options_.holds.size(); ++h) {
    const int bit = group->bitmask[group->find(options_.holds[h].group)];
    for (size_t p = 0; p < atoms.size(); ++p) {
      if (!(atom->mask[atoms[p]] & bit)) continue;
      held_[p] = 1;
      for (int c = 0; c < bdh::dof; ++c) velocity_[bdh::dof * p + c] = now_[bdh::dof * h + c];
    }
  }
}

std::string GivenMotions::text() const
{
  std::string text;
  for (const bdh::Hold &hold : options_.holds) {
    text += text.empty() ? "group " : ", group ";
    text += hold.group;
  }
  return text;
}

std::string GivenMotions::control_variate_text(double kT) const
{
  if (kT == 0.0) return "nothing to take out at temperature 0";
  return "one more solve for the constraint, besides: its loads are taken out of the output";
}
