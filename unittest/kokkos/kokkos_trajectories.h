// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Trajectories of the fixes with the KOKKOS package, for comparison with those of the plain styles
/// on the same ranks in the same process.  BDH_TEST_THREADS is the number of threads of each rank.
/// It is the same for all tests, since Kokkos starts only once in a process.
#ifndef BDH_TEST_KOKKOS_TRAJECTORIES_H
#define BDH_TEST_KOKKOS_TRAJECTORIES_H

#include "fix.h"
#include "lammps/lammps_scenes.h"
#include "neighbor.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace bdh_test {

inline std::string kokkos_options(const std::string &newton_and_lists)
{
  const char *threads = std::getenv("BDH_TEST_THREADS");
#if defined(KOKKOS_ENABLE_CUDA)
  const std::string where = "g 1 t ";
#else
  const std::string where = "t ";
#endif
  return "-k on " + where + (threads ? threads : "1") + " -sf kk -pk kokkos " + newton_and_lists;
}

const std::vector<std::string> kokkos_machines = {"newton on neigh half", "newton off neigh half",
                                                  "newton off neigh full"};

struct Trajectory {
  std::vector<double>
      end;            // positions and velocities after some steps, and all that the fix puts out
  long builds = 0;    // of neighbor lists
};

inline Trajectory trajectory(const std::string &options, const std::string &scene,
                             const std::string &fix, int steps,
                             const std::string &expected_style = "")
{
  LammpsSession lmp(MPI_COMM_WORLD, options);
  lmp.script(scene);
  lmp.script(fix);
  lmp.command("run " + std::to_string(steps));
  if (!expected_style.empty()) {
    EXPECT_EQ(lmp.fix("move")->style, expected_style);
  }
  Trajectory t;
  t.end = lmp.unwrapped_positions();
  const std::vector<double> v = lmp.velocities();
  t.end.insert(t.end.end(), v.begin(), v.end());
  LAMMPS_NS::Fix *move = lmp.fix("move");
  t.end.push_back(move->compute_scalar());
  for (int n = 0; n < move->size_vector; ++n) t.end.push_back(move->compute_vector(n));
  t.builds = lmp->neighbor->ncalls;
  return t;
}

/// The text with the first occurrence of a part replaced; the part must occur.
inline std::string with(std::string text, const std::string &part, const std::string &instead)
{
  const size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return at == std::string::npos ? text : text.replace(at, part.size(), instead);
}

}    // namespace bdh_test
#endif
