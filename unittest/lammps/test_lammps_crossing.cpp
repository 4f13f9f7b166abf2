// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/fib when a step crosses a wall: which positions are mirrored, and the resulting
// velocities.

#include "lammps/lammps_session.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>

using bdh_test::LammpsSession;
using bdh_test::largest_difference;
using bdh_test::text;

namespace {

const double zlo = -4.0, zhi = 8.0;

/// Two slip walls.  An atom near them can still move across, which no-slip walls hardly allow.
const std::string slit = R"(
units lj
atom_style atomic
atom_modify map array
boundary p p f
neigh_modify every 1 delay 0 check yes
comm_modify cutoff 2.0
region box block 0 12 0 12 -4 8
create_box 1 box
mass 1 1.0
)";
const std::string walls = " grid 12 12 12 kernel roma3 fft estimate wall zlo slip wall zhi slip ";

double mirrored(double z) { return z < zlo ? 2.0 * zlo - z : z > zhi ? 2.0 * zhi - z : z; }

/// One step at temperature 0 under a force on the first atom.
struct Pushed {
  std::vector<double> v, end;
};
Pushed pushed(const std::vector<std::array<double, 3>> &x, const std::array<double, 3> &force,
              double timestep, const std::string &keywords)
{
  LammpsSession lmp;
  lmp.script(slit);
  for (const auto &a : x) lmp.create_atom(a.data());
  lmp.script("group first id 1\nfix push first addforce " + text(force[0]) + " " + text(force[1]) +
             " " + text(force[2]) + "\nfix move all bd/fib 0.0 1.0 7" + walls + keywords +
             "\ntimestep " + text(timestep) + "\nrun 1");
  return {lmp.velocities(), lmp.unwrapped_positions()};
}

std::array<double, 3> moved(const std::array<double, 3> &x, const std::vector<double> &v,
                            double time)
{
  return {x[0] + time * v[0], x[1] + time * v[1], mirrored(x[2] + time * v[2])};
}

/// An atom near a wall and a force towards it.
struct Case {
  std::array<double, 3> x, force;
};
const std::array<Case, 2> cases{
    {{{4.3, 4.1, zhi - 0.8}, {0.03, -0.02, 1.0}}, {{3.3, 5.1, zlo + 0.7}, {0.01, 0.02, -1.0}}}};

/// Velocity at the beginning of the step.  Sets the step so that `part` of it ends a third of a
/// cell behind the wall.
std::vector<double> first_velocity(const Case &c, double part, double &timestep)
{
  const std::vector<double> v = pushed({c.x}, c.force, 1e-3, "scheme euler").v;
  const double to_wall = c.force[2] > 0.0 ? zhi - c.x[2] : zlo - c.x[2];
  timestep = (to_wall + (c.force[2] > 0.0 ? 0.3 : -0.3)) / v[2] / part;
  EXPECT_GT(timestep, 0.0);
  return v;
}

}    // namespace

// An atom ends at the mirror image of the position where its velocity would have taken it.  The
// velocity does not change.
TEST(LammpsCrossing, EndsAreMirrored)
{
  for (const std::string scheme : {"euler", "midpoint", "trapezoidal", "improved"}) {
    LammpsSession lmp;
    lmp.script(slit +
               "create_atoms 1 random 400 5 box\ntimestep 8.0\nfix move all bd/fib 1.0 1.0 7" +
               walls + "crossing reflect scheme " + scheme);
    int below = 0, above = 0;
    for (int step = 0; step < 15; ++step) {
      std::vector<double> expected = lmp.unwrapped_positions();
      lmp.command("run 1 post no");
      const std::vector<double> v = lmp.velocities();
      for (size_t k = 0; k < expected.size(); ++k) {
        expected[k] += 8.0 * v[k];
        if (k % 3 != 2) continue;
        below += expected[k] < zlo;
        above += expected[k] > zhi;
        expected[k] = mirrored(expected[k]);
      }
      EXPECT_LT(largest_difference(lmp.unwrapped_positions(), expected), 1e-12)
          << scheme << " " << step;
    }
    EXPECT_GT(below, 0) << scheme;
    EXPECT_GT(above, 0) << scheme;
    const double crossings = lmp.fix("move")->compute_vector(8);
    EXPECT_GE(crossings, below + above) << scheme;    // predicted positions count, too
    if (scheme == "euler") {
      EXPECT_EQ(crossings, below + above);
    }
  }
}

// In a scheme with one solve the second velocity is that of the fluid at the mirrored predicted
// position.  A second atom at this position, without a force, measures it.
TEST(LammpsCrossing, PredictedPositionsAreMirrored)
{
  for (const std::string scheme : {"midpoint", "trapezoidal"})
    for (const Case &c : cases) {
      const double part = scheme == "midpoint" ? 0.5 : 1.0;
      double dt;
      const auto first = first_velocity(c, part, dt);
      const auto predicted = moved(c.x, first, part * dt);
      const auto both = pushed({c.x, predicted}, c.force, 1e-3, "scheme euler").v;
      ASSERT_EQ(both.size(), 6u);
      const Pushed step = pushed({c.x}, c.force, dt, "crossing reflect scheme " + scheme);
      for (size_t d = 0; d < 3; ++d)
        EXPECT_NEAR(step.v[d], scheme == "midpoint" ? both[3 + d] : 0.5 * (both[d] + both[3 + d]),
                    1e-12)
            << scheme << d;
      const auto end = moved(c.x, step.v, dt);
      for (size_t d = 0; d < 3; ++d) EXPECT_NEAR(step.end[d], end[d], 1e-12) << scheme << d;
    }
}

// The improved scheme takes forces and mobility at the mirrored predicted position.
TEST(LammpsCrossing, PredictorOfTheImprovedSchemeIsMirrored)
{
  for (const Case &c : cases) {
    double dt;
    const auto first = first_velocity(c, 0.5, dt);
    const auto there = pushed({moved(c.x, first, 0.5 * dt)}, c.force, 1e-3, "scheme euler").v;
    const Pushed step = pushed({c.x}, c.force, dt, "crossing reflect scheme improved");
    const auto end = moved(c.x, step.v, dt);
    for (size_t d = 0; d < 3; ++d) {
      EXPECT_NEAR(step.v[d], there[d], 1e-12) << d;
      EXPECT_NEAR(step.end[d], end[d], 1e-12) << d;
    }
  }
}

// Many atoms, with steps of more than half a cell.
TEST(LammpsCrossing, LongStepsLoseNoAtom)
{
  for (const std::string scheme : {"midpoint", "improved"}) {
    LammpsSession lmp;
    EXPECT_EQ(lmp.error_of(
                  slit +
                  "create_atoms 1 random 1000 5 box\ntimestep 8.0\nfix move all bd/fib 1.0 1.0 7" +
                  walls + "crossing reflect scheme " + scheme + "\nrun 30 post no"),
              "")
        << scheme;
    EXPECT_EQ(lmp->atom->natoms, 1000) << scheme;
  }
}
