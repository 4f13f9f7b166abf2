// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/fib/kk and fix bd/pse/kk have the same trajectories as the plain styles, on the same ranks
// in one process.  BDH_TEST_THREADS is the number of threads of each rank.

#include "kokkos/kokkos_trajectories.h"
#include "lammps/lammps_mobility.h"

#include "comm.h"

using namespace bdh_test;

namespace {

std::string options(const std::string &newton_and_lists)
{
  return kokkos_options(newton_and_lists);
}

const std::vector<std::string> &machines = kokkos_machines;

const int threads =
    std::getenv("BDH_TEST_THREADS") ? std::atoi(std::getenv("BDH_TEST_THREADS")) : 1;

std::vector<double> run(const std::string &options, const std::string &scene,
                        const std::string &fix, int steps, const std::string &expected_style = "")
{
  return trajectory(options, scene, fix, steps, expected_style).end;
}

// Round-off of 1e-16 (1e-7 in single precision) grows through the steps; a wrong or missing
// contribution is at least 1e-2.
void expect_same(const std::string &fix, const std::string &style, double bound,
                 const std::string &scene = lattice_suspension, int steps = 20)
{
  const std::vector<double> plain = run("", scene, fix, steps, style);
  for (const std::string &m : machines)
    EXPECT_LT(largest_difference(run(options(m), scene, fix, steps, style + "/kk"), plain), bound)
        << fix << ", " << m;
}

/// A box of 8^dim with particles on a lattice, which the walls repel.  boundary: the arguments of
/// LAMMPS' command of that name
std::string walled_suspension(const std::string &boundary, int dim = 3)
{
  std::string walls;
  for (int d = 0; d < dim; ++d)
    for (const char *end : {"lo", "hi"})
      if (boundary[2 * d] == 'f') walls += std::string(" ") + "xyz"[d] + end + " EDGE 50.0 1.0 1.2";
  return "units lj\natom_style atomic\natom_modify map array\ndimension " + std::to_string(dim) +
         "\nboundary " + boundary +
         (dim == 3
              ? "\nlattice sc 0.421875 origin 0.5 0.5 0.5\nregion box block 0 8 0 8 0 8 units box"
              : "\nlattice sq 0.5625 origin 0.5 0.5 0\nregion box block 0 8 0 8 -0.5 0.5 units "
                "box") +
         "\ncreate_box 1 box\ncreate_atoms 1 box\nmass 1 1.0\n"
         "pair_style lj/cut 1.5\npair_coeff 1 1 1.0 1.0\nneighbor 0.4 bin\nneigh_modify every 1 "
         "delay 0 check yes\n"
         "fix walls all wall/harmonic" +
         walls + "\ntimestep 0.002\n";
}

/// 200 particles without forces, with steps so long that some of them cross a wall.
const char *const long_steps = R"(
units lj
atom_style atomic
atom_modify map array
boundary p f p
neigh_modify every 1 delay 0 check yes
comm_modify cutoff 2.0
region box block 0 8 0 8 0 8
create_box 1 box
create_atoms 1 random 200 5 box
mass 1 1.0
timestep 2.0
)";

}    // namespace

TEST(KokkosFixBD, FibPeriodic)
{
  expect_same("fix move all bd/fib 1.0 1.0 4711 grid 16 20 24", "bd/fib", 1e-9);
  expect_same(
      "fix move all bd/fib 1.0 1.0 4711 grid 16 20 24 scheme trapezoidal kernel roma3 shear 0.3",
      "bd/fib", 1e-9);
  expect_same("fix move all bd/fib 1.0 1.0 4711 grid 16 20 24 drift rfd kernel bkp6", "bd/fib",
              1e-9);
}

// The kernels of a GPU, which run on threads here, add up in another order.
TEST(KokkosFixBD, FibOnTheDevice)
{
  const std::string group = "\ngroup some id 1:40\n", fix = "fix move all bd/fib";
  for (const std::string rest :
       {" 1.0 1.0 4711 grid 16 20 24",
        " 1.0 1.0 4711 grid 16 20 24 scheme trapezoidal kernel roma3 shear 0.3",
        " 1.0 1.0 4711 grid 16 20 24 drift rfd kernel bkp6", " 0.0 1.0 4711 grid 16 20 24"}) {
    const std::vector<double> plain = run("", lattice_suspension, fix + rest, 20, "bd/fib");
    for (const std::string &m : machines)
      EXPECT_LT(largest_difference(run(options(m), lattice_suspension, fix + "/kk/device" + rest,
                                       20, "bd/fib/kk/device"),
                                   plain),
                1e-9)
          << rest << ", " << m;
  }
  const std::string some = " 1.0 1.0 4711 grid 16 20 24";
  const std::vector<double> plain =
      run("", lattice_suspension + group, "fix move some bd/fib" + some, 20, "bd/fib");
  EXPECT_LT(largest_difference(run(options(machines[0]), lattice_suspension + group,
                                   "fix move some bd/fib/kk/device" + some, 20),
                               plain),
            1e-9);
}

