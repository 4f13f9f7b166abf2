// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// compute temp/brownian: the ideal part of pressures, barostats and stresses, and the warnings of
// the fixes where it is missing.

#include "lammps/lammps_scenes.h"

#include "compute.h"
#include "group.h"
#include "output.h"
#include "thermo.h"
#include "update.h"

#include <algorithm>
#include <array>
#include <cmath>

using bdh_test::LammpsSession;
using bdh_test::text;

namespace {

constexpr int atoms = 40;

/// Particles without forces, whose pressure is N kT/V.
const char *const gas = R"(
units lj
atom_style atomic
atom_modify map array
boundary p p p
region box block 0 8 0 9 0 10
create_box 1 box
create_atoms 1 random 40 77 box
mass 1 2.0
timestep 0.001
neigh_modify every 1 delay 0 check yes
thermo_style custom step
)";
const char *const pse = "fix 1 all bd/pse 1.5 1.0 5 radius 0.5 tolerance 0.01 fft estimate\n";
const char *const fib = "fix 1 all bd/fib 1.5 1.0 5 grid 8 9 10 fft estimate\n";
constexpr double T = 1.5, volume = 720.0;

/// Evaluates the computes of the output at the beginning and at each step.
std::string show(const std::string &columns)
{
  return "thermo 1\nthermo_style custom step " + columns + "\n";
}

LAMMPS_NS::Compute &compute(LammpsSession &lmp, const std::string &id)
{
  return *lmp->modify->compute[lmp->modify->find_compute(id)];
}

double thermo(LammpsSession &lmp, const char *word)
{
  double value = std::nan("");
  lmp->output->thermo->evaluate_keyword(word, &value);
  return value;
}

long count(const std::string &text, const std::string &word)
{
  long n = 0;
  for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
  return n;
}

/// Lines of the log with a warning about a pressure.
std::string warnings(LammpsSession &lmp)
{
  std::istringstream log(lmp.log());
  std::string found;
  for (std::string line; std::getline(log, line);)
    if (line.find("the kinetic part of compute") != std::string::npos ||
        line.find("lacks the ideal term") != std::string::npos)
      found += line + "\n";
  return found;
}

struct UnitStyle {
  const char *name;
  int dimension;
  double side;
  const char *move;    // temperature, viscosity, seed and more
  double T, dt;
  double pressure;    // of one particle at T = 1 in a box of volume (or area) 1
};

// The Boltzmann constant and the atmosphere are those of SI.  LAMMPS' constants have 7 digits.
const UnitStyle unit_styles[] = {
    {"lj", 3, 8.0, "bd/pse 1.5 1.0 5 radius 0.5 tolerance 0.01", 1.5, 1e-3, 1.0},
    {"real", 3, 100.0, "bd/pse 298 0.0089 5 radius 5 tolerance 0.01", 298.0, 10.0,
     1.380649e-23 / 1e-30 / 101325.0},
    {"metal", 3, 100.0, "bd/fib 298 0.0089 5 radius 5", 298.0, 0.01, 1.380649e-23 / 1e-30 / 1e5},
    {"si", 3, 1e-5, "bd/fib 298 0.001 5 radius 5e-7", 298.0, 1e-6, 1.380649e-23},
    {"lj", 2, 8.0, "bd/fib 1.5 1.0 5 grid 8 8 1", 1.5, 1e-3, 1.0}};

}    // namespace

TEST(LammpsTempBrownian, PressureOfAnIdealGas)
{
  for (const UnitStyle &u : unit_styles) {
    LammpsSession lmp;
    const std::string side = text(u.side), half = text(u.side / 20);
    lmp.script("units " + std::string(u.name) + "\ndimension " + std::to_string(u.dimension) +
               "\natom_style atomic\natom_modify map array\nregion box block 0 " + side + " 0 " +
               side + (u.dimension == 2 ? " -" + half + " " + half : " 0 " + side) +
               " units box\ncreate_box 1 box\ncreate_atoms 1 random 40 77 box\nmass 1 1e-3\n"
               "neigh_modify every 1 delay 0 check yes\ntimestep " +
               text(u.dt) + "\nfix 1 all " + u.move +
               " fft estimate\ncompute T all temp/brownian 1\ncompute P all pressure T\n"
               "compute S all stress/atom T\ncompute s all reduce sum c_S[1]\n" +
               show("temp ke c_P c_P[1] c_s") + "thermo_modify temp T norm no\nrun 3");
    const double expected = atoms * u.T * u.pressure / std::pow(u.side, u.dimension);
    const LAMMPS_NS::Compute &P = compute(lmp, "P"), &temperature = compute(lmp, "T");
    EXPECT_EQ(temperature.scalar, u.T) << u.name;
    EXPECT_EQ(temperature.dof, u.dimension * atoms) << u.name;
    EXPECT_NEAR(P.scalar, expected, 1e-5 * expected) << u.name;
    for (int k = 0; k < 6; ++k) {
      const double value = k < u.dimension ? expected : 0.0;
      EXPECT_NEAR(P.vector[k], value, 1e-5 * expected) << u.name << ", component " << k;
    }
    EXPECT_EQ(temperature.vector[2] == 0.0, u.dimension == 2) << u.name;
    EXPECT_NEAR(-compute(lmp, "s").scalar / std::pow(u.side, u.dimension), expected,
                1e-5 * expected)
        << u.name;
    EXPECT_EQ(thermo(lmp, "temp"), u.T) << u.name;
    EXPECT_EQ(warnings(lmp), "") << u.name;
  }
}

