// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Transforms of the staggered field: every mode is visited once, at the right place, and transforms
// back.
//
// The tests run on any number of ranks, in slabs and pencils; some grids have fewer planes, rows or
// columns than ranks.  Every law is checked in both precisions.  Bounds are given for double
// precision; in single precision they are wider by the ratio of the rounding errors.

#include "grid/fft.h"

#include "base/errors.h"
#include "grid/row_transforms.h"

#include "support/test_support.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <limits>
#include <stdexcept>
#include <utility>

using namespace bdh;
using namespace bdh_test;

namespace {

using Complex = std::complex<double>;

template <class Real> double rounding()
{
  return double(std::numeric_limits<Real>::epsilon()) / std::numeric_limits<double>::epsilon();
}

/// Half spectra of all components, with the number of visits to each mode.
struct Spectrum {
  Grid grid;
  std::array<std::vector<double>, 3> re, im;
  std::vector<double> visits;

  explicit Spectrum(const Grid &g) : grid(g)
  {
    const std::size_t size = g.half() * g.n[1] * g.n[2];
    for (int d = 0; d < g.dim; ++d) {
      re[d].assign(size, 0.0);
      im[d].assign(size, 0.0);
    }
    visits.assign(size, 0.0);
  }
  std::size_t place(long kx, long ky, long kz) const
  {
    return ((kz * grid.n[1] + ky) * grid.half() + kx);
  }
  template <class Real> void record(const ModeBlock<Real> &b)
  {
    ASSERT_EQ(b.rows, grid.n[grid.slow_axis()]);
    for (long row = 0; row < b.rows; ++row)
      for (long column = 0; column < b.columns; ++column) {
        const long kx = b.first_x + column, ky = grid.dim == 3 ? b.y : row,
                   kz = grid.dim == 3 ? row : 0;
        ASSERT_LT(kx, grid.half());
        const std::size_t at = place(kx, ky, kz);
        visits[at] += 1.0;
        for (int d = 0; d < grid.dim; ++d) {
          re[d][at] = b.f[d][2 * (row * b.columns + column)];
          im[d][at] = b.f[d][2 * (row * b.columns + column) + 1];
        }
      }
  }
  void sum(const Comm &comm)
  {
    sum_over_ranks(visits, comm);
    for (int d = 0; d < grid.dim; ++d) {
      sum_over_ranks(re[d], comm);
      sum_over_ranks(im[d], comm);
    }
  }
};

/// fft.solve() from a whole field to a whole field.  With Input::zero the arrays are NaN, since
/// nothing may read them.
template <class Real> Field solved(VectorFft<Real> &fft, const Field &in, const Comm &comm,
                                   const typename VectorFft<Real>::Change &change,
                                   Input input = Input::field)
{
  AlignedArray<Real> local[3];
  std::array<Real *, 3> view{};
  for (int d = 0; d < in.grid.dim; ++d) {
    const std::vector<double> part = own_part(in, d, fft.parts(), fft.allocation());
    local[d].assign(part.begin(), part.end());
    if (input == Input::zero) std::fill(local[d].begin(), local[d].end(), Real(NAN));
    view[d] = local[d].data();
  }
  fft.solve(view, change, input);
  Field out(in.grid);
  for (int d = 0; d < in.grid.dim; ++d)
    add_part(std::vector<double>(local[d].begin(), local[d].end()), d, fft.parts(), out);
  sum_over_ranks(out, comm);
  return out;
}

template <class Real> Field solved(const Field &in, const Comm &comm, const FftSetup &setup,
                                   const typename VectorFft<Real>::Change &change)
{
  VectorFft<Real> fft(in.grid, comm, setup);
  return solved(fft, in, comm, change);
}

/// The definition F(k) = sum_x f(x) exp(-2 pi i k.x/n), axis by axis.
std::vector<Complex> definition(const Field &f, int d)
{
  const auto &n = f.grid.n;
  std::vector<Complex> a(f.c[d].begin(), f.c[d].end());
  const long stride[3] = {1, n[0], n[0] * n[1]};
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Complex> b(a.size()), phase;
    for (long x = 0; x < n[axis]; ++x)
      phase.push_back(std::polar(1.0, -2.0 * M_PI * double(x) / double(n[axis])));
    for (long p = 0; p < f.grid.cells(); ++p) {
      const long k = p / stride[axis] % n[axis], base = p - k * stride[axis];
      for (long x = 0; x < n[axis]; ++x)
        b[p] += a[base + x * stride[axis]] * phase[k * x % n[axis]];
    }
    a.swap(b);
  }
  return a;
}

