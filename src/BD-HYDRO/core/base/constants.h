// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Numbers of mathematics; kernels may use them on a device.
#ifndef BDH_BASE_CONSTANTS_H
#define BDH_BASE_CONSTANTS_H

namespace bdh {

constexpr double pi = 3.14159265358979323846;
constexpr double two_pi = 6.28318530717958647693;
constexpr double root_half = 0.70710678118654752440;

}    // namespace bdh
#endif
