// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// fix bd/pse with rigid spheres in a flow (stresslet), and with atoms that are held.

#include "lammps/lammps_scenes.h"
#include "lammps/lammps_turning.h"
#include "lammps/wrong_input.h"
#include "support/reference_json.h"
#include "support/test_support.h"

#include <gtest/gtest.h>

using namespace bdh_test;

namespace {

using Vector = std::vector<double>;

double figure(LammpsSession &lmp, int n) { return lmp.fix("move")->compute_vector(n - 1); }

/// Spheres of a case of fts_rigid.json.
void create_spheres(LammpsSession &lmp, const nlohmann::json &c)
{
  bdh::Cell cell = bdh_test::cell_of(c["box"]);
  lmp.script("units lj\natom_style sphere\natom_modify map array\nboundary p p p\n");
  std::string box = "region box prism";
  for (double length : {cell.lx, cell.ly, cell.lz}) box += " 0 " + text(length);
  lmp.script(box + " " + text(cell.xy) + " " + text(cell.xz) + " " + text(cell.yz) +
             " units box\ncreate_box 1 box\n");
  create_atoms(lmp, flatten(c["x"]));
  LAMMPS_NS::Atom &atom = *lmp->atom;
  for (int i = 0; i < atom.nlocal; ++i) atom.radius[i] = c["radius"][atom.tag[i] - 1];
  lmp.script("pair_style zero 1.0\npair_coeff * *\n"
             "neigh_modify every 1 delay 0 check yes\ntimestep 1e-8\n");
}

/// xx, yy, zz, xy, xz, yz of a tensor.
Vector six_of(const nlohmann::json &t)
{
  return {t[0][0], t[1][1], t[2][2], t[0][1], t[0][2], t[1][2]};
}

/// The flow of a box whose edges move, with an upper triangular gradient L_ab = d u_a/d x_b whose
/// symmetric part is E.
struct Flow {
  double L[3][3] = {};
  explicit Flow(const nlohmann::json &E)
  {
    for (int a = 0; a < 3; ++a)
      for (int b = a; b < 3; ++b) L[a][b] = (a == b ? 1.0 : 2.0) * E[a][b].get<double>();
  }
  std::string command(const bdh::Cell &c) const
  {
    return "fix flow all deform 1 x erate " + text(L[0][0]) + " y erate " + text(L[1][1]) +
           " z erate " + text(L[2][2]) + " xy vel " + text(L[0][0] * c.xy + L[0][1] * c.ly) +
           " xz vel " + text(L[0][0] * c.xz + L[0][1] * c.yz + L[0][2] * c.lz) + " yz vel " +
           text(L[1][1] * c.yz + L[1][2] * c.lz) + " remap x";
  }
  double spin(int d) const
  {
    const double half_curl[3] = {-0.5 * L[1][2], 0.5 * L[0][2], -0.5 * L[0][1]};
    return half_curl[d];
  }
};

/// One sphere per cell of a simple cubic lattice at phi = 0.1, with a flow; eta = 0.7.
void lattice(LammpsSession &lmp, const std::string &units, double length, const std::string &fix,
             const std::string &flow)
{
  const double L = length * std::cbrt(4.0 / 3.0 * M_PI / 0.1);
  lmp.script("units " + units + "\natom_style sphere\natom_modify map array\nregion box prism 0 " +
             text(L) + " 0 " + text(L) + " 0 " + text(L) +
             " 0 0 0 units box\ncreate_box 1 box\ncreate_atoms 1 single 1 1 1 units box\n"
             "set type 1 diameter " +
             text(2.0 * length) + "\npair_style zero " + text(length) +
             "\npair_coeff * *\nneigh_modify every 1 delay 0 check yes\n" + fix + "\n" + flow);
}

}    // namespace

