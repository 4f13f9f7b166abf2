// Transforms of the staggered field: every mode is visited once, at the right place, and comes back.
//
// Runs on any number of ranks; some grids have fewer planes or columns than ranks.

#include "bdh_fft.h"

#include "test_support.h"

#include <gtest/gtest.h>

#include <complex>

using namespace bdh;
using namespace bdh_test;

namespace
{

using Complex = std::complex<double>;

/// Half spectra of all components, and how often each mode was visited.
struct Spectrum {
  Grid grid;
  std::array<std::vector<double>, 3> re, im;
  std::vector<double> visits;

  explicit Spectrum(const Grid &g) : grid(g)
  {
    const std::size_t size = static_cast<std::size_t>(g.half() * g.n[1] * g.n[2]);
    for (int d = 0; d < g.dim; ++d) {
      re[d].assign(size, 0.0);
      im[d].assign(size, 0.0);
    }
    visits.assign(size, 0.0);
  }
  std::size_t place(long kx, long ky, long kz) const
  {
    return static_cast<std::size_t>((kz * grid.n[1] + ky) * grid.half() + kx);
  }
  void record(const ModeBlock &b)
  {
    ASSERT_EQ(b.rows, grid.n[grid.slow_axis()]);
    for (long row = 0; row < b.rows; ++row)
      for (long column = 0; column < b.columns; ++column) {
        const long kx = b.first_x + column, ky = grid.dim == 3 ? b.y : row, kz = grid.dim == 3 ? row : 0;
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

/// solve() on the ranks of comm, from a whole field to a whole field.
Field solved(const Field &in, const Comm &comm, FftEffort effort, const std::function<void(const ModeBlock &)> &change)
{
  VectorFft fft(in.grid, comm, effort);
  AlignedVector local[3];
  std::array<double *, 3> view{};
  for (int d = 0; d < in.grid.dim; ++d) {
    const std::vector<double> part = slab_part(in, d, fft.slab(), fft.allocation());
    local[d].assign(part.begin(), part.end());
    view[d] = local[d].data();
  }
  fft.solve(view, change);
  Field out(in.grid);
  for (int d = 0; d < in.grid.dim; ++d)
    add_slab(std::vector<double>(local[d].begin(), local[d].end()), d, fft.slab(), out);
  sum_over_ranks(out, comm);
  return out;
}

/// The definition, one axis after the other: F(k) = sum_x f(x) exp(-2 pi i k.x/n).
std::vector<Complex> definition(const Field &f, int d)
{
  const auto &n = f.grid.n;
  std::vector<Complex> a(f.c[d].begin(), f.c[d].end());
  const long stride[3] = {1, n[0], n[0] * n[1]};
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Complex> b(a.size()), phase;
    for (long x = 0; x < n[axis]; ++x) phase.push_back(std::polar(1.0, -2.0 * M_PI * double(x) / double(n[axis])));
    for (long p = 0; p < f.grid.cells(); ++p) {
      const long k = p / stride[axis] % n[axis], base = p - k * stride[axis];
      for (long x = 0; x < n[axis]; ++x) b[p] += a[base + x * stride[axis]] * phase[k * x % n[axis]];
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
                                                                   {6, 4},
                                                                   {4, 7},
                                                                   {5, 6},
                                                                   {7, 5},
                                                                   {8, 2},
                                                                   {3, 12}})
    g.push_back(make_grid(n, {1.0}));
  // Long rows: the columns of one row of y go through the cache in several blocks, the last one smaller.
  g.push_back(make_grid({390, 2, 120}, {1.0}));
  g.push_back(make_grid({601, 150}, {1.0}));
  return g;
}

} // namespace

// FFTW's error grows like log n; 1e-14 of the largest value is ten times what these sizes need.
TEST(VectorFft, ThereAndBackIsTheNumberOfCells)
{
  for (const Grid &g : grids())
    for (FftEffort effort : {FftEffort::estimate, FftEffort::measure}) {
      Field f = random_field(g, 3);
      const Field out = solved(f, world(), effort, [](const ModeBlock &) {});
      for (int d = 0; d < g.dim; ++d)
        for (double &v : f.c[d]) v *= static_cast<double>(g.cells());
      EXPECT_LT(distance(f, out), 1e-14 * f.norm()) << name_of(g);
    }
}

// All modes of a random field against the definition; every mode visited exactly once over all ranks.
TEST(VectorFft, ModesAreThoseOfTheDefinition)
{
  for (const Grid &g : grids()) {
    const Field f = random_field(g, 4);
    Spectrum s(g);
    solved(f, world(), FftEffort::estimate, [&](const ModeBlock &b) { s.record(b); });
    s.sum(world());
    double worst = 0.0, missed = 0.0;
    for (int d = 0; d < g.dim; ++d) {
      const std::vector<Complex> expected = definition(f, d);
      for (long kz = 0; kz < g.n[2]; ++kz)
        for (long ky = 0; ky < g.n[1]; ++ky)
          for (long kx = 0; kx < g.half(); ++kx) {
            const std::size_t at = s.place(kx, ky, kz);
            missed += std::fabs(s.visits[at] - 1.0);
            worst = std::max(worst, std::abs(Complex(s.re[d][at], s.im[d][at]) - expected[f.place(kx, ky, kz)]));
          }
    }
    EXPECT_EQ(missed, 0.0) << name_of(g);
    // The definition sums n terms of order 1 with phases good to 1e-16 n.
    EXPECT_LT(worst, 1e-13 * f.norm()) << name_of(g);
  }
}

// One plane wave fills one mode (and its conjugate where that is stored as well), in the component it was put into.
TEST(VectorFft, PlaneWaveFillsOneMode)
{
  for (const Grid &g : {make_grid({6, 5, 4}, {1.0}), make_grid({5, 6, 3}, {1.0}), make_grid({6, 5}, {1.0})})
    for (long kz = 0; kz < g.n[2]; ++kz)
      for (long ky = 0; ky < g.n[1]; ++ky)
        for (long kx = 0; kx < g.half(); ++kx) {
          Field f(g);
          const int component = static_cast<int>((kx + ky + kz) % g.dim);
          for (long z = 0; z < g.n[2]; ++z)
            for (long y = 0; y < g.n[1]; ++y)
              for (long x = 0; x < g.n[0]; ++x)
                f.at(component, x, y, z) =
                    std::cos(2.0 * M_PI *
                                 (double(kx * x) / double(g.n[0]) + double(ky * y) / double(g.n[1]) +
                                  double(kz * z) / double(g.n[2])) +
                             0.3);
          Spectrum s(g);
          solved(f, world(), FftEffort::estimate, [&](const ModeBlock &b) { s.record(b); });
          s.sum(world());
          // cos(k.x + a) = (e^{ia} e^{ik.x} + c.c.)/2: n/2 e^{ia}, and n cos a where the mode is its own conjugate.
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
            EXPECT_LT(difference(s.re[d], expected.re[d]), 1e-13 * double(g.cells())) << name_of(g) << kx << ky << kz;
            EXPECT_LT(difference(s.im[d], expected.im[d]), 1e-13 * double(g.cells())) << name_of(g) << kx << ky << kz;
          }
        }
}

// What `change` writes is what comes back: dropping all but one mode leaves its plane wave.
TEST(VectorFft, ChangedModesComeBack)
{
  for (const Grid &g : {make_grid({6, 5, 4}, {1.0}), make_grid({6, 5}, {1.0})}) {
    const long kx = 1, ky = 2, kz = g.dim == 3 ? 3 : 0;
    const Field out = solved(Field(g), world(), FftEffort::estimate, [&](const ModeBlock &b) {
      for (long row = 0; row < b.rows; ++row)
        for (long column = 0; column < b.columns; ++column) {
          const bool here = b.first_x + column == kx && (g.dim == 3 ? b.y == ky && row == kz : row == ky);
          for (int d = 0; d < g.dim; ++d) {
            b.f[d][2 * (row * b.columns + column)] = here ? d + 1.0 : 0.0;
            b.f[d][2 * (row * b.columns + column) + 1] = here ? 0.5 : 0.0;
          }
        }
    });
    for (int d = 0; d < g.dim; ++d)
      for (long z = 0; z < g.n[2]; ++z)
        for (long y = 0; y < g.n[1]; ++y)
          for (long x = 0; x < g.n[0]; ++x) {
            const double angle =
                2.0 * M_PI *
                (double(kx * x) / double(g.n[0]) + double(ky * y) / double(g.n[1]) + double(kz * z) / double(g.n[2]));
            EXPECT_NEAR(out.at(d, x, y, z), 2.0 * ((d + 1.0) * std::cos(angle) - 0.5 * std::sin(angle)), 1e-13);
          }
  }
}

TEST(VectorFft, EffortsAgree)
{
  for (const Grid &g : grids()) {
    const Field f = random_field(g, 5);
    auto damp = [&](const ModeBlock &b) {
      for (int d = 0; d < g.dim; ++d)
        for (long i = 0; i < 2 * b.rows * b.columns; ++i) b.f[d][i] /= 1.0 + double(i / 2 / b.columns);
    };
    const Field a = solved(f, world(), FftEffort::estimate, damp), b = solved(f, world(), FftEffort::measure, damp);
    EXPECT_LT(distance(a, b), 1e-14 * a.norm()) << name_of(g);
  }
}

TEST(VectorFft, SlabsCoverTheSlowAxisOnce)
{
  for (const Grid &g : grids()) {
    const Comm comm = world();
    VectorFft fft(g, comm, FftEffort::estimate);
    std::vector<double> owned(static_cast<std::size_t>(g.n[g.slow_axis()]), 0.0);
    for (long p = 0; p < fft.slab().count; ++p) owned[fft.slab().start + p] += 1.0;
    sum_over_ranks(owned, comm);
    for (double o : owned) EXPECT_EQ(o, 1.0) << name_of(g);
    EXPECT_GE(fft.allocation(), static_cast<std::size_t>(2 * g.half() * (g.dim == 3 ? g.n[1] : 1) * fft.slab().count));
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
