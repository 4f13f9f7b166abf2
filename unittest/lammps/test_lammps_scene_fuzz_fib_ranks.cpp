// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Random scenes of fix bd/fib: walls, grid, kernel, scheme, flow, units, processors, group, suffix,
// atoms that come and go, and runs that are interrupted at random steps, some of them by restart
// files.  The velocities of every step must equal those of the first step of a new LAMMPS on one
// rank, with the same fix and the current particles.
//
//   BDH_FUZZ_DECKS=200 mpirun -np 4 test_lammps_scene_fuzz_fib_ranks       more decks
//   BDH_FUZZ_FIRST=17 BDH_FUZZ_DECKS=1 ...                                 one of them

#include "lammps/lammps_scene_fuzz.h"

#include "comm.h"
#include "update.h"

#include <array>

using bdh_test::LammpsSession;

namespace {

/// The reference is a separate LAMMPS:
///
///     fix ID group bdh/watch/fib (what follows bd/fib)
class FixFibWatch : public bdh_test::FixStepWatch {
 public:
  FixFibWatch(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg) : FixStepWatch(lmp, narg, arg)
  {
    for (int i = 3; i < narg; ++i) words_ += std::string(" ") + arg[i];
  }

 protected:
  std::vector<double> reference(const bdh::Cell &cell, const std::vector<double> &x,
                                const std::vector<double> &f, double) override
  {
    std::vector<double> u(x.size());
    if (comm->me == 0) u = first_step(cell, x, f);
    MPI_Bcast(u.data(), u.size(), MPI_DOUBLE, 0, world);
    return u;
  }

 private:
  std::vector<double> first_step(const bdh::Cell &cell, const std::vector<double> &x,
                                 std::vector<double> f) const
  {
    for (double &a : f) a /= force->ftm2v;
    LammpsSession fresh(MPI_COMM_SELF, "");
    std::string boundary = "boundary";
    for (int d = 0; d < 3; ++d) boundary += domain->periodicity[d] ? " p" : " f";
    fresh.script("units " + std::string(update->unit_style) +
                 "\natom_style atomic\natom_modify map array\n" + boundary + "\n" +
                 bdh_test::box_commands(cell) + "mass 1 1.0\n");
    bdh_test::create_atoms(fresh, x);
    const bdh_test::GivenForces forces(fresh, f);
    fresh.script("comm_modify cutoff " + bdh_test::text(0.1 * cell.lx) +
                 "\nneigh_modify every 1 delay 0 check yes\nthermo_style custom step\ntimestep " +
                 bdh_test::text(update->dt) + "\nfix move all bd/fib" + words_ + "\nrun 1\n");
    return fresh.velocities();
  }

  std::string words_;
};

void add_fib_watch(LammpsSession &lmp)
{
  (*lmp->modify->fix_map)["bdh/watch/fib"] = [](LAMMPS_NS::LAMMPS *l, int narg,
                                                char **arg) -> LAMMPS_NS::Fix * {
    return new FixFibWatch(l, narg, arg);
  };
}

class Generator : public bdh_test::DeckGenerator {
 public:
  using DeckGenerator::DeckGenerator;

  bdh_test::Deck deck()
  {
    bdh_test::Deck d;
    // Above the round-off of the solver that iterates, and of the order of sums.
    d.tolerance = 1e-12;
    d.legs.emplace_back();
    choose_place(d.legs[0], true);
    // As in LAMMPS' units: factor from viscosity to force, and the timestep.
    struct Units {
      const char *name;
      double vxmu2f, dt;
    };
    const Units units[] = {{"lj", 1.0, 0.01}, {"real", 1.4393264316e4, 10.0}, {"nano", 1.0, 0.01}};
    const Units u = units[whole(0, 2)];
    dt_ = u.dt;
    viscosity_ = real(0.3, 3.0);
    // One call per line, since each draws numbers and the operands of + have no fixed order.
    std::string scene =
        std::string("units ") + u.name + "\natom_style atomic\natom_modify map array\n";
    scene += box();
    scene += atoms();
    std::string fixes = settings();
    fixes += group();
    // Moves of about 0.02 cells in a step.
    const double f = 0.02 * h_ * h_ / dt_ * 6.0 * M_PI * viscosity_ * u.vxmu2f;
    fixes += "variable fx atom " + text(f) + "*sin(7*id)\nvariable fy atom " + text(f) +
             "*cos(5*id)\nvariable fz atom " + text(f) +
             "*sin(3*id+1)\nfix push all addforce v_fx v_fy v_fz\n";
    const std::string words = options() + "\n";
    fixes += "fix watch " + group_ + " bdh/watch/fib " + words;
    fixes += "fix move " + group_ + " bd/fib " + words;
    fixes += changes();
    d.legs[0].script = scene + fixes;
    runs(fixes, d.legs);
    return d;
  }

 private:
  std::string box()
  {
    h_ = std::pow(10.0, real(-0.4, 0.6));
    std::string boundary = "boundary", region = "region box block";
    for (int d = 0; d < 3; ++d) {
      walled_[d] = chance(0.4);
      const int sizes[] = {6, 7, 8, 9, 10, 12, 15, 16};
      n_[d] = sizes[whole(0, 7)];
      const double lo = real(-3.0, 3.0) * h_;
      hi_[d] = lo + n_[d] * h_ * real(0.95, 1.05);
      lo_[d] = lo;
      boundary += walled_[d] ? " f" : " p";
      region += " " + text(lo_[d]) + " " + text(hi_[d]);
    }
    return boundary + "\n" + region + " units box\ncreate_box 1 box\n";
  }

