// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Steps in pieces (keyword adapt): Brownian paths, velocities, errors, and what is chosen.

#include "lammps/lammps_stiffness.h"
#include "lammps/wrong_input.h"

#include "base/rotation_kernel.h"

using bdh_test::LammpsSession;

namespace {

const std::string box = R"(
atom_modify map array sort 1 5.0
boundary p p p
region box block 0 20 0 20 0 20
create_box 1 box
)";

/// Without forces, of radius 1.
const std::string spheres = R"(
set group all diameter 2.0
set group all density 1.0
pair_style zero 4.0
pair_coeff * *
neighbor 0.5 bin
neigh_modify every 1 delay 0 check yes
timestep 1.5
)";

const std::string free_particles = R"(
units lj
atom_style sphere)" + box + R"(
create_atoms 1 random 40 5 NULL)" + spheres +
                                   R"(
thermo_style custom step
)";

/// With a step that is too long for the forces as a whole.
const std::string suspension = bdh_test::wca_suspension + std::string("timestep 0.1\n");

/// Layers at x = 2.5, 7.5 ..., and a wall beside one of them whose force grows by a factor of e
/// within 0.001 radii, and exceeds all numbers within 0.7.
const std::string layers_beside_a_wall = box + R"(
lattice sc 0.008 origin 0.5 0.5 0.5
create_atoms 1 box)" + spheres + R"(
variable f atom (x>=10.0)-exp(1e3*(x-7.7)*(x<10.0))
fix wall all addforce v_f 0.0 0.0
)";

struct End {
  std::vector<double> x, v;
  double pieces = 0.0;
};
End after(const std::string &scene, const std::string &fix, int steps = 1)
{
  LammpsSession lmp;
  lmp.script(scene);
  lmp.script(fix);
  lmp.command("run " + std::to_string(steps));
  LAMMPS_NS::Fix &f = *lmp.fix("1");
  return {lmp.unwrapped_positions(), lmp.velocities(), f.compute_vector(f.size_vector - 2)};
}

}    // namespace

// The halves of a path add up to the whole: without forces a step in pieces ends where a step ends.
// Each of some 30 pieces adds a rounding of positions of 20.
TEST(Adapt, TakesTheSamePathInPieces)
{
  for (const char *fix : {"bd/pse 1.0 1.0 77 radius 1.0", "bd/fib 1.0 1.0 77 grid 24 24 24",
                          "bd/fib 1.0 1.0 77 grid 24 24 24 scheme trapezoidal",
                          "bd/fib 1.0 1.0 77 grid 24 24 24 scheme improved"}) {
    const std::string words = "fix 1 all " + std::string(fix) + " fft estimate hydrodynamics no ";
    const End whole = after(free_particles, words, 3);
    const End pieces = after(free_particles, words + "adapt 0.02", 3);
    EXPECT_EQ(whole.pieces, 1.0) << fix;
    EXPECT_GE(pieces.pieces, 8.0) << fix;
    EXPECT_LT(bdh_test::largest_difference(whole.x, pieces.x), 1e-12) << fix;
    EXPECT_LT(bdh_test::largest_difference(whole.v, pieces.v), 1e-12) << fix;
  }
}

// With hydrodynamic interactions, too, the noise of a short step is nearly that of its pieces.
TEST(Adapt, TakesNearlyTheSamePathWithHydrodynamicInteractions)
{
  for (const char *fix : {"bd/pse 1.0 1.0 77 radius 1.0 fft estimate xi 0.5 tolerance 1e-4 ",
                          "bd/fib 1.0 1.0 77 grid 24 24 24 fft estimate "}) {
    const std::string words = "timestep 0.18\nfix 1 all " + std::string(fix);
    const End start = after(free_particles, "fix 1 all bd/pse 0 1 7 radius 1 hydrodynamics no");
    const End whole = after(free_particles, words);
    const End pieces = after(free_particles, words + "adapt 0.02");
    EXPECT_EQ(pieces.pieces, 2.0) << fix;
    double change = 0.0, moved = 0.0;
    for (size_t k = 0; k < start.x.size(); ++k) {
      change += std::pow(pieces.x[k] - whole.x[k], 2);
      moved += std::pow(whole.x[k] - start.x[k], 2);
    }
    // Mobilities change by a few per cent over a displacement of 0.1 radii; unrelated noise would
    // give 1.4.
    EXPECT_LT(std::sqrt(change / moved), 0.1) << fix;
    EXPECT_GT(change, 0.0) << fix;
  }
}

