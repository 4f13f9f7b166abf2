/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_orientation.h"

#include "atom.h"
#include "base/rotation_kernel.h"
#include "bdh_lammps.h"
#include "bdh_lammps_classes.h"
#include "error.h"
#include "force.h"

#ifndef BDH_INSTALLED_LAMMPS
#include "atom_vec_ellipsoid.h"
#endif

using namespace LAMMPS_NS;
using bdh::Rotation;

namespace {

/// The KOKKOS package's copies of dipoles and quaternions, as far as a release has them.
AtomMask orientation_mask()
{
  AtomMask mask = EMPTY_MASK;
#ifdef MU_MASK
  mask |= MU_MASK;
#endif
#ifdef BONUS_MASK
  mask |= ELLIPSOID_MASK | BONUS_MASK;
#endif
  return mask;
}

#ifndef BDH_INSTALLED_LAMMPS
/// The quaternion of an ellipsoid.  Newer releases keep superellipsoids in another array.
template <class Bodies> auto quaternion_of(Bodies &bodies, int k, int)
    -> decltype(&bodies.bonus_super->quat[0])
{
  return bodies.bonus ? bodies.bonus[k].quat : bodies.bonus_super[k].quat;
}
template <class Bodies> double *quaternion_of(Bodies &bodies, int k, long)
{
  return bodies.bonus[k].quat;
}
#endif

}    // namespace

bool Orientations::have_orientation() const { return atom->mu_flag || atom->ellipsoid_flag; }

/// What the atom style lacks, with the remedy; empty if the atoms can be turned.
std::string Orientations::what_is_missing() const
{
  if (!atom->torque_flag)
    return fmt::format("atoms of atom_style {} have no torque: use atom_style sphere, or hybrid "
                       "sphere dipole, or ellipsoid",
                       plain_style(atom->atom_style));
  if (!atom->omega_flag && !have_orientation())
    return fmt::format("atoms of atom_style {} have neither angular velocity nor orientation: use "
                       "atom_style sphere, or hybrid sphere dipole, or ellipsoid",
                       plain_style(atom->atom_style));
#ifdef BDH_INSTALLED_LAMMPS
  if (atom->ellipsoid_flag)
    return "quaternions of ellipsoids are out of reach in an installed LAMMPS library: build "
           "LAMMPS from source with this package, or use atom_style hybrid sphere dipole";
#endif
  return "";
}

void Orientations::choose(Rotation choice)
{
  choice_ = choice;
  const std::string missing = what_is_missing();
  if (choice == Rotation::yes && !missing.empty())
    error->all(FLERR, "{}: rotation = yes, but {}", name_, missing);
  turn_ = choice == Rotation::yes ||
          (choice == Rotation::automatic && have_orientation() && missing.empty());
}

std::string Orientations::text() const
{
  if (!turn_) return "off: keyword rotation no";
  std::string turned;
  const auto add = [&turned](const char *what) {
    turned += (turned.empty() ? "" : " and ") + std::string(what);
  };
  if (atom->mu_flag) add("dipoles");
  if (atom->ellipsoid_flag) add("quaternions");
  if (atom->omega_flag) add("omega");
  return fmt::format("on: torques turn particles ({})", turned);
}

void Orientations::gather_torques(const std::vector<int> &atoms, std::vector<double> &torque) const
{
  torque.resize(3 * atoms.size());
  const double to_core = force->ftm2v;
  for (size_t p = 0; p < atoms.size(); ++p)
    for (int d = 0; d < 3; ++d) torque[3 * p + d] = to_core * atom->torque[atoms[p]][d];
}

void Orientations::rotate(const std::vector<int> &atoms, const std::vector<double> &rotation) const
{
  sync_atoms(lmp, Host, orientation_mask(), EMPTY_MASK);
#ifndef BDH_INSTALLED_LAMMPS
  auto *bodies = atom->ellipsoid_flag
                     ? dynamic_cast<AtomVecEllipsoid *>(atom->style_match("ellipsoid"))
                     : nullptr;
#endif
  for (size_t p = 0; p < atoms.size(); ++p) {
    const int i = atoms[p];
    const bdh::Turn turn = bdh::Turn::by(rotation.data() + 3 * p);
    if (atom->mu_flag) bdh::turn_vector(turn, atom->mu[i][3], atom->mu[i]);
#ifndef BDH_INSTALLED_LAMMPS
    if (bodies && atom->ellipsoid[i] >= 0)
      bdh::turn_quaternion(turn, quaternion_of(*bodies, atom->ellipsoid[i], 0));
#endif
  }
  sync_atoms(lmp, Host, EMPTY_MASK, orientation_mask());
}

void Orientations::set_omega(const std::vector<int> &atoms, const std::vector<double> &omega) const
{
  if (!atom->omega_flag) return;
  for (size_t p = 0; p < atoms.size(); ++p)
    for (int d = 0; d < 3; ++d) atom->omega[atoms[p]][d] = omega[3 * p + d];
}
