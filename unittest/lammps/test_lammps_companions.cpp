// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Other commands in the input script.  There is one warning about styles that act on velocities,
// about rotations, about atoms that something is meant to hold and about atoms that a box leaves
// behind, and none about harmless styles.  Also second integrators and exclusions that appear,
// continued runs, and what other styles require of a thermostat.

#include "lammps/lammps_mobility.h"
#include "lammps/lammps_scenes.h"

#include "force.h"

#include <regex>

using bdh_test::LammpsSession;
using bdh_test::largest_difference;

namespace {

const char points[] = R"(
units lj
atom_style atomic
atom_modify map array
neigh_modify every 1 delay 0 check yes
region box block 0 8 0 8 0 8
create_box 2 box
create_atoms 1 single 1 2 3
create_atoms 1 single 5 2 3
create_atoms 1 single 5 6 3
create_atoms 2 single 2 6 6
mass * 1.0
group brown id 1:3
group rest id 4
thermo_style custom step
)";

const char spheres[] = R"(
units lj
atom_style sphere
atom_modify map array
neigh_modify every 1 delay 0 check yes
comm_modify vel yes
region box block 0 8 0 8 0 8
create_box 1 box
create_atoms 1 single 1 2 3
create_atoms 1 single 2.1 2 3
set group all diameter 1.0
group brown id 1:2
thermo_style custom step
)";

const char ellipsoids[] = R"(
units lj
atom_style ellipsoid
atom_modify map array
neigh_modify every 1 delay 0 check yes
region box block 0 8 0 8 0 8
create_box 1 box
create_atoms 1 single 1 2 3
create_atoms 1 single 5 2 3
group brown id 1
set group all mass 1.0
thermo_style custom step
)";

const char dipoles[] = R"(
units lj
atom_style dipole
atom_modify map array
neigh_modify every 1 delay 0 check yes
region box block 0 8 0 8 0 8
create_box 1 box
create_atoms 1 single 1 2 3
create_atoms 1 single 5 2 3
mass 1 1
group brown id 1
thermo_style custom step
)";

const char spinners[] = R"(
units lj
atom_style hybrid sphere dipole
atom_modify map array
neigh_modify every 1 delay 0 check yes
region box block 0 8 0 8 0 8
create_box 1 box
create_atoms 1 single 1 2 3
create_atoms 1 single 5 2 3
set group all diameter 1.0
group brown id 1:2
thermo_style custom step
)";

const char charges[] = R"(
units lj
atom_style charge
atom_modify map array
neigh_modify every 1 delay 0 check yes
region box block 0 8 0 8 0 8
create_box 1 box
create_atoms 1 single 1 2 3
create_atoms 1 single 5 2 3
mass 1 1
set group all charge 1
group brown id 1 2
thermo_style custom step
)";

const char tilted[] = R"(
units lj
atom_style atomic
atom_modify map array
neigh_modify every 1 delay 0 check yes
region box prism 0 8 0 8 0 8 0 0 0
create_box 1 box
create_atoms 1 single 1 2 3
create_atoms 1 single 5 2 3
mass 1 1.0
group brown id 1:2
group first id 1
thermo_style custom step
)";

const char flat[] = R"(
units lj
dimension 2
atom_style atomic
atom_modify map array
neigh_modify every 1 delay 0 check yes
region box block 0 8 0 8 -0.5 0.5
create_box 1 box
create_atoms 1 single 1 2 0
mass 1 1
thermo_style custom step
)";

#define FIB "fix move brown bd/fib 1.0 1.0 5 grid 8 8 8\n"
#define UNTURNED "fix move brown bd/fib 1.0 1.0 5 grid 8 8 8 rotation no\n"
#define PSE "fix move brown bd/pse 1.0 1.0 5 radius 1\n"
#define PSE_STILL "fix move brown bd/pse 1.0 1.0 5 radius 1 rotation no\n"

struct Case {
  const char *scene, *commands, *warning;
};

/// Removes the suffixes that the KOKKOS package adds to the names of styles.
std::string plain(const std::string &text)
{
  return std::regex_replace(text, std::regex("/kk(/device|/host)?"), "");
}

/// Warnings of this package's fixes, one per line.
std::vector<std::string> own_warnings(const std::string &log)
{
  std::vector<std::string> all;
  std::istringstream in(log);
  for (std::string line; std::getline(in, line);)
    if (std::regex_search(line, std::regex("^WARNING: fix (temp/)?(bd|brownian)/")))
      all.push_back(plain(line));
  return all;
}

std::string joined(const std::vector<std::string> &lines)
{
  std::string text;
  for (const auto &l : lines) text += l + "\n";
  return text;
}

