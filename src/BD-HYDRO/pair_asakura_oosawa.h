/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef PAIR_CLASS
// clang-format off
PairStyle(asakura/oosawa,PairAsakuraOosawa);
// clang-format on
#else

#ifndef LMP_PAIR_ASAKURA_OOSAWA_H
#define LMP_PAIR_ASAKURA_OOSAWA_H

#include "pair.h"

#include <string>
#include <vector>

namespace LAMMPS_NS {

/// Depletion attraction U(r) = c (D^2 r - r^3/3 - 2 D^3/3) for r < D, 0 beyond.
/// The formulas are in pair/asakura_oosawa_kernel.h; all quantities are in the units of LAMMPS.
class PairAsakuraOosawa : public Pair {
 public:
  PairAsakuraOosawa(class LAMMPS *);
  ~PairAsakuraOosawa() override;

  void compute(int, int) override;
  void settings(int, char **) override;
  void coeff(int, char **) override;
  void init_style() override;
  double init_one(int, int) override;

  void write_restart(FILE *) override;
  void read_restart(FILE *) override;
  void write_restart_settings(FILE *) override;
  void read_restart_settings(FILE *) override;
  void write_data(FILE *) override;
  void write_data_all(FILE *) override;

  double single(int, int, int, int, double, double, double, double &) override;
  void *extract(const char *, int &) override;

 protected:
  double
      cut_global;    // least neighbor cutoff: lets fix adapt raise D up to it; 0 = every pair has D
  double **c;        // strength [energy/distance^3], both triangles set by init_one()
  double **D;        // range [distance]
  double **reach;    // neighbor cutoff since init_style(): D must not exceed it [distance]

  virtual void allocate();
  void add_neighbors_of(int i, int eflag);
  void check_values(int i, int j) const;
  std::vector<std::string> file_entry(const std::string &file, const std::string &entry) const;
};

}    // namespace LAMMPS_NS

#endif
#endif
