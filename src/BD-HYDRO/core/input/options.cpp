// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "input/options.h"

#include "base/errors.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <set>

namespace bdh {

namespace {

DriftChoice drift_from_name(const std::string &name)
{
  if (name == "auto") return DriftChoice::automatic;
  if (name == "exact") return DriftChoice::exact;
  if (name == "rfd") return DriftChoice::finite_difference;
  if (name == "no") return DriftChoice::no;
  throw InvalidOption("drift", name, "must be auto, exact, rfd or no");
}

FftEffort effort_from_name(const std::string &name)
{
  if (name == "measure") return FftEffort::measure;
  if (name == "estimate") return FftEffort::estimate;
  throw InvalidOption("fft", name, "must be measure or estimate");
}

void require(bool good, const std::string &what, double value, const std::string &rule)
{
  if (!good) throw InvalidOption(what, value, rule);
}

void parse_grid(ArgumentReader &in, FibOptions &o)
{
  for (int d = 0; d < 3; ++d) {
    const std::string what = std::string("grid n") + "xyz"[d];
    o.cells[d] = in.integer_within(what, {1, most_cells});
  }
}

Boundary boundary_from_name(const std::string &what, const std::string &name)
{
  if (name == "noslip") return Boundary::noslip;
  if (name == "slip") return Boundary::slip;
  if (name == "open") return Boundary::open;
  throw InvalidOption(what, name, "must be noslip, slip or open");
}

/// Why a face of this kind cannot have a velocity; empty for one that can.
std::string reason_to_rest(Boundary kind)
{
  switch (kind) {
  case Boundary::slip:
    return "a wall without friction cannot drag the fluid: leave its velocity out";
  case Boundary::open:
    return "there is no wall that could move: leave the velocity out, or give it to the opposite "
           "wall";
  case Boundary::noslip:
  case Boundary::periodic: break;
  }
  return "";
}

/// Reads FACE noslip|slip|open [vx vy vz].
void parse_wall(ArgumentReader &in, FibOptions &o)
{
  const std::string name = in.word("wall");
  int axis = -1, side = 0;
  for (int d = 0; d < 3; ++d)
    for (int s = 0; s < 2; ++s)
      if (name == face_name(d, s)) {
        axis = d;
        side = s;
      }
  if (axis < 0)
    throw InvalidOption("wall", name, "the face must be xlo, xhi, ylo, yhi, zlo or zhi");
  const std::string what = "wall " + name, kind = in.word(what);
  WallOptions::Wall &w = o.walls.face[axis][side];
  if (w.kind != Boundary::periodic)
    throw InvalidOption("wall", name, "this face has a wall already");
  w.kind = boundary_from_name(what, kind);
  if (!in.number_follows()) return;
  for (int d = 0; d < 3; ++d) w.velocity[d] = in.number(what + " v" + "xyz"[d]);
  const double normal = w.velocity[axis];
  if (normal != 0.0)
    throw InvalidOption(what + " v" + "xyz"[axis], normal,
                        "a wall can only move along itself: give 0");
  const std::string reason = reason_to_rest(w.kind);
  if (w.moves() && !reason.empty()) throw InvalidOption(what, kind, reason);
}

void parse_body_force(ArgumentReader &in, FibOptions &o)
{
  for (int d = 0; d < 3; ++d) o.body_force[d] = in.number(std::string("force f") + "xyz"[d]);
}

Crossing crossing_from_name(const std::string &name)
{
  if (name == "error") return Crossing::error;
  if (name == "reflect") return Crossing::reflect;
  if (name == "redraw") return Crossing::redraw;
  throw InvalidOption("crossing", name, "must be error, reflect or redraw");
}

void parse_scheme(ArgumentReader &in, FibOptions &o)
{
  o.scheme = scheme_from_name(in.word("scheme"));
  o.scheme_given = true;
}

void parse_radius(ArgumentReader &in, FibOptions &o)
{
  o.radius = in.number("radius");
  require(o.radius > 0.0, "radius", o.radius, "must be > 0");
}

void parse_delta(ArgumentReader &in, FibOptions &o)
{
  // With a smaller delta, positions that differ by delta h are the same number.
  o.delta = in.number_within("delta", {1e-12, 0.1}, "units of h");
}

/// `least` is what the method can reach in double precision.
double tolerance(ArgumentReader &in, double least)
{
  return in.number_within("tolerance", {least, 0.5});
}

template <class Options> using Keywords =
    std::map<std::string, std::function<void(ArgumentReader &, Options &)>>;

bool yes_or_no(ArgumentReader &in, const std::string &what)
{
  const std::string answer = in.word(what);
  if (answer != "yes" && answer != "no") throw InvalidOption(what, answer, "must be yes or no");
  return answer == "yes";
}

template <class Options> void parse_rotation(ArgumentReader &in, Options &o)
{
  const std::string word = in.word("rotation");
  if (word != "auto" && word != "yes" && word != "no")
    throw InvalidOption("rotation", word, "must be auto, yes or no");
  o.rotation = word == "auto" ? Rotation::automatic : word == "yes" ? Rotation::yes : Rotation::no;
}

template <class Options> void parse_hydrodynamics(ArgumentReader &in, Options &o)
{
  o.hydrodynamics = yes_or_no(in, "hydrodynamics");
}

/// Reads tol|no.
template <class Options> void parse_adapt(ArgumentReader &in, Options &o)
{
  const std::string word = in.word("adapt");
  if (word == "no") return;
  ArgumentReader value({word});
  o.adapt = value.number("adapt");
  require(o.adapt >= 1e-4 && o.adapt <= 0.5, "adapt", o.adapt,
          "must be from 0.0001 to 0.5 radii, or the word no");
}

/// Reads dt|no.
void parse_fib_check(ArgumentReader &in, FibOptions &o)
{
  const std::string word = in.word("check");
  if (word != "dt" && word != "no") throw InvalidOption("check", word, "must be dt or no");
  o.check_dt = word == "dt";
}

/// Reads yes|no|dt.
void parse_pse_check(ArgumentReader &in, PseOptions &o)
{
  const std::string word = in.word("check");
  if (word != "yes" && word != "no" && word != "dt")
    throw InvalidOption("check", word, "must be yes, no or dt");
  o.check = word == "yes";
  o.check_dt = word == "dt";
}

/// hold group vx vy vz
void parse_hold(ArgumentReader &in, MotionOptions &o)
{
  Hold hold;
  hold.group = in.word("hold group");
  for (Quantity &v : hold.velocity) v = in.quantity("hold velocity");
  o.holds.push_back(hold);
}

void parse_stresslet(ArgumentReader &in, MotionOptions &o)
{
  o.stresslets = yes_or_no(in, "stresslet");
}

const Keywords<FibOptions> fib_keywords = {
    {"grid", parse_grid},
    {"check", parse_fib_check},
    {"adapt", parse_adapt<FibOptions>},
    {"radius", parse_radius},
    {"kernel",
     [](ArgumentReader &in, FibOptions &o) { o.kernel = kernel_from_name(in.word("kernel")); }},
    {"scheme", parse_scheme},
    {"wall", parse_wall},
    {"force", parse_body_force},
    {"crossing", [](ArgumentReader &in,
                    FibOptions &o) { o.crossing = crossing_from_name(in.word("crossing")); }},
    {"shear", [](ArgumentReader &in, FibOptions &o) { o.shear_rate = in.number("shear"); }},
    {"hydrodynamics", parse_hydrodynamics<FibOptions>},
    {"rotation", parse_rotation<FibOptions>},
    {"stresslet", parse_stresslet},
    {"hold", parse_hold},
    {"constraint",
     [](ArgumentReader &in, FibOptions &o) {
       o.constraint_tolerance = in.number_within("constraint", {1e-12, 0.1});
     }},
    {"drift",
     [](ArgumentReader &in, FibOptions &o) { o.drift = drift_from_name(in.word("drift")); }},
    {"delta", parse_delta},
    {"tolerance", [](ArgumentReader &in, FibOptions &o) { o.tolerance = tolerance(in, 1e-14); }},
    {"fft", [](ArgumentReader &in, FibOptions &o) { o.effort = effort_from_name(in.word("fft")); }},
    {"precision", [](ArgumentReader &in,
                     FibOptions &o) { o.precision = precision_from_name(in.word("precision")); }},
};

void parse_pse_radius(ArgumentReader &in, PseOptions &o)
{
  const std::string word = in.word("radius");
  if (word == "atom") return;
  ArgumentReader value({word});
  o.radius = value.number("radius");
  require(o.radius > 0.0, "radius", o.radius, "must be > 0, or the word atom");
}

void parse_xi(ArgumentReader &in, PseOptions &o)
{
  const std::string word = in.word("xi");
  if (word == "auto") return;
  ArgumentReader value({word});
  o.xi = value.number("xi");
  require(o.xi > 0.0, "xi", o.xi, "must be > 0, or the word auto");
}

int count(ArgumentReader &in, const std::string &what, std::array<long, 2> limits)
{
  return in.integer_within(what, limits);
}

void parse_pse_scheme(ArgumentReader &in, PseOptions &o)
{
  const std::string word = in.word("scheme");
  if (word != "euler" && word != "split")
    throw InvalidOption("scheme", word, "must be euler or split");
  o.split = word == "split";
}

/// Reads n|auto.
void parse_substeps(ArgumentReader &in, PseOptions &o)
{
  constexpr int usual = 10;
  const std::string word = in.word("substeps");
  o.choose_substeps = word == "auto";
  ArgumentReader value({word});
  o.substeps = o.choose_substeps ? usual : count(value, "substeps", {1, 100});
}

const Keywords<PseOptions> pse_keywords = {
    {"radius", parse_pse_radius},
    {"adapt", parse_adapt<PseOptions>},
    {"tolerance", [](ArgumentReader &in, PseOptions &o) { o.tolerance = tolerance(in, 1e-12); }},
    {"xi", parse_xi},
    {"hydrodynamics", parse_hydrodynamics<PseOptions>},
    {"rotation", parse_rotation<PseOptions>},
    {"stresslet", parse_stresslet},
    {"hold", parse_hold},
    {"precision", [](ArgumentReader &in,
                     PseOptions &o) { o.precision = precision_from_name(in.word("precision")); }},
    {"iterations",
     [](ArgumentReader &in, PseOptions &o) {
       o.iterations = count(in, "iterations", {2, 1000});
     }},
    {"check", parse_pse_check},
    {"parts", [](ArgumentReader &in, PseOptions &o) { o.parts = yes_or_no(in, "parts"); }},
    {"fft", [](ArgumentReader &in, PseOptions &o) { o.effort = effort_from_name(in.word("fft")); }},
    {"scheme", parse_pse_scheme},
    {"substeps", parse_substeps},
};

template <class Options> std::string keyword_list(const Keywords<Options> &keywords)
{
  std::string list;
  for (const auto &k : keywords) list += (list.empty() ? "" : ", ") + k.first;
  return list;
}

/// Reads temperature viscosity seed.
template <class Options> void parse_positional(ArgumentReader &in, Options &o)
{
  o.temperature = in.quantity("temperature");
  require(o.temperature.value >= 0.0, "temperature", o.temperature.value, "must be >= 0");
  o.viscosity = in.quantity("viscosity");
  if (!o.viscosity.is_variable())
    require(o.viscosity.value > 0.0, "viscosity", o.viscosity.value, "must be > 0");
  o.seed = in.integer_within("seed", {1, 2147483647});
}

/// Reads keyword value ..., where each keyword appears once, except those in `repeatable`.
template <class Options> void parse_keywords(ArgumentReader &in, const Keywords<Options> &keywords,
                                             const std::set<std::string> &repeatable, Options &o)
{
  std::set<std::string> seen;
  while (!in.done()) {
    const std::string key = in.word("keyword");
    const auto found = keywords.find(key);
    if (found == keywords.end())
      throw InvalidOption("keyword", key, "must be one of " + keyword_list(keywords));
    if (!seen.insert(key).second && !repeatable.count(key))
      throw InvalidOption("keyword", key, "it may be given only once");
    found->second(in, o);
  }
}

/// The 2,3,5,7-smooth number nearest to `wanted` that is at least `least`.
long nearest_fast_size(double wanted, long least)
{
  const long above = next_fast_size(std::max<long>(least, std::ceil(wanted)));
  for (long below = std::max<long>(least, std::floor(wanted)); below >= least; --below)
    if (next_fast_size(below) == below)
      // Ratios are compared, since the radius is proportional to 1/n.
      return wanted / below < above / wanted ? below : above;
  return above;
}

[[noreturn]] void refuse_large_grid(double radius)
{
  throw InvalidOption(
      "radius", radius,
      "it needs more than 32768 cells along an axis of the box: use a larger radius");
}

/// Cells along an axis of the box without open faces.
long cells_along(const FibOptions &options, const Grid &g, int d)
{
  const int width = kernel_width(options.kernel);
  const double wanted = g.length[d] * radius_over_spacing(options.kernel, g.dim) / options.radius;
  if (options.grid_given()) {
    if (options.cells[d] < width)
      throw InvalidOption(std::string("grid n") + "xyz"[d], options.cells[d],
                          std::string("kernel ") + kernel_name(options.kernel) +
                              " needs at least " + std::to_string(width) + " cells per axis");
    return options.cells[d];
  }
  if (wanted < width)
    throw InvalidOption("radius", options.radius,
                        std::string("the box is only ") + std::to_string(wanted) +
                            " grid cells wide along " + "xyz"[d] + ": kernel " +
                            kernel_name(options.kernel) + " needs " + std::to_string(width) +
                            "; use a smaller radius, a smaller kernel or a larger box");
  if (wanted > most_cells) refuse_large_grid(options.radius);
  return nearest_fast_size(wanted, width);
}

/// Lets an axis with an open face have the spacing of the other axes: as many cells as contain the
/// box, beginning at the wall if there is one.
void fill_with_cubes(int d, Grid &g)
{
  double h = 1.0;
  for (int other = 0; other < g.dim; ++other)
    if (other != d) h *= g.dim == 3 ? std::sqrt(g.h(other)) : g.h(other);
  const double cells = std::ceil(g.length[d] / h - 1e-9);
  if (cells > most_cells) refuse_large_grid(h);
  g.n[d] = std::max(1L, static_cast<long>(cells));
  const double more = g.n[d] * h - g.length[d];
  const bool lower = g.boundary[d][0] == Boundary::open, upper = g.boundary[d][1] == Boundary::open;
  g.beyond[d] = {lower ? upper ? 0.5 * more : more : 0.0, upper ? lower ? 0.5 * more : more : 0.0};
  g.lo[d] -= g.beyond[d][0];
  g.length[d] = g.n[d] * h;
}

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

/// What stresslets and held particles cannot be combined with.
void check_constraints(const FibOptions &o)
{
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

}    // namespace

Drift FibOptions::drift_at(double kT) const
{
  if (kT == 0.0 || !hydrodynamics) return Drift::no;
  switch (drift) {
  case DriftChoice::exact: return Drift::exact;
  case DriftChoice::finite_difference: return Drift::finite_difference;
  case DriftChoice::no: return Drift::no;
  case DriftChoice::automatic: break;
  }
  return scheme == Scheme::euler ? Drift::no : Drift::exact;
}

bool FibOptions::needs_corrector(double kT) const
{
  return scheme_given || kT > 0.0 || shear_rate != 0.0 || walls.any_moves() || has_body_force();
}

FibOptions parse_fib_options(const std::vector<std::string> &words)
{
  ArgumentReader in(words);
  FibOptions o;
  parse_positional(in, o);
  parse_keywords(in, fib_keywords, {"wall", "hold"}, o);
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
  return o;
}

/// What belongs to scheme split.
static void check_split(const PseOptions &o)
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

PseOptions parse_pse_options(const std::vector<std::string> &words)
{
  ArgumentReader in(words);
  PseOptions o;
  parse_positional(in, o);
  parse_keywords(in, pse_keywords, {"hold"}, o);
  check_constraints(o);
  check_split(o);
  check_halves(o);
  if (o.check_dt && o.split)
    throw InvalidOption("check", "dt", "needs scheme euler: the steps of scheme split share noise");
  if (o.adapt > 0.0 && o.parts)
    throw InvalidOption("parts", "yes", "needs steps as a whole: use adapt no");
  return o;
}

Grid choose_grid(const FibOptions &options, int dim, const std::array<double, 3> &lo,
                 const std::array<double, 3> &length, const std::array<bool, 3> &periodic)
{
  Grid g;
  g.dim = dim;
  g.boundary = options.walls.boundary(dim, periodic);
  if (dim == 2 && options.grid_given() && options.cells[2] != 1)
    throw InvalidOption("grid nz", options.cells[2], "must be 1 in a two-dimensional simulation");
  if (dim == 2 && options.body_force[2] != 0.0)
    throw InvalidOption("force fz", options.body_force[2],
                        "must be 0 in a two-dimensional simulation");
  for (int d = 0; d < dim; ++d) {
    g.lo[d] = lo[d];
    g.length[d] = length[d];
    if (!g.has(Boundary::open, d))
      g.n[d] = cells_along(options, g, d);
    else if (options.grid_given())
      g.n[d] = options.cells[d];
  }
  for (int d = 0; d < dim && !options.grid_given(); ++d)
    if (g.has(Boundary::open, d)) fill_with_cubes(d, g);
  return beyond_open_faces(g, rows_beyond(options.kernel));
}

double anisotropy(const Grid &grid)
{
  double least = grid.h(0), most = grid.h(0);
  for (int d = 1; d < grid.dim; ++d) {
    least = std::min(least, grid.h(d));
    most = std::max(most, grid.h(d));
  }
  return most / least - 1.0;
}

}    // namespace bdh
