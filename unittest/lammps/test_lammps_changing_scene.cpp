// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Changes that other commands make during a run: radii, number and group of the particles, the box,
// other integrators.  Either the velocities of every step agree with M F by direct Ewald sums for
// the current particles, or the run ends with a message that names the atom.

#include "lammps/lammps_mobility_watch.h"
#include "lammps/lammps_scenes.h"

#include "comm.h"

#include <gtest/gtest.h>

using bdh_test::LammpsSession;

namespace {

/// Spheres of radius 0.5 in a cube of edge 20.
const char *const spheres = R"(
units lj
atom_style sphere
atom_modify map array
region box block 0 20 0 20 0 20
create_box 1 box
pair_style none
neighbor 1.0 bin
neigh_modify every 1 delay 0 check yes
timestep 1e-3
)";
/// For fix adapt; empty with the KOKKOS package, which does not support spheres that grow.
std::string growing_spheres()
{
  if (LammpsSession()->kokkos) return "";
  const std::string fixed = "atom_style sphere", text = spheres;
  const size_t end = text.find(fixed) + fixed.size();
  return text.substr(0, end) + " 1" + text.substr(end);
}
const char *const forty = "create_atoms 1 random 40 987 box\nset group all diameter 1.0\n";

bool has_style(LammpsSession &lmp, const char *name)
{
  return lmp->modify->fix_map->find(name) != lmp->modify->fix_map->end();
}

void expect_words(const std::string &text, const std::vector<std::string> &words)
{
  for (const std::string &w : words) EXPECT_NE(text.find(w), std::string::npos) << text;
}

/// Scene, a watch over the group with forces that differ from atom to atom, and the fix.
void begin(LammpsSession &lmp, const std::string &scene, const std::string &group,
           const std::string &fix, const std::string &radius = "0")
{
  bdh_test::add_mobility_watch(lmp);
  lmp.script(scene + "variable fx atom sin(7*id)\nvariable fy atom cos(5*id)\n" +
             "variable fz atom sin(3*id+1)\nfix push all addforce v_fx v_fy v_fz\n" + "fix watch " +
             group + " bdh/watch " + radius + " 1.0\n" + fix);
}

/// Runs the script, and expects correct velocities in at least this number of steps.  Returns the
/// largest number of particles in a step.
size_t expect_right(LammpsSession &lmp, const std::string &script, int steps, double tolerance)
{
  EXPECT_EQ(lmp.error_of(script), "");
  const bdh_test::FixStepWatch &watch = bdh_test::mobility_watch(lmp, "watch");
  EXPECT_GE(watch.steps, steps);
  EXPECT_LT(watch.worst, tolerance) << script;
  return watch.most_particles;
}

const char *const move = "fix move all bd/pse 0 1 123 tolerance 1e-5 fft estimate\n";

}    // namespace

TEST(ChangingScene, SpheresAreDepositedIntoAnEmptyGroup)
{
  LammpsSession lmp;
  if (!has_style(lmp, "deposit")) GTEST_SKIP() << "without package MISC";
  begin(lmp, std::string(spheres) + "group sp type 1\nregion r block 1 19 1 19 1 19\n", "sp",
        "fix move sp bd/pse 0 1 123 tolerance 1e-5 fft estimate\n");
  const size_t most =
      expect_right(lmp, "fix dep sp deposit 30 1 2 4567 region r near 0.5\nrun 80", 70, 1e-5);
  EXPECT_EQ(most, 30u);
  expect_words(lmp.log(), {"waits", "the plan is made, since the group has its first particles",
                           "the plan is made again, since the group has"});
}

TEST(ChangingScene, FixedRadiusOfAnEmptyGroup)
{
  LammpsSession lmp;
  begin(lmp, std::string(spheres) + forty + "group few empty\n", "few",
        "fix move few bd/pse 0 1 123 radius 0.5 tolerance 1e-5 fft estimate\n", "0.5");
  expect_right(lmp, "run 2\ngroup few id 1:20\nrun 3\ngroup few clear\nrun 2\n", 3, 1e-5);
}

