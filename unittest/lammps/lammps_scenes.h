// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Scenes for tests of both fixes, and runs that are interrupted and continued.
#ifndef BDH_TEST_LAMMPS_SCENES_H
#define BDH_TEST_LAMMPS_SCENES_H

#include "lammps/lammps_session.h"

#include <gtest/gtest.h>

#include <string>

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
thermo_style custom step pe
)";

/// A closed channel a thousand times as long as it is wide, and its walls.  Its pressure does not
/// converge to 1e-14.
const char *const long_channel = R"(
units lj
dimension 2
atom_style atomic
atom_modify map array
boundary f f p
neigh_modify every 1 delay 0 check yes
comm_modify cutoff 2.0
region box block 0 4000 0 4 -0.5 0.5
create_box 1 box
create_atoms 1 single 3.2 1.7 0
mass 1 1.0
fix push all addforce 1.0 0.5 0.0
)";
const char *const channel_walls =
    " wall xlo noslip wall xhi noslip wall ylo noslip wall yhi noslip ";

inline void expect_unconverged_pressure(const std::string &message)
{
  for (const char *words :
       {": the pressure has not converged after 1000 iterations: estimated error ",
        ", but 1e-14 is asked for", ": use a looser tolerance, or a less elongated box"})
    EXPECT_NE(message.find(words), std::string::npos) << message;
}

/// Positions after 25 + 25 steps, in one session or with a restart file in between.
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
      // After a restart positions are wrapped and the neighbor list is new.  This does the same in
      // the uninterrupted run.
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
