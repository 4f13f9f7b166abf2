// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "fib/typed_step.h"
#include "kokkos/device_backend.h"
