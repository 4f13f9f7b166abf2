// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Rotation vectors of any size turn vectors and quaternions exactly, by the exponential of the
// matrix of the cross product, which Eigen computes from the axis and the angle.

#include "base/rotation_kernel.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace bdh;

namespace {

const Eigen::Vector3d axis = Eigen::Vector3d(0.3, -0.8, 0.5).normalized();

Eigen::Matrix3d matrix_of(const Eigen::Vector3d &r)
{
  return r.norm() > 0.0 ? Eigen::AngleAxisd(r.norm(), r.normalized()).toRotationMatrix()
                        : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

const double angles[] = {0.0, 1e-300, 1e-20, 1e-9, 0.1, 1.0, 3.14, 3.2, 6.28, 7.0, 100.0};

}    // namespace

TEST(Rotation, VectorsTurnAndKeepTheirLength)
{
  for (double angle : angles) {
    const Eigen::Vector3d r = angle * axis, before(1.0, 2.0, -0.5);
    Eigen::Vector3d u = before;
    turn_vector(Turn::by(r.data()), before.norm(), u.data());
    EXPECT_LT((u - matrix_of(r) * before).norm(), 1e-14) << angle;
    EXPECT_NEAR(u.norm(), before.norm(), 1e-15) << angle;
  }
}

TEST(Rotation, QuaternionsTurnInTheAxesOfSpace)
{
  const Eigen::Quaterniond before(Eigen::AngleAxisd(1.2, Eigen::Vector3d(1, 2, 3).normalized()));
  for (double angle : angles) {
    const Eigen::Vector3d r = angle * axis;
    double q[4] = {before.w(), before.x(), before.y(), before.z()};
    turn_quaternion(Turn::by(r.data()), q);
    const Eigen::Matrix3d now = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
    EXPECT_LT((now - matrix_of(r) * before.toRotationMatrix()).norm(), 1e-14) << angle;
  }
}

TEST(Rotation, TheRestOfATurnCompletesIt)
{
  const Eigen::Vector3d other = Eigen::Vector3d(-0.2, 0.1, 0.9).normalized();
  for (double whole_angle : angles)
    for (double done_angle : angles) {
      const Eigen::Vector3d whole = whole_angle * axis, done = done_angle * other;
      Eigen::Vector3d left;
      RestOfTurn{whole.data(), done.data(), left.data()}(0);
      EXPECT_LE(left.norm(), M_PI * (1.0 + 1e-15));
      EXPECT_LT((matrix_of(left) * matrix_of(done) - matrix_of(whole)).norm(), 1e-13)
          << whole_angle << " " << done_angle;
    }
}
