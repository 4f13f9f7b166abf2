// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Where the time of a step goes: wall-clock seconds by phase, each second in one phase only.
#ifndef BDH_BASE_PHASES_H
#define BDH_BASE_PHASES_H

#include <array>
#include <chrono>

namespace bdh {

/// The phases are in the order of the table at the end of a run.
enum class Phase {
  spread,
  transform,
  modes,
  interpolate,
  pairs,
  lanczos,
  forces,
  communicate,
  other
};
constexpr int phase_count = 9;

/// The name in the table.  It has at most 8 characters, as LAMMPS' own table requires.
inline const char *phase_name(int phase)
{
  constexpr const char *names[phase_count] = {"Spread",  "FFT",    "Noise", "Interp", "Near",
                                              "Lanczos", "Forces", "Comm",  "Other"};
  return names[phase];
}

using PhaseTimes = std::array<double, phase_count>;

/// The clock of a thread.  A phase that begins within another one takes over from it until it ends.
class PhaseClock {
 public:
  static PhaseClock &mine()
  {
    thread_local PhaseClock clock;
    return clock;
  }

  /// Seconds in all phases that have ended, or been interrupted, since the thread began.
  const PhaseTimes &times() const { return times_; }

 private:
  friend class PhaseScope;
  using Clock = std::chrono::steady_clock;

  /// Starts a phase and returns the one before.  A negative phase means that none runs.
  int change(int phase)
  {
    const Clock::time_point now = Clock::now();
    const int before = phase_;
    if (before >= 0) times_[before] += std::chrono::duration<double>(now - since_).count();
    since_ = now;
    phase_ = phase;
    return before;
  }

  PhaseTimes times_{};
  int phase_ = -1;
  Clock::time_point since_;
};

/// The time of its life counts for the phase, except for that of phases within.
class PhaseScope {
 public:
  explicit PhaseScope(Phase phase) : before_(PhaseClock::mine().change(static_cast<int>(phase))) {}
  ~PhaseScope() { PhaseClock::mine().change(before_); }
  PhaseScope(const PhaseScope &) = delete;
  PhaseScope &operator=(const PhaseScope &) = delete;

 private:
  int before_;
};

}    // namespace bdh
#endif
