// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// What the user may say of a pair of atom types of pair style asakura/oosawa, in any of its forms.
#ifndef BDH_INPUT_DEPLETION_H
#define BDH_INPUT_DEPLETION_H

#include <string>
#include <vector>

namespace bdh {

/// What a pair of atom types needs, whatever the form in which it was given.
struct Depletion {
  double c;    ///< [energy/distance^3]
  double D;    ///< [distance]
};

/// words:  [direct] c D | density sigma_c sigma_d n T | fraction sigma_c sigma_d eta_r T
/// origin: where the words come from, for messages
/// boltz:  Boltzmann's constant [energy/temperature]
/// Throws InvalidOption.
Depletion parse_depletion(const std::vector<std::string> &words, const std::string &origin,
                          double boltz);

}    // namespace bdh
#endif
