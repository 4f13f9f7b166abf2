// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "kokkos/device_backend.h"
#include "fib/typed_fib.h"
