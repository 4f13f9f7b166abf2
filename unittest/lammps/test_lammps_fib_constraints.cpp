// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/fib with rigid spheres in a flow (stresslet), and with atoms that are held.

#include "lammps/lammps_turning.h"
#include "lammps/wrong_input.h"
#include "support/reference_json.h"

#include <gtest/gtest.h>

using namespace bdh_test;

namespace {

using Vector = std::vector<double>;

// Numbers of the fix's vector: 8 of all fixes, the crossings, 18 of walls, then those of
// constraints.
double figure(LammpsSession &lmp, int n) { return lmp.fix("move")->compute_vector(n - 1); }
constexpr int first_figure = 28;

void create_box(LammpsSession &lmp, const Vector &lengths, const std::string &boundary)
{
  std::string box = "region box block";
  for (double length : lengths) box += " 0 " + text(length);
  lmp.script("units lj\natom_style sphere\natom_modify map array\nboundary " + boundary + "\n" +
             box + " units box\ncreate_box 1 box\n");
}

constexpr const char *settings = "set type 1 diameter 2.0\npair_style zero 1.0\npair_coeff * *\n"
                                 "neigh_modify every 1 delay 0 check yes\n";

}    // namespace

// A rigid sphere in shear, with a force and a torque, as an independent program finds them: in
// LAMMPS' columns and figures, with Batchelor's sign.
TEST(LammpsFibConstraints, RigidSphereInShear)
{
  const auto cases = json_reference("fib_stresslet.json")["cases"];
  for (const auto &c : cases) {
    if (c["N"] != 1) continue;
    LammpsSession lmp;
    const double rate = 2.0 * c["Einf"][0][1].get<double>();
    create_box(lmp, {12, 12, 12}, "p p p");
    create_atoms(lmp, flatten(c["x"]));
    const Vector f = flatten(c["f"]), T = flatten(c["torque"]);
    AtForces loads(lmp, [&](const AtForces::Call &call) {
      for (int d = 0; d < 3; ++d) {
        call.force[0][d] = f[d];
        lmp->atom->torque[0][d] += T[d];
      }
    });
    lmp.script(std::string(settings) + "timestep 1e-8\nfix move all bd/fib 0.0 " + text(c["eta"]) +
               " 5 grid 12 12 12 fft estimate rotation yes stresslet yes constraint 1e-8 kernel " +
               (c["kernel_J"] == 4 ? "peskin4" : "roma3") + " shear " + text(rate) + "\nrun 1");
    Vector u = lmp.velocities(), omega = omegas(lmp);
    u[0] -= rate * c["x"][0][1].get<double>();
    omega[2] += 0.5 * rate;
    EXPECT_LT(relative_error(u, flatten(c["u_rel"])), 1e-6);
    EXPECT_LT(relative_error(omega, flatten(c["omega_rel"])), 1e-6);
    const Vector columns = lmp.per_atom("move", 9);
    const int order[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
    Vector S, expected, stress, expected_stress;
    for (int k = 0; k < 6; ++k) {
      S.push_back(columns[k]);
      expected.push_back(-c["S"][0][order[k][0]][order[k][1]].get<double>());
      stress.push_back(figure(lmp, first_figure + 1 + k));
      expected_stress.push_back(c["stress"][order[k][0]][order[k][1]]);
    }
    EXPECT_LT(relative_error(S, expected), 1e-7);
    EXPECT_LT(relative_error(stress, expected_stress), 1e-7);
    EXPECT_NEAR(columns[8], omegas(lmp)[2], 1e-12);
    EXPECT_NEAR(figure(lmp, first_figure + 14), 1.0 + stress[3] / (c["eta"].get<double>() * rate),
                1e-10);
    EXPECT_GT(figure(lmp, first_figure), 0.0);
  }
}

// Suspensions between walls that shear them.  Couette flow of the rate g is what the walls need to
// make, so by the reciprocal theorem the excess force on each of them is the sum of the stresslets
// over the distance, and the walls balance each other.
TEST(LammpsFibConstraints, WallsBearTheStressletsInASlit)
{
  for (const char *normal : {"y", "z"}) {
    const bool along_z = *normal == 'z';
    LammpsSession lmp;
    create_box(lmp, {12, 12, 12}, along_z ? "p p f" : "p f p");
    create_atoms(lmp, {2, 5, 3, 7, 8, 8, 9, 3, 5, 4, 10, 9});
    const double rate = 0.3, eta = 0.7;
    lmp.script(std::string(settings) + "timestep 1e-8\nfix move all bd/fib 0.0 " + text(eta) +
               " 5 radius 1.0 fft estimate stresslet yes constraint 1e-9 wall " + normal +
               "lo noslip wall " + normal + "hi noslip " + text(12.0 * rate) + " 0 0\nrun 1");
    const Vector columns = lmp.per_atom("move", 9);
    double S = 0.0;
    for (int i = 0; i < 4; ++i) S += columns[9 * i + (along_z ? 4 : 3)];
    const int wall = 10 + 6 * (along_z ? 2 : 1);    // force along x on the lower wall
    const double shear = eta * rate * 144.0;
    EXPECT_NEAR(figure(lmp, wall), shear + S / 12.0, 1e-6 * shear) << normal;
    EXPECT_NEAR(figure(lmp, wall + 3), -shear - S / 12.0, 1e-6 * shear) << normal;
    EXPECT_GT(S, 0.02 * shear * 12.0);
    EXPECT_NEAR(figure(lmp, first_figure + 14), 1.0 + S / (12.0 * shear), 1e-7);
  }
}

// The force that the fluid exerts on an atom that is dragged is minus that which moves it as fast.
TEST(LammpsFibConstraints, DragOnAnAtomThatIsHeld)
{
  const auto run = [](const std::string &more, auto read) {
    LammpsSession lmp;
    create_box(lmp, {10, 10, 10}, "p p p");
    create_atoms(lmp, {2, 3, 4, 6, 6, 6});
    lmp.script(std::string(settings) + "timestep 1e-8\ngroup bead id 1\nvariable pull equal 0.2\n" +
               more + "\nrun 1");
    return read(lmp);
  };
  const std::string fix = "fix move all bd/fib 0.0 0.7 5 radius 1.0 fft estimate ";
  for (const char *more : {"", " rotation yes", " stresslet yes"}) {
    const int columns = *more == ' ' && more[1] == 's' ? 15 : 6;
    const Vector held =
        run(fix + "constraint 1e-10 hold bead 0.2 0 v_pull" + more, [columns](LammpsSession &lmp) {
          Vector v = lmp.velocities();
          const Vector all = lmp.per_atom("move", columns);
          v.insert(v.end(), &all[columns - 6], &all[columns - 3]);
          for (int d = 0; d < 3; ++d) v.push_back(figure(lmp, first_figure + 15 + d));
          return v;
        });
    EXPECT_EQ(held[0], 0.2);
    EXPECT_EQ(held[1], 0.0);
    EXPECT_EQ(held[2], 0.2);
    for (int d = 0; d < 3; ++d) EXPECT_NEAR(held[6 + d], held[9 + d], 1e-12);
    if (*more) continue;
    const Vector free = run("fix pull bead addforce " + text(-held[6]) + " " + text(-held[7]) +
                                " " + text(-held[8]) + "\n" + fix,
                            [](LammpsSession &lmp) { return lmp.velocities(); });
    EXPECT_LT(relative_error(Vector(held.begin(), held.begin() + 6), free), 1e-8);
  }
}

TEST(LammpsFibConstraints, WrongInput)
{
  const char *const begin = "fix move all bd/fib 1.0 1.0 12345 grid 8 8 8 ";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"stresslet maybe", "stresslet = maybe, but must be yes or no"},
      {"stresslet yes scheme improved", "stresslet = yes, but needs scheme midpoint"},
      {"hold all 0 0 0 scheme trapezoidal", "hold = all, but needs scheme midpoint"},
      {"stresslet yes drift rfd", "stresslet = yes, but needs drift auto"},
      {"stresslet yes hydrodynamics no", "stresslet = yes, but needs hydrodynamics yes"},
      {"control_variate yes", "control_variate = yes, but needs stresslet yes or hold"},
      {"stresslet yes control_variate yes crossing redraw",
       "control_variate = yes, but needs crossing error or reflect"},
      {"hold all 0 0 0 hydrodynamics no", "hold = all, but needs hydrodynamics yes"},
      {"hold all 0 0", "hold velocity"},
      {"constraint 2", "constraint = 2"},
      {"hold nobody 0 0 0\nrun 0", "hold nobody: there is no group of that name"},
      {"hold all 0 0 v_none\nrun 1", "hold all = v_none, but there is no variable of that name"}};
  for (const auto &c : cases) expect_message({(begin + c.first).c_str(), c.second.c_str()});
  expect_message({"change_box all boundary f p f\nfix 1 all bd/fib 1 1 5 grid 8 8 8 stresslet yes "
                  "wall xlo noslip wall xhi noslip 0 1 0 wall zlo noslip wall zhi noslip\nrun 0",
                  "stresslet = yes is not possible in a duct or a closed box with moving walls"});
}