// v and omega hold what the whole step has done.
TEST(Adapt, VelocitiesAreThoseOfTheWholeStep)
{
  for (const char *fix : {"bd/pse 1.0 1.0 77 radius 1.0", "bd/fib 1.0 1.0 77 radius 1.0"}) {
    LammpsSession lmp;
    lmp.script(suspension);
    lmp.script("fix 1 all " + std::string(fix) + " fft estimate adapt 0.02\nrun 5");
    std::vector<double> x = lmp.unwrapped_positions();
    lmp.command("run 1");
    const std::vector<double> now = lmp.unwrapped_positions(), v = lmp.velocities();
    for (size_t k = 0; k < x.size(); ++k) x[k] += 0.1 * v[k];
    EXPECT_GT(lmp.fix("1")->compute_vector(lmp.fix("1")->size_vector - 2), 1.0) << fix;
    EXPECT_LT(bdh_test::largest_difference(x, now), 1e-12) << fix;
  }
}

TEST(Adapt, OmegaIsTheRotationOfTheWholeStep)
{
  if (std::getenv("BDH_TEST_LAMMPS_OPTIONS")) GTEST_SKIP() << "hybrid sphere dipole has no /kk";
  std::string scene = suspension;
  scene.replace(scene.find("atom_style sphere"), 17, "atom_style hybrid sphere dipole");
  LammpsSession lmp;
  lmp.script(scene);
  lmp.script("set group all dipole 1.0 0.0 0.0\ntimestep 0.5\n"
             "fix 1 all bd/pse 1.0 1.0 77 radius 1.0 fft estimate adapt 0.02\nrun 1");
  EXPECT_GT(lmp.fix("1")->compute_vector(lmp.fix("1")->size_vector - 2), 1.0);
  const LAMMPS_NS::Atom &atom = lmp.host_atoms();
  for (int i = 0; i < atom.nlocal; ++i) {
    double turn[3], mu[3] = {1.0, 0.0, 0.0};
    for (int d = 0; d < 3; ++d) turn[d] = 0.5 * atom.omega[i][d];
    bdh::turn_vector(bdh::Turn::by(turn), 1.0, mu);
    for (int d = 0; d < 3; ++d) EXPECT_NEAR(atom.mu[i][d], mu[d], 1e-12);
  }
}

// Within a steep wall no piece could follow the forces.
TEST(Adapt, APieceThatLeadsToSuchForcesIsTakenBack)
{
  for (const char *style : {"sphere", "hybrid sphere dipole"}) {
    const bool turns = std::string(style) != "sphere";
    if (turns && std::getenv("BDH_TEST_LAMMPS_OPTIONS")) continue;    // has no /kk
    for (const char *fix : {"bd/pse 1.0 1.0 77 radius 1.0", "bd/fib 1.0 1.0 77 radius 1.0"}) {
      LammpsSession lmp;
      lmp.command("units lj");
      lmp.command("atom_style " + std::string(style));
      lmp.script(layers_beside_a_wall);
      if (turns) lmp.command("set group all dipole 1.0 0.0 0.0");
      lmp.command("fix 1 all " + std::string(fix) + " fft estimate hydrodynamics no adapt 0.02");
      const std::vector<double> before = lmp.unwrapped_positions();
      lmp.command("run 1");
      EXPECT_NE(lmp.log().find("pieces were halved again"), std::string::npos) << fix;
      const LAMMPS_NS::Atom &atom = lmp.host_atoms();
      const std::vector<double> after = lmp.unwrapped_positions(), v = lmp.velocities();
      // Each of some 10^4 pieces rounds a position.
      for (size_t k = 0; k < after.size(); ++k)
        EXPECT_NEAR(before[k] + 1.5 * v[k], after[k], 1e-11);
      for (int i = 0; i < atom.nlocal; ++i) {
        EXPECT_FALSE(atom.x[i][0] > 7.73 && atom.x[i][0] < 10.0) << fix;
        if (!turns) continue;
        double turn[3], mu[3] = {1.0, 0.0, 0.0};
        for (int d = 0; d < 3; ++d) turn[d] = 1.5 * atom.omega[i][d];
        bdh::turn_vector(bdh::Turn::by(turn), 1.0, mu);
        for (int d = 0; d < 3; ++d) EXPECT_NEAR(atom.mu[i][d], mu[d], 1e-11) << fix;
      }
    }
  }
}