std::vector<Grid> grids()
{
  std::vector<Grid> g;
  for (const std::vector<long> &n : std::vector<std::vector<long>>{{4, 4, 4},
                                                                   {6, 5, 3},
                                                                   {5, 4, 6},
                                                                   {7, 3, 5},
                                                                   {8, 6, 2},
                                                                   {3, 2, 9},
                                                                   {4, 7, 1},
                                                                   {16, 16, 5},
                                                                   {17, 15, 9},
                                                                   {130, 37, 2},
                                                                   {6, 4},
                                                                   {4, 7},
                                                                   {5, 6},
                                                                   {7, 5},
                                                                   {8, 2},
                                                                   {3, 12}})
    g.push_back(make_grid(n, {1.0}));
  // Long rows, so that the columns of one row of y pass through the cache in several blocks, the
  // last one smaller.
  g.push_back(make_grid({390, 2, 120}, {1.0}));
  g.push_back(make_grid({601, 150}, {1.0}));
  return g;
}

/// Grids with something to prune: odd and even sizes, fewer planes or rows than ranks, and both n_y
/// and n_x/2 + 1 odd.
std::vector<Grid> pruned_grids()
{
  std::vector<Grid> g;
  for (const std::vector<long> &n : std::vector<std::vector<long>>{{24, 20, 16},
                                                                   {21, 15, 18},
                                                                   {32, 27, 3},
                                                                   {16, 2, 24},
                                                                   {60, 9, 2},
                                                                   {24, 25, 7},
                                                                   {12, 12, 1},
                                                                   {14, 30, 11},
                                                                   {14, 30, 70}})
    g.push_back(make_grid(n, {1.0}));
  // Rows with more than one block.
  g.push_back(make_grid({390, 6, 120}, {1.0}));
  return g;
}

/// The signed index nearest to zero.
long near_zero(long i, long n) { return 2 * i > n ? i - n : i; }

/// A smooth function of k inside an ellipsoid, 0 outside.  The ellipsoid is not aligned with the
/// axes, as in a sheared box.
struct Ellipsoid {
  Grid grid;
  double radius, tilt;    // radius in units of n

  double value(long kx, long ky, long kz) const
  {
    const double x = double(kx) / double(grid.n[0]),
                 y = double(near_zero(ky, grid.n[1])) / double(grid.n[1]);
    const double z = double(near_zero(kz, grid.n[2])) / double(grid.n[2]), slanted = y - tilt * x;
    const double r2 = (x * x + slanted * slanted + z * z) / (radius * radius);
    return r2 > 1.0 ? 0.0 : std::exp(-r2) * (1.0 + 0.3 * x - 0.2 * y + 0.1 * z);
  }
  std::vector<long> columns() const
  {
    std::vector<long> c(grid.n[1], 0);
    for (long y = 0; y < grid.n[1]; ++y)
      for (long x = 0; x < grid.half(); ++x)
        if (value(x, y, 0) != 0.0) c[y] = x + 1;
    return c;
  }
  KeptModes kept() const
  {
    KeptModes k{0, 0};
    const std::vector<long> c = columns();
    for (long y = 0; y < grid.n[1]; ++y)
      if (c[y]) {
        k.x = std::max(k.x, c[y] - 1);
        k.y = std::max(k.y, std::labs(near_zero(y, grid.n[1])));
      }
    return k;
  }
  template <class Real> void operator()(const ModeBlock<Real> &b) const
  {
    for (long row = 0; row < b.rows; ++row)
      for (long column = 0; column < b.columns; ++column) {
        const Real v = value(b.first_x + column, b.y, row);
        for (int d = 0; d < 3; ++d)
          for (long part = 0; part < 2; ++part) b.f[d][2 * (row * b.columns + column) + part] *= v;
      }
  }
};