TEST(ChangingScene, DynamicGroupThatIsEmptyAtFirst)
{
  LammpsSession lmp;
  begin(lmp,
        std::string(spheres) + forty +
            "variable in atom (step>=3)*(x<10)\ngroup dyn dynamic all var in every 1\n",
        "dyn", "fix move dyn bd/pse 0 1 123 tolerance 1e-5 fft estimate\n");
  EXPECT_GT(expect_right(lmp, "run 10", 6, 1e-5), 10u);
  expect_words(lmp.log(), {"waits", "since the group has its first particles"});
}

TEST(ChangingScene, EvaporationLeavesAnEmptyGroup)
{
  LammpsSession lmp;
  if (!has_style(lmp, "evaporate")) GTEST_SKIP() << "without package MISC";
  begin(lmp, std::string(spheres) + forty, "all", move);
  expect_right(lmp, "fix gone all evaporate 1 9 box 4949\nrun 10", 3, 1e-5);
  EXPECT_EQ(lmp->atom->natoms, 0);
}

TEST(ChangingScene, RadiiGrowAndShrink)
{
  if (growing_spheres().empty()) GTEST_SKIP();
  for (const char *ramp : {"ramp(1.0,3.0)", "ramp(1.0,0.3)"}) {
    LammpsSession lmp;
    begin(lmp, growing_spheres() + forty, "all", move);
    lmp.script(std::string("variable D equal ") + ramp +
               "\nfix swell all adapt 1 atom diameter v_D\n");
    expect_right(lmp, "run 12", 12, 1e-5);
    expect_words(lmp.log(), {"the plan is made again, since the radius has changed"});
  }
}

TEST(ChangingScene, RadiiThatAreSetBetweenPartsOfARun)
{
  LammpsSession lmp;
  begin(lmp, std::string(spheres) + forty, "all", move);
  expect_right(lmp, "run 6 every 2 \"set group all diameter 1.7\"", 4, 1e-5);
  EXPECT_EQ(lmp.fix("move")->compute_vector(3), 0.85);
}

// From equal radii to unequal ones within a run.
TEST(ChangingScene, OneRadiusChanges)
{
  if (growing_spheres().empty()) GTEST_SKIP();
  LammpsSession lmp;
  lmp.script(growing_spheres() + forty + move);
  lmp.script("group one id 7\nvariable D equal 1+0.1*(step>3)\n"
             "fix swell one adapt 1 atom diameter v_D\n");
  EXPECT_EQ(lmp.error_of("run 10"), "");
  expect_words(lmp.log(), {"step 5: the plan is made again, since the radii have changed"});
}

TEST(ChangingScene, DepositOfAnotherRadius)
{
  LammpsSession lmp;
  if (!has_style(lmp, "deposit")) GTEST_SKIP() << "without package MISC";
  lmp.script(std::string(spheres) + forty + "set group all diameter 2.0\n" + move);
  lmp.script("region r block 1 19 1 19 1 19\n"
             "fix dep all deposit 1 1 3 4567 region r near 0.5\n");
  EXPECT_EQ(lmp.error_of("run 10"), "");
  expect_words(lmp.log(), {"the plan is made again, since the group has 41 particles"});
}

TEST(ChangingScene, AnotherIntegratorGetsAtomsOfTheGroup)
{
  for (const char *rest : {"bd/pse 0 1 123 fft estimate", "bd/fib 0 1 123 grid 16 16 16"}) {
    LammpsSession lmp;
    lmp.script(std::string(spheres) + forty);
    lmp.script(std::string("group mine id 1:20\nfix move mine ") + rest +
               "\nvariable in atom ((id>20)&&(id<31))||((id==13)&&(step>4))\n"
               "group dyn dynamic all var in every 1\nfix other dyn nve\n"
               "group last id 31:40\nfix third last nve\n");
    expect_words(lmp.error_of("run 10"),
                 {"atom 13 is also integrated by fix other nve", " at step 6", "keep the groups"});
  }
}