// With forces the rest of the pressure is the virial.
TEST(LammpsTempBrownian, PressureIsVirialAndIdealPart)
{
  LammpsSession lmp;
  lmp.script(bdh_test::lattice_suspension);
  lmp.script(pse);
  lmp.script("compute T all temp/brownian 1\ncompute P all pressure T\ncompute W all pressure NULL "
             "virial\nthermo 1\nthermo_style custom step temp press pxx pyz c_P c_W c_W[1] "
             "c_W[6]\nthermo_modify temp T\nrun 4");
  const double ideal = 64 * T / 512;
  EXPECT_GT(std::fabs(compute(lmp, "W").scalar), 1e-4);
  EXPECT_NEAR(compute(lmp, "P").scalar, compute(lmp, "W").scalar + ideal, 1e-13);
  EXPECT_NEAR(thermo(lmp, "press"), compute(lmp, "W").scalar + ideal, 1e-13);
  EXPECT_NEAR(thermo(lmp, "pxx"), compute(lmp, "W").vector[0] + ideal, 1e-13);
  EXPECT_NEAR(thermo(lmp, "pyz"), compute(lmp, "W").vector[5], 1e-13);
  EXPECT_EQ(warnings(lmp), "");
}

// Obstacles are not moved by the fix and have no temperature, whatever the group of the compute.
TEST(LammpsTempBrownian, CountsAtomsOfBothGroups)
{
  LammpsSession lmp;
  lmp.script(gas);
  lmp.script("group mobile id 1:30\ngroup some id 21:40\n"
             "fix 1 mobile bd/fib 1.5 1.0 5 grid 8 9 10 fft estimate\n"
             "compute T all temp/brownian 1\ncompute S some temp/brownian 1\n"
             "compute P all pressure T\n" +
             show("c_T c_S c_P c_T[1] c_T[4]") + "run 2");
  EXPECT_EQ(compute(lmp, "T").dof, 90);
  EXPECT_EQ(compute(lmp, "S").dof, 30);
  EXPECT_EQ(compute(lmp, "S").scalar, T);
  EXPECT_NEAR(compute(lmp, "P").scalar, 30 * T / volume, 1e-15);
  EXPECT_NEAR(compute(lmp, "T").vector[0], 30 * T, 1e-12);
  EXPECT_EQ(compute(lmp, "T").vector[3], 0.0);
}

TEST(LammpsTempBrownian, GroupWithoutAtoms)
{
  LammpsSession lmp;
  lmp.script(gas);
  lmp.script("group none empty\nfix 1 all bd/fib 1.5 1.0 5 grid 8 9 10 fft estimate\n"
             "compute T none temp/brownian 1\n" +
             show("c_T c_T[1]") + "run 2");
  EXPECT_EQ(compute(lmp, "T").scalar, 0.0);
  EXPECT_EQ(compute(lmp, "T").vector[0], 0.0);
}

TEST(LammpsTempBrownian, TwoFixes)
{
  LammpsSession lmp;
  lmp.script(gas);
  lmp.script("group a id 1:10\ngroup b subtract all a\n"
             "fix A a bd/fib 1.0 1.0 5 grid 8 9 10 fft estimate\n"
             "fix B b bd/fib 3.0 1.0 6 grid 8 9 10 fft estimate\n"
             "compute T all temp/brownian A B\ncompute P all pressure T\n" +
             show("c_P") + "run 2");
  EXPECT_NEAR(compute(lmp, "T").scalar, (10 * 1.0 + 30 * 3.0) / 40, 1e-14);
  EXPECT_NEAR(compute(lmp, "P").scalar, (10 * 1.0 + 30 * 3.0) / volume, 1e-14);
  EXPECT_EQ(warnings(lmp), "");
}

