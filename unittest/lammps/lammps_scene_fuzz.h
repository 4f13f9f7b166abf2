// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Random decks for tests that run under mpirun -np 4, and the harness that runs them in legs. Each
/// leg continues from a restart file of the previous one, on other ranks or with another suffix.
#ifndef BDH_TEST_LAMMPS_SCENE_FUZZ_H
#define BDH_TEST_LAMMPS_SCENE_FUZZ_H

#include "lammps/lammps_mobility_watch.h"
#include "lammps/lammps_ranks.h"

#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <random>

namespace bdh_test {

/// Part of a deck.  The first leg makes the scene, the others read it from a restart file.
struct Leg {
  int ranks = 1;
  std::string options;    // of the command line
  bool clears = false;    // goes on in the session of the leg before, after the command clear
  std::string script;
};

/// The same on all ranks of the world.  The fix that watches has the id watch.
struct Deck {
  double tolerance = 1e-3;
  std::vector<Leg> legs;
};

/// Draws what decks are made of.
class DeckGenerator {
 public:
  explicit DeckGenerator(unsigned seed) : engine_(seed) {}

 protected:
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

  /// LAMMPS cannot go back from a restart file that the KOKKOS package has written.
  void choose_place(Leg &leg, bool may_use_kokkos)
  {
    leg.ranks = whole(1, 4);
#if defined(LMP_KOKKOS)
    kokkos_ = kokkos_ || (may_use_kokkos && chance(0.5));
    if (kokkos_) leg.options = "-k on t 1 -sf " + pick({"kk", "kk/host", "kk/device"});
#else
    (void) may_use_kokkos;
#endif
  }
  bool uses_kokkos() const { return kokkos_; }

  /// A leg after `last`, in its session or not.
  Leg next_leg(const Leg &last, bool may_use_kokkos)
  {
    Leg leg;
    leg.ranks = last.ranks;
    leg.options = last.options;
    leg.clears = chance(0.4);
    if (!leg.clears) choose_place(leg, may_use_kokkos);
    return leg;
  }

 private:
  std::mt19937_64 engine_;
  bool kokkos_ = false;
};

/// Runs decks and keeps their results.
class DeckRunner {
 public:
  /// add_watch lets a session know the style of the watch.  allowed: words of an error with which a
  /// deck may end.
  DeckRunner(void (*add_watch)(LammpsSession &), std::string allowed) :
      add_watch_(add_watch), allowed_(std::move(allowed)), file_(restart_file("fuzz"))
  {}

  /// Collective over the world.
  void run(const Deck &deck, long number)
  {
    double error = 0.0;
    for (const Leg &leg : deck.legs) {
      if (!leg.clears) begin_session(leg);
      const bool is_first = &leg == deck.legs.data(), is_last = &leg == &deck.legs.back();
      const std::string message = lmp_ ? run_leg(leg, is_first, is_last, error) : "";
      if (my_rank() == 0) judge(deck, leg, number, message, error);
      int ends = !message.empty();
      MPI_Allreduce(MPI_IN_PLACE, &ends, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
      if (ends) break;
    }
    end_session();
    if (my_rank() == 0) std::remove(file_.c_str());
    worst = std::max(worst, error / deck.tolerance);
    sum += error / deck.tolerance;
  }

  int steps = 0, legs = 0;
  double worst = 0.0, sum = 0.0;    // of error/tolerance

 private:
  void begin_session(const Leg &leg)
  {
    end_session();
    const int me = my_rank();
    MPI_Comm_split(MPI_COMM_WORLD, me < leg.ranks ? 0 : MPI_UNDEFINED, me, &comm_);
    if (comm_ != MPI_COMM_NULL) lmp_ = std::make_unique<LammpsSession>(comm_, leg.options);
  }
  void end_session()
  {
    lmp_.reset();
    if (comm_ != MPI_COMM_NULL) MPI_Comm_free(&comm_);
    MPI_Barrier(MPI_COMM_WORLD);    // the file is written
  }

  /// Returns LAMMPS' error; error: the greatest so far.
  std::string run_leg(const Leg &leg, bool is_first, bool is_last, double &error)
  {
    LammpsSession &lmp = *lmp_;
    if (leg.clears) lmp.command("clear");
    add_watch_(lmp);
    std::string message;
    // Shear may leave a box that leans a little more than LAMMPS likes to begin with.
    if (!is_first) message = lmp.error_of("box tilt large\nread_restart " + file_);
    if (message.empty()) message = lmp.error_of(leg.script);
    if (lmp->modify->find_fix("watch") >= 0) {
      const FixStepWatch &watch = mobility_watch(lmp, "watch");
      steps += watch.steps;
      error = std::max(error, watch.worst);
      ++legs;
    }
    if (message.empty() && !is_last) message = lmp.error_of("write_restart " + file_);
    return message;
  }

  void judge(const Deck &deck, const Leg &leg, long number, const std::string &message,
             double error) const
  {
    const bool fails = !message.empty() && message.find(allowed_) == std::string::npos;
    if (!fails && error <= deck.tolerance) return;
    std::string all;
    for (const Leg &l : deck.legs)
      all += "# " + std::to_string(l.ranks) + " ranks, " + l.options +
             (l.clears ? ", after clear\n" : "\n") + l.script;
    ADD_FAILURE() << "deck " << number << ", leg " << &leg - deck.legs.data() << ", error " << error
                  << ", tolerance " << deck.tolerance << "\n"
                  << all << message;
  }

  void (*add_watch_)(LammpsSession &);
  std::string allowed_, file_;
  MPI_Comm comm_ = MPI_COMM_NULL;
  std::unique_ptr<LammpsSession> lmp_;
};

inline long from_environment(const char *name, long otherwise)
{
  const char *value = std::getenv(name);
  return value ? std::atol(value) : otherwise;
}

/// Runs the decks of a generator: so many, or as the environment says (BDH_FUZZ_FIRST,
/// BDH_FUZZ_DECKS).
template <class Generator> void run_decks(DeckRunner &runner, long usual)
{
  const long first = from_environment("BDH_FUZZ_FIRST", 0),
             decks = from_environment("BDH_FUZZ_DECKS", usual);
  for (long number = first; number < first + decks; ++number)
    runner.run(Generator(1000 + number).deck(), number);
  if (my_rank()) return;
  EXPECT_GT(runner.steps, 4 * decks);
  printf("%ld decks in %d legs, %d steps: error/tolerance %.2g at most, %.2g in the mean\n", decks,
         runner.legs, runner.steps, runner.worst, runner.sum / decks);
}

}    // namespace bdh_test
#endif
