// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Rigid spheres and atoms that are held: fix bd/pse/kk and bd/fib/kk have the trajectory, the
// stress and the loads of the plain style, on threads of the host and with the kernels of the
// device.

#include "kokkos/kokkos_trajectories.h"

using namespace bdh_test;

namespace {

/// Spheres of unequal radii.
std::string spheres()
{
  return with(with(lattice_suspension, "atom_style atomic", "atom_style sphere"), "mass 1 1.0",
              "set type 1 diameter 1.0\ngroup large id 1:20\n"
              "set group large diameter 1.3");
}

/// The trajectory and what the fix puts out, followed by its numbers of each atom.
std::vector<double> all_of(const std::string &options, const std::string &scene,
                           const std::string &fix, int columns)
{
  LammpsSession lmp(MPI_COMM_WORLD, options);
  lmp.script(scene + fix + "\nrun 15");
  std::vector<double> all = lmp.unwrapped_positions();
  const auto add = [&all](const std::vector<double> &more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  add(lmp.velocities());
  add(lmp.per_atom("move", columns));
  LAMMPS_NS::Fix *move = lmp.fix("move");
  for (int n = 0; n < move->size_vector; ++n) all.push_back(move->compute_vector(n));
  return all;
}

struct Deck {
  std::string scene, rest;
  int columns;    // of each atom
  std::string style = "bd/pse";
};

// Round-off grows through the steps and the iterations; what is missing or wrong changes positions
// by at least 1e-4.
void expect_same(const Deck &d)
{
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const std::string fix = "fix move all " + d.style, rest = " 1.0 1.0 4711 fft estimate " + d.rest;
  const std::vector<double> plain = all_of("", d.scene, fix + rest, d.columns);
  const auto machines = ranks > 1 ? std::vector<std::string>{kokkos_machines[0]} : kokkos_machines;
  for (const std::string &m : machines) {
    EXPECT_LT(largest_difference(
                  all_of(kokkos_options(m), d.scene, fix + "/kk/host" + rest, d.columns), plain),
              1e-8)
        << d.rest << ", " << m;
    if (ranks > 1) continue;
    EXPECT_LT(largest_difference(
                  all_of(kokkos_options(m), d.scene, fix + "/kk/device" + rest, d.columns), plain),
              1e-8)
        << d.rest << ", " << m;
  }
}

const std::string shear =
    "change_box all triclinic\nfix flow all deform 1 xy erate 0.5 remap x flip yes\n";
constexpr int stresslet_columns = 9, held_columns = 6;

}    // namespace

TEST(KokkosConstraints, RigidSpheresInShear)
{
  expect_same({spheres() + shear, "precision double stresslet yes", stresslet_columns});
  expect_same({std::string(lattice_suspension) + shear, "radius 0.5 precision double stresslet yes",
               stresslet_columns});
}

// Some atoms at rest, others that move, and the same of rigid spheres.
TEST(KokkosConstraints, HeldAtoms)
{
  const std::string groups = "group posts id 3 17 40\ngroup driven id 21:24\n"
                             "variable pull equal 0.5*sin(0.1*step)\n",
                    hold = " hold posts 0 0 0 hold driven v_pull 0.3 0";
  expect_same({lattice_suspension + groups, "radius 0.5 precision double" + hold, held_columns});
  expect_same({spheres() + groups, "precision double" + hold, held_columns});
  expect_same({spheres() + groups, "precision double stresslet yes" + hold,
               stresslet_columns + held_columns});
  expect_same({spheres() + groups, "precision double stresslet yes control_variate yes" + hold,
               stresslet_columns + held_columns});
}

// The same in a fluid, in a box and between walls.  The number of iterations may differ by one with
// the order of summation, so the constraint is met far below the bound.
TEST(KokkosConstraints, InAFluid)
{
  const std::string groups = "group posts id 3 17 40\ngroup driven id 21:24\n"
                             "variable pull equal 0.5*sin(0.1*step)\n",
                    hold = " hold posts 0 0 0 hold driven v_pull 0.3 0",
                    fix = "radius 0.8 constraint 1e-11 ",
                    slit = "change_box all boundary p p f z delta -0.9 0.9\n",
                    walls = "wall zlo noslip wall zhi noslip 0.3 0 0 ";
  expect_same({lattice_suspension, fix + "stresslet yes shear 0.3", stresslet_columns, "bd/fib"});
  expect_same({lattice_suspension + groups, fix + hold, held_columns, "bd/fib"});
  expect_same({lattice_suspension + groups, fix + "control_variate yes stresslet yes" + hold,
               stresslet_columns + held_columns, "bd/fib"});
  expect_same({lattice_suspension + groups + slit, fix + walls + "stresslet yes" + hold,
               stresslet_columns + held_columns, "bd/fib"});
}

// Single precision: the bound is the effect of another order of summation.
TEST(KokkosConstraints, SinglePrecision)
{
  const std::string scene = spheres() + shear,
                    rest = " 0.0 1.0 4711 fft estimate precision single stresslet yes";
  const auto end = [&](const std::string &options, const std::string &style) {
    return trajectory(options, scene, "fix move all " + style + rest, 15, style).end;
  };
  EXPECT_LT(largest_difference(end(kokkos_options(kokkos_machines[0]), "bd/pse/kk/device"),
                               end("", "bd/pse")),
            1e-3);
}
