// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Grids in pencils give the trajectory of one rank, in every geometry and with all that particles
// spread and interpolate.  Run under mpirun -np 4 or 16.

#include "lammps/lammps_ranks.h"
#include "lammps/lammps_scenes.h"
#include "lammps/lammps_spheres.h"

#include <utility>

using namespace bdh_test;

namespace {

using Vector = std::vector<double>;

const std::string periodic = "fix move all bd/fib 0.7 0.9 4711 fft estimate grid 20 24 16 ";

/// Numbers of ranks, and how many of them share a slab: all of one slab, equal groups of them, and
/// some that are left over.
std::vector<std::array<int, 2>> layouts()
{
  if (all_ranks() < 16) return {{2, 2}, {3, 2}, {4, 2}, {4, 3}, {4, 4}};
  return {{5, 2}, {8, 4}, {13, 5}, {16, 4}, {16, 16}};
}

/// Positions, orientations where atoms have some, and numbers `from` .. `to` - 1 of the fix's
/// vector.
struct Compared {
  std::string before;
  int from = 0, to = 0;
  bool turns = false;

  Vector after(int ranks, const std::string &fix, int steps) const
  {
    Vector v;
    on_ranks(ranks, before, "", [&](LammpsSession &lmp) {
      lmp.script(fix);
      lmp.command("run " + std::to_string(steps));
      v = lmp.unwrapped_positions();
      if (turns)
        for (double mu : dipoles(lmp, lmp->world)) v.push_back(mu);
      for (int n = from; n < to; ++n) v.push_back(lmp.fix("move")->compute_vector(n));
    });
    return v;
  }
  /// %: where " pencils N" goes.
  void expect_same(const std::string &fix, int steps, double bound) const
  {
    const auto with = [&fix](const std::string &pencils) {
      const std::size_t at = fix.find('%');
      return at == std::string::npos ? fix + pencils
                                     : fix.substr(0, at) + pencils + fix.substr(at + 1);
    };
    const Vector one = after(1, with(""), steps);
    for (const auto &[ranks, share] : layouts()) {
      const Vector many = after(ranks, with(" pencils " + std::to_string(share)), steps);
      if (my_rank()) continue;
      ASSERT_EQ(many.size(), one.size());
      double worst = 0.0;
      for (std::size_t k = 0; k < one.size(); ++k)
        worst = std::max(worst, std::fabs(many[k] - one[k]) / (1.0 + std::fabs(one[k])));
      EXPECT_LT(worst, bound) << ranks << " ranks, " << share << " in each slab: " << fix;
    }
  }
};

/// A suspension that stays away from the faces of its box.
std::string walled(const std::string &boundary)
{
  return "units lj\natom_style atomic\natom_modify map array\nboundary " + boundary + R"(
region box block 0 10 0 12 0 8
create_box 1 box
region inner block 0.5 9.5 0.5 11.5 0.5 7.5
lattice sc 0.125 origin 0.3 0.3 0.3
create_atoms 1 region inner
mass 1 1.0
pair_style lj/cut 1.122462048309373
pair_coeff 1 1 1.0 1.0
)";
}

}    // namespace

TEST(LammpsPencilsRanks, Periodic)
{
  const Compared scene{bonded_suspension};
  for (const char *more : {"", "scheme trapezoidal shear 0.3 drift rfd kernel bkp6"})
    scene.expect_same(periodic + more, 10, 1e-9);
  scene.expect_same(periodic + "precision single", 5, 2e-6);
}

// The slow axis is the one across the walls, whichever of the box it is.
TEST(LammpsPencilsRanks, SlitsAndOpenFaces)
{
  for (const char *axis : {"x", "z"}) {
    const Compared slit{walled(*axis == 'x' ? "f p p" : "p p f")};
    const std::string lo = std::string(" wall ") + axis + "lo noslip",
                      hi = std::string(" wall ") + axis + "hi ";
    slit.expect_same(periodic + "crossing reflect force 0.1 0.1 0.1" + lo + hi + "slip", 10, 1e-9);
    slit.expect_same(periodic + "crossing reflect" + lo + hi + "open", 10, 1e-9);
  }
}

TEST(LammpsPencilsRanks, StressletsAndHeldAtoms)
{
  const Compared fib{lattice_suspension, 9, 45};
  fib.expect_same("group wall id 3 9 17\nfix move all bd/fib 0.7 0.9 4711 fft estimate radius 1.0 "
                  "stresslet yes hold wall 0.1 0 -0.2",
                  3, 1e-8);
}

TEST(LammpsPencilsRanks, SplitEwald)
{
  const std::string equal = "fix move all bd/pse 0.7 0.9 4711 radius 0.6 fft estimate ";
  const Compared scene{bonded_suspension};
  scene.expect_same(equal + "xi 0.9 precision double tolerance 1e-6", 5, 1e-9);
  scene.expect_same(equal + "tolerance 1e-2", 5, 2e-5);
}

TEST(LammpsPencilsRanks, UnequalSpheresThatTurnInShear)
{
  const Compared scene{dipole_spheres, 8, 26, true};
  scene.expect_same(std::string(field_command) + no_forces +
                        "fix move all bd/pse 0.7 0.9 4711 radius atom fft estimate precision "
                        "double xi 0.6 stresslet yes tolerance 1e-4%\nfix flow all deform 1 xz "
                        "erate 0.5 remap x",
                    3, 1e-8);
}
