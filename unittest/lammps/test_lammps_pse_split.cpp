// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/pse, scheme split: one step compared with dense matrices, its covariance, Gibbs-Boltzmann,
// restarts, messages.

#include "lammps/lammps_mobility.h"
#include "lammps/lammps_scenes.h"
#include "lammps/wrong_input.h"
#include "neighbor.h"
#include "pse/plan.h"

#include <fstream>
#include <iterator>

using bdh_test::AtForces;
using bdh_test::LammpsSession;
using bdh_test::largest_difference;

namespace {

std::vector<double> product(const std::vector<double> &M, const std::vector<double> &f)
{
  std::vector<double> u(f.size(), 0.0);
  for (size_t i = 0; i < f.size(); ++i)
    for (size_t j = 0; j < f.size(); ++j) u[i] += M[i * f.size() + j] * f[j];
  return u;
}

/// Leaves a value in memory that functions called next will use for their variables.
__attribute__((noinline)) void fill_stack(unsigned char value)
{
  volatile unsigned char bytes[1 << 17];
  for (auto &b : bytes) b = value;
}

/// A chain of four atoms with harmonic bonds, each held by a spring to a fixed point, and one atom
/// that only has such a spring.
void create_spring_chain(LammpsSession &lmp, const std::vector<double> &start)
{
  lmp.script(R"(
units lj
atom_style bond
atom_modify map array
boundary p p p
neigh_modify every 1 delay 0 check yes
special_bonds lj 1.0 1.0 1.0
region box block 0 6 0 6 0 7
create_box 1 box bond/types 1 extra/bond/per/atom 4 extra/special/per/atom 8
mass 1 1.0
bond_style harmonic
bond_coeff 1 15.0 1.3
)");
  bdh_test::create_atoms(lmp, start);
  lmp.script("create_bonds single/bond 1 1 2\ncreate_bonds single/bond 1 2 3\ncreate_bonds "
             "single/bond 1 3 4\n"
             "displace_atoms all move 0.1 -0.1 0.2\nfix spring all spring/self 5.0\ndisplace_atoms "
             "all move -0.1 0.1 -0.2");
}
/// The forces on these atoms.
std::vector<double> chain_forces(const std::vector<double> &x, const std::vector<double> &start)
{
  const double k = 30.0, own = 5.0, rest = 1.3, to_home[3] = {0.1, -0.1, 0.2};
  std::vector<double> f(x.size());
  for (size_t i = 0; i < x.size(); ++i) f[i] = -own * (x[i] - start[i] - to_home[i % 3]);
  for (size_t p = 0; p < 3; ++p) {
    double d[3], r2 = 0.0;
    for (size_t c = 0; c < 3; ++c) {
      d[c] = x[3 * (p + 1) + c] - x[3 * p + c];
      r2 += d[c] * d[c];
    }
    const double r = std::sqrt(r2);
    for (size_t c = 0; c < 3; ++c) {
      const double pull = k * (r - rest) * d[c] / r;
      f[3 * p + c] += pull;
      f[3 * (p + 1) + c] -= pull;
    }
  }
  return f;
}

/// Products of the velocities of two atoms, in one step and in two successive ones, on average.
struct Correlations {
  void add(const double *v, int samples)
  {
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        same[i][j] += v[i] * v[j] / samples;
        next[i][j] += v[i] * before[j] / samples;
      }
    std::copy_n(v, 6, before);
  }
  double same[6][6] = {}, next[6][6] = {}, before[6] = {};
};

/// Dumbbells with stiff springs, whose lengths are counted in intervals of equal probability.
class Dumbbells {
 public:
  static constexpr int pairs = 100, bins = 20;
  static constexpr double k = 400.0, rest = 2.2;    // kT = 1, radius 1, viscosity 1/(6 pi)

