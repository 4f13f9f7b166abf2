// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/pse in changing boxes: M f of every step is compared with direct Ewald sums for the
// positions and the cell of that step.  fix deform and fix press/berendsen change box and positions
// at the end of a step, after the forces.

#include "lammps/lammps_mobility.h"

#include "domain.h"

#include <gtest/gtest.h>

using bdh_test::GivenForces;
using bdh_test::LammpsSession;

namespace {

const std::string leaning_box = R"(
units lj
atom_style atomic
atom_modify map array
boundary p p p
region box prism 0 6 0 5 0 7 2.85 -2.8 -2.3
create_box 1 box
create_atoms 1 random 20 77 NULL
mass 1 1.0
neighbor 0.5 bin
neigh_modify every 1 delay 0 check yes
timestep 0.01
)";

const double radius = 0.8, viscosity = 1.3, tolerance = 1e-6;
const std::string move =
    "fix move all bd/pse 0.0 1.3 1 radius 0.8 xi 0.6 tolerance 1e-6 fft estimate";

std::vector<double> forces_of(LammpsSession &lmp)
{
  const LAMMPS_NS::Atom &atom = *lmp->atom;
  std::vector<double> f(3 * atom.natoms);
  for (int i = 0; i < atom.nlocal; ++i)
    for (int d = 0; d < 3; ++d) f[3 * (atom.tag[i] - 1) + d] = atom.f[i][d];
  return f;
}

/// Takes the steps one by one without a setup in between and checks each `every`-th one.  Returns
/// the number of flips.
int expect_mobility_of_every_step(LammpsSession &lmp, int steps, int every = 1)
{
  const std::string range = " start 0 stop " + std::to_string(steps);
  lmp.command("run 0 post no" + range);
  int flips = 0;
  double worst = 0.0;
  for (int step = 1; step <= steps; ++step) {
    const bdh::Cell before = bdh_test::cell_of(lmp);
    std::vector<double> exact;
    if (step % every == 0)
      exact = bdh_test::exact_velocities(lmp, radius, viscosity, forces_of(lmp));
    lmp.command("run 1 pre no post no" + range);
    if (step % every == 0) {
      const double error = bdh_test::relative_error(lmp.velocities(), exact);
      EXPECT_LE(error, tolerance) << "step " << step;
      worst = std::max(worst, error);
    }
    const bdh::Cell after = bdh_test::cell_of(lmp);
    flips += std::fabs(after.xy - before.xy) > 0.4 * before.lx ||
             std::fabs(after.xz - before.xz) > 0.4 * before.lx ||
             std::fabs(after.yz - before.yz) > 0.4 * before.ly;
  }
  EXPECT_GT(worst, 0.0);
  return flips;
}

/// Takes steps under fix deform with one set of random forces.
int deform(LammpsSession &lmp, const std::string &how, int steps, int every = 1)
{
  lmp.script(leaning_box);
  GivenForces forces(lmp, bdh_test::random_vector(60, 3));
  lmp.script("fix change all deform 1 " + how + " remap x\n" + move);
  return expect_mobility_of_every_step(lmp, steps, every);
}

}    // namespace

TEST(LammpsPseBox, ShearThroughFlips)
{
  for (const std::string how : {"xy erate 1.5", "xz erate -1.5", "yz erate -1.5"}) {
    LammpsSession lmp;
    EXPECT_GE(deform(lmp, how, 12), 1) << how;
    EXPECT_NE(lmp.log().find("changes during the run"), std::string::npos);
  }
}

// Without flips the tilt keeps growing, and wave vectors and images must follow it.
TEST(LammpsPseBox, ShearWithoutFlips)
{
  LammpsSession lmp;
  EXPECT_EQ(deform(lmp, "xy erate 1.5 flip no", 80, 8), 0);
  EXPECT_GT(lmp->domain->xy, 6.0);
}

TEST(LammpsPseBox, GridGrowsWithTheBox)
{
  LammpsSession lmp;
  deform(lmp, "x erate 1.0 y erate 0.5 z erate -0.5", 60, 6);
  EXPECT_NE(lmp.log().find("the box has changed, new grid "), std::string::npos);
  EXPECT_GT(lmp->domain->xprd, 9.5);
}

TEST(LammpsPseBox, PressureControl)
{
  LammpsSession lmp;
  lmp.script("units lj\natom_style atomic\natom_modify map array\nboundary p p p\nregion box block "
             "0 6 0 4.5 0 7.5\n"
             "create_box 1 box\nlattice sc 0.2962962962962963\ncreate_atoms 1 box\nmass 1 "
             "1.0\npair_style lj/cut 1.5\npair_coeff 1 1 1.0 1.0\n"
             "neighbor 0.5 bin\nneigh_modify every 1 delay 0 check yes\ntimestep 0.005");
  GivenForces forces(lmp, bdh_test::random_vector(3 * lmp->atom->natoms, 3));
  lmp.script(move + "\nfix barostat all press/berendsen iso 2.0 2.0 0.2 modulus 10.0");
  const double before = lmp->domain->xprd;
  EXPECT_EQ(expect_mobility_of_every_step(lmp, 20, 2), 0);
  EXPECT_GT(std::fabs(lmp->domain->xprd - before), 1e-3);
}

// change_box between two runs, and forces in the new box.
TEST(LammpsPseBox, ChangeBoxBetweenRuns)
{
  LammpsSession lmp;
  lmp.script(leaning_box);
  GivenForces forces(lmp, bdh_test::random_vector(60, 3));
  lmp.script(move + "\nrun 1\nchange_box all x final 0 12 xy final -4 remap");
  const auto exact = bdh_test::exact_velocities(lmp, radius, viscosity, forces());
  lmp.command("run 1");
  EXPECT_LE(bdh_test::relative_error(lmp.velocities(), exact), tolerance);
}
