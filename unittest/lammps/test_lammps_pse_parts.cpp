// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Parts of fix bd/pse on their own: what it keeps in restart files, how far it asks for ghosts, and
// the limits that it finds for a plan.

#include "lammps/lammps_session.h"

#include "bdh_conditions.h"
#include "bdh_ghost_cutoff.h"
#include "bdh_pse_restart.h"
#include "bdh_scene.h"
#include "comm.h"
#include "group.h"
#include "neighbor.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

using bdh_test::LammpsSession;
using LAMMPS_NS::GhostCutoff;
using LAMMPS_NS::PseRestart;

namespace {

/// Everything that a restart file has to keep; each number differs from that of a new object.
PseRestart an_example()
{
  PseRestart r;
  bdh::PsePlan &p = r.plan;
  p.radius = 1.5, p.least_radius = 1.125, p.rotation = true, p.volume = 7.0;
  p.tolerance = 2e-4, p.root_tolerance = 1e-4, p.xi = 0.7;
  p.r_cut = 4.5, p.k_cut = 6.5, p.spacing = 0.25, p.n = {20, 24, 30};
  p.window.width = bdh::Window::least + 1, p.window.beta = 9.5;
  p.window_error = 3e-5, p.table_error = 4e-5, p.single = true;
  p.errors = {0.1, 0.2, 0.3, 0.4};
  p.neighbors = 11.0, p.most_neighbors = 22.0, p.modes = 33.0, p.iterations = 5;
  p.real_seconds = 0.01, p.wave_seconds = 0.02, p.grid_bytes = 1e6, p.pair_bytes = 2e6;
  p.limit = bdh::PseLimit::memory;
  bdh::PseScene &s = r.made_for;
  s.volume = 8.0, s.edge = {1.5, 2.5, 3.5}, s.particles = 77, s.radius = 1.25, s.noise = false;
  s.least_radius = 0.875, s.mean_cube = 0.625, s.rotation = true;
  s.classes = {{5.0, 15.0, 25.0, 35.0}, {0.9, 1.0, 1.1, 1.2}, 45.0};
  s.tolerance = 5e-4, s.xi = 0.9, s.substeps = 3, s.largest_cutoff = 6.0;
  s.precision = bdh::Precision::double_precision;
  r.split_price = 0.75;
  r.narrow = true;
  return r;
}

std::vector<double> numbers_of(const PseRestart &r)
{
  const bdh::PsePlan &p = r.plan;
  const bdh::PseScene &s = r.made_for;
  const bdh::PseErrors &e = p.errors;
  std::vector<double> all = {
      p.radius,       p.least_radius, p.volume,         p.tolerance,    p.root_tolerance,
      p.xi,           p.r_cut,        p.k_cut,          p.spacing,      p.window.beta,
      p.window_error, p.table_error,  e.real_space,     e.wave_space,   e.window,
      e.rounding,     p.neighbors,    p.most_neighbors, p.modes,        p.real_seconds,
      p.wave_seconds, p.grid_bytes,   p.pair_bytes,     s.volume,       s.edge[0],
      s.edge[1],      s.edge[2],      s.radius,         s.least_radius, s.mean_cube,
      s.tolerance,    s.xi,           s.largest_cutoff, r.split_price};
  for (const long n : {p.n[0], p.n[1], p.n[2], long(p.window.width), long(p.iterations),
                       long(p.limit), long(s.particles), long(s.substeps), long(s.precision),
                       long(p.single), long(p.hydrodynamics), long(s.hydrodynamics), long(s.noise),
                       long(r.narrow), long(p.rotation), long(s.rotation)})
    all.push_back(n);
  for (int k = 0; k < bdh::radius_classes; ++k)
    all.insert(all.end(), {s.classes.count[k], s.classes.greatest[k]});
  all.push_back(s.classes.between);
  return all;
}

std::vector<double> read_again(const std::vector<char> &bytes)
{
  PseRestart read;
  return LAMMPS_NS::from_bytes(bytes.data(), bytes.size(), read) ? numbers_of(read)
                                                                 : std::vector<double>();
}

/// Atoms in a box that is not a cube, without a pair style.
const char *const few_atoms = "units lj\natom_style atomic\natom_modify map array\n"
                              "region box block 0 14 0 13 0 12\ncreate_box 1 box\n"
                              "create_atoms 1 random 60 987 box\nmass 1 1.0\nneighbor 0.5 bin\n"
                              "group few id 1:20\n";

}    // namespace

