/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(bd/fib/kk,FixBDFibKokkos);
FixStyle(bd/fib/kk/device,FixBDFibKokkos);
FixStyle(bd/fib/kk/host,FixBDFibKokkos);
FixStyle(brownian/fib/kk,FixBDFibKokkos);
FixStyle(brownian/fib/kk/device,FixBDFibKokkos);
FixStyle(brownian/fib/kk/host,FixBDFibKokkos);
// clang-format on
#else

#ifndef LMP_FIX_BD_FIB_KOKKOS_H
#define LMP_FIX_BD_FIB_KOKKOS_H

#include "fix_bd_fib.h"

namespace LAMMPS_NS {

/// fix bd/fib with the threads of the KOKKOS package, or on its device (wants_device() says when).
class FixBDFibKokkos : public FixBDFib {
 public:
  FixBDFibKokkos(class LAMMPS *, int, char **);
  ~FixBDFibKokkos() override;
  void init() override;
  double memory_usage() override;

 protected:
  void build() override;
  std::string plan_text() const override;
  const bdh::Workers &workers() const override;
  std::unique_ptr<bdh::FibEngine> make_engine() const override;
  void take_step() override;
  std::string describe(long index) const override;

 private:
  std::string why_not_device() const;

  bool warned_half_box_ = false;
  struct OnDevice;
  std::unique_ptr<OnDevice> device_;    // null: the host does it
};

}    // namespace LAMMPS_NS
#endif
#endif
