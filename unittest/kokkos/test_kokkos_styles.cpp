// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// pair asakura/oosawa/kk and fix wall/harmonic/kk compared with the plain styles, in one process
// and on the same ranks.  BDH_TEST_THREADS is the number of threads of each rank.  It is the same
// for all tests, since Kokkos starts only once in a process.

#include "lammps/lammps_session.h"

#include "atom.h"
#include "compute.h"
#include "force.h"
#include "pair.h"

#include <Kokkos_Macros.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

using namespace bdh_test;
using namespace LAMMPS_NS;

namespace {

using Values = std::vector<double>;

// Sums differ in the order of their terms, and terms by one rounding where the compiler fuses other
// multiplications and additions.  The sums have fewer than 100 terms of one sign, so 100 roundings
// of the largest value are an upper bound.
constexpr double ROUND_OFF = 2e-14;

/// One way to run LAMMPS.
struct Machine {
  std::string kokkos;    // arguments of package kokkos; empty: plain styles
  std::string suffix;    // of the styles under test: "", "/kk", "/kk/host", "/kk/device"
  std::string newton;

  std::string options() const
  {
    if (suffix.empty()) return "";
    const char *threads = std::getenv("BDH_TEST_THREADS");
#if defined(KOKKOS_ENABLE_CUDA)
    const std::string where = "g 1 t ";
#else
    const std::string where = "t ";
#endif
    return "-k on " + where + (threads ? threads : "1") + " -sf kk -pk kokkos newton " + newton +
           " " + kokkos;
  }
};

Machine plain(const std::string &newton) { return {"", "", newton}; }

std::vector<Machine> kokkos_machines()
{
  return {{"neigh half", "/kk", "on"},
          {"neigh half", "/kk", "off"},
          {"neigh full", "/kk", "off"},
          {"neigh half", "/kk/device", "on"},
          {"neigh half", "/kk/host", "off"},
          // One thread per neighbor, which LAMMPS chooses for few atoms on a GPU.
          {"neigh full neigh/thread on", "/kk", "off"}};
}

/// Some values of each atom, ordered by atom id, on every rank.  get(i, out) reads local atom i.
template <class Get> Values by_id(LammpsSession &run, int columns, Get get)
{
  const Atom &atom = run.host_atoms();
  Values mine(columns * atom.natoms, 0.0), all(mine.size());
  for (int i = 0; i < atom.nlocal; ++i) get(i, mine.data() + columns * (atom.tag[i] - 1));
  MPI_Allreduce(mine.data(), all.data(), mine.size(), MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return all;
}

Values forces(LammpsSession &run)
{
  return by_id(run, 3, [&](int i, double *out) {
    for (int d = 0; d < 3; ++d) out[d] = run->atom->f[i][d];
  });
}

Compute &compute(LammpsSession &run, const std::string &id)
{
  return *run->modify->compute[run->modify->find_compute(id)];
}

void expect_equal(const Values &a, const Values &b, const char *what)
{
  ASSERT_EQ(a.size(), b.size());
  double scale = 0.0;
  for (double v : b) scale = std::max(scale, std::fabs(v));
  ASSERT_GT(scale, 0.0) << what << ": nothing to compare";
  EXPECT_LE(largest_difference(a, b), ROUND_OFF * scale) << what << ", largest value " << scale;
}

/// Defines computes that collect every sum.  They must exist before the run, so that it tallies for
/// them.
void collect_sums(LammpsSession &run)
{
  run.script(R"(
    compute virial all pressure NULL virial
    compute energy all pe/atom
    compute stress all stress/atom NULL
    compute sums all reduce sum c_energy c_stress[1] c_stress[6]
    thermo_style custom step pe c_virial[1] c_sums[1] c_sums[2] c_sums[3]
    thermo_modify norm no
    thermo 1)");
}

Values energies_and_virials_of_atoms(LammpsSession &run)
{
  return by_id(run, 7, [&](int i, double *out) {
    out[0] = compute(run, "energy").vector_atom[i];
    for (int k = 0; k < 6; ++k) out[1 + k] = compute(run, "stress").array_atom[i][k];
  });
}

Values virial(LammpsSession &run)
{
  const double *v = compute(run, "virial").vector;
  return {v, v + 6};
}

void expect_equal_runs(LammpsSession &kokkos, LammpsSession &reference)
{
  EXPECT_NEAR(compute(kokkos, "thermo_pe").scalar, compute(reference, "thermo_pe").scalar,
              ROUND_OFF * std::fabs(compute(reference, "thermo_pe").scalar));
  expect_equal(forces(kokkos), forces(reference), "forces");
  expect_equal(virial(kokkos), virial(reference), "virial");
  expect_equal(energies_and_virials_of_atoms(kokkos), energies_and_virials_of_atoms(reference),
               "energies and virials of atoms");
}

// ---- pair asakura/oosawa/kk ----

void cluster(LammpsSession &run, const Machine &machine, int types)
{
  run.command("newton " + machine.newton);
  run.script("units lj\natom_modify map array\nregion box block 0 9 0 9 0 9");
  run.command("create_box " + std::to_string(types) + " box");
  for (int t = 1; t <= types; ++t)
    run.command("create_atoms " + std::to_string(t) + " random " + std::to_string(120 / types) +
                " " + std::to_string(4711 + t) + " box");
  run.script("mass * 1.0\nneighbor 0.5 bin");
}

/// Every pair of types has its own c and D.
void set_coefficients(LammpsSession &run, int types, const std::string &sub_style = "")
{
  for (int i = 1; i <= types; ++i)
    for (int j = i; j <= types; ++j)
      run.command("pair_coeff " + std::to_string(i) + " " + std::to_string(j) + " " + sub_style +
                  " direct " + text(0.5 + 0.13 * i + 0.07 * j) + " " +
                  text(2.0 + 0.03 * i + 0.05 * j));
}

void attracting_cluster(LammpsSession &run, const Machine &machine, int types)
{
  cluster(run, machine, types);
  run.command("pair_style asakura/oosawa" + machine.suffix + " 3.5");
  set_coefficients(run, types);
  collect_sums(run);
}

void expect_equal_clusters(int types)
{
  for (const Machine &machine : kokkos_machines()) {
    SCOPED_TRACE(machine.suffix + " " + machine.options());
    LammpsSession kokkos(MPI_COMM_WORLD, machine.options()), reference(MPI_COMM_WORLD, "");
    attracting_cluster(kokkos, machine, types);
    attracting_cluster(reference, plain(machine.newton), types);
    for (LammpsSession *run : {&kokkos, &reference}) run->command("run 0 post no");
    expect_equal_runs(kokkos, reference);
  }
}

TEST(KokkosAsakuraOosawa, EqualsPlain) { expect_equal_clusters(2); }

// More types than fit in the object that LAMMPS copies to the device (MAX_TYPES_STACKPARAMS = 12).
TEST(KokkosAsakuraOosawa, ManyTypes) { expect_equal_clusters(13); }

// Together with a sub-style with /kk and with one without.
TEST(KokkosAsakuraOosawa, Overlay)
{
  for (const std::string core : {"lj/cut 2.5", "soft 2.2"})
    for (const Machine &machine : kokkos_machines()) {
      SCOPED_TRACE(core + " " + machine.options());
      LammpsSession kokkos(MPI_COMM_WORLD, machine.options()), reference(MPI_COMM_WORLD, "");
      for (LammpsSession *run : {&kokkos, &reference}) {
        const Machine here = run == &kokkos ? machine : plain(machine.newton);
        cluster(*run, here, 2);
        run->command("pair_style hybrid/overlay asakura/oosawa" + here.suffix + " 3.5 " + core);
        set_coefficients(*run, 2, "asakura/oosawa" + here.suffix);
        run->command(core[0] == 's' ? "pair_coeff * * soft 3.0" : "pair_coeff * * lj/cut 1e-6 0.3");
        collect_sums(*run);
        run->command("run 0 post no");
      }
      expect_equal_runs(kokkos, reference);
    }
}

// New c and D reach the device.
TEST(KokkosAsakuraOosawa, FixAdapt)
{
  for (const Machine &machine : kokkos_machines()) {
    SCOPED_TRACE(machine.options());
    LammpsSession kokkos(MPI_COMM_WORLD, machine.options()), reference(MPI_COMM_WORLD, "");
    attracting_cluster(kokkos, machine, 2);
    attracting_cluster(reference, plain(machine.newton), 2);
    double energy = 0.0;
    for (LammpsSession *run : {&kokkos, &reference}) {
      run->command("run 0 post no");
      energy = compute(*run, "thermo_pe").scalar;
      const std::string style = " pair asakura/oosawa" + (run == &kokkos ? machine.suffix : "");
      run->script("variable c equal 1.0+0.5*step\nvariable D equal 2.2+0.2*step");
      run->command("fix adapt all adapt 1" + style + " c 1 2 v_c" + style + " D 1*2 2 v_D");
      run->command("run 3 post no");
    }
    expect_equal_runs(kokkos, reference);
    EXPECT_GT(std::fabs(compute(reference, "thermo_pe").scalar - energy), 0.01 * std::fabs(energy));
  }
}

// ---- fix wall/harmonic/kk, where LAMMPS has none of its own ----

#ifdef BDH_BACKPORTS

void slit(LammpsSession &run, const Machine &machine, double lower = 0.0)
{
  run.command("newton " + machine.newton);
  run.script(R"(
    units lj
    atom_modify map array
    boundary p f p
    region box block 0 6 0 5 0 4
    create_box 2 box
    create_atoms 1 random 60 4711 box
    create_atoms 2 random 20 4712 box
    mass * 1.0
    group first type 1
    neighbor 0.5 bin
    pair_style zero 1.0
    pair_coeff * *
    comm_modify cutoff 1.5
    variable stiff equal 30.0+step
    variable upper equal 5.2+0.01*step)");
  run.command("fix walls first wall/harmonic" + machine.suffix + " ylo " + text(lower) +
              " v_stiff 1.0 1.1 yhi v_upper 20.0 1.0 1.4 units box");
  run.command("fix_modify walls energy yes virial yes");
  collect_sums(run);
}

Values fix_output(LammpsSession &run)
{
  return {run.fix("walls")->compute_scalar(), run.fix("walls")->compute_vector(0),
          run.fix("walls")->compute_vector(1)};
}

TEST(KokkosWallHarmonic, EqualsPlain)
{
  for (const Machine &machine : kokkos_machines()) {
    SCOPED_TRACE(machine.suffix + " " + machine.options());
    LammpsSession kokkos(MPI_COMM_WORLD, machine.options()), reference(MPI_COMM_WORLD, "");
    slit(kokkos, machine);
    slit(reference, plain(machine.newton));
    for (LammpsSession *run : {&kokkos, &reference}) run->command("run 2 post no");
    expect_equal_runs(kokkos, reference);
    expect_equal(fix_output(kokkos), fix_output(reference), "energy, forces on the walls");
    EXPECT_LT(fix_output(kokkos)[1] * fix_output(kokkos)[2], 0.0) << "the walls are pushed apart";
  }
}

TEST(KokkosWallHarmonic, NamesAtomBehindWall)
{
  LammpsSession kokkos(MPI_COMM_SELF, kokkos_machines()[0].options());
  slit(kokkos, kokkos_machines()[0]);
  kokkos.command("set atom 7 y 0.0");
  EXPECT_NE(
      kokkos.error_of("run 0").find("Particle on or inside fix wall surface: atom 7 at step 0"),
      std::string::npos);
}

// In this case all ids are 0.
TEST(KokkosWallHarmonic, StopsForAtomsWithoutIds)
{
  LammpsSession kokkos(MPI_COMM_SELF, kokkos_machines()[0].options());
  kokkos.script(R"(
    atom_modify id no
    boundary p p f
    region box block 0 8 0 8 0 8
    create_box 1 box
    create_atoms 1 single 1 1 0
    mass 1 1.0
    fix walls all wall/harmonic zlo EDGE 10 1 2 zhi EDGE 10 1 2)");
  EXPECT_NE(kokkos.error_of("run 0").find("Particle on or inside fix wall surface"),
            std::string::npos);
}

#endif

}    // namespace
