// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// FFTW's names in each precision, and its plans in pairs, forward and backward: the only part of
/// the core that includes fftw3.h.
#ifndef BDH_GRID_FFTW_H
#define BDH_GRID_FFTW_H

#include "grid/fft.h"

#include <fftw3.h>
#include <memory>
#include <type_traits>

namespace bdh {

template <class Real> struct Fftw;

template <> struct Fftw<double> {
  using Complex = fftw_complex;
  using PlanPointer = fftw_plan;
  static constexpr auto many_dft = fftw_plan_many_dft;
  static constexpr auto many_r2c = fftw_plan_many_dft_r2c;
  static constexpr auto many_c2r = fftw_plan_many_dft_c2r;
  static constexpr auto execute = fftw_execute_dft;
  static constexpr auto execute_r2c = fftw_execute_dft_r2c;
  static constexpr auto execute_c2r = fftw_execute_dft_c2r;
  static constexpr auto destroy = fftw_destroy_plan;
};

template <> struct Fftw<float> {
  using Complex = fftwf_complex;
  using PlanPointer = fftwf_plan;
  static constexpr auto many_dft = fftwf_plan_many_dft;
  static constexpr auto many_r2c = fftwf_plan_many_dft_r2c;
  static constexpr auto many_c2r = fftwf_plan_many_dft_c2r;
  static constexpr auto execute = fftwf_execute_dft;
  static constexpr auto execute_r2c = fftwf_execute_dft_r2c;
  static constexpr auto execute_c2r = fftwf_execute_dft_c2r;
  static constexpr auto destroy = fftwf_destroy_plan;
};

template <class Real> struct FftwPlanDeleter {
  void operator()(typename Fftw<Real>::PlanPointer p) const { Fftw<Real>::destroy(p); }
};
template <class Real> using FftwPlan =
    std::unique_ptr<typename std::remove_pointer<typename Fftw<Real>::PlanPointer>::type,
                    FftwPlanDeleter<Real>>;

template <class Real> struct FftwPlanPair {
  FftwPlan<Real> forward, backward;
};

template <class Real> typename Fftw<Real>::Complex *as_fftw_complex(Real *p)
{
  return reinterpret_cast<typename Fftw<Real>::Complex *>(p);
}

/// `many` transforms of one axis whose neighbours lie side by side, in place; `stride` complex
/// numbers between points.
template <class Real>
FftwPlanPair<Real> strided_plans(int length, int many, int stride, Real *array, unsigned flags)
{
  auto *modes = as_fftw_complex(array);
  const auto plan = [&](int sign) {
    return Fftw<Real>::many_dft(1, &length, many, modes, nullptr, stride, 1, modes, nullptr, stride,
                                1, sign, flags);
  };
  FftwPlanPair<Real> plans;
  plans.forward.reset(plan(FFTW_FORWARD));
  plans.backward.reset(plan(FFTW_BACKWARD));
  return plans;
}

/// `many` transforms of lines, in place, `distance` complex numbers apart.
template <class Real>
FftwPlanPair<Real> line_plans(int length, int many, int distance, Real *array, unsigned flags)
{
  auto *lines = as_fftw_complex(array);
  const auto plan = [&](int sign) {
    return Fftw<Real>::many_dft(1, &length, many, lines, nullptr, 1, distance, lines, nullptr, 1,
                                distance, sign, flags);
  };
  FftwPlanPair<Real> plans;
  plans.forward.reset(plan(FFTW_FORWARD));
  plans.backward.reset(plan(FFTW_BACKWARD));
  return plans;
}

/// `many` real transforms of `rank` axes (lengths: slowest first), in place in padded rows,
/// `distance` complex numbers apart.
template <class Real> FftwPlanPair<Real> real_plans(int rank, const int *lengths, int many,
                                                    int distance, Real *array, unsigned flags)
{
  auto *modes = as_fftw_complex(array);
  FftwPlanPair<Real> plans;
  plans.forward.reset(Fftw<Real>::many_r2c(rank, lengths, many, array, nullptr, 1, 2 * distance,
                                           modes, nullptr, 1, distance, flags));
  plans.backward.reset(Fftw<Real>::many_c2r(rank, lengths, many, modes, nullptr, 1, distance, array,
                                            nullptr, 1, 2 * distance, flags));
  return plans;
}

// Transforms along the slow axis up to this length, and of the rows and columns of planes, are
// planned with FFTW_PATIENT.  That gains a tenth; beyond, it takes seconds and gains nothing.
constexpr long patient_length = 256, patient_length_in_planes = 64;
inline unsigned planner_flag(FftEffort effort, bool patient)
{
  if (effort == FftEffort::estimate) return FFTW_ESTIMATE;
  return patient ? FFTW_PATIENT : FFTW_MEASURE;
}

}    // namespace bdh
#endif
