// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/fib with open faces in LAMMPS: reference mobilities, boxes of any height, flows, wall
// forces, particles that leave, and equilibrium above one wall.

#include "lammps/lammps_fib_reference.h"
#include "lammps/lammps_scenes.h"
#include "lammps/lammps_turning.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

using bdh_test::LammpsSession;
using bdh_test::text;

namespace {

/// A box of 10 x 8 and some height with atoms near its lower end, which are pulled.
std::string above_a_wall(double height, const std::string &fix)
{
  return R"(
units lj
atom_style atomic
atom_modify map array
boundary p p f
neigh_modify every 1 delay 0 check yes
comm_modify cutoff 2.0
region box block 0 10 0 8 -1 )" +
         text(height - 1.0) + R"(
create_box 1 box
create_atoms 1 single 1 2 0.5
create_atoms 1 single 5 2 2
create_atoms 1 single 3 4 3
create_atoms 1 single 3.2 4.1 3.9
mass 1 1.0
timestep 0.01
fix pull all addforce 0.3 0.2 -0.5
)" + fix +
         "\n";
}

const std::string wall_below = " wall zlo noslip wall zhi open ";

/// f_ID[10 + 6 axis + 3 side + component], counted from 1
double wall_force(LammpsSession &lmp, int side, int component, int axis = 2)
{
  return lmp.fix("move")->compute_vector(9 + 6 * axis + 3 * side + component);
}

std::vector<double> ends_of_run(const std::string &script, int steps)
{
  LammpsSession lmp;
  lmp.script(script);
  lmp.command("run " + std::to_string(steps));
  return lmp.unwrapped_positions();
}

/// One atom in a box of 8 x 8 x 8 that is pushed up, or down by a negative force.
std::string pushed(double z, double force, double dt, const std::string &keywords)
{
  return "units lj\natom_style atomic\natom_modify map array\nboundary p p f\n"
         "comm_modify cutoff 2.0\nneigh_modify every 1 delay 0 check yes\n"
         "region box block 0 8 0 8 0 8\ncreate_box 1 box\nmass 1 1.0\ncreate_atoms 1 single 3 4 " +
         text(z) + "\nfix push all addforce 0 0 " + text(force) +
         "\nfix move all bd/fib 0.0 1.0 7 grid 8 8 8 " + keywords + "\ntimestep " + text(dt) +
         "\nrun 20\n";
}

/// What a torque of 1 about an axis does to a sphere of radius 1.
struct Turned {
  double omega;    // about the axis
  std::vector<double> velocity;
};

/// The sphere is over a plate of 32 x 32 radii, in a fluid of viscosity 1.3.
Turned turned_over_plate(double height, size_t axis)
{
  LammpsSession lmp;
  lmp.script("units lj\natom_style sphere\natom_modify map array\nboundary p p f\n"
             "comm_modify cutoff 2.0\nneigh_modify every 1 delay 0 check yes\n"
             "region box block 0 32 0 32 0 12\ncreate_box 1 box\n"
             "create_atoms 1 single 15.9 16.3 " +
             text(height) + "\nset group all diameter 2.0\ntimestep 1e-9\n");
  std::vector<double> torque(3, 0.0);
  torque[axis] = 1.0;
  const bdh_test::GivenTorques given(lmp, torque);
  lmp.script("fix move all bd/fib 0.0 1.3 7 radius 1.0 fft estimate rotation yes scheme euler " +
             wall_below + "\nrun 1");
  return {bdh_test::omegas(lmp)[axis], lmp.velocities()};
}

/// The lines of the log that begin with a word, joined.
std::string lines_of(const std::string &log, const std::string &word)
{
  std::string found;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);)
    if (line.find("  " + word + " ") == 0) found += line + "\n";
  return found;
}

/// Cholesky factor of an n x n matrix, row by row: C = L L^T.
std::vector<double> cholesky(const std::vector<double> &C, int n)
{
  std::vector<double> L(n * n, 0.0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      double s = C[i * n + j];
      for (int k = 0; k < j; ++k) s -= L[i * n + k] * L[j * n + k];
      L[i * n + j] = i == j ? std::sqrt(s) : s / L[j * n + j];
    }
  return L;
}

/// L^-1 v
std::vector<double> whitened(const std::vector<double> &L, std::vector<double> v)
{
  const int n = v.size();
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < i; ++k) v[i] -= L[i * n + k] * v[k];
    v[i] /= L[i * n + i];
  }
  return v;
}

