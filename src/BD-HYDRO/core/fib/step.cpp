// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "fib/step.h"

#include "base/errors.h"

namespace bdh {

namespace {
constexpr struct {
  Scheme scheme;
  const char *name;
} schemes[] = {{Scheme::midpoint, "midpoint"},
               {Scheme::improved, "improved"},
               {Scheme::euler, "euler"},
               {Scheme::trapezoidal, "trapezoidal"}};
}    // namespace

Scheme scheme_from_name(const std::string &name)
{
  for (const auto &s : schemes)
    if (name == s.name) return s.scheme;
  throw InvalidOption("scheme", name, "must be midpoint, improved, euler or trapezoidal");
}

const char *scheme_name(Scheme scheme) { return schemes[static_cast<int>(scheme)].name; }

}    // namespace bdh
