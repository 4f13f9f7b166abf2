// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The Stokes problem between walls, straight from its definition: the operators are matrices, made
/// from stencils with ghost values.
///
/// Nothing here is shared with the solvers: no transforms and no factorisation by modes.
#ifndef BDH_TEST_CONFINED_H
#define BDH_TEST_CONFINED_H

#include "support/test_support.h"

#include <Eigen/Dense>
#include <string>
#include <vector>

namespace bdh_test {

inline bdh::Boundary kind_of(char letter)
{
  return letter == 'n'   ? bdh::Boundary::noslip
         : letter == 's' ? bdh::Boundary::slip
         : letter == 'o' ? bdh::Boundary::open
                         : bdh::Boundary::periodic;
}
inline char letter_of(bdh::Boundary kind) { return "pnso"[static_cast<int>(kind)]; }

/// Sets the walls of each axis by letters: "p", or n (no-slip), s (free-slip) or o (open) for the
/// lower face and another one for the upper face.
inline bdh::Grid with_walls(bdh::Grid g, const std::vector<std::string> &walls)
{
  for (std::size_t d = 0; d < walls.size(); ++d)
    for (std::size_t side = 0; side < 2 && walls[d] != "p"; ++side)
      g.boundary[d][side] = kind_of(walls[d][side]);
  return g;
}

inline std::string wall_names(const bdh::Grid &g)
{
  std::string s = name_of(g);
  for (int d = 0; d < g.dim; ++d) {
    s += d ? "/" : " ";
    for (int side = 0; side < (g.walled(d) ? 2 : 1); ++side) s += letter_of(g.boundary[d][side]);
  }
  return s;
}

/// D, D~ and L of a grid.  The unknowns are the faces that are not walls, component by component.
class DenseOperators {
 public:
  explicit DenseOperators(const bdh::Grid &g) : grid_(g)
  {
    for (int d = 0; d < g.dim; ++d)
      for (long k = 0; k < g.n[2]; ++k)
        for (long j = 0; j < g.n[1]; ++j)
          for (long i = 0; i < g.n[0]; ++i) {
            const long at[3] = {i, j, k};
            const bool wall = g.walled(d) && g.boundary[d][0] != bdh::Boundary::open && at[d] == 0;
            number_.push_back(wall ? -1 : count_++);
          }
  }
  long size() const { return count_; }
  /// Number of the unknown at a face, or -1 on a wall.
  long number(int d, long place) const { return number_[d * grid_.cells() + place]; }

  /// (D v) in each cell.
  Eigen::MatrixXd divergence() const
  {
    Eigen::MatrixXd D = Eigen::MatrixXd::Zero(grid_.cells(), count_);
    for_points([&](const long *at, long place) {
      for (int d = 0; d < grid_.dim; ++d) {
        add(D, place, d, at, 0, 0, -1.0 / grid_.h(d));
        add(D, place, d, at, d, 1, 1.0 / grid_.h(d));
      }
    });
    return D;
  }

  /// Divergence of a stress with independent entries.  The normal entries live in cells, s_da
  /// (d != a) on the edges that the faces of d share along a.  The variance is 1, except on edges
  /// in walls: 2 in a no-slip wall and 0 in a free-slip wall.
  Eigen::MatrixXd stress_divergence() const
  {
    std::vector<Eigen::VectorXd> columns;
    for (int d = 0; d < grid_.dim; ++d)
      for (int a = 0; a < grid_.dim; ++a)
        for_points(
            [&](const long *at, long) {
              // The entry between the face `at` and the previous one along a; for a = d this is
              // the cell between two faces.
              const bool wall = a != d && grid_.walled(a) && (at[a] == 0 || at[a] == grid_.n[a]);
              double weight = 1.0;
              if (wall) {
                const bdh::Boundary kind = grid_.boundary[a][at[a] == 0 ? 0 : 1];
                weight = kind == bdh::Boundary::noslip ? std::sqrt(2.0) : 0.0;
              }
              Eigen::MatrixXd row = Eigen::MatrixXd::Zero(1, count_);
              const bool upper = a != d && grid_.walled(a) && at[a] == grid_.n[a];
              const bool lower = wall && !upper;
              if (a == d) {
                add(row, 0, d, at, 0, 0, -1.0 / grid_.h(a));
                add(row, 0, d, at, d, 1, 1.0 / grid_.h(a));
              } else {
                if (!upper) add(row, 0, d, at, 0, 0, weight / grid_.h(a));
                if (!lower) add(row, 0, d, at, a, -1, -weight / grid_.h(a));
              }
              columns.push_back(row.transpose());
            },
            a != d && grid_.walled(a) ? a : -1);
    Eigen::MatrixXd B(count_, bdh::ssize(columns));
    for (std::size_t c = 0; c < columns.size(); ++c) B.col(c) = columns[c];
    return B;
  }