struct Deck {
  std::string scene, rest;
};

/// Trajectories, crossings and forces on walls on the device are those of the plain style.
void expect_device_same(const std::vector<Deck> &decks, int steps)
{
  for (const Deck &d : decks) {
    const std::vector<double> plain =
        run("", d.scene, "fix move all bd/fib" + d.rest, steps, "bd/fib");
    for (const std::string &m : &d == &decks[0] ? machines : std::vector<std::string>{machines[0]})
      EXPECT_LT(
          largest_difference(run(options(m), d.scene, "fix move all bd/fib/kk/device" + d.rest,
                                 steps, "bd/fib/kk/device"),
                             plain),
          1e-9)
          << d.rest << ", " << m;
  }
}

// Walls on any axis, at rest and moving.  Particles, wall potential and fluid are all on the
// device. The random finite difference divides round-off by delta, so delta is not as small as
// possible.
TEST(KokkosFixBD, SlitOnTheDevice)
{
  expect_device_same(
      {{walled_suspension("p p f"),
        " 1.0 1.0 4711 grid 16 20 24 fft estimate wall zlo noslip wall zhi noslip 0.5 0.3 0"},
       {walled_suspension("f p p"), " 1.0 1.0 4711 grid 16 20 24 fft estimate scheme trapezoidal "
                                    "kernel roma3 force 0.1 0.2 0.3 "
                                    "wall xlo noslip 0 0.3 -0.2 wall xhi slip"},
       {walled_suspension("p f p"), " 1.0 1.0 4711 grid 15 20 21 fft estimate drift rfd delta 1e-4 "
                                    "kernel bkp6 wall ylo slip wall yhi slip"},
       {walled_suspension("p f p", 2),
        " 1.0 1.0 4711 grid 16 20 1 fft estimate wall ylo slip wall yhi noslip 0.5 0 0"},
       {walled_suspension("f p p", 2),
        " 0.0 1.0 4711 grid 16 15 1 fft estimate wall xlo noslip wall xhi noslip"},
       {walled_suspension("f p p"), " 1.0 1.0 4711 grid 16 20 24 fft estimate scheme improved wall "
                                    "xlo noslip 0 0.3 -0.2 wall xhi noslip"}},
      25);
}

// Ducts and closed boxes, at a tolerance for which the round-off of the iterations remains small.
TEST(KokkosFixBD, DuctsAndBoxesOnTheDevice)
{
  const std::string x = " wall xlo noslip wall xhi noslip", y = " wall ylo noslip wall yhi noslip",
                    z = " wall zlo noslip wall zhi noslip";
  expect_device_same(
      {{walled_suspension("f p f"),
        " 1.0 1.0 4711 grid 12 10 16 fft estimate force 0 0.3 0" + x + z},
       {walled_suspension("p f f"), " 1.0 1.0 4711 grid 12 15 12 fft estimate scheme trapezoidal "
                                    "kernel roma3 wall ylo noslip 0.4 0 0.2 wall yhi slip"
                                    " wall zlo slip wall zhi noslip 0 0.3 0"},
       {walled_suspension("f f f"), " 1.0 1.0 4711 grid 12 10 16 fft estimate scheme improved "
                                    "kernel bkp6 wall xlo noslip 0 0.5 -0.4 wall xhi noslip" +
                                        y + z},
       {walled_suspension("f f f"), " 1.0 1.0 4711 grid 12 10 16 fft estimate tolerance 1e-4 wall "
                                    "xlo slip wall xhi slip wall ylo slip wall yhi slip"
                                    " wall zlo slip wall zhi slip"},
       {walled_suspension("f f p", 2), " 1.0 1.0 4711 grid 12 15 1 fft estimate wall xlo noslip "
                                       "wall xhi noslip wall ylo slip wall yhi noslip 0.5 0 0"}},
      15);
}