/// Atoms above a wall in two dimensions that feel their weight and a soft floor.
struct Sediment {
  const double weight = 0.4, stiffness = 3.0, range = 3.0, height = 60.0;
  const int atoms = 60;
  std::vector<double> cumulative{0.0};    // of the distribution, in steps of 1e-3
  double expected[2] = {0.0, 0.0};        // means of z and of exp(-z), which sees the floor

  Sediment()
  {
    for (double z = 5e-4; z < height; z += 1e-3) {
      const double p = std::exp(-energy(z));
      cumulative.push_back(cumulative.back() + p);
      expected[0] += z * p;
      expected[1] += std::exp(-z) * p;
    }
    for (double &e : expected) e /= cumulative.back();
  }
  double energy(double z) const
  {
    return weight * z + (z < range ? stiffness * (range - z) * (range - z) : 0.0);
  }
  void begin(LammpsSession &lmp, const std::string &scheme) const
  {
    lmp.script("units lj\ndimension 2\natom_style atomic\natom_modify map array\nboundary p f p\n"
               "comm_modify cutoff 2.0\nneigh_modify every 1 delay 0 check yes\n"
               "region box block 0 16 0 60 -0.5 0.5\ncreate_box 1 box\nmass 1 1.0");
    std::mt19937_64 engine(3);
    std::uniform_real_distribution<double> uniform;
    for (int i = 0; i < atoms; ++i) {
      const double u = uniform(engine) * cumulative.back();
      const auto bin = std::upper_bound(cumulative.begin(), cumulative.end(), u);
      const double x[3] = {16.0 * uniform(engine), 1e-3 * double(bin - cumulative.begin()), 0.0};
      lmp.create_atom(x);
    }
    lmp.script("fix weight all addforce 0 -" + text(weight) + " 0\nfix floor all wall/harmonic " +
               "ylo EDGE " + text(stiffness) + " 1.0 " + text(range) +
               "\nfix flat all enforce2d\n" +
               "fix move all bd/fib 1.0 1.0 11 grid 16 60 1 wall ylo noslip wall yhi open scheme " +
               scheme + "\ntimestep 0.1\nthermo 1000000\nrun 0");
  }
  /// Deviations of both means from those expected, in standard errors over 20 blocks.
  std::array<double, 2> deviations(const std::string &scheme) const
  {
    LammpsSession lmp;
    begin(lmp, scheme);
    std::array<std::vector<double>, 2> blocks;
    for (int block = 0; block < 20; ++block) {
      double mean[2] = {0.0, 0.0};
      for (int s = 0; s < 60; ++s) {
        lmp.command("run 20 pre no post no");
        const std::vector<double> x = lmp.unwrapped_positions();
        for (size_t i = 1; i < x.size(); i += 3) {
          mean[0] += x[i] / (60 * atoms);
          mean[1] += std::exp(-x[i]) / (60 * atoms);
        }
      }
      for (size_t m = 0; m < 2; ++m) blocks[m].push_back(mean[m]);
    }
    std::array<double, 2> t{};
    for (size_t m = 0; m < 2; ++m) {
      double mean = 0.0, square = 0.0;
      for (double b : blocks[m]) mean += b / 20.0;
      for (double b : blocks[m]) square += (b - mean) * (b - mean);
      t[m] = (mean - expected[m]) / std::sqrt(square / 19.0 / 20.0);
      std::printf("%s: mean %.5f, expected %.5f, t %.2f\n", scheme.c_str(), mean, expected[m],
                  t[m]);
    }
    return t;
  }
};

}    // namespace

TEST(LammpsOpen, OneStepAtTemperatureZeroReadsOutMF)
{
  const nlohmann::json all = bdh_test::json_reference("fib_open.json");
  EXPECT_GE(all["cases"].size(), 30u);
  for (const auto &c : all["cases"])
    EXPECT_LT(bdh_test::deviation(c, bdh_test::velocities_of(c, 1e-5, "")), 1e-11) << c["id"];
}

