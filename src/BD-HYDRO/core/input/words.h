// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Words of a command line, read one after the other.
#ifndef BDH_INPUT_WORDS_H
#define BDH_INPUT_WORDS_H

#include <array>
#include <string>
#include <vector>

namespace bdh {

/// A number, or the name of a variable that gives one at every step (v_NAME).
struct Quantity {
  double value = 0.0;
  std::string variable;    ///< if empty, `value` is the number
  bool is_variable() const { return !variable.empty(); }
};

/// True if all of `text` is a decimal number, as LAMMPS writes them.  `value` is then that number,
/// which may be infinite.  strtod() alone would also accept nan, inf and hexadecimal numbers, and
/// would read an empty text as 0.
bool read_decimal(const std::string &text, double &value);

/// What a number must be in addition to finite.
enum class Sign { any, positive, not_negative };
bool obeys(double value, Sign sign);
/// The rule in words: "must be a finite number" and so on.
std::string rule(Sign sign);

/// Words of a command, read one after the other.  Each reader throws InvalidOption naming the word
/// that is wrong.
class ArgumentReader {
 public:
  explicit ArgumentReader(std::vector<std::string> words) : words_(std::move(words)) {}
  bool done() const { return next_ == words_.size(); }
  /// True if a word follows and it is a number.
  bool number_follows() const;
  /// `what` is the name of the argument, for messages.
  std::string word(const std::string &what);
  double number(const std::string &what);
  /// The number must lie within the limits or be equal to one of them.  `unit` is for messages.
  double number_within(const std::string &what, std::array<double, 2> limits,
                       const std::string &unit = "");
  long integer(const std::string &what);
  long integer_within(const std::string &what, std::array<long, 2> limits);
  Quantity quantity(const std::string &what);

 private:
  std::vector<std::string> words_;
  std::size_t next_ = 0;
};

}    // namespace bdh
#endif
