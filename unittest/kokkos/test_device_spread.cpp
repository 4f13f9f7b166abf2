// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// The backend comes first: the tests are written for what it names.
#include "kokkos/device_backend.h"

#include "fib/typed_spread.h"