  Dumbbells()
  {
    for (double r = low; r < rest + 0.4; r += step)
      weight_.push_back(total_ += r * r * std::exp(-0.5 * k * (r - rest) * (r - rest)));
  }
  static void create(LammpsSession &lmp)
  {
    lmp.script(R"(
units lj
atom_style bond
atom_modify map array
boundary p p p
neighbor 1.5 bin
neigh_modify every 1 delay 0 check yes
region box block 0 40 0 40 0 40
create_box 1 box bond/types 1 extra/bond/per/atom 1 extra/special/per/atom 4
mass 1 1.0
bond_style harmonic
bond_coeff 1 200.0 2.2
comm_modify cutoff 8.0
)");
    const std::vector<double> x = bdh_test::random_vector(3 * pairs, 5);
    for (int p = 0; p < pairs; ++p) {
      // On a lattice, so that the pairs are apart at first.
      const double at[3] = {1.0 + 6.5 * (p % 6), 1.0 + 6.5 * (p / 6 % 6), 1.0 + 6.5 * (p / 36)};
      const double other[3] = {at[0] + 2.2 + 0.02 * x[p], at[1], at[2]};
      lmp.create_atom(at);
      lmp.create_atom(other);
    }
    for (int p = 0; p < pairs; ++p)
      lmp.command("create_bonds single/bond 1 " + std::to_string(2 * p + 1) + " " +
                  std::to_string(2 * p + 2) +
                  (p + 1 < pairs ? " special no" : ""));    // the last one builds all lists
  }
  void count(const std::vector<double> &x)
  {
    for (int p = 0; p < pairs; ++p) {
      double r2 = 0.0;
      for (int d = 0; d < 3; ++d) r2 += std::pow(x[6 * p + d] - x[6 * p + 3 + d], 2);
      const double place = (std::sqrt(r2) - low) / step, last = weight_.size() - 1.0;
      const double u = place <= 0.0 ? 0.0 : weight_[std::min(place, last)] / total_;
      count_[std::min(bins - 1.0, u * bins)] += 1.0;
    }
    ++rounds_;
  }
  double chi2() const
  {
    const double expected = static_cast<double>(pairs) * rounds_ / bins;
    double chi2 = 0.0;
    for (double c : count_) chi2 += (c - expected) * (c - expected) / expected;
    return chi2;
  }

 private:
  static constexpr double low = rest - 0.4, step = 1e-4;
  std::vector<double> weight_;    // cumulative, of r in fine steps
  double total_ = 0.0;
  std::vector<double> count_ = std::vector<double>(bins);
  int rounds_ = 0;
};

}    // namespace

