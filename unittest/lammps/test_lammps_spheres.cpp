// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/pse with spheres of different radii that turn: velocities and angular velocities by the
// dense oracle, orientations, and what may change during a run.

#include "lammps/lammps_spheres.h"
#include "lammps/wrong_input.h"
#include "support/test_support.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace bdh_test;

namespace {

using Vector = std::vector<double>;
const std::string start = "fix move all bd/pse 0.0 0.9 4711 radius atom fft estimate ";

/// The error of one step at T = 0, over the tolerance: of velocities and of angular velocities.
std::array<double, 2> errors_of_step(LammpsSession &lmp, const std::string &fix, double tolerance)
{
  lmp.script(std::string(field_command) + fix);
  const GivenForces force(lmp, random_vector(60, 3));
  lmp.command("run 0");
  const Vector exact = exact_motions(lmp, 0.9, force(), field_torques(dipoles(lmp)));
  lmp.command("run 1");
  return {part_error(lmp.velocities(), exact, 0) / tolerance,
          part_error(omegas(lmp), exact, 60) / tolerance};
}

/// The vector m after it has turned with angular velocity w for some time, by Rodrigues' formula.
Vector rotated(const double *m, const double *w, double time)
{
  const double speed = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]), angle = time * speed;
  const double along = (w[0] * m[0] + w[1] * m[1] + w[2] * m[2]) / (speed * speed);
  Vector turned;
  for (std::size_t d = 0; d < 3; ++d) {
    const std::size_t e = (d + 1) % 3, f = (d + 2) % 3;
    const double cross = (w[e] * m[f] - w[f] * m[e]) / speed;
    turned.push_back(m[d] * std::cos(angle) + cross * std::sin(angle) +
                     along * w[d] * (1.0 - std::cos(angle)));
  }
  return turned;
}

}    // namespace

// Dipoles turn without being asked to.
TEST(LammpsSpheres, MotionsAreThoseOfTheOracle)
{
  for (double tolerance : {1e-2, 1e-3, 1e-6}) {
    LammpsSession lmp;
    lmp.script(dipole_spheres);
    const auto error = errors_of_step(lmp, start + "tolerance " + text(tolerance), tolerance);
    EXPECT_LE(error[0], 1.0) << tolerance;
    EXPECT_LE(error[1], 1.0) << tolerance;
  }
}

TEST(LammpsSpheres, OneSubstepOfSchemeSplitMovesAlike)
{
  LammpsSession lmp;
  lmp.script(dipole_spheres);
  lmp.command("timestep 1e-9");    // forces within the step are those at its beginning
  const auto error = errors_of_step(lmp, start + "tolerance 1e-5 scheme split substeps 1", 1e-5);
  EXPECT_LE(error[0], 1.0);
  EXPECT_LE(error[1], 1.0);
}

// A tighter solve checks the tolerance and prints both kinds of motion.
TEST(LammpsSpheres, KeywordCheck)
{
  LammpsSession lmp;
  lmp.script(dipole_spheres);
  lmp.script(std::string(field_command) +
             "fix move all bd/pse 1.0 0.9 4711 radius atom check yes\nrun 0");
  const std::string log = lmp.log();
  EXPECT_NE(log.find("error   angular velocities:"), std::string::npos);
  EXPECT_EQ(log.find("above the tolerance"), std::string::npos);
  EXPECT_NE(log.find("radius       0.25 to 1 (of the atoms)"), std::string::npos);
  EXPECT_NE(log.find("rotation     on"), std::string::npos);
}

// Keyword parts gives displacements and rotations by forces and by noise.
TEST(LammpsSpheres, PartsAddUp)
{
  LammpsSession lmp;
  lmp.script(dipole_spheres);
  lmp.script(std::string(field_command) +
             "fix move all bd/pse 1.0 0.9 4711 radius atom parts yes\nrun 3");
  const Vector parts = lmp.per_atom("move", 12), v = lmp.velocities(), omega = omegas(lmp);
  for (std::size_t i = 0; i < 20; ++i)
    for (std::size_t d = 0; d < 3; ++d) {
      const double *p = &parts[12 * i + d];
      EXPECT_NEAR(p[0] + p[3], 1e-4 * v[3 * i + d], 1e-12);
      EXPECT_NEAR(p[6] + p[9], 1e-4 * omega[3 * i + d], 1e-12);
      EXPECT_NE(p[6], 0.0);
    }
}

