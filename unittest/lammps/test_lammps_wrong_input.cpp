// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Every argument of the styles with every kind of wrong word, and impossible scenes, combinations
// and runs.
//
// Syntax cases are generated from an argument, the command before it, and the words that it must
// reject.  A message names the style, the argument, the word and the rule.  After each error the
// same LAMMPS must be able to continue.

#include "lammps/lammps_mobility.h"
#include "lammps/wrong_input.h"

#include "force.h"

#include <cstdlib>
#include <limits>

using bdh_test::LammpsSession;

namespace {

/// The kind of word that an argument takes.
enum class Takes { number, integer, name };

struct Argument {
  std::string before;    ///< the command up to the argument
  std::string name;      ///< as in messages
  Takes takes;
  std::string rule;                    ///< "must be > 0"
  std::vector<std::string> outside;    ///< well-formed words that break the rule
};

/// The word as a message prints it: 1e-3 appears as 0.001.
std::string printed(const Argument &a, const std::string &word)
{
  if (a.takes == Takes::name) return word;
  std::ostringstream out;
  out.precision(10);
  out << std::strtod(word.c_str(), nullptr);
  return out.str();
}

struct SyntaxCase {
  std::string command, message;
};

std::string quoted(const std::string &word) { return word.empty() ? "\"\"" : word; }

/// Wrong words for an argument, and the message for each.
std::vector<SyntaxCase> cases_of(const Argument &a)
{
  const std::string style = a.before.substr(0, a.before.find(' '));
  std::vector<SyntaxCase> all;
  const auto add = [&](const std::string &word, const std::string &shown, const std::string &rule) {
    all.push_back({"fix 1 all " + a.before + " " + quoted(word),
                   "fix " + style + ": " + a.name + " = " + shown + ", but " + rule});
  };
  all.push_back({"fix 1 all " + a.before,
                 "fix " + style + ": " + a.name + " = (nothing), but a value must follow"});
  static const std::vector<std::string> no_number = {"x",    "1.0x", "nan", "inf", "-inf", "1e999",
                                                     "0x10", "",     "--1", "1,5", "1d3",  "."};
  static const std::vector<std::string> no_integer = {
      "x", "1.5", "8x", "1e3", "0x8", "", "99999999999999999999", "nan"};
  static const std::vector<std::string> no_name = {"", "unknown", "1", "NO_SUCH"};
  if (a.takes == Takes::number)
    for (const auto &w : no_number) add(w, w, "must be a finite number");
  if (a.takes == Takes::integer)
    for (const auto &w : no_integer) add(w, w, "must be an integer");
  if (a.takes == Takes::name)
    for (const auto &w : no_name) add(w, w, a.rule);
  for (const auto &w : a.outside) add(w, printed(a, w), a.rule);
  return all;
}

const std::string fib = "bd/fib 1.0 1.0 5 grid 8 8 8 ", pse = "bd/pse 1.0 1.0 5 radius 1 ";

std::vector<Argument> positional(const std::string &style)
{
  return {{style, "temperature", Takes::number, "must be >= 0", {"-1", "-1e-300"}},
          {style + " 1.0", "viscosity", Takes::number, "must be > 0", {"0", "-1", "-0", "1e-400"}},
          {style + " 1.0 1.0",
           "seed",
           Takes::integer,
           "must be from 1 to 2147483647",
           {"0", "-1", "2147483648", "9000000000000000000"}}};
}

std::vector<Argument> arguments()
{
  std::vector<Argument> all;
  for (const char *style : {"bd/fib", "brownian/fib", "bd/pse", "brownian/pse"})
    for (const Argument &a : positional(style)) all.push_back(a);

  const std::string size = "must be from 1 to 32768", open = "bd/fib 1.0 1.0 5 ";
  all.push_back({open + "grid", "grid nx", Takes::integer, size, {"0", "-8", "32769"}});
  all.push_back({open + "grid 8", "grid ny", Takes::integer, size, {"0", "-8", "32769"}});
  all.push_back({open + "grid 8 8", "grid nz", Takes::integer, size, {"0", "-8", "32769"}});
  all.push_back({open + "radius", "radius", Takes::number, "must be > 0", {"0", "-1"}});
  all.push_back({fib + "kernel",
                 "kernel",
                 Takes::name,
                 "must be roma3, peskin4 or bkp6",
                 {"Peskin4", "peskin"}});
  all.push_back(
      {fib + "scheme", "scheme", Takes::name, "must be midpoint, improved", {"Midpoint"}});
  all.push_back({fib + "drift", "drift", Takes::name, "must be auto, exact, rfd or no", {"yes"}});
  all.push_back({fib + "delta",
                 "delta",
                 Takes::number,
                 "must be from 1e-12 to 0.1",
                 {"0", "-1e-6", "1e-13", "1e-300", "0.2"}});
  all.push_back({fib + "tolerance",
                 "tolerance",
                 Takes::number,
                 "must be from 1e-14 to 0.5",
                 {"0", "-1e-3", "1e-15", "0.6", "1"}});
  all.push_back({fib + "shear", "shear", Takes::number, "", {}});
  all.push_back({fib + "fft", "fft", Takes::name, "must be measure or estimate", {"patient"}});
  all.push_back(
      {fib + "crossing", "crossing", Takes::name, "must be error, reflect or redraw", {"Reflect"}});
  all.push_back({fib + "force", "force fx", Takes::number, "", {}});
  all.push_back({fib + "force 1", "force fy", Takes::number, "", {}});
  all.push_back({fib + "force 1 0", "force fz", Takes::number, "", {}});
  all.push_back({fib + "wall",
                 "wall",
                 Takes::name,
                 "the face must be xlo, xhi, ylo, yhi, zlo or zhi",
                 {"z", "zlow", "ZLO"}});
  for (const char *face : {"xlo", "xhi", "ylo", "yhi", "zlo", "zhi"})
    all.push_back({fib + "wall " + face,
                   std::string("wall ") + face,
                   Takes::name,
                   "must be noslip, slip or open",
                   {"no-slip", "Open"}});
  all.push_back({fib + "wall zlo noslip 1", "wall zlo vy", Takes::number, "", {}});
  all.push_back({fib + "wall zlo noslip 1 0",
                 "wall zlo vz",
                 Takes::number,
                 "a wall can only move along itself",
                 {"1", "-1e-9"}});

  all.push_back({"bd/pse 1.0 1.0 5 radius",
                 "radius",
                 Takes::number,
                 "must be > 0, or the word atom",
                 {"0", "-1"}});
  all.push_back({pse + "tolerance",
                 "tolerance",
                 Takes::number,
                 "must be from 1e-12 to 0.5",
                 {"0", "-1e-3", "1e-13", "0.6"}});
  all.push_back({pse + "xi", "xi", Takes::number, "must be > 0, or the word auto", {"0", "-1"}});
  all.push_back(
      {pse + "precision", "precision", Takes::name, "must be auto, single or double", {"mixed"}});
  all.push_back({pse + "iterations",
                 "iterations",
                 Takes::integer,
                 "must be from 2 to 1000",
                 {"0", "1", "1001", "-5"}});
  all.push_back({pse + "check", "check", Takes::name, "must be yes, no or dt", {"true", "dt2"}});
  all.push_back({fib + "check", "check", Takes::name, "must be dt or no", {"yes"}});
  all.push_back({pse + "parts", "parts", Takes::name, "must be yes or no", {"on"}});
  all.push_back({pse + "fft", "fft", Takes::name, "must be measure or estimate", {"patient"}});
  for (const std::string &style : {fib, pse})
    all.push_back({style + "pencils",
                   "pencils",
                   Takes::integer,
                   "must be from 1 to the number of processes, or the word auto",
                   {"0", "-2", "16777217"}});
  return all;
}

/// A correct command and a step must work after any number of errors.
void expect_usable(LammpsSession &lmp)
{
  EXPECT_EQ(
      lmp.error_of("fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 fft estimate\nrun 1 post no\nunfix 1\n"
                   "fix 1 all bd/pse 1.0 1.0 5 radius 1 fft estimate\nrun 1 post no\nunfix 1"),
      "");
}

}    // namespace

