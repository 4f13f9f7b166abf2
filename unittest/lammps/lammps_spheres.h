// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Dipoles of different radii in a field, for tests of fix bd/pse with unequal radii and rotation.
#ifndef BDH_TEST_LAMMPS_SPHERES_H
#define BDH_TEST_LAMMPS_SPHERES_H

#include "lammps/lammps_turning.h"
#include "oracle/dense_spheres.h"

namespace bdh_test {

/// 20 spheres with radii from 0.25 to 1, some of which overlap, with dipoles in a tilted box.
const char *const dipole_spheres = R"(
units lj
atom_style hybrid sphere dipole
atom_modify map array
boundary p p p
region box prism 0 6 0 7 0 5 1.2 -0.8 1.5
create_box 1 box
create_atoms 1 random 20 77 NULL
set group all dipole/random 31 1.3
set atom 1*7 diameter 2.0
set atom 8*14 diameter 0.9
set atom 15*20 diameter 0.5
pair_style zero 0.5
pair_coeff * *
neighbor 0.3 bin
neigh_modify every 1 delay 0 check yes
timestep 1e-4
)";

/// No forces between the spheres, and the time step: a restart file contains neither.
const char *const no_forces = "pair_style zero 0.5\npair_coeff * *\ntimestep 1e-3\n";

const double field[3] = {0.4, -0.7, 0.5};
const char *const field_command = "fix field all efield 0.4 -0.7 0.5\n";

inline std::vector<double> radii(LammpsSession &lmp, MPI_Comm comm = MPI_COMM_SELF)
{
  return by_id(
      lmp, 1, [](const LAMMPS_NS::Atom &a, int i) { return a.radius + i; }, comm);
}
inline std::vector<double> dipoles(LammpsSession &lmp, MPI_Comm comm = MPI_COMM_SELF)
{
  return by_id(
      lmp, 3, [](const LAMMPS_NS::Atom &a, int i) { return a.mu[i]; }, comm);
}

/// The torques mu x E of the field.
inline std::vector<double> field_torques(const std::vector<double> &mu)
{
  std::vector<double> torque;
  for (std::size_t i = 0; i < mu.size(); i += 3)
    for (std::size_t d = 0; d < 3; ++d) {
      const std::size_t e = (d + 1) % 3, f = (d + 2) % 3;
      torque.push_back(mu[i + e] * field[f] - mu[i + f] * field[e]);
    }
  return torque;
}

/// All velocities, then all angular velocities, by the dense oracle at the present positions and
/// radii.
inline std::vector<double> exact_motions(LammpsSession &lmp, double viscosity,
                                         const std::vector<double> &force,
                                         const std::vector<double> &torque)
{
  const std::size_t n = force.size() / 3;
  const std::vector<double> M =
      bdh::dense_spheres(cell_of(lmp), lmp.unwrapped_positions(), radii(lmp), viscosity);
  std::vector<double> motion(6 * n, 0.0);
  for (std::size_t i = 0; i < 6 * n; ++i)
    for (std::size_t j = 0; j < 6 * n; ++j)
      motion[i] += M[i * 6 * n + j] * (j < 3 * n ? force[j] : torque[j - 3 * n]);
  return motion;
}

/// |a - b|/|b| of numbers first .. first + a.size() - 1 of b.
inline double part_error(const std::vector<double> &a, const std::vector<double> &b,
                         std::size_t first)
{
  double difference = 0.0, size = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    difference += std::pow(a[k] - b[first + k], 2);
    size += std::pow(b[first + k], 2);
  }
  return std::sqrt(difference / size);
}

}    // namespace bdh_test
#endif
