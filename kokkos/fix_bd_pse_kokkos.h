/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(bd/pse/kk,FixBDPseKokkos);
FixStyle(bd/pse/kk/device,FixBDPseKokkos);
FixStyle(bd/pse/kk/host,FixBDPseKokkos);
FixStyle(brownian/pse/kk,FixBDPseKokkos);
FixStyle(brownian/pse/kk/device,FixBDPseKokkos);
FixStyle(brownian/pse/kk/host,FixBDPseKokkos);
FixStyle(temp/bd/pse/kk,FixBDPseKokkos);
FixStyle(temp/bd/pse/kk/device,FixBDPseKokkos);
FixStyle(temp/bd/pse/kk/host,FixBDPseKokkos);
// clang-format on
#else

#ifndef LMP_FIX_BD_PSE_KOKKOS_H
#define LMP_FIX_BD_PSE_KOKKOS_H

#include "fix_bd_pse.h"

#include <string>

namespace LAMMPS_NS {

/// fix bd/pse with the threads and the neighbor lists of the KOKKOS package, or on its device:
/// chooses another engine.
class FixBDPseKokkos : public FixBDPse {
 public:
  FixBDPseKokkos(class LAMMPS *, int, char **);
  void init() override;
  void setup_pre_neighbor() override;
  void pre_neighbor() override;

 protected:
  PlanText plan_text() const override;

 private:
  void make_host_engine();
  void make_device_engine();

  std::string list_text_;
  bool warned_half_box_ = false;
};

}    // namespace LAMMPS_NS
#endif
#endif