/// Counts a style that this LAMMPS lacks, or has no variant of for the KOKKOS package.
bool is_missing(const std::string &message)
{
  return message.find("not enabled in this LAMMPS") != std::string::npos ||
         message.find("not yet implemented with kokkos") != std::string::npos;
}

/// All cases exist in a LAMMPS without KOKKOS and with the packages that the build chooses.
bool knows_all()
{
  LammpsSession lmp;
  const auto &pairs = *lmp->force->pair_map;
  const auto &fixes = *lmp->modify->fix_map;
  return !lmp->kokkos && pairs.count("gayberne") && pairs.count("lj/cut/dipole/cut") &&
         pairs.count("lubricate") && fixes.count("efield") && fixes.count("viscosity");
}

/// Runs the commands and returns the warnings; false if this LAMMPS lacks one of the styles.
bool run_case(LammpsSession &lmp, const Case &c, std::vector<std::string> &warnings)
{
  if (!lmp.error_of(c.scene).empty()) return false;
  const std::string message = lmp.error_of(c.commands);
  if (is_missing(message)) return false;
  EXPECT_EQ(message, "") << c.commands;
  warnings = own_warnings(lmp.log());
  return true;
}

/// At least this many of the cases must exist in every LAMMPS that runs these tests.
template <size_t n> void expect_one_warning_each(const Case (&cases)[n], size_t at_least)
{
  size_t known = 0;
  for (const Case &c : cases) {
    LammpsSession lmp;
    std::vector<std::string> warnings;
    if (!run_case(lmp, c, warnings)) continue;
    ++known;
    EXPECT_EQ(warnings.size(), 1u) << c.commands << "\n" << joined(warnings);
    EXPECT_NE(joined(warnings).find(c.warning), std::string::npos)
        << c.commands << "\nwanted: " << c.warning << "\ngot: " << joined(warnings);
  }
  EXPECT_GE(known, knows_all() ? n : at_least);
}

template <size_t n> void expect_no_warning(const Case (&cases)[n], size_t at_least)
{
  size_t known = 0;
  for (const Case &c : cases) {
    LammpsSession lmp;
    std::vector<std::string> warnings;
    if (!run_case(lmp, c, warnings)) continue;
    ++known;
    EXPECT_EQ(joined(warnings), "") << c.commands;
  }
  EXPECT_GE(known, knows_all() ? n : at_least);
}

}    // namespace

// Each runs twice, since a warning must not be repeated.
TEST(Companions, WhatActsOnVelocities)
{
  const Case cases[] = {
      {points, PSE "fix 2 all viscosity 1 x z 4\nrun 2\nrun 2",
       "fix 2 viscosity acts on velocities"},
      {points, FIB "fix 2 brown viscosity 1 x z 4\nrun 2\nrun 2", "its flux is meaningless"},
      {points, PSE "fix 2 all thermal/conductivity 1 z 4\nrun 2",
       "fix 2 thermal/conductivity acts on"},
      {points, PSE "fix 2 all heat 1 0.1\nrun 2", "fix 2 heat acts on velocities"},
      {points, FIB "fix 2 all ehex 1 0.1\nrun 2", "fix 2 ehex acts on velocities"},
      {points, FIB "fix 2 brown momentum 1 linear 1 1 1\nrun 2\nrun 2", "use fix recenter"},
      {points, PSE "fix 2 all temp/rescale 1 1 1 0.1 1\nrun 2", "fix 2 temp/rescale acts on"},
      {points, PSE "fix 2 all temp/csvr 1 1 1 54\nrun 2", "fix 2 temp/csvr acts on velocities"},
      {points, PSE "fix 2 all langevin 1 1 1 54\nrun 2", "friction and noise come from the fluid"},
      {points, FIB "fix 2 all viscous 1\nrun 2\nrun 2", "acts on velocities"},
      {points, PSE "fix 2 all propel/self velocity 1\nrun 2", "no direction of swimming"},
      {points, FIB "fix 2 all flow/gauss 1 0 0\nrun 2", "fix 2 flow/gauss acts on velocities"},
      {points, FIB "region half block 0 4 INF INF INF INF\nfix 2 all oneway 1 half x\nrun 2",
       "fix 2 oneway acts on velocities"},
      {points, "neigh_modify every 1\n" PSE "group late empty\nfix 2 brown viscous 1\nrun 1",
       "acts on velocities"},
      {spheres, "pair_style lubricate 1 1 1 1.05 2\npair_coeff * *\n" PSE "run 0",
       "pair style lubricate acts on velocities"},
  };
  expect_one_warning_each(cases, 8);
}

