// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/pse with unequal radii and rotation: the same on any number of ranks, and after a restart.
// Run under mpirun -np 4.

#include "lammps/lammps_ranks.h"
#include "lammps/lammps_spheres.h"

using namespace bdh_test;

namespace {

using Vector = std::vector<double>;
const std::string start =
    std::string(field_command) +
    "fix move all bd/pse 0.7 0.9 4711 radius atom fft estimate precision double "
    "xi 0.6 ";

struct State {
  Vector x, mu, omega;
};

State state(LammpsSession &lmp)
{
  return {lmp.unwrapped_positions(), dipoles(lmp, lmp->world), omegas(lmp, lmp->world)};
}

State state_after(int ranks, const std::string &fix, const std::string &runs)
{
  State s;
  on_ranks(ranks, dipole_spheres, "", [&](LammpsSession &lmp) {
    lmp.script(no_forces + fix + "\n" + runs);
    s = state(lmp);
  });
  return s;
}

double largest(const Vector &a, const Vector &b)
{
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::fabs(a[k] - b[k]));
  return most;
}

void expect_same(const State &a, const State &b, double bound)
{
  if (a.x.empty() || b.x.empty()) return;
  EXPECT_LE(largest(a.x, b.x), bound);
  EXPECT_LE(largest(a.mu, b.mu), bound);
  EXPECT_LE(largest(a.omega, b.omega), 1e4 * bound);
}

}    // namespace

TEST(LammpsSpheresRanks, SameTrajectory)
{
  for (const char *more : {"", "scheme split substeps 2", "hydrodynamics no"}) {
    const State one = state_after(1, start + more, "run 20");
    for (int ranks = 2; ranks <= all_ranks(); ++ranks)
      expect_same(one, state_after(ranks, start + more, "run 20"), 1e-10);
  }
}

// Positions, dipoles and the last noise of scheme split are in the restart file.
TEST(LammpsSpheresRanks, RestartGoesOn)
{
  for (const char *more : {"", "scheme split substeps 2"}) {
    const std::string file = restart_file("spheres");
    const State whole = state_after(2, start + more, "run 10\nwrite_restart " + file + "\nrun 10");
    from_restart(2, file, "", [&](LammpsSession &lmp) {
      lmp.script(no_forces + start + more + "\nrun 10");
      expect_same(whole, state(lmp), 1e-11);
    });
  }
}
