// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// A LAMMPS instance for tests, which takes commands and returns positions, errors and the log.
#ifndef BDH_TEST_LAMMPS_SESSION_H
#define BDH_TEST_LAMMPS_SESSION_H

#include "atom.h"
#include "atom_masks.h"
#include "bdh_lammps.h"
#include "domain.h"
#include "exceptions.h"
#include "fix.h"
#include "input.h"
#include "lammps.h"
#include "modify.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <mpi.h>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>

namespace bdh_test {

class LammpsSession {
 public:
  /// options: further words of the command line, such as "-k on t 2 -sf kk".  A session without
  /// options takes those of the environment variable BDH_TEST_LAMMPS_OPTIONS.
  explicit LammpsSession(MPI_Comm comm = MPI_COMM_SELF,
                         const std::string &options = default_options()) :
      comm_(comm)
  {
    // Several sessions may exist at the same time, in one process and in several.
    static int sessions = 0;
    log_ = "test_" + std::to_string(getpid()) + "_" + std::to_string(++sessions) + ".log";
    std::vector<std::string> words = {"lmp", "-log", log_, "-screen", "none", "-nocite"};
    std::istringstream more(options);
    for (std::string word; more >> word;) words.push_back(word);
    std::vector<char *> argv;
    for (auto &w : words) argv.push_back(&w[0]);
    lmp_ = new LAMMPS_NS::LAMMPS(argv.size(), argv.data(), comm);
  }
  ~LammpsSession()
  {
    delete lmp_;
    std::remove(log_.c_str());
  }
  LammpsSession(const LammpsSession &) = delete;
  LammpsSession &operator=(const LammpsSession &) = delete;

  LAMMPS_NS::LAMMPS *operator->() { return lmp_; }

  void command(const std::string &line) { lmp_->input->one(line); }
  void commands(const std::vector<std::string> &lines)
  {
    for (const auto &l : lines) command(l);
  }
  /// Several lines of input.
  void script(const std::string &text)
  {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);)
      if (line.find_first_not_of(' ') != std::string::npos) command(line);
  }
  /// Message of the error that ends the commands; empty if there is none.
  std::string error_of(const std::string &text)
  {
    try {
      script(text);
    } catch (LAMMPS_NS::LAMMPSException &e) {
      return e.what();
    }
    return "";
  }

  /// All output so far, including warnings.
  std::string log()
  {
    if (lmp_->logfile) fflush(lmp_->logfile);
    std::ifstream in(log_);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }

  void create_atom(const double *x, int type = 1)
  {
    char line[200];
    std::snprintf(line, sizeof line, "create_atoms %d single %.17g %.17g %.17g units box", type,
                  x[0], x[1], x[2]);
    command(line);
  }

  /// Three numbers for each atom, ordered by atom id, on every rank.
  std::vector<double> unwrapped_positions() { return gathered(true); }
  std::vector<double> velocities() { return gathered(false); }
  /// The per-atom array of a fix, ordered by atom id.
  std::vector<double> per_atom(const std::string &id, int columns)
  {
    const LAMMPS_NS::Atom &atom = host_atoms();
    std::vector<double> mine(columns * atom.natoms, 0.0), all(mine.size());
    for (int i = 0; i < atom.nlocal; ++i)
      std::copy_n(fix(id)->array_atom[i], columns, mine.data() + columns * (atom.tag[i] - 1));
    MPI_Allreduce(mine.data(), all.data(), mine.size(), MPI_DOUBLE, MPI_SUM, comm_);
    return all;
  }

  /// The atoms of this rank, copied back from the device if necessary.
  LAMMPS_NS::Atom &host_atoms()
  {
    LAMMPS_NS::sync_atoms(lmp_, LAMMPS_NS::Host, ALL_MASK, EMPTY_MASK);
    return *lmp_->atom;
  }

  /// To be called after a test has changed positions of host_atoms().
  void have_moved_atoms() { LAMMPS_NS::sync_atoms(lmp_, LAMMPS_NS::Host, EMPTY_MASK, X_MASK); }

  LAMMPS_NS::Fix *fix(const std::string &id)
  {
    return lmp_->modify->fix[lmp_->modify->find_fix(id)];
  }

 private:
  static std::string default_options()
  {
    const char *options = std::getenv("BDH_TEST_LAMMPS_OPTIONS");
    return options ? options : "";
  }
  std::vector<double> gathered(bool positions)
  {
    const LAMMPS_NS::Atom &atom = host_atoms();
    std::vector<double> mine(3 * atom.natoms, 0.0), all(mine.size());
    for (int i = 0; i < atom.nlocal; ++i) {
      double *target = mine.data() + 3 * (atom.tag[i] - 1);
      if (positions)
        lmp_->domain->unmap(atom.x[i], atom.image[i], target);
      else
        for (int d = 0; d < 3; ++d) target[d] = atom.v[i][d];
    }
    MPI_Allreduce(mine.data(), all.data(), mine.size(), MPI_DOUBLE, MPI_SUM, comm_);
    return all;
  }

  MPI_Comm comm_;
  std::string log_;
  LAMMPS_NS::LAMMPS *lmp_;
};

/// A number as input for LAMMPS, without rounding.
inline std::string text(double x)
{
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.17g", x);
  return buffer;
}

/// How often the words occur in the text.
inline size_t occurrences(const std::string &words, const std::string &text)
{
  size_t count = 0;
  for (size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1))
    ++count;
  return count;
}

inline double largest_difference(const std::vector<double> &a, const std::vector<double> &b)
{
  double most = a.size() == b.size() ? 0.0 : 1e300;
  for (size_t i = 0; i < a.size() && i < b.size(); ++i) {
    const double d = a[i] > b[i] ? a[i] - b[i] : b[i] - a[i];
    if (!(d <= most)) most = d;
  }
  return most;
}

}    // namespace bdh_test
#endif
