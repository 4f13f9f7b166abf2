// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Forces within a step, for bd/fib with scheme improved and bd/pse with scheme split.  Every kind
// of force acts, and other integrators find unchanged forces and torques.

#include "lammps/lammps_mobility.h"

#include "force.h"
#include "group.h"

#include <gtest/gtest.h>

using bdh_test::AtForces;
using bdh_test::LammpsSession;

namespace {

/// Four charged atoms, on which no forces act so far.
const std::string four_atoms =
    R"(
units lj
atom_style full
atom_modify map array
boundary p p p
newton on
neigh_modify every 1 delay 0 check yes
region box block 0 8 0 8 0 8
create_box 1 box bond/types 1 angle/types 1 dihedral/types 1 improper/types 1)"
    " extra/bond/per/atom 4 extra/angle/per/atom 4 extra/dihedral/per/atom 4"
    " extra/improper/per/atom 4 extra/special/per/atom 8"
    R"(
mass 1 1.0
create_atoms 1 single 2.0 2.1 2.2
create_atoms 1 single 3.3 2.0 2.5
create_atoms 1 single 3.6 3.2 2.1
create_atoms 1 single 4.4 3.5 3.3
set atom 1 charge 2.0
set atom 2 charge -1.5
set atom 3 charge 1.0
set atom 4 charge -1.5
comm_modify cutoff 3.5
timestep 1e-7
)";

struct Kind {
  std::string name, commands;
};
const std::vector<Kind> kinds{
    {"pair", "pair_style lj/cut 2.0\npair_coeff * * 1.0 1.0"},
    {"bond", "bond_style harmonic\nbond_coeff 1 10.0 1.0\ncreate_bonds single/bond 1 1 2"},
    {"angle", "angle_style harmonic\nangle_coeff 1 10.0 60.0\ncreate_bonds single/angle 1 1 2 3"},
    {"dihedral",
     "dihedral_style harmonic\ndihedral_coeff 1 5.0 1 2\ncreate_bonds single/dihedral 1 1 2 3 4"},
    {"improper",
     "improper_style harmonic\nimproper_coeff 1 5.0 10.0\ncreate_bonds single/improper 1 1 2 3 4"},
    {"kspace", "pair_style coul/long 2.0\npair_coeff * *\nkspace_style ewald 1e-5"}};

std::vector<double> velocities(LammpsSession &lmp, const Kind &kind, const std::string &fix)
{
  lmp.script(four_atoms + kind.commands + "\n" + fix + "\nrun 1");
  return lmp.velocities();
}

/// In a step without motion, schemes with forces within the step give the same velocities as a
/// scheme without them.
void expect_same_velocities(const std::string &within, const std::string &without,
                            const std::string &kernels)
{
  for (const Kind &kind : kinds) {
    LammpsSession a, b;
    if (kind.name == "kspace" && !a->force->kspace_map->count("ewald"))
      continue;    // LAMMPS without the package KSPACE
    const auto u = velocities(a, kind, kernels + within),
               exact = velocities(b, kind, kernels + without);
    EXPECT_GT(bdh_test::length_of(exact), 0.05) << kind.name;
    EXPECT_LT(bdh_test::relative_error(u, exact), 1e-5) << kind.name;
  }
}

/// A sphere under a constant force drags nothing along, but the torque on another one depends on
/// its position.
void expect_torques_of_the_beginning(const std::string &fix, bool other_first)
{
  const double dt = 0.1, slope = 0.7;
  LammpsSession lmp;
  lmp.script(R"(
units lj
atom_style sphere
atom_modify map array
boundary p p p
neigh_modify every 1 delay 0 check yes
comm_modify cutoff 3.0
region box block 0 8 0 8 0 8
create_box 1 box
create_atoms 1 single 2 3 4
create_atoms 1 single 6 6 6
set type 1 diameter 1.0
group moving id 1
group turning id 2
timestep 0.1
)");
  LAMMPS_NS::Atom &atom = *lmp->atom;
  AtForces forces(lmp, [&](const AtForces::Call &call) {
    double at = 0.0;
    for (int i = 0; i < call.atoms; ++i)
      if (call.id[i] == 1) at = call.x[i][0];
    for (int i = 0; i < call.atoms; ++i) {
      if (call.id[i] == 1) call.force[i][0] = 20.0;
      if (call.id[i] == 2) atom.torque[i][1] = slope * at;
    }
  });
  const std::string turn = "fix turn turning nve/sphere\n";
  lmp.script(other_first ? turn + fix : fix + "\n" + turn);
  const double before = lmp.unwrapped_positions()[0];
  lmp.command("run 1");
  const double after = lmp.unwrapped_positions()[0];
  EXPECT_GT(after - before, 0.1) << fix;
  LAMMPS_NS::Atom &now = lmp.host_atoms();
  for (int i = 0; i < now.nlocal; ++i) {
    if (now.tag[i] != 2) continue;
    const double inertia = 0.4 * now.rmass[i] * 0.25;
    EXPECT_NEAR(now.omega[i][1], 0.5 * dt / inertia * slope * (before + after), 1e-10) << fix;
  }
}

