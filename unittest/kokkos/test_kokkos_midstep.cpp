// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Forces within a step with the KOKKOS package, for scheme improved of bd/fib and scheme split of
// bd/pse.  The trajectory is that of the plain run for any mixture of styles on the host and on the
// device, before, after and within the pair style.

#include "kokkos/kokkos_trajectories.h"

#include <cstdio>
#include <unistd.h>

using namespace bdh_test;

namespace {

const std::string improved = "bd/fib", split = "bd/pse";

/// The fix command for a style with or without a suffix.
std::string fix_of(const std::string &style, const std::string &group = "all",
                   const std::string &grid = "16 20 24")
{
  const std::string start = "fix move " + group + " " + style + " 1.0 1.0 4711 ";
  return style.compare(0, 6, improved) == 0
             ? start + "grid " + grid + " scheme improved"
             : start + "radius 0.5 xi 1.0 fft estimate precision double scheme split substeps 3";
}

constexpr int steps = 20;

/// On several ranks the fix does not use the device.
bool uses_device()
{
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return ranks == 1;
}

// Round-off of 1e-16 grows through the steps.  Forces that are missing, doubled, or taken at wrong
// positions change the result by at least 1e-3.
void expect_same(const std::string &plain_style, const std::string &scene,
                 const std::string &group = "all",
                 const std::vector<std::string> &machines = kokkos_machines,
                 const std::string &grid = "16 20 24", const std::string &more = "")
{
  const Trajectory plain =
      trajectory("", scene, fix_of(plain_style, group, grid) + more, steps, plain_style);
  const auto compare = [&](const std::string &style, const std::string &expected,
                           const std::string &machine) {
    const Trajectory there = trajectory(kokkos_options(machine), scene,
                                        fix_of(style, group, grid) + more, steps, expected);
    EXPECT_LT(largest_difference(there.end, plain.end), 1e-9) << style << ", " << machine;
    EXPECT_EQ(there.builds, plain.builds) << style << ", " << machine;
  };
  for (const std::string &m : machines) compare(plain_style, plain_style + "/kk", m);
  if (uses_device())
    compare(plain_style + "/kk/device", plain_style + "/kk/device", machines.back());
}

void expect_same_of_both(const std::string &scene, const std::string &group = "all",
                         const std::vector<std::string> &machines = kokkos_machines,
                         const std::string &grid = "16 20 24", const std::string &more = "")
{
  expect_same(improved, scene, group, machines, grid, more);
  expect_same(split, scene, group, machines, grid, more);
}

const std::string suspension = lattice_suspension;
const std::string pair = "pair_style lj/cut 2.5\npair_coeff 1 1 1.0 1.0";

/// 27 particles with bonds; bonded pairs are left out of the neighbor lists.
const std::string bonded = R"(
units lj
atom_style bond
atom_modify map array
boundary p p p
region box block 0 8 0 8 0 8
create_box 1 box bond/types 1 extra/bond/per/atom 6 extra/special/per/atom 30
lattice sc 1.0
region cube block 2.9 5.1 2.9 5.1 2.9 5.1
create_atoms 1 region cube
mass 1 1.0
pair_style lj/cut 1.6
pair_coeff 1 1 1.0 1.0
neighbor 0.1 bin
special_bonds lj 0.0 1.0 1.0
bond_style harmonic
bond_coeff 1 50.0 1.05
create_bonds many all all 1 0.9 1.1
neigh_modify every 1 delay 0 check yes
timestep 0.002
)";

}    // namespace

TEST(KokkosMidstep, PairForces) { expect_same_of_both(suspension); }

// The skin is so thin that lists are also built within steps, and more often than there are steps.
TEST(KokkosMidstep, ListsAreBuiltWithinTheStep)
{
  const std::string thin = with(suspension, "neighbor 0.4 bin", "neighbor 0.02 bin");
  for (const std::string &style : {improved, split})
    EXPECT_GT(trajectory("", thin, fix_of(style), steps).builds, 3 * steps / 2);
  expect_same_of_both(thin);
}