TEST(ChangingScene, IntegratorsOfOtherAtoms)
{
  LammpsSession lmp;
  begin(lmp, std::string(spheres) + forty + "group a id 1:20\ngroup b id 21:40\n", "a",
        "fix other b nve\nfix move a bd/pse 0 1 123 tolerance 1e-5 fft estimate\n");
  expect_right(lmp, "run 5", 5, 1e-5);
}

// From a volume fraction of 0.003 to 0.3, each plan meets the tolerance wherever it is used.
TEST(ChangingScene, TheBoxShrinks)
{
  for (const char *keywords : {"", "xi 0.6 "}) {
    LammpsSession lmp;
    begin(lmp, std::string(spheres) + forty, "all",
          std::string("fix move all bd/pse 0 1 123 tolerance 1e-5 fft estimate ") + keywords +
              "\nfix shrink all deform 1 x final 0 4.4 y final 0 4.4 z final 0 4.4 remap x\n");
    expect_right(lmp, "run 60", 60, 1e-5);
    if (*keywords) continue;
    expect_words(lmp.log(), {"the plan is made again, since the volume is"});
    // Another splitting has shortened the list within the run; the cutoff was 18 at its beginning.
    EXPECT_LT(lmp->comm->cutghostuser, 7.0);
  }
}

TEST(ChangingScene, AtomsAreAddedBetweenRuns)
{
  LammpsSession lmp;
  begin(lmp, std::string(spheres) + "create_atoms 1 random 3 987 box\nset group all diameter 1.0\n",
        "all", move);
  const char *more = "run 2\ncreate_atoms 1 random 60 55 box\nset group all diameter 1.0\nrun 2";
  EXPECT_EQ(expect_right(lmp, more, 4, 1e-5), 63u);
}

namespace {

const char *const eighty_large = "create_atoms 1 random 80 987 box\nset group all diameter 2.0\n";

/// Grid spacing of the plan after the script, which begins with the fix.
double spacing_after(const std::string &script)
{
  LammpsSession lmp;
  lmp.script(std::string(spheres) + eighty_large + script);
  return lmp.fix("move")->compute_vector(4);
}

}    // namespace

// In a box of more than twice the volume, and with noise where there was none, another plan is
// cheaper.
TEST(ChangingScene, ThePlanSuitsTheNextRun)
{
  const std::string cold = "fix move all bd/pse 0 1 123 tolerance 1e-3 precision double\n",
                    hot = "fix move all bd/pse 1 1 123 tolerance 1e-3 precision double\n",
                    expand = "change_box all x final 0 29 y final 0 29 z final 0 29 remap units "
                             "box\n";
  EXPECT_NE(spacing_after(cold + "run 0\n"), spacing_after(expand + cold + "run 0\n"));
  EXPECT_EQ(spacing_after(cold + "run 0\n" + expand + "run 0\n"),
            spacing_after(expand + cold + "run 0\n"));
  LammpsSession lmp;
  lmp.script(std::string(spheres) + eighty_large + cold + "run 0\n");
  int dim = -1;
  *static_cast<double *>(lmp.fix("move")->extract("temperature", dim)) = 1.0;
  const double before = lmp.fix("move")->compute_vector(4);
  lmp.command("run 0");
  EXPECT_EQ(lmp.fix("move")->compute_vector(4), spacing_after(hot + "run 0\n"));
  EXPECT_NE(lmp.fix("move")->compute_vector(4), before);
}

