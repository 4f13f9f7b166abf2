/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// The beginnings of some LAMMPS classes, as far as the package reads their members, for a library
/// installed without their headers.  bdh_lammps_classes.h includes this file within a namespace.
///
/// Objects of these classes are never made here.  Their destructors are not inline, so that
/// dynamic_cast uses the type information in the library.  The test lammps_classes compares the
/// offset of every member with LAMMPS' own headers, and cmake refuses an installed library of a
/// release for which this was not done.

// no guard, since that test includes the file in two namespaces

struct AtomVec : protected Pointers {
  virtual ~AtomVec();
  int molecular, bonds_allow, angles_allow, dihedrals_allow, impropers_allow, mass_type,
      dipole_type;
  int forceclearflag;
};

struct FixAdapt : Fix {
  ~FixAdapt() override;
  int diamflag;    // only in releases whose class Fix has no diam_flag
};

struct FixDeform : Fix {
  ~FixDeform() override;
  int remapflag;
};

struct FixSetForce : Fix {
  ~FixSetForce() override;
  double xvalue, yvalue, zvalue;
#if BDH_LAMMPS_DATE < 20250204
  int varflag, iregion;
  char *xstr, *ystr, *zstr, *idregion;
#else
  int varflag;
  char *xstr, *ystr, *zstr, *idregion;
  class Region *region;
#endif
  int xvar, yvar, zvar, xstyle, ystyle, zstyle;
};

struct FixPressBerendsen : Fix {
  ~FixPressBerendsen() override;
  int dimension, which;
  double bulkmodulus;
  int pstyle, pcouple, allremap;
};

struct FixNH : Fix {
  ~FixNH() override;
  int dimension, which;
  double dtv, dtf, dthalf, dt4, dt8, dto, boltz, nktv2p, tdof, vol0, t0;
  double t_start, t_stop, t_current, t_target, ke_target, t_freq;
  int tstat_flag, pstat_flag, pstyle, pcouple, allremap;
  int p_flag[6];
  double p_start[6], p_stop[6], p_freq[6], p_target[6], omega[6], omega_dot[6], omega_mass[6],
      p_current[6];
  double drag, tdrag_factor, pdrag_factor;
  int kspace_flag;
#if BDH_LAMMPS_DATE < 20250204
  int nrigid;
#endif
  int dilate_group_bit;
};

struct ComputePressure : Compute {
  ~ComputePressure() override;
  double boltz, nktv2p, inv_volume;
  int nvirial, dimension;
  double **vptr, *kspace_virial;
  Compute *temperature;
  char *id_temp;
  double virial[6];
  int pairhybridflag;
  class Pair *pairhybrid;
  int keflag;
};

struct NeighRequest : protected Pointers {
#if BDH_LAMMPS_DATE < 20250204
  int index;
  void *requestor;
  int requestor_instance, id, pair, fix, compute, command, neigh, half, full, occasional, newton;
  int ghost, size, history, granonesided, respainner, respamiddle, respaouter, bond, omp, intel;
  int kokkos_host, kokkos_device, ssa, cut;
  double cutoff;
#else
  void set_cutoff(double);
  void set_kokkos_device(int);
  void set_kokkos_host(int);
  void enable_full();
#endif
};
