/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_constraint_output.h"

#include "fix.h"
#include "force.h"
#include "update.h"

using namespace LAMMPS_NS;

namespace {
constexpr int tensor = 6, vector = 3;    // numbers
}

ConstraintOutput::ConstraintOutput(LAMMPS *lmp, Fix &fix, AtomColumns &columns,
                                   const bdh::MotionOptions &options) :
    Pointers(lmp),
    columns_(columns), rheology_(lmp, fix.id, options.stresslets)
{
  if (options.stresslets) rigid_ = columns.add(tensor + vector);
  if (!options.holds.empty()) held_ = columns.add(2 * vector);
  fix.peratom_flag = fix.create_attribute = fix.peratom_freq = 1;
  fix.size_peratom_cols = rigid_.width + held_.width;
  fix.size_vector += Rheology::figures;
}

void ConstraintOutput::announce()
{
  rheology_.announce(update->ntimestep);
  rheology_.announce(update->ntimestep + 1);
}

void ConstraintOutput::keep(const ConstrainedMotion &motion, const std::vector<int> &atoms,
                            const std::vector<char> &held, const Flow &flow, int iterations)
{
  const double to_force = 1.0 / force->ftm2v;
  columns_.clear(rigid_);
  columns_.clear(held_);
  Rheology::Found found;
  found.iterations = iterations;
  found.strain = flow.strain;
  found.viscosity = flow.viscosity;
  found.kT = flow.kT;
  found.particles = atoms.size();
  double sum[bdh::strain_numbers] = {};
  for (size_t p = 0; p < atoms.size(); ++p) {
    if (rigid_.width) {
      const double *s = &motion.stresslet[bdh::strain_numbers * p];
      const auto S = bdh::Symmetric<double>::of(s);
      double *to = columns_.of(rigid_, atoms[p]);
      for (int c = 0; c < tensor; ++c) to[c] = -to_force * S.component(c);
      for (int c = 0; c < bdh::strain_numbers; ++c) sum[c] += s[c];
      for (int c = 0; c < vector; ++c)
        to[tensor + c] = motion.angular[vector * p + c] + flow.angular[c];
    }
    if (held_.width && held[p]) {
      double *to = columns_.of(held_, atoms[p]);
      for (int c = 0; c < vector; ++c) {
        to[c] = -to_force * motion.force[vector * p + c];
        if (!motion.torque.empty()) to[vector + c] = -to_force * motion.torque[vector * p + c];
        found.force_on_held[c] -= motion.force[vector * p + c];
      }
    }
  }
  found.stresslets = bdh::Symmetric<double>::of(sum);
  rheology_.set(found);
  rheology_.announce(update->ntimestep + 1);
}
