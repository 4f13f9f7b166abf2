// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Particles for benchmarks of time steps without LAMMPS.
#ifndef BDH_BENCH_RESTING_PARTICLES_H
#define BDH_BENCH_RESTING_PARTICLES_H

#include "fib/step.h"

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace bdh_bench {

/// Particles that stay in place, each under the same force along each axis.  velocity: of the last
/// step.
class RestingParticles : public bdh::Particles {
 public:
  RestingParticles(std::vector<double> x, double force) :
      x_(std::move(x)), f_(x_.size(), force), id_(x_.size() / 3)
  {
    std::iota(id_.begin(), id_.end(), uint64_t(0));
  }
  long size() const override { return bdh::ssize(id_); }
  const double *x() const override { return x_.data(); }
  const double *force() const override { return f_.data(); }
  const uint64_t *ids() const override { return id_.data(); }
  void move_and_update_forces(std::vector<double> &, std::vector<double> *) override {}
  void finish(const std::vector<double> &, const std::vector<double> &v) override { velocity = v; }
  std::vector<double> velocity;

 private:
  std::vector<double> x_, f_;
  std::vector<uint64_t> id_;
};

}    // namespace bdh_bench
#endif
