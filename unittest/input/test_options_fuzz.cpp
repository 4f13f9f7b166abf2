// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Random and mutated argument lists: the parsers either throw InvalidOption with a message, or
// return options that satisfy their own rules.  The lists are the same in every run;
// BDH_FUZZ_ROUNDS requests more of them than the test takes by default.

#include "base/errors.h"
#include "input/options.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <sstream>

using namespace bdh;

namespace {

using Words = std::vector<std::string>;

int rounds(int usual)
{
  const char *asked = std::getenv("BDH_FUZZ_ROUNDS");
  return asked ? std::atoi(asked) : usual;
}

/// Argument lists that are almost valid.
class Fuzzer {
 public:
  Fuzzer(uint64_t seed, Words seeds) : random_(seed), seeds_(std::move(seeds)) {}

  Words list()
  {
    Words words;
    std::istringstream in(pick(seeds_));
    for (std::string w; in >> w;) words.push_back(w);
    for (long changes = below(5); changes > 0; --changes) change(words);
    return words;
  }

 private:
  long below(long n) { return random_() % n; }
  const std::string &pick(const Words &from) { return from[below(bdh::ssize(from))]; }

  void change(Words &words)
  {
    const std::size_t at = below(bdh::ssize(words) + 1);
    const auto place = words.begin() + at;
    switch (below(6)) {
    case 0: words.insert(place, word()); return;
    case 1:
      if (at < words.size()) words.erase(place);
      return;
    case 2:
      if (at < words.size()) words[at] = word();
      return;
    case 3:
      if (at < words.size()) mutate(words[at]);
      return;
    case 4: words.resize(at); return;
    case 5:
      if (at < words.size()) words.push_back(words[at]);
      return;
    }
  }

  std::string word()
  {
    static const Words known = {"grid",
                                "radius",
                                "kernel",
                                "roma3",
                                "peskin4",
                                "bkp6",
                                "scheme",
                                "midpoint",
                                "improved",
                                "euler",
                                "trapezoidal",
                                "wall",
                                "xlo",
                                "xhi",
                                "ylo",
                                "yhi",
                                "zlo",
                                "zhi",
                                "noslip",
                                "slip",
                                "open",
                                "hydrodynamics",
                                "rotation",
                                "shear",
                                "drift",
                                "auto",
                                "exact",
                                "rfd",
                                "no",
                                "yes",
                                "delta",
                                "tolerance",
                                "fft",
                                "pencils",
                                "measure",
                                "estimate",
                                "force",
                                "crossing",
                                "error",
                                "reflect",
                                "redraw",
                                "atom",
                                "xi",
                                "precision",
                                "single",
                                "double",
                                "iterations",
                                "check",
                                "parts",
                                "v_",
                                "v_T",
                                "0",
                                "-0",
                                "1",
                                "-1",
                                "8",
                                "1e-3",
                                "1e-12",
                                "1e300",
                                "1e-300",
                                "1e999",
                                "1e-999",
                                "nan",
                                "-nan",
                                "inf",
                                "-inf",
                                "NAN(1)",
                                "infinity",
                                "0x1p3",
                                "1.",
                                ".1",
                                ".",
                                "-",
                                "+",
                                "e",
                                "1e",
                                "1e+",
                                "2147483647",
                                "2147483648",
                                "9223372036854775807",
                                "9223372036854775808",
                                "-9223372036854775808",
                                "32768",
                                "",
                                " ",
                                " 1"};
    if (below(4)) return pick(known);
    std::string w(below(12), ' ');
    for (char &c : w) c = 1 + below(255);
    if (below(1000) == 0) w.assign(100000, '9');
    return w;
  }

  void mutate(std::string &w)
  {
    const std::size_t at = below(bdh::ssize(w) + 1);
    if (below(2) || at == w.size())
      w.insert(at, 1, static_cast<char>(1 + below(255)));
    else
      w.erase(at, 1);
  }

