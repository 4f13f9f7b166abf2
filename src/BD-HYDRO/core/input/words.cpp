// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "input/words.h"

#include "base/errors.h"

#include <cerrno>
#include <cmath>
#include <cstdlib>

namespace bdh {

bool read_decimal(const std::string &text, double &value)
{
  char *end = nullptr;
  value = std::strtod(text.c_str(), &end);
  return end != text.c_str() && !*end &&
         text.find_first_not_of("0123456789.+-eE") == std::string::npos;
}

std::string ArgumentReader::word(const std::string &what)
{
  if (done())
    throw InvalidOption(what, "(nothing)",
                        "a value must follow: see the syntax on the manual page");
  return words_[next_++];
}

double ArgumentReader::number(const std::string &what)
{
  const std::string text = word(what);
  double value;
  if (!read_decimal(text, value) || !std::isfinite(value))
    throw InvalidOption(what, text, "must be a finite number");
  return value;
}

bool ArgumentReader::number_follows() const
{
  if (done()) return false;
  double value;
  return read_decimal(words_[next_], value);
}

long ArgumentReader::integer(const std::string &what)
{
  const std::string text = word(what);
  char *end = nullptr;
  errno = 0;
  const long value = std::strtol(text.c_str(), &end, 10);
  if (end == text.c_str() || *end || errno) throw InvalidOption(what, text, "must be an integer");
  return value;
}

Quantity ArgumentReader::quantity(const std::string &what)
{
  Quantity q;
  if (!done() && words_[next_].rfind("v_", 0) == 0) {
    q.variable = word(what).substr(2);
    if (q.variable.empty()) throw InvalidOption(what, "v_", "a variable needs a name: v_NAME");
  } else {
    q.value = number(what);
  }
  return q;
}

}    // namespace bdh
