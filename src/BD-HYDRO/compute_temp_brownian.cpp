/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "compute_temp_brownian.h"

#include "atom.h"
#include "base/bytes_of.h"
#include "base/rng_kernel.h"
#include "bdh_lammps.h"
#include "bdh_lammps_classes.h"
#include "domain.h"
#include "error.h"
#include "fix_bd.h"
#include "force.h"
#include "modify.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;

ComputeTempBrownian::ComputeTempBrownian(LAMMPS *lmp, int narg, char **arg) :
    Compute(lmp, narg, arg)
{
  if (narg < 4)
    error->all(FLERR,
               "compute temp/brownian {}: the id of a fix bd/fib or bd/pse is missing: use compute "
               "{} group temp/brownian fix-ID",
               id, id);
  for (int k = 3; k < narg; ++k) {
    for (const Source &s : sources_)
      if (s.id == arg[k])
        error->all(FLERR, "compute temp/brownian {}: fix {} is given twice: name each fix once", id,
                   arg[k]);
    sources_.push_back({arg[k], nullptr, 0, 0.0});
  }
  scalar_flag = vector_flag = 1;
  size_vector = 6;
  extscalar = 0;
  extvector = 1;
  tempflag = tempbias = 1;
  extra_dof = 0.0;    // friction and noise do not conserve the momentum of the center of mass
  vector = new double[size_vector];
}

ComputeTempBrownian::~ComputeTempBrownian() { delete[] vector; }

void ComputeTempBrownian::init()
{
  for (Source &s : sources_) {
    const int f = modify->find_fix(s.id);
    if (f < 0)
      error->all(FLERR, "compute temp/brownian {}: there is no fix {}: define it before the run",
                 id, s.id);
    s.fix = dynamic_cast<FixBD *>(modify->fix[f]);
    if (!s.fix)
      error->all(FLERR,
                 "compute temp/brownian {}: fix {} is of style {}, but must be of style bd/fib or "
                 "bd/pse: name the fix that moves the atoms",
                 id, s.id, modify->fix[f]->style);
  }
}

bool ComputeTempBrownian::is_of(const Fix *fix) const
{
  return std::any_of(sources_.begin(), sources_.end(),
                     [&](const Source &s) { return s.id == fix->id; });
}

/// Atoms that none of the listed fixes moves are not counted; the degrees of freedom that other
/// fixes remove belong to such atoms.  Calls init() because run pre no initialises nothing, and
/// fixes may have been replaced.
void ComputeTempBrownian::count()
{
  init();
  natoms_temp = 0.0;
  for (Source &s : sources_) {
    s.atoms = count_in_both(lmp, groupbit, s.fix->groupbit);
    natoms_temp += s.atoms;
  }
  dof = domain->dimension * natoms_temp - extra_dof;
  if (dof < 0.0 && natoms_temp > 0.0)
    error->all(FLERR,
               "compute temp/brownian {}: {} atoms with {} extra degrees of freedom have {}, but "
               "must have at least 0: use a smaller compute_modify extra/dof",
               id, natoms_temp, extra_dof, dof);
}

/// Collective.  Counts the atoms every time, whatever compute_modify dynamic/dof says.
void ComputeTempBrownian::evaluate()
{
  count();
  scalar = 0.0;
  for (Source &s : sources_) {
    s.temperature = s.fix->solvent().imposed_temperature();
    if (s.atoms) scalar += s.temperature * s.atoms / natoms_temp;
  }
  // Uses the seed 0, which no fix has.
  const uint64_t step = update->ntimestep;
  turn_ = bdh::random_words({0, bdh::Stream::fluid, step, 0}, 0).v[0];
  sync_atoms(lmp, Host, TAG_MASK | MASK_MASK | TYPE_MASK | RMASS_MASK, EMPTY_MASK);
}

double ComputeTempBrownian::compute_scalar()
{
  invoked_scalar = update->ntimestep;
  evaluate();
  return scalar;
}

/// Kinetic energy tensor [energy]: twice the kinetic energy in each direction, as in LAMMPS'
/// compute temp.
void ComputeTempBrownian::compute_vector()
{
  invoked_vector = update->ntimestep;
  evaluate();
  std::fill_n(vector, size_vector, 0.0);
  std::fill_n(vector, domain->dimension, dof * force->boltz * scalar / domain->dimension);
}

/// A velocity w with m w_a^2 = kT along each axis [length/time]; 0 for atoms that are not counted.
///
/// No single vector satisfies m w w^T = kT I, so w w^T is right only on the diagonal.  The signs
/// are chosen so that the off-diagonal terms vanish in the sum over four consecutive atom ids and
/// in the mean over steps.
std::array<double, 3> ComputeTempBrownian::thermal_velocity(int i) const
{
  static const double signs[4][3] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  std::array<double, 3> w = {0.0, 0.0, 0.0};
  if (!(atom->mask[i] & groupbit)) return w;
  const double mass = atom->rmass ? atom->rmass[i] : atom->mass[atom->type[i]];
  for (const Source &s : sources_)
    if (atom->mask[i] & s.fix->groupbit)
      for (int d = 0; d < domain->dimension; ++d)
        w[d] = signs[(atom->tag[i] + turn_) % 4][d] *
               std::sqrt(force->boltz * s.temperature / (force->mvv2e * mass));
  return w;
}

/// The bias is v - w.  Storing v instead restores v to the last bit.
void ComputeTempBrownian::remove_bias_thr(int i, double *v, double *bias)
{
  const std::array<double, 3> w = thermal_velocity(i);
  std::copy_n(v, 3, bias);
  std::copy_n(w.data(), 3, v);
}

void ComputeTempBrownian::restore_bias_thr(int i, double *v, double *bias)
{
  const std::array<double, 3> w = thermal_velocity(i);
  for (int d = 0; d < 3; ++d) v[d] = bias[d] + (v[d] - w[d]);
}

void ComputeTempBrownian::remove_bias(int i, double *v) { remove_bias_thr(i, v, vbias); }

void ComputeTempBrownian::restore_bias(int i, double *v) { restore_bias_thr(i, v, vbias); }

void ComputeTempBrownian::remove_bias_all()
{
  kept_.resize(atom->nlocal);
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) remove_bias_thr(i, atom->v[i], kept_[i].data());
}

/// Requires that atoms have kept their positions in memory since remove_bias_all().
void ComputeTempBrownian::reapply_bias_all()
{
  for (int i = 0; i < atom->nlocal; ++i) {
    const std::array<double, 3> w = thermal_velocity(i);
    for (int d = 0; d < 3 && (atom->mask[i] & groupbit); ++d)
      atom->v[i][d] = w[d] + (atom->v[i][d] - kept_[i][d]);
  }
}

void ComputeTempBrownian::restore_bias_all()
{
  for (int i = 0; i < atom->nlocal; ++i)
    if (atom->mask[i] & groupbit) restore_bias_thr(i, atom->v[i], kept_[i].data());
}