/// Sets the modes to a fixed function of k that belongs to a real field.  all_zero remains true if
/// the modes were zero before.
template <class Real> void fill(const Ellipsoid &e, const ModeBlock<Real> &b, bool &all_zero)
{
  for (long row = 0; row < b.rows; ++row)
    for (long column = 0; column < b.columns; ++column)
      for (int d = 0; d < 3; ++d) {
        Real *f = b.f[d] + 2 * (row * b.columns + column);
        all_zero = all_zero && f[0] == Real(0) && f[1] == Real(0);
        // The function is even in k, so that it is Hermitian also where both k and -k are stored.
        const double x = double(b.first_x + column), y = double(near_zero(b.y, e.grid.n[1]));
        const double z = double(near_zero(row, e.grid.n[2]));
        const auto &n = e.grid.n;
        const bool nyquist = 2 * (b.first_x + column) == n[0] || 2 * b.y == n[1] || 2 * row == n[2];
        const bool inside = e.value(b.first_x + column, b.y, row) != 0.0 && !nyquist;
        f[0] = inside ? 1.0 + d + std::cos(x + 2.0 * y - z) : Real(0);
        f[1] = inside ? std::sin(x - y + 0.5 * z) : Real(0);
      }
}

/// How many ranks share each slab: one, two or all of them.
enum class Sharing { none, pairs, all };
template <class Number, Sharing sharing_by> struct Layout {
  using Real = Number;
  static constexpr Sharing sharing = sharing_by;
};

template <class L> class VectorFftTest : public testing::Test {
 protected:
  void SetUp() override
  {
    if (world().size() == 1 && L::sharing != Sharing::none) GTEST_SKIP() << "one rank";
  }
  /// Those that differ from slabs, and are small.
  static std::vector<Grid> chosen(const std::vector<Grid> &grids)
  {
    if (L::sharing == Sharing::none) return grids;
    std::vector<Grid> some;
    for (const Grid &g : grids)
      if (g.dim == 3 && g.cells() < 20000) some.push_back(g);
    return some;
  }
  static FftSetup setup(const Grid &g, FftEffort effort = FftEffort::estimate)
  {
    const int ranks = world().size();
    if (g.dim == 2 || L::sharing == Sharing::none) return {effort, 1};
    return {effort, L::sharing == Sharing::pairs ? std::min(2, ranks) : ranks};
  }
};
using Layouts = testing::Types<Layout<double, Sharing::none>, Layout<float, Sharing::none>,
                               Layout<double, Sharing::pairs>, Layout<float, Sharing::pairs>,
                               Layout<double, Sharing::all>, Layout<float, Sharing::all>>;
TYPED_TEST_SUITE(VectorFftTest, Layouts);

}    // namespace

// The error of FFTW grows like log n.  1e-14 of the largest value leaves a factor of ten at these
// sizes.
TYPED_TEST(VectorFftTest, ThereAndBackIsTheNumberOfCells)
{
  using Real = typename TypeParam::Real;
  for (const Grid &g : this->chosen(grids()))
    for (FftEffort effort : {FftEffort::estimate, FftEffort::measure}) {
      Field f = random_field(g, 3);
      const Field out =
          solved<Real>(f, world(), this->setup(g, effort), [](const ModeBlock<Real> &) {});
      for (int d = 0; d < g.dim; ++d)
        for (double &v : f.c[d]) v *= g.cells();
      EXPECT_LT(distance(f, out), 1e-14 * rounding<Real>() * f.norm()) << name_of(g);
    }
}

