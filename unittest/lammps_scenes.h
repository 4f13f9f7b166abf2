// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Scenes that tests of both fixes run, and runs that are broken and continued.
#ifndef BDH_TEST_LAMMPS_SCENES_H
#define BDH_TEST_LAMMPS_SCENES_H

#include "lammps_session.h"

namespace bdh_test {

/// 64 attracting particles on a lattice.
const char *const lattice_suspension = R"(
units lj
atom_style atomic
atom_modify map array
boundary p p p
region box block 0 8 0 8 0 8
create_box 1 box
lattice sc 0.125
create_atoms 1 box
mass 1 1.0
pair_style lj/cut 2.5
pair_coeff 1 1 1.0 1.0
neighbor 0.4 bin
neigh_modify every 1 delay 0 check yes
timestep 0.002
)";

/// Positions after 25 + 25 steps, in one session or with a restart file between.
inline std::vector<double> run_twice_through_restart(const std::string &fix, bool restart)
{
  const std::string file = "test_" + std::to_string(getpid()) + ".restart";
  std::vector<double> x;
  {
    LammpsSession lmp;
    lmp.script(lattice_suspension);
    lmp.script(fix);
    lmp.command("run 25");
    if (!restart) {
      // a restart file holds wrapped positions and a new neighbor list: give the unbroken run the same
      lmp.command("run 25");
      return lmp.unwrapped_positions();
    }
    lmp.command("write_restart " + file);
  }
  LammpsSession lmp;
  lmp.command("read_restart " + file);
  lmp.script("neighbor 0.4 bin\nneigh_modify every 1 delay 0 check yes\ntimestep 0.002");
  lmp.script(fix);
  lmp.command("run 25");
  x = lmp.unwrapped_positions();
  std::remove(file.c_str());
  return x;
}

}    // namespace bdh_test
#endif