// The trajectory above a no-slip wall, with noise and drift, does not depend on where the box ends.
// With keyword radius the height need not be a multiple of h.  Roundings grow over the steps.
TEST(LammpsOpen, TrajectoryDoesNotDependOnTheHeightOfTheBox)
{
  for (const char *scheme :
       {"midpoint", "improved", "euler", "trapezoidal", "midpoint drift rfd"}) {
    const auto ends = [&](double height, int seed) {
      return ends_of_run(
          above_a_wall(height, "fix move all bd/fib 1.0 1.0 " + std::to_string(seed) +
                                   " radius 1.2544 fft estimate scheme " + scheme + wall_below),
          40);
    };
    const std::vector<double> low = ends(7.3, 7);
    // Differences over 2e-6 h multiply roundings by as much.
    const double bound = std::string(scheme) == "midpoint drift rfd" ? 1e-7 : 1e-11;
    EXPECT_LT(bdh_test::largest_difference(low, ends(30.0, 7)), bound) << scheme;
    EXPECT_GT(bdh_test::largest_difference(low, ends(30.0, 8)), 1e-2) << scheme;
  }
}

TEST(LammpsOpen, PlanNamesTheOpenFace)
{
  LammpsSession above, free;
  above.script(
      above_a_wall(8.0, "fix move all bd/fib 1.0 1.0 7 grid 10 8 8" + wall_below + "\nrun 0"));
  const std::string log = above.log();
  for (const char *line :
       {"grid       10 x 8 x 11 cells", "wall       zlo no-slip",
        "wall       zhi open: fluid without end; 3 rows of the grid lie beyond the box",
        "rows       only those up to the highest particle", "now        11 rows, 0.0",
        "eliminates the fluid beyond open faces"})
    EXPECT_NE(log.find(line), std::string::npos) << line << "\n" << log;
  EXPECT_EQ(log.find("is a convention"), std::string::npos);
  free.script(above_a_wall(8.0, "fix move all bd/fib 1.0 1.0 7 grid 10 8 8 kernel bkp6 "
                                "wall zlo slip wall zhi open\nrun 0"));
  EXPECT_NE(free.log().find("the common velocity along the faces is a convention"),
            std::string::npos);
  EXPECT_NE(free.log().find("4 rows of the grid lie beyond"), std::string::npos);
}

// With keyword radius the cells are cubes, whatever the height.
TEST(LammpsOpen, RadiusGivesCubes)
{
  for (double height : {5.0, 5.3, 6.7}) {
    LammpsSession lmp;
    lmp.script(above_a_wall(height, "fix move all bd/fib 1.0 1.0 7 radius 1.2544" + wall_below +
                                        "\nrun 0"));
    EXPECT_EQ(lmp.log().find("the cells are not cubic"), std::string::npos) << height;
    EXPECT_NEAR(lmp.fix("move")->compute_vector(4), 1.0, 1e-12);
  }
}

// A single layer of cells is enough, and on the lower side the cells are counted from the wall,
// too.
TEST(LammpsOpen, AMonolayerNeedsOneLayerOfCells)
{
  const std::string scene =
      "units lj\natom_style atomic\natom_modify map array\nboundary p p f\ncomm_modify cutoff 2.0\n"
      "region box block 0 8 0 8 0 0.9\ncreate_box 1 box\nmass 1 1.0\ncreate_atoms 1 single 3 4 "
      "0.4\n"
      "fix push all addforce 1 0 0\nfix move all bd/fib 0.0 1.0 7 ";
  const auto velocity = [&](const std::string &fix) {
    LammpsSession lmp;
    lmp.script(scene + fix + "\ntimestep 1e-6\nrun 1");
    return lmp.velocities()[0];
  };
  const double low = velocity("radius 1.2544" + wall_below);
  EXPECT_GT(low, 1e-4);
  EXPECT_NEAR(low, velocity("radius 1.2544 wall zlo noslip wall zhi open scheme euler"), 1e-12);
  const double above = velocity("radius 1.2544 wall zlo open wall zhi noslip");    // 0.5 below it
  EXPECT_GT(above, low);
  EXPECT_GT(velocity("radius 1.2544 wall zlo open wall zhi open"), above);
}

// The wall carries the whole pull on atoms that do not reach their images; nothing acts on the open
// face.
TEST(LammpsOpen, TheWallCarriesTheNetForce)
{
  LammpsSession lmp;
  lmp.script(above_a_wall(8.0, "displace_atoms all move 0 0 1.5\nfix move all bd/fib 0.0 1.0 7 "
                               "grid 10 8 8" +
                                   wall_below + "\nrun 1"));
  const double pull[3] = {1.2, 0.8, -2.0};
  for (int d = 0; d < 3; ++d) {
    EXPECT_NEAR(wall_force(lmp, 0, d), pull[d], 1e-12);
    EXPECT_EQ(wall_force(lmp, 1, d), 0.0);
    EXPECT_EQ(wall_force(lmp, 0, d, 0), 0.0);
  }
}