// All modes of a random field equal the definition, and each is visited exactly once over all
// ranks.
TYPED_TEST(VectorFftTest, ModesAreThoseOfTheDefinition)
{
  using Real = typename TypeParam::Real;
  for (const Grid &g : this->chosen(grids())) {
    const Field f = random_field(g, 4);
    Spectrum s(g);
    solved<Real>(f, world(), this->setup(g), [&](const ModeBlock<Real> &b) { s.record(b); });
    s.sum(world());
    double worst = 0.0, missed = 0.0;
    for (int d = 0; d < g.dim; ++d) {
      const std::vector<Complex> expected = definition(f, d);
      for (long kz = 0; kz < g.n[2]; ++kz)
        for (long ky = 0; ky < g.n[1]; ++ky)
          for (long kx = 0; kx < g.half(); ++kx) {
            const std::size_t at = s.place(kx, ky, kz);
            missed += std::fabs(s.visits[at] - 1.0);
            worst = std::max(
                worst, std::abs(Complex(s.re[d][at], s.im[d][at]) - expected[f.place(kx, ky, kz)]));
          }
    }
    EXPECT_EQ(missed, 0.0) << name_of(g);
    // The definition sums n terms of order 1 with phases accurate to 1e-16 n.
    EXPECT_LT(worst, 1e-13 * rounding<Real>() * f.norm()) << name_of(g);
  }
}

// A plane wave in one component fills one mode of this component, and the conjugate mode where that
// is stored as well.
TYPED_TEST(VectorFftTest, PlaneWaveFillsOneMode)
{
  using Real = typename TypeParam::Real;
  for (const Grid &g :
       {make_grid({6, 5, 4}, {1.0}), make_grid({5, 6, 3}, {1.0}), make_grid({6, 5}, {1.0})})
    for (long kz = 0; kz < g.n[2]; ++kz)
      for (long ky = 0; ky < g.n[1]; ++ky)
        for (long kx = 0; kx < g.half(); ++kx) {
          Field f(g);
          const int component = (kx + ky + kz) % g.dim;
          for (long z = 0; z < g.n[2]; ++z)
            for (long y = 0; y < g.n[1]; ++y)
              for (long x = 0; x < g.n[0]; ++x)
                f.at(component, x, y, z) = std::cos(2.0 * M_PI *
                                                        (double(kx * x) / double(g.n[0]) +
                                                         double(ky * y) / double(g.n[1]) +
                                                         double(kz * z) / double(g.n[2])) +
                                                    0.3);
          Spectrum s(g);
          solved<Real>(f, world(), this->setup(g), [&](const ModeBlock<Real> &b) { s.record(b); });
          s.sum(world());
          // cos(k.x + a) = (e^{ia} e^{ik.x} + c.c.)/2 gives n/2 e^{ia}, or n cos a if the mode is
          // its own conjugate.
          const long cx = wrap(-kx, g.n[0]), cy = wrap(-ky, g.n[1]), cz = wrap(-kz, g.n[2]);
          const bool own = cx == kx && cy == ky && cz == kz;
          const Complex half = 0.5 * double(g.cells()) * std::polar(1.0, 0.3);
          Spectrum expected(g);
          auto put = [&](long x, long y, long z, Complex v) {
            if (x >= g.half()) return;
            expected.re[component][expected.place(x, y, z)] = v.real();
            expected.im[component][expected.place(x, y, z)] = v.imag();
          };
          if (own) {
            put(kx, ky, kz, 2.0 * half.real());
          } else {
            put(kx, ky, kz, half);
            put(cx, cy, cz, std::conj(half));
          }
          for (int d = 0; d < g.dim; ++d) {
            const double bound = 1e-13 * rounding<Real>() * double(g.cells());
            EXPECT_LT(difference(s.re[d], expected.re[d]), bound) << name_of(g) << kx << ky << kz;
            EXPECT_LT(difference(s.im[d], expected.im[d]), bound) << name_of(g) << kx << ky << kz;
          }
        }
}