// A tighter tolerance needs more pieces, and the change of forces follows it.
TEST(Adapt, KeepsTheChangeOfForcesSmall)
{
  double pieces[2];
  int k = 0;
  for (const char *tolerance : {"0.04", "0.01"}) {
    LammpsSession lmp;
    lmp.script(suspension);
    lmp.script("fix 1 all bd/pse 1.0 1.0 77 radius 1.0 hydrodynamics no adapt " +
               std::string(tolerance) + "\nrun 200");
    const std::string log = lmp.log();
    const size_t at = log.find("adapt: ");
    ASSERT_NE(at, std::string::npos);
    double largest = 0.0;
    ASSERT_EQ(std::sscanf(log.c_str() + at,
                          "adapt: %lf pieces a step on average; the change of forces within a "
                          "piece moves a particle by %lf radii at most",
                          &pieces[k], &largest),
              2);
    // The largest of all particles and steps; it is predicted from earlier ones.
    EXPECT_LT(largest, 4.0 * std::stod(tolerance));
    EXPECT_GT(largest, 0.5 * std::stod(tolerance));
    ++k;
  }
  EXPECT_GT(pieces[1], 1.5 * pieces[0]);
  EXPECT_LT(pieces[1], 6.0 * pieces[0]);
}

/// <(r - bond)^2> of harmonic bonds over its exact value, minus 1; and its standard error.
struct Excess {
  double mean = 0.0, error = 0.0;
};
static Excess excess_after(const std::string &keywords, double p, double pieces)
{
  bdh_test::HarmonicPairs scene;
  LammpsSession lmp;
  lmp.script(scene.scene());
  lmp.script("fix 1 all bd/pse 1.0 1.0 77 radius 1.0 hydrodynamics no " + keywords + "\ntimestep " +
             bdh_test::text(scene.step_for(p)) + "\nrun 10");
  double sum = 0.0;
  const int samples = 100;
  for (int s = 0; s < samples; ++s) {
    lmp.command("run 1 pre no post no");
    EXPECT_GE(lmp.fix("1")->compute_vector(lmp.fix("1")->size_vector - 2), pieces);
    const std::vector<double> x = lmp.unwrapped_positions();
    for (int i = 0; i < scene.pairs; ++i) {
      double r2 = 0.0;
      for (int d = 0; d < 3; ++d) r2 += std::pow(x[6 * i + 3 + d] - x[6 * i + d], 2);
      sum += std::pow(std::sqrt(r2) - scene.bond, 2);
    }
  }
  const int n = samples * scene.pairs;
  return {sum / n * scene.stiffness - 1.0, std::sqrt(2.0 / n)};
}

// Harmonic bonds in one step that is unstable as a whole (p = 4), and whose pieces keep their
// distances: the excess is that of pieces with p = 0.1 or less.
TEST(Adapt, KeepsHarmonicBondsStable)
{
  const Excess excess = excess_after("adapt 0.01", 4.0, 4.0);
  EXPECT_NEAR(excess.mean, 0.03, 0.03 + 5.0 * excess.error);
}