// A far step and four near ones without noise, for springs between particles and to fixed points (a
// fix that adds forces), compared with dense matrices of both parts at the positions of each
// substep. At tolerance 1e-9 the displacements, which are of order 0.1, agree to 1e-8.  A substep
// with old forces or an old mobility is off by 1e-3.
TEST(LammpsPseSplit, OneStepByDenseMatrices)
{
  const double radius = 0.5, viscosity = 0.8, xi = 1.1, H = 0.2;
  const int n = 4;
  const std::vector<double> start{1.0, 1.0, 1.0, 1.9, 1.1, 0.8, 2.2, 1.9,
                                  1.2, 1.5, 2.4, 2.1, 5.9, 0.2, 3.0};
  const size_t atoms = start.size() / 3;
  LammpsSession lmp;
  create_spring_chain(lmp, start);
  lmp.script("timestep 0.2\nfix move all bd/pse 0.0 0.8 1 radius 0.5 tolerance 1e-9 xi 1.1 fft "
             "estimate scheme split substeps 4\nrun 1");
  std::vector<double> x = start;
  bdh::Cell cell;
  cell.lx = cell.ly = 6.0;
  cell.lz = 7.0;
  for (int substep = -1; substep < n; ++substep) {
    const auto split = bdh::dense_split(cell, x.data(), atoms, radius, viscosity, xi);
    const auto u = product(substep < 0 ? split.wave : split.real, chain_forces(x, start));
    for (size_t i = 0; i < x.size(); ++i) x[i] += (substep < 0 ? H : H / n) * u[i];
  }
  EXPECT_GT(largest_difference(x, start), 0.05);
  EXPECT_LT(largest_difference(lmp.unwrapped_positions(), x), 1e-8);
  const auto v = lmp.velocities();
  for (size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(v[i], (x[i] - start[i]) / H, 1e-7) << i;
}

// Without forces, and with steps so short that nothing moves, the displacement of a step has the
// covariance
//     2 kT H M_w + 2 kT h M_r (1/4 + (n - 1) + 1/4),
// and 2 kT h M_r/4 with the previous step, since they share one near noise.  20 000 samples with
// bounds of 5 standard errors; correlations between successive samples change these by less than a
// tenth.  One noise used in two substeps, or two where there should be one, is off by 20 of them.
TEST(LammpsPseSplitStatistics, CovarianceOfDisplacements)
{
  const double kT = 0.7, viscosity = 1.4, radius = 0.9, H = 1e-12, xi = 0.6;
  const int samples = 20000, n = 3;
  LammpsSession lmp;
  bdh::Cell cell;
  cell.lx = 5.0;
  cell.ly = 4.0;
  cell.lz = 6.0;
  lmp.script("units lj\natom_style atomic\natom_modify map array\nboundary p p p\n" +
             bdh_test::box_commands(cell) + "mass 1 1.0");
  bdh_test::create_atoms(lmp, {0.1, 0.2, 0.3, 1.6, 0.9, 5.8});
  const auto x = lmp.unwrapped_positions();
  const auto M = bdh::dense_split(cell, x.data(), 2, radius, viscosity, xi);
  Correlations seen;
  AtForces sample(lmp, [&](const AtForces::Call &call) {
    if (call.step == 0 || call.atoms != 2) return;
    static int calls = 0;
    if (++calls % (n + 1))
      return;    // forces are evaluated n + 1 times per step, the last time at its end
    double v[6] = {};
    for (int i = 0; i < call.atoms; ++i)
      for (int d = 0; d < 3; ++d) v[3 * (call.id[i] - 1) + d] = lmp->atom->v[i][d];
    seen.add(v, samples);
  });
  lmp.script("fix move all bd/pse 0.7 1.4 99 fft estimate radius 0.9 xi 0.6 scheme split substeps "
             "3\ntimestep 1e-12\n"
             "thermo 100000\nrun " +
             std::to_string(samples) + " post no");
  const double scale = 2.0 * kT / H;
  const auto exact = [&](int i, int j) {
    return scale * (M.wave[6 * i + j] + (n - 0.5) / n * M.real[6 * i + j]);
  };
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const double shared = scale * 0.25 / n * M.real[6 * i + j],
                   error = std::sqrt(exact(i, i) * exact(j, j) / samples);
      EXPECT_LT(std::fabs(seen.next[i][j] - shared), 5.0 * error) << i << " " << j;
      EXPECT_LT(std::fabs(seen.same[i][j] - exact(i, j)),
                5.0 * std::hypot(error, exact(i, j) / std::sqrt(samples)))
          << i << " " << j;
    }
}

// 100 dumbbells with stiff springs, for whose length p = k mu dt = 0.6 in a near step.  For any
// mobility, P(r) ~ r^2 exp(-k (r - r0)^2/2 kT).  In 20 intervals of equal probability chi2 has mean
// 19.  Samples are four steps apart; with a factor of 2 for the remaining correlation, chi2 > 90
// has probability 1e-4.  scheme euler with the same near step widens the distribution by 1/(1 -
// p/2) and fails.
TEST(LammpsPseSplitStatistics, DumbbellsAgainstGibbsBoltzmann)
{
  const auto chi2_of = [](const std::string &keywords, double dt, int rounds) {
    LammpsSession lmp;
    Dumbbells::create(lmp);
    lmp.script("fix move all bd/pse 1.0 0.0530516477 17 radius 1.0 fft estimate " + keywords +
               "\ntimestep " + bdh_test::text(dt) + "\nthermo 100000\nrun 40");
    Dumbbells lengths;
    for (int round = 0; round < rounds; ++round) {
      lmp.command("run 4 post no");
      lengths.count(lmp.unwrapped_positions());
    }
    return lengths.chi2();
  };
  // The relative mobility of two spheres 2.2 radii apart is 2 * 0.4122 of the mobility of one.
  const double near = 0.6 / (2.0 * 0.4122 * Dumbbells::k);
  const double split = chi2_of("scheme split substeps 4", 4.0 * near, 100),
               euler = chi2_of("scheme euler", near, 40);
  std::printf("chi2 of 20 intervals: split %.1f, euler with the near step %.0f\n", split, euler);
  EXPECT_LT(split, 90.0);
  EXPECT_GT(euler, 150.0);
}

