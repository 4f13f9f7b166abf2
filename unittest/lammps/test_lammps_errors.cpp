// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Wrong input gives a helpful message: the style, the parameter, its value and the rule.

#include "lammps/wrong_input.h"

using bdh_test::LammpsSession;
using Case = bdh_test::WrongInput;

namespace {

class WrongInput : public ::testing::TestWithParam<Case> {};

const Case syntax[] = {
    {"fix 1 all bd/fib", "fix bd/fib: temperature = (nothing)"},
    {"fix 1 all bd/fib 1.0", "viscosity = (nothing)"},
    {"fix 1 all bd/fib 1.0 1.0", "seed = (nothing)"},
    {"fix 1 all bd/fib 1.0 1.0 5", "grid = (not given), but the spacing must be set"},
    {"fix 1 all bd/fib warm 1.0 5 grid 8 8 8", "temperature = warm, but must be a finite number"},
    {"fix 1 all bd/fib nan 1.0 5 grid 8 8 8", "temperature = nan, but must be a finite number"},
    {"fix 1 all bd/fib -1 1.0 5 grid 8 8 8", "temperature = -1, but must be >= 0"},
    {"fix 1 all bd/fib 1.0 0 5 grid 8 8 8", "viscosity = 0, but must be > 0"},
    {"fix 1 all bd/fib 1.0 -2 5 grid 8 8 8", "viscosity = -2, but must be > 0"},
    {"fix 1 all bd/fib 1.0 1e999 5 grid 8 8 8", "viscosity = 1e999, but must be a finite number"},
    {"fix 1 all bd/fib v_ 1.0 5 grid 8 8 8", "a variable needs a name"},
    {"fix 1 all bd/fib 1.0 1.0 0 grid 8 8 8", "seed = 0, but must be from 1"},
    {"fix 1 all bd/fib 1.0 1.0 -3 grid 8 8 8", "seed = -3, but must be from 1"},
    {"fix 1 all bd/fib 1.0 1.0 1.5 grid 8 8 8", "seed = 1.5, but must be an integer"},
    {"fix 1 all bd/fib 1.0 1.0 99999999999 grid 8 8 8", "seed = 1e+11, but must be from 1"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8", "grid nz = (nothing)"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 x", "grid nz = x, but must be an integer"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 0 8", "grid ny = 0, but must be from 1"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 99999", "grid nz = 99999"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 grid 8 8 8",
     "keyword = grid, but it may be given only once"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 radius 1",
     "radius = 1, but give either grid or radius"},
    {"fix 1 all bd/fib 1.0 1.0 5 radius 0", "radius = 0, but must be > 0"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 kernel gauss",
     "kernel = gauss, but must be roma3, peskin4 or bkp6"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 kernel", "kernel = (nothing)"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 scheme heun",
     "scheme = heun, but must be midpoint, improved"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 drift maybe",
     "drift = maybe, but must be auto, exact, rfd or no"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 delta 0", "delta = 0, but must be from 1e-12 to 0.1"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 delta 0.5", "delta = 0.5"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 tolerance 2",
     "tolerance = 2, but must be from 1e-14 to 0.5"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 shear fast",
     "shear = fast, but must be a finite number"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 fft slow",
     "fft = slow, but must be measure or estimate"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 wall", "wall = (nothing)"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 wall top noslip",
     "wall = top, but the face must be xlo"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 wall zlo", "wall zlo = (nothing)"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 wall zlo rough",
     "wall zlo = rough, but must be noslip, slip or open"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 wall zlo noslip 1 0", "wall zlo vz = (nothing)"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 wall zlo noslip 1 0 2",
     "wall zlo vz = 2, but a wall can only move along itself"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 wall zlo slip 1 0 0",
     "wall zlo = slip, but a wall without friction"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 wall zlo slip wall zlo slip",
     "wall = zlo, but this face has a wall already"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 wall zlo slip wall zhi slip shear 1",
     "shear = 1, but between walls"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 force 1 0", "force fz = (nothing)"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 crossing jump",
     "crossing = jump, but must be error, reflect or redraw"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 crossing redraw scheme improved",
     "crossing = redraw, but scheme improved"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 colour red", "keyword = colour, but must be one of"},
    {"fix 1 all brownian/fib 1.0 1.0 5 grid 8 8 8 colour red",
     "fix brownian/fib: keyword = colour"},
};

const Case setup[] = {
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 3\nrun 1",
     "grid nz = 3, but kernel peskin4 needs at least 4 cells"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 5 kernel bkp6\nrun 1",
     "kernel bkp6 needs at least 6 cells"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 pencils 2\nrun 1",
     "pencils = 2, but there are not so many processes to share a slab of planes, but 1: give 1"},
    {"change_box all boundary f f p\nfix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 wall xlo noslip wall "
     "xhi noslip wall ylo noslip wall yhi noslip pencils 2\nrun 1",
     "pencils = 2, but a box with walls in several directions has only slabs: give 1"},
    {"fix 1 all bd/fib 1.0 1.0 5 radius 4\nrun 1", "radius = 4, but the box is only"},
    {"fix 1 all bd/fib 1.0 1.0 5 radius 1e-9\nrun 1", "more than 32768 cells"},
    {"fix 1 all bd/fib v_T 1.0 5 grid 8 8 8\nrun 1",
     "temperature = v_T, but there is no variable of that name"},
    {"variable T atom x\nfix 1 all bd/fib v_T 1.0 5 grid 8 8 8\nrun 1", "must be of style equal"},
    {"variable T equal -1\nfix 1 all bd/fib v_T 1.0 5 grid 8 8 8\nrun 1",
     "temperature = -1 at step 0, but must be >= 0"},
    {"variable T equal 1.5-step\nfix 1 all bd/fib v_T 1.0 5 grid 8 8 8\nrun 5",
     "temperature = -0.5 at step 2"},
    {"variable e equal 1-step\nfix 1 all bd/fib 1.0 v_e 5 grid 8 8 8\nrun 5",
     "viscosity = 0 at step 1, but must be > 0"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8\nfix 2 all nve\nrun 1",
     "2 atoms of group all are also integrated by fix 2 nve"},
    {"change_box all triclinic\nfix 1 all bd/fib 1.0 1.0 5 grid 8 8 8\nrun 1",
     "the box is triclinic, but must be orthogonal"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8\nfix 2 all deform 1 x erate 0.1\nrun 1",
     "fix 2 deform changes the box"},
    {"change_box all boundary p p f\nfix 1 all bd/fib 1.0 1.0 5 grid 8 8 8\nrun 1",
     "wall zlo = (not given), but the box is not periodic along z"},
    {"change_box all boundary p p f\nfix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 wall zlo noslip\nrun 1",
     "wall zhi = (not given), but the box is not periodic along z"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 wall zlo noslip wall zhi noslip\nrun 1",
     "wall = zlo, but the box is periodic along z"},
    {"change_box all boundary p p s\nfix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 wall zlo noslip wall "
     "zhi noslip\nrun 1",
     "face zlo of the box is shrink-wrapped"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8\ntimestep 0\nrun 1", "timestep = 0, but must be > 0"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8\ntimestep -0.1\nrun 1",
     "timestep = -0.1, but must be > 0"},
    {"group a id 1\ngroup b id 2\nfix 1 a bd/fib 1.0 1.0 5 grid 8 8 8\nfix 2 b bd/fib 1.0 1.0 5 "
     "grid 8 8 8\nrun 1",
     "fix 2 bd/fib has the same seed 5"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8\ntimestep 1e9\nrun 1", "moved by"},
    {"pair_style lj/cut 2.5\npair_coeff 1 1 1 1\ncreate_atoms 1 single 1.02 2 3\n"
     "fix 1 all bd/fib 0.0 1.0 5 grid 8 8 8 scheme improved\ntimestep 1e-5\nrun 9",
     "at step 1 moved by"},
    {"run_style respa 2 2\nfix 1 all bd/fib 1.0 1.0 5 grid 8 8 8\nrun 1", "use run_style verlet"},
    {"fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8\nfix 2 all addforce v_big 0 0\nvariable big equal "
     "1e308*10\nrun 2",
     "the force on it is not a finite number"},
    {"variable half atom (id==2)*1e308*10\nfix 1 all bd/fib 1.0 1.0 5 grid 8 8 8\nfix 2 all "
     "addforce v_half 0 0\nrun 2",
     "atom 2 at step 1: the force on it is not a finite number"},
};

}    // namespace

TEST_P(WrongInput, GivesTheIntendedMessage) { bdh_test::expect_message(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Syntax, WrongInput, ::testing::ValuesIn(syntax));
INSTANTIATE_TEST_SUITE_P(Setup, WrongInput, ::testing::ValuesIn(setup));

TEST(WrongInputWithBonds, ConstraintsAreRefused)
{
  LammpsSession lmp;
  lmp.script(
      "units lj\natom_style bond\natom_modify map array\nregion box block 0 8 0 8 0 8\n"
      "create_box 1 box bond/types 1 extra/bond/per/atom 2 extra/special/per/atom 4\ncreate_atoms "
      "1 single 1 2 3\n"
      "create_atoms 1 single 2 2 3\nmass 1 1.0\npair_style zero 2.0\npair_coeff * *\nbond_style "
      "harmonic\n"
      "bond_coeff 1 100.0 1.0\ncreate_bonds single/bond 1 1 2\nfix hold all shake 1e-4 20 0 b 1");
  EXPECT_NE(lmp.error_of("fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8\nrun 1")
                .find("fix hold shake predicts positions"),
            std::string::npos);
}

const char *const flat_scene = "units lj\ndimension 2\natom_style atomic\nregion box block 0 8 0 8 "
                               "-0.5 0.5\ncreate_box 1 box\n"
                               "create_atoms 1 single 1 2 0\nmass 1 1";

TEST(WrongInputInTwoDimensions, GridMustBeFlat)
{
  LammpsSession lmp;
  lmp.script(flat_scene);
  EXPECT_NE(lmp.error_of("fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8\nrun 1")
                .find("grid nz = 8, but must be 1"),
            std::string::npos);
}

TEST(WrongInputInTwoDimensions, ForceMustBeFlat)
{
  LammpsSession lmp;
  lmp.script(flat_scene);
  EXPECT_NE(lmp.error_of("fix 1 all bd/fib 1.0 1.0 5 grid 8 8 1 force 0 0 0.5\nrun 1")
                .find("force fz = 0.5, but must be 0"),
            std::string::npos);
}
