// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Particles on which a force acts that depends on their positions.
#ifndef BDH_TEST_PARTICLES_IN_FIELD_H
#define BDH_TEST_PARTICLES_IN_FIELD_H

#include "base/particles.h"
#include "base/ssize.h"
#include "support/test_support.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace bdh_test {

/// The particles of a step, or of its pieces.
class ParticlesInField : public bdh::Particles {
 public:
  /// x: positions, 3 numbers each.
  explicit ParticlesInField(std::vector<double> x) :
      x_(std::move(x)), force_(x_.size()), before_(x_.size()), id_(counted(x_.size() / 3))
  {}
  long size() const override { return bdh::ssize(id_); }
  const double *x() const override { return x_.data(); }
  const double *force() const override { return force_.data(); }
  const uint64_t *ids() const override { return id_.data(); }
  const double *force_before() const override { return before_.data(); }
  void begin_piece(double) override { before_ = force_; }
  void move_and_update_forces(std::vector<double> &displacement, std::vector<double> *) override
  {
    move(displacement);
  }
  void end_piece(std::vector<double> &displacement, const std::vector<double> &,
                 std::vector<double> *, const std::vector<double> &) override
  {
    move(displacement);
  }
  void finish(const std::vector<double> &displacement, const std::vector<double> &) override
  {
    move(displacement);
  }
  /// Of a number of a force, since the piece began.
  double largest_change() const
  {
    double change = 0.0;
    for (std::size_t k = 0; k < force_.size(); ++k)
      change = std::max(change, std::fabs(force_[k] - before_[k]));
    return change;
  }

 protected:
  /// force_ := that at x_.  Call it in the constructor of a derived class, too.
  virtual void update() = 0;

  std::vector<double> x_, force_;

 private:
  void move(const std::vector<double> &displacement)
  {
    for (std::size_t k = 0; k < x_.size(); ++k) x_[k] += displacement[k];
    update();
  }

  std::vector<double> before_;
  std::vector<uint64_t> id_;
};

}    // namespace bdh_test
#endif