TEST(Companions, WhatDoesNot)
{
  const Case cases[] = {
      // Forces that depend on positions.
      {points, PSE "fix 2 all drag 4 4 4 0.1 0.1\nrun 2", nullptr},
      {points, FIB "fix 2 all spring/self 1\nfix 3 all addforce 1 0 0\nrun 2", nullptr},
      {points, FIB "fix 2 all indent 1 sphere 4 4 4 1\nfix 3 all gravity 1 vector 0 0 1\nrun 2",
       nullptr},
      {points, PSE "fix 2 all setforce 1.0 0.0 0.0\nrun 2", nullptr},
      {points, PSE "fix 2 all setforce NULL NULL 2.0\nrun 2", nullptr},
      {charges, PSE "fix 2 all efield 1 0 0\nrun 2", nullptr},
      // Styles that act on other atoms.
      {points, PSE "fix 2 rest nve\nfix 3 rest langevin 1 1 1 5\nrun 2", nullptr},
      {points, FIB "fix 2 rest nvt temp 1 1 1\nfix 3 rest momentum 1 linear 1 1 1\nrun 2", nullptr},
      {points, PSE "fix 2 rest nve\nfix 3 rest viscous 1\nfix 4 rest setforce 0 0 0\nrun 2",
       nullptr},
      {points, PSE "fix 2 rest setforce 0 0 0\nfix 3 rest heat 1 0.1\nrun 2", nullptr},
      // Styles that move, mirror, measure or print.
      {points, PSE "fix 2 all recenter 4 4 4 units box\nrun 2", nullptr},
      {points,
       "change_box all boundary p p f\nfix move brown bd/fib 1 1 5 grid 8 8 8 wall zlo noslip wall "
       "zhi noslip\nfix 2 all wall/reflect zlo EDGE zhi EDGE\nfix 3 all wall/harmonic zlo EDGE 1 1 "
       "1\nrun 2",
       nullptr},
      {points, PSE "compute t all temp\nfix 2 all ave/time 1 2 2 c_t\nfix 3 all print 1 x\nrun 4",
       nullptr},
      {points, PSE "fix 2 all store/state 1 vx vy\nfix 3 all ave/atom 1 1 1 vx\nrun 4", nullptr},
      // Velocities of ghost atoms, without a use for them.
      {points, "comm_modify vel yes\npair_style lj/cut 1\npair_coeff * * 1 1\n" PSE "run 1",
       nullptr},
      // Boxes that carry all atoms along.
      {tilted, PSE "fix 2 all deform 1 xy erate 0.1 remap x\nrun 2", nullptr},
      {tilted, PSE "fix 2 brown deform 1 x erate 0.1\nrun 2", nullptr},
      // No motion out of the plane.
      {flat, "fix move all bd/fib 1 1 5 grid 8 8 1\nfix 2 all setforce NULL NULL 0\nrun 2",
       nullptr},
      {flat, "fix move all bd/fib 1 1 5 grid 8 8 1\nfix 2 all enforce2d\nrun 2", nullptr},
      // Atoms that this fix turns.
      {spinners,
       "set group all dipole 1 0 0\nset atom 2 dipole 0 1 0\npair_style lj/cut/dipole/cut 1.1 "
       "6\npair_coeff * * 1 1\n" FIB "run 1",
       nullptr},
      {ellipsoids, "set group all shape 2 1 1\nset group all quat 0 0 1 30\n" FIB "run 1", nullptr},
      {spinners, "set group all dipole 1 0 0\n" FIB "fix 2 all propel/self dipole 1\nrun 2",
       nullptr},
      // Atoms that can rotate, but do not.
      {spheres, PSE "run 2", nullptr},
      {spheres, "pair_style lj/cut 1\npair_coeff * * 1 1\n" FIB "run 2", nullptr},
      {ellipsoids, "set group all shape 1 1 1\n" FIB "run 2", nullptr},
      {ellipsoids, "set atom 2 shape 2 1 1\nset atom 2 quat 0 0 1 30\n" FIB "run 2", nullptr},
      {dipoles, "set atom 2 dipole 1 0 0\n" FIB "run 2", nullptr},
  };
  expect_no_warning(cases, 15);
}