TEST(LammpsTempBrownian, ExtraDegreesOfFreedom)
{
  LammpsSession lmp;
  lmp.script(gas);
  lmp.script(fib);
  lmp.script("compute T all temp/brownian 1\ncompute P all pressure T\n" + show("c_P c_P[1]") +
             "compute_modify T extra/dof 3\nrun 1");
  EXPECT_EQ(compute(lmp, "T").dof, 117);
  EXPECT_EQ(compute(lmp, "T").scalar, T);
  EXPECT_NEAR(compute(lmp, "P").scalar, 39 * T / volume, 1e-15);
  EXPECT_NEAR(compute(lmp, "P").vector[0], 39 * T / volume, 1e-15);
}

// A fix that is defined earlier requests the temperature in its setup, before that of this run is
// known.  The variable depends on the step, whose temperature the fix returns as its sixth number.
TEST(LammpsTempBrownian, FollowsAVariableFromTheSetupOn)
{
  LammpsSession lmp;
  lmp.script(gas);
  lmp.script("variable T equal 1.0\nfix 1 all bd/fib v_T 1.0 5 grid 8 9 10 fft estimate\n"
             "compute T all temp/brownian 1\nvariable push equal c_T\nunfix 1\n"
             "fix early all addforce v_push 0 0\n"
             "fix 1 all bd/fib v_T 1.0 5 grid 8 9 10 fft estimate\n" +
             show("c_T f_1[6]"));
  for (int run = 0; run < 2; ++run) {
    lmp.script("variable T equal " + std::to_string(run + 1) + "+0.25*step\nrun 0");
    const double now = run + 1 + 0.25 * lmp->update->ntimestep;
    EXPECT_EQ(lmp.host_atoms().f[0][0], now);
    EXPECT_EQ(compute(lmp, "T").scalar, now);
    lmp.command("run 5");
    EXPECT_EQ(compute(lmp, "T").scalar, now + 1.25);
    EXPECT_EQ(lmp.fix("1")->compute_vector(5), now + 1.25);
  }
}

// A temperature that depends on the energy, and is requested in a setup before that of the fix,
// must not make LAMMPS forget that the virial is needed two steps later.
TEST(LammpsTempBrownian, VariableOfAComputeInTheSetup)
{
  LammpsSession lmp;
  lmp.script(bdh_test::lattice_suspension);
  lmp.script("compute energy all pe\nvariable T equal 0.5+0.001*c_energy^2\n"
             "compute T all temp/brownian 1\ncompute W all pressure NULL virial\n"
             "fix early all ave/time 2 1 2 c_W c_T\n"
             "fix 1 all bd/pse v_T 1.0 5 radius 0.5 fft estimate\nthermo 100\n"
             "thermo_style custom step c_energy v_T\nrun 0");
  EXPECT_NE(lmp.fix("early")->compute_vector(0), 0.0);
  const double hot = 0.5 + 0.001 * std::pow(compute(lmp, "energy").scalar, 2);
  EXPECT_NEAR(lmp.fix("early")->compute_vector(1), hot, 1e-14 * hot);
  EXPECT_EQ(lmp.error_of("run 4"), "");
}

// This is how fix adapt and users of the library set the temperature.
TEST(LammpsTempBrownian, FollowsATemperatureThatIsSetFromOutside)
{
  LammpsSession lmp;
  lmp.script(gas);
  lmp.script(fib);
  lmp.script("compute T all temp/brownian 1\n" + show("c_T") + "run 1");
  int dim = -1;
  *static_cast<double *>(lmp.fix("1")->extract("temperature", dim)) = 4.0;
  lmp.command("run 1 pre no");
  EXPECT_EQ(compute(lmp, "T").scalar, 4.0);
}

// x < 4 changes from step to step; half of the atoms jump across in the middle of the run.
TEST(LammpsTempBrownian, FollowsADynamicGroup)
{
  LammpsSession lmp;
  lmp.script(gas);
  lmp.script("variable left atom \"x < 4+step\"\ngroup left dynamic all every 1 var left\n");
  lmp.script(fib);
  lmp.script("compute T left temp/brownian 1\n" + show("c_T") + "run 0");
  const double before = compute(lmp, "T").dof;
  EXPECT_LT(before, 3 * atoms);
  lmp.command("run 5");
  EXPECT_GT(before, 0);
  EXPECT_EQ(compute(lmp, "T").dof, 3 * lmp->group->count(lmp->group->find("left")));
  EXPECT_EQ(compute(lmp, "T").dof, 3 * atoms);
}