// The check after a change of the plan compares with a solve for the scene as it is now.
TEST(ChangingScene, TheNextCheckIsOfTheNewPlan)
{
  if (growing_spheres().empty()) GTEST_SKIP();
  LammpsSession lmp;
  lmp.script(growing_spheres() + forty +
             "fix move all bd/pse 0 1 123 tolerance 1e-4 check yes fft estimate\n"
             "variable D equal 1-0.5*(step>2)\nfix swell all adapt 1 atom diameter v_D\nrun 6\n"
             "unfix swell\nrun 0\n");
  expect_words(lmp.log(), {"the plan is made again, since the radius has changed"});
  EXPECT_EQ(bdh_test::occurrences("check of the tolerance", lmp.log()), 2u);
  EXPECT_EQ(bdh_test::occurrences("above the tolerance", lmp.log()), 0u);
}

// The plan is shown whenever it differs from the last one.
TEST(ChangingScene, ThePlanIsKeptFromRunToRun)
{
  LammpsSession lmp;
  lmp.script(std::string(spheres) + forty +
             "fix move all bd/pse 1 1 123 tolerance 1e-3 fft estimate\nrun 2\nrun 2\nrun 0\n"
             "run 6 every 2 \"velocity all set 0 0 0\"\n");
  EXPECT_EQ(bdh_test::occurrences("fix bd/pse: plan", lmp.log()), 1u);
}

TEST(ChangingScene, ThePlanGoesIntoTheRestartFile)
{
  const std::string file = "test_scene_" + std::to_string(getpid()) + ".restart";
  const std::string fix =
      "fix move all bd/pse 1 1 123 radius 0.5 tolerance 1e-3 precision double fft estimate "
      "scheme split substeps 2\n";
  const std::string expand = "change_box all x final 0 23 y final 0 23 z final 0 23 remap units "
                             "box\n";
  // The KOKKOS package cannot read restart files with spheres.
  const std::string scene = "units lj\natom_style atomic\natom_modify map array\n"
                            "region box block 0 20 0 20 0 20\ncreate_box 1 box\nmass 1 1\n"
                            "neighbor 1.0 bin\nneigh_modify every 1 delay 0 check yes\n"
                            "timestep 1e-3\ncreate_atoms 1 random 40 987 box\n";
  const auto session = [&](const std::string &options, const std::string &script) {
    auto lmp = std::make_unique<LammpsSession>(MPI_COMM_SELF, options);
    lmp->script(script);
    return lmp;
  };
  std::vector<double> unbroken;
  double spacing = 0.0;
  {
    LammpsSession lmp;
    lmp.script(scene + fix + "run 10\n" + expand + "write_restart " + file + "\nrun 10\n");
    unbroken = lmp.unwrapped_positions();
    spacing = lmp.fix("move")->compute_vector(4);
    // A plan made for this box would be different.
    lmp.script("unfix move\n" + fix + "run 0\n");
    EXPECT_NE(lmp.fix("move")->compute_vector(4), spacing);
  }
  std::vector<std::string> suffixes = {""};
#if defined(LMP_KOKKOS)
  suffixes = {"-k on t 1 -sf kk", "-k on t 1 -sf kk/host"};
  if (!LammpsSession()->kokkos) suffixes.push_back("");    // LAMMPS itself cannot go back from kk
#endif
  for (const std::string &options : suffixes) {
    auto lmp = session(options, "read_restart " + file +
                                    "\nneighbor 1.0 bin\nneigh_modify every 1 delay 0 check yes\n"
                                    "timestep 1e-3\n" +
                                    fix + "run 10\n");
    EXPECT_EQ(lmp->fix("move")->compute_vector(4), spacing) << options;
    EXPECT_LT(bdh_test::largest_difference(lmp->unwrapped_positions(), unbroken), 1e-9) << options;
    expect_words(lmp->log(), {"from the restart file"});
  }
  std::remove(file.c_str());
}

