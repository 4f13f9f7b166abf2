// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Random scenes of fix bd/pse: box, tilt, units, processors, group, radii, suffix, and commands
// that change them during runs, which are interrupted at random steps, some of them by restart
// files.  The velocities of every step are compared with direct Ewald sums and must meet the
// tolerance that the deck requests.
//
//   BDH_FUZZ_DECKS=200 mpirun -np 4 test_lammps_scene_fuzz_ranks       more decks
//   BDH_FUZZ_FIRST=17 BDH_FUZZ_DECKS=1 ...                             one of them

#include "lammps/lammps_scene_fuzz.h"

namespace {

class Generator : public bdh_test::DeckGenerator {
 public:
  using DeckGenerator::DeckGenerator;

  bdh_test::Deck deck()
  {
    bdh_test::Deck d;
    d.legs.emplace_back();
    choose_place(d.legs[0], true);
    // As in LAMMPS' units: factor from viscosity to force, and the timestep.
    struct Units {
      const char *name;
      double vxmu2f, dt;
    };
    const Units units[] = {{"lj", 1.0, 0.01}, {"real", 1.4393264316e4, 10.0}, {"nano", 1.0, 0.01}};
    const Units u = units[whole(0, 2)];
    d.tolerance = std::pow(10.0, -real(2.0, 6.0));
    radii_of_atoms_ = chance(0.5);
    deposits_ = chance(0.3);
    a_ = radii_of_atoms_ && deposits_ ? 0.5 : std::pow(10.0, real(-0.4, 0.6));
    dt_ = u.dt;
    viscosity_ = real(0.3, 3.0);
    // One call per line, since each draws numbers and the operands of + have no fixed order.
    std::string scene = std::string("units ") + u.name + "\natom_style " +
                        (radii_of_atoms_ ? uses_kokkos() ? "sphere" : "sphere 1" : "atomic") +
                        "\natom_modify map array\n";
    scene += box();
    scene += atoms();
    std::string fixes = settings();
    fixes += group();
    // Moves of about 0.02 radii in a step.
    const double f = 0.02 * a_ * a_ / dt_ * 6.0 * M_PI * viscosity_ * u.vxmu2f;
    fixes += "variable fx atom " + text(f) + "*sin(7*id)\nvariable fy atom " + text(f) +
             "*cos(5*id)\nvariable fz atom " + text(f) +
             "*sin(3*id+1)\nfix push all addforce v_fx v_fy v_fz\n";
    fixes += "fix watch " + group_ + " bdh/watch " + (radii_of_atoms_ ? "0" : text(a_)) + " " +
             text(viscosity_) + "\nfix move " + group_ + " bd/pse 0 " + text(viscosity_) +
             " 1234 tolerance " + text(d.tolerance) + " fft estimate" +
             (radii_of_atoms_ ? "" : " radius " + text(a_));
    if (chance(0.3) && !tiled_) fixes += " xi " + text(real(0.4, 1.2) / a_);
    if (chance(0.3)) fixes += " precision double";
    fixes += "\n";
    fixes += changes();
    d.legs[0].script = scene + fixes;
    runs(fixes, d.legs);
    return d;
  }

 private:
  /// A position around the center of the box.
  std::string middle() const
  {
    std::string words;
    for (int d = 0; d < 3; ++d)
      words += text(center_[d] - 0.9 * a_) + " " + text(center_[d] + 0.9 * a_) + " ";
    return words;
  }

  std::string box()
  {
    tilted_ = chance(0.5);
    std::string words = tilted_ ? "region box prism" : "region box block";
    for (int d = 0; d < 3; ++d) {
      const double lo = real(-3.0, 3.0) * a_;
      edge_[d] = real(5.0, 25.0) * a_;
      words += " " + text(lo) + " " + text(lo + edge_[d]);
      center_[d] = lo + 0.5 * edge_[d];
    }
    if (tilted_) {
      const double xy = real(-0.5, 0.5) * edge_[0], xz = real(-0.5, 0.5) * edge_[0],
                   yz = real(-0.5, 0.5) * edge_[1];
      words += " " + text(xy) + " " + text(xz) + " " + text(yz);
      center_[0] += 0.5 * (xy + xz);
      center_[1] += 0.5 * yz;
    }
    return words + " units box\ncreate_box 1 box\n";
  }