TEST(Companions, TorquesAndOrientations)
{
  const Case cases[] = {
      {dipoles, "set group all dipole 1 0 0\n" FIB "run 2\nrun 2",
       "have dipoles, but nothing rotates"},
      // Its force is along the dipole and not along the velocity.
      {dipoles, "set group all dipole 1 0 0\n" PSE_STILL "fix 2 all propel/self dipole 1\nrun 2",
       "have dipoles, but nothing rotates"},
      {dipoles, "set group all dipole 1 0 0\n" FIB "fix 2 all efield 0 0 3\nrun 2",
       "but nothing rotates them"},
      {spinners,
       "set group all dipole 1 0 0\nset atom 2 dipole 0 1 0\npair_style lj/cut/dipole/cut 1.1 "
       "6\npair_coeff * * 1 1\n" PSE_STILL "run 1",
       "have dipoles and torques, but nothing rotates them"},
      {ellipsoids, "set group all shape 2 1 1\nset group all quat 0 0 1 30\n" UNTURNED "run 1",
       "have orientations, but nothing rotates them: use rotation yes"},
      {spinners,
       "set group all dipole 1 0 0\nset atom 2 dipole 0 1 0\npair_style lj/cut/dipole/cut 1.1 "
       "6\npair_coeff * * 1 1\n" UNTURNED "run 1",
       "have dipoles and torques, but nothing rotates them: use rotation yes"},
      {ellipsoids,
       "set group all shape 2 1 1\nset group all quat 0 0 1 30\npair_style gayberne 1 3 1 "
       "6\npair_coeff * * 1 1 1 1 0.2 1 1 0.2 6\n" PSE_STILL "run 1",
       "have orientations and torques, but nothing rotates them"},
  };
  expect_one_warning_each(cases, 0);
  // This style causes a second warning, about its friction, and needs no package.
  LammpsSession lmp;
  const std::string message =
      lmp.error_of(std::string(spheres) + FIB "fix 2 all langevin 1 1 1 5 omega yes\nrun 2");
  if (is_missing(message)) return;
  EXPECT_EQ(message, "");
  const auto warnings = own_warnings(lmp.log());
  EXPECT_EQ(warnings.size(), 2u) << joined(warnings);
  EXPECT_NE(joined(warnings).find("have torques, but nothing rotates them"), std::string::npos)
      << joined(warnings);
}

// The table of names has no entry for this.
TEST(Companions, TorquesThatBeginLate)
{
  LammpsSession lmp;
  lmp.script(spheres);
  lmp.script("neigh_modify every 1 delay 0 check no");
  bdh_test::AtForces turn(lmp, [&](const bdh_test::AtForces::Call &call) {
    if (call.step >= 3) lmp->atom->torque[0][2] = 0.1;
  });
  lmp.script(PSE "run 2");
  EXPECT_EQ(joined(own_warnings(lmp.log())), "");
  lmp.script("run 6");
  EXPECT_EQ(own_warnings(lmp.log()).size(), 1u) << joined(own_warnings(lmp.log()));
  EXPECT_NE(lmp.log().find("have torques, but nothing rotates them"), std::string::npos);
}

// A fix that is in no table is found by its effect on the velocities.
TEST(Companions, UnknownFixThatChangesVelocities)
{
  for (const char *fluid : {FIB, PSE}) {
    for (const bool changes : {false, true}) {
      LammpsSession lmp;
      lmp.script(points);
      bdh_test::AtForces swap(lmp, [&](const bdh_test::AtForces::Call &) {
        lmp.host_atoms();
        if (changes) std::swap(lmp->atom->v[0][0], lmp->atom->v[2][0]);
      });
      lmp.script(std::string(fluid) + "run 6\nrun 2");
      const auto warnings = own_warnings(lmp.log());
      EXPECT_EQ(warnings.size(), changes ? 1u : 0u) << joined(warnings);
      if (changes) {
        EXPECT_NE(joined(warnings).find("fix at_forces external changed velocities at step 1"),
                  std::string::npos)
            << joined(warnings);
      }
    }
  }
}

// Velocities that leave with their atoms have not changed.
TEST(Companions, UnknownFixThatRemovesAtoms)
{
  LammpsSession lmp;
  lmp.script(points);
  if (!lmp->modify->fix_map->count("evaporate")) GTEST_SKIP() << "without package MISC";
  lmp.script(PSE "run 1\nregion all block INF INF INF INF INF INF\n"
                 "fix 2 brown evaporate 1 1 all 49\nrun 2");
  EXPECT_EQ(lmp->atom->natoms, 2);
  EXPECT_EQ(joined(own_warnings(lmp.log())), "");
}

// Commands between runs may change velocities.
TEST(Companions, VelocitiesChangedBetweenRuns)
{
  LammpsSession lmp;
  lmp.script(points);
  lmp.script("fix 2 all print 1 x\n" PSE
             "run 1\nvelocity all set 1 0 0\nrun 2 pre no\nvelocity all "
             "set 0 1 0\nrun 2");
  EXPECT_EQ(joined(own_warnings(lmp.log())), "");
}