TEST(WrongWords, EachArgumentRefusesThem)
{
  LammpsSession lmp;
  lmp.script(bdh_test::box3);
  int count = 0;
  for (const Argument &a : arguments())
    for (const SyntaxCase &c : cases_of(a)) {
      const std::string message = lmp.error_of(c.command);
      EXPECT_NE(message.find(c.message), std::string::npos)
          << c.command << "\nwanted: " << c.message << "\ngot: " << message;
      EXPECT_EQ(lmp->modify->nfix, 0) << c.command;
      ++count;
    }
  RecordProperty("cases", count);
  EXPECT_GE(count, 400);
  expect_usable(lmp);
}

namespace {

struct Scene {
  const char *scene, *commands, *message;
};

const char spheres[] = R"(
units lj
atom_style sphere
atom_modify map array
neigh_modify every 1 delay 0 check yes
region box block 0 8 0 8 0 8
create_box 1 box
create_atoms 1 single 1 2 3
create_atoms 1 single 5 2 3
)";

const char flat[] = "units lj\ndimension 2\natom_style atomic\natom_modify map array\nregion box "
                    "block 0 8 0 8 -0.5 0.5\ncreate_box 1 box\n"
                    "create_atoms 1 single 1 2 0\nmass 1 1";

const char slit[] =
    "units lj\natom_style atomic\natom_modify map array\nboundary p p f\nneigh_modify every 1 "
    "delay 0 check yes\n"
    "region box block 0 8 0 8 0 8\ncreate_box 1 box\ncreate_atoms 1 single 1 2 3\nmass 1 1";

const char duct[] =
    "units lj\natom_style atomic\natom_modify map array\nboundary p f f\nneigh_modify every 1 "
    "delay 0 check yes\n"
    "region box block 0 8 0 8 0 8\ncreate_box 1 box\ncreate_atoms 1 single 1 2 3\nmass 1 1";

const char nameless[] = "units lj\natom_style atomic\natom_modify id no\nregion box block 0 8 0 8 "
                        "0 8\ncreate_box 1 box\n"
                        "create_atoms 1 single 1 2 0\nmass 1 1";

