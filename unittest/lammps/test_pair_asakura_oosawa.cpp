// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// pair_style asakura/oosawa within LAMMPS.  The tests also run on several ranks.
// BDH_POTENTIALS_DIR is the folder with the parameter files of this package.

#include "pair/asakura_oosawa_kernel.h"

#include "atom.h"
#include "domain.h"
#include "exceptions.h"
#include "force.h"
#include "input.h"
#include "lammps.h"
#include "library.h"
#include "pair.h"

#include <gtest/gtest.h>
#include <mpi.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>

using namespace LAMMPS_NS;

using Values = std::vector<double>;

namespace {

constexpr double PI = 3.14159265358979323846;
constexpr int ATOMS = 24;
const char POTENTIAL[] = BDH_POTENTIALS_DIR "/Delong2014.asakura_oosawa";

int world_rank()
{
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

/// A file name that is unique to this run of the program and the same on all ranks.
std::string scratch(const std::string &name)
{
  long id = getpid();
  MPI_Bcast(&id, 1, MPI_LONG, 0, MPI_COMM_WORLD);
  return ::testing::TempDir() + "bdh_ao_" + std::to_string(id) + "_" + name;
}

/// A file that is removed at the end of the test.
struct ScratchFile {
  std::string path;

  explicit ScratchFile(const std::string &name, const std::string &text = "") : path(scratch(name))
  {
    if (!text.empty() && world_rank() == 0) std::ofstream(path) << text;
    MPI_Barrier(MPI_COMM_WORLD);
  }
  ~ScratchFile()
  {
    MPI_Barrier(MPI_COMM_WORLD);
    if (world_rank() == 0) std::remove(path.c_str());
  }
};

/// A silent LAMMPS instance with the few quantities that the tests read.
class Simulation {
 public:
  Simulation()
  {
    const char *options = std::getenv("BDH_TEST_LAMMPS_OPTIONS");    // e.g. "-k on -sf kk"
    std::istringstream line(std::string("test -screen none -log none -nocite ") +
                            (options ? options : ""));
    std::vector<std::string> words{std::istream_iterator<std::string>(line), {}};
    std::vector<char *> args;
    for (std::string &word : words) args.push_back(&word[0]);
    lmp = new LAMMPS(args.size(), args.data(), MPI_COMM_WORLD);
  }
  ~Simulation() { delete lmp; }
  Simulation(const Simulation &) = delete;
  Simulation &operator=(const Simulation &) = delete;

  void operator()(const std::string &command) { lmp->input->one(command); }

  /// The message with which LAMMPS rejects the command; empty if it accepts it.
  std::string refusal(const std::string &command)
  {
    try {
      (*this)(command);
    } catch (const LAMMPSException &e) {
      return e.what();
    }
    return "";
  }

  Pair *pair() { return lmp->force->pair; }

  double energy()
  {
    (*this)("run 0 post no");
    double sum = 0.0;
    MPI_Allreduce(&pair()->eng_vdwl, &sum, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return sum;
  }

  Values gather(const char *what)
  {
    char *name = const_cast<char *>(what);
    Values all(3 * lmp->atom->natoms);
    lammps_gather_atoms(lmp, name, 1, 3, all.data());
    return all;
  }

  void place(Values x)
  {
    static char name[] = "x";
    lammps_scatter_atoms(lmp, name, 1, 3, x.data());
  }

  std::vector<int> types()
  {
    static char name[] = "type";
    std::vector<int> all(lmp->atom->natoms);
    lammps_gather_atoms(lmp, name, 0, 1, all.data());
    return all;
  }

  double length() const { return lmp->domain->xprd; }

  /// Virial part of the pressure tensor times the volume after the last run 0: xx yy zz xy xz yz.
  Values virial()
  {
    void *vector = lammps_extract_compute(lmp, const_cast<char *>("virial"), LMP_STYLE_GLOBAL,
                                          LMP_TYPE_VECTOR);
    const double *p = static_cast<double *>(vector);
    Values w(p, p + 6);
    for (double &value : w) value *= std::pow(length(), 3);
    return w;
  }

 private:
  LAMMPS *lmp;
};

/// Two types at random positions in a periodic box.  The caller sets the coefficients.
void random_cluster(Simulation &run, const std::string &pair_style = "asakura/oosawa",
                    const std::string &newton = "on", int types = 2)
{
  run("units lj");
  run("newton " + newton);
  run("atom_modify map array");
  run("region box block 0 9 0 9 0 9");
  run("create_box " + std::to_string(types) + " box");
  run("create_atoms 1 random " + std::to_string(ATOMS) + " 4711 box");
  if (types == 2) run("set type 1 type/fraction 2 0.4 815");
  run("mass * 1.0");
  run("neighbor 0.5 bin");
  run("pair_style " + pair_style);
  run("compute virial all pressure NULL virial");
  run("thermo_style custom step pe c_virial[1]");
  run("thermo_modify norm no");
}

void three_pairs(Simulation &run, const std::string &sub_style = "")
{
  run("pair_coeff 1 1 " + sub_style + " direct 1.5 2.5");
  run("pair_coeff 1 2 " + sub_style + " direct 0.7 3.0");
  run("pair_coeff 2 2 " + sub_style + " direct 2.1 3.5");
}

double minimum_image_distance(const Values &x, int i, int j, double length)
{
  double sum = 0.0;
  for (int d = 0; d < 3; d++) {
    const double delta = x[3 * i + d] - x[3 * j + d];
    sum += std::pow(delta - length * std::round(delta / length), 2);
  }
  return std::sqrt(sum);
}

/// Sum of function(type_i, type_j, distance) over all pairs.
template <class Function> double sum_over_pairs(Simulation &run, Function function)
{
  const Values x = run.gather("x");
  const std::vector<int> type = run.types();
  double sum = 0.0;
  for (std::size_t i = 0; i < type.size(); i++)
    for (std::size_t j = i + 1; j < type.size(); j++)
      sum += function(type[i], type[j], minimum_image_distance(x, i, j, run.length()));
  return sum;
}

double norm(const Values &v)
{
  double sum = 0.0;
  for (double value : v) sum += value * value;
  return std::sqrt(sum);
}

void expect_equal(const Values &a, const Values &b, double relative)
{
  ASSERT_EQ(a.size(), b.size());
  const double bound = relative * norm(b);
  for (std::size_t i = 0; i < a.size(); i++) EXPECT_NEAR(a[i], b[i], bound) << i;
}

void expect_contains(const std::string &text, const std::vector<std::string> &parts)
{
  for (const std::string &part : parts)
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n  in: " << text;
}

/// Every error message names the style and contains the parts: parameter, value, rule, remedy.
void expect_refused(Simulation &run, const std::string &command,
                    const std::vector<std::string> &parts)
{
  const std::string message = run.refusal(command);
  expect_contains(message, {"Pair style asakura/oosawa: "});
  expect_contains(message, parts);
}

}    // namespace

/// The laws hold with newton on and off.
class AsakuraOosawaNewton : public ::testing::TestWithParam<const char *> {};

INSTANTIATE_TEST_SUITE_P(Newton, AsakuraOosawaNewton, ::testing::Values("on", "off"));

TEST_P(AsakuraOosawaNewton, EnergyIsSumOfKernelOverPairs)
{
  Simulation run;
  random_cluster(run, "asakura/oosawa", GetParam());
  three_pairs(run);
  const double c[3] = {1.5, 0.7, 2.1}, D[3] = {2.5, 3.0, 3.5};
  const double energy = run.energy();
  const double expected = sum_over_pairs(run, [&](int itype, int jtype, double r) {
    const int k = itype + jtype - 2;
    return bdh::ao_energy(r, c[k], D[k]);
  });
  EXPECT_LT(energy, -1.0);
  EXPECT_NEAR(energy, expected, 1e-13 * std::fabs(expected));
}

TEST_P(AsakuraOosawaNewton, SingleAddsUpToCompute)
{
  Simulation run;
  random_cluster(run, "asakura/oosawa", GetParam());
  three_pairs(run);
  const double energy = run.energy();
  const double expected = sum_over_pairs(run, [&](int itype, int jtype, double r) {
    double fforce;
    return run.pair()->single(0, 1, itype, jtype, r * r, 1.0, 1.0, fforce);
  });
  EXPECT_NEAR(energy, expected, 1e-13 * std::fabs(expected));
}

// The error of central differences, h^2 U'''/6 plus the round-off of the energy divided by h, is
// below 1e-7 of |F|.
TEST_P(AsakuraOosawaNewton, ForceIsMinusGradientOfEnergy)
{
  Simulation run;
  random_cluster(run, "asakura/oosawa", GetParam());
  three_pairs(run);
  run.energy();
  const Values x = run.gather("x"), f = run.gather("f");
  const double h = 1e-5;
  Values slope(f.size());
  for (std::size_t k = 0; k < f.size(); k++) {
    Values moved = x;
    moved[k] = x[k] + h;
    run.place(moved);
    const double up = run.energy();
    moved[k] = x[k] - h;
    run.place(moved);
    slope[k] = -(up - run.energy()) / (2.0 * h);
  }
  expect_equal(slope, f, 1e-7);
}

TEST_P(AsakuraOosawaNewton, ForcesAddUpToZero)
{
  Simulation run;
  random_cluster(run, "asakura/oosawa", GetParam());
  three_pairs(run);
  run.energy();
  const Values f = run.gather("f");
  for (int d = 0; d < 3; d++) {
    double sum = 0.0;
    for (int i = 0; i < ATOMS; i++) sum += f[3 * i + d];
    EXPECT_NEAR(sum, 0.0, 1e-13 * norm(f));
  }
}

// trace(W)/3 = -dE/dlnV = -(L/3) dE/dL.  The bound is the error of the central difference.
TEST_P(AsakuraOosawaNewton, VirialIsMinusSlopeOfEnergyWithVolume)
{
  const double h = 1e-5;
  double energy[2];
  Values w;
  for (int sign : {-1, 0, 1}) {
    Simulation run;
    random_cluster(run, "asakura/oosawa", GetParam());
    three_pairs(run);
    char scale[64];
    snprintf(scale, sizeof scale, "%.17g", 1.0 + sign * h);
    const std::string s = scale;
    run("change_box all x scale " + s + " y scale " + s + " z scale " + s + " remap units box");
    const double e = run.energy();
    if (sign == 0) w = run.virial();
    if (sign != 0) energy[(sign + 1) / 2] = e;
  }
  const double slope = -(energy[1] - energy[0]) / (2.0 * h) / 3.0;
  EXPECT_NEAR((w[0] + w[1] + w[2]) / 3.0, slope, 1e-7 * std::fabs(slope));
}

// Two independent ways to obtain the same tensor: the sum of r f over atoms, and the tally of every
// pair.
TEST_P(AsakuraOosawaNewton, VirialOfAtomsEqualsVirialOfPairs)
{
  Simulation run;
  random_cluster(run, "asakura/oosawa", GetParam());
  three_pairs(run);
  run.energy();
  const Values of_atoms = run.virial();
  run("pair_modify nofdotr");
  run.energy();
  expect_equal(run.virial(), of_atoms, 1e-12);
}

// Without a core the attraction pulls atoms to the same position.
TEST(AsakuraOosawaOverlap, CoincidentAtomsHaveEnergyAndNoForce)
{
  Simulation run;
  random_cluster(run, "asakura/oosawa", "on", 1);
  run("pair_coeff 1 1 2.0 3.0");
  run("delete_atoms group all");
  run("create_atoms 1 single 4 4 4 units box");
  run("create_atoms 1 single 4 4 4 units box");
  EXPECT_NEAR(run.energy(), -2.0 / 3.0 * 2.0 * 27.0, 1e-12);
  for (double f : run.gather("f")) EXPECT_EQ(f, 0.0);
  double fforce = 1.0;
  EXPECT_NEAR(run.pair()->single(0, 1, 1, 1, 0.0, 1.0, 1.0, fforce), -36.0, 1e-12);
  EXPECT_EQ(fforce, 0.0);
}

TEST(AsakuraOosawaSpecialBonds, FactorScalesEnergyAndForce)
{
  Simulation run;
  run("units lj");
  run("atom_style bond");
  run("atom_modify map array");
  run("special_bonds lj 0.25 1.0 1.0");
  run("region box block 0 9 0 9 0 9");
  run("create_box 1 box bond/types 1 extra/bond/per/atom 1 extra/special/per/atom 1");
  run("create_atoms 1 single 4 4 4 units box");
  run("create_atoms 1 single 5 4 4 units box");
  run("mass * 1.0");
  run("pair_style asakura/oosawa");
  run("pair_coeff 1 1 2.0 3.0");
  run("bond_style zero");
  run("bond_coeff 1");
  run("create_bonds single/bond 1 1 2");
  EXPECT_NEAR(run.energy(), 0.25 * bdh::ao_energy(1.0, 2.0, 3.0), 1e-13);
  EXPECT_NEAR(run.gather("f")[0], -0.25 * bdh::ao_force_over_r(1.0, 2.0, 3.0), 1e-13);
}

namespace {

double energy_with(const std::string &coefficients)
{
  Simulation run;
  random_cluster(run, "asakura/oosawa", "on", 1);
  run("pair_coeff 1 1 " + coefficients);
  return run.energy();
}

}    // namespace

TEST(AsakuraOosawaForms, DirectIsTheDefault)
{
  EXPECT_EQ(energy_with("1.25 3.0"), energy_with("direct 1.25 3.0"));
}

// n = 0.9, T = 1.3, sigma_c = 2.2, sigma_d = 0.8 give c = pi/4 n T, D = 3, eta_r = pi/6 n
// sigma_d^3.
TEST(AsakuraOosawaForms, DensityAndFractionEqualDirect)
{
  char direct[64], fraction[96];
  snprintf(direct, sizeof direct, "direct %.17g 3.0", PI / 4.0 * 0.9 * 1.3);
  snprintf(fraction, sizeof fraction, "fraction 2.2 0.8 %.17g 1.3",
           PI / 6.0 * 0.9 * 0.8 * 0.8 * 0.8);
  const double expected = energy_with(direct);
  EXPECT_NEAR(energy_with("density 2.2 0.8 0.9 1.3"), expected, 1e-13 * std::fabs(expected));
  EXPECT_NEAR(energy_with(fraction), expected, 1e-13 * std::fabs(expected));
}

// The temperature is converted to an energy with Boltzmann's constant of the units style.
TEST(AsakuraOosawaForms, TemperatureFollowsUnits)
{
  Simulation run;
  run("units real");
  run("region box block 0 9 0 9 0 9");
  run("create_box 1 box");
  run("mass 1 1.0");
  run("pair_style asakura/oosawa");
  run("pair_coeff 1 1 density 2.2 0.8 0.9 300.0");
  run("run 0 post no");
  double fforce;
  const double c = PI / 4.0 * 0.9 * 0.0019872067 * 300.0;
  EXPECT_NEAR(run.pair()->single(0, 1, 1, 1, 4.0, 1.0, 1.0, fforce), bdh::ao_energy(2.0, c, 3.0),
              1e-13);
}

TEST(AsakuraOosawaFile, EveryFormOfEntryEqualsTheCommand)
{
  const ScratchFile file("forms", "# DATE: 2014-04-01 UNITS: lj\n\nA 1.25 3.0   # plain\n"
                                  "B direct 1.25 3.0\n# no entry\n"
                                  "C density 2.2 0.8 0.9 1.3\nD fraction 2.2 0.8 0.25 1.3\n");
  const std::string prefix = "file " + file.path + " ";
  EXPECT_EQ(energy_with(prefix + "A"), energy_with("1.25 3.0"));
  EXPECT_EQ(energy_with(prefix + "B"), energy_with("1.25 3.0"));
  EXPECT_EQ(energy_with(prefix + "C"), energy_with("density 2.2 0.8 0.9 1.3"));
  EXPECT_EQ(energy_with(prefix + "D"), energy_with("fraction 2.2 0.8 0.25 1.3"));
}

// eps = 10 and a = 3.2 give c = 58.5 eps/a^3 and D = 2^(1/6) 2 a.
TEST(AsakuraOosawaFile, ClusterOfThePackage)
{
  Simulation run;
  random_cluster(run, "asakura/oosawa", "on", 1);
  run(std::string("pair_coeff 1 1 file ") + POTENTIAL + " cluster");
  int dim;
  double **c = static_cast<double **>(run.pair()->extract("c", dim));
  double **D = static_cast<double **>(run.pair()->extract("D", dim));
  EXPECT_NEAR(c[1][1], 58.5 * 10.0 / std::pow(3.2, 3), 1e-13);
  EXPECT_NEAR(D[1][1], std::pow(2.0, 1.0 / 6.0) * 6.4, 1e-14);
}

TEST(AsakuraOosawaCutoff, IsRangeOfEachPair)
{
  Simulation run;
  random_cluster(run);
  three_pairs(run);
  run.energy();
  EXPECT_EQ(run.pair()->cutforce, 3.5);
  EXPECT_DOUBLE_EQ(run.pair()->cutsq[1][1], 2.5 * 2.5);
  EXPECT_DOUBLE_EQ(run.pair()->cutsq[2][1], 3.0 * 3.0);
}

TEST(AsakuraOosawaCutoff, GlobalCutoffChangesOnlyTheNeighborList)
{
  Simulation wide, tight;
  random_cluster(wide, "asakura/oosawa 4.0");
  random_cluster(tight);
  three_pairs(wide);
  three_pairs(tight);
  const double expected = tight.energy();
  EXPECT_NEAR(wide.energy(), expected, 1e-13 * std::fabs(expected));
  EXPECT_EQ(wide.pair()->cutforce, 4.0);
}

TEST(AsakuraOosawaPairModify, ShiftAndTailChangeNothing)
{
  for (const char *option : {"shift yes", "tail yes"}) {
    Simulation run;
    random_cluster(run);
    three_pairs(run);
    const double expected = run.energy();
    run(std::string("pair_modify ") + option);
    EXPECT_EQ(run.energy(), expected) << option;
    EXPECT_EQ(run.pair()->etail, 0.0) << option;
  }
}

TEST(AsakuraOosawaRestart, BinaryFileKeepsCoefficientsAndCutoff)
{
  const ScratchFile file("restart");
  double expected;
  {
    Simulation run;
    random_cluster(run, "asakura/oosawa 3.75");
    three_pairs(run);
    expected = run.energy();
    run("write_restart " + file.path);
  }
  Simulation run;
  run("read_restart " + file.path);
  EXPECT_NEAR(run.energy(), expected, 1e-14 * std::fabs(expected));
  EXPECT_EQ(run.pair()->cutforce, 3.75);
}

// 1/3 and 10/3 are not finite decimals, so the file must store them to the last bit.
TEST(AsakuraOosawaRestart, DataFileKeepsCoefficientsExactly)
{
  for (const std::string form : {"ii", "ij"}) {
    const ScratchFile file("data");
    {
      Simulation run;
      random_cluster(run, "asakura/oosawa", "on", form == "ii" ? 1 : 2);
      run("pair_coeff * * direct 0.33333333333333331 3.3333333333333335");
      run.energy();
      run("write_data " + file.path + " pair " + form);
    }
    Simulation run;
    run("pair_style asakura/oosawa");
    run("read_data " + file.path);
    int dim;
    double **c = static_cast<double **>(run.pair()->extract("c", dim));
    double **D = static_cast<double **>(run.pair()->extract("D", dim));
    EXPECT_EQ(c[1][1], 1.0 / 3.0) << form;
    EXPECT_EQ(D[1][1], 10.0 / 3.0) << form;
    EXPECT_LT(run.energy(), 0.0) << form;
  }
}

TEST(AsakuraOosawaPairWrite, TableIsTheKernel)
{
  const ScratchFile file("table");
  Simulation run;
  random_cluster(run);
  three_pairs(run);
  run("pair_write 1 2 61 r 0.5 3.5 " + file.path + " AO");
  if (world_rank() != 0) return;

  std::ifstream table(file.path);
  std::string line;
  int rows = 0;
  while (std::getline(table, line)) {
    std::istringstream words(line);
    double i, r, e, f;
    if (!(words >> i >> r >> e >> f)) continue;
    EXPECT_NEAR(e, bdh::ao_energy(r, 0.7, 3.0), 1e-13);
    EXPECT_NEAR(f, r * bdh::ao_force_over_r(r, 0.7, 3.0), 1e-13);
    rows++;
  }
  EXPECT_EQ(rows, 61);
}

TEST(AsakuraOosawaHybrid, OverlayIsTheSumOfBoth)
{
  Simulation overlay, attraction, core;
  random_cluster(overlay, "hybrid/overlay asakura/oosawa lj/cut 1.5");
  random_cluster(attraction);
  random_cluster(core, "lj/cut 1.5");
  three_pairs(overlay, "asakura/oosawa");
  three_pairs(attraction);
  overlay("pair_coeff * * lj/cut 0.01 0.8");
  core("pair_coeff * * 0.01 0.8");

  const double expected = attraction.energy() + core.energy();
  EXPECT_NEAR(overlay.energy(), expected, 1e-12 * std::fabs(expected));
  Values sum = attraction.gather("f");
  const Values f_core = core.gather("f");
  for (std::size_t i = 0; i < sum.size(); i++) sum[i] += f_core[i];
  expect_equal(overlay.gather("f"), sum, 1e-12);
}

TEST(AsakuraOosawaHybrid, MayServeSomePairsOnly)
{
  Simulation run;
  random_cluster(run, "hybrid asakura/oosawa zero 1.0");
  run("pair_coeff * * zero");
  run("pair_coeff 1 1 asakura/oosawa fraction 2.2 0.8 0.25 1.3");
  const double c = bdh::ao_strength_from_density(bdh::ao_density_from_fraction(0.25, 0.8), 1.3);
  const double energy = run.energy();
  const double expected = sum_over_pairs(run, [&](int itype, int jtype, double r) {
    return itype == 1 && jtype == 1 ? bdh::ao_energy(r, c, 3.0) : 0.0;
  });
  EXPECT_NEAR(energy, expected, 1e-13 * std::fabs(expected));
}

namespace {

/// Energy after fix adapt has changed c to 2.0 and D to D_end in ten steps without motion.
double adapted_energy(Simulation &run, const std::string &style_prefix, const std::string &D_end)
{
  run("pair_coeff * * " + style_prefix + " direct 1.0 2.5");
  run("variable c equal ramp(1.0,2.0)");
  run("variable D equal ramp(2.5," + D_end + ")");
  run("fix change all adapt 1 pair asakura/oosawa c * * v_c pair asakura/oosawa D * * v_D");
  run("run 10 post no");
  double sum = 0.0;
  MPI_Allreduce(&run.pair()->eng_vdwl, &sum, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return sum;
}

}    // namespace

TEST(AsakuraOosawaAdapt, ReachesStrengthAndRangeUpToTheCutoff)
{
  for (const std::string hybrid : {"", "hybrid/overlay "}) {
    Simulation run, fixed;
    random_cluster(run, hybrid + "asakura/oosawa 3.5");
    random_cluster(fixed);
    fixed("pair_coeff * * direct 2.0 3.5");
    const double expected = fixed.energy();
    const double energy = adapted_energy(run, hybrid.empty() ? "" : "asakura/oosawa", "3.5");
    EXPECT_NEAR(energy, expected, 1e-12 * std::fabs(expected)) << hybrid;
  }
}

TEST(AsakuraOosawaAdapt, ShorterRangeNeedsNoCutoff)
{
  Simulation run, fixed;
  random_cluster(run);
  random_cluster(fixed);
  fixed("pair_coeff * * direct 2.0 2.0");
  const double expected = fixed.energy();
  EXPECT_NEAR(adapted_energy(run, "", "2.0"), expected, 1e-12 * std::fabs(expected));
}

TEST(AsakuraOosawaAdapt, RefusesRangeBeyondTheNeighborList)
{
  for (const std::string hybrid : {"", "hybrid/overlay "}) {
    Simulation run;
    random_cluster(run, hybrid + "asakura/oosawa");
    std::string message;
    try {
      adapted_energy(run, hybrid.empty() ? "" : "asakura/oosawa", "3.5");
    } catch (const LAMMPSException &e) {
      message = e.what();
    }
    expect_contains(message,
                    {"Pair style asakura/oosawa: D = 2.6 for atom types 1 and 1", "must be <= 2.5",
                     "give the largest D as the argument of pair_style"});
  }
}

TEST(AsakuraOosawaAdapt, RefusesNegativeStrength)
{
  Simulation run;
  random_cluster(run);
  three_pairs(run);
  run("variable c equal -1.0");
  run("fix change all adapt 1 pair asakura/oosawa c 1 2 v_c");
  expect_refused(run, "run 1", {"c = -1 for atom types 1 and 2", "must be a finite number >= 0"});
}

TEST(AsakuraOosawaRefuses, UnsetMixedPair)
{
  Simulation run;
  random_cluster(run);
  run("pair_coeff 1 1 1.0 2.0");
  run("pair_coeff 2 2 1.0 3.0");
  expect_refused(run, "run 0",
                 {"atom types 1 and 2 have no coefficients", "no mixing rule",
                  "add 'pair_coeff 1 2 direct c D'"});
}

TEST(AsakuraOosawaRefuses, StyleArguments)
{
  Simulation run;
  random_cluster(run);
  expect_refused(run, "pair_style asakura/oosawa 1.0 2.0",
                 {"2 arguments", "at most one", "pair_coeff"});
  expect_refused(run, "pair_style asakura/oosawa -1.0", {"cutoff = -1.0", "> 0", "leave it out"});
  // Newer releases of LAMMPS refuse such a number themselves.
  expect_contains(run.refusal("pair_style asakura/oosawa 1e400"),
                  {"1e400", BDH_LAMMPS_DATE < 20250204 ? "finite" : "out of range"});
  run("pair_style asakura/oosawa 2.75");
  three_pairs(run);
  expect_refused(run, "run 0",
                 {"cutoff = 2.75", ">= D = 3 of atom types 1 and 2", "raise it in pair_style"});
}

TEST(AsakuraOosawaRefuses, BadValues)
{
  Simulation run;
  random_cluster(run);
  expect_refused(run, "pair_coeff 1 1 -1.0 2.0", {"c = -1.0 in pair_coeff", ">= 0", "c = 0"});
  expect_refused(run, "pair_coeff 1 1 direct nan 2.0", {"c = nan", "finite"});
  expect_refused(run, "pair_coeff 1 1 direct inf 2.0", {"c = inf", "finite"});
  expect_refused(run, "pair_coeff 1 1 direct 1.0 0.0", {"D = 0.0", "> 0"});
  expect_refused(run, "pair_coeff 1 1 direct 1.0 two", {"D = two", "number"});
  expect_refused(run, "pair_coeff 1 1 density 0.0 1.0 1.0 1.0", {"sigma_c = 0.0", "> 0"});
  expect_refused(run, "pair_coeff 1 1 density 1.0 -1.0 1.0 1.0", {"sigma_d = -1.0", "> 0"});
  expect_refused(run, "pair_coeff 1 1 density 1.0 1.0 -0.1 1.0", {"n = -0.1", ">= 0"});
  expect_refused(run, "pair_coeff 1 1 density 1.0 1.0 1.0 0.0", {"T = 0.0", "> 0"});
  expect_refused(run, "pair_coeff 1 1 fraction 1.0 1.0 -0.1 1.0", {"eta_r = -0.1", ">= 0"});
  expect_refused(run, "pair_coeff 1 1 fraction 1.0 0.0 0.1 1.0", {"sigma_d = 0.0", "> 0"});
}

TEST(AsakuraOosawaRefuses, WrongWords)
{
  Simulation run;
  random_cluster(run);
  expect_refused(run, "pair_coeff 1 1", {"pair_coeff has no values", "direct c D"});
  expect_refused(run, "pair_coeff 1 1 depletion 1.0 2.0 3.0",
                 {"form 'depletion'", "direct, density or fraction"});
  expect_refused(run, "pair_coeff 1 1 direct 1.0", {"1 values", "needs 2", "direct c D"});
  expect_refused(run, "pair_coeff 1 1 density 1.0 2.0 3.0",
                 {"3 values", "needs 4", "density sigma_c sigma_d n T"});
  expect_refused(run, "pair_coeff 1 1 fraction 1.0 2.0 3.0",
                 {"needs 4", "fraction sigma_c sigma_d eta_r T"});
  expect_refused(run, "pair_coeff 1 1 file somewhere",
                 {"1 words after 'file'", "file FILENAME ENTRY"});
  // Newer releases of LAMMPS exchange the types of pair_coeff 2 1.
  expect_refused(run, "pair_coeff 2* 1 1.0 2.0",
                 {"pair_coeff 2* 1 selects no pair", "lower atom type first"});
}

TEST(AsakuraOosawaRefuses, BadFiles)
{
  const ScratchFile file("bad",
                         "# UNITS: lj\nA direct 1.0 2.0\nB direct -1.0 2.0\nB direct 1.0 2.0\n"
                         "C direct -1.0 2.0\nD\nE file x A\n");
  const std::string prefix = "pair_coeff 1 1 file " + file.path + " ";
  Simulation run;
  random_cluster(run);
  expect_refused(run, "pair_coeff 1 1 file /no/such/file A",
                 {"file /no/such/file cannot be read", "give its path"});
  expect_refused(run, prefix + "Z",
                 {"entry Z is not in file " + file.path, "one of its entries: A B B C D E"});
  expect_refused(run, prefix + "B",
                 {"entry B occurs 2 times in file " + file.path, "must occur once"});
  expect_refused(run, prefix + "C", {"c = -1.0 in entry C of file " + file.path, ">= 0"});
  expect_refused(run, prefix + "D", {"form '' in entry D of file " + file.path, "direct c D"});
  expect_refused(run, prefix + "E", {"form 'file' in entry E", "in pair_coeff also file"});
}

// Only rank 0 reads the file, and LAMMPS stops there: the exception does not reach the other ranks.
TEST(AsakuraOosawaRefuses, FileInOtherUnits)
{
  Simulation run;
  run("units real");
  run("region box block 0 9 0 9 0 9");
  run("create_box 1 box");
  run("pair_style asakura/oosawa");
  expect_refused(run, std::string("pair_coeff 1 1 file ") + POTENTIAL + " cluster",
                 {POTENTIAL, "is for units lj", "the units are real", "use a file for those"});
}

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  ::testing::InitGoogleTest(&argc, argv);
  const int result = RUN_ALL_TESTS();
  MPI_Finalize();
  return result;
}