TEST(Companions, AtomsThatSomethingMeansToHold)
{
  const Case cases[] = {
      {points, PSE "fix 2 all setforce 0 0 0\nvelocity all set 0 0 0\nrun 2\nrun 2",
       "fix 2 setforce removes forces, as if to hold atoms where they are"},
      {points, FIB "group one id 2\nfix 2 one setforce 0.0 0.0 0.0\nrun 2",
       "leave them out of group brown (the fluid then flows through them), or tie them with fix "
       "spring/self"},
      {points, FIB "fix 2 all setforce NULL NULL 0.0\nrun 2", "hold atoms at their z"},
      {points, PSE "fix 2 all planeforce 0 0 1\nrun 2", "hold atoms in a plane"},
      {points, FIB "fix 2 brown lineforce 0 0 1\nrun 2", "hold atoms on a line"},
  };
  expect_one_warning_each(cases, 5);
}

// The remedies that the warning suggests.
TEST(Companions, AnObstacleOutsideTheGroupStays)
{
  const std::string flow = "fix push brown addforce 3 0 0\nfix move brown bd/pse 0 1 5 radius 1\n"
                           "timestep 0.1\nrun 20";
  const auto moved = [&](const std::string &obstacle) {
    LammpsSession lmp;
    lmp.script(points);
    const auto before = lmp.unwrapped_positions();
    lmp.script(obstacle + flow);
    EXPECT_EQ(joined(own_warnings(lmp.log())), "");
    auto after = lmp.unwrapped_positions();
    for (size_t i = 0; i < after.size(); ++i) after[i] -= before[i];
    return after;
  };
  const auto outside = moved("fix held rest setforce 0 0 0\n");
  for (int d = 0; d < 3; ++d) EXPECT_EQ(outside[9 + d], 0.0);
  EXPECT_GT(outside[0], 0.1);
  const auto carried = moved("group brown id 4\n"), tied = moved("group brown id 4\nfix held rest "
                                                                 "spring/self 100\n");
  EXPECT_GT(carried[9], 0.1);
  EXPECT_LT(std::fabs(tied[9]), 0.05);
}

TEST(Companions, BoxesThatLeaveAtomsBehind)
{
  const Case cases[] = {
      {tilted, PSE "fix 2 first deform 1 xy erate 0.1 remap x\nrun 2\nrun 2",
       "but not 1 atoms of group brown"},
      {tilted, PSE "fix 2 first deform 1 x erate 0.1\nrun 2", "fix 2 deform changes the box and"},
      {points,
       "pair_style lj/cut 2\npair_coeff * * 1 1\n" PSE
       "fix 2 rest press/berendsen iso 0 0 1 dilate partial\ncompute T all temp/brownian "
       "move\ncompute p all "
       "pressure T\nfix_modify 2 press p\nrun 2",
       "fix 2 press/berendsen changes the box and"},
  };
  expect_one_warning_each(cases, 3);
}

/* ----------------------------------------------------------------------
   integrators
------------------------------------------------------------------------- */

// Atom 4 of fix nve walks into the region of a dynamic group.
TEST(Companions, AnAtomThatComesIntoTheGroup)
{
  for (const std::string rest : {"bd/fib 0 1.0 5 grid 8 8 8", "bd/pse 0 1.0 5 radius 1"}) {
    const std::string commands = "region left block 0 4 INF INF INF INF\ngroup left dynamic all "
                                 "region left every 1\nset atom 4 vx -1.0 x 4.95\nfix fly rest "
                                 "nve\nfix move left " +
                                 rest + "\ntimestep 0.1\n";
    LammpsSession lmp;
    lmp.script(points);
    const std::string message = lmp.error_of(commands + "run 8\nrun 20");
    EXPECT_NE(plain(message).find("atom 4 is also integrated by fix fly nve at step 11"),
              std::string::npos)
        << message;
  }
}

TEST(Companions, AnAtomThatIsDepositedIntoBothGroups)
{
  const std::string deposit = "region spot block 3 4 3 4 3 4\nfix add rest deposit 1 1 3 77 region "
                              "spot near 0.1\nfix fly rest nve\n";
  {
    LammpsSession lmp;
    lmp.script(points);
    lmp.script("group rest clear\n");
    const std::string message = lmp.error_of(deposit + "fix move all bd/pse 0 1 5 radius 1\nrun 9");
    EXPECT_NE(plain(message).find("atom 5 is also integrated by fix fly nve at step"),
              std::string::npos)
        << message;
  }
  LammpsSession lmp;
  lmp.script(points);
  EXPECT_EQ(lmp.error_of(deposit + PSE "run 9"), "");
}