// In a box that is far too long the pressure does not converge, and the device gives the message of
// the plain style.
TEST(KokkosFixBD, PressureThatDoesNotConvergeOnTheDevice)
{
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks > 1) GTEST_SKIP() << "once is enough for a thousand iterations";
  if (threads > 1) GTEST_SKIP() << "once is enough for a thousand iterations";
  LammpsSession lmp(MPI_COMM_WORLD, options(machines[0]));
  bdh_test::expect_unconverged_pressure(
      lmp.error_of(std::string(bdh_test::long_channel) +
                   "fix move all bd/fib/kk/device 0.0 1.0 7 grid 600 3 1 kernel roma3 fft estimate "
                   "tolerance 1e-14" +
                   bdh_test::channel_walls + "\nrun 1"));
}

TEST(KokkosFixBD, CrossingsOnTheDevice)
{
  const std::string walls =
      " 1.0 1.0 7 grid 8 8 8 fft estimate kernel roma3 wall ylo noslip wall yhi slip scheme ";
  for (const std::string way :
       {"euler crossing reflect", "trapezoidal crossing reflect", "euler crossing redraw"}) {
    const std::vector<double> plain = run("", long_steps, "fix move all bd/fib" + walls + way, 40);
    EXPECT_GT(plain[2 * 3 * 200 + 9], 0.0) << way;    // crossings
    EXPECT_LT(largest_difference(run(options(machines[0]), long_steps,
                                     "fix move all bd/fib/kk/device" + walls + way, 40),
                                 plain),
              1e-9)
        << way;
  }
}

// The same for bd/pse.  In single precision the bound is the effect of another order of summation.
TEST(KokkosFixBD, PseOnTheDevice)
{
  const std::string fix = "fix move all bd/pse";
  for (const auto &rest :
       {std::make_pair(std::string(" 1.0 1.0 4711 radius 0.5 fft estimate precision double"), 1e-9),
        std::make_pair(std::string(" 0.0 1.0 4711 radius 0.5 fft estimate tolerance 1e-6"), 1e-9),
        std::make_pair(std::string(" 1.0 1.0 4711 radius 0.5 fft estimate precision single"),
                       1e-3)}) {
    const std::vector<double> plain = run("", lattice_suspension, fix + rest.first, 20, "bd/pse");
    for (const std::string &m : machines)
      EXPECT_LT(largest_difference(run(options(m), lattice_suspension,
                                       fix + "/kk/device" + rest.first, 20, "bd/pse/kk/device"),
                                   plain),
                rest.second)
          << rest.first << ", " << m;
  }
}

// Keyword parts: six numbers per atom, also for atoms that enter or leave the group.
TEST(KokkosFixBD, PseInPartsOnTheDevice)
{
  const std::string group =
      "region left block 0 4 INF INF INF INF\ngroup some dynamic all region left every 1\n";
  for (const std::string temperature : {"0.0", "1.0"}) {
    const auto parts = [&](const std::string &options, const std::string &style) {
      LammpsSession lmp(MPI_COMM_WORLD, options);
      lmp.script(lattice_suspension);
      lmp.script("displace_atoms all random 0.3 0.3 0.3 5\n" + group + "fix move some " + style +
                 " " + temperature +
                 " 1.0 4711 radius 0.5 fft estimate precision double parts yes\nrun 20");
      return lmp.per_atom("move", 6);
    };
    const std::vector<double> plain = parts("", "bd/pse");
    EXPECT_GT(length_of(plain), 0.0);
    for (const std::string &m : machines)
      EXPECT_LT(largest_difference(parts(options(m), "bd/pse/kk/device"), plain), 1e-9)
          << temperature << ", " << m;
  }
}