// Dipoles turn by omega dt about omega, and keep their lengths.
TEST(LammpsSpheres, DipolesTurnByOmega)
{
  LammpsSession lmp;
  lmp.script(dipole_spheres);
  lmp.script(std::string(field_command) + start + "\ntimestep 0.5\nthermo 1\nrun 0");
  const Vector before = dipoles(lmp);
  lmp.command("run 1");
  const Vector after = dipoles(lmp), omega = omegas(lmp);
  for (std::size_t i = 0; i < 60; i += 3) {
    const Vector turned = rotated(&before[i], &omega[i], 0.5);
    for (std::size_t d = 0; d < 3; ++d) EXPECT_NEAR(after[i + d], turned[d], 1e-12);
  }
}

// The lattice vector along z leans along y, so that u_x = 0.3 (y - 1.5/5 z): half the curl is
// (0, -0.045, -0.15).
TEST(LammpsSpheres, TurnWithTheFlow)
{
  for (const char *more : {"", " scheme split substeps 2"}) {
    LammpsSession lmp;
    lmp.script(dipole_spheres);
    lmp.script(start + more + "\nfix flow all deform 1 xy erate 0.3 remap x\nrun 0");
    const Vector before = dipoles(lmp);
    lmp.command("run 50");
    const Vector after = dipoles(lmp), omega = omegas(lmp);
    const double w[3] = {0.0, -0.045, -0.15};
    for (std::size_t i = 0; i < 60; i += 3) {
      const Vector turned = rotated(&before[i], w, 50 * 1e-4);
      for (std::size_t d = 0; d < 3; ++d) {
        EXPECT_NEAR(omega[i + d], w[d], 1e-9);
        EXPECT_NEAR(after[i + d], turned[d], 1e-9);
      }
    }
  }
}

// rotation no leaves dipoles as they are, with a warning that names the remedy.
TEST(LammpsSpheres, RotationNo)
{
  LammpsSession lmp;
  lmp.script(dipole_spheres);
  lmp.script(std::string(field_command) + start + "rotation no\nrun 0");
  const Vector before = dipoles(lmp);
  lmp.command("run 2");
  EXPECT_EQ(dipoles(lmp), before);
  EXPECT_NE(lmp.log().find("rotation yes"), std::string::npos);
}

// Radii may change during a run: the next velocities are those of the new ones.
TEST(LammpsSpheres, RadiiThatChange)
{
  LammpsSession lmp;
  lmp.script(dipole_spheres);
  lmp.script(std::string(field_command) + start + "tolerance 1e-4");
  const GivenForces force(lmp, random_vector(60, 3));
  lmp.script("run 3\nset atom 3 diameter 1.4\nset atom 16 diameter 0.45\nrun 0");
  const Vector exact = exact_motions(lmp, 0.9, force(), field_torques(dipoles(lmp)));
  lmp.command("run 1");
  EXPECT_LE(part_error(lmp.velocities(), exact, 0), 1e-4);
  EXPECT_LE(part_error(omegas(lmp), exact, 60), 1e-4);
}

// Spheres that do not interact: U = F/(6 pi eta a), W = T/(8 pi eta a^3).
TEST(LammpsSpheres, WithoutHydrodynamics)
{
  const double pi = 3.14159265358979323846;
  LammpsSession lmp;
  lmp.script(dipole_spheres);
  lmp.script(std::string(field_command) + start + "hydrodynamics no");
  const GivenForces force(lmp, random_vector(60, 3));
  lmp.command("run 0");
  const Vector torque = field_torques(dipoles(lmp)), a = radii(lmp);
  lmp.command("run 1");
  const Vector v = lmp.velocities(), omega = omegas(lmp);
  for (std::size_t k = 0; k < 60; ++k) {
    const double r = a[k / 3];
    EXPECT_NEAR(v[k], force()[k] / (6.0 * pi * 0.9 * r), 1e-12);
    EXPECT_NEAR(omega[k], torque[k] / (8.0 * pi * 0.9 * r * r * r), 1e-10);
  }
}

// Real units: torques are converted like forces.
TEST(LammpsSpheres, RealUnits)
{
  const double pi = 3.14159265358979323846;
  LammpsSession lmp;
  lmp.script(R"(
units real
atom_style hybrid sphere dipole
region box block 0 2000 0 2000 0 2000
create_box 1 box
create_atoms 1 single 500 500 500
set group all diameter 20.0 dipole 1 0 0
pair_style zero 5.0
pair_coeff * *
fix turn all efield 0.0 0.1 0.0
fix move all bd/pse 0.0 0.9 4711 radius atom hydrodynamics no
timestep 1.0
run 1
)");
  // kcal/mol over (poise Angstrom^3) is 4184/6.02214076e23 J/(0.1 Pa s 1e-30 m^3), times 1e-15 s.
  const double unit = 4184.0 / 6.02214076e23 / 1e-31 * 1e-15;
  const double torque = 0.1 * 23.060549;    // e V in kcal/mol
  EXPECT_NEAR(omegas(lmp)[2] / (torque * unit / (8.0 * pi * 0.9 * 1000.0)), 1.0, 1e-5);
}

