// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// The stiffness that fixes report.  For harmonic pairs without hydrodynamic interactions it is
// known, and so is the variance of their distance in each scheme.

#include "lammps/lammps_stiffness.h"

#include "force.h"

#include <gtest/gtest.h>

using bdh_test::HarmonicPairs;
using bdh_test::LammpsSession;
using bdh_test::stiffness_line;
using bdh_test::StiffnessLine;

namespace {

std::string fix_line(const std::string &words, const std::string &T = "1.0")
{
  const std::string style = words.substr(0, 3);
  return "fix 1 all bd/" + style + " " + T + " 1.0 77 " +
         (style == "fib" ? "radius 1.0 kernel peskin4" : "radius 1.0") +
         " fft estimate hydrodynamics no " + words.substr(3) + "\n";
}

/// Mean square deviation of the pairs' distances from the bond length.
double spread(LammpsSession &lmp, const HarmonicPairs &scene)
{
  const std::vector<double> x = lmp.unwrapped_positions();
  double sum = 0.0;
  for (int i = 0; i < scene.pairs; ++i) {
    double r2 = 0.0;
    for (int d = 0; d < 3; ++d) {
      const double d1 = x[6 * i + 3 + d] - x[6 * i + d];
      r2 += d1 * d1;
    }
    sum += (std::sqrt(r2) - scene.bond) * (std::sqrt(r2) - scene.bond);
  }
  return sum / scene.pairs;
}

/// p of the fix's own radius, which a grid gives only nearly.
double number_of(LammpsSession &lmp, const HarmonicPairs &scene, double dt)
{
  return scene.number(dt) / lmp.fix("1")->compute_vector(3);
}

class Stiffness : public testing::TestWithParam<const char *> {};
INSTANTIATE_TEST_SUITE_P(Schemes, Stiffness,
                         testing::Values("fib", "fib scheme improved", "fib scheme trapezoidal",
                                         "fib scheme euler", "pse", "pse scheme split substeps 3"));

}    // namespace

// The number is exact for a stretched bond.  A bond that turns by the angle e during the step adds
// e^2 times its tension to |dF|, here below 1 % of it.
TEST_P(Stiffness, OfHarmonicPairsIsExact)
{
  const HarmonicPairs scene;
  const std::string words = GetParam();
  const bool split = words.find("split") != std::string::npos;
  LammpsSession lmp;
  lmp.script(scene.scene());
  lmp.script(fix_line(words));
  lmp.script("timestep " + bdh_test::text(scene.step_for(0.25)) + "\nrun 60");
  const double p = number_of(lmp, scene, scene.step_for(0.25)) / (split ? 3 : 1);
  const StiffnessLine line = stiffness_line(lmp.log());
  EXPECT_NEAR(line.mean, p, 0.02 * p) << line.text;
  EXPECT_NEAR(lmp.fix("1")->compute_vector(lmp.fix("1")->size_vector - 4), p, 0.02 * p);
  const double last = lmp.fix("1")->compute_vector(lmp.fix("1")->size_vector - 3);
  EXPECT_GT(last, 0.6 * p);
  EXPECT_LE(last, line.most * 1.05);
  // Particles do not know how much of a change their partner has made; see the manual.
  EXPECT_GE(line.most, 0.9 * p);
  EXPECT_LE(line.most, 2.5 * p);
}

// What the line says of the variance is what it is: measured over 400 steps of 64 pairs, whose
// distances are independent after 1/p steps.  The bound is five standard errors.
TEST_P(Stiffness, TellsTheVarianceOfDistances)
{
  const HarmonicPairs scene;
  const std::string words = GetParam();
  const bool split = words.find("split") != std::string::npos;
  const double dt = scene.step_for(0.4);
  LammpsSession lmp;
  lmp.script(scene.scene());
  lmp.script(fix_line(words));
  lmp.script("timestep " + bdh_test::text(dt) + "\nrun 40");
  double sum = 0.0;
  const int samples = 200;
  for (int s = 0; s < samples; ++s) {
    lmp.command("run 4 pre no post no");
    sum += spread(lmp, scene);
  }
  const double measured = sum / samples * scene.stiffness - 1.0;
  const double p = number_of(lmp, scene, dt);
  double claimed = p / (2.0 - p);
  if (split) claimed = 0.0;
  if (words.find("improved") != std::string::npos) claimed = p * p * p / 8.0;
  EXPECT_NEAR(measured, claimed, 5.0 * std::sqrt(2.0 / (samples * scene.pairs)) * (1 + claimed));
}

