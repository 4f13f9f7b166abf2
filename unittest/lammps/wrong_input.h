// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Wrong input, and what the error message must contain: style, parameter, value, rule, remedy.
#ifndef BDH_TEST_WRONG_INPUT_H
#define BDH_TEST_WRONG_INPUT_H

#include "lammps/lammps_session.h"

#include <gtest/gtest.h>

namespace bdh_test {

const char *const box3 = R"(
units lj
atom_style atomic
atom_modify map array
boundary p p p
neigh_modify every 1 delay 0 check yes
region box block 0 8 0 8 0 8
create_box 1 box
create_atoms 1 single 1 2 3
create_atoms 1 single 5 2 3
mass 1 1.0
)";

struct WrongInput {
  const char *input;
  const char *message;    ///< must occur in the error
};

inline void PrintTo(const WrongInput &c, std::ostream *out) { *out << c.input; }

inline void expect_message(const WrongInput &c, const std::string &scene = box3)
{
  LammpsSession lmp;
  lmp.script(scene);
  const std::string message = lmp.error_of(c.input);
  EXPECT_NE(message.find(c.message), std::string::npos) << c.input << "\ngot: " << message;
}

}    // namespace bdh_test
#endif
