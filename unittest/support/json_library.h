// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// nlohmann::json: newer releases of LAMMPS bring a copy in another namespace, whose headers hide
/// the system's.
#ifndef BDH_TEST_JSON_LIBRARY_H
#define BDH_TEST_JSON_LIBRARY_H

#if __has_include("json.h")
#include "json.h"
namespace nlohmann = nlohmann_lmp;
#else
#include <nlohmann/json.hpp>
#endif

#endif