TEST(StiffnessOfAPair, DoesNotDependOnUnits)
{
  const HarmonicPairs scene;
  LammpsSession lmp;
  // units real: kT = 1 kcal/mol at 503.22 K; the lengths and forces of the scene in Angstrom and
  // kcal/mol/Angstrom, time in units in which 6 pi eta a is the same number
  std::string text = scene.scene();
  text.replace(text.find("units lj"), 8, "units real");
  lmp.script(text);
  const double T = 1.0 / lmp->force->boltz;
  const double eta = 0.0089;                                    // Poise
  const double drag = 6.0 * M_PI * eta * lmp->force->vxmu2f;    // of radius 1
  const double dt = 0.25 * drag / (2.0 * scene.stiffness);
  lmp.script("fix 1 all bd/pse " + bdh_test::text(T) +
             " 0.0089 77 radius 1.0 fft estimate hydrodynamics no\ntimestep " + bdh_test::text(dt) +
             "\nrun 20");
  EXPECT_NEAR(stiffness_line(lmp.log()).mean, 0.25, 0.02 * 0.25);
}

// Particles in traps of stiffness k, half of them twice as large and half as mobile.  Their
// displacements are in proportion to the mobility, so that the mean of dt mu k over all of them,
// weighted with |dF.dq|, is (1 + 1/4)/(1 + 1/2) of that of the small ones.  The error of both sums
// together is 1 %.
TEST(StiffnessOfTraps, KnowsTheRadiiOfItsAtoms)
{
  const double stiffness = 50.0, p = 0.2, dt = 6.0 * M_PI * p / stiffness;
  LammpsSession lmp;
  lmp.script(R"(
units lj
atom_style sphere
atom_modify map array
boundary p p p
lattice sc 0.001
region box block 0 4 0 4 0 4
create_box 1 box
create_atoms 1 box
variable twice atom 2.0*(1.0+id%2)
set group all density 1.0
set group all diameter v_twice
pair_style zero 12.0
pair_coeff * *
neighbor 2.0 bin
neigh_modify every 1 delay 0 check yes
thermo_style custom step
)");
  lmp.script("fix trap all spring/self " + bdh_test::text(stiffness) +
             "\nfix 1 all bd/pse 1.0 1.0 77 radius atom hydrodynamics no\ntimestep " +
             bdh_test::text(dt) + "\nrun 100");
  const StiffnessLine line = stiffness_line(lmp.log());
  EXPECT_NEAR(line.mean, 1.25 / 1.5 * p, 0.05 * p) << line.text;
  // That of a trap is never taken to be stiffer than it is.
  EXPECT_LE(line.most, p * (1.0 + 1e-9));
  EXPECT_GE(line.most, 0.99 * p);
}

TEST(StiffnessOfAPair, NamesTheStiffestAtom)
{
  const HarmonicPairs scene;
  LammpsSession lmp;
  lmp.script(scene.scene());
  lmp.script("bond_style hybrid harmonic\nbond_coeff 1 harmonic 0.25 8.0\n" + fix_line("pse") +
             "group stiff id 17\nfix trap stiff spring tether 40.0 30.0 10.0 10.0 0.0\n"
             "timestep 0.02\nrun 50");
  EXPECT_EQ(stiffness_line(lmp.log()).atom, 17.0);
}

TEST(StiffnessWarning, ComesOnceFromOneHalfOn)
{
  const HarmonicPairs scene;
  for (const double p : {0.4, 0.6}) {
    LammpsSession lmp;
    lmp.script(scene.scene());
    lmp.script(fix_line("pse") + "timestep " + bdh_test::text(scene.step_for(p)) +
               "\nrun 250\nrun 150");
    EXPECT_EQ(bdh_test::occurrences("too stiff for the time step", lmp.log()), p > 0.5 ? 1u : 0u);
    // The advice is a time step for p = 0.1.
    char step[40];
    std::snprintf(step, sizeof step, "use timestep %.1g", scene.step_for(0.1));
    EXPECT_NE(stiffness_line(lmp.log()).text.find(step), std::string::npos)
        << stiffness_line(lmp.log()).text;
  }
}

TEST(StiffnessWarning, IsSilentWhereForcesDoNotChange)
{
  LammpsSession lmp;
  const HarmonicPairs scene;
  lmp.script(scene.scene());
  lmp.script("bond_coeff 1 0.0 8.0\nfix push all addforce 1.0 0 0\n" + fix_line("fib") +
             "timestep 0.1\nrun 5");
  EXPECT_EQ(lmp.log().find("stiffness"), std::string::npos);
  EXPECT_EQ(lmp.fix("1")->compute_vector(lmp.fix("1")->size_vector - 4), 0.0);
}

// Atoms join and leave the group, and new ones are inserted: none counts as having changed its
// force by all of it.
TEST(StiffnessOfAPair, LeavesOutAtomsThatWereNotThere)
{
  const HarmonicPairs scene;
  LammpsSession lmp;
  lmp.script(scene.scene());
  lmp.script("fix pull all addforce 1000.0 0 0\n" + fix_line("pse") +
             "timestep 0.0001\nrun 3\nregion spot block 0 80 0 80 0 3\n"
             "fix more all deposit 5 1 2 88 region spot near 1.0 vx 0 0 vy 0 0 vz 0 0\nrun 12");
  EXPECT_EQ(lmp->atom->natoms, 128 + 5);
  EXPECT_LT(stiffness_line(lmp.log()).most, 0.02);
}