  std::mt19937_64 random_;
  Words seeds_;
};

bool all_finite(std::initializer_list<double> values)
{
  for (double v : values)
    if (!std::isfinite(v)) return false;
  return true;
}

bool sound(const Quantity &q, bool zero)
{
  return q.is_variable() || (std::isfinite(q.value) && (zero ? q.value >= 0.0 : q.value > 0.0));
}

/// Nothing moves or bears an open face, and no force on all of the fluid acts beside it.
bool sound_open_faces(const FibOptions &o)
{
  for (const auto &axis : o.walls.face)
    for (const auto &wall : axis)
      if (wall.kind == Boundary::open &&
          (wall.moves() || o.body_force != std::array<double, 3>{0.0, 0.0, 0.0}))
        return false;
  return true;
}

bool sound(const FibOptions &o)
{
  if (!sound_open_faces(o)) return false;
  for (const auto &axis : o.walls.face)
    for (const auto &wall : axis)
      if (!all_finite({wall.velocity[0], wall.velocity[1], wall.velocity[2]})) return false;
  for (long n : o.cells)
    if (n < 0 || n > 32768) return false;
  return sound(o.temperature, true) && sound(o.viscosity, false) && o.seed > 0 &&
         o.grid_given() != (o.radius > 0.0) &&
         all_finite({o.radius, o.shear_rate, o.body_force[0], o.body_force[1], o.body_force[2]}) &&
         o.delta >= 1e-12 && o.delta <= 0.1 && o.tolerance >= 1e-14 && o.tolerance <= 0.5;
}

bool sound(const PseOptions &o)
{
  return sound(o.temperature, true) && sound(o.viscosity, false) && o.seed > 0 &&
         std::isfinite(o.radius) && o.radius >= 0.0 && std::isfinite(o.xi) && o.xi >= 0.0 &&
         o.tolerance >= 1e-12 && o.tolerance <= 0.5 && o.iterations >= 2 && o.iterations <= 1000;
}

std::string joined(const Words &words)
{
  std::string all;
  for (const auto &w : words) all += "[" + w.substr(0, 40) + "] ";
  return all;
}

template <class Parse> void fuzz(uint64_t seed, const Words &seeds, Parse parse)
{
  Fuzzer fuzzer(seed, seeds);
  const int most = rounds(100000);
  int accepted = 0;
  for (int i = 0; i < most; ++i) {
    const Words words = fuzzer.list();
    try {
      ASSERT_TRUE(sound(parse(words))) << joined(words);
      ++accepted;
    } catch (const InvalidOption &e) {
      ASSERT_GT(std::string(e.what()).size(), 20u) << joined(words);
    }
  }
  // Some lists are accepted and some rejected, so the test exercises both.
  EXPECT_GT(accepted, most / 20);
  EXPECT_LT(accepted, most / 2);
}

}    // namespace

TEST(Fuzz, FibOptions)
{
  fuzz(1,
       {"1.0 1.0 5 grid 8 8 8",
        "1.0 1.0 5 radius 1.5 kernel bkp6 scheme improved drift rfd delta 1e-4 tolerance 1e-6 fft "
        "estimate",
        "v_T v_eta 12345 grid 8 16 32 wall zlo noslip 1 0 0 wall zhi slip force 1 2 3 crossing "
        "reflect",
        "0 1e-3 7 radius 1 wall ylo noslip 1 0 0 wall yhi open shear 2 rotation yes",
        "0 1e-3 7 radius 1 shear -3 precision single pencils 8"},
       parse_fib_options);
}

TEST(Fuzz, PseOptions)
{
  fuzz(2,
       {"1.0 1.0 5",
        "1.0 1.0 5 radius 1 tolerance 1e-6 xi 0.5 precision double iterations 50 check yes parts "
        "no fft estimate",
        "v_T v_eta 12345 radius atom xi auto precision auto pencils auto"},
       parse_pse_options);
}
