// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "input/words.h"

#include "base/errors.h"

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace bdh {

bool read_decimal(const std::string &text, double &value)
{
  char *end = nullptr;
  value = std::strtod(text.c_str(), &end);
  return end != text.c_str() && !*end &&
         text.find_first_not_of("0123456789.+-eE") == std::string::npos;
}

bool obeys(double value, Sign sign)
{
  if (!std::isfinite(value)) return false;
  if (sign == Sign::any) return true;
  return sign == Sign::positive ? value > 0.0 : value >= 0.0;
}

std::string rule(Sign sign)
{
  const std::string any = "must be a finite number";
  if (sign == Sign::any) return any;
  return any + (sign == Sign::positive ? " > 0" : " >= 0");
}

namespace {

template <class Number> std::string range(const std::array<Number, 2> &limits)
{
  std::ostringstream out;
  out << "must be from " << limits[0] << " to " << limits[1];
  return out.str();
}

}    // namespace

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
  if (!read_decimal(text, value) || !obeys(value, Sign::any))
    throw InvalidOption(what, text, rule(Sign::any));
  return value;
}

double ArgumentReader::number_within(const std::string &what, std::array<double, 2> limits,
                                     const std::string &unit)
{
  const double value = number(what);
  if (value >= limits[0] && value <= limits[1]) return value;
  throw InvalidOption(what, value, range(limits) + (unit.empty() ? "" : " (" + unit + ")"));
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

long ArgumentReader::integer_within(const std::string &what, std::array<long, 2> limits)
{
  const long value = integer(what);
  if (value >= limits[0] && value <= limits[1]) return value;
  // The number goes as a double, because messages shorten that if it is large.
  throw InvalidOption(what, static_cast<double>(value), range(limits));
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
