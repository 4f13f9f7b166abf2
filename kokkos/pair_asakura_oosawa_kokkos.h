/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef PAIR_CLASS
// clang-format off
PairStyle(asakura/oosawa/kk,PairAsakuraOosawaKokkos<LMPDeviceType>);
PairStyle(asakura/oosawa/kk/device,PairAsakuraOosawaKokkos<LMPDeviceType>);
PairStyle(asakura/oosawa/kk/host,PairAsakuraOosawaKokkos<LMPHostType>);
// clang-format on
#else

#ifndef LMP_PAIR_ASAKURA_OOSAWA_KOKKOS_H
#define LMP_PAIR_ASAKURA_OOSAWA_KOKKOS_H

#include "bdh_arrays_kokkos.h"
#include "pair/asakura_oosawa_kernel.h"
#include "pair_asakura_oosawa.h"
#include "pair_kokkos.h"

namespace LAMMPS_NS {

/// PairAsakuraOosawa with the loop over pairs of LAMMPS' pair_kokkos.h, which requires the members
/// from EnabledNeighFlags to m_cutsq, compute_fpair() and compute_evdwl().  The round-off of its
/// two sums, over the neighbors of an atom and over atoms, depends on the threads.  These
/// members are public, since the signatures of the functions that need them differ between
/// releases.
template <class DeviceType> class PairAsakuraOosawaKokkos : public PairAsakuraOosawa {
 public:
  enum { EnabledNeighFlags = FULL | HALFTHREAD | HALF };
  enum { COUL_FLAG = 0 };
  using device_type = DeviceType;
  using AT = ArrayTypes<DeviceType>;

  // public, since nvcc requires this of the element types of views
  struct Depletion {
    double c;    // [energy/length^3]
    double D;    // [length]
  };

  PairAsakuraOosawaKokkos(class LAMMPS *);
  ~PairAsakuraOosawaKokkos() override;

  void compute(int, int) override;
  void init_style() override;
  double init_one(int, int) override;

  /// F(r)/r of two atoms of these types [energy/length^2]; rsq = r^2.  With STACK, the coefficients
  /// are stored in this object.
  template <bool STACK, class Specialisation> KOKKOS_INLINE_FUNCTION double
  compute_fpair(const double &rsq, int, int, int itype, int jtype) const
  {
    const Depletion p = depletion<STACK>(itype, jtype);
    return bdh::ao_force_over_r(sqrt(rsq), p.c, p.D);
  }

  /// U(r) [energy].
  template <bool STACK, class Specialisation> KOKKOS_INLINE_FUNCTION double
  compute_evdwl(const double &rsq, int, int, int itype, int jtype) const
  {
    const Depletion p = depletion<STACK>(itype, jtype);
    return bdh::ao_energy(sqrt(rsq), p.c, p.D);
  }

  template <bool STACK, class Specialisation>
  KOKKOS_INLINE_FUNCTION double compute_ecoul(const double &, int, int, int, int) const
  {
    return 0.0;
  }

  template <bool STACK> KOKKOS_INLINE_FUNCTION Depletion depletion(int itype, int jtype) const
  {
    return STACK ? m_depletion[itype][jtype] : d_depletion(itype, jtype);
  }

  Kokkos::DualView<Depletion **, Kokkos::LayoutRight, DeviceType> k_depletion;
  typename Kokkos::DualView<Depletion **, Kokkos::LayoutRight, DeviceType>::t_dev_const_um
      d_depletion;
  Depletion m_depletion[MAX_TYPES_STACKPARAMS + 1][MAX_TYPES_STACKPARAMS + 1];

  // squared neighbor cutoff; D^2 is smaller while fix adapt has lowered D, and between the two the
  // formulas give 0
  DualArrays::DualTypePairs k_cutsq;
  typename Arrays<DeviceType>::TypePairs d_cutsq;
  double m_cutsq[MAX_TYPES_STACKPARAMS + 1][MAX_TYPES_STACKPARAMS + 1];

  typename Arrays<DeviceType>::ConstPositions x;
  typename Arrays<DeviceType>::Forces f;
  typename AT::t_int_1d_randomread type;
  DualArrays::DualEnergies k_eatom;
  DualArrays::DualVirials k_vatom;
  typename Arrays<DeviceType>::Energies d_eatom;
  typename Arrays<DeviceType>::Virials d_vatom;

  using Pair::copymode;
  using Pair::vflag_fdotr;
  using Pointers::atom;
  using Pointers::lmp;
  using Pointers::neighbor;
  int newton_pair, neighflag, nlocal, eflag, vflag;
  double special_lj[4];

 protected:
  void allocate() override;
  void reserve_per_atom_sums();
};

}    // namespace LAMMPS_NS

#endif
#endif