// Velocities, angular velocities, stresslets and stress of rigid spheres in shear and in other
// flows, with forces and torques on them.
TEST(LammpsStresslets, RigidSpheresInAnyFlow)
{
  const auto cases = json_reference("fts_rigid.json")["cases"];
  for (const auto &c : cases) {
    LammpsSession lmp;
    create_spheres(lmp, c);
    const double tolerance = 1e-4;
    const Flow flow(c["Einf"]);
    const Vector f = flatten(c["f"]), T = flatten(c["torque"]);
    const std::size_t n = f.size() / 3;
    AtForces loads(lmp, [&](const AtForces::Call &call) {
      for (int i = 0; i < call.atoms; ++i)
        for (int d = 0; d < 3; ++d) {
          call.force[i][d] = f[3 * (call.id[i] - 1) + d];
          lmp->atom->torque[i][d] += T[3 * (call.id[i] - 1) + d];
        }
    });
    lmp.script("fix move all bd/pse 0.0 " + text(c["eta"]) +
               " 12345 radius atom rotation yes stresslet yes fft estimate tolerance " +
               text(tolerance) + "\n" + flow.command(bdh_test::cell_of(c["box"])) + "\nrun 1");
    EXPECT_LE(relative_error(lmp.velocities(), flatten(c["u_rel"])), tolerance) << c["id"];
    Vector omega = omegas(lmp), S, expected;
    const Vector columns = lmp.per_atom("move", 9);
    for (std::size_t i = 0; i < n; ++i) {
      for (int d = 0; d < 3; ++d) {
        EXPECT_NEAR(columns[9 * i + 6 + d], omega[3 * i + d], 1e-12);
        omega[3 * i + d] -= flow.spin(d);
      }
      S.insert(S.end(), &columns[9 * i], &columns[9 * i] + 6);
      for (double s : six_of(c["S"][i])) expected.push_back(-s);
    }
    EXPECT_LE(relative_error(omega, flatten(c["omega_rel"])), tolerance) << c["id"];
    EXPECT_LE(relative_error(S, expected), tolerance) << c["id"];
    Vector stress;
    for (int k = 0; k < 6; ++k) stress.push_back(figure(lmp, 10 + k));
    EXPECT_LE(relative_error(stress, six_of(c["stress"])), 2.0 * tolerance) << c["id"];
  }
}

// The relative viscosity of a lattice has a closed form, in any units and along any axes.
TEST(LammpsStresslets, ViscosityOfALattice)
{
  const double off_axes = 1.2411773063017446, along_axes = 1.359646335197423;
  const std::string fix = "fix move all bd/pse 0.0 0.7 12345 radius atom stresslet yes tolerance "
                          "1e-6 fft estimate\n";
  for (const auto &plane : {"xy", "xz", "yz"}) {
    LammpsSession lmp;
    lattice(lmp, "lj", 1.0, fix,
            std::string("fix flow all deform 1 ") + plane + " erate 0.3 remap x\n");
    lmp.script("timestep 1e-6\nrun 2");
    EXPECT_NEAR(figure(lmp, 23), off_axes, 2e-5) << plane;
  }
  for (const auto &axes : {"x erate 0.3 y erate -0.3", "z erate 0.4 x erate -0.2 y erate -0.2"}) {
    LammpsSession lmp;
    lattice(lmp, "lj", 1.0, fix, std::string("fix flow all deform 1 ") + axes + " remap x\n");
    lmp.script("timestep 1e-6\nrun 2");
    EXPECT_NEAR(figure(lmp, 23), along_axes, 2e-5) << axes;
  }
  LammpsSession lmp;
  lattice(lmp, "real", 500.0, fix, "fix flow all deform 1 xy erate 1e-9 remap x\n");
  lmp.script("timestep 1\nrun 2");
  EXPECT_NEAR(figure(lmp, 23), off_axes, 2e-5);
}

// A held lattice in a fluid that it is drawn through feels the drag of sedimentation: the force of
// the fluid on it is minus that which would move it.
TEST(LammpsStresslets, DragOnAHeldLattice)
{
  const auto drag_at = [](const std::string &keywords) {
    LammpsSession lmp;
    lattice(lmp, "lj", 1.0,
            "fix move all bd/pse 0.0 0.7 12345 radius 1.0 tolerance 1e-6 fft estimate hold all "
            "0.2 0 v_up " +
                keywords + "\nvariable up equal 0.1\n",
            "");
    lmp.script("timestep 1e-6\nrun 1");
    EXPECT_NEAR(lmp.velocities()[0], 0.2, 1e-14);
    EXPECT_NEAR(lmp.velocities()[2], 0.1, 1e-14);
    EXPECT_NEAR(figure(lmp, 26), 0.5 * figure(lmp, 24), 1e-5);
    const int first = keywords.empty() ? 0 : 9;
    EXPECT_NEAR(lmp.per_atom("move", first + 6)[first], figure(lmp, 24), 1e-12);
    return figure(lmp, 24) / (-6.0 * M_PI * 0.7 * 0.2);
  };
  // U/U0 of lattice_sedimentation.csv and fts_lattice.csv at phi = 0.1; symmetry decouples strain.
  EXPECT_NEAR(1.0 / drag_at(""), 0.2830251841157607, 1e-5);
  EXPECT_NEAR(1.0 / drag_at("stresslet yes"), 0.2830251841157607, 1e-5);
}