TEST(LammpsSpheres, WrongInput)
{
  const WrongInput cases[] = {
      {"set atom 4 diameter 0.0\nfix 1 all bd/pse 1.0 1.0 5 radius atom\nrun 0",
       "fix bd/pse: atom 4 has radius 0 at step 0, but must be > 0 and finite"},
      {"fix 1 all bd/pse 1.0 1.0 5 radius atom xi 2.0\nrun 0", "at most 1.1/(greatest radius)"},
      {"fix 1 all bd/pse 1.0 1.0 5 radius atom rotation maybe", "rotation = maybe, but must be"},
  };
  for (const auto &c : cases) expect_message(c, dipole_spheres);
  expect_message({"fix 1 all bd/pse 1.0 1.0 5 radius 1 rotation yes",
                  "rotation = yes, but atoms of atom_style atomic have no torque"});
}

// The dipole of a free sphere loses its direction as exp(-2 D_r t), D_r = kT/(8 pi eta a^3) with
// the share 1 - phi of the periodic images.  400 independent spheres: their mean has a standard
// error of 0.58/20 at most; 4 of them, and a rotation with sqrt(2) or 1/sqrt(2) of the noise would
// miss by 7.
TEST(StatisticsLammpsSpheres, DipolesForgetTheirDirection)
{
  const double pi = 3.14159265358979323846;
  LammpsSession lmp;
  lmp.script(R"(
units lj
atom_style hybrid sphere dipole
atom_modify map array
region box block 0 40 0 40 0 40
create_box 1 box
create_atoms 1 random 400 77 NULL
set group all dipole/random 31 1.0
set group all diameter 1.6
set atom 1*200 diameter 1.0
pair_style zero 0.5
pair_coeff * *
neigh_modify every 1 delay 0 check yes
timestep 0.02
fix move all bd/pse 1.0 0.2 4711 radius atom tolerance 1e-2
run 0
)");
  const Vector before = dipoles(lmp), a = radii(lmp);
  lmp.command("run 40");
  const Vector after = dipoles(lmp);
  for (int small : {0, 1}) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 1200; ++k)
      if ((k / 3 < 200) == (small == 1)) sum += before[k] * after[k];
    const double r = small ? 0.5 : 0.8, D = 1.0 / (8.0 * pi * 0.2 * r * r * r);
    EXPECT_NEAR(sum / 200, std::exp(-2.0 * D * 0.8), 4.0 * 0.58 / std::sqrt(200.0)) << r;
  }
}

// In a field the mean of cos(theta) is Langevin's coth x - 1/x at x = mu E/kT, here 2.  200 spheres
// over 60 correlation times; the standard error is below 0.006.
TEST(StatisticsLammpsSpheres, LangevinFunction)
{
  LammpsSession lmp;
  lmp.script(R"(
units lj
atom_style hybrid sphere dipole
atom_modify map array
region box block 0 16 0 16 0 16
create_box 1 box
create_atoms 1 random 200 77 NULL
set group all dipole/random 31 1.0
set atom 1*100 diameter 2.0
set atom 101*200 diameter 1.2
pair_style zero 0.5
pair_coeff * *
neigh_modify every 1 delay 0 check yes
timestep 0.02
fix field all efield 0 0 2.0
fix move all bd/pse 1.0 0.2 4711 radius atom tolerance 1e-2
run 100
)");
  double sum = 0.0;
  const int samples = 30;
  for (int s = 0; s < samples; ++s) {
    lmp.command("run 20");
    const Vector mu = dipoles(lmp);
    for (std::size_t k = 2; k < mu.size(); k += 3) sum += mu[k] / (200.0 * samples);
  }
  EXPECT_NEAR(sum, 1.0 / std::tanh(2.0) - 0.5, 0.025);
}