// The modes that `change` writes are transformed back: clearing all but one leaves its plane wave.
TYPED_TEST(VectorFftTest, ChangedModesComeBack)
{
  using Real = typename TypeParam::Real;
  for (const Grid &g : {make_grid({6, 5, 4}, {1.0}), make_grid({6, 5}, {1.0})}) {
    const long kx = 1, ky = 2, kz = g.dim == 3 ? 3 : 0;
    const Field out =
        solved<Real>(Field(g), world(), this->setup(g), [&](const ModeBlock<Real> &b) {
          for (long row = 0; row < b.rows; ++row)
            for (long column = 0; column < b.columns; ++column) {
              const bool here =
                  b.first_x + column == kx && (g.dim == 3 ? b.y == ky && row == kz : row == ky);
              for (int d = 0; d < g.dim; ++d) {
                b.f[d][2 * (row * b.columns + column)] = here ? Real(d + 1) : Real(0);
                b.f[d][2 * (row * b.columns + column) + 1] = here ? Real(0.5) : Real(0);
              }
            }
        });
    for (int d = 0; d < g.dim; ++d)
      for (long z = 0; z < g.n[2]; ++z)
        for (long y = 0; y < g.n[1]; ++y)
          for (long x = 0; x < g.n[0]; ++x) {
            const double angle =
                2.0 * M_PI *
                (double(kx * x) / double(g.n[0]) + double(ky * y) / double(g.n[1]) +
                 double(kz * z) / double(g.n[2]));
            EXPECT_NEAR(out.at(d, x, y, z),
                        2.0 * ((d + 1.0) * std::cos(angle) - 0.5 * std::sin(angle)),
                        1e-13 * rounding<Real>());
          }
  }
}

TYPED_TEST(VectorFftTest, EffortsAgree)
{
  using Real = typename TypeParam::Real;
  for (const Grid &g : this->chosen(grids())) {
    const Field f = random_field(g, 5);
    auto damp = [&](const ModeBlock<Real> &b) {
      for (int d = 0; d < g.dim; ++d)
        for (long i = 0; i < 2 * b.rows * b.columns; ++i) b.f[d][i] /= Real(1 + i / 2 / b.columns);
    };
    const Field a = solved<Real>(f, world(), this->setup(g), damp);
    const Field b = solved<Real>(f, world(), this->setup(g, FftEffort::measure), damp);
    EXPECT_LT(distance(a, b), 1e-14 * rounding<Real>() * a.norm()) << name_of(g);
  }
}

TYPED_TEST(VectorFftTest, PartsCoverTheGridOnce)
{
  using Real = typename TypeParam::Real;
  for (const Grid &g : this->chosen(grids())) {
    VectorFft<Real> fft(g, world(), this->setup(g));
    Field owned(g);
    for_part(g, fft.parts(), [&](std::size_t, std::size_t at) { owned.c[0][at] += 1.0; });
    sum_over_ranks(owned, world());
    for (double o : owned.c[0]) ASSERT_EQ(o, 1.0) << name_of(g);
    EXPECT_GE(fft.allocation(), 2 * g.half() * (g.dim == 3 ? g.n[1] : 1) * fft.slab().count);
  }
}

TEST(GridParts, SomeLayoutsAreImpossible)
{
  const Grid cube = make_grid({8, 8, 8}, {1.0});
  const Comm comm = world();
  EXPECT_NO_THROW(GridParts(cube, comm, comm.size()));
  EXPECT_THROW(GridParts(cube, comm, comm.size() + 1), InvalidOption);
  EXPECT_THROW(GridParts(cube, comm, -1), InvalidOption);
  EXPECT_THROW(GridParts(make_grid({8, 8}, {1.0}), comm, 2), InvalidOption);
}

// Slabs as long as there are planes enough.  Beyond, as many ranks as rows and planes can use.
TEST(GridParts, PencilsWhereSlabsRunOut)
{
  const Grid cube = make_grid({64, 64, 64}, {1.0}), flat = make_grid({256, 256, 8}, {1.0});
  for (int ranks : {1, 2, 3, 4, 8, 16, 32}) EXPECT_EQ(best_share(cube, ranks), 1) << ranks;
  for (int ranks : {1, 2, 4, 8}) EXPECT_EQ(best_share(flat, ranks), 1) << ranks;
  for (const auto &[g, ranks] : std::vector<std::pair<Grid, int>>{
           {cube, 128}, {cube, 1000}, {cube, 4096}, {flat, 12}, {flat, 64}, {flat, 2048}}) {
    const int share = best_share(g, ranks);
    EXPECT_GT(share, 1) << name_of(g) << " " << ranks;
    EXPECT_LE(share, g.n[1]);
    // Planes are dealt first, since each rank keeps whole ones.
    EXPECT_TRUE(share <= ranks / share || ranks / share >= g.n[2]) << name_of(g) << " " << ranks;
    EXPECT_GT(share * std::min<long>(ranks / share, g.n[2]), std::min<long>(ranks, g.n[2]))
        << name_of(g) << " " << ranks;
  }
  EXPECT_EQ(best_share(make_grid({64, 64}, {1.0}), 1000), 1);
}