TEST(LammpsTempBrownian, FollowsTheNumberOfAtoms)
{
  LammpsSession lmp;
  if (!lmp->modify->fix_map->count("deposit")) GTEST_SKIP() << "no fix deposit in this build";
  lmp.script(gas);
  lmp.script(fib);
  lmp.script("compute T all temp/brownian 1\ncompute P all pressure T\n"
             "fix rain all deposit 7 1 2 99 region box near 0.01\n" +
             show("c_P") + "run 20");
  EXPECT_EQ(lmp->atom->natoms, atoms + 7);
  EXPECT_NEAR(compute(lmp, "P").scalar, (atoms + 7) * T / volume, 1e-14);
}

// Without forces the result of a barostat step is known exactly.
TEST(LammpsTempBrownian, Barostat)
{
  for (const std::string mode : {"iso", "aniso"}) {
    LammpsSession lmp;
    lmp.script(gas);
    lmp.script(pse);
    lmp.script("compute T all temp/brownian 1\nfix 2 all press/berendsen " + mode +
               " 5.0 5.0 0.5 modulus 3\nfix_modify 2 temp T\nrun 1");
    const double P = atoms * T / volume;
    const double factor = 1.0 - 0.001 / 0.5 * (5.0 - P) / 3.0;
    EXPECT_NEAR(lmp->domain->xprd, 8.0 * std::cbrt(factor), 1e-13) << mode;
    EXPECT_NEAR(lmp->domain->zprd, 10.0 * std::cbrt(factor), 1e-13) << mode;
    lmp.command("run 5");
    EXPECT_EQ(warnings(lmp), "") << mode;
  }
}

namespace {

/// Tests that a compute of stresses has kT on the diagonal for each atom that moves and 0 there for
/// the others, and off the diagonal +-kT, which cancel.  per_atom: kT pressure*volume
void expect_thermal_stress(LammpsSession &lmp, const std::string &id, int columns, int moving,
                           double per_atom)
{
  const LAMMPS_NS::Atom &atom = lmp.host_atoms();
  const LAMMPS_NS::Compute &stress = compute(lmp, id);
  std::vector<double> sum(columns, 0.0);
  for (int i = 0; i < atom.nlocal; ++i) {
    const double here = atom.tag[i] <= moving ? per_atom : 0.0;
    for (int k = 0; k < columns; ++k) {
      const double value = stress.array_atom[i][k];
      EXPECT_NEAR(k < 3 ? value : std::fabs(value), k < 3 ? -here : here, 1e-13) << id << k;
      sum[k] += value;
    }
  }
  for (int k = 0; k < columns; ++k)
    EXPECT_NEAR(sum[k], k < 3 ? -moving * per_atom : 0.0, 1e-11) << id << k;
}

}    // namespace

TEST(LammpsTempBrownian, StressOfAtoms)
{
  LammpsSession lmp;
  lmp.script(gas);
  lmp.script("group mobile id 1:32\n"
             "fix 1 mobile bd/pse 1.5 1.0 5 radius 0.5 tolerance 0.01 fft estimate\n"
             "compute T all temp/brownian 1\ncompute S all stress/atom T\n"
             "compute C all centroid/stress/atom T ke\n"
             "compute s all reduce sum c_S[1] c_S[4] c_C[1] c_C[9]\n"
             "run 2");
  const auto before = lmp.velocities();
  lmp.script(show("c_s[1] c_s[2] c_s[3] c_s[4]") + "run 0");
  expect_thermal_stress(lmp, "S", 6, 32, T);
  expect_thermal_stress(lmp, "C", 9, 32, T);
  EXPECT_EQ(lmp.velocities(), before);
  EXPECT_NE(bdh_test::largest_difference(before, std::vector<double>(before.size(), 0.0)), 0.0);
}