TEST(LammpsPseSplit, RestartContinuesTheTrajectory)
{
  const std::string fix = "fix move all bd/pse 1.0 1.0 321 radius 0.5 xi 1.0 fft estimate "
                          "precision double scheme split substeps 3";
  const auto unbroken = bdh_test::run_twice_through_restart(fix, false);
  EXPECT_LT(largest_difference(bdh_test::run_twice_through_restart(fix, true), unbroken), 1e-10);
}

// Restart files contain nothing uninitialised, such as the padding of structures.
TEST(LammpsPseSplit, EqualRunsWriteEqualRestartFiles)
{
  const std::string file = "test_" + std::to_string(getpid()) + "_bytes.restart";
  const auto bytes = [&](unsigned char before) {
    LammpsSession lmp;
    lmp.script(bdh_test::lattice_suspension);
    lmp.script("fix move all bd/pse 1.0 1.0 321 radius 0.5 fft estimate scheme split substeps 3\n"
               "run 3");
    fill_stack(before);
    lmp.command("write_restart " + file);
    std::ifstream in(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const std::string first = bytes(0x55), second = bytes(0xaa);
  std::remove(file.c_str());
  EXPECT_NE(first.find("bd/pse"), std::string::npos);
  ASSERT_EQ(first.size(), second.size());
  for (size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i], second[i]) << "byte " << i;
}

// scheme euler ignores the data of scheme split in a restart file.
TEST(LammpsPseSplit, RestartMayGoOnWithEuler)
{
  const std::string file = "test_" + std::to_string(getpid()) + "_scheme.restart",
                    fix = "all bd/pse 1.0 1.0 321 radius 0.5 xi 1.0 fft estimate";
  {
    LammpsSession lmp;
    lmp.script(bdh_test::lattice_suspension);
    lmp.script("fix move " + fix + " scheme split substeps 3\nrun 2\nwrite_restart " + file);
  }
  const auto positions = [&](const std::string &start) {
    LammpsSession lmp;
    lmp.script("read_restart " + file +
               "\nneighbor 0.4 bin\nneigh_modify every 1 delay 0 check yes\ntimestep 0.002");
    lmp.script(start);
    if (start.find("parts") != std::string::npos) {
      for (int i = 0; i < lmp->atom->nlocal; ++i)
        for (int c = 0; c < 6; ++c)
          EXPECT_EQ(lmp.fix("move")->array_atom[i][c], 0.0) << i << " " << c;
    }
    lmp.command("run 2");
    return lmp.unwrapped_positions();
  };
  const auto other_id = positions("fix other " + fix);
  EXPECT_EQ(largest_difference(positions("fix move " + fix), other_id), 0.0);
  EXPECT_LT(largest_difference(positions("fix move " + fix + " parts yes"), other_id), 1e-4);
  std::remove(file.c_str());
}

// Neighbor lists are rebuilt within the step when particles have moved by half the skin, also in a
// tilted or sheared cell.  Positions must not depend on the skin.
TEST(LammpsPseSplit, TrajectoryDoesNotDependOnTheSkin)
{
  const auto trajectory = [](const std::string &box, const char *skin, double &builds) {
    LammpsSession lmp;
    lmp.script("units lj\natom_style atomic\natom_modify map array\nregion box " + box +
               "\ncreate_box 1 box\nlattice sc 0.125\n"
               "create_atoms 1 box\nmass 1 1.0\npair_style soft 1.8\npair_coeff 1 1 "
               "5.0\nneigh_modify every 1 delay 0 check yes\n"
               "timestep 0.02\nneighbor " +
               std::string(skin) +
               " bin\n"
               "fix move all bd/pse 1.0 1.0 321 radius 0.5 xi 1.0 fft estimate precision double "
               "scheme split substeps 3");
    if (box.find("prism 0 8 0 8 0 8 0") != std::string::npos)
      lmp.command("fix shear all deform 1 xy erate 0.3 remap x flip no");
    lmp.command("run 20");
    builds = lmp->neighbor->ncalls;
    return lmp.unwrapped_positions();
  };
  for (const char *box :
       {"block 0 8 0 8 0 8", "prism 0 8 0 8 0 8 2 -2 2", "prism 0 8 0 8 0 8 0 0 0"}) {
    double often, seldom;
    const auto thin = trajectory(box, "0.1", often), thick = trajectory(box, "3.0", seldom);
    EXPECT_GT(often, 20.0) << box;
    EXPECT_LT(seldom, 3.0) << box;
    EXPECT_LT(largest_difference(thin, thick), 1e-9) << box;
  }
}

TEST(LammpsPseSplit, PlanSaysWhatWasChosen)
{
  LammpsSession lmp;
  lmp.script(bdh_test::lattice_suspension);
  lmp.script(
      "fix move all bd/pse 1.0 1.0 321 radius 0.5 fft estimate scheme split substeps 4\nrun 1");
  EXPECT_NE(lmp.log().find(
                "split: 1 far step of 0.002, then 4 near steps of 0.0005, forces 5 times a step"),
            std::string::npos)
      << lmp.log();
  EXPECT_NE(
      lmp.log().find("times as much as with scheme euler at timestep 0.0005; forces not counted"),
      std::string::npos)
      << lmp.log();
  EXPECT_EQ(lmp.log().find("WARNING"), std::string::npos) << lmp.log();
  lmp.script("unfix move\nfix move all bd/pse 1.0 1.0 321 radius 0.5 xi 2.0 fft estimate scheme "
             "split substeps 4\nrun 1");
  EXPECT_NE(lmp.log().find("times as stiff as a near one, but should be at most as stiff: use xi "
                           "auto, or fewer substeps"),
            std::string::npos);
}

// The solve that checks the tolerance takes no steps, so their stiffness does not matter.
TEST(LammpsPseSplit, ToleranceCanBeChecked)
{
  LammpsSession lmp;
  lmp.script(bdh_test::lattice_suspension);
  lmp.script("fix move all bd/pse 1.0 1.0 321 radius 0.5 fft estimate scheme split substeps 8 "
             "check yes\nrun 1");
  EXPECT_NE(lmp.log().find("check of the tolerance 0.001"), std::string::npos);
}

// The fraction of wave space in the mobility of two touching spheres along their line of centres,
// in an unbounded fluid.
TEST(LammpsPseSplit, FarShareOfTouchingSpheres)
{
  EXPECT_NEAR(bdh::pse_far_share(0.3), 0.044 / 0.375, 0.002);
  EXPECT_NEAR(bdh::pse_far_share(0.5), 0.12 / 0.375, 0.015);
}

TEST(LammpsPseSplit, WrongInput)
{
  const std::string fix = "fix 1 all bd/pse 1.0 1.0 5 radius 0.5 ";
  for (const auto &c : std::vector<std::pair<std::string, std::string>>{
           {"scheme midpoint", "must be euler or split"},
           {"scheme split", "add substeps n"},
           {"substeps 3", "needs scheme split"},
           {"scheme split substeps 0", "must be from 1 to 100"},
           {"scheme split substeps 101", "must be from 1 to 100"},
           {"scheme split substeps 4 parts yes", "needs scheme euler"}}) {
    const std::string input = fix + c.first;
    bdh_test::expect_message({input.c_str(), c.second.c_str()});
  }
}
