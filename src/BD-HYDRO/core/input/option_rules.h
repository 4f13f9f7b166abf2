// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Which options a fix cannot have together.
#ifndef BDH_INPUT_OPTION_RULES_H
#define BDH_INPUT_OPTION_RULES_H

#include "input/options.h"

namespace bdh {

/// Throws InvalidOption, naming the option and the remedy, if some of the options exclude each
/// other or one lacks what it needs.
void check_combination(const FibOptions &options);
void check_combination(const PseOptions &options);

}    // namespace bdh
#endif
