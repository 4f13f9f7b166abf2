// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Harmonic pairs whose stiffness is known, and what the fixes report of it.
#ifndef BDH_TEST_LAMMPS_STIFFNESS_H
#define BDH_TEST_LAMMPS_STIFFNESS_H

#include "lammps/lammps_session.h"

#include <cmath>
#include <cstdio>

namespace bdh_test {

/// WCA spheres of radius 1 and depth 1 kT that do not overlap much.
inline const char *const wca_suspension = R"(
units lj
atom_style sphere
atom_modify map array sort 1 5.0
boundary p p p
lattice sc 0.064
region box block 0 5 0 5 0 5
create_box 1 box
create_atoms 1 box
displace_atoms all random 0.3 0.3 0.3 5 units box
set group all diameter 2.0
set group all density 1.0
pair_style lj/cut 2.2449240966187465
pair_coeff 1 1 1.0 2.0
pair_modify shift yes
neighbor 0.5 bin
comm_modify cutoff 5.0
neigh_modify every 1 delay 0 check yes
thermo_style custom step
)";

/// Pairs of particles of radius 1 at the distance `bond` in a fluid of viscosity 1, kT = 1, far
/// from each other.
struct HarmonicPairs {
  int pairs = 64;
  double stiffness = 50.0;    // of the distance
  double bond = 8.0;

  /// dt mu k of the distance, whose mobility is twice that of a particle.
  double number(double dt) const { return dt * 2.0 * stiffness / (6.0 * M_PI); }
  double step_for(double p) const { return p / number(1.0); }

  std::string scene() const
  {
    std::string text = R"(
units lj
atom_style bond
atom_modify map array sort 1 10.0
boundary p p p
region box block 0 80 0 80 0 80
create_box 1 box bond/types 1 extra/bond/per/atom 1
mass 1 1.0
pair_style zero 12.0
pair_coeff * *
bond_style harmonic
bond_coeff 1 )" + bdh_test::text(0.5 * stiffness) +
                       " " + bdh_test::text(bond) + R"(
neighbor 0.05 bin
neigh_modify every 1 delay 0 check yes
thermo_style custom step
)";
    for (int i = 0; i < pairs; ++i) {
      char line[300];
      const double x = 10.0 + 20 * (i % 4), y = 10.0 + 20 * (i / 4 % 4), z = 10.0 + 20 * (i / 16);
      std::snprintf(line, sizeof line,
                    "create_atoms 1 single %g %g %g\ncreate_atoms 1 single %g %g %g\n", x, y, z,
                    x + bond, y, z);
      text += line;
    }
    for (int i = 0; i < pairs; ++i)
      text += "create_bonds single/bond 1 " + std::to_string(2 * i + 1) + " " +
              std::to_string(2 * i + 2) + "\n";
    return text;
  }
};

/// The last line about stiffness in a log.
struct StiffnessLine {
  double mean = 0.0, most = 0.0, atom = 0.0, step = 0.0;
  std::string text;
};
inline StiffnessLine stiffness_line(const std::string &log)
{
  StiffnessLine l;
  const size_t at = log.rfind("stiffness of contacts");
  if (at == std::string::npos) return l;
  l.text = log.substr(at, log.find('\n', at) - at);
  const size_t p = l.text.find("p = ");
  if (std::sscanf(l.text.c_str() + p, "p = %lf on average, %lf at most (atom %lf, step %lf)",
                  &l.mean, &l.most, &l.atom, &l.step) != 4)
    l = {};
  return l;
}

}    // namespace bdh_test
#endif
