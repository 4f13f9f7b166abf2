// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/fib turns particles: torques through the mobility, dipoles and quaternions by omega dt,
// restart, units, groups, messages, and the laws of rotational diffusion.

#include "lammps/lammps_turning.h"

#include "atom_vec_ellipsoid.h"
#include "fib/fluid.h"
#include "fib/host.h"
#include "support/test_support.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

using bdh_test::GivenTorques;
using bdh_test::LammpsSession;
using bdh_test::omegas;
using bdh_test::text;

namespace {

/// Spheres with dipoles, which sets the angular velocity, torque and mu.
std::string dipoles(const std::string &more = "")
{
  return "units lj\natom_style hybrid sphere dipole\natom_modify map array\n"
         "region box block 0 8 0 8 0 8\ncreate_box 1 box\n"
         "create_atoms 1 single 1.3 2.2 3.1\ncreate_atoms 1 single 3.4 2.6 3.3\n"
         "set group all diameter 2.0\nset atom 1 dipole 1 0.5 0\nset atom 2 dipole 0 0.6 0.8\n"
         "pair_style none\ncomm_modify cutoff 2.0\nneigh_modify every 1 delay 0 check yes\n" +
         more;
}

/// Components and length of each dipole, by id.
std::vector<double> dipoles_of(LammpsSession &lmp)
{
  return bdh_test::by_id(lmp, 4, [](const LAMMPS_NS::Atom &a, int i) { return a.mu[i]; });
}

/// True if the KOKKOS package is on and does not have the atom style, as in releases before 2025.
bool lacks(const std::string &style)
{
  LammpsSession lmp;
  return lmp->kokkos && !lmp->atom->avec_map->count(style + "/kk");
}
#define NEEDS_ATOM_STYLE(style)                                                                    \
  if (lacks(style)) GTEST_SKIP() << "the KOKKOS package has no atom_style " << style

/// Angular velocities that torques cause in a fluid of the core.
std::vector<double> expected_omega(const bdh::Grid &g, double viscosity,
                                   const std::vector<double> &x, const std::vector<double> &torque)
{
  bdh::FibFluid<bdh::FibOnHost> fluid(g, bdh::IbKernel::peskin4, bdh::FftEffort::estimate,
                                      bdh_test::self(), bdh::Workers::one(), bdh::Moments::torque);
  fluid.bind(x.data(), x.size() / 3);
  fluid.clear();
  fluid.spread_torque(torque.data());
  bdh::StokesProblem problem;
  problem.viscosity = viscosity;
  fluid.solve(problem);
  std::vector<double> omega(x.size());
  fluid.angular_velocity(omega.data());
  return omega;
}

const std::string fib = "fix move all bd/fib 0.0 1.7 5 grid 8 8 8 fft estimate ";

using Vector = std::array<double, 3>;

Vector vector_of(const std::vector<double> &v, size_t i, size_t width)
{
  return {v[width * i], v[width * i + 1], v[width * i + 2]};
}
double dot(const Vector &a, const Vector &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double distance(const Vector &a, const Vector &b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
double length(const Vector &v) { return distance(v, {0.0, 0.0, 0.0}); }
Vector times(double c, const Vector &v) { return {c * v[0], c * v[1], c * v[2]}; }

/// v turned by the rotation vector r, by Rodrigues' formula.
Vector turned_by(const Vector &r, const Vector &v)
{
  const double angle = length(r), c = std::cos(angle), s = std::sin(angle);
  const Vector n = times(1.0 / angle, r);
  const Vector cross = {n[1] * v[2] - n[2] * v[1], n[2] * v[0] - n[0] * v[2],
                        n[0] * v[1] - n[1] * v[0]};
  Vector u{};
  for (size_t d = 0; d < 3; ++d) u[d] = c * v[d] + s * cross[d] + (1.0 - c) * dot(n, v) * n[d];
  return u;
}

/// The axes of a body with the unit quaternion q.
std::array<Vector, 3> axes_of(const double *q)
{
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  return {{{w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)},
           {2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (y * z + w * x)},
           {2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z}}};
}

}    // namespace

TEST(LammpsRotation, TorquesTurnThroughTheMobility)
{
  NEEDS_ATOM_STYLE("dipole");
  for (const std::string scheme : {"midpoint", "improved", "euler", "trapezoidal"}) {
    LammpsSession lmp;
    lmp.script(dipoles());
    const std::vector<double> torque = {1.0, -2.0, 0.5, 0.3, 0.7, -1.1};
    const GivenTorques given(lmp, torque);
    const std::vector<double> before = dipoles_of(lmp), x = lmp.unwrapped_positions();
    // In a longer step positions would change before the velocity is taken.
    const double dt = 1e-6;
    lmp.script(fib + "scheme " + scheme + "\ntimestep " + text(dt) + "\nrun 1");
    const std::vector<double> omega = omegas(lmp), after = dipoles_of(lmp);
    const std::vector<double> expected =
        expected_omega(bdh_test::make_grid({8, 8, 8}, {1.0}, 0.0), 1.7, x, torque);
    for (size_t i = 0; i < 6; ++i) EXPECT_NEAR(omega[i], expected[i], 1e-6) << scheme;
    for (size_t i = 0; i < 2; ++i) {
      const Vector turned = turned_by(times(dt, vector_of(omega, i, 3)), vector_of(before, i, 4));
      EXPECT_LT(distance(vector_of(after, i, 4), turned), 1e-15) << scheme;
      EXPECT_EQ(after[4 * i + 3], before[4 * i + 3]);
    }
    EXPECT_NE(lmp.log().find("rotation   on: torques turn particles (dipoles and omega)"),
              std::string::npos)
        << lmp.log();
  }
}

// The same for spheres without an orientation, which need the keyword, and for omega over several
// steps with noise: those of the core's own step, whose noise is that of the fix.
TEST(LammpsRotation, SpheresHaveAngularVelocities)
{
  LammpsSession lmp;
  lmp.script("units lj\natom_style sphere\natom_modify map array\n"
             "region box block 0 8 0 8 0 8\ncreate_box 1 box\n"
             "create_atoms 1 single 1.3 2.2 3.1\ncreate_atoms 1 single 3.4 2.6 3.3\n"
             "set group all diameter 2.0\ncomm_modify cutoff 2.0\n"
             "neigh_modify every 1 delay 0 check yes\n");
  const std::vector<double> torque = {1.0, -2.0, 0.5, 0.3, 0.7, -1.1};
  const GivenTorques given(lmp, torque);
  const bdh::Grid g = bdh_test::make_grid({8, 8, 8}, {1.0}, 0.0);
  lmp.script("fix move all bd/fib 0.4 1.7 5 grid 8 8 8 fft estimate scheme euler rotation yes\n"
             "timestep 0.01\n");
  bdh::FibFluid<bdh::FibOnHost> fluid(g, bdh::IbKernel::peskin4, bdh::FftEffort::estimate,
                                      bdh_test::self(), bdh::Workers::one(), bdh::Moments::torque);
  for (int step = 1; step <= 3; ++step) {
    const std::vector<double> x = lmp.unwrapped_positions();
    lmp.command(step > 1 ? "run 1 pre no" : "run 1");
    bdh::StokesProblem problem;
    problem.viscosity = 1.7;
    problem.kT_over_dt = 0.4 / 0.01;
    problem.seed = 5;
    problem.step = step;
    problem.stress.push_back({1.0, 0});
    fluid.bind(x.data(), 2);
    fluid.clear();
    fluid.spread_torque(torque.data());
    fluid.solve(problem);
    std::vector<double> expected(6);
    fluid.angular_velocity(expected.data());
    EXPECT_LT(bdh_test::largest_difference(omegas(lmp), expected), 1e-12) << step;
  }
}

// Steps that turn particles by several radians keep the length, and are the exponential map.
TEST(LammpsRotation, LongRotationsKeepTheLength)
{
  NEEDS_ATOM_STYLE("dipole");
  for (const std::string scheme : {"midpoint", "improved"}) {
    LammpsSession lmp;
    lmp.script(dipoles());
    const GivenTorques given(lmp, {10000.0, -20000.0, 5000.0, 3000.0, 7000.0, -11000.0});
    lmp.script(fib + "scheme " + scheme + "\ntimestep 0.01\n");
    for (int step = 0; step < 20; ++step) {
      const std::vector<double> before = dipoles_of(lmp);
      lmp.command(step ? "run 1 pre no post no" : "run 1 post no");
      const std::vector<double> omega = omegas(lmp), after = dipoles_of(lmp);
      for (size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(length(vector_of(after, i, 4)), before[4 * i + 3], 1e-15);
        const Vector turned =
            turned_by(times(0.01, vector_of(omega, i, 3)), vector_of(before, i, 4));
        EXPECT_LT(distance(vector_of(after, i, 4), turned), 1e-13) << scheme << step;
      }
    }
    EXPECT_GT(0.01 * length(vector_of(omegas(lmp), 0, 3)), 2.0);
  }
}

// Quaternions turn as dipoles do.
TEST(LammpsRotation, QuaternionsTurnLikeDipoles)
{
  NEEDS_ATOM_STYLE("ellipsoid");
  LammpsSession lmp;
  lmp.script("units lj\natom_style ellipsoid\natom_modify map array\n"
             "region box block 0 8 0 8 0 8\ncreate_box 1 box\n"
             "create_atoms 1 single 1.3 2.2 3.1\ncreate_atoms 1 single 3.4 2.6 3.3\n"
             "set group all shape 2 1 1\nset atom 1 quat 1 1 0 40\nset atom 2 quat 0 0 1 -130\n"
             "set group all density 1\ncomm_modify cutoff 2.0\nthermo_style custom step\n");
  const std::vector<double> torque = {1.0, -2.0, 0.5, 0.3, 0.7, -1.1};
  const GivenTorques given(lmp, torque);
  const auto quaternion = [&lmp](int id) {
    auto *bodies = dynamic_cast<LAMMPS_NS::AtomVecEllipsoid *>(lmp->atom->style_match("ellipsoid"));
    return bodies->bonus[lmp->atom->ellipsoid[lmp->atom->map(id)]].quat;
  };
  const std::array<Vector, 3> before[2] = {axes_of(quaternion(1)), axes_of(quaternion(2))};
  const std::vector<double> omega = expected_omega(bdh_test::make_grid({8, 8, 8}, {1.0}, 0.0), 1.7,
                                                   lmp.unwrapped_positions(), torque);
  const double dt = 1e-3;
  lmp.script(fib + "scheme euler\ntimestep " + text(dt) + "\nrun 1");
  for (size_t i = 0; i < 2; ++i) {
    const double *q = quaternion(int(i) + 1);
    EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1.0, 1e-15);
    for (size_t axis = 0; axis < 3; ++axis)
      EXPECT_LT(
          distance(axes_of(q)[axis], turned_by(times(dt, vector_of(omega, i, 3)), before[i][axis])),
          1e-14);
  }
  EXPECT_EQ(lmp.log().find("nothing rotates"), std::string::npos);
}

