// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Every second belongs to exactly one phase.  These laws hold on any machine, however fast or busy.

#include "base/phases.h"

#include <gtest/gtest.h>

#include <chrono>
#include <numeric>
#include <stdexcept>
#include <thread>

using namespace bdh;

namespace {

/// Waits at least this long.
void wait(double seconds)
{
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (std::chrono::steady_clock::now() < end) {
  }
}

double of(const PhaseTimes &t, Phase p) { return t[static_cast<int>(p)]; }

PhaseTimes difference(const PhaseTimes &a, const PhaseTimes &b)
{
  PhaseTimes d;
  for (std::size_t p = 0; p < d.size(); ++p) d[p] = a[p] - b[p];
  return d;
}

}    // namespace

TEST(Phases, OneWithinAnotherTakesOver)
{
  const PhaseTimes before = PhaseClock::mine().times();
  const auto start = std::chrono::steady_clock::now();
  {
    const PhaseScope outer(Phase::transform);
    wait(0.002);
    {
      const PhaseScope inner(Phase::modes);
      wait(0.004);
    }
    wait(0.002);
  }
  const double all =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const PhaseTimes t = difference(PhaseClock::mine().times(), before);
  EXPECT_GE(of(t, Phase::transform), 0.004);
  EXPECT_GE(of(t, Phase::modes), 0.004);
  EXPECT_LE(of(t, Phase::transform) + of(t, Phase::modes), all);
  EXPECT_LE(of(t, Phase::transform), all - 0.004);    // without the time of the inner phase
  EXPECT_EQ(std::accumulate(t.begin(), t.end(), 0.0),
            of(t, Phase::transform) + of(t, Phase::modes));
}

TEST(Phases, EndWithTheirScopeWhateverEndsIt)
{
  const PhaseTimes before = PhaseClock::mine().times();
  try {
    const PhaseScope outer(Phase::lanczos);
    const PhaseScope inner(Phase::communicate);
    throw std::runtime_error("");
  } catch (const std::runtime_error &) {
  }
  const PhaseTimes ended = PhaseClock::mine().times();
  EXPECT_GT(of(ended, Phase::lanczos), of(before, Phase::lanczos));
  wait(0.001);
  {
    const PhaseScope spreading(Phase::spread);
  }
  EXPECT_EQ(of(PhaseClock::mine().times(), Phase::lanczos),
            of(ended, Phase::lanczos));    // no phase runs in between
}

TEST(Phases, EachThreadHasItsOwn)
{
  const PhaseTimes before = PhaseClock::mine().times();
  std::thread([] {
    const PhaseScope spreading(Phase::spread);
    wait(0.001);
  }).join();
  EXPECT_EQ(PhaseClock::mine().times(), before);
}
