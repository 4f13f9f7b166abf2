// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Numbers of particles with the axes as the user has them, and with those of the solver, which
/// needs the walls of a slit on the slow axis.
#ifndef BDH_FIB_SOLVER_AXES_H
#define BDH_FIB_SOLVER_AXES_H

#include "base/bytes_of.h"
#include "base/moments_kernel.h"
#include "grid/position_kernel.h"
#include "stokes/choice.h"

#include <cstddef>

namespace bdh {

/// Positions, forces, velocities.
struct PolarVectors {
  static constexpr int size = vector_size;
  static ReorderAxes reorder(const ReorderAxes &axes) { return axes; }
};
/// Torques and angular velocities.
struct AxialVectors {
  static constexpr int size = vector_size;
  static ReorderAxial reorder(const ReorderAxes &axes) { return {axes, -1.0}; }
};
/// Stresslets and rates of strain.
struct TracelessTensors {
  static constexpr int size = strain_numbers;
  static ReorderTensors reorder(const ReorderAxes &axes) { return {axes}; }
};

/// Exchanges the axes of what particles bring to the solver and take back from there, Kind::size
/// numbers for each of n particles; Kind is one of those above.  Where the axes are the same
/// nothing is copied.  Execution and Vector: of the place where the particles are.
///
/// Both kinds of vectors share a work array: it is valid until the next call for one of them.
template <class Execution, class Vector> class SolverAxes {
 public:
  SolverAxes(const AxisOrder &order, const Execution &execution) :
      order_(order), execution_(execution)
  {}
  const AxisOrder &order() const { return order_; }

  /// The numbers `from` with the axes of the solver.
  template <class Kind> const double *bring(Kind, const double *from, long n)
  {
    if (order_.is_natural()) return from;
    double *const to = room<Kind>(n);
    execution_.for_each("bdh::reorder", n, Kind::reorder(order_.reorder(from, to)));
    return to;
  }
  /// Where the numbers go that take_back() is to bring to `to`.
  template <class Kind> double *parts(Kind, double *to, long n)
  {
    return order_.is_natural() ? to : room<Kind>(n);
  }
  /// to := the numbers in parts(), with the axes of the user.
  template <class Kind> void take_back(Kind, double *to, long n) const
  {
    if (order_.is_natural()) return;
    const double *from = array<Kind>(*this).data();
    execution_.for_each("bdh::reorder", n, Kind::reorder(order_.reorder(from, to)));
  }

  /// Bytes on this rank.
  std::size_t memory() const { return bytes_of(vectors_, tensors_); }

 private:
  template <class Kind, class Self> static auto &array(Self &self)
  {
    return Kind::size == vector_size ? self.vectors_ : self.tensors_;
  }
  template <class Kind> double *room(long n)
  {
    Vector &all = array<Kind>(*this);
    all.resize(Kind::size * n);
    return all.data();
  }

  AxisOrder order_;
  Execution execution_;
  Vector vectors_, tensors_;
};

}    // namespace bdh
#endif