// The off-diagonal stress of an atom vanishes in the mean over steps, also over every fourth step.
// The mean of 400 random signs is below 0.25 except once in 2 million cases.
TEST(LammpsTempBrownian, ShearStressOfAnAtomVanishesInTheMean)
{
  for (int every : {1, 4}) {
    LammpsSession lmp;
    lmp.script(gas);
    lmp.script("delete_atoms group all\ncreate_atoms 1 single 1 1 1\n"
               "fix 1 all bd/fib 1.5 1.0 5 grid 4 4 4 fft estimate\n"
               "compute T all temp/brownian 1\ncompute S all stress/atom T\n"
               "fix mean all ave/atom " +
               std::to_string(every) + " 400 " + std::to_string(400 * every) + " c_S[*]\nrun " +
               std::to_string(400 * every));
    const auto mean = lmp.per_atom("mean", 6);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean[k], -T, 1e-12) << every;
    for (int k = 3; k < 6; ++k) EXPECT_LT(std::fabs(mean[k]), 0.25 * T) << every;
  }
}

// Stresses of all atoms sum up to the pressure, and in a plane there are two directions.
TEST(LammpsTempBrownian, StressesSumUpToThePressure)
{
  for (const int dimension : {2, 3}) {
    LammpsSession lmp;
    const bool flat = dimension == 2;
    lmp.script("units lj\ndimension " + std::to_string(dimension) +
               "\natom_style sphere\natom_modify map array\nregion box block 0 8 0 8 " +
               (flat ? "-0.5 0.5" : "0 8") + "\ncreate_box 1 box\nlattice " +
               (flat ? "sq 0.25" : "sc 0.125") +
               "\ncreate_atoms 1 box\ndisplace_atoms all random 0.3 0.3 " + (flat ? "0" : "0.3") +
               " 5 units box\nset group all diameter 1.0\nset group all density 3.0\n"
               "pair_style lj/cut 2.5\npair_coeff 1 1 1.0 1.0\nneighbor 0.4 bin\n"
               "neigh_modify every 1 delay 0 check yes\ntimestep 0.001\n"
               "fix 1 all bd/fib 1.5 1.0 5 grid 16 16" +
               (flat ? " 1" : " 16") +
               " fft estimate\ncompute T all temp/brownian 1\ncompute P all pressure T\n"
               "compute S all stress/atom T\ncompute s all reduce sum c_S[*]\n" +
               show("c_P c_P[1] c_s[1]") + "run 3");
    const double V = flat ? 64.0 : 512.0;
    const LAMMPS_NS::Compute &P = compute(lmp, "P"), &s = compute(lmp, "s");
    for (int k = 0; k < (flat ? 2 : 6); ++k) EXPECT_NEAR(-s.vector[k] / V, P.vector[k], 1e-12) << k;
    EXPECT_NEAR(-s.vector[3] / V, P.vector[3], 1e-12);
    EXPECT_GT(std::fabs(P.vector[3]), 1e-5);
    EXPECT_EQ(s.vector[2] == 0.0, flat);
  }
}

// compute temp/chunk removes the bias from all atoms at once.
TEST(LammpsTempBrownian, TemperatureOfChunks)
{
  LammpsSession lmp;
  lmp.script(gas);
  lmp.script(fib);
  lmp.script("compute T all temp/brownian 1\ncompute bins all chunk/atom bin/1d x lower 2.0 units "
             "box\ncompute local all temp/chunk bins temp bias T adof 3 cdof 0\nrun 2\n"
             "fix mean all ave/time 1 1 1 c_local[1] mode vector");
  const auto before = lmp.velocities();
  lmp.command("run 0");
  EXPECT_EQ(lmp.velocities(), before);
  const LAMMPS_NS::Compute &local = compute(lmp, "local");
  for (int b = 0; b < 4; ++b) EXPECT_NEAR(local.array[b][0], T, 1e-12) << b;
  EXPECT_EQ(bdh_test::largest_difference(before, before), 0.0);
}