TEST(Companions, AnIntegratorWhoseGroupGrowsBetweenRuns)
{
  LammpsSession lmp;
  lmp.script(points);
  lmp.script(FIB "fix fly rest nve\nrun 1");
  const std::string grow = "group rest id 2\n";
  const std::string quick = lmp.error_of(grow + "run 3 pre no");
  EXPECT_NE(plain(quick).find("atom 2 is also integrated by fix fly nve at step 2"),
            std::string::npos)
      << quick;
  const std::string message = lmp.error_of("run 1");
  EXPECT_NE(plain(message).find("1 atoms of group brown are also integrated by fix fly nve"),
            std::string::npos)
      << message;
}

TEST(Companions, ConstraintsOfOtherAtoms)
{
  const std::string scene =
      "units lj\natom_style bond\natom_modify map array\nregion box block 0 8 0 "
      "8 0 8\ncreate_box 1 box bond/types 1 extra/bond/per/atom 1 "
      "extra/special/per/atom 2\ncreate_atoms 1 single 1 1 1\ncreate_atoms 1 "
      "single 5 5 5\ncreate_atoms 1 single 6 5 5\nmass 1 1\nbond_style "
      "harmonic\nbond_coeff 1 1 1\ngroup brown id 1\ngroup two id 2 "
      "3\npair_style zero 2\npair_coeff * *\nneigh_modify every 1 delay "
      "0\ncreate_bonds single/bond 1 2 3\n";
  const std::string run = "fix 2 two nve\nfix 3 two shake 1e-4 20 0 b 1\nrun 1";
  LammpsSession apart;
  if (apart->kokkos) GTEST_SKIP() << "fix shake/kk may crash when it is deleted";
  EXPECT_EQ(apart.error_of(scene + PSE + run), "");
  LammpsSession lmp;
  EXPECT_NE(lmp.error_of(scene + "fix move all bd/pse 1 1 5 radius 1\nfix 3 two shake 1e-4 20 0 b "
                                 "1\nrun 1")
                .find("predicts positions from velocities"),
            std::string::npos);
}

/* ----------------------------------------------------------------------
   exclusions
------------------------------------------------------------------------- */

TEST(Exclusions, OfOtherAtomsAreAllowed)
{
  for (const std::string exclude :
       {"group nobody all", "group rest rest", "group brown rest", "type 2 2", "type 1 2"}) {
    LammpsSession lmp;
    lmp.script(points);
    lmp.command("group nobody empty");
    EXPECT_EQ(lmp.error_of("neigh_modify exclude " + exclude + "\n" PSE "run 1"), "") << exclude;
  }
}

TEST(Exclusions, OfTheGroupAreRefused)
{
  for (const std::string exclude :
       {"group all all", "group brown all", "group one brown", "type 1 1", "type 1 *"}) {
    if (exclude == "type 1 *") continue;
    LammpsSession lmp;
    lmp.script(points);
    lmp.command("group one id 2");
    const std::string message = lmp.error_of("neigh_modify exclude " + exclude + "\n" PSE "run 1");
    EXPECT_NE(message.find("(exclude " + exclude + " is for atoms of group brown)"),
              std::string::npos)
        << message;
  }
}

// A molecule of two particles, one of one, and another atom.
TEST(Exclusions, OfMolecules)
{
  const std::string scene =
      "units lj\natom_style molecular\natom_modify map array\nneigh_modify every "
      "1 delay 0 check yes\nregion box block 0 8 0 8 0 8\ncreate_box 1 "
      "box\ncreate_atoms 1 single 1 1 1\ncreate_atoms 1 single 3 1 "
      "1\ncreate_atoms 1 single 5 1 1\ncreate_atoms 1 single 5 5 5\nmass 1 "
      "1\nset atom 1*2 mol 1\nset atom 3 mol 2\nset atom 4 mol 2\ngroup brown id "
      "1:3\ngroup pair id 1:2\ngroup rest id 4\n";
  const auto message_of = [&](const std::string &exclude) {
    LammpsSession lmp;
    return lmp.error_of(scene + "neigh_modify exclude " + exclude + "\n" PSE "run 1");
  };
  EXPECT_EQ(message_of("molecule/intra rest"), "");
  EXPECT_EQ(message_of("molecule/inter rest"), "");
  EXPECT_EQ(message_of("molecule/inter pair"), "");
  for (const std::string bad :
       {"molecule/intra pair", "molecule/intra all", "molecule/inter brown"})
    EXPECT_NE(message_of(bad).find("(exclude " + bad + " is for"), std::string::npos)
        << message_of(bad);
}

