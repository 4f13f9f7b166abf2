// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Complex transforms of lines that lie side by side.
#ifndef BDH_GRID_LINE_TRANSFORMS_H
#define BDH_GRID_LINE_TRANSFORMS_H

#include "grid/fftw.h"

#include <array>
#include <cstdint>

namespace bdh {

/// Where the points of neighbouring lines are: `stride` complex numbers from one point of a line to
/// the next.  `array`, on a cache line, is where FFTW may try its plans.  Lines that are
/// transformed begin on a multiple of 16 bytes, as FFTW's vector code requires, or with any_start
/// at any complex number; the array must then have room for one more.
template <class Real> struct LinesAt {
  Real *array;
  long stride;
  bool any_start = false;
};

/// Transforms from lines at one place to lines at another, which may be the same, not normalised.
///
/// FFTW's vector code takes four complex floats at once, but only if their number is a multiple of
/// four: of 33 lines it transforms 32 and one in 0.65 of the time of all together
/// (bench/README.md).
template <class Real> class LineTransforms {
 public:
  LineTransforms() = default;
  LineTransforms(int length, long many, const LinesAt<Real> &outside, const LinesAt<Real> &inside,
                 unsigned flags) :
      most_(many / batch * batch)
  {
    const bool in_place = outside.array == inside.array;
    for (std::size_t odd = 0; odd < plans_.size(); ++odd) {
      if (odd && !may_be_odd(outside)) continue;
      const LinesAt<Real> out{outside.array + 2 * odd, outside.stride},
          in{inside.array + (in_place ? 2 * odd : 0), inside.stride};
      plans_[odd][0] = plan(length, most_, out, in, flags);
      plans_[odd][1] = plan(length, many - most_, out, in, few(flags));
    }
  }

  void forward(Real *outside, Real *inside) const
  {
    run(outside, [=](const FftwPlanPair<Real> &plans, long first) {
      execute(plans.forward, outside + first, inside + first);
    });
  }
  void backward(Real *inside, Real *outside) const
  {
    run(outside, [=](const FftwPlanPair<Real> &plans, long first) {
      execute(plans.backward, inside + first, outside + first);
    });
  }

 private:
  static constexpr long batch = 4;
  static constexpr std::uintptr_t alignment = 16;

  /// Few lines are not worth a long search for the fastest plan.
  static unsigned few(unsigned flags) { return flags == FFTW_PATIENT ? FFTW_MEASURE : flags; }
  static bool may_be_odd(const LinesAt<Real> &lines)
  {
    return lines.any_start && 2 * sizeof(Real) < alignment;
  }
  static FftwPlanPair<Real> plan(int length, long many, const LinesAt<Real> &outside,
                                 const LinesAt<Real> &inside, unsigned flags)
  {
    FftwPlanPair<Real> plans;
    if (many == 0) return plans;
    auto *const out = as_fftw_complex(outside.array), *const in = as_fftw_complex(inside.array);
    const int from = outside.stride, to = inside.stride;
    plans.forward.reset(Fftw<Real>::many_dft(1, &length, many, out, nullptr, from, 1, in, nullptr,
                                             to, 1, FFTW_FORWARD, flags));
    plans.backward.reset(Fftw<Real>::many_dft(1, &length, many, in, nullptr, to, 1, out, nullptr,
                                              from, 1, FFTW_BACKWARD, flags));
    return plans;
  }
  template <class Action> void run(const Real *outside, const Action &action) const
  {
    const auto &plans = plans_[reinterpret_cast<std::uintptr_t>(outside) % alignment != 0];
    action(plans[0], 0);
    action(plans[1], 2 * most_);
  }
  static void execute(const FftwPlan<Real> &plan, Real *from, Real *to)
  {
    if (plan) Fftw<Real>::execute(plan.get(), as_fftw_complex(from), as_fftw_complex(to));
  }

  long most_ = 0;
  // For lines outside that begin at a multiple of the alignment and that do not: of most_ lines and
  // of the others.
  std::array<std::array<FftwPlanPair<Real>, 2>, 2> plans_;
};

}    // namespace bdh
#endif