// Keyword check: the errors are measured with the kernels of the device, in every run and for a
// group that has changed.  They equal those of the plain style to the two digits printed.
TEST(KokkosFixBD, CheckOnTheDevice)
{
  const auto errors = [&](const std::string &options, const std::string &style,
                          const std::string &rest) {
    LammpsSession lmp(MPI_COMM_WORLD, options);
    lmp.script(lattice_suspension);
    lmp.script("displace_atoms all random 0.3 0.3 0.3 5\ngroup some id 1:40\nfix move some " +
               style + " 1.0 1.0 4711 radius 0.5 fft estimate check yes" + rest +
               "\nrun 3\ngroup some id 41:64\nrun 3\ngroup some clear\ngroup some id 20:50\nrun 1");
    std::string found;
    std::istringstream lines(lmp.log());
    for (std::string line; std::getline(lines, line);)
      if (line.compare(0, 8, "  error ") == 0) found += line + "\n";
    // Each check prints two errors of M F and one of the noise; the first rank writes the log.
    EXPECT_EQ(std::count(found.begin(), found.end(), '\n'), lmp->comm->me == 0 ? 9 : 0);
    return found;
  };
  for (const std::string rest : {" precision double", " precision double tolerance 1e-6",
                                 " precision double scheme split substeps 2", ""}) {
    const std::string plain = errors("", "bd/pse", rest);
    EXPECT_EQ(errors(options(machines[0]), "bd/pse/kk/device", rest), plain) << rest;
  }
}

// Each particle has the radius of its atom, with and without hydrodynamic interactions, after lists
// have been built; images of other atoms take the places of ghosts.
TEST(KokkosFixBD, RadiiOnTheDevice)
{
  const std::string scene =
      with(with(lattice_suspension, "atom_style atomic", "atom_style sphere"), "mass 1 1.0",
           "set type 1 diameter 1.0\ngroup large id 1:20\nset group large diameter 1.6");
  for (const std::string rest :
       {" 1.0 1.0 4711 fft estimate precision double radius atom",
        " 1.0 1.0 4711 fft estimate precision double radius atom hydrodynamics no"}) {
    const Trajectory plain = trajectory("", scene, "fix move all bd/pse" + rest, 60);
    EXPECT_GT(plain.builds, 3) << rest;
    EXPECT_LT(largest_difference(
                  run(options(machines[0]), scene, "fix move all bd/pse/kk/device" + rest, 60),
                  plain.end),
              1e-8)
        << rest;
  }
}

// A group of some atoms, a dynamic group, and a sheared box.
TEST(KokkosFixBD, PseOnTheDeviceForGroupsAndBoxes)
{
  const std::string rest = " 1.0 1.0 4711 radius 0.5 fft estimate precision double";
  const std::vector<std::pair<std::string, std::string>> scenes = {
      {"group some id 1:40\n", "some"},
      {"region left block 0 4 INF INF INF INF\ngroup some dynamic all region left every 1\n",
       "some"},
      {"change_box all triclinic\nfix flow all deform 1 xy erate 0.5 remap x flip yes\n", "all"}};
  for (const auto &scene : scenes) {
    const std::string start = lattice_suspension + scene.first,
                      fix = "fix move " + scene.second + " bd/pse";
    const std::vector<double> plain = run("", start, fix + rest, 30);
    EXPECT_LT(
        largest_difference(run(options(machines[0]), start, fix + "/kk/device" + rest, 30), plain),
        1e-9)
        << scene.first;
  }
}

// Bonded neighbors, which special_bonds excludes from LAMMPS' lists, interact through the fluid.
TEST(KokkosFixBD, PseOnTheDeviceWithBonds)
{
  const std::string chain = R"(
units lj
atom_style bond
atom_modify map array
boundary p p p
region box block 0 9 0 9 0 9
create_box 1 box bond/types 1 extra/bond/per/atom 2 extra/special/per/atom 6
lattice sc 1.0
region row block 0.9 7.1 3.9 4.1 3.9 4.1
create_atoms 1 region row
mass 1 1.0
pair_style lj/cut 1.12
pair_coeff 1 1 1.0 1.0
neighbor 0.4 bin
special_bonds lj 0.0 0.0 1.0
bond_style harmonic
bond_coeff 1 50.0 1.0
create_bonds many all all 1 0.9 1.1
neigh_modify every 1 delay 0 check yes
timestep 0.001
)";
  const std::string fix = "fix move all bd/pse",
                    rest = " 1.0 1.0 4711 radius 0.5 fft estimate precision double";
  const std::vector<double> plain = run("", chain, fix + rest, 20);
  EXPECT_LT(
      largest_difference(run(options(machines[0]), chain, fix + "/kk/device" + rest, 20), plain),
      1e-9);
}