// What changes velocities while the bias is removed, such as a thermostat of LAMMPS, changes them
// by as much afterwards.
TEST(LammpsTempBrownian, ChangesWithoutTheBiasRemain)
{
  LammpsSession lmp;
  lmp.script(gas);
  lmp.script(fib);
  lmp.script("group some id 1:20\ncompute T some temp/brownian 1\n" + show("c_T") + "run 2");
  LAMMPS_NS::Compute &temperature = compute(lmp, "T");
  const LAMMPS_NS::Atom &atom = lmp.host_atoms();
  const std::vector<double> before = lmp.velocities();
  const double thermal = std::sqrt(T / 2.0);    // m w^2 = kT along each axis
  const auto differs_by = [&](int i, double change) {
    for (int d = 0; d < 3; ++d)
      EXPECT_NEAR(atom.v[i][d] - before[3 * (atom.tag[i] - 1) + d], change, 1e-13);
  };
  for (int again = 0; again < 2; ++again) {
    again ? temperature.reapply_bias_all() : temperature.remove_bias_all();
    for (int i = 0; i < atom.nlocal; ++i)
      for (int d = 0; d < 3; ++d) {
        if (atom.tag[i] <= 20) {
          EXPECT_NEAR(std::fabs(atom.v[i][d] - 0.25 * again), thermal, 1e-13) << i;
        }
        atom.v[i][d] += 0.25;
      }
    temperature.restore_bias_all();
    for (int i = 0; i < atom.nlocal; ++i) differs_by(i, 0.25 * (again + 1));
  }
  for (int i = 0; i < atom.nlocal; ++i) {
    temperature.remove_bias(i, atom.v[i]);
    for (int d = 0; d < 3; ++d)
      EXPECT_NEAR(std::fabs(atom.v[i][d]), atom.tag[i] <= 20 ? thermal : 0.0, 1e-13) << i;
    temperature.restore_bias(i, atom.v[i]);
    differs_by(i, 0.5);
  }
}

// A mass of the atom is used in place of that of its type, as in LAMMPS.
TEST(LammpsTempBrownian, MassesOfAtomsAndOfTypes)
{
  LammpsSession lmp;
  if (lmp->kokkos) GTEST_SKIP() << "the KOKKOS package has no masses by fix property/atom";
  lmp.script(gas);
  lmp.script(fib);
  lmp.script("fix masses all property/atom rmass\nset group all mass 8.0\n"
             "compute T all temp/brownian 1\n" +
             show("c_T") + "run 1");
  const LAMMPS_NS::Atom &atom = lmp.host_atoms();
  ASSERT_NE(atom.mass, nullptr);
  compute(lmp, "T").remove_bias_all();
  for (int i = 0; i < atom.nlocal; ++i)
    for (int d = 0; d < 3; ++d) EXPECT_NEAR(std::fabs(atom.v[i][d]), std::sqrt(T / 8.0), 1e-13);
  compute(lmp, "T").restore_bias_all();
}

namespace {

struct WarningCase {
  const char *commands;
  int warnings;                      // lines
  std::vector<std::string> words;    // of the warnings
};

const char *const remedy_for_thermo =
    "compute T all temp/brownian 1, and thermo_modify temp T (or compute P all pressure T and "
    "thermo_modify press P)";

const WarningCase warning_cases[] = {
    {"thermo_style one\nrun 2\nrun 2",
     1,
     {"of compute thermo_press (temperature thermo_temp) comes", remedy_for_thermo}},
    {"thermo_style one\nrun 0", 1, {"of compute thermo_press (temperature thermo_temp) comes"}},
    {"thermo_style multi\nrun 1", 1, {"of compute thermo_press (temperature thermo_temp) comes"}},
    {"thermo_style custom step pxy\nrun 1", 1, {"of compute thermo_press"}},
    {"thermo_style custom step temp\nrun 1",
     1,
     {"of compute thermo_temp comes", "and thermo_modify temp T ("}},
    {"thermo_style custom step\nrun 2", 0, {}},
    {"fix 2 all press/berendsen iso 1 1 1\nrun 3\nrun 3",
     1,
     {"of compute 2_press (temperature 2_temp) comes",
      "compute T all temp/brownian 1, and fix_modify 2 temp T"}},
    {"thermo_style one\nfix 2 all press/berendsen iso 1 1 1\nrun 3",
     2,
     {"thermo_press (temperature thermo_temp)", "2_press", "fix_modify 2 temp T",
      remedy_for_thermo}},
    {"compute W all pressure NULL virial\nfix 2 all press/berendsen iso 1 1 1\n"
     "fix_modify 2 press W\nrun 3\nrun 3",
     1,
     {"the pressure that fix 2 press/berendsen controls lacks the ideal term N kT/V: use compute T "
      "all temp/brownian 1, compute P all pressure T, and fix_modify 2 press P"}},
    {"compute T all temp/brownian 1\ncompute P all pressure T\ncompute W all pressure NULL virial\n"
     "fix 2 all press/berendsen iso 1 1 1\nfix_modify 2 press P\nthermo 1\n"
     "thermo_style custom step c_W\nrun 3",
     0,
     {}},
    {"compute W all pressure NULL virial\nthermo 1\nthermo_style custom step c_W\nrun 3", 0, {}},
    {"compute T all temp/brownian 1\nthermo_style one\nthermo_modify temp T\nrun 2", 0, {}},
    {"compute T all temp/brownian 1\ncompute P all pressure T\nthermo_style custom step press\n"
     "thermo_modify press P\nrun 2",
     0,
     {}},
    {"compute P all pressure thermo_temp\nvariable p equal c_P\nfix mean all ave/time 1 2 2 v_p\n"
     "run 4",
     1,
     {"of compute P (temperature thermo_temp) comes",
      "compute T all temp/brownian 1, and compute P all pressure T ("}},
    {"compute P all pressure thermo_temp virial\nfix mean all ave/time 1 2 2 c_P\nrun 4", 0, {}},
    {"fix mean all ave/time 1 2 2 c_thermo_press\nrun 4", 1, {"thermo_press"}},
    {"thermo_style one\nminimize 0 0 5 5", 0, {}},
    {"compute T all temp/brownian 1\nthermo_style one\nthermo_modify temp T\nrun 2\n"
     "thermo_modify temp thermo_temp\nrun 2",
     1,
     {"of compute thermo_press"}},
    // Corrected between two runs, and then undone again.
    {"thermo_style one\nrun 2\ncompute T all temp/brownian 1\nthermo_modify temp T\nrun 2\n"
     "thermo_modify temp thermo_temp\nrun 2",
     1,
     {"thermo_press"}},
};

}    // namespace