// u = velocity of the wall + rate times the distance from it; the stress on the wall is viscosity
// times rate, over an area of 80.
TEST(LammpsOpen, ShearAboveOneWall)
{
  LammpsSession lmp;
  lmp.script(above_a_wall(8.0, "unfix pull\nfix move all bd/fib 0.0 2.0 7 grid 10 8 8 shear 0.3 "
                               "wall zlo noslip 0.1 -0.2 0 wall zhi open\nrun 1"));
  const std::vector<double> v = lmp.velocities();
  const double z[4] = {0.5, 2.0, 3.0, 3.9};
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(v[3 * i], 0.1 + 0.3 * (z[i] + 1.0), 1e-13);
    EXPECT_NEAR(v[3 * i + 1], -0.2, 1e-13);
    EXPECT_NEAR(v[3 * i + 2], 0.0, 1e-13);
  }
  EXPECT_NEAR(wall_force(lmp, 0, 0), 2.0 * 0.3 * 80.0, 1e-11);
  EXPECT_EQ(wall_force(lmp, 1, 0), 0.0);
  EXPECT_NE(lmp.log().find("u = 0.3 times the distance from the wall along x is added"),
            std::string::npos);
}

// Below one wall, and between open faces in two dimensions.
TEST(LammpsOpen, ShearElsewhere)
{
  LammpsSession below, free;
  below.script(above_a_wall(8.0, "unfix pull\nfix move all bd/fib 0.0 2.0 7 grid 10 8 8 shear 0.3 "
                                 "wall zlo open wall zhi noslip\nrun 1"));
  EXPECT_NEAR(below.velocities()[0], 0.3 * (7.0 - 0.5), 1e-13);
  EXPECT_NEAR(wall_force(below, 1, 0), 2.0 * 0.3 * 80.0, 1e-11);
  free.script("units lj\ndimension 2\natom_style atomic\natom_modify map array\nboundary p f p\n"
              "comm_modify cutoff 2.0\nregion box block 0 8 0 6 -0.5 0.5\ncreate_box 1 box\n"
              "mass 1 1.0\ncreate_atoms 1 single 3 1 0\ncreate_atoms 1 single 3 5 0\n"
              "fix move all bd/fib 0.0 2.0 7 grid 8 6 1 shear 0.3 wall ylo open wall yhi open\n"
              "timestep 0.01\nrun 1");
  EXPECT_NEAR(free.velocities()[0], -0.6, 1e-13);
  EXPECT_NEAR(free.velocities()[3], 0.6, 1e-13);
}

TEST(LammpsOpen, AMovingWallCarriesAllFluid)
{
  LammpsSession lmp;
  lmp.script(above_a_wall(8.0, "unfix pull\nfix move all bd/fib 0.0 2.0 7 grid 10 8 8 "
                               "wall zlo noslip 1.5 0.5 0 wall zhi open\nrun 1"));
  const std::vector<double> v = lmp.velocities();
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(v[3 * i], 1.5, 1e-13);
    EXPECT_NEAR(v[3 * i + 1], 0.5, 1e-13);
  }
}

// Whatever crossing says, since it is for walls: the error names the face and the remedy.
TEST(LammpsOpen, AnAtomThatLeavesStopsTheRun)
{
  for (const char *crossing : {"error", "reflect", "redraw"})
    for (const char *scheme : {"midpoint", "euler", "trapezoidal"}) {
      LammpsSession lmp;
      const std::string message = lmp.error_of(pushed(
          7.7, 3.0, 0.5, std::string("crossing ") + crossing + " scheme " + scheme + wall_below));
      for (const char *words :
           {"atom 1 at step ", "it has left through the open face zhi (z = 8.",
            "the face is at 8): make the box larger on that side, which changes nothing else"})
        EXPECT_NE(message.find(words), std::string::npos) << crossing << scheme << message;
    }
}

