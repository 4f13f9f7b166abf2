// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Errors of the core.  The glue turns them into LAMMPS errors in one place (bdh_lammps.h).
#ifndef BDH_BASE_ERRORS_H
#define BDH_BASE_ERRORS_H

#include <sstream>
#include <stdexcept>
#include <string>

namespace bdh {

/// A value that the user gave (equal on all ranks) breaks a rule.
class InvalidOption : public std::runtime_error {
 public:
  explicit InvalidOption(const std::string &message) : std::runtime_error(message) {}
  template <class T>
  InvalidOption(const std::string &what, const T &value, const std::string &rule) :
      std::runtime_error(text(what, value, rule))
  {}

 private:
  template <class T>
  static std::string text(const std::string &what, const T &value, const std::string &rule)
  {
    std::ostringstream out;
    out.precision(10);
    out << what << " = " << value << ", but " << rule;
    return out.str();
  }
};

/// Throws InvalidOption unless the value of `what` is good.
inline void require(bool good, const std::string &what, double value, const std::string &rule)
{
  if (!good) throw InvalidOption(what, value, rule);
}

/// One particle is in a state that cannot be computed with; `index` is its place in the arrays
/// given to the core.
class BadParticle : public std::runtime_error {
 public:
  BadParticle(long index, const std::string &what) : std::runtime_error(what), index(index) {}
  long index;
};

/// An iteration did not reach its tolerance.  All ranks throw it together.
class NotConverged : public std::runtime_error {
 public:
  explicit NotConverged(const std::string &what) : std::runtime_error(what) {}
  NotConverged(const std::string &method, int iterations, double reached, double asked) :
      std::runtime_error(text(method, iterations, reached, asked))
  {}

 private:
  static std::string text(const std::string &method, int iterations, double reached, double asked)
  {
    std::ostringstream out;
    out << method << " has not converged after " << iterations << " iterations: estimated error "
        << reached << ", but " << asked << " is asked for";
    return out.str();
  }
};

}    // namespace bdh
#endif