  /// L with ghost values -u behind a no-slip wall and +u behind a free-slip wall.
  Eigen::MatrixXd laplacian() const
  {
    Eigen::MatrixXd L = Eigen::MatrixXd::Zero(count_, count_);
    for (int d = 0; d < grid_.dim; ++d)
      for_points([&](const long *at, long place) {
        const long me = number(d, place);
        if (me < 0) return;
        for (int a = 0; a < grid_.dim; ++a)
          for (int step : {-1, 1}) {
            const double c = 1.0 / (grid_.h(a) * grid_.h(a));
            L(me, me) -= c;
            const long to = at[a] + step;
            if (a != d && grid_.walled(a) && (to < 0 || to >= grid_.n[a]))
              L(me, me) += grid_.boundary[a][to < 0 ? 0 : 1] == bdh::Boundary::noslip ? -c : c;
            else
              add(L, me, d, at, a, step, c);
          }
      });
    return L;
  }

  /// Contribution to L u of the ghost values 2 V - u behind no-slip walls with velocity V.
  Eigen::VectorXd moving_walls(const bdh::WallVectors &V) const
  {
    Eigen::VectorXd f = Eigen::VectorXd::Zero(count_);
    for (int d = 0; d < grid_.dim; ++d)
      for_points([&](const long *at, long place) {
        if (number(d, place) < 0) return;
        for (int a = 0; a < grid_.dim; ++a)
          for (int side = 0; side < 2; ++side)
            if (a != d && at[a] == (side ? grid_.n[a] - 1 : 0))
              f[number(d, place)] += 2.0 * V[a][side][d] / (grid_.h(a) * grid_.h(a));
      });
    return f;
  }

  /// Component d of u at any face, also outside the box.  Behind a wall u is mirrored.  Behind one
  /// moving wall the ghost value is 2 V - u; behind several no-slip walls only u is mirrored.
  double extended(const Eigen::VectorXd &u, const bdh::WallVectors &V, int d, long i, long j,
                  long k) const
  {
    long at[3] = {i, j, k};
    double sign = 1.0, wall_sign = 1.0, wall = 0.0;
    int frictions = 0;
    for (int a = 0; a < grid_.dim; ++a) {
      const long n = grid_.n[a];
      if (!grid_.walled(a)) {
        at[a] = wrap(at[a], n);
        continue;
      }
      if (a == d && (at[a] == 0 || at[a] == n)) return 0.0;    // the face lies in a wall
      if (at[a] >= 0 && at[a] < n) continue;
      const int side = at[a] < 0 ? 0 : 1;
      const bool noslip = grid_.boundary[a][side] == bdh::Boundary::noslip;
      at[a] = a == d ? (side ? 2 * n : 0) - at[a] : (side ? 2 * n : 0) - 1 - at[a];
      sign *= noslip || a == d ? -1.0 : 1.0;
      if (a == d)
        wall_sign *= noslip ? 0.0 : -1.0;
      else if (noslip) {
        ++frictions;
        wall = 2.0 * V[a][side][d];
      }
    }
    return sign * u[number(d, (at[2] * grid_.n[1] + at[1]) * grid_.n[0] + at[0])] +
           (frictions == 1 ? wall_sign * wall : 0.0);
  }

  /// v = L^-1 f for unit viscosity, from the saddle-point problem.  A pseudo-inverse removes its
  /// null vectors: constant pressure, and uniform flows that no wall opposes.
  Eigen::MatrixXd stokes_inverse() const
  {
    const Eigen::MatrixXd D = divergence(), L = laplacian();
    // The divergence-free fields are the null space of D.
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(D, Eigen::ComputeFullV);
    svd.setThreshold(1e-10);
    const Eigen::MatrixXd Z = svd.matrixV().rightCols(count_ - svd.rank());
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Z.transpose() * -L * Z);
    Eigen::VectorXd inverse = eigen.eigenvalues();
    for (double &e : inverse) e = e > 1e-10 * eigen.eigenvalues().maxCoeff() ? 1.0 / e : 0.0;
    const Eigen::MatrixXd V = Z * eigen.eigenvectors();
    return V * inverse.asDiagonal() * V.transpose();
  }

 private:
  /// Calls action(indices, place) for all points.  Along the axis `beyond` this includes the upper
  /// wall.
  template <class Action> void for_points(Action action, int beyond = -1) const
  {
    long n[3] = {grid_.n[0], grid_.n[1], grid_.n[2]};
    if (beyond >= 0) ++n[beyond];
    for (long k = 0; k < n[2]; ++k)
      for (long j = 0; j < n[1]; ++j)
        for (long i = 0; i < n[0]; ++i) {
          const long at[3] = {i, j, k};
          action(at, (k * grid_.n[1] + j) * grid_.n[0] + i);
        }
  }
  /// Adds value to matrix(row, column), with the column of the face of d at `at`, moved by step
  /// along axis.  Faces in walls have no column.
  void add(Eigen::MatrixXd &matrix, long row, int d, const long *at, int axis, int step,
           double value) const
  {
    long to[3] = {at[0], at[1], at[2]};
    to[axis] += step;
    if (grid_.walled(d) && (to[d] == 0 || to[d] == grid_.n[d])) return;
    for (int a = 0; a < 3; ++a) to[a] = wrap(to[a], grid_.n[a]);
    matrix(row, number(d, (to[2] * grid_.n[1] + to[1]) * grid_.n[0] + to[0])) += value;
  }

  bdh::Grid grid_;
  std::vector<long> number_;
  long count_ = 0;
};

}    // namespace bdh_test
#endif