// At the opposite wall an atom is mirrored as ever.
TEST(LammpsOpen, CrossingActsAtWalls)
{
  LammpsSession error, reflect;
  const std::string walls = " kernel roma3 wall zlo slip wall zhi open ";
  const std::string message = error.error_of(pushed(0.7, -30.0, 2.0, "scheme euler" + walls));
  EXPECT_NE(message.find("it is outside the wall zlo"), std::string::npos) << message;
  EXPECT_EQ(reflect.error_of(pushed(0.7, -30.0, 2.0, "scheme euler crossing reflect" + walls)), "");
  EXPECT_GT(reflect.fix("move")->compute_vector(8), 0.0);
}

// Without interactions each atom is distributed as exp(-energy/kT).  Runs start in equilibrium.
// With 19 degrees of freedom, |t| > 5 has the probability 8e-5.  Scheme euler, which lacks the
// thermal drift, must be rejected.
TEST(LammpsOpen, DensityAboveAWallIsBoltzmanns)
{
  const Sediment sediment;
  for (double t : sediment.deviations("midpoint")) EXPECT_LT(std::fabs(t), 5.0);
  const std::array<double, 2> biased = sediment.deviations("euler");
  EXPECT_GT(std::max(std::fabs(biased[0]), std::fabs(biased[1])), 5.0);
}

// The displacements of atoms at the open face and near it have the covariance 2 kT M dt, with M
// read out column by column.  The steps are so short that the atoms stay where they are.  Over the
// 78 elements of the whitened covariance chi^2 exceeds 78 + 5 sqrt(156) for 1e-5 of all seeds.
TEST(LammpsOpen, CovarianceOfDisplacementsIsTheMobility)
{
  const int samples = 3000, n = 12;
  const double kT = 0.8, dt = 1e-12;
  const std::string scene = above_a_wall(4.9001, "unfix pull\ntimestep " + text(dt));
  const std::string fix = " 1.3 7 grid 10 8 5 scheme euler" + wall_below;
  std::vector<double> C(n * n);
  for (int c = 0; c < n; ++c) {
    LammpsSession lmp;
    const char *axes[3] = {"1 0 0", "0 1 0", "0 0 1"};
    lmp.script(scene + "group one id " + std::to_string(c / 3 + 1) + "\nfix push one addforce " +
               axes[c % 3] + "\nfix move all bd/fib 0.0" + fix + "\nrun 1");
    const std::vector<double> v = lmp.velocities();
    for (int r = 0; r < n; ++r) C[r * n + c] = 2.0 * kT / dt * v[r];
  }
  const std::vector<double> L = cholesky(C, n);
  LammpsSession lmp;
  lmp.script(scene + "fix move all bd/fib " + text(kT) + fix + "\nrun 0");
  std::vector<double> found(n * n, 0.0);
  for (int s = 0; s < samples; ++s) {
    lmp.command("run 1 pre no post no");
    const std::vector<double> y = whitened(L, lmp.velocities());
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j) found[i * n + j] += y[i] * y[j] / samples;
  }
  double chi2 = 0.0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      const double off = found[i * n + j] - (i == j ? 1.0 : 0.0);
      chi2 += off * off * samples / (i == j ? 2.0 : 1.0);
    }
  std::printf("covariance at an open face: chi2 %.1f for 78 elements\n", chi2);
  EXPECT_LT(chi2, 78.0 + 5.0 * std::sqrt(156.0));
}

// Only the rows up to the highest atom are used: a box 100 times as high needs no more memory,
// nothing changes, and the log says so before the first step.
TEST(LammpsOpen, ATallBoxCostsNothing)
{
  std::vector<double> x[2];
  double bytes[2];
  std::string now[2];
  for (int tall = 0; tall < 2; ++tall) {
    LammpsSession lmp;
    lmp.script(above_a_wall(tall ? 3000.0 : 30.0,
                            "fix move all bd/fib 1.0 1.0 7 radius 1.2544 fft estimate" +
                                wall_below + "\nrun 20"));
    x[tall] = lmp.unwrapped_positions();
    bytes[tall] = lmp.fix("move")->memory_usage();
    EXPECT_NE(lmp.log().find("rows       only those up to the highest particle, in steps of 8"),
              std::string::npos);
    now[tall] = lines_of(lmp.log(), "now");
  }
  EXPECT_EQ(now[0].find("  now        16 rows, 0."), 0u) << now[0];
  EXPECT_EQ(now[0], now[1]);
  EXPECT_EQ(bytes[0], bytes[1]);
  EXPECT_LT(bdh_test::largest_difference(x[0], x[1]), 1e-11);
}

