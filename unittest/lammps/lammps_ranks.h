// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// One trajectory on different numbers of ranks, for tests that run under mpirun -np 4.
#ifndef BDH_TEST_LAMMPS_RANKS_H
#define BDH_TEST_LAMMPS_RANKS_H

#include "lammps/lammps_session.h"

#include <functional>
#include <gtest/gtest.h>

namespace bdh_test {

/// 120 WCA particles and 3 bonds in a box that is not cubic and whose edges are not round numbers.
const char *const bonded_suspension = R"(
units lj
atom_style bond
atom_modify map array
boundary p p p
newton on
region box block 0 10 0 12 0 8
create_box 1 box bond/types 1 extra/bond/per/atom 2
lattice sc 0.125
create_atoms 1 box
displace_atoms all random 0.3 0.3 0.3 5 units box
mass 1 1.0
pair_style lj/cut 1.122462048309373
pair_coeff 1 1 1.0 1.0
bond_style harmonic
bond_coeff 1 50.0 1.8
create_bonds single/bond 1 1 2
create_bonds single/bond 1 2 3
create_bonds single/bond 1 21 22
special_bonds lj 1 1 1
comm_modify cutoff 3.0
neighbor 0.1 bin
neigh_modify every 1 delay 0 check yes
timestep 0.004
)";

/// The settings that a restart file does not contain.
const char *const after_restart = R"(
comm_modify cutoff 3.0
neighbor 0.1 bin
neigh_modify every 1 delay 0 check yes
timestep 0.004
)";

inline int my_rank()
{
  int me;
  MPI_Comm_rank(MPI_COMM_WORLD, &me);
  return me;
}

inline int all_ranks()
{
  int size;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

/// Collective.  A name for a restart file of this test: several tests may run in one folder.
inline std::string restart_file(const std::string &name)
{
  int unique = getpid();    // that of rank 0
  MPI_Bcast(&unique, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return "test_" + name + "_" + std::to_string(unique) + ".restart";
}

/// Runs `action` in a session on the first `ranks` ranks of the world that goes on from a restart
/// file, which is removed then; the other ranks wait.  processors: arguments of LAMMPS' command of
/// that name, or empty
inline void from_restart(int ranks, const std::string &file, const std::string &processors,
                         const std::function<void(LammpsSession &)> &action)
{
  const int me = my_rank();
  MPI_Barrier(MPI_COMM_WORLD);
  MPI_Comm comm;
  MPI_Comm_split(MPI_COMM_WORLD, me < ranks ? 0 : MPI_UNDEFINED, me, &comm);
  if (comm != MPI_COMM_NULL) {
    // An error on one rank would leave the others waiting.
    try {
      LammpsSession lmp(comm);
      if (!processors.empty()) lmp.command("processors " + processors);
      lmp.command("read_restart " + file);
      lmp.script(after_restart);
      action(lmp);
    } catch (LAMMPS_NS::LAMMPSException &e) {
      fprintf(stderr, "%s", e.what());
      MPI_Abort(MPI_COMM_WORLD, 1);
    }
    MPI_Comm_free(&comm);
  }
  MPI_Barrier(MPI_COMM_WORLD);
  if (me == 0) std::remove(file.c_str());
}

/// Runs `action` in a session on the first `ranks` ranks of the world, after reading the scene
/// `before`; the other ranks wait.  One rank creates the atoms, since create_atoms numbers them by
/// rank.  processors: see from_restart()
inline void on_ranks(int ranks, const std::string &before, const std::string &processors,
                     const std::function<void(LammpsSession &)> &action)
{
  const std::string file = restart_file("ranks");
  if (my_rank() == 0) {
    LammpsSession lmp;
    lmp.script(before);
    lmp.script("run 0\nwrite_restart " + file);
  }
  from_restart(ranks, file, processors, action);
}

/// Positions after some steps; empty on ranks that do not take part.
inline std::vector<double> trajectory(int ranks, const std::string &fix, int steps,
                                      const std::string &before = bonded_suspension,
                                      const std::string &processors = "")
{
  std::vector<double> x;
  on_ranks(ranks, before, processors, [&](LammpsSession &lmp) {
    lmp.script(fix);
    lmp.command("run " + std::to_string(steps));
    x = lmp.unwrapped_positions();
  });
  return x;
}

// Round-off (1e-16) grows through 40 steps of colliding particles; a wrong or missing contribution
// is at least 1e-2.
inline void expect_same_on_all_rank_counts(const std::string &fix, int steps,
                                           const std::string &before = bonded_suspension,
                                           double bound = 1e-9)
{
  std::vector<double> reference;
  for (int ranks = 1; ranks <= all_ranks(); ++ranks) {
    const std::vector<double> x = trajectory(ranks, fix, steps, before);
    if (my_rank()) continue;
    if (ranks == 1) reference = x;
    EXPECT_FALSE(x.empty());
    EXPECT_LT(largest_difference(x, reference), bound) << ranks << " ranks";
  }
}

}    // namespace bdh_test
#endif
