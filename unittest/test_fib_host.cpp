// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "bdh_host.h"
#define TEST_BACKEND bdh::HostBackend
#include "typed_fib.h"