// A rank keeps whole planes, so that many ranks of a slab need many times the memory of slabs.
TEST(GridParts, PencilsKeepFewPlanes)
{
  for (const auto &[n, ranks] :
       std::vector<std::pair<long, int>>{{2025, 1000}, {2560, 2048}, {2560, 4096}}) {
    const long pencils =
        equal_part(n, 0, ranks / best_share(make_grid({n, n, n}, {1.0}), ranks)).count;
    EXPECT_LE(pencils, 6 * equal_part(n, 0, ranks).count) << n << " " << ranks;
  }
}

// Interpolation reads rows of other ranks next to a rank's own ones, and spreading writes to them.
TYPED_TEST(VectorFftTest, RowsOfOtherRanksNearbyAreZero)
{
  using Real = typename TypeParam::Real;
  const long margin = GridParts::margin;
  for (const Grid &g : {make_grid({6, 5, 3}, {1.0}), make_grid({4, 120, 6}, {1.0})}) {
    const FftSetup setup = this->setup(g);
    VectorFft<Real> fft(g, world(), setup);
    const GridParts &parts = fft.parts();
    std::vector<AlignedArray<Real>> field(3, AlignedArray<Real>(fft.allocation(), Real(1)));
    const std::array<Real *, 3> view{field[0].data(), field[1].data(), field[2].data()};
    const auto other_rows_near = [&](double expected, bool own) {
      for (long p = 0; p < parts.planes().count; ++p)
        for (long y = 0; y < g.n[1]; ++y) {
          const long before = wrap(parts.rows().start - y, g.n[1]),
                     after = wrap(y - (parts.rows().start + parts.rows().count - 1), g.n[1]);
          const bool mine = parts.rows().contains(y), near = before <= margin || after <= margin;
          if (parts.rows().count == 0 || (mine ? !own : !near)) continue;
          for (long i = 0; i < g.n[0]; ++i)
            for (const auto &f : field)
              ASSERT_EQ(f[(p * g.n[1] + y) * 2 * g.half() + i], expected) << p << " " << y;
        }
    };
    fft.solve(view, [](const ModeBlock<Real> &) {});
    if (parts.pencils()) other_rows_near(0.0, false);
    for (const auto &f : field) {
      const bool has_part = parts.planes().count > 0 && parts.rows().count > 0;
      EXPECT_TRUE(!has_part || f[parts.rows().start * 2 * g.half()] != Real(0));
    }
    for (Real *const f : view) parts.clear(f);
    other_rows_near(0.0, true);
  }
}

// Pruned modes are zero anyway, so the same change without KeptModes gives the same field.  Radii
// extend beyond n/2, where all modes are kept.  keep() changes between solves as in a shearing box,
// to fewer and to more modes.
TYPED_TEST(VectorFftTest, PrunedIsUnprunedWithZeros)
{
  using Real = typename TypeParam::Real;
  for (const Grid &g : this->chosen(pruned_grids()))
    for (const double radius : {0.05, 0.3, 0.38, 0.49, 0.9}) {
      if (g.cells() > 100000 && radius != 0.38) continue;
      const Field f = random_field(g, 6);
      const Ellipsoid widest{g, radius, 0.5};
      KeptModes kept = widest.kept();
      const KeptModes upright = Ellipsoid{g, radius, 0.0}.kept();
      kept = {std::max(kept.x, upright.x), std::max(kept.y, upright.y)};
      VectorFft<Real> pruned(g, world(), this->setup(g), kept), whole(g, world(), this->setup(g));
      for (const double tilt : {0.5, 0.0, -0.2, 0.5}) {
        const Ellipsoid change{g, radius, tilt};
        if (change.kept().x > kept.x || change.kept().y > kept.y) continue;
        pruned.keep(change.columns());
        const Field a = solved<Real>(pruned, f, world(), change),
                    b = solved<Real>(whole, f, world(), change);
        EXPECT_GT(b.norm(), 0.0);
        EXPECT_LT(distance(a, b), 1e-14 * rounding<Real>() * f.norm() * double(g.cells()))
            << name_of(g) << " radius " << radius << " tilt " << tilt;
      }
    }
}