const char *const box3 = bdh_test::box3;

#define FIB "fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 "
#define PSE "fix 1 all bd/pse 1.0 1.0 5 radius 1 "
#define WALLS_Z "wall zlo noslip wall zhi noslip "
#define WALLS_Y "wall ylo noslip wall yhi noslip "

const Scene scenes[] = {
    // Missing and contradictory arguments
    {box3, "fix 1 all bd/fib 1.0 1.0 5",
     "grid = (not given), but the spacing must be set: with grid nx ny nz, or with radius a"},
    {box3, "fix 1 all bd/pse 1.0 1.0 5",
     "radius = atom, but the atoms of atom_style atomic have no radius: give one as radius a"},
    {box3, FIB "radius 1", "radius = 1, but give either grid or radius"},
    {box3, FIB "kernel roma3 kernel roma3", "keyword = kernel, but it may be given only once"},
    {box3, PSE "xi 1 xi 1", "keyword = xi, but it may be given only once"},
    {box3, FIB "xi 1",
     "keyword = xi, but must be one of adapt, check, constraint, control_variate, crossing, delta, "
     "drift"},
    {box3, PSE "kernel roma3",
     "keyword = kernel, but must be one of adapt, check, control_variate, fft, hold, "
     "hydrodynamics, iterations"},
    {box3, FIB "extra", "keyword = extra, but must be one of"},
    {box3, "fix 1 nobody bd/fib 1.0 1.0 5 grid 8 8 8", "Could not find fix group ID"},
    {nameless, FIB, "fix bd/fib: random numbers are drawn by atom id: use atom_modify id yes"},
    {nameless, PSE, "fix bd/pse: random numbers are drawn by atom id: use atom_modify id yes"},
    {spheres,
     "create_atoms 1 single 3 6 3\nset atom 1 diameter 2\nset atom 3 diameter 1.5\n"
     "fix 1 all bd/pse 1.0 1.0 5 xi 1.2\nrun 1",
     "it must be at most 1.1/(greatest radius)"},
    {spheres, "set atom 1 diameter 0\nfix 1 all bd/pse 1.0 1.0 5\nrun 1",
     "has radius 0 at step 0, but must be > 0"},
    {spheres, "set group all diameter 17\nfix 1 all bd/pse 1.0 1.0 5\nrun 1",
     "radius = 8.5, but a sphere must not be twice as wide"},

    // Geometry
    {box3, "fix 1 all bd/fib 1.0 1.0 5 grid 3 8 8\nrun 1",
     "grid nx = 3, but kernel peskin4 needs at least 4 cells"},
    {box3, "fix 1 all bd/fib 1.0 1.0 5 grid 8 3 8\nrun 1",
     "grid ny = 3, but kernel peskin4 needs at least 4 cells"},
    {box3, "fix 1 all bd/fib 1.0 1.0 5 grid 8 8 2 kernel roma3\nrun 1",
     "grid nz = 2, but kernel roma3 needs at least 3 cells"},
    {box3, "fix 1 all bd/fib 1.0 1.0 5 grid 5 8 8 kernel bkp6\nrun 1",
     "grid nx = 5, but kernel bkp6 needs at least 6 cells"},
    {box3, "fix 1 all bd/fib 1.0 1.0 5 radius 3\nrun 1", "radius = 3, but the box is only"},
    {box3, "fix 1 all bd/fib 1.0 1.0 5 radius 1e300\nrun 1",
     "use a smaller radius, a smaller kernel or a larger box"},
    {box3, "fix 1 all bd/fib 1.0 1.0 5 radius 1e-300\nrun 1",
     "it needs more than 32768 cells along an axis of the box: use a larger radius"},
    {box3, "fix 1 all bd/pse 1.0 1.0 5 radius 8.1\nrun 1",
     "radius = 8.1, but a sphere must not be twice as wide as the box"},
    {box3, "fix 1 all bd/pse 1.0 1.0 5 radius 1e300\nrun 1",
     "use a smaller radius, or a box of more than"},
    {box3, "fix 1 all bd/pse 1.0 1.0 5 radius 1e-300\nrun 1",
     "the box is more than a million radii long: use a larger radius"},
    {box3, "fix 1 all bd/pse 1.0 1.0 5 radius 1\nrun 1\nchange_box all x final 0 0.9\nrun 1",
     "radius = 1, but a sphere must not be twice as wide"},
    {box3, "change_box all triclinic\n" FIB "\nrun 1",
     "the box is triclinic, but must be orthogonal: use change_box all ortho"},
    {box3, FIB "\nrun 1\nchange_box all triclinic\nrun 1",
     "the box is triclinic, but must be orthogonal"},
    {box3, "change_box all boundary f p p\n" FIB "\nrun 1",
     "wall xlo = (not given), but the box is not periodic along x"},
    {box3, "change_box all boundary p f p\n" FIB "\nrun 1",
     "wall ylo = (not given), but the box is not periodic along y"},
    {slit, FIB "\nrun 1",
     "wall zlo = (not given), but the box is not periodic along z, so both faces need a wall: add "
     "wall zlo noslip"},
    {slit, FIB "wall zlo slip\nrun 1",
     "wall zhi = (not given), but the box is not periodic along z"},
    {slit, FIB WALLS_Z "wall xlo slip wall xhi slip\nrun 1",
     "wall = xlo, but the box is periodic along x: remove the wall"},
    {duct, FIB WALLS_Z "\nrun 1", "wall ylo = (not given)"},
    {duct, FIB WALLS_Z WALLS_Y "shear 1",
     "shear = 1, but between walls the flow is that of moving walls"},
    {slit, FIB "wall zlo noslip wall zhi open 1 0 0",
     "wall zhi = open, but there is no wall that could move: leave the velocity out, or give it to "
     "the opposite wall"},
    {slit, FIB "wall zlo slip wall zhi open shear 1",
     "shear = 1, but wall zlo has no friction and bears no shear: use noslip or open there"},
    {box3, "change_box all boundary f p p\n" FIB "wall xlo noslip wall xhi open shear 1",
     "shear = 1, but the flow is along x, which wall xlo crosses: let the wall lie across y or z"},
    {slit, FIB "wall zlo noslip wall zhi open force 1 0 0",
     "force = fx fy fz, but fluid without end behind an open face has no steady flow"},
    {slit, FIB "wall zlo noslip wall zhi open force 0 0 1", "force = fx fy fz, but fluid without"},
    {box3, FIB "wall zlo open wall zhi open\nrun 1",
     "wall = zlo, but the box is periodic along z: remove the wall, or use boundary f"},
    {slit, "change_box all boundary p p fs\n" FIB "wall zlo noslip wall zhi open\nrun 1",
     "face zhi of the box is shrink-wrapped (boundary s or m), but walls must stay in place: use "
     "boundary f, or p without walls; an open face may be shrink-wrapped with keyword radius"},
    {slit,
     "change_box all boundary p p fs\nfix 1 all bd/fib 1.0 1.0 5 radius 1 wall zlo slip wall zhi "
     "open\nrun 1",
     "face zhi of the box is shrink-wrapped (boundary s or m), but walls must stay in place"},
    {slit,
     "change_box all boundary p p ms\nfix 1 all bd/fib 1.0 1.0 5 radius 1 wall zlo open wall zhi "
     "open\nrun 1",
     "face zlo of the box is shrink-wrapped (boundary s or m), but walls must stay in place"},
    {slit,
     "change_box all boundary p p s\nfix 1 all bd/fib 1.0 1.0 5 radius 1 wall zlo noslip wall zhi "
     "open\nrun 1",
     "face zlo of the box is shrink-wrapped (boundary s or m), but walls must stay in place"},
    {slit,
     "change_box all triclinic\nfix 1 all bd/fib 1.0 1.0 5 radius 1 wall zlo noslip wall zhi "
     "open\nrun 1",
     "the box is triclinic, but must be orthogonal"},
    {slit,
     "fix 2 all deform 1 x scale 1.1\nfix 1 all bd/fib 1.0 1.0 5 radius 1 wall zlo noslip wall "
     "zhi open\nrun 1",
     "fix 2 deform changes the box during the run, but the grid is fixed to it"},
    {slit, FIB "wall zlo noslip wall zhi open wall zhi open",
     "wall = zhi, but this face has a wall already"},
    {slit, FIB "wall zhi open\nrun 1",
     "wall zlo = (not given), but the box is not periodic along z, so both faces need a wall: add "
     "wall zlo noslip (or slip, or open)"},
    {duct, FIB WALLS_Y "wall zlo noslip wall zhi open\nrun 1",
     "wall zhi = open, but the box is not periodic along y, and behind an open face"},
    {duct, FIB "wall ylo open wall yhi open wall zlo open wall zhi open\nrun 1",
     "wall ylo = open, but the box is not periodic along z"},
    {box3, FIB "precision half", "precision = half, but must be auto, single or double"},
    {box3, FIB "precision single drift rfd\nrun 1",
     "precision = single, but drift rfd takes differences that single precision would round away: "
     "use precision auto or double"},
    {box3, FIB "precision single hold all 0 0 0\nrun 1",
     "precision = single, but the iteration for motions that are given needs double: use "
     "precision auto or double"},
    {duct, FIB WALLS_Z WALLS_Y "precision single\nrun 1",
     "precision = single, but the iteration for the pressure between walls needs double: use "
     "precision auto or double"},
    {slit, FIB WALLS_Z "crossing redraw scheme improved",
     "crossing = redraw, but scheme improved takes forces within the step"},
    {slit, "change_box all boundary p p s\n" FIB WALLS_Z "\nrun 1",
     "face zlo of the box is shrink-wrapped"},
    {slit, "change_box all boundary p p m\n" FIB WALLS_Z "\nrun 1",
     "face zlo of the box is shrink-wrapped"},
    {slit, "change_box all boundary p p fs\n" FIB WALLS_Z "\nrun 1",
     "face zhi of the box is shrink-wrapped"},
    {slit, PSE "\nrun 1",
     "the box must be periodic in all directions, since Ewald sums cannot represent walls: use "
     "boundary p p "
     "p, or fix bd/fib"},
    {duct, PSE "\nrun 1", "the box must be periodic in all directions"},
    {flat, PSE "\nrun 1",
     "the simulation is two-dimensional, but the Rotne-Prager-Yamakawa mobility is not: use fix "
     "bd/fib"},
    {flat, FIB "\nrun 1", "grid nz = 8, but must be 1 in a two-dimensional simulation"},
    {flat, "fix 1 all bd/fib 1.0 1.0 5 grid 8 8 1 wall zlo slip wall zhi slip\nrun 1",
     "wall = zlo, but the box is periodic along z"},
    {flat,
     "change_box all boundary p f p\nfix 1 all bd/fib 1.0 1.0 5 grid 8 8 1 wall ylo noslip wall "
     "yhi noslip 1 0 0.5\nrun 1",
     "wall yhi vz = 0.5, but must be 0 in a two-dimensional simulation"},

    // Other fixes and settings
    {box3, FIB "\nfix 2 all nve\nrun 1",
     "2 atoms of group all are also integrated by fix 2 nve: unfix it or separate the groups"},
    {box3, FIB "\nfix 2 all nvt temp 1 1 1\nrun 1", "are also integrated by fix 2 nvt"},
    {box3, FIB "\nfix 2 all nve/limit 0.1\nrun 1", "are also integrated by fix 2 nve/limit"},
    {box3, FIB "\nfix 2 all nve/noforce\nrun 1", "are also integrated by fix 2 nve/noforce"},
    {box3, FIB "\nfix 2 all brownian 1.0 5 gamma_t 1\nrun 1",
     "are also integrated by fix 2 brownian"},
    {box3, FIB "\nfix 2 all move linear 1 0 0\nrun 1", "are also integrated by fix 2 move"},
    {box3, FIB "\nfix 2 all rigid single\nrun 1", "are also integrated by fix 2 rigid"},
    {box3, FIB "\nfix 2 all bd/pse 1.0 1.0 6 radius 1\nrun 1",
     "are also integrated by fix 2 bd/pse"},
    {box3, "group one id 1\n" PSE "\nfix 2 one nve\nrun 1",
     "1 atoms of group all are also integrated by fix 2 nve"},
    {box3,
     "group a id 1\ngroup b id 2\nfix 1 a bd/fib 1.0 1.0 5 grid 8 8 8\nfix 2 b bd/pse 1.0 1.0 5 "
     "radius 1\nrun 1",
     "fix 2 bd/pse has the same seed 5"},
    {box3, FIB "\nfix 2 all deform 1 x erate 0.1\nrun 1",
     "fix 2 deform changes the box during the run, but the grid is fixed to it"},
    {box3, FIB "\nfix 2 all press/berendsen iso 0 0 1\nrun 1",
     "fix 2 press/berendsen changes the box during the run"},
    {box3, "change_box all triclinic\n" PSE "\nfix 2 all deform 1 xy erate 0.1 remap v\nrun 1",
     "use remap x, which carries particles along"},
    {box3, "run_style respa 2 2\n" FIB "\nrun 1",
     "run_style respa has no meaning without inertia: use run_style verlet"},
    {box3, "run_style respa 2 2\n" PSE "\nrun 1",
     "run_style respa has no meaning without inertia: use run_style verlet"},
    {box3, "neighbor 0.3 nsq\n" PSE "\nrun 1", "neighbor style must be bin"},
    {box3, "neighbor 8.5 bin\n" PSE "\nrun 1",
     "neighbor skin = 8.5, but must be at most the longest edge of the box, 8"},
    {box3, "neigh_modify once yes\n" PSE "\nrun 1",
     "neigh_modify once yes keeps the neighbor lists of the first step: use once no"},
    {box3, "neigh_modify exclude type 1 1\n" PSE "\nrun 1",
     "neigh_modify exclude keeps pairs out of all neighbor lists"},

    // Values out of reach, alone or in combination
    {box3, PSE "xi 9e-7\nrun 1", "xi = 9e-07, but must be from 1e-6/radius to 20/radius"},
    {box3, PSE "xi 21\nrun 1", "xi = 21, but must be from 1e-6/radius to 20/radius"},
    {box3, PSE "precision single tolerance 1e-6\nrun 1",
     "tolerance = 1e-06, but precision single reaches only 1e-5: use precision auto or double"},

    // Variables
    {box3, "fix 1 all bd/fib v_ 1.0 5 grid 8 8 8",
     "temperature = v_, but a variable needs a name: v_NAME"},
    {box3, "fix 1 all bd/pse 1.0 v_ 5 radius 1",
     "viscosity = v_, but a variable needs a name: v_NAME"},
    {box3, "fix 1 all bd/fib v_T 1.0 5 grid 8 8 8\nrun 1",
     "temperature = v_T, but there is no variable of that name: define it before the run"},
    {box3, "fix 1 all bd/pse 1.0 v_e 5 radius 1\nrun 1",
     "viscosity = v_e, but there is no variable of that name"},
    {box3, "variable T atom 1\nfix 1 all bd/pse v_T 1.0 5 radius 1\nrun 1",
     "temperature = v_T, but the variable must be of style equal"},
    {box3, "variable e string thick\nfix 1 all bd/fib 1.0 v_e 5 grid 8 8 8\nrun 1",
     "viscosity = v_e, but the variable must be of style equal"},
    {box3, "variable T equal 2.5-step\nfix 1 all bd/fib v_T 1.0 5 grid 8 8 8\nrun 9",
     "temperature = -0.5 at step 3, but must be >= 0"},
    {box3, "variable T equal 1e308*10\nfix 1 all bd/pse v_T 1.0 5 radius 1\nrun 1",
     "temperature = inf at step 0, but must be >= 0"},
    {box3, "variable T equal 1e308*10-1e308*10\nfix 1 all bd/pse v_T 1.0 5 radius 1\nrun 1",
     "nan at step 0, but must be >= 0"},
    {box3, "variable e equal 2-step\nfix 1 all bd/pse 1.0 v_e 5 radius 1\nrun 9",
     "viscosity = 0 at step 2, but must be > 0"},
    {box3, FIB "\ntimestep 0\nrun 1", "timestep = 0, but must be > 0"},
    {box3, PSE "\ntimestep -1\nrun 1", "timestep = -1, but must be > 0"},

    // Runs that fail
    {box3, FIB "\ntimestep 1e9\nrun 1",
     "in one step, which is more than half the box: use a smaller timestep"},
    {box3, PSE "\ntimestep 1e9\nrun 1",
     "in one step, which is more than half the box: use a smaller timestep"},
    {box3, "fix 1 all bd/fib 1e300 1.0 5 grid 8 8 8\nrun 1",
     "atom 1 at step 1: its position is not a finite number"},
    {box3, "fix 1 all bd/pse 1.0 1e-300 5 radius 1\nrun 1",
     "its displacement is not a finite number: use a smaller timestep"},
    {box3, FIB "shear 1e300\nrun 1",
     "at step 1: its position is not a finite number, or astronomically far away: use a smaller "
     "timestep"},
    {slit, FIB WALLS_Z "force 1e300 0 0\nrun 1", "at step 1: its position is not a finite number"},
    {slit, FIB "wall zlo noslip 1e300 0 0 wall zhi noslip\nrun 1",
     "at step 1: its position is not a finite number"},
    {box3, FIB "\nvariable x atom (id==2)*1e308*10\nfix 2 all addforce v_x 0 0\nrun 1",
     "atom 2 at step 1: the force on it is not a finite number: atoms may overlap"},
    {box3, PSE "\nvariable x atom (id==2)*1e308*10\nfix 2 all addforce v_x 0 0\nrun 1",
     "atom 2 at step 1: the force on it is not a finite number: atoms may overlap"},
    {box3, "pair_style lj/cut 2.5\npair_coeff * * 1 1\nset atom 2 x 1 y 2 z 3\n" FIB "\nrun 1",
     "the force on it is not a finite number: atoms may overlap"},
    {box3, "pair_style lj/cut 2.5\npair_coeff * * 1 1\nset atom 2 x 1 y 2 z 3\n" PSE "\nrun 1",
     "the force on it is not a finite number: atoms may overlap"},
    {box3, "pair_style lj/cut 2.5\npair_coeff * * 1 1\nset atom 2 x 1.001 y 2 z 3\n" PSE "\nrun 1",
     "use a smaller timestep"},
    {slit, FIB WALLS_Z "\nfix 2 all addforce 0 0 -1e3\ntimestep 1\nrun 50",
     "it is outside the wall zlo"},
    {slit, FIB WALLS_Z "crossing redraw\nfix 2 all addforce 0 0 -1e3\ntimestep 1\nrun 50",
     "it would cross a wall in each of 20 attempts: use a smaller timestep"},
    {box3, FIB "\nrun 1\nunfix 1\n" FIB "\nrun 1 pre no",
     "the fix was defined after the last setup and is not initialised: use run with pre yes"},
    {box3, PSE "\nrun 1\nunfix 1\n" PSE "\nrun 1 pre no",
     "the fix was defined after the last setup and is not initialised: use run with pre yes"},
    {box3, "group one id 1\natom_modify first one\ncomm_modify group one\n" PSE "\nrun 1",
     "comm_modify group one keeps ghosts of other atoms from the fix: use comm_modify group all"},
    {box3, PSE "xi 0.01\nrun 1",
     "neighbors per particle in a box of 8 x 8 x 8, more than 1e+06: use a larger one, or xi auto"},
    {box3, PSE "xi 0.02 precision single tolerance 1e-4\nrun 1",
     "precision single does not reach the tolerance with it: use precision double"},
    {box3, PSE "tolerance 1e-9 xi 1 iterations 2\nrun 1",
     "Lanczos has not converged after 2 iterations"},
};

}    // namespace