// A step so long that an atom leaves the rows in use within it: at a distance of 10.9 from the
// wall, 16 rows reach to 13.  A second atom without force, far away, needs more rows from the
// beginning. Without its thermal drift it does not disturb the first one.
TEST(LammpsOpen, LongStepsMakeRoom)
{
  for (const char *scheme : {"euler", "midpoint", "improved", "trapezoidal"})
    for (const bool up : {true, false}) {
      std::vector<double> x[2];
      for (int far = 0; far < 2; ++far) {
        LammpsSession lmp;
        lmp.script("units lj\natom_style atomic\natom_modify map array\nboundary p p f\n"
                   "comm_modify cutoff 2.0\nneigh_modify every 1 delay 0 check yes\n"
                   "region box block 0 20 0 20 0 60\ncreate_box 1 box\nmass 1 1.0\n"
                   "create_atoms 1 single 3 4 " +
                   text(up ? 10.9 : 60.0 - 10.9) +
                   "\ngroup pushed id 1\nfix push pushed addforce 0 0 " + (up ? "30" : "-30") +
                   "\nfix move all bd/fib 1.0 1.0 7 radius 1.2544 drift no scheme " + scheme +
                   (up ? " wall zlo noslip wall zhi open" : " wall zlo open wall zhi noslip") +
                   "\ntimestep 6.0");
        if (far) lmp.script("create_atoms 1 single 13 14 " + std::string(up ? "45" : "15"));
        lmp.command("run 1");
        x[far] = lmp.unwrapped_positions();
        x[far].resize(3);
      }
      const double way = up ? x[0][2] - 10.9 : 60.0 - 10.9 - x[0][2];
      if (std::string(scheme) == "euler") {
        EXPECT_GT(way, 5.0);    // half of it, where the others interpolate, is beyond 13
      }
      EXPECT_LT(bdh_test::largest_difference(x[0], x[1]), 1e-11) << scheme << up;
    }
}

// The face of the box may go along with the atoms, if the spacing does not come from its height.
TEST(LammpsOpen, TheFaceMayFollowTheAtoms)
{
  const std::string fix = "fix move all bd/fib 1.0 1.0 7 radius 1.2544 fft estimate" + wall_below;
  const std::vector<double> fixed = ends_of_run(above_a_wall(60.0, fix), 400);
  for (const char *boundary : {"fs", "fm"}) {
    const std::string follow = std::string("change_box all boundary p p ") + boundary + "\n";
    LammpsSession lmp;
    lmp.script(above_a_wall(60.0, follow + fix + "\nrun 400"));
    EXPECT_LT(bdh_test::largest_difference(fixed, lmp.unwrapped_positions()), 1e-9) << boundary;
    if (std::string(boundary) == "fs") {
      EXPECT_LT(lmp->domain->boxhi[2], 30.0);
    }
    // Restarted, the box is another one, and the trajectory the same.
    const std::string file = "test_open_" + std::to_string(getpid()) + ".restart";
    LammpsSession first, second;
    first.script(above_a_wall(60.0, follow + fix + "\nrun 133\nwrite_restart " + file));
    second.script("read_restart " + file +
                  "\ncomm_modify cutoff 2.0\nneigh_modify every 1 delay 0 check yes\n"
                  "timestep 0.01\nfix pull all addforce 0.3 0.2 -0.5\n" +
                  fix + "\nrun 267");
    std::remove(file.c_str());
    EXPECT_LT(bdh_test::largest_difference(fixed, second.unwrapped_positions()), 1e-9) << boundary;
  }
}

// A run continues after a restart as if nothing had happened.
TEST(LammpsOpen, RestartContinues)
{
  const std::string fix = "fix move all bd/fib 1.0 1.0 7 radius 1.2544 fft estimate" + wall_below;
  const std::string file = "test_open_" + std::to_string(getpid()) + ".restart";
  LammpsSession first, second;
  first.script(above_a_wall(9.0, fix + "\nrun 25\nwrite_restart " + file + "\nrun 25"));
  second.script("read_restart " + file +
                "\ncomm_modify cutoff 2.0\nneigh_modify every 1 delay 0 check yes\ntimestep 0.01\n"
                "fix pull all addforce 0.3 0.2 -0.5\n" +
                fix + "\nrun 25");
  std::remove(file.c_str());
  EXPECT_LT(bdh_test::largest_difference(first.unwrapped_positions(), second.unwrapped_positions()),
            1e-12);
}

