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
// clang-format on
#else

#ifndef LMP_FIX_BD_PSE_KOKKOS_H
#define LMP_FIX_BD_PSE_KOKKOS_H

#include "fix_bd_pse.h"

namespace bdh {
struct DeviceNeighbors;
}

namespace LAMMPS_NS {

/// fix bd/pse with the threads and the neighbor lists of the KOKKOS package, or on its device
/// (wants_device() says when).
class FixBDPseKokkos : public FixBDPse {
 public:
  FixBDPseKokkos(class LAMMPS *, int, char **);
  ~FixBDPseKokkos() override;
  void init() override;
  int setmask() override;
  void setup_pre_neighbor() override;
  void setup(int) override;
  void post_neighbor() override;
  void copy_arrays(int, int, int) override;
  void set_arrays(int) override;
  int pack_restart(int, double *) override;
  void unpack_restart(int, int) override;

 protected:
  std::string plan_text() const override;
  double mobility_memory() const override;
  const bdh::Workers &workers() const override;
  void adjust_request(class NeighRequest &) const override;
  bdh::NeighborView neighbor_view() const override;
  void drop_listed_pairs(std::vector<std::pair<int, int>> &pairs) const override;
  void refresh_ghosts() override;
  void renew_neighbors() override;
  std::unique_ptr<bdh::PseProbe> probe(const bdh::PsePlan *other) override;
  double make_mobility() override;
  bool update_cell() override;
  std::array<long, 3> grid_points() const override;
  void take_step() override;
  std::string describe(long index) const override;

 private:
  bool uses_kokkos_list() const;
  std::string why_not_device() const;
  bdh::DeviceNeighbors device_list() const;
  bdh::DeviceNeighbors device_neighbors() const;
  void bring_noise();
  void fetch_noise() const;
  void replace_noise();

  bool warned_half_box_ = false;
  mutable std::vector<const int *> first_neighbor_;    // by atom
  struct OnDevice;
  friend struct OnDevice;
  std::unique_ptr<OnDevice> device_;    // null: the host does it
};

}    // namespace LAMMPS_NS
#endif
#endif