TEST(WrongScenes, EachGivesItsMessage)
{
  for (const Scene &s : scenes) {
    LammpsSession lmp;
    lmp.script(s.scene);
    const std::string message = lmp.error_of(s.commands);
    EXPECT_NE(message.find(s.message), std::string::npos)
        << s.commands << "\nwanted: " << s.message << "\ngot: " << message;
  }
  RecordProperty("cases", std::size(scenes));
}

namespace {

// These do not stop the run, but the user must be told.
const Scene warnings[] = {
    {box3, "neigh_modify delay 10\npair_style zero 2\npair_coeff * *\n" FIB "\nrun 0",
     "use neigh_modify every 1 delay 0 check yes"},
    {box3, "neigh_modify every 5\n" PSE "\nrun 0", "use neigh_modify every 1 delay 0 check yes"},
    {box3, FIB "\nfix 2 all langevin 1 1 1 5\nrun 0",
     "fix 2 langevin acts on velocities, which here are displacement/dt"},
    {box3, PSE "\nfix 2 all viscous 1\nrun 0",
     "fix 2 viscous acts on velocities, which here are displacement/dt"},
    {box3, "fix 1 all bd/fib 1.0 1.0 5 grid 9 8 8\nrun 0", "the cells are not cubic"},
    {box3, "fix 1 all bd/fib 1.0 1.0 5 radius 1.1\nrun 0",
     "the nearest that a grid of this box gives is"},
    {spheres, "set atom 1 diameter 2\n" FIB "\nrun 0",
     "the atoms' radii go from 0.5 to 1, but kernel and grid give all of them"},
    {box3, FIB "\nfix 2 all temp/berendsen 1 1 1\nrun 0",
     "fix 2 temp/berendsen acts on velocities, which here are displacement/dt"},
    {box3, FIB "\nfix 2 all momentum 1 linear 1 1 1\nrun 0",
     "fix 2 momentum acts on velocities, which here are displacement/dt"},
    {box3,
     "fix 1 all bd/fib 0 1 5 grid 8 8 8\nneigh_modify delay 10\nfix 2 all addforce 5 0 0\ntimestep "
     "10\nrun 1",
     "wraps atoms back into the box only every 10 steps (neigh_modify every 1 delay 10)"},
    {box3, "fix 1 all bd/pse 0 1 5 radius 1 xi 0.05\nrun 0",
     "neighbors per particle, which take much time and memory"},
    // A check that needs a longer neighbor list than the run
    {box3, PSE "tolerance 1e-2 xi 10 check yes\nrun 0",
     "check of the tolerance 0.01 against a solve to 0.0001"},
    {box3, FIB "force 1 0 0\nrun 0",
     "no effect, since no wall without slip lies along it, or walls lie across it"},
    {box3, "change_box all boundary p p f\n" FIB "wall zlo slip wall zhi slip force 1 0 0\nrun 0",
     "no effect, since no wall without slip"},
    {box3, "change_box all boundary p p f\n" FIB "wall zlo noslip wall zhi slip force 0 0 1\nrun 0",
     "no effect, since no wall without slip"},
    {box3,
     FIB "\nfix 2 all box/relax iso 0\npair_style lj/cut 2\npair_coeff * * 1 1\nminimize 0 0 1 "
         "1\nunfix 2\nrun 0",
     "plan"},
    {box3, FIB "\ntimestep 20\nrun 9", "in one step, which is more than the grid spacing = 1"},
    {box3, "fix 1 all bd/pse 1.0 1.0 5 radius 0.1 xi 5\ntimestep 0.1\nrun 9",
     "in one step, which is more than the radius = 0.1"},
    {box3, FIB "\nrun 2\nreset_timestep 0\nrun 1", "step 1 was taken before (reset_timestep?)"},
    {box3,
     "group a id 1\ngroup b id 2\nfix 1 a bd/fib 1.0 1.0 5 grid 8 8 8\nfix 2 b bd/fib 1.0 1.0 6 "
     "grid 8 8 8\nrun 0",
     "has a fluid of its own, so particles of the two fixes do not interact through a fluid"},
    {box3, PSE "\nfix 2 all deform 1 x erate 0.01 remap none\nrun 0",
     "changes the box but does not carry particles along"},
    {box3, FIB "scheme improved\nfix 2 all langevin 1 1 1 5\nrun 0",
     "scheme improved evaluates forces twice a step, and fix 2 langevin"},
};

void expect_warning(LammpsSession &lmp, const Scene &s)
{
  lmp.script(s.scene);
  EXPECT_EQ(lmp.error_of(s.commands), "") << s.commands;
  EXPECT_NE(lmp.log().find(s.message), std::string::npos)
      << s.commands << "\nwanted: " << s.message;
}

}    // namespace