// A torque of 1 in the units of each style, as force times distance.
TEST(LammpsRotation, UnitsOfTorqueAreThoseOfForceTimesDistance)
{
  // A force F turns a pair about its middle as the torque turns a sphere: omega and v of the same
  // fluid, so omega/T over v/F depends on lengths alone.
  std::vector<double> ratios;
  for (const std::string units : {"lj", "real", "metal", "si", "cgs", "micro", "nano"}) {
    LammpsSession lmp;
    lmp.script("units " + units +
               "\natom_style sphere\natom_modify map array\nregion box block 0 8 0 8 0 8\n"
               "create_box 1 box\ncreate_atoms 1 single 1.3 2.2 3.1\n"
               "set group all diameter 2.0\ncomm_modify cutoff 2.0\nneighbor 0.1 bin\n"
               "timestep 1e-9\nfix f all addforce 2.0 0.0 0.0\n");
    const GivenTorques given(lmp, {0.0, 0.0, 3.0});
    lmp.script("fix move all bd/fib 0.0 1.7 5 grid 8 8 8 scheme euler rotation yes\nrun 1");
    const double v = lmp.velocities()[0], omega = omegas(lmp)[2];
    ratios.push_back(omega / 3.0 / (v / 2.0));
    EXPECT_NEAR(ratios.back() / ratios.front(), 1.0, 1e-12) << units;
  }
}

