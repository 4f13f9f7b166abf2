// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/pse and bd/fib with stresslets and held atoms: the same on any number of ranks, and after
// a restart. Run under mpirun -np 4.

#include "lammps/lammps_ranks.h"
#include "lammps/lammps_scenes.h"
#include "lammps/lammps_spheres.h"

using namespace bdh_test;

namespace {

using Vector = std::vector<double>;
const std::string start =
    std::string(field_command) +
    "group wall id 3 9 17\nfix move all bd/pse 0.7 0.9 4711 radius atom fft estimate precision "
    "double stresslet yes tolerance 1e-4 ";

Vector positions_after(int ranks, const std::string &fix, const std::string &runs)
{
  Vector x;
  on_ranks(ranks, dipole_spheres, "", [&](LammpsSession &lmp) {
    lmp.script(no_forces + fix + "\n" + runs);
    x = lmp.unwrapped_positions();
    const Vector mu = dipoles(lmp, lmp->world);
    x.insert(x.end(), mu.begin(), mu.end());
    for (int n = 8; n < 26; ++n) x.push_back(lmp.fix("move")->compute_vector(n));
  });
  return x;
}

/// The same of bd/fib in a box without dipoles, with its figures.
Vector fib_positions_after(int ranks, const std::string &fix, const std::string &runs)
{
  Vector x;
  on_ranks(ranks, lattice_suspension, "", [&](LammpsSession &lmp) {
    lmp.script(fix + "\n" + runs);
    x = lmp.unwrapped_positions();
    for (int n = 9; n < 45; ++n) x.push_back(lmp.fix("move")->compute_vector(n));
  });
  return x;
}

void expect_same(const Vector &a, const Vector &b)
{
  for (std::size_t k = 0; k < a.size() && k < b.size(); ++k)
    EXPECT_NEAR(a[k], b[k], 1e-8 * (1.0 + std::fabs(a[k]))) << k;
}

}    // namespace

TEST(LammpsStressletsRanks, SameTrajectory)
{
  for (const char *more : {"", "hold wall 0.1 0 -0.2 control_variate yes",
                           "\nfix flow all deform 1 xz erate 0.5 remap x"}) {
    const Vector one = positions_after(1, start + more, "run 5");
    for (int ranks = 2; ranks <= all_ranks(); ++ranks)
      expect_same(one, positions_after(ranks, start + more, "run 5"));
  }
}

// Between walls, too, whose forces are among the figures.
TEST(LammpsStressletsRanks, SameTrajectoryInAFluid)
{
  const std::string fix =
      "group posts id 3 9 17\nfix move all bd/fib 0.7 0.9 4711 radius 0.8 fft estimate constraint "
      "1e-6 ";
  const std::string walls = "wall zlo noslip wall zhi noslip 0.3 0 0 ",
                    slit = "change_box all boundary p p f z delta -0.9 0.9\n";
  for (const std::string &deck :
       {fix + "stresslet yes", fix + "stresslet yes shear 0.2 hold posts 0.1 0 -0.2",
        fix + "hold posts 0 0 0 control_variate yes",
        slit + fix + walls + "stresslet yes hold posts 0 0 0"}) {
    SCOPED_TRACE(deck);
    const Vector one = fib_positions_after(1, deck, "run 5");
    for (int ranks = 2; ranks <= all_ranks(); ++ranks)
      expect_same(one, fib_positions_after(ranks, deck, "run 5"));
  }
}

TEST(LammpsStressletsRanks, RestartGoesOn)
{
  const std::string file = restart_file("stresslets"), fix = start + "hold wall 0.1 0 -0.2";
  const Vector whole = positions_after(2, fix, "run 5\nwrite_restart " + file + "\nrun 5");
  from_restart(2, file, "", [&](LammpsSession &lmp) {
    lmp.script(no_forces + fix + "\nrun 5");
    expect_same(whole, lmp.unwrapped_positions());
  });
}

// Processes without atoms do what the others do.
TEST(LammpsStressletsRanks, HeldAtomsOfFewProcesses)
{
  const std::string few = "group rest id > 3\ndelete_atoms group rest compress no\n",
                    hold = " hold wall 0.1 0 -0.2";
  for (const std::string &fib : {hold, hold + " stresslet yes"}) {
    const std::string fix =
        few + "group wall id 3\nfix move all bd/fib 0.7 0.9 4711 fft estimate radius 1.0" + fib;
    expect_same(fib_positions_after(1, fix, "run 3"), fib_positions_after(4, fix, "run 3"));
  }
  const std::string fix = few + start + hold;
  expect_same(positions_after(1, fix, "run 3"), positions_after(4, fix, "run 3"));
}
