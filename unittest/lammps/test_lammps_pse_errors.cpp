// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/pse: wrong input gives a helpful message: the style, the parameter, its value, the rule
// and a remedy.

#include "lammps/lammps_mobility.h"
#include "lammps/wrong_input.h"

#include <limits>

using bdh_test::AtForces;
using bdh_test::expect_message;
using bdh_test::LammpsSession;
using Case = bdh_test::WrongInput;

namespace {

class WrongInputPse : public ::testing::TestWithParam<Case> {};

const Case syntax[] = {
    {"fix 1 all bd/pse", "fix bd/pse: temperature = (nothing), but a value must follow"},
    {"fix 1 all bd/pse 1.0", "viscosity = (nothing)"},
    {"fix 1 all bd/pse 1.0 1.0", "seed = (nothing)"},
    {"fix 1 all bd/pse hot 1.0 5 radius 1", "temperature = hot, but must be a finite number"},
    {"fix 1 all bd/pse inf 1.0 5 radius 1", "temperature = inf, but must be a finite number"},
    {"fix 1 all bd/pse -1 1.0 5 radius 1", "temperature = -1, but must be >= 0"},
    {"fix 1 all bd/pse 1.0 0 5 radius 1", "viscosity = 0, but must be > 0"},
    {"fix 1 all bd/pse 1.0 v_ 5 radius 1", "a variable needs a name"},
    {"fix 1 all bd/pse 1.0 1.0 0 radius 1", "seed = 0, but must be from 1 to 2147483647"},
    {"fix 1 all bd/pse 1.0 1.0 2147483648 radius 1", "seed = 2147483648, but must be from 1"},
    {"fix 1 all bd/pse 1.0 1.0 2.5 radius 1", "seed = 2.5, but must be an integer"},
    {"fix 1 all bd/pse 1.0 1.0 5", "fix bd/pse: radius = atom, but the atoms of atom_style atomic "
                                   "have no radius: give one as radius a"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius atom", "the atoms of atom_style atomic have no radius"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius", "radius = (nothing)"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 0", "radius = 0, but must be > 0, or the word atom"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius -1", "radius = -1, but must be > 0"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius nan", "radius = nan, but must be a finite number"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 tolerance", "tolerance = (nothing)"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 tolerance 0",
     "tolerance = 0, but must be from 1e-12 to 0.5"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 tolerance 1",
     "tolerance = 1, but must be from 1e-12 to 0.5"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 tolerance -1e-3", "tolerance = -0.001, but must be from"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 tolerance 1e-13", "tolerance = 1e-13, but must be from"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 xi 0", "xi = 0, but must be > 0, or the word auto"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 xi large", "xi = large, but must be a finite number"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 precision half",
     "precision = half, but must be auto, single or double"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 iterations 1",
     "iterations = 1, but must be from 2 to 1000"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 iterations 1001",
     "iterations = 1001, but must be from 2"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 iterations many",
     "iterations = many, but must be an integer"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 check maybe", "check = maybe, but must be yes, no or dt"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 parts", "parts = (nothing)"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 parts both", "parts = both, but must be yes or no"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 fft slow", "fft = slow, but must be measure or estimate"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 grid 8 8 8",
     "keyword = grid, but must be one of adapt, check, control_variate, fft, hold, hydrodynamics, "
     "iterations"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 radius 1",
     "keyword = radius, but it may be given only once"},
    {"fix 1 all brownian/pse 1.0 1.0 5 radius 0", "fix brownian/pse: radius = 0"},
};

const Case setup[] = {
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 pencils 2\nrun 1",
     "pencils = 2, but there are not so many processes to share a slab of planes, but 1: give 1"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 xi 1e-7\nrun 1",
     "xi = 1e-07, but must be from 1e-6/radius to 20/radius"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 xi 100\nrun 1", "xi = 100, but must be from"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 precision single tolerance 1e-7\nrun 1",
     "tolerance = 1e-07, but precision single reaches only 1e-5: use precision auto or double"},
    {"change_box all boundary p p f\nfix 1 all bd/pse 1.0 1.0 5 radius 1\nrun 1",
     "the box must be periodic in all directions, since Ewald sums cannot represent walls: use "
     "boundary p p "
     "p, or fix bd/fib"},
    {"change_box all boundary s p p\nfix 1 all bd/pse 1.0 1.0 5 radius 1\nrun 1",
     "must be periodic in all directions"},
    {"neighbor 0.3 nsq\nfix 1 all bd/pse 1.0 1.0 5 radius 1\nrun 1",
     "neighbor style must be bin, the only one whose lists may have"},
    {"pair_style zero 1.0\npair_coeff * *\nneighbor 0.3 multi\nfix 1 all bd/pse 1.0 1.0 5 radius "
     "1\nrun 1",
     "use neighbor 0.3 bin"},
    {"pair_style zero 1.0\npair_coeff * *\nneighbor 0.3 multi\ncomm_modify mode multi\nneighbor "
     "0.3 bin\nfix 1 all bd/pse 1.0 1.0 5 radius 1\nrun 1",
     "ghosts must reach equally far for all atoms: use comm_modify mode single"},
    {"neighbor 9.0 bin\nfix 1 all bd/pse 1.0 1.0 5 radius 1\nrun 1",
     "neighbor skin = 9, but must be at most the longest edge of the box, 8"},
    {"neigh_modify exclude type 1 1\nfix 1 all bd/pse 1.0 1.0 5 radius 1\nrun 1",
     "neigh_modify exclude keeps pairs out of all neighbor lists, but they interact through the "
     "fluid: use neigh_modify "
     "exclude none"},
    {"neigh_modify exclude group all all\nfix 1 all bd/pse 1.0 1.0 5 radius 1\nrun 1",
     "use neigh_modify exclude none"},
    {"neigh_modify once yes\nfix 1 all bd/pse 1.0 1.0 5 radius 1\nrun 1",
     "neigh_modify once yes keeps the neighbor lists of the first step"},
    {"group a id 1\natom_modify first a\nneigh_modify include a\nfix 1 all bd/pse 1.0 1.0 5 radius "
     "1\nrun 1",
     "neigh_modify include keeps atoms of group all out of the neighbor lists: use include all"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1\nfix 2 all nve\nrun 1",
     "2 atoms of group all are also integrated by fix 2 nve: unfix it"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1\nfix 2 all bd/fib 1.0 1.0 6 grid 8 8 8\nrun 1",
     "are also integrated by fix 2 bd/fib"},
    {"group a id 1\ngroup b id 2\nfix 1 a bd/pse 1.0 1.0 5 radius 1\nfix 2 b bd/pse 1.0 1.0 5 "
     "radius 1\nrun 1",
     "fix 2 bd/pse has the same seed 5, so their particles would get the same noise: give one of "
     "them another seed"},
    {"change_box all triclinic\nfix 1 all bd/pse 1.0 1.0 5 radius 1\nfix s all deform 1 xy erate "
     "0.1 remap v\nrun 1",
     "fix s deform remaps velocities, which here are displacement/timestep: use remap x"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 xi 1 tolerance 1e-9 iterations 2\nfix 2 all addforce 1 0 "
     "0\nrun 1",
     "Lanczos has not converged after 2 iterations"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 xi 1 tolerance 1e-9 iterations 2\nrun 1",
     "use more iterations, a larger xi or a looser tolerance"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1 xi 1 tolerance 1e-9 iterations 2 check yes\nrun 0",
     "use more iterations, a larger xi or a looser tolerance"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1\ntimestep 0\nrun 1", "timestep = 0, but must be > 0"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1\ntimestep 1e9\nrun 1",
     "in one step, which is more than half the box: use a smaller timestep"},
    {"run_style respa 2 2\nfix 1 all bd/pse 1.0 1.0 5 radius 1\nrun 1", "use run_style verlet"},
    {"fix 1 all bd/pse v_T 1.0 5 radius 1\nrun 1",
     "temperature = v_T, but there is no variable of that name"},
    {"variable T equal 1.5-step\nfix 1 all bd/pse v_T 1.0 5 radius 1\nrun 5",
     "temperature = -0.5 at step 2, but must be >= 0"},
    {"variable half atom (id==2)*1e308*10\nfix 1 all bd/pse 1.0 1.0 5 radius 1\nfix 2 all addforce "
     "v_half 0 0\nrun 2",
     "atom 2 at step 1: the force on it is not a finite number"},
    {"fix 1 all bd/pse 1.0 1.0 5 radius 1\nfix 2 all addforce v_nan 0 0\nvariable nan equal "
     "1e308*10-1e308*10\nrun 2",
     "the force on it is not a finite number"},
};