// Fix gcmc and fix widom exclude a group of their own from the lists.
TEST(Exclusions, MonteCarloOfOtherAtoms)
{
  for (const std::string fix :
       {"gcmc 1 2 2 2 29494 1.0 -1.0 0.1", "gcmc 1 2 2 2 29494 1.0 -1.0 0.1 full_energy",
        "widom 1 2 2 29494 1.0"}) {
    LammpsSession lmp;
    lmp.script(points);
    lmp.script("pair_style lj/cut 2\npair_coeff * * 1 1\ngroup gas type 2\ntimestep 0.001");
    const std::string message = lmp.error_of("fix gas gas " + fix + "\n" PSE "run 10\nrun 10");
    if (is_missing(message)) GTEST_SKIP() << "needs package MC";
    EXPECT_EQ(message, "") << fix;
    EXPECT_EQ(joined(own_warnings(lmp.log())), "") << fix;
  }
}

/* ----------------------------------------------------------------------
   continuation
------------------------------------------------------------------------- */

namespace {

const char same_noise[] = "this run repeats its noise from the first step on";

std::string after_data_file(const std::string &commands)
{
  const std::string file = "test_" + std::to_string(getpid()) + ".data";
  {
    LammpsSession lmp;
    lmp.script(points);
    lmp.script(PSE "run 5\nwrite_data " + file);
    EXPECT_EQ(lmp.log().find(same_noise), std::string::npos);
  }
  LammpsSession lmp;
  lmp.script(
      "units lj\natom_style atomic\natom_modify map array\nneigh_modify every 1 delay 0 check "
      "yes\nread_data " +
      file + "\ngroup brown id 1:3\ngroup rest id 4\nthermo_style custom step");
  std::remove(file.c_str());
  lmp.script(commands);
  EXPECT_EQ(joined(own_warnings(lmp.log())), "");
  return lmp.log();
}

size_t count(const std::string &text, const std::string &part)
{
  size_t n = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

}    // namespace

TEST(Continuation, OfADataFileIsMentionedOnce)
{
  const std::string log = after_data_file(PSE "run 0\nrun 2\nrun 2");
  EXPECT_EQ(count(log, same_noise), 1u) << log;
  EXPECT_NE(log.find("an earlier run with seed 5"), std::string::npos);
  EXPECT_EQ(count(after_data_file(FIB "run 2"), same_noise), 1u);
}

TEST(Continuation, OfADataFileIsNotMentionedElsewhere)
{
  EXPECT_EQ(count(after_data_file("reset_timestep 5\n" PSE "run 2"), same_noise), 0u);
  EXPECT_EQ(count(after_data_file("velocity all set 0 0 0\n" PSE "run 2"), same_noise), 0u);
  // The velocities belong to other atoms.
  EXPECT_EQ(
      count(after_data_file("velocity brown set 0 0 0\nvelocity rest set 1 0 0\n" PSE "run 2"),
            same_noise),
      0u);
}

// The remedy: if the steps continue from the first run, the second run gets other noise.
TEST(Continuation, NoiseOfADataFileRepeatsUnlessTheStepGoesOn)
{
  const auto moves = [](const std::string &step) {
    LammpsSession lmp;
    lmp.script(points);
    lmp.script("reset_timestep " + step + "\n" FIB "timestep 1e-6\nrun 3");
    return lmp.velocities();
  };
  EXPECT_EQ(largest_difference(moves("0"), moves("0")), 0.0);
  EXPECT_GT(largest_difference(moves("0"), moves("3")), 1.0);
}

// Under fix deform LAMMPS carries atoms along after it has computed forces.  At the beginning of a
// run it computes the forces for the positions at that time, whether the run follows a restart or
// another run.
TEST(Continuation, OfAShearedBoxIsAsAfterAnotherRun)
{
  const std::string file = "test_" + std::to_string(getpid()) + ".restart";
  const std::string fixes =
      "neigh_modify every 1 delay 0 check yes\nfix move all bd/pse 0.5 1 5 radius "
      "0.5 precision double fft estimate\nfix flow all deform 1 xy erate 1.0 remap "
      "x\ntimestep 0.002\n";
  const auto run = [&](const std::string &first, const std::string &second) {
    LammpsSession lmp;
    lmp.script(bdh_test::lattice_suspension);
    lmp.script("change_box all triclinic\n" + fixes + first);
    if (second.empty()) return lmp.unwrapped_positions();
    lmp.command("write_restart " + file);
    LammpsSession next;
    next.script("read_restart " + file + "\nneighbor 0.4 bin\n" + fixes + second);
    std::remove(file.c_str());
    return next.unwrapped_positions();
  };
  const auto restarted = run("run 10", "run 10"), two = run("run 10\nrun 10", ""),
             one = run("run 20", "");
  EXPECT_LT(largest_difference(restarted, two), 1e-9);
  EXPECT_GT(largest_difference(one, two), 1e-9);
  EXPECT_LT(largest_difference(one, two), 0.01);
}

/* ----------------------------------------------------------------------
   what is asked of a thermostat
------------------------------------------------------------------------- */

TEST(Thermostat, AnswersToLammpsNames)
{
  for (const std::string style : {"bd/fib 1.5 2.0 5 grid 8 8 8", "bd/pse 1.5 2.0 5 radius 1"}) {
    LammpsSession lmp;
    lmp.script(points);
    lmp.command("fix move brown " + style);
    LAMMPS_NS::Fix &fix = *lmp.fix("move");
    for (const char *name : {"temperature", "t_target", "t_start", "t_stop"}) {
      int dim = -1;
      const auto *T = static_cast<double *>(fix.extract(name, dim));
      ASSERT_NE(T, nullptr) << name;
      EXPECT_EQ(*T, 1.5) << name;
      EXPECT_EQ(dim, 0) << name;
    }
    int dim = -1;
    EXPECT_EQ(*static_cast<double *>(fix.extract("viscosity", dim)), 2.0);
    for (const char *name : {"p_flag", "p_start", "gvec", "body", "onemol", ""})
      EXPECT_EQ(fix.extract(name, dim), nullptr) << name;
    *static_cast<double *>(fix.extract("t_target", dim)) = 0.5;
    lmp.command("run 1");
    EXPECT_EQ(fix.compute_vector(5), 0.5);
    fix.reset_target(0.75);
    lmp.command("run 1 pre no");
    EXPECT_EQ(fix.compute_vector(5), 0.75);
  }
}

TEST(Thermostat, WhoseTemperatureIsAVariable)
{
  LammpsSession lmp;
  lmp.script(points);
  lmp.script("variable T equal 1+0.5*step\nfix move brown bd/pse v_T 1 5 radius 1\nrun 2");
  LAMMPS_NS::Fix &fix = *lmp.fix("move");
  int dim = -1;
  const auto *T = static_cast<double *>(fix.extract("t_target", dim));
  ASSERT_NE(T, nullptr);
  EXPECT_EQ(*T, 2.0);
  for (const char *name : {"temperature", "t_start", "t_stop"})
    EXPECT_EQ(fix.extract(name, dim), nullptr) << name;
  std::string message;
  try {
    fix.reset_target(1.0);
  } catch (LAMMPS_NS::LAMMPSException &e) {
    message = e.what();
  }
  EXPECT_NE(message.find("temperature = v_T, but replica exchange sets the temperature"),
            std::string::npos)
      << message;
}

// Styles of LAMMPS that take the temperature from another fix.
TEST(Thermostat, ServesOtherStyles)
{
  const Case cases[] = {
      {points, PSE "compute h all hma move u\nthermo_style custom step c_h[1]\nrun 2", nullptr},
      {points,
       "pair_style lj/cut 2\npair_coeff * * 1 1\n" PSE
       "fix g all grem 400 -0.01 -1000 move\nthermo_style custom step pe f_g\nrun 2",
       nullptr},
      {charges,
       "pair_style lj/cut 2\npair_coeff * * 1 1\n" PSE
       "fix c all charge/regulation 1 1 onlysalt yes 1 -1 pIp 3 pIm 3 nevery 1 nmc 1 seed 12 "
       "tempfixid move\nrun 2",
       nullptr},
  };
  for (const Case &c : cases) {
    LammpsSession lmp;
    const std::string message = lmp.error_of(std::string(c.scene) + c.commands);
    if (is_missing(message)) continue;
    // In newer releases fix grem takes no other fixes than those of LAMMPS.
    if (BDH_LAMMPS_DATE >= 20250204 && message.find("for fix grem") != std::string::npos) continue;
    EXPECT_EQ(message, "") << c.commands;
  }
}

// LAMMPS accepts only styles whose names it knows.
TEST(Thermostat, HasANameForReplicaExchange)
{
  for (const std::string style : {"bd/fib 1.5 2.0 5 grid 8 8 8", "bd/pse 1.5 2.0 5 radius 1"}) {
    std::vector<double> x[2];
    for (const bool alias : {false, true}) {
      LammpsSession lmp;
      lmp.script(points);
      lmp.script("fix move brown " + std::string(alias ? "temp/" : "") + style +
                 " fft estimate\nrun 3");
      EXPECT_EQ(joined(own_warnings(lmp.log())), "");
      x[alias] = lmp.unwrapped_positions();
    }
    EXPECT_EQ(largest_difference(x[0], x[1]), 0.0) << style;
  }
}
