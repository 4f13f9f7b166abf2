// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Boxes whose lower corner is not the origin, and boxes that are shifted or stretched between runs.

#include "lammps/lammps_mobility.h"

#include <gtest/gtest.h>

using bdh_test::LammpsSession;
using bdh_test::largest_difference;
using bdh_test::text;

namespace {

using Corner = std::array<double, 3>;

const double edge = 12.0;
const size_t atoms = 150;

/// A cube of edge 12 with 60 atoms at random positions that are the same relative to its corner and
/// away from its faces.
void make_cube(LammpsSession &lmp, const Corner &lo, const std::string &boundary,
               double margin = 0.1)
{
  std::string box = "region box block";
  for (double l : lo) box += " " + text(l) + " " + text(l + edge);
  lmp.script("units lj\natom_style atomic\natom_modify map array\nboundary " + boundary +
             "\ncomm_modify cutoff 2.0\n" + box +
             " units box\ncreate_box 1 box\nmass 1 1.0\nneigh_modify every 1 delay 0 check yes\n");
  std::mt19937_64 engine(17);
  std::uniform_real_distribution<double> inside(margin, edge - margin);
  for (size_t i = 0; i < atoms; ++i) {
    double x[3];
    for (size_t d = 0; d < 3; ++d) x[d] = lo[d] + inside(engine);
    lmp.create_atom(x);
  }
}

struct Outcome {
  std::vector<double> x;    // relative to the corner
  double crossings;
};

Outcome outcome(const Corner &lo, const std::string &boundary, const std::string &fix)
{
  LammpsSession lmp;
  make_cube(lmp, lo, boundary);
  lmp.script("fix push all addforce 0.001 -0.002 0.003\n" + fix + "\nrun 12");
  Outcome o{lmp.unwrapped_positions(), 0.0};
  for (size_t k = 0; k < o.x.size(); ++k) o.x[k] -= lo[k % 3];
  if (fix.find("wall") != std::string::npos) o.crossings = lmp.fix("move")->compute_vector(8);
  return o;
}

/// Round-off of 1e-15 grows through 12 steps.  A wall in another position would change the
/// displacements, which are of order 0.1.
void expect_shift_does_not_matter(const std::string &boundary, const std::string &fix, bool crosses)
{
  const Outcome at_origin = outcome({0.0, 0.0, 0.0}, boundary, fix),
                shifted = outcome({-3.0, 7.5, 1.25}, boundary, fix);
  EXPECT_LT(largest_difference(shifted.x, at_origin.x), 1e-10) << fix;
  EXPECT_EQ(shifted.crossings, at_origin.crossings) << fix;
  if (crosses) {
    EXPECT_GT(shifted.crossings, 0.0) << fix;
  }
}

const std::string fib = "fix move all bd/fib 1.0 1.0 5 grid 12 12 12 kernel roma3 fft estimate ";

/// Velocities of a step after `shift`, with the fix that took a step before it or with a new one.
std::vector<double> after_shift(const std::string &boundary, const std::string &shift,
                                const std::string &fix, bool renewed)
{
  LammpsSession lmp;
  make_cube(lmp, {0.0, 0.0, 0.0}, boundary, 1.5);
  lmp.script("timestep 1e-6\nfix push all addforce 0.3 -0.2 1.0\n" + fix + "\nrun 1\n" + shift);
  if (renewed) lmp.script("unfix move\n" + fix);
  lmp.command("run 1");
  return lmp.velocities();
}

// Both use the same positions, so they may differ only by round-off.
void expect_shift_between_runs_is_seen(const std::string &boundary, const std::string &shift,
                                       const std::string &fix)
{
  const auto renewed = after_shift(boundary, shift, fix, true);
  EXPECT_LT(largest_difference(after_shift(boundary, shift, fix, false), renewed), 1e-12)
      << shift << ", " << fix;
  EXPECT_GT(largest_difference(after_shift(boundary, "", fix, false), renewed), 1e-4)
      << shift << ", " << fix;
}

}    // namespace