// Bonded pairs that special_bonds excludes from LAMMPS' lists, in boxes whose half edges are not
// integers: lists of the KOKKOS package contain some of them, see warn_of_rounded_half_box().  The
// reference is a direct Ewald sum.
TEST(KokkosFixBD, PseWithBondsInSmallBoxes)
{
  struct Deck {
    std::string units, box;
    double unit, viscosity, second, xi;    // second: position of the second atom
  };
  for (const Deck &d : {Deck{"si", "block 0 2e-5 0 2e-5 0 2e-5", 1e-6, 1e-3, 3.6, 0.8},
                        Deck{"lj", "block 0 4.2 0 6 0 4.2", 0.4, 1.0, 6.425, 0.4},
                        Deck{"lj", "prism 0 4.2 0 6 0 4.2 1.0 0.5 -0.7", 0.4, 1.0, 6.425, 0.4}}) {
    std::vector<double> force = bdh_test::random_vector(15, 3);
    for (double &f : force) f *= d.viscosity * d.unit * d.unit;
    for (const std::string special : {"0 0 1", "0 1 1", "1 1 1"})
      for (const std::string style : {"bd/pse", "bd/pse/kk/host", "bd/pse/kk/device"})
        for (const std::string &m : style == "bd/pse" ? std::vector<std::string>{""} : machines) {
          LammpsSession lmp(MPI_COMM_WORLD, m.empty() ? m : options(m));
          lmp.script("units " + d.units +
                     "\natom_style bond\natom_modify map array\nboundary p p p\nregion box " +
                     d.box +
                     " units box\ncreate_box 1 box bond/types 1 extra/bond/per/atom 2 "
                     "extra/special/per/atom 4");
          const double x[5][3] = {{1.3, 0.5, 3.0},
                                  {d.second, 0.9, 3.3},
                                  {4.9, 2.1, 2.0},
                                  {2.8, 5.0, 5.5},
                                  {7.4, 1.0, 8.0}};
          for (const auto &at : x) {
            const double scaled[3] = {at[0] * d.unit, at[1] * d.unit, at[2] * d.unit};
            lmp.create_atom(scaled);
          }
          ASSERT_EQ(lmp->atom->natoms, 5);
          lmp.script("mass 1 1.0\nspecial_bonds lj/coul " + special +
                     "\nbond_style zero nocoeff\nbond_coeff *\npair_style zero " +
                     bdh_test::text(d.unit) + "\npair_coeff * *\nneighbor " +
                     bdh_test::text(0.5 * d.unit) +
                     " bin\nneigh_modify every 1 delay 0 check yes\ncomm_modify cutoff " +
                     bdh_test::text(3.0 * d.unit) +
                     "\ncreate_bonds single/bond 1 1 2\ncreate_bonds single/bond 1 2 "
                     "3\ncreate_bonds single/bond 1 3 4\n"
                     "timestep 1e-9");
          bdh_test::GivenForces forces(lmp, force);
          lmp.script("fix move all " + style + " 0.0 " + bdh_test::text(d.viscosity) +
                     " 4711 radius " + bdh_test::text(d.unit) + " fft estimate tolerance 1e-8 xi " +
                     bdh_test::text(d.xi / d.unit));
          const auto exact = bdh_test::exact_velocities(lmp, d.unit, d.viscosity, force);
          lmp.command("run 1");
          EXPECT_LT(bdh_test::relative_error(lmp.velocities(), exact), 2e-8)
              << d.units << ", " << d.box << ", " << special << ", " << style << ", " << m;
        }
  }
}