// Near steps with the mean of two noises give a harmonic bond its exact variance, whatever their
// lengths are: here from p = 0.25 to 1, in a far step of p = 4.
TEST(Substeps, ThatAreChosenGiveBondsTheirExactVariance)
{
  const Excess excess = excess_after("scheme split substeps auto adapt 0.1", 4.0, 4.0);
  EXPECT_NEAR(excess.mean, 0.0, 5.0 * excess.error);
}

// So do whole split steps as pieces, with the noise of the last near step in the next piece.
TEST(Adapt, GivesBondsTheirExactVarianceInSplitSteps)
{
  const Excess excess = excess_after("scheme split substeps 1 adapt 0.1", 4.0, 4.0);
  EXPECT_NEAR(excess.mean, 0.0, 5.0 * excess.error);
}

// The noise of chosen near steps adds up to that of one near step, but for the halves at both ends
// of the run: without forces the two paths stay together.
TEST(Substeps, ThatAreChosenTakeTheSamePath)
{
  const std::string words = "fix 1 all bd/pse 1.0 1.0 77 radius 1.0 hydrodynamics no scheme split ";
  const int steps = 60;
  const End start = after(free_particles, words + "substeps 1", 0);
  const End one = after(free_particles, words + "substeps 1", steps);
  const End chosen = after(free_particles, words + "substeps auto adapt 0.1", steps);
  EXPECT_GE(chosen.pieces, 16.0);
  double apart = 0.0, moved = 0.0;
  for (size_t k = 0; k < start.x.size(); ++k) {
    apart += std::pow(chosen.x[k] - one.x[k], 2);
    moved += std::pow(one.x[k] - start.x[k], 2);
  }
  // Each end contributes half a step's noise or less: 0.5/60 of the square at most.  Other noise
  // would give 2.
  EXPECT_LT(apart / moved, 0.02);
  EXPECT_GT(apart, 0.0);
}

// Positions at random: particles overlap by far, and forces are those of r = 0.1 sigma.
TEST(Adapt, TakesApartParticlesThatOverlap)
{
  std::string scene = suspension;
  scene += "create_atoms 1 single 2.0 2.0 2.0 units box\n"
           "create_atoms 1 single 2.1 2.1 2.1 units box\n"
           "set group all diameter 2.0\nset group all density 1.0\n";
  for (const char *fix : {"bd/pse 1.0 1.0 77 radius 1.0", "bd/fib 1.0 1.0 77 radius 1.0"}) {
    LammpsSession lmp;
    lmp.script(scene);
    EXPECT_EQ(lmp.error_of("fix 1 all " + std::string(fix) + " fft estimate adapt 0.02\nrun 3"), "")
        << fix;
    const double contact = std::pow(2.0, 1.0 / 6.0) * 2.0;
    const std::vector<double> x = lmp.unwrapped_positions();
    const size_t last = x.size() - 6;
    double r2 = 0.0;
    for (int d = 0; d < 3; ++d) r2 += std::pow(x[last + 3 + d] - x[last + d], 2);
    EXPECT_GT(std::sqrt(r2), 0.8 * contact) << fix;
  }
}

// In double precision: a restart changes the order of neighbors, which single precision sees.
TEST(Adapt, GoesOnAfterARestartAsIfNothingHadHappened)
{
  for (const char *fix : {"bd/pse 1.0 1.0 77 radius 1.0", "bd/fib 1.0 1.0 77 radius 1.0",
                          "bd/pse 1.0 1.0 77 radius 1.0 scheme split substeps 2",
                          "bd/pse 1.0 1.0 77 radius 1.0 scheme split substeps auto"}) {
    const std::string precise = std::string(fix).find("bd/pse") == 0 ? " precision double" : "";
    const std::string line =
        "fix 1 all " + std::string(fix) + precise + " fft estimate adapt 0.02\n";
    const std::string file = "test_adapt_" + std::to_string(getpid()) + ".restart";
    std::vector<double> straight, continued;
    {
      LammpsSession lmp;
      lmp.script(suspension);
      lmp.script(line + "run 6\nwrite_restart " + file + "\nrun 6");
      straight = lmp.unwrapped_positions();
    }
    {
      LammpsSession lmp;
      lmp.command("atom_modify map array sort 1 5.0");
      lmp.script("read_restart " + file +
                 "\nneighbor 0.5 bin\ncomm_modify cutoff 5.0\n"
                 "neigh_modify every 1 delay 0 check yes\nthermo_style custom step\n"
                 "timestep 0.1\n" +
                 line + "run 6");
      continued = lmp.unwrapped_positions();
    }
    std::remove(file.c_str());
    EXPECT_LT(bdh_test::largest_difference(straight, continued), 1e-9) << fix;
  }
}

