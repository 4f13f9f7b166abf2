/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/, Sandia National Laboratories

   This software is distributed under the GNU General Public License.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(bd/pse/kk,FixBDPseKokkos);
FixStyle(bd/pse/kk/device,FixBDPseKokkos);
FixStyle(bd/pse/kk/host,FixBDPseKokkos);
FixStyle(brownian/pse/kk,FixBDPseKokkos);
FixStyle(brownian/pse/kk/device,FixBDPseKokkos);
FixStyle(brownian/pse/kk/host,FixBDPseKokkos);
// clang-format on
#else

#ifndef LMP_FIX_BD_PSE_KOKKOS_H
#define LMP_FIX_BD_PSE_KOKKOS_H

#include "fix_bd_pse.h"

namespace LAMMPS_NS {

/// fix bd/pse with the threads and the neighbor lists of the KOKKOS package.
class FixBDPseKokkos : public FixBDPse {
 public:
  FixBDPseKokkos(class LAMMPS *, int, char **);

 protected:
  void build() override;
  std::string plan_text() const override;
  const bdh::Workers &workers() const override;
  bdh::NeighborView neighbor_view() const override;
  void refresh_ghosts() override;

 private:
  bool uses_kokkos_list() const;

  mutable std::vector<const int *> first_neighbor_;    // by atom
};

}    // namespace LAMMPS_NS
#endif
#endif