// A single warning tells what LAMMPS does to the interactions of such pairs.
TEST(KokkosFixBD, WarnsAboutARoundedHalfBox)
{
  const std::string scene = R"(
units lj
atom_style bond
atom_modify map array
boundary p p p
region box block 0 5 0 5.9 0 6
create_box 1 box bond/types 1 extra/bond/per/atom 2 extra/special/per/atom 4
create_atoms 1 single 1.0 0.1 2.5
create_atoms 1 single 1.0 2.5 2.5
mass 1 1.0
bond_style zero nocoeff
bond_coeff *
pair_style lj/cut 2.4
pair_coeff * * 1 1
neighbor 0.1 bin
neigh_modify every 1 delay 0 check yes
create_bonds single/bond 1 1 2
timestep 0.001
)";
  int me = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &me);
  const auto warnings = [&](const std::string &changed, const std::string &fix) {
    LammpsSession lmp(MPI_COMM_WORLD, options(machines[0]));
    lmp.script(changed + fix + "\nrun 1\nrun 1");
    const std::string log = lmp.log(),
                      text = "the KOKKOS package rounds half the box, 2.5, down to 2 ";
    int n = 0;
    for (size_t at = log.find(text); at != std::string::npos; at = log.find(text, at + 1)) ++n;
    return n;
  };
  for (const std::string fix : {"fix move all bd/fib/kk/host 0.0 1.0 1 grid 10 12 12",
                                "fix move all bd/pse/kk/device 0.0 1.0 1 radius 0.5"}) {
    const int once = warnings(scene, fix);
    if (me == 0) {
      EXPECT_EQ(once, 1) << fix;
    }
    EXPECT_EQ(warnings(scene + "special_bonds lj/coul 1 1 1\n", fix), 0) << fix;
    EXPECT_EQ(warnings(with(scene, "lj/cut 2.4", "lj/cut 1.8"), fix), 0) << fix;
    EXPECT_EQ(warnings(with(scene, "0 5 0 5.9", "0 8 0 6"), fix), 0) << fix;
  }
}

// The command group between two runs.  The second one has no setup and so no new neighbor list.
TEST(KokkosFixBD, PseOnTheDeviceForAGroupThatIsChanged)
{
  for (const std::string changed :
       {"group some id 41:64\nrun 1 pre no", "group some clear\ngroup some id 1:20\nrun 1 pre no",
        "group some clear\ngroup some id 25:64\nrun 1 pre no",
        "run 4 pre no every 2 \"group some id 41:64\""})
    for (const std::string rest :
         {" 0.0 1.0 4711 radius 0.5 fft estimate precision double",
          " 1.0 1.0 4711 radius 0.5 fft estimate precision double scheme split substeps 2"}) {
      const auto end = [&](const std::string &options, const std::string &style) {
        LammpsSession lmp(MPI_COMM_WORLD, options);
        lmp.script(lattice_suspension);
        lmp.script("group some id 1:40\nfix push all addforce 1.0 2.0 -1.0\nfix move some " +
                   style + rest + "\nrun 1\n" + changed);
        return lmp.unwrapped_positions();
      };
      EXPECT_LT(
          largest_difference(end(options(machines[0]), "bd/pse/kk/device"), end("", "bd/pse")),
          1e-9)
          << changed << rest;
    }
}

// Steps that are too long are counted and give a warning, and an error beyond half the box.
TEST(KokkosFixBD, LongMovesOnTheDevice)
{
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks > 1) GTEST_SKIP() << "the device is for one process";
  const std::string push = "group one id 17 18\nfix push one addforce ";
  for (const std::string rest :
       {"bd/pse% 1.0 1.0 4711 radius 0.5 precision double",
        "bd/pse% 1.0 1.0 4711 radius 0.5 precision double scheme split substeps 2",
        "bd/fib% 1.0 1.0 4711 grid 16 16 16",
        "bd/fib% 1.0 1.0 4711 grid 16 16 16 scheme improved"}) {
    const std::string start = lattice_suspension +
                              std::string("group one id 17 18\nfix push one addforce "),
                      plain = with(rest, "%", ""), device = with(rest, "%", "/kk/device");
    LammpsSession host(MPI_COMM_WORLD, ""), there(MPI_COMM_WORLD, options(machines[0]));
    host.script(start + "6000.0 0.0 0.0\nfix move all " + plain + "\nrun 1");
    there.script(start + "6000.0 0.0 0.0\nfix move all " + device + "\nrun 1");
    const double counted = host.fix("move")->compute_vector(7);
    EXPECT_GE(counted, 2.0) << rest;
    EXPECT_EQ(there.fix("move")->compute_vector(7), counted) << rest;
    // Compares the atom, the step and the distance.
    const auto said = [](const std::string &text) {
      const size_t at = text.find("atom ");
      return at == std::string::npos ? text : text.substr(at, text.find(" in one step", at) - at);
    };
    const auto warned = [&](LammpsSession &lmp) {
      const std::string log = lmp.log();
      return said(log.substr(MIN(log.find("WARNING: fix bd"), log.size())));
    };
    EXPECT_EQ(warned(there), warned(host));
    EXPECT_NE(warned(there).find("moved by"), std::string::npos) << warned(there);
    LammpsSession far_host(MPI_COMM_WORLD, ""), far_there(MPI_COMM_WORLD, options(machines[0]));
    const std::string message =
        far_there.error_of(start + "50000.0 0.0 0.0\nfix move all " + device + "\nrun 1");
    EXPECT_NE(message.find("which is more than half the box"), std::string::npos)
        << rest << ": " << message;
    EXPECT_EQ(said(message), said(far_host.error_of(start + "50000.0 0.0 0.0\nfix move all " +
                                                    plain + "\nrun 1")));
  }
}

