// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "input/options.h"

#include "base/errors.h"
#include "input/option_rules.h"

#include <functional>
#include <map>
#include <set>
#include <string>

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

/// Reads n|auto.
template <class Options> void parse_pencils(ArgumentReader &in, Options &o)
{
  constexpr long most_ranks = 1 << 24;
  const std::string word = in.word("pencils");
  if (word == "auto") return;
  ArgumentReader value({word});
  const long share = value.integer("pencils");
  require(share >= 1 && share <= most_ranks, "pencils", share,
          "must be from 1 to the number of processes, or the word auto");
  o.fft.share = share;
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

void parse_control_variate(ArgumentReader &in, MotionOptions &o)
{
  o.control_variate = yes_or_no(in, "control_variate");
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
    {"control_variate", parse_control_variate},
    {"constraint",
     [](ArgumentReader &in, FibOptions &o) {
       o.constraint_tolerance = in.number_within("constraint", {1e-12, 0.1});
     }},
    {"drift",
     [](ArgumentReader &in, FibOptions &o) { o.drift = drift_from_name(in.word("drift")); }},
    {"delta", parse_delta},
    {"tolerance", [](ArgumentReader &in, FibOptions &o) { o.tolerance = tolerance(in, 1e-14); }},
    {"fft",
     [](ArgumentReader &in, FibOptions &o) { o.fft.effort = effort_from_name(in.word("fft")); }},
    {"pencils", parse_pencils<FibOptions>},
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
    {"control_variate", parse_control_variate},
    {"precision", [](ArgumentReader &in,
                     PseOptions &o) { o.precision = precision_from_name(in.word("precision")); }},
    {"iterations",
     [](ArgumentReader &in, PseOptions &o) {
       o.iterations = count(in, "iterations", {2, 1000});
     }},
    {"check", parse_pse_check},
    {"parts", [](ArgumentReader &in, PseOptions &o) { o.parts = yes_or_no(in, "parts"); }},
    {"fft",
     [](ArgumentReader &in, PseOptions &o) { o.fft.effort = effort_from_name(in.word("fft")); }},
    {"pencils", parse_pencils<PseOptions>},
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
  check_combination(o);
  return o;
}

PseOptions parse_pse_options(const std::vector<std::string> &words)
{
  ArgumentReader in(words);
  PseOptions o;
  parse_positional(in, o);
  parse_keywords(in, pse_keywords, {"hold"}, o);
  check_combination(o);
  return o;
}

}    // namespace bdh