TEST(LammpsTempBrownian, WarningsNameTheRemedyOnce)
{
  for (const char *move : {pse, fib})
    for (const WarningCase &c : warning_cases) {
      if (move == fib && std::string(c.commands).find("berendsen") != std::string::npos) continue;
      LammpsSession lmp;
      lmp.script(gas);
      lmp.script(move);
      ASSERT_EQ(lmp.error_of(c.commands), "") << c.commands;
      const std::string found = warnings(lmp);
      EXPECT_EQ(count(found, "WARNING: fix bd/"), c.warnings) << c.commands << "\n" << found;
      for (const std::string &word : c.words)
        EXPECT_NE(found.find(word), std::string::npos) << c.commands << "\n"
                                                       << word << "\n"
                                                       << found;
    }
}

// The temperature of other atoms may come from their velocities.
TEST(LammpsTempBrownian, NoWarningAboutOtherAtoms)
{
  LammpsSession lmp;
  lmp.script(gas);
  lmp.script("group a id 1:10\ngroup b subtract all a\n"
             "fix 1 a bd/fib 1.0 1.0 5 grid 8 9 10 fft estimate\nfix 2 b nve\n"
             "compute B b temp\ncompute P all pressure B\n" +
             show("c_P") + "run 2");
  EXPECT_EQ(warnings(lmp), "");
  lmp.script("compute M all pressure thermo_temp\n" + show("c_M") + "run 2");
  EXPECT_EQ(count(warnings(lmp), "of compute M (temperature"), 1);
}

// The temperature of another fix does not describe the atoms of this one.
TEST(LammpsTempBrownian, WarningOfAFixThatIsNotNamed)
{
  LammpsSession lmp;
  lmp.script(gas);
  lmp.script("group a id 1:10\ngroup b subtract all a\n"
             "fix A a bd/fib 1.0 1.0 5 grid 8 9 10 fft estimate\n"
             "fix B b bd/fib 3.0 1.0 6 grid 8 9 10 fft estimate\n"
             "compute T all temp/brownian A\ncompute P all pressure T\n" +
             show("c_P") + "run 2");
  EXPECT_EQ(count(warnings(lmp), "use compute T all temp/brownian A B"), 1);
  EXPECT_EQ(count(warnings(lmp), "WARNING"), 1);
}

TEST(LammpsTempBrownian, Errors)
{
  const struct {
    const char *commands, *message;
  } cases[] = {
      {"compute T all temp/brownian",
       "compute temp/brownian T: the id of a fix bd/fib or bd/pse is "
       "missing: use compute T group temp/brownian fix-ID"},
      {"compute T all temp/brownian 1 1",
       "compute temp/brownian T: fix 1 is given twice: name each "
       "fix once"},
      {"compute T all temp/brownian 7\nrun 1",
       "compute temp/brownian T: there is no fix 7: define it before the run"},
      {"compute T all temp/brownian 2\nfix 2 all print 1 step\nrun 1",
       "compute temp/brownian T: fix 2 is of style print, but must be of style bd/fib or "
       "bd/pse: "
       "name the fix that moves the atoms"},
      {"compute T all temp/brownian 1\ncompute_modify T extra/dof 121\nrun 1",
       "compute temp/brownian T: 40 atoms with 121 extra degrees of freedom have -1, but must have "
       "at least 0: use a smaller compute_modify extra/dof"},
      {"compute T all temp/brownian 1\nthermo_style custom step c_T\nthermo 1\nrun 1\nunfix 1\n"
       "run 1 pre no",
       "compute temp/brownian T: there is no fix 1: define it before the run"}};
  for (const auto &c : cases) {
    LammpsSession lmp;
    lmp.script(gas);
    lmp.script(fib);
    const std::string message = lmp.error_of(c.commands);
    EXPECT_NE(message.find(c.message), std::string::npos) << message << "\n" << c.commands;
  }
}