  /// Where atoms come into being: not near walls, and in `share` of each edge.
  std::string region(const std::string &name, double share) const
  {
    std::string words = "region " + name + " block";
    for (int d = 0; d < 3; ++d) {
      const double margin = 0.5 * (1.0 - share) * (hi_[d] - lo_[d]);
      words += " " + text(lo_[d] + margin) + " " + text(hi_[d] - margin);
    }
    return words + " units box\n";
  }

  std::string atoms()
  {
    count_ = whole(1, 40);
    return region("inner", 0.6) + "create_atoms 1 random " + std::to_string(count_) +
           " 9871 inner\nmass 1 1.0\n";
  }

  /// What restart files do not contain.
  std::string settings()
  {
    std::string s = "pair_style none\nneighbor " + text(real(0.2, 1.0) * h_) +
                    " bin\nneigh_modify every 1 delay 0 check yes\nthermo_style custom step\n"
                    "timestep " +
                    text(dt_) + "\ncomm_modify cutoff " + text(2.0 * h_) + "\n";
    if (chance(0.2)) s += "comm_style tiled\n";
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

  std::string options()
  {
    std::string s = "0 " + text(viscosity_) + " 1234 grid";
    for (int n : n_) s += " " + std::to_string(n);
    s += " kernel " + pick({"roma3", "peskin4", "bkp6"}) + " fft estimate tolerance 1e-12";
    if (chance(0.5)) s += " scheme " + pick({"midpoint", "improved", "euler", "trapezoidal"});
    const bool any = walled_[0] || walled_[1] || walled_[2];
    if (any)
      s += walls();
    else if (chance(0.2))
      s += " shear " + text(real(-0.1, 0.1) / (n_[1] * dt_));
    return s;
  }

  std::string walls()
  {
    std::string s;
    std::vector<std::string> kinds = {"noslip", "noslip", "slip"};
    if (walled_[0] + walled_[1] + walled_[2] == 1) kinds.insert(kinds.end(), 2, "open");
    const std::string faces[3][2] = {{"xlo", "xhi"}, {"ylo", "yhi"}, {"zlo", "zhi"}};
    for (int d = 0; d < 3; ++d)
      for (int side = 0; side < 2 && walled_[d]; ++side) {
        s += " wall " + faces[d][side] + " " + pick(kinds);
        if (s.back() == 'p' && s.substr(s.size() - 6) == "noslip" && chance(0.2))
          for (int k = 0; k < 3; ++k)
            s += " " + (k == d ? "0" : text(real(-0.02, 0.02) * h_ / dt_));
      }
    return s;
  }

  /// Fixes that change the scene.
  std::string changes()
  {
    std::string s;
    if (chance(0.4))
      s += region("middle", 0.4) + "fix dep all deposit " + std::to_string(whole(1, 8)) +
           " 1 1 4567 region middle near " + text(1e-3 * h_) + " units box\n";
    if (chance(0.3))
      s += "region everywhere block INF INF INF INF INF INF\nfix gone all evaporate 2 2 everywhere "
           "4949\n";
    return s;
  }

  /// About ten steps, from fixes on.
  void runs(const std::string &fixes, std::vector<bdh_test::Leg> &legs)
  {
    for (int left = whole(8, 14); left > 0;) {
      const int n = std::min(left, whole(1, 8));
      left -= n;
      legs.back().script += run(n);
      if (left == 0) break;
      if (chance(0.3)) {
        legs.push_back(next_leg(legs.back(), true));
        legs.back().script = fixes;
      } else {
        legs.back().script += between_runs();
      }
    }
  }

  std::string run(int steps)
  {
    return "run " + std::to_string(steps) +
           pick({"\n", " post no\n", " every 2 \"variable idle equal 1\"\n"});
  }

  /// Atoms that are inserted and deleted, and another box.
  std::string between_runs()
  {
    const std::string name = std::to_string(++regions_);
    switch (whole(0, 4)) {
    case 0:
      return region("new" + name, 0.5) + "create_atoms 1 random " + std::to_string(whole(1, 5)) +
             " " + std::to_string(whole(1, 9999)) + " new" + name + "\n";
    case 1: return region("old" + name, 0.3) + "delete_atoms region old" + name + "\n";
    case 2:
      return "change_box all " + pick({"x", "y", "z"}) + " scale " + text(real(0.98, 1.02)) +
             " remap\n";
    default: return "";
    }
  }

  std::array<bool, 3> walled_{};
  std::array<int, 3> n_{};
  std::array<double, 3> lo_{}, hi_{};
  double h_ = 1.0, dt_ = 1.0, viscosity_ = 1.0;
  int count_ = 0, regions_ = 0;
  std::string group_;
};

}    // namespace

TEST(SceneFuzzFibRanks, EveryStepIsThatOfANewRun)
{
  bdh_test::DeckRunner runner(add_fib_watch, "no error is allowed");
  bdh_test::run_decks<Generator>(runner, 15);
}
