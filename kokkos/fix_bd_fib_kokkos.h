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
FixStyle(temp/bd/fib/kk,FixBDFibKokkos);
FixStyle(temp/bd/fib/kk/device,FixBDFibKokkos);
FixStyle(temp/bd/fib/kk/host,FixBDFibKokkos);
// clang-format on
#else

#ifndef LMP_FIX_BD_FIB_KOKKOS_H
#define LMP_FIX_BD_FIB_KOKKOS_H

#include "fix_bd_fib.h"

namespace LAMMPS_NS {

/// fix bd/fib with the threads of the KOKKOS package, or on its device: chooses another engine.
class FixBDFibKokkos : public FixBDFib {
 public:
  FixBDFibKokkos(class LAMMPS *, int, char **);
  void init() override;

 protected:
  PlanText plan_text() const override;

 private:
  bool warned_half_box_ = false;
};

}    // namespace LAMMPS_NS
#endif
#endif