TEST(WarnedScenes, EachGivesItsWarning)
{
  for (const Scene &s : warnings) {
    LammpsSession lmp;
    expect_warning(lmp, s);
  }
}

TEST(WarnedScenes, FixThatAdvancesWithEachEvaluation)
{
  LammpsSession lmp;
  if (!lmp->modify->fix_map->count("smd")) GTEST_SKIP() << "needs package EXTRA-FIX";
  expect_warning(lmp,
                 {box3, FIB "scheme improved\nfix 2 all smd cvel 5.0 0.5 tether 7 1 1 1.0\nrun 0",
                  "scheme improved evaluates forces twice a step, and fix 2 smd"});
}

// Whatever other code wrote into the positions, the message names the atom and the step.
TEST(WrongScenes, PositionThatIsNoNumber)
{
  for (const char *fix : {FIB, PSE}) {
    LammpsSession lmp;
    lmp.script(box3);
    bdh_test::AtForces spoil(lmp, [](const bdh_test::AtForces::Call &call) {
      for (int i = 0; i < call.atoms; ++i)
        if (call.step == 3 && call.id[i] == 2)
          call.x[i][1] = std::numeric_limits<double>::quiet_NaN();
    });
    const std::string message = lmp.error_of(std::string(fix) + "\ntimestep 1e-4\nrun 9");
    EXPECT_NE(message.find("atom 2 at step 4: its position is not a finite number"),
              std::string::npos)
        << message;
    EXPECT_NE(message.find("use a smaller timestep"), std::string::npos) << message;
  }
}