// The number of rows is that of the present positions, also in a later run.  It is said only with
// the plan, which has not changed.
TEST(LammpsOpen, RowsAreCountedBeforeTheFirstStep)
{
  LammpsSession lmp;
  lmp.script(
      above_a_wall(60.0, "fix move all bd/fib 0.0 1.0 7 radius 1.2544" + wall_below + "\nrun 0"));
  const double low = lmp.fix("move")->memory_usage();
  lmp.script("displace_atoms all move 0 0 20\nrun 0");
  // Three components on 16 more rows of 10 x 8 cells, at least.
  EXPECT_GT(lmp.fix("move")->memory_usage(), low + 16 * 10 * 8 * 3 * sizeof(double));
  EXPECT_EQ(bdh_test::occurrences("  now        16 rows", lmp.log()), 1u);
  lmp.script("fix move all bd/fib 0.0 2.0 7 radius 1.2544 scheme euler" + wall_below + "\nrun 0");
  EXPECT_EQ(bdh_test::occurrences("  now        32 rows", lmp.log()), 1u) << lmp.log();
}

// A torque about an axis turns a sphere over a plate more slowly than far away by 5 T/(128 pi eta
// H^3) along the plate and by T/(64 pi eta H^3) normal to it: half the curl of the images of
// Blake's point torque, without further terms in the size of a sphere whose surface exerts the
// torque.  Swan and Brady, Phys. Fluids 19, 113306 (2007).  It rolls along the plate as a wheel
// does, at 1/8 (a/H)^4 of a omega.  Ten cells higher up the kernel is at the same place in its
// cell, which cancels its spread.  The bounds are what the kernel's shape leaves.
TEST(LammpsOpen, ATorqueTurnsASphereOverAPlate)
{
  const double far = 1.0 / (8.0 * M_PI * 1.3);
  for (double H : {1.6, 2.0, 2.4, 3.0})
    for (size_t axis = 0; axis < 3; ++axis) {
      const Turned low = turned_over_plate(H, axis), high = turned_over_plate(H + 8.0, axis);
      const auto change = [&](double z) { return -(axis == 2 ? 1.0 : 2.5) / (8.0 * z * z * z); };
      const double expected = change(H) - change(H + 8.0);
      EXPECT_NEAR((low.omega - high.omega) / far, expected, 0.1 * std::fabs(expected))
          << H << " " << axis;
      const double rolls = far / (8.0 * H * H * H * H),
                   direction[2] = {axis == 1 ? 1.0 : 0.0, axis == 0 ? -1.0 : 0.0};
      for (size_t d = 0; d < 2; ++d)
        EXPECT_NEAR(low.velocity[d] - high.velocity[d], direction[d] * rolls, 9e-5)
            << H << " " << axis << " " << d;
    }
}

// Torques, the drift near the wall and noise turn particles in the same way in boxes of any height.
TEST(LammpsOpen, RotationDoesNotDependOnTheHeightOfTheBox)
{
  for (const char *scheme : {"midpoint", "improved", "euler", "trapezoidal"}) {
    std::vector<double> x[2], omega[2];
    for (int tall = 0; tall < 2; ++tall) {
      LammpsSession lmp;
      std::string scene = above_a_wall(tall ? 30.0 : 7.3, "");
      scene.replace(scene.find("atom_style atomic"), 17, "atom_style sphere");
      scene.replace(scene.find("mass 1 1.0"), 10, "set group all diameter 2.0");
      lmp.script(scene);
      const bdh_test::GivenTorques given(lmp, {3, -2, 1, 0, 2, -1, 1, 1, 4, -5, 0, 2});
      lmp.script("fix move all bd/fib 1.0 1.0 7 radius 1.2544 fft estimate rotation yes scheme " +
                 std::string(scheme) + wall_below + "\nrun 40");
      x[tall] = lmp.unwrapped_positions();
      omega[tall] = bdh_test::omegas(lmp);
    }
    EXPECT_LT(bdh_test::largest_difference(x[0], x[1]), 1e-11) << scheme;
    EXPECT_LT(bdh_test::largest_difference(omega[0], omega[1]), 1e-10) << scheme;
    EXPECT_GT(std::fabs(omega[0][0]), 1e-3);
  }
}