// LAMMPS loses an atom within the step, since it leaves a box that is not periodic.
TEST(KokkosFixBD, LostWithinTheStepOnTheDevice)
{
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks > 1) GTEST_SKIP() << "the device is for one process";
  LammpsSession lmp(MPI_COMM_WORLD, options(machines[0]));
  const std::string slit = with(with(lattice_suspension, "boundary p p p", "boundary p p f"),
                                "lattice sc 0.125", "lattice sc 0.125 origin 0.5 0.5 0.5");
  const std::string message = lmp.error_of(
      slit +
      "group some id 1:63\ngroup rest id 64\nvelocity rest set 0.0 0.0 2000.0\nfix inertia rest "
      "nve\n"
      "fix move some bd/fib/kk/device 1.0 1.0 4711 grid 16 16 16 scheme improved wall zlo noslip "
      "wall zhi noslip\nrun 3");
  EXPECT_NE(message.find("fix bd/fib"), std::string::npos) << message;
  EXPECT_NE(message.find("64 atoms, 63 of them of the group, have become 63 and 63 within step 1"),
            std::string::npos)
      << message;
}

// Grids and particles take as much as in the plain fix; forces within the step add some numbers per
// atom.  Of those, scheme improved of fix bd/fib saves all but the groups elsewhere.
TEST(KokkosFixBD, MemoryOfTheDevice)
{
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  for (const std::string rest :
       {"bd/pse% 1.0 1.0 4711 radius 0.5 xi 4.0", "bd/fib% 1.0 1.0 4711 grid 32 32 32"}) {
    int most = 0;    // atoms for which LAMMPS keeps arrays; newer releases: in large blocks
    const auto bytes = [&](const std::string &options, const std::string &suffix,
                           const std::string &scheme) {
      LammpsSession lmp(MPI_COMM_WORLD, options);
      lmp.script(lattice_suspension + std::string("fix move all ") + with(rest, "%", suffix) +
                 scheme + "\nrun 1");
      most = lmp->atom->nmax;
      return lmp.fix("move")->memory_usage();
    };
    const double plain = bytes("", "", ""), device = bytes(options(machines[0]), "/kk/device", "");
    EXPECT_GT(device, 0.5 * plain) << rest;
    EXPECT_LT(device, 2.0 * plain) << rest;
    if (ranks > 1) continue;    // forces within the step are evaluated on the host
    const bool pse = rest.find("pse") != std::string::npos;
    const double within = bytes(options(machines[0]), "/kk/device",
                                pse ? " scheme split substeps 2" : " scheme improved") -
                          device;
    EXPECT_GE(within, 64 * (pse ? 10 * sizeof(double) : sizeof(int))) << rest;
    EXPECT_LE(within, most < 16384 ? 64 * 2000 : 200 * most) << rest;
  }
}

// On several ranks the device evaluates no forces within the step.
TEST(KokkosFixBD, PlanSaysWhereTheKernelsAre)
{
  int me = 0, ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &me);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const std::string slit = " wall zlo noslip wall zhi noslip", device = "of the device, by Kokkos",
                    host = "on several processes those of the device do not evaluate forces";
  struct Case {
    std::string boundary, rest, place;
  };
  for (const Case &c : {Case{"p p p", "", device}, Case{"p p f", slit, device},
                        Case{"f p f", slit + " wall xlo noslip wall xhi slip", device},
                        Case{"p p p", " scheme improved", ranks > 1 ? host : device},
                        Case{"p p p", " adapt 0.1", ranks > 1 ? host : device}}) {
    LammpsSession lmp(MPI_COMM_WORLD, options(machines[0]));
    lmp.script(with(lattice_suspension, "boundary p p p", "boundary " + c.boundary));
    lmp.script("fix move all bd/fib/kk/device 1.0 1.0 4711 grid 16 20 24" + c.rest + "\nrun 0");
    if (me) continue;
    EXPECT_NE(lmp.log().find(c.place), std::string::npos) << lmp.log();
  }
}

