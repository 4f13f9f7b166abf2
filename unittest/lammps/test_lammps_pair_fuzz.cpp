// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// pair_style asakura/oosawa with random coefficients and damaged parameter files: the result is
// either a message or finite coefficients of the right sign.  The input is the same in every run;
// BDH_FUZZ_ROUNDS requests more of it than the test takes by default.

#include "lammps/lammps_session.h"

#include "force.h"
#include "pair.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

using bdh_test::LammpsSession;

namespace {

const char scene[] = "units lj\natom_style atomic\nregion box block 0 8 0 8 0 8\ncreate_box 1 "
                     "box\nmass 1 1\npair_style asakura/oosawa";

long below(std::mt19937_64 &random, long n) { return random() % n; }

int rounds(int usual)
{
  const char *asked = std::getenv("BDH_FUZZ_ROUNDS");
  return asked ? std::atoi(asked) : usual;
}

/// Tells whether the command was accepted.  If so, the coefficients must be usable.
bool accepted(LammpsSession &lmp, const std::string &command)
{
  const std::string message = lmp.error_of(command);
  if (!message.empty()) {
    EXPECT_GT(message.size(), 20u) << command;
    return false;
  }
  int dim = 0;
  const auto c = static_cast<double **>(lmp->force->pair->extract("c", dim)),
             D = static_cast<double **>(lmp->force->pair->extract("D", dim));
  // Products of finite numbers may still overflow, which is checked at the beginning of a run.
  if (std::isinf(c[1][1]) || std::isinf(D[1][1])) return false;
  EXPECT_TRUE(c[1][1] >= 0.0 && D[1][1] > 0.0)
      << command << ": c = " << c[1][1] << ", D = " << D[1][1];
  return true;
}

void expect_variety(int count, int most)
{
  EXPECT_GT(count, most / 50);
  EXPECT_LT(count, most - most / 10);
}

}    // namespace

TEST(Fuzz, PairCoeff)
{
  const char *const words[] = {"direct", "density", "fraction", "file",  "0",      "1",
                               "0.5",    "2",       "-1",       "1e300", "1e-300", "nan",
                               "inf",    "1e999",   "0x10",     "\"\"",  "'a b'",  "x",
                               "1.0x",   ".",       "-",        "*",     "1*",     "e5"};
  std::mt19937_64 random(3);
  LammpsSession lmp;
  lmp.script(scene);
  const int most = rounds(4000);
  int count = 0;
  for (int i = 0; i < most; ++i) {
    std::string command = "pair_coeff 1 1";
    if (below(random, 3)) command += std::string(" ") + words[below(random, 3)];
    for (long k = below(random, 6); k > 0; --k)
      command += std::string(" ") +
                 words[below(random, 3) ? 4 + below(random, 4) : below(random, std::size(words))];
    count += accepted(lmp, command);
    ASSERT_FALSE(HasFailure());
  }
  expect_variety(count, most);
}

TEST(Fuzz, ParameterFile)
{
  const std::string file = "test_" + std::to_string(getpid()) + ".asakura_oosawa";
  const std::string good = "# depletion  UNITS: lj\n\none direct 1.5 2.5\ntwo density 1.0 0.5 0.7 "
                           "1.0  # comment\n three fraction 1 0.3 0.2 1\n";
  std::mt19937_64 random(4);
  LammpsSession lmp;
  lmp.script(scene);
  const int most = rounds(3000);
  int count = 0;
  for (int i = 0; i < most; ++i) {
    std::string text = good;
    for (long changes = below(random, 5); changes > 0; --changes) {
      const std::size_t at = below(random, text.size() + 1);
      switch (below(random, 6)) {
      case 0: text.insert(at, 1, static_cast<char>(below(random, 256))); break;
      case 1: text.erase(at, below(random, 8)); break;
      case 2: text.insert(at, below(random, 2) ? "\n" : " "); break;
      case 3: text.insert(at, below(random, 2) ? "'" : "\""); break;
      case 4: text.insert(at, below(random, 3000), "x1 #"[below(random, 4)]); break;
      case 5: text.resize(at); break;
      }
      if (text.empty()) text = "\n";
    }
    std::ofstream(file) << text;
    static const char *const entries[] = {"one", "two", "three", "four"};
    count += accepted(lmp, "pair_coeff 1 1 file " + file + " " + entries[below(random, 4)]);
    ASSERT_FALSE(HasFailure()) << text;
  }
  std::remove(file.c_str());
  expect_variety(count, most);
}