namespace {

struct PairCase {
  std::string commands, message;
};

/// A numeric coefficient: its position in the command, its name, and whether 0 is allowed.
struct Coefficient {
  const char *before, *after, *name;
  bool zero;
};

std::vector<PairCase> pair_cases()
{
  const Coefficient coefficients[] = {
      {"direct", "4", "c", true},
      {"direct 1", "", "D", false},
      {"density", "0.5 2 1", "sigma_c", false},
      {"density 1", "2 1", "sigma_d", false},
      {"density 1 0.5", "1", "n", true},
      {"density 1 0.5 2", "", "T", false},
      {"fraction", "0.5 2 1", "sigma_c", false},
      {"fraction 1", "2 1", "sigma_d", false},
      {"fraction 1 0.5", "1", "eta_r", true},
      {"fraction 1 0.5 2", "", "T", false},
  };
  std::vector<PairCase> all;
  for (const Coefficient &c : coefficients) {
    std::vector<std::string> words = {"x", "1.0x", "nan", "inf", "1e999", "0x10", "", "-1"};
    if (!c.zero) words.push_back("0");
    for (const auto &w : words)
      all.push_back({std::string("pair_coeff 1 1 ") + c.before + " " + quoted(w) + " " + c.after,
                     std::string("Pair style asakura/oosawa: ") + c.name + " = " + w +
                         " in pair_coeff, but it must be a finite number " +
                         (c.zero ? ">= 0" : "> 0")});
  }
  for (const char *words : {"direct", "direct 1", "direct 1 2 3", "density 1 2 3",
                            "density 1 2 3 4 5", "fraction 1", "direct 1 2 3 4"})
    all.push_back({std::string("pair_coeff 1 1 ") + words, "but the form needs"});
  for (const char *words : {"colour 1 2", "1 2 3", "Direct 1 2 3", "\"\" 1 2"})
    all.push_back({std::string("pair_coeff 1 1 ") + words,
                   "is unknown, but must be direct, density or fraction"});
  all.push_back(
      {"pair_coeff 1 1", "pair_coeff has no values, but needs them after the two atom types"});
  all.push_back(
      {"pair_coeff 1 1 file", "words after 'file', but needs 2; write 'file FILENAME ENTRY'"});
  all.push_back({"pair_coeff 1 1 file none.asakura_oosawa", "words after 'file', but needs 2"});
  all.push_back({"pair_coeff 1 1 file none.asakura_oosawa x",
                 "file none.asakura_oosawa cannot be read, but must be a readable parameter file"});
  all.push_back({"pair_coeff 1 1 file " BDH_POTENTIALS_DIR
                 "/Delong2014.asakura_oosawa no_such_entry",
                 "entry no_such_entry is not in file"});
  all.push_back({"pair_style asakura/oosawa 1 2", "2 arguments, but at most one is allowed"});
  for (const char *cutoff : {"0", "-1"})
    all.push_back({std::string("pair_style asakura/oosawa ") + cutoff,
                   std::string("cutoff = ") + cutoff + ", but it must be a finite number > 0"});
  all.push_back({"pair_style asakura/oosawa 1.5\npair_coeff 1 1 direct 1 2\nrun 0",
                 "cutoff = 1.5, but it must be >= D = 2 of atom types 1 and 1"});
  all.push_back({"pair_style asakura/oosawa\npair_coeff 1 1 density 1 0.5 1e308 1e308\nrun 0",
                 "c = inf for atom types 1 and 1"});
  all.push_back({"pair_style asakura/oosawa\npair_coeff 1 1 fraction 1 1e-200 1 1\nrun 0",
                 "c = inf for atom types 1 and 1"});
  return all;
}

}    // namespace

TEST(WrongPairs, EachGivesItsMessage)
{
  LammpsSession lmp;
  lmp.script(box3);
  lmp.script("pair_style asakura/oosawa");
  const std::vector<PairCase> cases = pair_cases();
  for (const PairCase &c : cases) {
    const std::string message = lmp.error_of(c.commands);
    EXPECT_NE(message.find(c.message), std::string::npos)
        << c.commands << "\nwanted: " << c.message << "\ngot: " << message;
    if (!lmp->force->pair)
      lmp.script("pair_style asakura/oosawa");    // a rejected style no longer exists
  }
  EXPECT_GE(cases.size(), 100u);
  EXPECT_EQ(lmp.error_of("pair_style asakura/oosawa\npair_coeff * * direct 1 2\nrun 0 post no"),
            "");
}