// Errors on the device name the id of the atom.
TEST(KokkosFixBD, DeviceNamesTheAtom)
{
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks > 1) GTEST_SKIP() << "the device is for one process";
  LammpsSession lmp(MPI_COMM_WORLD, options(machines[0]));
  lmp.script(lattice_suspension);
  const std::string message =
      lmp.error_of("fix move all bd/fib/kk/device 1.0 1.0 4711 grid 16 20 24\n"
                   "variable push atom (id==17)*1e300*1e300\n"
                   "group one id 17\nfix push one addforce v_push 0.0 0.0\nrun 1");
  EXPECT_NE(message.find("atom 17 at step"), std::string::npos) << message;
  EXPECT_NE(message.find("not a finite number"), std::string::npos) << message;
  LammpsSession slit(MPI_COMM_WORLD, options(machines[0]));
  slit.script(long_steps);
  const std::string outside = slit.error_of(
      "fix move all bd/fib/kk/device 1.0 1.0 7 grid 8 8 8 fft estimate kernel roma3 scheme euler "
      "wall ylo noslip wall yhi slip\nrun 40");
  EXPECT_NE(outside.find("atom "), std::string::npos) << outside;
  EXPECT_NE(outside.find("it is outside the wall y"), std::string::npos) << outside;
}

TEST(KokkosFixBD, ADeviceHasSlabsOnly)
{
  for (const char *fix : {"bd/fib/kk/device 1.0 1.0 4711 grid 16 20 24",
                          "bd/pse/kk/device 1.0 1.0 4711 radius 1.0"}) {
    LammpsSession lmp(MPI_COMM_WORLD, options(machines[0]));
    lmp.script(lattice_suspension);
    const std::string message = lmp.error_of(std::string("fix move all ") + fix + " pencils 2");
    EXPECT_NE(message.find("pencils = 2, but a device has only slabs"), std::string::npos)
        << message;
    EXPECT_EQ(lmp.error_of(std::string("fix move all ") + fix + " pencils 1\nrun 1"), "");
  }
}

TEST(KokkosFixBD, FibInASlit)
{
  const std::string slit = R"(
units lj
atom_style atomic
atom_modify map array
boundary p p f
region box block 0 8 0 8 0 8
create_box 1 box
lattice sc 0.125 origin 0.5 0.5 0.5
create_atoms 1 box
mass 1 1.0
pair_style lj/cut 1.12
pair_coeff 1 1 1.0 1.0
neighbor 0.4 bin
neigh_modify every 1 delay 0 check yes
timestep 0.002
)";
  expect_same("fix move all bd/fib 1.0 1.0 4711 grid 16 20 24 wall zlo noslip wall zhi noslip "
              "crossing reflect",
              "bd/fib", 1e-9, slit);
}

TEST(KokkosFixBD, PseInBothPrecisions)
{
  const std::string start = "fix move all bd/pse 1.0 1.0 4711 radius 0.5 fft estimate ";
  expect_same(start + "precision double", "bd/pse", 1e-9);
  expect_same(start + "precision double parts yes xi 1.0", "bd/pse", 1e-9);
  expect_same(start + "precision single", "bd/pse", 1e-3);
}

// Pair styles without a /kk variant work on the copies on the host.
TEST(KokkosFixBD, PairStyleWithoutKokkos)
{
  std::string scene = lattice_suspension;
  const std::string pair = "pair_style lj/cut 2.5\npair_coeff 1 1 1.0 1.0";
  scene.replace(scene.find(pair), pair.size(), "pair_style soft 2.5\npair_coeff 1 1 5.0");
  expect_same("fix move all bd/fib 1.0 1.0 4711 grid 16 20 24", "bd/fib", 1e-9, scene);
  expect_same("fix move all bd/pse 1.0 1.0 4711 radius 0.5 precision double", "bd/pse", 1e-9,
              scene);
}

TEST(KokkosFixBD, PlanNamesTheThreads)
{
  LammpsSession lmp(MPI_COMM_WORLD, options(machines[0]));
  lmp.script(lattice_suspension);
  lmp.script("fix move all bd/fib 1.0 1.0 4711 grid 16 20 24\nrun 0");
  int me = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &me);
  if (me) return;
  EXPECT_NE(lmp.log().find(std::to_string(threads) + " threads per process, by Kokkos"),
            std::string::npos);
}