// Over all ranks modes are visited at most once, and kept ones exactly once.  Before keep() the
// whole rectangle is kept.
TYPED_TEST(VectorFftTest, EveryKeptColumnIsVisitedOnce)
{
  using Real = typename TypeParam::Real;
  for (const Grid &g : this->chosen(pruned_grids())) {
    const Ellipsoid e{g, 0.38, 0.3};
    const KeptModes kept = e.kept();
    VectorFft<Real> fft(g, world(), this->setup(g), kept);
    for (const bool rectangle : {true, false}) {
      std::vector<long> columns = e.columns();
      if (rectangle)
        for (long y = 0; y < g.n[1]; ++y)
          columns[y] = std::labs(near_zero(y, g.n[1])) <= kept.y ? kept.x + 1 : 0;
      else
        fft.keep(columns);
      Spectrum s(g);
      solved<Real>(fft, random_field(g, 7), world(),
                   [&](const ModeBlock<Real> &b) { s.record(b); });
      s.sum(world());
      for (long kz = 0; kz < g.n[2]; ++kz)
        for (long ky = 0; ky < g.n[1]; ++ky)
          for (long kx = 0; kx < g.half(); ++kx) {
            const double visits = s.visits[s.place(kx, ky, kz)];
            if (kx < columns[ky])
              ASSERT_EQ(visits, 1.0) << name_of(g) << " " << kx << " " << ky << " " << kz;
            else
              ASSERT_LE(visits, kx < columns[ky] + 4 && columns[ky] ? 1.0 : 0.0)
                  << name_of(g) << kx << " " << ky;
          }
    }
  }
}

// For pure noise change() sees zeros, whatever the arrays contained, and the backward transform is
// the same.
TYPED_TEST(VectorFftTest, ZeroInputReadsNothing)
{
  using Real = typename TypeParam::Real;
  for (const Grid &g : this->chosen(pruned_grids())) {
    const Ellipsoid e{g, 0.38, 0.3};
    VectorFft<Real> pruned(g, world(), this->setup(g), e.kept()), whole(g, world(), this->setup(g));
    pruned.keep(e.columns());
    bool zero = true, ignored = true;
    auto noise = [&](const ModeBlock<Real> &b) { fill(e, b, zero); };
    auto over_zeros = [&](const ModeBlock<Real> &b) { fill(e, b, ignored); };
    const Field a = solved<Real>(pruned, Field(g), world(), noise, Input::zero);
    const Field b = solved<Real>(whole, Field(g), world(), noise, Input::zero);
    EXPECT_TRUE(zero) << name_of(g);
    const Field c = solved<Real>(whole, Field(g), world(), over_zeros);
    EXPECT_GT(c.norm(), 0.0);
    // The modes are of order 1, so the norm of the spectrum is at most that of a wave over all
    // cells.
    EXPECT_LT(distance(a, c), 1e-14 * rounding<Real>() * double(g.cells())) << name_of(g);
    EXPECT_LT(distance(b, c), 1e-14 * rounding<Real>() * double(g.cells())) << name_of(g);
  }
}

// Plans found by measurement give the same numbers.
TYPED_TEST(VectorFftTest, MeasuredPruningAgrees)
{
  using Real = typename TypeParam::Real;
  for (const Grid &g : {make_grid({24, 25, 14}, {1.0}), make_grid({14, 30, 70}, {1.0})}) {
    const Ellipsoid e{g, 0.38, 0.3};
    const Field f = random_field(g, 8);
    VectorFft<Real> measured(g, world(), this->setup(g, FftEffort::measure), e.kept()),
        whole(g, world(), this->setup(g));
    measured.keep(e.columns());
    const Field a = solved<Real>(measured, f, world(), e), b = solved<Real>(whole, f, world(), e);
    EXPECT_LT(distance(a, b), 1e-14 * rounding<Real>() * f.norm() * double(g.cells()));
  }
}

