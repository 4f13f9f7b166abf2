// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "kokkos/device_backend.h"    // first: it defines TEST_BACKEND

#include "fib/typed_stresslets.h"