  std::string atoms()
  {
    const double room = 0.3 * edge_[0] * edge_[1] * edge_[2] / (4.2 * a_ * a_ * a_);
    count_ = static_cast<int>(std::min(room, real(1.0, 40.0)));
    const bool empty = deposits_ && chance(0.4);
    std::string s;
    if (!empty) s = "create_atoms 1 random " + std::to_string(std::max(1, count_)) + " 9871 NULL\n";
    if (radii_of_atoms_ && !empty) s += "set group all diameter " + text(2.0 * a_) + "\n";
    if (!radii_of_atoms_) s += "mass 1 1.0\n";
    return s;
  }

  /// What restart files do not contain.
  std::string settings()
  {
    std::string s = "pair_style none\nneighbor " + text(real(0.2, 1.0) * a_) +
                    " bin\nneigh_modify every 1 delay 0 check yes\ntimestep " + text(dt_) +
                    "\ncomm_modify cutoff " + text(3.0 * a_) + "\n";
    tiled_ = chance(0.2);
    if (tiled_) s += "comm_style tiled\n";
    return s;
  }

  std::string group()
  {
    group_ = "some";
    switch (whole(0, 3)) {
    case 0: return "group some id 1:" + std::to_string(1 + count_ / 2) + "\n";
    case 1:
      return "variable some atom (sin(id)+0.1*step)>" + text(real(-0.5, 0.8)) +
             "\ngroup some dynamic all var some every " + std::to_string(whole(1, 3)) + "\n";
    default: group_ = "all"; return "";
    }
  }

  /// Fixes that change the scene.
  std::string changes()
  {
    std::string s;
    if (deposits_)
      s += "region middle block " + middle() + " units box\nfix dep all deposit " +
           std::to_string(whole(1, 8)) + " 1 1 4567 region middle near " + text(1e-3 * a_) + "\n";
    if (chance(0.2))
      s += "region everywhere block INF INF INF INF INF INF\nfix gone all evaporate 2 2 everywhere "
           "4949\n";
    if (radii_of_atoms_ && !uses_kokkos() && !deposits_ && chance(0.4))
      s += "variable D equal " + text(2.0 * a_) + "*ramp(1.0," + text(real(0.6, 1.8)) +
           ")\nfix swell all adapt 1 atom diameter v_D\n";
    switch (whole(0, 3)) {
    case 0:
      s += "fix def all deform 1 x erate " + text(real(-0.2, 0.3) / (12.0 * dt_));
      s += " z erate " + text(real(-0.2, 0.3) / (12.0 * dt_)) + " remap x\n";
      break;
    case 1:
      if (tilted_)
        s += "fix def all deform 1 xy erate " + text(real(0.2, 1.2) / (10.0 * dt_)) + " remap x\n";
      break;
    default: break;
    }
    return s;
  }

  /// The KOKKOS package cannot read restart files with spheres.
  bool may_use_kokkos() const { return !radii_of_atoms_; }
  bool may_restart() const { return !uses_kokkos() || may_use_kokkos(); }

  /// About ten steps, from fixes on.
  void runs(const std::string &fixes, std::vector<bdh_test::Leg> &legs)
  {
    for (int left = whole(8, 14); left > 0;) {
      const int n = std::min(left, whole(1, 8));
      left -= n;
      legs.back().script += run(n);
      if (left == 0 || !may_restart() || !chance(0.4)) continue;
      legs.push_back(next_leg(legs.back(), may_use_kokkos()));
      legs.back().script = fixes;
    }
  }

  std::string run(int steps)
  {
    const std::string run = "run " + std::to_string(steps);
    switch (whole(0, 3)) {
    case 0: return run + " every 2 \"variable idle equal 1\"\n";
    case 1: return run + " post no\n";
    case 2:
      if (!tilted_ && chance(0.5))
        return run + "\nchange_box all y scale " + text(real(0.9, 1.2)) + " remap\n";
      return run + "\n";
    default: return run + "\n";
    }
  }

  bool tilted_ = false, tiled_ = false, radii_of_atoms_ = false, deposits_ = false;
  double a_ = 1.0, dt_ = 1.0, viscosity_ = 1.0, edge_[3], center_[3];
  int count_ = 0;
  std::string group_;
};

}    // namespace

// A radius may grow until the list of the run is too short: then the fix says so.
TEST(SceneFuzzRanks, EveryStepKeepsTheTolerance)
{
  bdh_test::DeckRunner runner(bdh_test::add_mobility_watch, "begin another run here");
  bdh_test::run_decks<Generator>(runner, 20);
}
