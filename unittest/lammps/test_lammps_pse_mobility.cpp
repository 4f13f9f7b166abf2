// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/pse: M F from LAMMPS after one step at temperature 0 is accurate to the tolerance, and not
// far more accurate.

#include "lammps/lammps_mobility.h"
#include "support/reference_json.h"

#include "force.h"

#include "support/json_library.h"
#include <gtest/gtest.h>

using bdh_test::GivenForces;
using bdh_test::LammpsSession;
using bdh_test::relative_error;
using bdh_test::text;

namespace {

nlohmann::json cases() { return bdh_test::json_reference("rpy_periodic.json")["cases"]; }

nlohmann::json case_named(const std::string &id)
{
  for (const auto &c : cases())
    if (c["id"] == id) return c;
  throw std::runtime_error("no case " + id);
}

/// n rows of 3 as 3 n numbers, times a factor.
std::vector<double> flat(const nlohmann::json &rows, double factor = 1.0)
{
  std::vector<double> v;
  for (const auto &row : rows)
    for (const auto &e : row) v.push_back(factor * e.get<double>());
  return v;
}

bdh::Cell cell_of_case(const nlohmann::json &c, double length = 1.0)
{
  const auto &box = c["box"];
  bdh::Cell cell;
  cell.lx = length * box["Lx"].get<double>();
  cell.ly = length * box["Ly"].get<double>();
  cell.lz = length * box["Lz"].get<double>();
  cell.xy = length * box.value("xy", 0.0);
  cell.xz = length * box.value("xz", 0.0);
  cell.yz = length * box.value("yz", 0.0);
  return cell;
}

/// Creates the box and the atoms of a case, with all lengths multiplied by `length`.
void load(LammpsSession &lmp, const nlohmann::json &c, const std::string &style = "atomic",
          double length = 1.0)
{
  lmp.script("atom_style " + style +
             "\natom_modify map array\nboundary p p p\nneigh_modify every 1 delay 0 check yes\n" +
             bdh_test::box_commands(cell_of_case(c, length)));
  if (style == "atomic") lmp.command("mass 1 1.0");
  bdh_test::create_atoms(lmp, flat(c["x"], length));
}

/// Velocities of one step.  The step is so short that nothing moves; the velocities do not depend
/// on it.
std::vector<double> one_step(LammpsSession &lmp, const std::string &fix, double timestep = 1e-14)
{
  lmp.script("fix move " + fix + "\ntimestep " + text(timestep) + "\nrun 1 post no");
  const auto v = lmp.velocities();
  lmp.command("unfix move");
  return v;
}

std::string pse(const nlohmann::json &c, const std::string &keywords)
{
  return "bd/pse 0.0 " + text(c["eta"].get<double>()) + " 1 radius " + text(c["a"].get<double>()) +
         " fft estimate " + keywords;
}

}    // namespace

// The error never exceeds the tolerance, and on average over the cases is not smaller by more than
// a factor of 50.  Every third splitting is the fix's own choice, which takes longer than the step;
// the others lie on both sides of it.
TEST(LammpsPseMobility, ReferenceCasesAtAllTolerances)
{
  std::vector<double> worst(11, 0.0), sum(11, 0.0);
  int count = 0;
  for (const auto &c : cases()) {
    LammpsSession lmp;
    lmp.command("units lj");
    load(lmp, c);
    GivenForces forces(lmp, flat(c["f"]));
    const auto u = flat(c["u"]);
    for (int digits = 1; digits <= 10; ++digits) {
      const std::string tolerance = "1e-" + std::to_string(digits);
      const int turn = (count + digits) % 3;
      const std::string xi =
          turn == 0 ? "auto" : text((turn == 1 ? 0.35 : 0.6) / c["a"].get<double>());
      const auto v = one_step(lmp, "all " + pse(c, "xi " + xi + " tolerance " + tolerance));
      const double ratio = relative_error(v, u) / std::stod(tolerance);
      EXPECT_LE(ratio, 1.0) << c["id"] << ", tolerance " << tolerance << ", xi " << xi;
      worst[digits] = std::max(worst[digits], ratio);
      sum[digits] += ratio;
    }
    ++count;
  }
  EXPECT_EQ(count, 26);
  std::printf("tolerance: achieved/asked, mean and largest\n");
  for (int digits = 1; digits <= 10; ++digits) {
    std::printf("  1e-%-2d  %.3f %.3f\n", digits, sum[digits] / count, worst[digits]);
    EXPECT_GE(sum[digits] / count, 0.02) << "tolerance 1e-" << digits;
  }
}

TEST(LammpsPseMobility, BothPrecisionsAndAnySplitting)
{
  const auto c = case_named("triclinic-N200-phi0.1");
  LammpsSession lmp;
  lmp.command("units lj");
  load(lmp, c);
  GivenForces forces(lmp, flat(c["f"]));
  for (const std::string keywords :
       {"precision single", "precision double", "xi 0.3", "xi 0.6", "xi 0.6 precision double"}) {
    const auto v = one_step(lmp, "all " + pse(c, "tolerance 1e-4 " + keywords));
    EXPECT_LE(relative_error(v, flat(c["u"])), 1e-4) << keywords;
  }
}

