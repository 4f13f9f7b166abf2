// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Torques on atoms and what turns, for tests of rotation in both fixes.
#ifndef BDH_TEST_LAMMPS_TURNING_H
#define BDH_TEST_LAMMPS_TURNING_H

#include "lammps/lammps_mobility.h"

namespace bdh_test {

/// Numbers of all atoms by id, on every rank: `columns` of what `of(atom, i)` points to.
template <class Of> std::vector<double> by_id(LammpsSession &lmp, int columns, const Of &of,
                                              MPI_Comm comm = MPI_COMM_SELF)
{
  const LAMMPS_NS::Atom &atom = lmp.host_atoms();
  std::vector<double> mine(columns * atom.natoms, 0.0), all(mine.size());
  for (int i = 0; i < atom.nlocal; ++i)
    std::copy_n(of(atom, i), columns, mine.data() + columns * (atom.tag[i] - 1));
  MPI_Allreduce(mine.data(), all.data(), mine.size(), MPI_DOUBLE, MPI_SUM, comm);
  return all;
}
inline std::vector<double> omegas(LammpsSession &lmp, MPI_Comm comm = MPI_COMM_SELF)
{
  return by_id(
      lmp, 3, [](const LAMMPS_NS::Atom &a, int i) { return a.omega[i]; }, comm);
}

/// Sets torques at every evaluation of forces, by atom id, 3 numbers each.  The object must outlive
/// the runs.
class GivenTorques {
 public:
  GivenTorques(LammpsSession &lmp, std::vector<double> torque) :
      torque_(std::move(torque)), hook_(lmp, [this, &lmp](const AtForces::Call &call) {
        for (int i = 0; i < call.atoms; ++i)
          for (int d = 0; d < 3; ++d) lmp->atom->torque[i][d] += torque_[3 * (call.id[i] - 1) + d];
      })
  {}

 private:
  std::vector<double> torque_;
  AtForces hook_;
};

}    // namespace bdh_test
#endif