// The same, with communication by LAMMPS' Kokkos kernels on the device and on the host.
TEST(KokkosMidstep, CommunicationByKokkos)
{
  const std::string thin = with(suspension, "neighbor 0.4 bin", "neighbor 0.1 bin");
  expect_same_of_both(thin, "all",
                      {"newton on neigh half comm device", "newton off neigh full comm host"});
}

TEST(KokkosMidstep, AsakuraOosawaWithAndWithoutAnother)
{
  expect_same_of_both(
      with(suspension, pair, "pair_style asakura/oosawa 3.5\npair_coeff 1 1 direct 2.0 2.6"), "all",
      {kokkos_machines[0]});
  expect_same_of_both(
      with(suspension, pair,
           "pair_style hybrid/overlay lj/cut 2.5 soft 2.5\npair_coeff 1 1 lj/cut 1.0 1.0\n"
           "pair_coeff 1 1 soft 5.0"));
}

// A pair style that runs only on the host, with fixes with and without a /kk variant, and a run
// without a pair style.
TEST(KokkosMidstep, StylesWithoutKokkos)
{
  const std::string soft = with(suspension, pair, "pair_style soft 2.5\npair_coeff 1 1 5.0");
  expect_same_of_both(soft, "all", {kokkos_machines[0], kokkos_machines[1]});
  expect_same_of_both(
      with(suspension, pair,
           "fix spring all spring/self 3.0\npair_style none\ncomm_modify cutoff 2.9"),
      "all", {kokkos_machines[0]});
}

TEST(KokkosMidstep, BondsAndPairsOutsideTheLists)
{
  expect_same_of_both(bonded);
  // A bond style without a /kk variant, after a pair style that has one.
  expect_same_of_both(
      with(with(bonded, "bond_style harmonic", "bond_style morse"), "50.0 1.05", "10.0 2.0 1.05"),
      "all", {kokkos_machines[0]});
}

// Fixes that add or remove forces after all others: setforce has a /kk variant, addforce and
// spring/self have none.
TEST(KokkosMidstep, FixesThatChangeForces)
{
  expect_same_of_both(
      suspension +
      "group some id 1:20\nfix spring all spring/self 3.0\nfix hold some setforce NULL 0.0 NULL\n"
      "fix push some addforce 2.0 0.0 -1.0\n");
  const std::string slit =
      with(with(with(suspension, "boundary p p p", "boundary p p f"), "lattice sc 0.125",
                "lattice sc 0.125 origin 0.5 0.5 0.5"),
           "mass 1 1.0",
           "mass 1 1.0\nfix walls all wall/harmonic zlo EDGE 10.0 1.0 2.0 zhi EDGE 10.0 1.0 2.0");
  expect_same(improved, slit, "all", kokkos_machines, "16 20 24",
              " wall zlo noslip wall zhi noslip");
}

// Another integrator uses the forces of the beginning of the step, which the fix restores.
TEST(KokkosMidstep, OtherIntegrators)
{
  expect_same_of_both(
      suspension + "group some id 1:40\ngroup rest id 41:64\nfix spring all spring/self 3.0\n",
      "some", kokkos_machines, "16 20 24", "\nfix inertia rest nve");
}

// Atoms join and leave the group from step to step.
TEST(KokkosMidstep, DynamicGroup)
{
  expect_same_of_both(
      suspension +
          "region left block 0 4 INF INF INF INF\ngroup some dynamic all region left every 1\n",
      "some", {kokkos_machines[0], kokkos_machines[2]});
}

TEST(KokkosMidstep, WithoutNoise)
{
  for (const std::string &style : {improved, split}) {
    const auto end = [&](const std::string &machine, const std::string &suffix) {
      return trajectory(machine, suspension,
                        with(fix_of(style + suffix), " 1.0 1.0 4711", " 0.0 1.0 4711"), steps)
          .end;
    };
    const std::vector<double> plain = end("", "");
    for (const std::string suffix : {"/kk/host", "/kk/device"})
      EXPECT_LT(largest_difference(end(kokkos_options(kokkos_machines[0]), suffix), plain), 1e-9)
          << style << suffix;
  }
}

// Torques are saved and restored like forces.
TEST(KokkosMidstep, Spheres)
{
  expect_same_of_both(with(with(suspension, "atom_style atomic", "atom_style sphere"), "mass 1 1.0",
                           "set type 1 diameter 1.0"),
                      "all", {kokkos_machines[0]});
}