// Thermo output finds the fix that was defined again, with another temperature.
TEST(LammpsTempBrownian, FixDefinedAgain)
{
  LammpsSession lmp;
  lmp.script(gas);
  lmp.script(fib);
  lmp.script("compute T all temp/brownian 1\n" + show("c_T") +
             "run 1\nunfix 1\nfix 1 all bd/pse 2.5 1.0 5 radius 0.5 fft estimate\nrun 1");
  EXPECT_EQ(compute(lmp, "T").scalar, 2.5);
}

namespace {

struct Mean {
  double density, error, virial;    // standard error of the density
};

/// Spheres with the WCA potential under a barostat of P = kT/sigma^3 = 1; `control` tells it which
/// pressure to control.  The standard error comes from the blocks.
Mean under_a_barostat(const std::string &control)
{
  LammpsSession lmp;
  lmp.script("units lj\natom_style atomic\nregion box block 0 7 0 7 0 7\ncreate_box 1 box\n"
             "lattice sc 0.3644\ncreate_atoms 1 box\nmass 1 1\npair_style lj/cut 1.122462\n"
             "pair_coeff 1 1 1 1\npair_modify shift yes\nneighbor 0.6 bin\n"
             "neigh_modify every 1 delay 0 check yes\ntimestep 5e-4\nthermo_style custom step\n"
             "fix 1 all bd/pse 1 0.05 123 radius 0.5 tolerance 1e-2 fft estimate\n"
             "compute T all temp/brownian 1\ncompute W all pressure NULL virial\n"
             "fix 2 all press/berendsen iso 1 1 0.1 modulus 5\n" +
             control +
             "\nvariable density equal count(all)/vol\nvariable virial equal c_W\nrun 4000");
  constexpr int blocks = 10;
  std::array<double, blocks> densities;
  Mean mean{0.0, 0.0, 0.0};
  for (double &density : densities) {
    lmp.script("fix mean all ave/time 1 2000 2000 v_density v_virial\nrun 2000");
    density = lmp.fix("mean")->compute_vector(0);
    mean.density += density / blocks;
    mean.virial += lmp.fix("mean")->compute_vector(1) / blocks;
    lmp.command("unfix mean");
  }
  double variance = 0.0;
  for (double density : densities) variance += std::pow(density - mean.density, 2) / (blocks - 1.0);
  mean.error = std::sqrt(variance / blocks);
  std::printf("density %.4f +- %.4f, virial %.4f\n", mean.density, mean.error, mean.virial);
  return mean;
}

}    // namespace

// Molecular dynamics (fix npt) and Monte Carlo give the density 0.390, and so does the equation of
// state of Carnahan and Starling with the diameter of Barker and Henderson (P = 1.005 at 0.390).
//
// The standard error is about 0.0008; steps of this length lower the density by 0.002.  A correct
// density exceeds the bound, 2 %, by chance in less than one run in a million, and one that is
// wrong by 5 % is detected.
TEST(StatisticsTempBrownian, DensityUnderABarostat)
{
  const Mean mean = under_a_barostat("fix_modify 2 temp T");
  EXPECT_NEAR(mean.density, 0.390, 0.02 * 0.390);
  EXPECT_LT(mean.error, 0.002);
  EXPECT_NEAR(mean.virial + mean.density, 1.0, 0.02);
}

// A barostat that controls only the virial reaches the density at which the virial is 1 and the
// pressure 1.46: by the same equation of state 0.465.
TEST(StatisticsTempBrownian, DensityWithoutTheIdealTerm)
{
  const Mean mean = under_a_barostat("fix_modify 2 press W");
  EXPECT_NEAR(mean.density, 0.462, 0.02 * 0.462);
  EXPECT_LT(mean.error, 0.002);
  EXPECT_NEAR(mean.virial, 1.0, 0.02);
}
