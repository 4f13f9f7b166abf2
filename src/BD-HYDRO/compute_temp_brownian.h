/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef COMPUTE_CLASS
// clang-format off
ComputeStyle(temp/brownian,ComputeTempBrownian);
// clang-format on
#else

#ifndef LMP_COMPUTE_TEMP_BROWNIAN_H
#define LMP_COMPUTE_TEMP_BROWNIAN_H

#include "base/bytes_of.h"
#include "compute.h"

#include <array>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/// compute temp/brownian: the temperature that the fixes of this package impose.
///
/// To LAMMPS it is a temperature with a velocity bias.  Removing the bias from a velocity leaves a
/// thermal velocity, from which LAMMPS can compute the kinetic part of the per-atom stress.
class ComputeTempBrownian : public Compute {
 public:
  ComputeTempBrownian(class LAMMPS *, int, char **);
  ~ComputeTempBrownian() override;

  void init() override;
  void setup() override { count(); }
  double compute_scalar() override;
  void compute_vector() override;
  double memory_usage() override { return bdh::bytes_of(kept_); }

  void remove_bias(int i, double *v) override;
  void remove_bias_thr(int i, double *v, double *bias) override;
  void remove_bias_all() override;
  void reapply_bias_all() override;
  void restore_bias(int i, double *v) override;
  void restore_bias_thr(int i, double *v, double *bias) override;
  void restore_bias_all() override;

  /// True if this fix is one of those whose temperature is computed.
  bool is_of(const class Fix *fix) const;

 private:
  /// A fix, and its values at the last evaluation.
  struct Source {
    std::string id;
    class FixBD *fix;
    bigint atoms;          ///< in both its group and that of the compute
    double temperature;    ///< [temperature]
  };

  void count();
  void evaluate();
  std::array<double, 3> thermal_velocity(int i) const;

  std::vector<Source> sources_;
  uint64_t turn_ = 0;    // selects the signs of the thermal velocities
  std::vector<std::array<double, 3>> kept_;
};

}    // namespace LAMMPS_NS
#endif
#endif
