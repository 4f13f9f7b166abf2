// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// The timing breakdown at the end of a run: its rows and their sum.

#include "lammps/wrong_input.h"

#include <map>

using bdh_test::LammpsSession;

namespace {

/// Sections of the last breakdown in the log, with their percentages.
std::map<std::string, double> breakdown(const std::string &log)
{
  std::map<std::string, double> rows;
  const std::size_t begin = log.rfind("Timing breakdown of fix 1");
  if (begin == std::string::npos) return rows;
  std::istringstream in(log.substr(begin));
  std::string line;
  for (int heading = 0; heading < 3; ++heading) std::getline(in, line);
  while (std::getline(in, line) && !line.empty())
    rows[line.substr(0, line.find(' '))] = std::stod(line.substr(line.rfind('|') + 1));
  return rows;
}

std::map<std::string, double> breakdown_of(const std::string &commands)
{
  LammpsSession lmp;
  lmp.script(bdh_test::box3);
  lmp.script(commands);
  return breakdown(lmp.log());
}

void expect_rows(const std::string &commands, std::vector<std::string> names)
{
  const auto rows = breakdown_of(commands);
  double all = 0.0;
  for (const auto &row : rows) all += row.second;
  EXPECT_NEAR(all, 100.0, 0.005 * rows.size() + 1e-9) << commands;
  EXPECT_EQ(rows.size(), names.size()) << commands;
  for (const auto &name : names) EXPECT_EQ(rows.count(name), 1u) << commands << ": " << name;
}

}    // namespace

TEST(Timing, RowsMatchTheRun)
{
  const std::string push = "\nfix 2 all addforce 1 0 0\ntimestep 1e-3\nrun 5";
  expect_rows("fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8" + push,
              {"Spread", "FFT", "Noise", "Interp", "Other"});
  expect_rows("fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8 scheme improved" + push,
              {"Spread", "FFT", "Noise", "Interp", "Forces", "Other"});
  expect_rows("fix 1 all bd/pse 1.0 1.0 5 radius 1" + push,
              {"Spread", "FFT", "Noise", "Interp", "Near", "Lanczos", "Comm", "Other"});
  expect_rows("fix 1 all bd/pse 0.0 1.0 5 radius 1" + push,
              {"Spread", "FFT", "Noise", "Interp", "Near", "Comm", "Other"});
}

TEST(Timing, IsOmittedWithoutStatistics)
{
  const std::string fix = "fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8\ntimestep 1e-3\n";
  for (const char *run : {"run 5 post no", "timer off\nrun 5", "run 0"})
    EXPECT_TRUE(breakdown_of(fix + run).empty()) << run;
}

// setup(), which resets the times, is skipped by pre no and by minimize; neither takes a step here.
TEST(Timing, CoversASingleRun)
{
  const std::string fix = "fix 1 all bd/fib 1.0 1.0 5 grid 8 8 8\ntimestep 1e-3\nrun 5\n";
  for (const char *more : {"run 0 pre no", "minimize 0 0 1 1"}) {
    LammpsSession lmp;
    lmp.script(bdh_test::box3);
    lmp.script(fix + more);
    const std::string log = lmp.log(), words = "Timing breakdown of fix 1";
    EXPECT_NE(log.find(words), std::string::npos);
    EXPECT_EQ(log.find(words), log.rfind(words)) << more;
  }
}