// Two dimensions: rotation about z only.
TEST(LammpsRotation, InTwoDimensionsParticlesTurnInThePlane)
{
  NEEDS_ATOM_STYLE("dipole");
  LammpsSession lmp;
  lmp.script("units lj\ndimension 2\natom_style hybrid sphere dipole\natom_modify map array\n"
             "region box block 0 8 0 8 -0.5 0.5\ncreate_box 1 box\n"
             "create_atoms 1 single 1.3 2.2 0\ncreate_atoms 1 single 4.4 2.6 0\n"
             "set group all diameter 2.0\nset atom 1 dipole 1 0.5 0.3\nset atom 2 dipole 0 1 0\n"
             "comm_modify cutoff 2.0\nfix flat all enforce2d\n");
  const GivenTorques given(lmp, {1.0, -2.0, 0.5, 0.3, 0.7, -1.1});
  const std::vector<double> before = dipoles_of(lmp);
  lmp.script("fix move all bd/fib 0.5 1.0 5 grid 8 8 1 scheme improved\ntimestep 0.01\nrun 20");
  const std::vector<double> omega = omegas(lmp), after = dipoles_of(lmp);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(omega[3 * i], 0.0);
    EXPECT_EQ(omega[3 * i + 1], 0.0);
    EXPECT_NE(omega[3 * i + 2], 0.0);
    EXPECT_NEAR(after[4 * i + 2], before[4 * i + 2], 1e-14);
    EXPECT_GT(distance(vector_of(after, i, 4), vector_of(before, i, 4)), 1e-4);
  }
}