class WrongAdapt : public testing::TestWithParam<bdh_test::WrongInput> {};
TEST_P(WrongAdapt, IsRefused) { bdh_test::expect_message(GetParam()); }
INSTANTIATE_TEST_SUITE_P(
    Adapt, WrongAdapt,
    testing::Values(
        bdh_test::WrongInput{"fix 1 all bd/pse 1 1 5 radius 1 adapt 0.6",
                             "fix bd/pse: adapt = 0.6, but must be from 0.0001 to 0.5 radii"},
        bdh_test::WrongInput{"fix 1 all bd/fib 1 1 5 radius 1 adapt 0",
                             "fix bd/fib: adapt = 0, but must be from 0.0001 to 0.5 radii"},
        bdh_test::WrongInput{"fix 1 all bd/fib 1 1 5 radius 1 adapt yes", "adapt"},
        bdh_test::WrongInput{"fix 1 all bd/pse 1 1 5 radius 1 adapt", "adapt"},
        bdh_test::WrongInput{"fix 1 all bd/pse 1 1 5 radius 1 scheme split substeps auto",
                             "substeps = auto, but needs a tolerance for near steps: add adapt"},
        bdh_test::WrongInput{"fix 1 all bd/pse 1 1 5 radius 1 adapt 0.02 substeps auto",
                             "substeps = auto, but needs scheme split"},
        bdh_test::WrongInput{"fix 1 all bd/pse 1 1 5 radius 1 scheme split substeps many",
                             "substeps = many"},
        bdh_test::WrongInput{"fix 1 all bd/pse 1 1 5 radius 1 adapt 0.02 stresslet yes",
                             "stresslet = yes, but needs adapt no"},
        bdh_test::WrongInput{"fix 1 all bd/pse 1 1 5 radius 1 adapt 0.02 parts yes",
                             "needs steps as a whole: use adapt no"}));

// A constant force carries a particle over a wall in one step, which ends a run with steps as a
// whole. The change of forces does not foresee it.  The piece is halved until it does not: counted,
// printed and warned of.
TEST(Adapt, TakesBackAPieceThatWouldCrossAWall)
{
  const std::string scene = R"(
units lj
atom_style atomic
atom_modify map array
boundary p p f
region box block 0 8 0 8 0 8
create_box 1 box
create_atoms 1 single 4 4 2.5
mass 1 1.0
neigh_modify every 1 delay 0 check yes
thermo_style custom step
fix push all addforce 0.0 0.0 100.0
timestep 3.0
)";
  const std::string fix =
      "fix 1 all bd/fib 0.0 1.0 77 grid 8 8 8 wall zlo noslip wall zhi slip scheme euler ";
  LammpsSession whole;
  whole.script(scene);
  EXPECT_NE(whole.error_of(fix + "\nrun 8").find("wall"), std::string::npos);
  LammpsSession pieces;
  pieces.script(scene);
  EXPECT_EQ(pieces.error_of(fix + "adapt 0.5\nrun 8"), "");
  EXPECT_NE(pieces.log().find("were halved again"), std::string::npos);
  EXPECT_NE(pieces.log().find("would have ended the run"), std::string::npos);
  EXPECT_LT(pieces.unwrapped_positions()[2], 8.0);
}
