// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The pressure that makes a velocity between walls free of divergence, by conjugate gradients.
#ifndef BDH_STOKES_PRESSURE_H
#define BDH_STOKES_PRESSURE_H

#include "base/errors.h"
#include "base/vector_kernel.h"
#include "stokes/box_kernel.h"
#include "stokes/solver.h"

#include <cmath>

namespace bdh {

/// Solves D (-L)^-1 D^T q = -D u; see stokes/box.h.
///
/// Box: the solver whose pressure it is, and whose friend this class.  It has divergence(faces,
/// cells): cells := D faces; gradient(cells, faces): faces := D^T cells; inverse_laplacian(faces,
/// factor, noise); sum(double): over ranks. faces: FieldView, cells: pointer. Vector, Algebra: as
/// for LanczosRoot (base/lanczos.h).
template <class Vector, class Algebra> class PressureIteration {
 public:
  /// cells, faces: numbers in an array of cells, and in one of the faces of a component, which are
  /// not fewer.
  PressureIteration(int dim, std::size_t cells, std::size_t faces,
                    const Algebra &algebra = Algebra()) :
      dim_(dim),
      cells_(cells), algebra_(algebra)
  {
    for (Vector *v : {&pressure_, &residual_, &direction_, &image_}) make(*v, cells);
    for (int d = 0; d < dim; ++d) make(step_[d], faces);
  }

  /// Collective.  velocity += (-L)^-1 D^T q.  Throws NotConverged.
  /// tolerance: of the divergence, relative to that before.
  template <class Box> SolveReport run(Box &box, const FieldView &velocity, double tolerance)
  {
    constexpr int most = 1000;
    SolveReport report;
    box.divergence(velocity, residual_.data());
    algebra_.for_each("bdh::start_descent", cells_,
                      StartDescent{residual_.data(), direction_.data(), pressure_.data()});
    double rr = dot(box, residual_, residual_);
    const double start = rr;
    // What roundings leave of a divergence is no reason to iterate.
    while (rr > tolerance * tolerance * start && rr > 0.0) {
      if (report.iterations == most)
        throw NotConverged("the pressure", most, std::sqrt(rr / start), tolerance);
      const FieldView step = {step_[0].data(), step_[1].data(), step_[2].data()};
      box.gradient(direction_.data(), step);
      box.inverse_laplacian(step, 1.0, nullptr);
      box.divergence(step, image_.data());
      const double alpha = rr / dot(box, direction_, image_);
      dim_ == 3 ? advance<3>(alpha, velocity) : advance<2>(alpha, velocity);
      const double next = dot(box, residual_, residual_);
      algebra_.for_each(
          "bdh::turn", cells_,
          Combine{1.0, residual_.data(), next / rr, direction_.data(), direction_.data()});
      rr = next;
      ++report.iterations;
    }
    report.residual = start > 0.0 ? std::sqrt(rr / start) : 0.0;
    return report;
  }

  /// q of the last run, by cell; its mean is 0.
  const Vector &pressure() const { return pressure_; }
  std::size_t memory() const
  {
    std::size_t numbers = 4 * pressure_.capacity();
    for (const Vector &v : step_) numbers += v.capacity();
    return numbers * sizeof(double);
  }

 private:
  void make(Vector &v, std::size_t size)
  {
    v.resize(size);
    algebra_.for_each("bdh::clear", size, Clear{v.data()});
  }
  /// Over the cells of all ranks.  What pads the rows is 0.
  template <class Box> double dot(const Box &box, const Vector &a, const Vector &b) const
  {
    return box.sum(algebra_.dot(a.data(), b.data(), cells_));
  }
  template <int D> void advance(double alpha, const FieldView &velocity)
  {
    AdvanceDescent<D> a{
        alpha, direction_.data(), image_.data(), {}, pressure_.data(), residual_.data(), {}};
    for (std::size_t d = 0; d < D; ++d) {
      a.step[d] = step_[d].data();
      a.velocity[d] = velocity[d];
    }
    algebra_.for_each("bdh::advance", cells_, a);
  }

  int dim_;
  std::size_t cells_;
  Algebra algebra_;
  Vector step_[3];    // (-L)^-1 D^T direction
  Vector pressure_, residual_, direction_, image_;
};

}    // namespace bdh
#endif