// Without init(), only the step itself can notice another box.
TEST(ChangingScene, AnotherBoxBeforeARunWithPreNo)
{
  {
    LammpsSession lmp;
    begin(lmp, std::string(spheres) + forty, "all", move);
    expect_right(lmp,
                 "run 2\nchange_box all x final 0 18 y final 0 22 remap units box\nrun 3 pre no", 5,
                 1e-5);
  }
  LammpsSession lmp;
  lmp.script(std::string(spheres) + forty + "fix move all bd/fib 0 1 123 grid 16 16 16\nrun 1\n");
  expect_words(lmp.error_of("change_box all x final 0 18 remap units box\nrun 2 pre no"),
               {"fix bd/fib: step 2: the box has changed", "along x"});
}

// A box that is shifted together with its atoms changes nothing, not even the noise.
TEST(ChangingScene, AShiftedBoxBeforeARunWithPreNo)
{
  std::vector<double> x[2];
  for (const bool shift : {false, true}) {
    LammpsSession lmp;
    lmp.script(std::string(spheres) +
               "region middle block 2 18 2 18 2 18\ncreate_atoms 1 random 40 987 middle\n"
               "set group all diameter 1.0\n"
               "fix move all bd/pse 1 1 123 tolerance 1e-3 precision double fft estimate\nrun 1\n");
    if (shift)
      lmp.script("change_box all x final 0.3 20.3 y final 0.3 20.3 z final 0.3 20.3 remap units "
                 "box\n");
    lmp.command("run 2 pre no");
    x[shift] = lmp.unwrapped_positions();
  }
  for (double &coordinate : x[1]) coordinate -= 0.3;
  EXPECT_LT(bdh_test::largest_difference(x[0], x[1]), 1e-9);
}

TEST(ChangingScene, FibDoesNotFollowRadii)
{
  if (growing_spheres().empty()) GTEST_SKIP();
  LammpsSession lmp;
  lmp.script(growing_spheres() + forty +
             "fix move all bd/fib 0 1 123 grid 16 16 16\nvariable D equal ramp(1,2)\n"
             "fix swell all adapt 1 atom diameter v_D\nrun 2\nrun 2\n");
  EXPECT_EQ(bdh_test::occurrences("fix bd/fib: fix swell adapt changes radii", lmp.log()), 1u);
}

// A minimization moves the particles, so the plan is made for the positions after it.
TEST(ChangingScene, AMinimizationComesFirst)
{
  LammpsSession lmp;
  begin(lmp, std::string(spheres) + forty, "all", move);
  ASSERT_EQ(lmp.error_of("unfix push\nminimize 0 0 3 3"), "");
  EXPECT_EQ(lmp.log().find("fix bd/pse: plan"), std::string::npos);
  expect_right(lmp,
               "fix push all addforce 1 2 3\nrun 2\nunfix push\nminimize 0 0 3 3\n"
               "fix push all addforce 1 2 3\nrun 2",
               4, 1e-5);
  EXPECT_EQ(bdh_test::occurrences("fix bd/pse: plan", lmp.log()), 1u);
  expect_words(lmp.error_of("unfix push\nminimize 0 0 3 3\nrun 1 pre no"),
               {"use run with pre yes"});
}

// Within a run the list may be too short for the given splitting; the next run has a longer one.
TEST(ChangingScene, AGivenSplittingComesBackInTheNextRun)
{
  if (growing_spheres().empty()) GTEST_SKIP();
  LammpsSession lmp;
  begin(lmp, growing_spheres() + forty, "all",
        "fix move all bd/pse 0 1 123 tolerance 1e-5 xi 0.61 fft estimate\n");
  expect_right(lmp,
               "variable D equal ramp(1.0,2.0)\nfix swell all adapt 1 atom diameter v_D\nrun 6\n"
               "unfix swell\nrun 2\n",
               8, 1e-5);
  const std::string log = lmp.log();
  const size_t again = log.find("the plan is made again"), last = log.rfind("xi = 0.61 ");
  ASSERT_NE(again, std::string::npos);
  EXPECT_GT(last, again);
  EXPECT_NE(last, std::string::npos);
}