// Only the atoms of the group turn.
TEST(LammpsRotation, OtherAtomsKeepTheirOrientation)
{
  NEEDS_ATOM_STYLE("dipole");
  LammpsSession lmp;
  lmp.script(dipoles("group one id 1\n"));
  const GivenTorques given(lmp, {1.0, -2.0, 0.5, 0.3, 0.7, -1.1});
  const std::vector<double> before = dipoles_of(lmp);
  lmp.script("fix move one bd/fib 1.0 1.0 5 grid 8 8 8\ntimestep 0.01\nrun 5");
  const std::vector<double> omega = omegas(lmp), after = dipoles_of(lmp);
  for (size_t d = 0; d < 3; ++d) {
    EXPECT_EQ(after[4 + d], before[4 + d]);
    EXPECT_EQ(omega[3 + d], 0.0);
    EXPECT_NE(after[d], before[d]);
  }
}

// A run that goes on from a restart file has the same orientations and omega to the last bit.
TEST(LammpsRotation, RestartIsExact)
{
  NEEDS_ATOM_STYLE("dipole");
  const std::string file = "test_rotation_" + std::to_string(getpid()) + ".restart";
  const std::string move = "fix field all efield 0.5 0.2 1.0\n"
                           "fix move all bd/fib 0.7 1.0 5 grid 8 8 8 scheme improved fft estimate\n"
                           "timestep 0.01\nneigh_modify every 1 delay 0 check yes\n"
                           "comm_modify cutoff 2.0\n";
  LammpsSession lmp, later;
  lmp.script(dipoles("set group all charge 0.0\n" + move + "run 10\nwrite_restart " + file +
                     "\nrun 10\n"));
  later.script("read_restart " + file + "\n" + move + "run 10\n");
  std::remove(file.c_str());
  EXPECT_EQ(dipoles_of(later), dipoles_of(lmp));
  EXPECT_EQ(omegas(later), omegas(lmp));
  EXPECT_EQ(later.unwrapped_positions(), lmp.unwrapped_positions());
  EXPECT_NE(omegas(lmp)[0], 0.0);
}