TEST(KokkosMidstep, TiltedBoxThatIsSheared)
{
  expect_same(
      split, with(suspension, "neighbor 0.4 bin", "neighbor 0.05 bin") +
                 "change_box all triclinic\nfix flow all deform 1 xy erate 0.5 remap x flip yes\n");
}

// The box flips after lists were built within the step: the lists of the step then need the stencil
// of the new tilts.  The old one misses pairs, which changes positions by 2e-4 and more.
TEST(KokkosMidstep, TiltedBoxThatFlips)
{
  const auto scene = [](const std::string &xz, const std::string &yz) {
    return with(suspension, "neighbor 0.4 bin", "neighbor 0.01 bin") +
           "change_box all triclinic\nchange_box all xy final 3.97 units box\nchange_box all xz "
           "final " +
           xz + " units box\nchange_box all yz final " + yz +
           " units box\nfix flow all deform 1 xy erate 1.0 remap x flip yes\n";
  };
  const std::string longer = with(fix_of(split), "xi 1.0", "xi 0.9"),
                    shorter = with(fix_of(split), "xi 1.0", "xi 1.2");
  const auto compare = [](const std::string &tilted, const std::string &fix) {
    const Trajectory plain = trajectory("", tilted, fix, 8);
    for (const std::string &m : kokkos_machines) {
      const Trajectory there = trajectory(kokkos_options(m), tilted, fix, 8);
      EXPECT_LT(largest_difference(there.end, plain.end), 1e-9) << m;
      EXPECT_EQ(there.builds, plain.builds) << m;
    }
    if (!uses_device()) return;
    const std::string on_device = with(fix, split, split + "/kk/device");
    EXPECT_LT(
        largest_difference(trajectory(kokkos_options(kokkos_machines[0]), tilted, on_device, 8).end,
                           plain.end),
        1e-9);
  };
  compare(scene("2", "3.9"), longer);
  compare(scene("3", "3.9"), longer);
  compare(scene("3.9", "1"), shorter);
  compare(scene("3.9", "3"), shorter);
}

// The plain bd/fib among /kk styles: the KOKKOS package keeps the copies on the host up to date for
// it.
TEST(KokkosMidstep, PlainFixAmongKokkosStyles)
{
  const Trajectory plain = trajectory("", bonded, fix_of(improved), steps, improved);
  for (const std::string &m : kokkos_machines)
    EXPECT_LT(largest_difference(trajectory(kokkos_options(m), bonded,
                                            "suffix off\n" + fix_of(improved) + "\nsuffix on",
                                            steps, improved)
                                     .end,
                                 plain.end),
              1e-9)
        << m;
}

// The last near noise survives a restart file and the sorting of atoms in memory.
TEST(KokkosMidstep, RestartAndSorting)
{
  const std::string
      sorting = with(suspension, "atom_modify map array", "atom_modify map array sort 3 2.0"),
      settings = "neighbor 0.4 bin\nneigh_modify every 1 delay 0 check yes\ntimestep 0.002\n";
  for (const std::string &style : {improved, split}) {
    const Trajectory unbroken = trajectory("", sorting, fix_of(style) + "\nrun 10", 10);
    for (const std::string &here : {style, style + "/kk/device"}) {
      char file[80];    // named by the first rank
      std::snprintf(file, sizeof file, "test_%d.restart", getpid());
      MPI_Bcast(file, sizeof file, MPI_CHAR, 0, MPI_COMM_WORLD);
      {
        LammpsSession lmp(MPI_COMM_WORLD, kokkos_options(kokkos_machines[0]));
        lmp.script(sorting + fix_of(here) + "\nrun 10\nwrite_restart " + file);
      }
      const Trajectory broken =
          trajectory(kokkos_options(kokkos_machines[0]),
                     "read_restart " + std::string(file) + "\n" + settings, fix_of(here), 10);
      EXPECT_LT(largest_difference(broken.end, unbroken.end), 1e-9) << here;
      MPI_Barrier(MPI_COMM_WORLD);
      std::remove(file);
    }
  }
}