TEST(LammpsPseMobility, RadiusOfTheAtoms)
{
  const auto c = case_named("shear-N10-phi0.5");
  LammpsSession lmp;
  lmp.command("units lj");
  load(lmp, c, "sphere");
  lmp.command("set group all diameter " + text(2.0 * c["a"].get<double>()));
  GivenForces forces(lmp, flat(c["f"]));
  for (const std::string radius : {"", "radius atom"}) {
    const auto v = one_step(lmp, "all bd/pse 0.0 " + text(c["eta"].get<double>()) +
                                     " 1 tolerance 1e-6 " + radius);
    EXPECT_LE(relative_error(v, flat(c["u"])), 1e-6);
  }
}

// The reduced numbers of the case are multiplied by scales of length, force and velocity in each
// units style.
TEST(LammpsPseMobility, UnitsStyles)
{
  struct Style {
    const char *name;
    double length, force, velocity;
  };
  const auto c = case_named("triclinic-N10-phi0.05");
  for (const Style &s : {Style{"real", 10.0, 0.06, 1e-5}, Style{"metal", 10.0, 2.6e-3, 1e-2},
                         Style{"si", 1e-6, 4e-15, 1e-4}, Style{"nano", 5.0, 0.4, 3.0}}) {
    LammpsSession lmp;
    lmp.command(std::string("units ") + s.name);
    load(lmp, c, "atomic", s.length);
    lmp.command("neighbor " + text(0.1 * s.length) + " bin");
    GivenForces forces(lmp, flat(c["f"], s.force));
    // LAMMPS: force = viscosity * velocity * length * vxmu2f
    const double viscosity =
        c["eta"].get<double>() * s.force / (s.velocity * s.length * lmp->force->vxmu2f);
    const auto v = one_step(lmp,
                            "all bd/pse 0.0 " + text(viscosity) + " 1 tolerance 1e-6 radius " +
                                text(s.length * c["a"].get<double>()),
                            1e-14 * s.length / s.velocity);
    EXPECT_LE(relative_error(v, flat(c["u"], s.velocity)), 1e-6) << s.name;
  }
}

// Atoms outside the group neither push the fluid nor move, even if forces act on them.
TEST(LammpsPseMobility, OnlyTheGroupMovesAndPushes)
{
  const auto c = case_named("triclinic-N200-phi0.1");
  LammpsSession lmp;
  lmp.command("units lj");
  load(lmp, c);
  const auto f = flat(c["f"]);
  GivenForces forces(lmp, f);
  lmp.command("group some id 3:180:7");
  std::vector<double> x, force;
  std::vector<size_t> chosen;
  for (size_t i = 2; i < 180; i += 7) chosen.push_back(i);
  const auto all = lmp.unwrapped_positions();
  for (size_t i : chosen)
    for (int d = 0; d < 3; ++d) {
      x.push_back(all[3 * i + d]);
      force.push_back(f[3 * i + d]);
    }
  std::vector<double> exact(x.size()), seen;
  bdh::dense_apply(bdh_test::cell_of(lmp), x.data(), chosen.size(), c["a"].get<double>(),
                   c["eta"].get<double>(), force.data(), exact.data());
  auto v = one_step(lmp, "some " + pse(c, "tolerance 1e-6"));
  for (size_t i : chosen)
    for (int d = 0; d < 3; ++d) {
      seen.push_back(v[3 * i + d]);
      v[3 * i + d] = 0.0;
    }
  EXPECT_LE(relative_error(seen, exact), 1e-6);
  EXPECT_EQ(bdh_test::length_of(v), 0.0);
}

// The cells are so small that a particle interacts with many images of itself and of every other
// particle, and even overlaps its own images.
TEST(LammpsPseMobility, ManyImages)
{
  for (const double radius : {0.4, 1.1}) {
    bdh::Cell cell;
    cell.lo[0] = -0.4;
    cell.lo[1] = 1.1;
    cell.lo[2] = 5.0;
    cell.lx = 2.0;
    cell.ly = 2.6;
    cell.lz = 3.1;
    cell.xy = 0.9;
    cell.xz = -0.7;
    cell.yz = 1.2;
    LammpsSession lmp;
    lmp.script("units lj\natom_style atomic\natom_modify map array\nboundary p p p\n" +
               bdh_test::box_commands(cell) + "mass 1 1.0");
    bdh_test::create_atoms(lmp, {0.1, 1.3, 5.5, 0.9, 2.0, 6.1, 10.0, -20.0, 30.0});
    GivenForces forces(lmp, bdh_test::random_vector(9, 4));
    const auto exact = bdh_test::exact_velocities(lmp, radius, 0.7, forces());
    for (const std::string tolerance : {"1e-3", "1e-6", "1e-9"}) {
      const auto v = one_step(lmp, "all bd/pse 0.0 0.7 1 fft estimate radius " + text(radius) +
                                       " tolerance " + tolerance);
      EXPECT_LE(relative_error(v, exact), std::stod(tolerance))
          << radius << ", tolerance " << tolerance;
    }
  }
}

TEST(LammpsPseMobility, Alias)
{
  const auto c = case_named("cubic-N10-phi0.05");
  LammpsSession lmp;
  lmp.command("units lj");
  load(lmp, c);
  GivenForces forces(lmp, flat(c["f"]));
  const auto v = one_step(lmp, "all brownian/pse 0.0 " + text(c["eta"].get<double>()) +
                                   " 1 radius " + text(c["a"].get<double>()));
  EXPECT_LE(relative_error(v, flat(c["u"])), 1e-3);
}