// Where nothing turns nothing changes: not the trajectory, and not omega.
TEST(LammpsRotation, OffMeansOff)
{
  NEEDS_ATOM_STYLE("dipole");
  const std::string run = "fix move all bd/fib 1.0 1.0 5 grid 8 8 8 ";
  LammpsSession off, plain;
  off.script(dipoles());
  const std::vector<double> before = dipoles_of(off);
  off.script(run + "rotation no\ntimestep 0.01\nrun 10");
  plain.script("units lj\natom_style atomic\natom_modify map array\n"
               "region box block 0 8 0 8 0 8\ncreate_box 1 box\nmass 1 1.0\n"
               "create_atoms 1 single 1.3 2.2 3.1\ncreate_atoms 1 single 3.4 2.6 3.3\n"
               "comm_modify cutoff 2.0\nneigh_modify every 1 delay 0 check yes\n" +
               run + "\ntimestep 0.01\nrun 10");
  EXPECT_EQ(off.unwrapped_positions(), plain.unwrapped_positions());
  EXPECT_EQ(dipoles_of(off), before);
  EXPECT_EQ(omegas(off), std::vector<double>(6, 0.0));
  EXPECT_EQ(plain.log().find("rotation"), std::string::npos);
  EXPECT_EQ(
      bdh_test::occurrences("have dipoles, but nothing rotates them: use rotation yes", off.log()),
      1u)
      << off.log();
}

// Rotation changes no positions: where no torques act, the noise of translation stays what it was.
TEST(LammpsRotation, RotationLeavesTranslationAsItWas)
{
  NEEDS_ATOM_STYLE("dipole");
  std::vector<double> x[2];
  for (int turns : {0, 1}) {
    LammpsSession lmp;
    lmp.script(dipoles("fix move all bd/fib 1.0 1.0 5 grid 8 8 8 rotation " +
                       std::string(turns ? "yes" : "no") + "\ntimestep 0.01\nrun 10"));
    x[turns] = lmp.unwrapped_positions();
  }
  EXPECT_LT(bdh_test::largest_difference(x[0], x[1]), 1e-14);
}

TEST(LammpsRotation, Messages)
{
  NEEDS_ATOM_STYLE("dipole");
  const struct {
    std::string style, keyword, expected;
  } cases[] = {
      {"atomic", "yes", "rotation = yes, but atoms of atom_style atomic have no torque: use"},
      {"dipole", "yes", "rotation = yes, but atoms of atom_style dipole have no torque: use"},
      {"sphere", "maybe", "rotation = maybe, but must be auto, yes or no"},
      {"sphere", "", "rotation = (nothing)"},
      {"sphere", "yes", ""},
      {"dipole", "auto", ""},
  };
  for (const auto &c : cases) {
    LammpsSession lmp;
    const std::string message = lmp.error_of(
        "units lj\natom_style " + c.style + "\nregion box block 0 8 0 8 0 8\ncreate_box 1 box\n" +
        "create_atoms 1 single 1 2 3\n" + (c.style == "sphere" ? "" : "mass 1 1.0\n") +
        "comm_modify cutoff 2.0\nfix move all bd/fib 1.0 1.0 5 grid 8 8 8 rotation " + c.keyword +
        (c.expected.empty() ? "\nrun 1" : ""));
    if (c.expected.empty())
      EXPECT_EQ(message, "") << c.style;
    else
      EXPECT_NE(message.find(c.expected), std::string::npos) << message;
  }
}

// A force field that turns to NaN is reported with the atom.
TEST(LammpsRotation, ATorqueThatIsNoNumberStopsTheRun)
{
  NEEDS_ATOM_STYLE("dipole");
  LammpsSession lmp;
  lmp.script(dipoles());
  const GivenTorques given(lmp, {0.0, 0.0, 0.5, 0.3, NAN, -1.1});
  EXPECT_NE(lmp.error_of(fib + "\ntimestep 0.01\nrun 1")
                .find("atom 2 at step 1: the torque on it is not a finite number"),
            std::string::npos);
}