// The check of the tolerance takes torques of 0 where atoms have none, and passes.
TEST(LammpsStresslets, KeywordCheck)
{
  LammpsSession lmp;
  lattice(lmp, "lj", 1.0,
          "fix move all bd/pse 1.0 0.7 12345 radius 1.0 stresslet yes check yes fft estimate", "");
  lmp.command("run 0");
  const std::string log = lmp.log();
  EXPECT_NE(log.find("check of the tolerance"), std::string::npos);
  EXPECT_EQ(log.find("above the tolerance"), std::string::npos);
}

namespace {

/// Where Brownian particles are after some steps, and what the constraint did in the last one.
struct Steps {
  Vector x, figures;    // hydrodynamic stress, force on what is held
  /// lines: before the fix.  fix: without its ID and group.
  Steps(const std::string &lines, const std::string &fix, int steps)
  {
    LammpsSession lmp;
    lmp.script(lattice_suspension + std::string("group posts id 3 17 40\n") + lines +
               "\nfix move all " + fix + "\ntimestep 1e-7\nrun " + std::to_string(steps));
    x = lmp.unwrapped_positions();
    const int first = fix.find("bd/pse") == 0 ? 9 : 28;
    for (int n : {1, 2, 3, 4, 5, 6, 15, 16, 17}) figures.push_back(figure(lmp, first + n));
  }
};

Vector minus(const Vector &a, const Vector &b)
{
  Vector d;
  for (std::size_t k = 0; k < a.size(); ++k) d.push_back(a[k] - b[k]);
  return d;
}

const std::string variate = " control_variate yes",
                  on_pse = "bd/pse 1.0 1.0 4711 radius 0.5 fft estimate tolerance 1e-4",
                  on_fib = "bd/fib 1.0 1.0 4711 radius 0.8 fft estimate constraint 1e-5";

}    // namespace

// The control variate changes no trajectory.  It takes at least nine tenths of the noise out of
// stress and force, which at this time step are nothing but noise.
TEST(LammpsStresslets, ControlVariate)
{
  for (const std::string &fix : {on_pse, on_fib})
    for (const char *what :
         {" stresslet yes", " hold posts 0 0 0.3", " stresslet yes hold posts 0 0 0.3"}) {
      SCOPED_TRACE(fix + what);
      const Steps noisy("", fix + what, 5), quiet("", fix + what + variate, 5);
      EXPECT_EQ(quiet.x, noisy.x);
      EXPECT_LT(norm(quiet.figures), 0.1 * norm(noisy.figures));
    }
}

// What it takes out belongs to the noise alone, and so has the mean 0: it is the same with and
// without flows, forces, and motions of what is held and of walls.
TEST(LammpsStresslets, ControlVariateIsThatOfTheNoise)
{
  const auto shear = [](const std::string &rate) {
    return "change_box all triclinic\nfix flow all deform 1 xy erate " + rate + " remap x";
  };
  const std::string slit = "change_box all boundary p p f z delta -0.9 0.9",
                    rest = " stresslet yes hold posts 0 0 0",
                    moves = " stresslet yes hold posts 1e3 0 3e3",
                    push = "fix push all addforce 1e3 0 -1e3",
                    walls = " wall zlo noslip wall zhi noslip";
  struct Case {
    std::string quiet_lines, quiet_fix, lines, fix;
  };
  for (const Case &c :
       {Case{shear("1e-4"), on_pse + " stresslet yes", shear("1e4"), on_pse + " stresslet yes"},
        Case{"", on_pse + rest, push, on_pse + moves},
        Case{"", on_fib + rest, push, on_fib + moves + " shear 1e4"},
        Case{slit, on_fib + rest + walls, slit + "\n" + push,
             on_fib + moves + walls + " 1e4 0 0 force 1e3 0 0"}}) {
    SCOPED_TRACE(c.lines + c.fix);
    const auto taken_out = [](const std::string &lines, const std::string &fix) {
      return minus(Steps(lines, fix, 1).figures, Steps(lines, fix + variate, 1).figures);
    };
    const Vector alone = taken_out(c.quiet_lines, c.quiet_fix);
    EXPECT_LT(relative_error(taken_out(c.lines, c.fix), alone), 1e-5);
    EXPECT_GT(relative_error(Steps(c.lines, c.fix, 1).figures,
                             Steps(c.quiet_lines, c.quiet_fix, 1).figures),
              1e-2);
  }
}