TYPED_TEST(VectorFftTest, NothingBeyondKeptModes)
{
  using Real = typename TypeParam::Real;
  const Grid g = make_grid({12, 10, 8}, {1.0});
  VectorFft<Real> fft(g, world(), this->setup(g), KeptModes{3, 2}),
      whole(g, world(), this->setup(g));
  EXPECT_THROW(fft.keep(std::vector<long>(9, 0)), std::invalid_argument);
  std::vector<long> columns(10, 0);
  fft.keep(columns);
  EXPECT_EQ(solved<Real>(fft, random_field(g, 9), world(), [](const ModeBlock<Real> &) {}).norm(),
            0.0);
  columns[2] = 5;
  EXPECT_THROW(fft.keep(columns), std::invalid_argument);
  columns[2] = 4;
  EXPECT_NO_THROW(fft.keep(columns));
  columns[3] = 1;
  EXPECT_THROW(fft.keep(columns), std::invalid_argument);
  EXPECT_THROW(whole.keep(columns), std::invalid_argument);
  const Grid flat = make_grid({12, 10}, {1.0});
  EXPECT_THROW(VectorFft<Real>(flat, world(), this->setup(flat), KeptModes{3, 2}),
               std::invalid_argument);
}

template <class Real> class RowTransformsTest : public testing::Test {};
using Precisions = testing::Types<double, float>;
TYPED_TEST_SUITE(RowTransformsTest, Precisions);

// Rows by pairs are the real transforms of FFTW, also of modes that no real row has: what is
// imaginary in those that are their own conjugates does not reach the other row of a pair.
TYPED_TEST(RowTransformsTest, PairsAreRealTransforms)
{
  using Real = TypeParam;
  std::mt19937 random(7);
  std::uniform_real_distribution<Real> uniform(-1, 1);
  for (const long n : {1, 2, 3, 4, 5, 15, 16, 17, 30, 31, 32, 33, 64, 130})
    for (const long rows : {1, 2, 7, 40}) {
      const int length = n;
      const bdh::PlainFft<Real> plain(1, &length, rows);
      bdh::RowTransforms<Real> pairs(n, rows, FftEffort::estimate, 2);
      const long pitch = 2 * (n / 2 + 1);
      for (const bool forward : {true, false}) {
        AlignedArray<Real> b(pitch * rows);
        for (Real &x : b) x = uniform(random);
        // Planes may begin at any complex number.
        AlignedArray<Real> a(2, Real(NAN));
        a.insert(a.end(), b.begin(), b.end());
        if (forward) {
          pairs.forward(a.data() + 2, 1);
          plain.forward(b.data());
        } else {
          pairs.backward(a.data() + 2, 1);
          plain.backward(b.data());
        }
        const double bound = 1e-15 * rounding<Real>() * n;
        long wrong = 0;    // not a number is wrong, too
        for (long i = 0; i < bdh::ssize(b); ++i)
          if (i % pitch < (forward ? pitch : n) && !(std::fabs(a[i + 2] - b[i]) < bound)) ++wrong;
        EXPECT_EQ(wrong, 0) << (forward ? "forward " : "backward ") << n << " x " << rows;
      }
    }
}

TEST(NextFastSize, HasSmallFactorsAndIsTheNext)
{
  auto smooth = [](long n) {
    for (long p : {2, 3, 5, 7})
      while (n % p == 0) n /= p;
    return n == 1;
  };
  for (long n = 1; n < 3000; ++n) {
    const long m = next_fast_size(n);
    ASSERT_GE(m, n);
    EXPECT_TRUE(smooth(m)) << n;
    for (long k = n; k < m; ++k) EXPECT_FALSE(smooth(k)) << n;
  }
  EXPECT_EQ(next_fast_size(11), 12);
  EXPECT_EQ(next_fast_size(121), 125);
  EXPECT_EQ(next_fast_size(0), 1);
}
