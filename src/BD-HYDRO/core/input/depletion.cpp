// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "input/depletion.h"

#include "base/errors.h"
#include "base/ssize.h"
#include "input/words.h"
#include "pair/asakura_oosawa_kernel.h"

#include <algorithm>

namespace bdh {

namespace {

/// Reads the values of one form.
class DepletionReader {
 public:
  /// `form` is the syntax, for messages.
  DepletionReader(const std::vector<std::string> &values, const std::string &form,
                  const std::string &origin) :
      in_(values),
      origin_(origin)
  {
    const long words = 1 + std::count(form.begin(), form.end(), ' ');
    if (ssize(values) != words - 1)
      throw InvalidOption(origin + " has " + std::to_string(values.size()) +
                          " values, but the form needs " + std::to_string(words - 1) + "; write '" +
                          form + "'");
  }

  double number(const std::string &name, Sign sign)
  {
    const std::string word = in_.word(name);
    double value;
    if (read_decimal(word, value) && obeys(value, sign)) return value;
    throw InvalidOption(name, word + " in " + origin_,
                        "it " + rule(sign) +
                            "; correct it there (c = 0 or n = 0 switches the attraction off)");
  }

 private:
  ArgumentReader in_;
  std::string origin_;
};

}    // namespace

Depletion parse_depletion(const std::vector<std::string> &words, const std::string &origin,
                          double boltz)
{
  const std::string first = words.empty() ? "" : words[0];
  const bool by_density = first == "density", by_fraction = first == "fraction";
  const bool named = by_density || by_fraction || first == "direct";
  if (!named && words.size() != 2)
    throw InvalidOption("form '" + first + "' in " + origin +
                        " is unknown, but must be direct, density or fraction (in pair_coeff also "
                        "file); write 'direct c D', 'density sigma_c sigma_d n T' or 'fraction "
                        "sigma_c sigma_d eta_r T'");
  const std::vector<std::string> values(words.begin() + (named ? 1 : 0), words.end());

  if (!by_density && !by_fraction) {
    DepletionReader in(values, "direct c D", origin);
    const double c = in.number("c", Sign::not_negative);
    return {c, in.number("D", Sign::positive)};
  }
  DepletionReader in(
      values, by_density ? "density sigma_c sigma_d n T" : "fraction sigma_c sigma_d eta_r T",
      origin);
  const double sigma_c = in.number("sigma_c", Sign::positive);
  const double sigma_d = in.number("sigma_d", Sign::positive);
  const double amount = in.number(by_density ? "n" : "eta_r", Sign::not_negative);
  const double kT = boltz * in.number("T", Sign::positive);
  const double n = by_density ? amount : ao_density_from_fraction(amount, sigma_d);
  return {ao_strength_from_density(n, kT), ao_range(sigma_c, sigma_d)};
}

}    // namespace bdh