namespace {

/// Two dipoles of length 4 on spheres of radius 1, which a spring of stiffness 0.2 holds together.
struct TwoDipoles {
  double together, along;    ///< n1.n2; (n1.e)(n2.e), with e between the centers
  double distance;
};

/// Energy over kT, by the formulas of LAMMPS' manual for lj/sf/dipole/sf with cutoffs 2^(7/6)
/// and 6.
double energy_of(const TwoDipoles &p)
{
  const double r = p.distance, s6 = std::pow(2.0 / r, 6), x = r / 6.0;
  const double core = r < 2.0 * std::pow(2.0, 1.0 / 6.0) ? 4.0 * (s6 * s6 - s6) + 1.0 : 0.0;
  const double cut = r < 6.0 ? 1.0 - 4.0 * std::pow(x, 3) + 3.0 * std::pow(x, 4) : 0.0;
  return core + cut * 16.0 / std::pow(r, 3) * (p.together - 3.0 * p.along) + 0.1 * r * r;
}

/// Boltzmann's means, by Monte Carlo with weights.
TwoDipoles boltzmann_means()
{
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> cosine(-1.0, 1.0), angle(0.0, 6.283185307179586),
      distance(1.5, 9.0);
  TwoDipoles sum{};
  double all = 0.0;
  for (int k = 0; k < 2000000; ++k) {
    const double c = cosine(engine), d = cosine(engine), r = distance(engine),
                 turn = std::cos(angle(engine));
    const TwoDipoles p{c * d + std::sqrt((1.0 - c * c) * (1.0 - d * d)) * turn, c * d, r};
    const double weight = r * r * std::exp(-energy_of(p));
    all += weight;
    sum.together += weight * p.together;
    sum.along += weight * p.along;
    sum.distance += weight * p.distance;
  }
  return {sum.together / all, sum.along / all, sum.distance / all};
}

/// 64 such pairs, far from each other: atoms k and k + 64.  Springs to a common point are one
/// between both of half their stiffness, and one for their center.
std::string pairs_of_dipoles()
{
  std::string text = "units lj\natom_style hybrid sphere dipole\natom_modify map array\n"
                     "region box block 0 56 0 56 0 56\ncreate_box 1 box\n";
  for (int copy = 0; copy < 2; ++copy)
    for (int k = 0; k < 64; ++k)
      text += "create_atoms 1 single " + bdh_test::text(7.0 + 14.0 * (k % 4)) + " " +
              bdh_test::text(7.0 + 14.0 * (k / 4 % 4)) + " " +
              bdh_test::text(7.0 + 14.0 * (k / 16)) + "\n";
  return text + R"(
set group all diameter 2.0
set group all dipole/random 31 4.0
pair_style lj/sf/dipole/sf 2.244924096618746 6.0
pair_coeff 1 1 1.0 2.0
fix together all spring/self 0.4
group second id > 64
displace_atoms second move 1.6 1.6 0.8
neighbor 1.0 bin
neigh_modify every 1 delay 0 check yes
timestep 0.02
)";
}

}    // namespace

// Two dipoles with hydrodynamic interactions have the angles and distances of Boltzmann.  Errors
// from 64 independent pairs: z > 4.5 has probability 3e-5 for each of three means.
TEST(StatisticsLammpsSpheres, AnglesOfTwoDipoles)
{
  const TwoDipoles exact = boltzmann_means();
  LammpsSession lmp;
  lmp.script(pairs_of_dipoles() +
             "fix move all bd/pse 1.0 0.2 4711 radius atom tolerance 1e-2 scheme split substeps 2\n"
             "thermo 100000\nrun 1500");
  const int samples = 150;
  std::vector<TwoDipoles> mean(64, TwoDipoles{});
  for (int s = 0; s < samples; ++s) {
    lmp.command("run 20 pre no post no");
    const Vector x = lmp.unwrapped_positions(), mu = dipoles(lmp);
    for (std::size_t k = 0; k < 64; ++k) {
      double r2 = 0.0, dot = 0.0, one = 0.0, two = 0.0;
      for (std::size_t c = 3 * k; c < 3 * k + 3; ++c) {
        const double d = x[c + 192] - x[c];
        r2 += d * d;
        dot += mu[c] * mu[c + 192] / 16.0;
        one += mu[c] * d / 4.0;
        two += mu[c + 192] * d / 4.0;
      }
      mean[k].together += dot / samples;
      mean[k].along += one * two / r2 / samples;
      mean[k].distance += std::sqrt(r2) / samples;
    }
  }
  bdh_test::Mean together, along, distance;
  for (const TwoDipoles &p : mean) {
    together.add(p.together);
    along.add(p.along);
    distance.add(p.distance);
  }
  EXPECT_LT(std::fabs(together.z(exact.together)), 4.5) << together.mean << " " << exact.together;
  EXPECT_LT(std::fabs(along.z(exact.along)), 4.5) << along.mean << " " << exact.along;
  EXPECT_LT(std::fabs(distance.z(exact.distance)), 4.5) << distance.mean << " " << exact.distance;
  // A temperature of rotation that is wrong by a fifth would show.
  EXPECT_LT(along.error(), 0.02);
}
