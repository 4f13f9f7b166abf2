// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Random scenes of fix bd/pse: box, tilt, units, processors, group, radii, suffix, and commands
// that change them during runs, which are interrupted at random steps.  The velocities of every
// step are compared with direct Ewald sums and must meet the tolerance that the deck requests.
//
//   BDH_FUZZ_DECKS=200 mpirun -np 4 test_lammps_scene_fuzz_ranks       more decks
//   BDH_FUZZ_FIRST=17 BDH_FUZZ_DECKS=1 ...                             one of them

#include "lammps/lammps_mobility_watch.h"
#include "lammps/lammps_ranks.h"

#include <cmath>
#include <gtest/gtest.h>

using bdh_test::LammpsSession;

namespace {

long from_environment(const char *name, long otherwise)
{
  const char *value = std::getenv(name);
  return value ? std::atol(value) : otherwise;
}

/// A deck, the same on all ranks of the world.
struct Deck {
  int ranks = 1;
  double tolerance = 1e-3;
  std::string options, script;
};

class Generator {
 public:
  explicit Generator(unsigned seed) : engine_(seed) {}

  Deck deck()
  {
    Deck d;
    d.ranks = whole(1, 4);
#if defined(LMP_KOKKOS)
    kokkos_ = chance(0.5);
    if (kokkos_) d.options = "-k on t 1 -sf " + pick({"kk", "kk/host", "kk/device"});
#endif
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
    d.script = std::string("units ") + u.name + "\natom_style " +
               (radii_of_atoms_ ? kokkos_ ? "sphere" : "sphere 1" : "atomic") +
               "\natom_modify map array\n";
    d.script += box();
    d.script += atoms();
    d.script += group();
    // Moves of about 0.02 radii in a step.
    const double f = 0.02 * a_ * a_ / dt_ * 6.0 * M_PI * viscosity_ * u.vxmu2f;
    d.script += "variable fx atom " + text(f) + "*sin(7*id)\nvariable fy atom " + text(f) +
                "*cos(5*id)\nvariable fz atom " + text(f) +
                "*sin(3*id+1)\nfix push all addforce v_fx v_fy v_fz\n";
    d.script += "fix watch " + group_ + " bdh/watch " + (radii_of_atoms_ ? "0" : text(a_)) + " " +
                text(viscosity_) + "\nfix move " + group_ + " bd/pse 0 " + text(viscosity_) +
                " 1234 tolerance " + text(d.tolerance) + " fft estimate" +
                (radii_of_atoms_ ? "" : " radius " + text(a_));
    if (chance(0.3) && !tiled_) d.script += " xi " + text(real(0.4, 1.2) / a_);
    if (chance(0.3)) d.script += " precision double";
    d.script += "\n";
    d.script += changes();
    d.script += runs();
    return d;
  }

 private:
  double real(double from, double to)
  {
    return std::uniform_real_distribution<double>(from, to)(engine_);
  }
  int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(engine_); }
  bool chance(double p) { return real(0.0, 1.0) < p; }
  std::string pick(const std::vector<std::string> &list)
  {
    return list[whole(0, static_cast<int>(list.size()) - 1)];
  }
  static std::string text(double x) { return bdh_test::text(x); }

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
    s += "pair_style none\nneighbor " + text(real(0.2, 1.0) * a_) +
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
    if (radii_of_atoms_ && !kokkos_ && !deposits_ && chance(0.4))
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

  /// About ten steps.
  std::string runs()
  {
    std::string s;
    for (int left = whole(8, 14); left > 0;) {
      const int n = std::min(left, whole(1, 8));
      left -= n;
      const std::string run = "run " + std::to_string(n);
      switch (whole(0, 3)) {
      case 0: s += run + " every 2 \"variable idle equal 1\"\n"; break;
      case 1: s += run + " post no\n"; break;
      case 2:
        s += run + "\n";
        if (!tilted_ && chance(0.5))
          s += "change_box all y scale " + text(real(0.9, 1.2)) + " remap\n";
        break;
      default: s += run + "\n"; break;
      }
    }
    return s;
  }

  std::mt19937_64 engine_;
  bool kokkos_ = false, tilted_ = false, tiled_ = false, radii_of_atoms_ = false, deposits_ = false;
  double a_ = 1.0, dt_ = 1.0, viscosity_ = 1.0, edge_[3], center_[3];
  int count_ = 0;
  std::string group_;
};

/// Worst ratio of error to tolerance; 0 if there was nothing to compare.
double run_deck(const Deck &deck, MPI_Comm comm, long number, int &steps)
{
  LammpsSession lmp(comm, deck.options);
  bdh_test::add_mobility_watch(lmp);
  const std::string message = lmp.error_of(deck.script);
  // A radius may grow until the list of the run is too short: then it says so.
  const bool stops = message.find("begin another run here") != std::string::npos;
  const bool failed = !message.empty() && !stops;
  if (failed && bdh_test::my_rank() == 0)
    ADD_FAILURE() << "deck " << number << ", " << deck.ranks << " ranks, " << deck.options << "\n"
                  << deck.script << message;
  if (failed) return 0.0;
  const bdh_test::FixMobilityWatch &watch = bdh_test::mobility_watch(lmp, "watch");
  steps += watch.steps;
  if (bdh_test::my_rank() == 0 && watch.worst > deck.tolerance)
    ADD_FAILURE() << "deck " << number << ", error " << watch.worst << ", " << deck.ranks
                  << " ranks, " << deck.options << "\n"
                  << deck.script;
  return watch.worst / deck.tolerance;
}

}    // namespace

TEST(SceneFuzzRanks, EveryStepKeepsTheTolerance)
{
  const long first = from_environment("BDH_FUZZ_FIRST", 0),
             decks = from_environment("BDH_FUZZ_DECKS", 30);
  double worst = 0.0, sum = 0.0;
  int steps = 0;
  for (long number = first; number < first + decks; ++number) {
    const Deck deck = Generator(1000 + number).deck();
    MPI_Comm comm;
    const int me = bdh_test::my_rank();
    MPI_Comm_split(MPI_COMM_WORLD, me < deck.ranks ? 0 : MPI_UNDEFINED, me, &comm);
    if (comm != MPI_COMM_NULL) {
      const double error = run_deck(deck, comm, number, steps);
      worst = std::max(worst, error);
      sum += error;
      MPI_Comm_free(&comm);
    }
    MPI_Barrier(MPI_COMM_WORLD);
  }
  if (bdh_test::my_rank() == 0) {
    EXPECT_GT(steps, 4 * decks);
    printf("%ld decks, %d steps: error/tolerance %.2f at most, %.2f in the mean\n", decks, steps,
           worst, sum / decks);
  }
}