TEST(PseRestart, KeepsEveryNumber)
{
  PseRestart r = an_example();
  EXPECT_EQ(read_again(bytes_of(r)), numbers_of(r));
  r.plan.hydrodynamics = r.made_for.hydrodynamics = false;
  EXPECT_EQ(read_again(bytes_of(r)), numbers_of(r));
}

TEST(PseRestart, RefusesOtherVersionsAndLengths)
{
  const std::vector<char> right = bytes_of(an_example());
  std::vector<char> bytes = right;
  int version = 0;
  std::memcpy(&version, bytes.data(), sizeof version);
  for (const int other : {version - 1, version + 1}) {
    std::memcpy(bytes.data(), &other, sizeof other);
    EXPECT_TRUE(read_again(bytes).empty()) << other;
  }
  bytes = right;
  bytes.push_back(0);
  EXPECT_TRUE(read_again(bytes).empty());
  bytes.resize(right.size() - 1);
  EXPECT_TRUE(read_again(bytes).empty());
}

TEST(PseRestart, RefusesNumbersThatAreNoPlan)
{
  const auto refused = [](auto spoil) {
    PseRestart r = an_example();
    spoil(r.plan);
    return read_again(bytes_of(r)).empty();
  };
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(refused([](bdh::PsePlan &) {}));
  EXPECT_TRUE(refused([](bdh::PsePlan &p) { p.radius = 0.0; }));
  EXPECT_TRUE(refused([](bdh::PsePlan &p) { p.xi = std::nan(""); }));
  EXPECT_TRUE(refused([=](bdh::PsePlan &p) { p.xi = infinite; }));
  EXPECT_TRUE(refused([=](bdh::PsePlan &p) { p.r_cut = infinite; }));
  EXPECT_TRUE(refused([](bdh::PsePlan &p) { p.r_cut = -1.0; }));
  EXPECT_TRUE(refused([](bdh::PsePlan &p) { p.spacing = 0.0; }));
  EXPECT_TRUE(refused([](bdh::PsePlan &p) { p.n[1] = 0; }));
  EXPECT_TRUE(
      refused([](bdh::PsePlan &p) { p.window.width = bdh::Window::greatest(p.single) + 1; }));
}

TEST(GhostCutoff, RaisesTheValueOfOthersAndRestoresIt)
{
  LammpsSession lmp;
  lmp.script(few_atoms);
  GhostCutoff cutoff(lmp.operator->());
  lmp->comm->cutghostuser = 5.0;
  cutoff.reach(3.0);    // others already ask for more
  EXPECT_EQ(lmp->comm->cutghostuser, 5.0);
  EXPECT_EQ(cutoff.note(), "");
  cutoff.reach(7.0);
  EXPECT_EQ(lmp->comm->cutghostuser, 7.0);
  EXPECT_NE(cutoff.note().find("ask for 5)"), std::string::npos) << cutoff.note();
  cutoff.reach(4.0);
  EXPECT_EQ(lmp->comm->cutghostuser, 5.0);
  cutoff.reach(7.0);
  lmp->comm->cutghostuser = 6.0;    // another value by comm_modify
  cutoff.reach(4.0);
  EXPECT_EQ(lmp->comm->cutghostuser, 6.0);
}

TEST(GhostCutoff, EndsWithTheFix)
{
  LammpsSession lmp;
  lmp.script(few_atoms);
  const char *const fix = "bd/pse 1 1 5 radius 0.5 xi 0.8\n";
  lmp.script(std::string("comm_modify cutoff 1.5\nfix one few ") + fix + "run 0\n");
  EXPECT_GT(lmp->comm->cutghostuser, 2.0);
  lmp.script("unfix one\n");
  EXPECT_EQ(lmp->comm->cutghostuser, 1.5);
  lmp.script(std::string("group rest subtract all few\nfix one few ") + fix +
             "fix two rest bd/pse 1 1 6 radius 0.5 xi 0.8\nrun 0\n");
  const double both = lmp->comm->cutghostuser;
  lmp.script("unfix one\n");    // a run with pre no may follow, in which the other one needs ghosts
  EXPECT_EQ(lmp->comm->cutghostuser, both);
}