TEST(LammpsStresslets, WrongInput)
{
  const char *const begin = "fix move all bd/pse 1.0 1.0 12345 radius 1.0 ";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"stresslet maybe", "stresslet = maybe, but must be yes or no"},
      {"stresslet yes scheme split substeps 4", "stresslet = yes, but needs scheme euler"},
      {"stresslet yes parts yes", "stresslet = yes, but needs parts no"},
      {"stresslet yes hydrodynamics no", "stresslet = yes, but needs hydrodynamics yes"},
      {"hold all 0 0 0 hydrodynamics no", "hold = all, but needs hydrodynamics yes"},
      {"stresslet yes control_variate maybe", "control_variate = maybe, but must be yes or no"},
      {"control_variate yes", "control_variate = yes, but needs stresslet yes or hold"},
      {"hold all 0 0", "hold velocity"},
      {"hold all 0 0 zero", "hold velocity"},
      {"hold nobody 0 0 0\nrun 0", "hold nobody: there is no group of that name"},
      {"hold all 0 0 v_none\nrun 1", "hold all = v_none, but there is no variable of that name"},
      {"hold all 0 0 0\nfix flow all deform 1 x erate 0.1 remap x\nrun 0",
       "hold all: the box changes during the run"}};
  for (const auto &c : cases) expect_message({(begin + c.first).c_str(), c.second.c_str()});
}

// The stresslets of two spheres that overlap, drawn 10000 times at one place: with the control
// variate their mean, the Brownian part, is known to a tenth.  The bound of 5 standard errors is
// passed by chance once in 70000 seeds.
TEST(StatisticsLammpsStresslets, BrownianPartWithControlVariate)
{
  const auto cases = json_reference("fts_pairs.json")["cases"];
  for (const auto &c : cases) {
    if (c["id"] != "triclinic-overlapping" && c["id"] != "shear-poly-overlapping") continue;
    LammpsSession lmp;
    create_spheres(lmp, c);
    const double eta = c["eta"], a = c["radius"][0];
    lmp.script("fix move all bd/pse 1.0 " + text(eta) +
               " 4711 radius atom stresslet yes control_variate yes tolerance 1e-3 fft estimate\n"
               "timestep " +
               text(1e-3 * 6.0 * M_PI * eta * a * a * a) + "\nrun 0 post no");
    const Vector x = flatten(c["x"]);
    std::vector<Mean> S(12);
    for (int draw = 0; draw < 10000; ++draw) {
      lmp.command("run 1 pre no post no");
      const Vector columns = lmp.per_atom("move", 9);
      LAMMPS_NS::Atom &atom = lmp.host_atoms();
      for (int i = 0; i < 2; ++i) {
        for (int k = 0; k < 6; ++k) S[6 * i + k].add(columns[9 * i + k]);
        std::copy_n(&x[3 * (atom.tag[i] - 1)], 3, atom.x[i]);
      }
      lmp.have_moved_atoms();
    }
    double largest = 0.0;
    for (int i = 0; i < 2; ++i) {
      const Vector expected = six_of(c["brownian_stresslet_per_kT"][i]);
      for (int k = 0; k < 6; ++k) {
        EXPECT_LT(std::fabs(S[6 * i + k].z(expected[k])), 5.0) << c["id"] << " " << i << " " << k;
        largest = std::max(largest, std::fabs(expected[k]) / S[6 * i + k].error());
      }
    }
    EXPECT_GT(largest, 10.0) << c["id"];
  }
}

// 64 bonds of 1.5 radii: the mean distance is that of Boltzmann, 1.6277 radii, and 1.6887 without
// the thermal drift.  The bound is 4.5 standard errors.
TEST(StatisticsLammpsStresslets, BondsHaveTheirThermalDrift)
{
  LammpsSession lmp;
  lmp.script(R"(
units lj
atom_style bond
atom_modify map array
region box block 0 32 0 32 0 32
create_box 1 box bond/types 1 extra/bond/per/atom 1
lattice sc $(1.0/8.0^3)
create_atoms 1 box
displace_atoms all move 1.6 0 0 units box
create_atoms 1 box
mass 1 1.0
bond_style harmonic
bond_coeff 1 5.0 1.5
special_bonds lj/coul 0 1 1
pair_style soft 2.0
pair_coeff * * 10.0
neigh_modify every 1 delay 0 check yes
comm_modify cutoff 5.0
variable i loop 64
)");
  for (int i = 1; i <= 64; ++i)
    lmp.command("create_bonds single/bond 1 " + std::to_string(i) + " " + std::to_string(i + 64));
  lmp.script(
      "fix move all bd/pse 1.0 $(1.0/(6.0*PI)) 12345 radius 1.0 tolerance 1e-2 stresslet yes "
      "fft estimate\ncompute b all bond/local dist\n"
      // newer releases are told that the numbers are not by atom
      "if '$(version) > 20231120' then 'compute r all reduce ave c_b inputs local' "
      "else 'compute r all reduce ave c_b'\n"
      "timestep 0.004\nfix mean all ave/time 5 1 5 c_r ave running start 500\nrun 4500");
  EXPECT_NEAR(lmp.fix("mean")->compute_scalar(), 1.6277, 0.03);
}
