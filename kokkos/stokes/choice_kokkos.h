// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Chooses the Stokes solver of a device for the walls of a box.
#ifndef BDH_STOKES_CHOICE_KOKKOS_H
#define BDH_STOKES_CHOICE_KOKKOS_H

#include "stokes/box_kokkos.h"
#include "stokes/choice.h"
#include "stokes/periodic_kokkos.h"
#include "stokes/slit_kokkos.h"

#include <memory>

namespace bdh {

/// AnyStokes on a device; all pointers are device pointers.
template <class Exec> class DeviceStokes : public StokesSolver<double> {
 public:
  /// Collective.
  DeviceStokes(const Grid &grid, const Comm &comm, const FftSetup &,
               const Workers & = Workers::one())
  {
    solver_ = choose_solver<double>(
        grid, [&] { return std::make_unique<DevicePeriodicStokes<Exec>>(grid, comm); },
        [&] { return std::make_unique<DeviceSlitStokes<Exec>>(grid, comm); },
        [&] { return std::make_unique<DeviceBoxStokes<Exec>>(grid, comm); });
  }
  const GridParts &parts() const override { return solver_->parts(); }
  std::size_t allocation() const override { return solver_->allocation(); }
  SolveReport solve(const FieldView &field, const StokesProblem &problem) override
  {
    return solver_->solve(field, problem);
  }
  std::size_t memory() const override { return solver_->memory(); }

 private:
  std::unique_ptr<StokesSolver<double>> solver_;
};

}    // namespace bdh
#endif
