// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The pressure that makes a velocity between walls divergence-free, by conjugate gradients.
#ifndef BDH_STOKES_PRESSURE_H
#define BDH_STOKES_PRESSURE_H

#include "base/bytes_of.h"
#include "base/errors.h"
#include "base/execution.h"
#include "base/vector_kernel.h"
#include "stokes/box_kernel.h"
#include "stokes/solver.h"

#include <cmath>

namespace bdh {

/// Solves D (-L)^-1 D^T q = -D u; see stokes/box.h.
///
/// Box is the solver that needs the pressure; it makes this class its friend and has, with faces
/// as a FieldView and cells as a pointer,
///     divergence(faces, cells)                  cells := D faces
///     gradient(cells, faces)                    faces := D^T cells
///     inverse_laplacian(faces, factor, noise)   faces := factor (-L)^-1 faces + noise
///     steepest(faces)                           this rank's sum of (value/spacing)^2
///     sum(double)                               the sum over all ranks
/// A Vector is contiguous and lies where the execution is (base/execution.h).
template <class Vector, class Execution> class PressureIteration {
 public:
  /// `cells` and `faces` are the lengths of an array of cells and of one of a component's faces,
  /// faces >= cells.
  PressureIteration(int dim, std::size_t cells, std::size_t faces,
                    const Execution &execution = Execution()) :
      dim_(dim),
      cells_(cells), execution_(execution)
  {
    for (Vector *v : {&pressure_, &residual_, &direction_, &image_}) make(*v, cells);
    for (int d = 0; d < dim; ++d) make(step_[d], faces);
  }

  /// Collective.  velocity += (-L)^-1 D^T q.  Throws NotConverged.  `tolerance` is the norm of the
  /// divergence that may remain, relative to the initial one.
  template <class Box> SolveReport run(Box &box, const FieldView &velocity, double tolerance)
  {
    constexpr int most = 1000;
    SolveReport report;
    box.divergence(velocity, residual_.data());
    execution_.for_each("bdh::start_descent", cells_,
                        StartDescent{residual_.data(), direction_.data(), pressure_.data()});
    double rr = dot(box, residual_, residual_);
    const double start = rr;
    // A divergence that is only rounding error needs no iteration, and allows none: that of a
    // torque is, between free-slip walls.
    constexpr double rounding = 2e-15;
    const double floor = rounding * rounding * box.sum(box.steepest(velocity));
    while (rr > tolerance * tolerance * start && rr > floor) {
      if (report.iterations == most)
        throw NotConverged("the pressure", most, std::sqrt(rr / start), tolerance);
      const FieldView step = {step_[0].data(), step_[1].data(), step_[2].data()};
      box.gradient(direction_.data(), step);
      box.inverse_laplacian(step, 1.0, nullptr);
      box.divergence(step, image_.data());
      const double alpha = rr / dot(box, direction_, image_);
      dim_ == 3 ? advance<3>(alpha, velocity) : advance<2>(alpha, velocity);
      const double next = dot(box, residual_, residual_);
      execution_.for_each(
          "bdh::turn", cells_,
          Combine{1.0, residual_.data(), next / rr, direction_.data(), direction_.data()});
      rr = next;
      ++report.iterations;
    }
    report.residual = start > floor ? std::sqrt(rr / start) : 0.0;
    return report;
  }

  /// q of the last run in each cell; its mean is 0.
  const Vector &pressure() const { return pressure_; }
  /// Bytes allocated on this rank.
  std::size_t memory() const { return bytes_of(step_, pressure_, residual_, direction_, image_); }

 private:
  void make(Vector &v, std::size_t size)
  {
    v.resize(size);
    execution_.for_each("bdh::clear", size, Clear{v.data()});
  }
  /// Dot product over the cells of all ranks.  The padding of the rows is 0.
  template <class Box> double dot(const Box &box, const Vector &a, const Vector &b) const
  {
    return box.sum(execution_.dot(a.data(), b.data(), cells_));
  }
  template <int D> void advance(double alpha, const FieldView &velocity)
  {
    AdvanceDescent<D> a{
        alpha, direction_.data(), image_.data(), {}, pressure_.data(), residual_.data(), {}};
    for (std::size_t d = 0; d < D; ++d) {
      a.step[d] = step_[d].data();
      a.velocity[d] = velocity[d];
    }
    execution_.for_each("bdh::advance", cells_, a);
  }

  int dim_;
  std::size_t cells_;
  Execution execution_;
  Vector step_[3];    // (-L)^-1 D^T direction
  Vector pressure_, residual_, direction_, image_;
};

}    // namespace bdh
#endif
