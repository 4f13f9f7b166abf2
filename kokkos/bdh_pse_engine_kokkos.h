/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Computes the steps of fix bd/pse/kk: with neighbor lists of the KOKKOS package for the host's
/// engine, or with an engine on the device.
#ifndef LMP_BDH_PSE_ENGINE_KOKKOS_H
#define LMP_BDH_PSE_ENGINE_KOKKOS_H

#include "bdh_lammps_kokkos.h"
#include "bdh_pse_engine.h"
#include "pse/mobility_kokkos.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace LAMMPS_NS {

/// True if the host can read the neighbor lists of the KOKKOS package.  Those of a GPU are laid out
/// by columns and lie in its memory.
bool host_reads_kokkos_lists();

/// Call it before lists are built, if their stencils may have changed.  The KOKKOS package copies a
/// stencil to the device only if it was made in a different step from the last one copied.  It
/// would therefore keep an old stencil if a run with another box begins in the step of the last
/// build, or if the box flips after lists were built within the step.
void show_new_stencils(const class Neighbor &neighbor);

/// Half lists of the KOKKOS package if the host can read them, else those of LAMMPS.
class KokkosPairs : public PairSource {
 public:
  using PairSource::PairSource;
  void refresh_ghosts() override;
  bdh::NeighborView view() const override;
  void before_lists() const override;

 protected:
  void adjust(ListWish &wish) const override;

 private:
  mutable std::vector<const int *> first_neighbor_;    // by atom
};

/// Full lists of the KOKKOS package in the memory of the device.
class DevicePairs : public PairSource {
 public:
  using Space = LMPDeviceType::execution_space;
  template <class T> using Array = bdh::DeviceArray<T, Space>;

  using PairSource::PairSource;
  void before_lists() const override;
  void list_was_built() override;
  void refresh_ghosts() override;

  /// True if the particles are these atoms, in this order, and the list has not changed since they
  /// were mapped to it.
  bool is_current(const DeviceGroup<LMPDeviceType> &group) const;
  /// Collective.  Computes on the host, and copies to the device, what changes only with the list
  /// or the group.
  void renew(AtomGroup &group);
  bdh::DeviceNeighbors neighbors() const;
  /// Collective.  The same where each particle and its images are displaced, by dof numbers per
  /// particle.
  bdh::DeviceNeighbors shifted(const double *displacement);
  /// Adds the radii of other ranks' particles behind those of this one's.  given: of all of them;
  /// 0: those of the atoms.
  void gather_ghost_radii(double given, double *radius) const;

  std::size_t memory() const;

 protected:
  void adjust(ListWish &wish) const override;
  void drop_listed(std::vector<std::pair<int, int>> &pairs) const override;

 private:
  bdh::DeviceNeighbors rows() const;
  void copy_unlisted(std::size_t particles);

  bool built_ = true;
  int most_ = 0, most_extra_ = 0;
  Array<int> mapped_;    // the group for which the other arrays were made
  Array<int> particle_, extra_begin_, extra_;
  Array<double> displacement_;    // quads by particle
  Array<double> shifted_;         // positions by atom
};

/// The last noise of the near part in scheme split.  It stays on the device until LAMMPS moves
/// atoms in memory or writes a restart file.  A periodic box on one process exchanges no atoms; it
/// only loses some at times.
class DeviceNoise : public AtomColumns::Mirror, protected Pointers {
 public:
  /// column: where the host keeps it.
  DeviceNoise(LAMMPS *lmp, AtomColumns &columns, const AtomColumns::Column &column) :
      Pointers(lmp), columns_(columns), column_(column)
  {}
  ~DeviceNoise() noexcept override {}    // newer releases let that of Pointers throw

  /// Copies the host's noise to the device unless the device has a newer one.  The step will then
  /// change it on the device.
  double *bring();
  double *data() { return noise_.data(); }
  void bring_home() override;
  void expire() override { is_here_ = false; }
  std::size_t memory() const { return bdh::bytes_of(noise_); }

 private:
  AtomColumns &columns_;
  AtomColumns::Column column_;
  bdh::DeviceArray<double, DevicePairs::Space> noise_;    // by atom
  bool is_here_ = false, is_newer_ = false;               // newer than the host's
};

/// Works in the memory of the device.  On several ranks no forces are evaluated within a step.
class DevicePseEngine : public PseEngine, protected Pointers {
 public:
  using Group = DeviceGroup<LMPDeviceType>;

  DevicePseEngine(LAMMPS *lmp, const PseFixParts &fix, DevicePairs &pairs,
                  std::unique_ptr<Group> group);
  ~DevicePseEngine() noexcept override;    // newer releases let that of Pointers throw

  double make(const bdh::PsePlan &plan) override;
  bool set_cell(const bdh::Cell &cell) override;
  const bdh::PsePlan &plan() const override { return mobility_->plan(); }
  bdh::PseReport step(const bdh::PseStepPlan &plan, bdh::PieceChoice &choice) override;
  bdh::StepAgainstHalves compare_with_halves(const bdh::PseStepPlan &plan, double limit) override;
  bdh::PseVelocityParts parts() const override { return step_.parts(); }
  ConstrainedMotion constrained() const override { return motion_of(step_); }
  void look_again() override;
  std::unique_ptr<bdh::PseProbe> probe(const bdh::PsePlan *other, double viscosity) override;
  std::string describe(long index) const override { return group_->describe(index); }
  double memory() const override;

 private:
  using Space = DevicePairs::Space;
  using Execution = bdh::DeviceExecution<Space>;

  class Around;

  bdh::PseDevice parts_of_device() const;
  bdh::StepInPieces<Execution> pieces() const { return {Execution(), bdh::Comm(world)}; }

  const bdh::PseOptions &options_;
  AtomGroup &host_group_;
  DevicePairs &pairs_;
  PseColumns kept_;
  std::unique_ptr<Group> group_;
  DeviceNoise noise_;
  bdh::Cell cell_;
  std::unique_ptr<Around> around_;
  std::unique_ptr<bdh::DevicePseMobility> mobility_;
  GivenMotions &given_;
  ConstraintOn<Execution> constraint_;
  bdh::ConstrainedStep<Execution, bdh::DeviceNeighbors> step_;
};

}    // namespace LAMMPS_NS
#endif