// u = V + (z - zlo) dV/dz, on every axis.
TEST(LammpsShiftedBox, CouetteFlow)
{
  const Corner lo{2.0, 5.0, -3.0};
  const char *boundary[3] = {"f p p", "p f p", "p p f"};
  for (size_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    const size_t along = (axis + 1) % 3;
    std::string lower, upper;
    for (size_t d = 0; d < 3; ++d) {
      lower += d == along ? " -0.5" : " 0";
      upper += d == along ? " 1.5" : " 0";
    }
    LammpsSession lmp;
    make_cube(lmp, lo, boundary[axis]);
    const auto x = lmp.unwrapped_positions();
    lmp.script("fix move all bd/fib 0.0 2.0 5 grid 12 12 12 kernel roma3 fft estimate wall " +
               name + "lo noslip" + lower + " wall " + name + "hi noslip" + upper +
               "\ntimestep 0.01\nrun 1");
    const auto v = lmp.velocities();
    for (size_t i = 0; i < atoms; ++i)
      for (size_t d = 0; d < 3; ++d)
        EXPECT_NEAR(v[3 * i + d],
                    d == along ? -0.5 + 2.0 / edge * (x[3 * i + axis] - lo[axis]) : 0.0, 1e-13)
            << name << i;
  }
}

TEST(LammpsShiftedBox, Periodic)
{
  expect_shift_does_not_matter("p p p", fib + "\ntimestep 0.2", false);
  expect_shift_does_not_matter(
      "p p p",
      "fix move all bd/pse 1.0 1.0 5 radius 0.9 precision double fft estimate\ntimestep 0.2",
      false);
}

TEST(LammpsShiftedBox, WallsThatReflect)
{
  const std::string long_steps = "\ntimestep 8.0", z = "wall zlo slip wall zhi slip ",
                    all =
                        z +
                        "wall xlo slip wall xhi slip wall ylo slip wall yhi slip tolerance 1e-12 ";
  for (const std::string scheme : {"euler", "midpoint", "improved"})
    expect_shift_does_not_matter("p p f",
                                 fib + z + "crossing reflect scheme " + scheme + long_steps, true);
  expect_shift_does_not_matter("f f f", fib + all + "crossing reflect scheme euler" + long_steps,
                               true);
}

TEST(LammpsShiftedBox, WallsThatMove)
{
  expect_shift_does_not_matter(
      "p p f", fib + "wall zlo noslip 0.1 0.2 0 wall zhi noslip -0.3 0.1 0\ntimestep 0.1", false);
  expect_shift_does_not_matter(
      "p f f",
      fib + "wall ylo noslip wall yhi noslip 0.2 0 0 wall zlo noslip wall zhi noslip 0.1 0 0 "
            "tolerance 1e-12\ntimestep 0.1",
      false);
}

// After the faces of the box have moved past its atoms, a fix continues as a new one would.
TEST(LammpsShiftedBox, ShiftBetweenRuns)
{
  const std::string cold = "fix move all bd/fib 0.0 1.0 5 grid 12 12 12 kernel roma3 fft estimate ";
  expect_shift_between_runs_is_seen("p p f", "change_box all z final -0.7 11.3",
                                    cold + "wall zlo noslip wall zhi slip");
  expect_shift_between_runs_is_seen(
      "f p f", "change_box all x final 0.6 12.6",
      cold + "wall xlo noslip wall xhi noslip wall zlo noslip wall zhi noslip tolerance 1e-12");
  expect_shift_between_runs_is_seen("p p p", "change_box all y final 0.4 12.4", cold);
  // A wider box.
  expect_shift_between_runs_is_seen("p p f", "change_box all z final 0 12.9",
                                    cold + "wall zlo noslip wall zhi slip");
  expect_shift_between_runs_is_seen("p p p", "change_box all x final 0 12.9", cold);
  expect_shift_between_runs_is_seen("p p f", "change_box all z final -0.7 11.3",
                                    cold + "wall zlo noslip 1 0 0 wall zhi noslip");
}
