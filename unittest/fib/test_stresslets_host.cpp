// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "fib/host.h"
#define TEST_BACKEND bdh::FibOnHost
#include "fib/typed_stresslets.h"
