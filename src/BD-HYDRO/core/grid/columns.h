// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Rows of grid points in vector registers: several short ones in one, or a long one in several.
#ifndef BDH_GRID_COLUMNS_H
#define BDH_GRID_COLUMNS_H

#include "base/shuffles.h"

#include <algorithm>
#include <utility>

namespace bdh {

/// Numbers that follow each other in memory, in `count` registers of `lanes` numbers.
template <class Real, int lanes, int count> class Registers {
 public:
  using Part = LanesOf<Real, lanes>;

  static Registers at(const Real *p)
  {
    Registers c;
    for (int k = 0; k < count; ++k) c.part_[k] = lanes_at<Real, lanes>(p + k * lanes);
    return c;
  }
  void store(Real *p) const
  {
    for (int k = 0; k < count; ++k) put_lanes<Real, lanes>(part_[k], p + k * lanes);
  }
  /// `count` of these registers, from register `first` on.
  template <int all> static Registers of(const Registers<Real, lanes, all> &more, int first)
  {
    Registers c;
    for (int k = 0; k < count; ++k) c.part_[k] = more.part(first + k);
    return c;
  }
  const Part &part(int k) const { return part_[k]; }
  Real operator[](int i) const { return part_[i / lanes][i % lanes]; }
  void set(int i, Real x) { part_[i / lanes][i % lanes] = x; }
  Registers &operator+=(const Registers &more)
  {
    for (int k = 0; k < count; ++k) part_[k] += more.part_[k];
    return *this;
  }
  friend Registers operator*(Real factor, const Registers &c)
  {
    Registers product;
    for (int k = 0; k < count; ++k) product.part_[k] = factor * c.part_[k];
    return product;
  }
  friend Real dot(const Registers &a, const Registers &b)
  {
    Part sum = a.part_[0] * b.part_[0];
    for (int k = 1; k < count; ++k) sum += a.part_[k] * b.part_[k];
    return sum_of<Real, lanes>(sum);
  }

 private:
  Part part_[count];
};

/// Lanes of W columns, filled up to a width that fits the registers, and how many of these a
/// register has.
constexpr int lanes_of_columns(int W) { return W <= 4 ? 4 : W <= 8 ? 8 : 16; }
template <class Real> constexpr int lanes_in_register(int W)
{
  return std::min(lanes_of_columns(W), register_bytes / static_cast<int>(sizeof(Real)));
}

/// The W columns under a particle, filled up with zeros.
template <class Real, int W> struct Columns
    : Registers<Real, lanes_in_register<Real>(W),
                lanes_of_columns(W) / lanes_in_register<Real>(W)> {
  static constexpr int lanes = lanes_of_columns(W), in_register = lanes_in_register<Real>(W),
                       registers = lanes / in_register;
  using Base = Registers<Real, in_register, registers>;
  Columns() = default;
  Columns(const Base &b) : Base(b) {}
  /// How many of the registers C sums over rows take at once: more would not stay in registers.
  template <int C> static constexpr int at_once = std::min(registers, C == 1 ? 4 : 2);
};

/// Rows of `columns` numbers each, as many as fit into a register.  `used`: rows that there are
/// from the first one on; those missing in a tile are zero, and are neither read nor written.
template <class Real, int columns> struct RowTile {
  static constexpr int rows =
      std::max(1, register_bytes / static_cast<int>(columns * sizeof(Real)));
  static constexpr int lanes = rows * columns;
  using Lanes = LanesOf<Real, lanes>;

  /// The tile of the vectors row(j) of columns.
  template <int used, class Row> static Lanes of(const Row &row)
  {
    return join<rows, 0, used>(row);
  }
  /// Calls write(j, row j of the tile).
  template <int used, class Write> static void split(Lanes v, const Write &write)
  {
    split(v, write, std::make_integer_sequence<int, std::min(used, rows)>());
  }

 private:
  template <int count, int begin, int used, class Row>
  static LanesOf<Real, count * columns> join(const Row &row)
  {
    if constexpr (begin >= used)
      return LanesOf<Real, count * columns>{};
    else if constexpr (count == 1)
      return row(begin);
    else
      return joined<Real, count / 2 * columns>(join<count / 2, begin, used>(row),
                                               join<count / 2, begin + count / 2, used>(row),
                                               std::make_integer_sequence<int, count * columns>());
  }
  template <class Write, int... j>
  static void split(Lanes v, const Write &write, std::integer_sequence<int, j...>)
  {
    (write(j, part_of<Real, lanes, j * columns>(v, std::make_integer_sequence<int, columns>())),
     ...);
  }
};

}    // namespace bdh
#endif
