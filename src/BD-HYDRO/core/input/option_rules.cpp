// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "input/option_rules.h"

#include "base/errors.h"

#include <array>
#include <string>

namespace bdh {

namespace {

/// Shear needs fluid without end, or one no-slip wall.
void check_shear(const FibOptions &o)
{
  if (o.shear_rate == 0.0 || !o.walls.any()) return;
  if (!o.walls.any_open())
    throw InvalidOption("shear", o.shear_rate,
                        "between walls the flow is that of moving walls: give them velocities");
  for (int d = 0; d < 3; ++d)
    for (int side = 0; side < 2; ++side) {
      const Boundary kind = o.walls.face[d][side].kind;
      if (kind == Boundary::slip)
        throw InvalidOption("shear", o.shear_rate,
                            "wall " + face_name(d, side) +
                                " has no friction and bears no shear: use noslip or open there");
      if (kind != Boundary::periodic && d == 0)
        throw InvalidOption("shear", o.shear_rate,
                            "the flow is along x, which wall " + face_name(d, side) +
                                " crosses: let the wall lie across y or z");
    }
}

void check_body_force(const FibOptions &o)
{
  if (o.body_force == std::array<double, 3>{0.0, 0.0, 0.0}) return;
  if (!o.hydrodynamics)
    throw InvalidOption("hydrodynamics", "no",
                        "a force on the fluid drives a flow, which needs the fluid: leave out the "
                        "keyword force");
  if (o.walls.any_open())
    throw InvalidOption("force", "fx fy fz",
                        "fluid without end behind an open face has no steady flow under a force on "
                        "all of it: use keyword shear or a moving wall, or put a wall in place of "
                        "the open face");
}

/// Calls check(refuse) if a keyword gives motions; refuse(why) names that keyword.
template <class Check> void check_given_motions(const MotionOptions &o, Check check)
{
  if (!o.give_motions()) return;
  const char *const what = o.stresslets ? "stresslet" : "hold";
  const std::string value = o.stresslets ? "yes" : o.holds[0].group;
  check([&](const std::string &why) { throw InvalidOption(what, value, why); });
}

/// Without hydrodynamic interactions nothing moves with what is held.
template <class Refuse> void check_fluid_for_constraints(bool stresslets, const Refuse &refuse)
{
  if (stresslets)
    refuse("needs hydrodynamics yes: spheres that do not interact are not moved by their "
           "stresslets");
  refuse("needs hydrodynamics yes: without, leave atoms that do not move out of the group");
}

template <class Options, class Refuse>
void check_steps_of_constraints(const Options &o, const Refuse &refuse)
{
  if (o.adapt > 0.0) refuse("needs adapt no: the loads of a constraint are those of a whole step");
  if (o.check_dt) refuse("needs no check dt: steps with constraints have no halves");
}

/// A control variate is one of loads that a constraint finds.
void check_control_variate(const MotionOptions &o)
{
  if (o.control_variate && !o.give_motions())
    throw InvalidOption("control_variate", "yes",
                        "needs stresslet yes or hold: without constraints there are no loads whose "
                        "noise it could take out");
}

/// What stresslets and held particles cannot be combined with.
void check_constraints(const FibOptions &o)
{
  check_control_variate(o);
  if (o.control_variate && o.crossing == Crossing::redraw)
    throw InvalidOption("control_variate", "yes",
                        "needs crossing error or reflect: noise that is drawn again until no atom "
                        "crosses a wall no longer has the mean 0");
  check_given_motions(o, [&o](const auto &refuse) {
    if (!o.hydrodynamics) check_fluid_for_constraints(o.stresslets, refuse);
    check_steps_of_constraints(o, refuse);
    if (o.scheme != Scheme::midpoint)
      refuse("needs scheme midpoint: the other schemes have no step with constraints");
    if (o.drift == DriftChoice::finite_difference)
      refuse("needs drift auto, exact or no: drift rfd has no step with "
             "constraints");
  });
}
void check_constraints(const PseOptions &o)
{
  check_control_variate(o);
  check_given_motions(o, [&o](const auto &refuse) {
    if (o.split) refuse("needs scheme euler: scheme split has no step with constraints");
    check_steps_of_constraints(o, refuse);
    if (o.parts)
      refuse("needs parts no: the loads of a constraint belong to forces and noise together");
    if (!o.hydrodynamics) check_fluid_for_constraints(o.stresslets, refuse);
  });
}

template <class Options> void check_halves(const Options &o)
{
  if (o.check_dt && o.adapt > 0.0)
    throw InvalidOption("check", "dt", "needs adapt no: pieces of a step are shorter than dt");
}

/// What belongs to scheme split.
void check_split(const PseOptions &o)
{
  const std::string n = o.choose_substeps ? "auto" : std::to_string(o.substeps);
  if (!o.split && o.substeps)
    throw InvalidOption("substeps", n, "needs scheme split: scheme euler has no substeps");
  if (o.split && !o.substeps)
    throw InvalidOption("scheme", "split",
                        "needs the number of near steps: add substeps n, or substeps auto with "
                        "adapt tol");
  if (o.choose_substeps && o.adapt == 0.0)
    throw InvalidOption("substeps", n, "needs a tolerance for near steps: add adapt tol");
  if (o.split && o.parts)
    throw InvalidOption("parts", "yes",
                        "needs scheme euler: substeps mix what forces and noise do");
}

}    // namespace

void check_combination(const FibOptions &o)
{
  check_constraints(o);
  if (o.grid_given() && o.radius > 0.0)
    throw InvalidOption("radius", o.radius,
                        "give either grid or radius, since each sets the spacing");
  if (!o.grid_given() && o.radius == 0.0)
    throw InvalidOption(
        "grid", "(not given)",
        "the spacing must be set: with grid nx ny nz, or with radius a for a hydrodynamic radius");
  check_shear(o);
  check_body_force(o);
  check_halves(o);
  if (o.check_dt && o.scheme == Scheme::improved)
    throw InvalidOption("check", "dt",
                        "needs a scheme that takes forces where the step begins: scheme improved "
                        "does not");
  if (o.crossing == Crossing::redraw && o.scheme == Scheme::improved)
    throw InvalidOption("crossing", "redraw",
                        "scheme improved takes forces within the step, which cannot be taken "
                        "back: use crossing reflect, or scheme midpoint");
}

void check_combination(const PseOptions &o)
{
  check_constraints(o);
  check_split(o);
  check_halves(o);
  if (o.check_dt && o.split)
    throw InvalidOption("check", "dt", "needs scheme euler: the steps of scheme split share noise");
  if (o.adapt > 0.0 && o.parts)
    throw InvalidOption("parts", "yes", "needs steps as a whole: use adapt no");
}

}    // namespace bdh