const std::string spheres = R"(
units lj
atom_style sphere
atom_modify map array
region box block 0 8 0 8 0 8
create_box 1 box
create_atoms 1 single 1 2 3
create_atoms 1 single 5 2 3
create_atoms 1 single 5 6 3
)";

}    // namespace

TEST_P(WrongInputPse, GivesTheIntendedMessage) { expect_message(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Syntax, WrongInputPse, ::testing::ValuesIn(syntax));
INSTANTIATE_TEST_SUITE_P(Setup, WrongInputPse, ::testing::ValuesIn(setup));

TEST(WrongInputPseScenes, RadiiOfAtoms)
{
  expect_message(
      {"set atom 2 diameter 0\nfix 1 all bd/pse 1.0 1.0 5\nrun 1",
       "atom 2 has radius 0 at step 0, but must be > 0 and finite: use set ... diameter"},
      spheres);
  // Only the group counts, and an explicit radius overrides those of the atoms.
  expect_message(
      {"set atom 2 diameter 0\ngroup same id 1 3\nfix 1 same bd/pse 1.0 1.0 5\nrun 1\nfix wrong",
       "Illegal fix command"},
      spheres);
  expect_message({"set atom 2 diameter 0\nfix 1 all bd/pse 1.0 1.0 5 radius 0.3\nrun 1\nfix wrong",
                  "Illegal fix command"},
                 spheres);
}

TEST(WrongInputPseScenes, TwoDimensions)
{
  expect_message({"fix 1 all bd/pse 1.0 1.0 5 radius 0.5\nrun 1",
                  "the simulation is two-dimensional, but the Rotne-Prager-Yamakawa "
                  "mobility is not: use fix bd/fib"},
                 "units lj\ndimension 2\natom_style atomic\nregion box block 0 8 0 8 -0.5 "
                 "0.5\ncreate_box 1 box\n"
                 "create_atoms 1 single 1 2 0\nmass 1 1");
}

TEST(WrongInputPseScenes, AtomsWithoutIds)
{
  expect_message({"fix 1 all bd/pse 1.0 1.0 5 radius 0.5",
                  "fix bd/pse: random numbers are drawn by atom id: use atom_modify id yes"},
                 "units lj\natom_style atomic\natom_modify id no\nregion box block 0 8 0 8 0 "
                 "8\ncreate_box 1 box\n"
                 "create_atoms 1 single 1 2 0\nmass 1 1");
}

TEST(WrongInputPseScenes, Template)
{
  const std::string file = "test_" + std::to_string(getpid()) + ".molecule";
  std::ofstream(file) << "one bead\n\n1 atoms\n\nCoords\n\n1 0 0 0\n\nTypes\n\n1 1\n";
  expect_message(
      {"fix 1 all bd/pse 1.0 1.0 5 radius 0.5\nrun 1",
       "atom_style template is not supported: use atom_style bond, angle, molecular or full"},
      "units lj\nmolecule bead " + file +
          "\natom_style template bead\nregion box block 0 8 0 8 0 8\ncreate_box 1 box\n"
          "create_atoms 0 single 1 2 3 mol bead 5\nmass 1 1");
  std::remove(file.c_str());
}

// Whatever other code wrote into the positions, the message names the atom and the step.
TEST(WrongInputPseScenes, PositionThatIsNoNumber)
{
  LammpsSession lmp;
  lmp.script(bdh_test::box3);
  AtForces spoil(lmp, [](const AtForces::Call &call) {
    for (int i = 0; i < call.atoms; ++i)
      if (call.step == 3 && call.id[i] == 2)
        call.x[i][1] = std::numeric_limits<double>::quiet_NaN();
  });
  const std::string message =
      lmp.error_of("fix 1 all bd/pse 1.0 1.0 5 radius 1\ntimestep 1e-4\nrun 9");
  EXPECT_NE(message.find("fix bd/pse: atom 2 at step 4: its position is not a finite number"),
            std::string::npos)
      << message;
}

TEST(WrongInputPseScenes, Warnings)
{
  LammpsSession still, delayed, far;
  still.script(bdh_test::box3);
  still.script("change_box all triclinic\nfix 1 all bd/pse 1.0 1.0 5 radius 1\nfix s all deform 1 "
               "xy erate 0.1 remap none\nrun 0");
  EXPECT_NE(still.log().find("fix s deform changes the box but does not carry particles along"),
            std::string::npos);
  // The fix has its own neighbor list, so the danger exists without a pair style.
  delayed.script(bdh_test::box3);
  delayed.script(
      "neigh_modify delay 10\nfix 1 all bd/pse 1.0 1.0 5 radius 1 xi 0.5\ntimestep 1.0\nrun 12");
  const std::string log = delayed.log();
  EXPECT_NE(log.find("use neigh_modify every 1 delay 0 check yes"), std::string::npos);
  EXPECT_NE(log.find("dangerous neighbor list build before step 11"), std::string::npos);
  far.script(bdh_test::box3);
  far.script("fix 1 all bd/pse 1.0 1.0 5 radius 0.1 xi 5\nrun 1\ntimestep 0.1\nrun 3");
  EXPECT_NE(far.log().find("in one step, which is more than the radius = 0.1"), std::string::npos);
  EXPECT_GT(far.fix("1")->compute_vector(7), 0.0);
}