namespace {

/// 64 dipoles of length 1 on a lattice, which they leave freely.
std::string many_dipoles(const std::string &more)
{
  return "units lj\natom_style hybrid sphere dipole\natom_modify map array\n"
         "region box block 0 12 0 12 0 12\ncreate_box 1 box\n"
         "lattice sc " +
         text(64.0 / 1728.0) +
         "\ncreate_atoms 1 box\n"
         "set group all diameter 2.0\nset group all charge 0.0\n"
         "set group all dipole/random 345 1.0\ncomm_modify cutoff 2.0\n"
         "neigh_modify every 1 delay 0 check yes\nthermo 100000\n" +
         more;
}

}    // namespace

// <mu(t).mu(0)> = exp(-2 D_r t) with D_r = kT mu_r, mu_r the mean of the self-mobility over
// positions: (1/a^3 - 4 pi/(3 V))/(8 pi eta) with the tabulated rotational radius.  Particles turn
// independently but for their hydrodynamic interaction, which is small, and so do windows of time.
TEST(StatisticsRotation, DipolesForgetTheirDirection)
{
  NEEDS_ATOM_STYLE("dipole");
  for (const std::string hydrodynamics : {"yes", "no"}) {
    LammpsSession lmp;
    lmp.script(
        many_dipoles("fix move all bd/fib 1.0 1.0 77 grid 12 12 12 fft estimate hydrodynamics " +
                     hydrodynamics + "\ntimestep 0.2\nrun 0\n"));
    const size_t atoms = lmp->atom->natoms;
    const double a = 1.2407, V = hydrodynamics == "yes" ? 1728.0 : HUGE_VAL;
    const double D = (1.0 / (a * a * a) - 4.0 * M_PI / 3.0 / V) / (8.0 * M_PI);
    const int lag = 60, windows = 60;    // 2 D_r t = 0.5 after a window
    bdh_test::Mean mean;
    for (int w = 0; w < windows; ++w) {
      const std::vector<double> before = dipoles_of(lmp);
      lmp.command("run " + std::to_string(lag) + " pre no post no");
      const std::vector<double> after = dipoles_of(lmp);
      for (size_t i = 0; i < atoms; ++i)
        mean.add(dot(vector_of(before, i, 4), vector_of(after, i, 4)));
    }
    EXPECT_LT(std::fabs(mean.z(std::exp(-2.0 * D * lag * 0.2))), 3.5)
        << mean.mean << " " << std::exp(-2.0 * D * lag * 0.2) << " " << mean.error();
    EXPECT_LT(mean.error(), 0.012);
  }
}

// Dipoles in a field: <cos theta> is Langevin's function, whatever the step.
TEST(StatisticsRotation, DipolesInAFieldObeyLangevin)
{
  NEEDS_ATOM_STYLE("dipole");
  for (const std::string scheme : {"midpoint", "improved"}) {
    LammpsSession lmp;
    lmp.script(many_dipoles("fix field all efield 0.0 0.0 2.0\n"
                            "fix move all bd/fib 1.0 1.0 77 grid 12 12 12 fft estimate scheme " +
                            scheme + "\ntimestep 0.3\nrun 500\n"));
    const size_t atoms = lmp->atom->natoms;
    // The direction is forgotten after less than 1/(2 D_r) = 24; batches of 5 samples last 30.
    bdh_test::Mean mean;
    for (int batch = 0; batch < 40; ++batch) {
      double sum = 0.0;
      for (int sample = 0; sample < 5; ++sample) {
        lmp.command("run 20 pre no post no");
        const std::vector<double> mu = dipoles_of(lmp);
        for (size_t i = 0; i < atoms; ++i) sum += mu[4 * i + 2] / double(5 * atoms);
      }
      mean.add(sum);
    }
    const double expected = 1.0 / std::tanh(2.0) - 0.5;
    // The schemes' error is of first order: 1 % of the mean at this step, a fraction of the error.
    EXPECT_LT(std::fabs(mean.z(expected)), 3.5) << scheme << mean.mean << " " << mean.error();
    EXPECT_LT(mean.error(), 0.02);
  }
}