const std::string
    fib = "fix move all bd/fib 0.0 1.0 7 grid 16 16 16 fft estimate ",
    pse = "fix move all bd/pse 0.0 1.0 7 radius 0.5 xi 1.0 tolerance 1e-8 fft estimate ";

}    // namespace

TEST(LammpsMidstepForces, EveryKindActsInTheImprovedScheme)
{
  expect_same_velocities("scheme improved", "scheme euler", fib);
}

TEST(LammpsMidstepForces, EveryKindActsInTheSplitScheme)
{
  expect_same_velocities("scheme split substeps 2", "scheme euler", pse);
}

TEST(LammpsMidstepForces, TorquesOfOthersAreLeftAlone)
{
  for (const bool other_first : {false, true}) {
    expect_torques_of_the_beginning(
        "fix move moving bd/fib 0.0 1.0 7 grid 16 16 16 fft estimate scheme improved", other_first);
    expect_torques_of_the_beginning(
        "fix move moving bd/pse 0.0 1.0 7 radius 0.5 fft estimate scheme split substeps 3",
        other_first);
  }
}

namespace {

/// Where two atoms are after a step, if both or only the first are in the group of the fix
/// whenever forces are evaluated within it.  At the end of the step both are.
std::vector<double> ends_if_one_leaves(const std::string &fix, bool leaves)
{
  LammpsSession lmp;
  lmp.script(R"(
units lj
atom_style atomic
atom_modify map array
boundary p p p
neigh_modify every 1 delay 0 check yes
comm_modify cutoff 3.0
region box block 0 8 0 8 0 8
create_box 1 box
create_atoms 1 single 2 3 4
create_atoms 1 single 6 6 6
mass 1 1.0
group moving id 1 2
timestep 0.1
)");
  const int bit = lmp->group->bitmask[lmp->group->find("moving")];
  AtForces forces(lmp, [&](const AtForces::Call &call) {
    LAMMPS_NS::Atom &atom = lmp.host_atoms();
    for (int i = 0; i < call.atoms; ++i) {
      call.force[i][0] = 3.0;
      if (leaves && call.id[i] == 2) atom.mask[i] &= ~bit;
    }
    LAMMPS_NS::sync_atoms(lmp.operator->(), LAMMPS_NS::Host, EMPTY_MASK, MASK_MASK);
  });
  lmp.script(fix);
  lmp.command("run 0");
  LAMMPS_NS::Atom &atom = lmp.host_atoms();
  for (int i = 0; i < atom.nlocal; ++i) atom.mask[i] |= bit;
  LAMMPS_NS::sync_atoms(lmp.operator->(), LAMMPS_NS::Host, EMPTY_MASK, MASK_MASK);
  lmp.command("run 1 pre no");
  return lmp.unwrapped_positions();
}

}    // namespace

// A step moves the particles that were in the group when it began.  Since 2022 dynamic groups
// change whenever forces are evaluated.
TEST(LammpsMidstepForces, TheGroupStaysTheSameWithinAStep)
{
  for (const std::string fix :
       {"fix move moving bd/fib 0.0 1.0 7 grid 16 16 16 fft estimate scheme improved",
        "fix move moving bd/pse 0.0 1.0 7 radius 0.5 fft estimate scheme split substeps 3"}) {
    const std::vector<double> stays = ends_if_one_leaves(fix, false);
    EXPECT_LT(bdh_test::largest_difference(stays, ends_if_one_leaves(fix, true)), 1e-14) << fix;
    EXPECT_GT(stays[0] - 2.0, 1e-3);
    EXPECT_GT(stays[3] - 6.0, 1e-3);
  }
}