TEST(GhostCutoff, IsShortenedToWhatOthersAskFor)
{
  LammpsSession lmp;
  lmp.script(few_atoms);
  lmp.script("fix one few bd/pse 1 1 5 radius 0.5\n");
  GhostCutoff cutoff(lmp.operator->());
  lmp->comm->cutghostuser = 5.0;
  cutoff.reach(7.0);
  cutoff.shorten(6.0);
  EXPECT_EQ(lmp->comm->cutghostuser, 6.0);
  cutoff.shorten(3.0);
  EXPECT_EQ(lmp->comm->cutghostuser, 5.0);
  cutoff.reach(7.0);
  lmp->comm->cutghostuser = 9.0;    // another style has raised it further
  cutoff.shorten(3.0);
  EXPECT_EQ(lmp->comm->cutghostuser, 9.0);
}

TEST(GhostCutoff, IsNotShortenedBesideAnotherFix)
{
  LammpsSession lmp;
  lmp.script(few_atoms);
  lmp.script("group rest subtract all few\nfix one few bd/pse 1 1 5 radius 0.5\n"
             "fix two rest brownian/pse 1 1 6 radius 0.5\n");
  GhostCutoff cutoff(lmp.operator->());
  cutoff.reach(7.0);
  cutoff.shorten(3.0);
  EXPECT_EQ(lmp->comm->cutghostuser, 7.0);
}

// With comm_style tiled ghosts are kept up to the shortest edge, less the skin.
TEST(PseConditions, LongestCutoffOfTiledDomains)
{
  LammpsSession lmp;
  lmp.script(few_atoms);
  const auto longest = [&](double lx, double ly, double lz) {
    bdh::Cell cell;
    cell.lx = lx, cell.ly = ly, cell.lz = lz;
    return LAMMPS_NS::longest_cutoff(lmp.operator->(), cell);
  };
  EXPECT_EQ(longest(14.0, 13.0, 12.0), 0.0);    // no limit
  lmp.script("comm_style tiled");
  lmp->neighbor->skin = 0.5;
  EXPECT_NEAR(longest(14.0, 13.0, 12.0), 11.5, 1e-6);
  EXPECT_NEAR(longest(13.0, 12.0, 14.0), 11.5, 1e-6);
  EXPECT_NEAR(longest(12.0, 14.0, 13.0), 11.5, 1e-6);
  EXPECT_GT(longest(0.4, 1.0, 1.0), 0.0);    // none is possible, which is not the same as no limit
  EXPECT_LT(longest(0.4, 1.0, 1.0), 1e-6);
}

// Other atoms have no part in how crowded the group is.
TEST(PseConditions, CountTheGroupOnly)
{
  LammpsSession lmp;
  lmp.script(few_atoms);
  const auto conditions = [&](const char *group) {
    return LAMMPS_NS::conditions_now(lmp.operator->(), lmp->group->bitmask[lmp->group->find(group)],
                                     1.0, LAMMPS_NS::cell_now(*lmp->domain));
  };
  const bdh::PseConditions all = conditions("all"), few = conditions("few");
  lmp.script("group rest subtract all few\ndelete_atoms group rest compress no\n");
  const bdh::PseConditions alone = conditions("all");
  ASSERT_FALSE(few.counts.empty());
  EXPECT_EQ(few.counts.mean, alone.counts.mean);
  EXPECT_EQ(few.counts.largest, alone.counts.largest);
  EXPECT_NE(few.counts.mean, all.counts.mean);
}

// LAMMPS' neighbor lists and the machine's memory are finite.
TEST(PseConditions, LimitsOfLammpsAndTheMachine)
{
  LammpsSession lmp;
  lmp.script(few_atoms);
  const bdh::PseConditions c =
      LAMMPS_NS::conditions_now(lmp.operator->(), 1, 1.0, LAMMPS_NS::cell_now(*lmp->domain));
  const double machine = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
  EXPECT_GT(c.memory, 0.5 * machine);
  EXPECT_LT(c.memory, machine);
  EXPECT_LE(c.most_neighbors, 0.1 * std::numeric_limits<int>::max());    // ten fit into a page
  EXPECT_EQ(c.skin, lmp->neighbor->skin);
}
