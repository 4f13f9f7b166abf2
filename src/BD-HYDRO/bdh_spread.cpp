#include "bdh_spread.h"

#include "bdh_errors.h"
#include "bdh_ib_kernel.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace bdh {

namespace {

struct KernelFacts {
  IbKernel kernel;
  const char *name;
  int width;
  double radius[2], spread[2];    // 2D, 3D
};

// From self-mobilities over the positions in a cell: test_fib_host measures them anew (TypedFibRadius).
constexpr KernelFacts kernel_facts[] = {
    {IbKernel::roma3, "roma3", 3, {0.745, 0.908}, {0.031, 0.0215}},
    {IbKernel::peskin4, "peskin4", 4, {1.042, 1.2544}, {0.0093, 0.0068}},
    {IbKernel::bkp6, "bkp6", 6, {1.227, 1.4685}, {0.00026, 0.00025}},
};

const KernelFacts &facts(IbKernel kernel) { return kernel_facts[static_cast<int>(kernel)]; }

long wrap(long i, long n)
{
  i %= n;
  return i < 0 ? i + n : i;
}

// Particles whose weights are computed together, in vector registers; the weights stay in the first-level cache.
constexpr int batch = 16;

// Cells per particle above which reading all rows costs more than it saves: 200 at 128^3.  At 32 it halves the time.
constexpr long sparse = 200;

// Of a second-level cache of 1 MiB, for the planes that a tile of rows has in use.
constexpr long tile_bytes = 1 << 19;

/// One number per particle of a batch for each of the W lines under it.
template <int W> using BatchWeights = double[W][batch];

/// Weights of a batch of particles along one axis: on the axis' own faces and on the lines half a spacing away.
template <class Kernel> struct AxisWeights {
  static constexpr int W = Kernel::width;
  alignas(64) BatchWeights<W> face, centre, slope;
  alignas(64) int first_face[batch], first_centre[batch];

  /// x: `batch` positions
  void compute(const double *x, bool with_slope)
  {
    lines(x, 0.0, first_face, face, Kernel::weights);
    if (with_slope) lines(x, 0.0, first_face, slope, Kernel::derivatives);
    lines(x, 0.5, first_centre, centre, Kernel::weights);
  }

 private:
  template <class Formula>
  static void lines(const double *x, double shift, int *first, BatchWeights<W> &w, Formula formula)
  {
    BDH_INDEPENDENT
    for (int p = 0; p < batch; ++p) {
      double r, line[W];
      first[p] = static_cast<int>(Kernel::first(x[p] - shift, r));
      formula(r, line);
      for (int i = 0; i < W; ++i) w[i][p] = line[i];
    }
  }
};

/// The columns under a particle as one vector: W, filled up with weights 0 to what fits the registers.
template <int W> struct Columns {
  static constexpr int lanes = W <= 4 ? 4 : 8;
  typedef double Lanes __attribute__((vector_size(lanes * sizeof(double))));
  Lanes v;

  static Columns at(const double *p)
  {
    Columns c;
    std::memcpy(&c.v, p, sizeof c.v);
    return c;
  }
  void store(double *p) const { std::memcpy(p, &v, sizeof v); }
};

/// The faces of one component under one particle: the weights of W lines per axis, and where the lines begin.
template <int W> struct Stencil {
  Columns<W> wx;
  const double *wy, *wz;                  // stride: batch
  const long *columns, *rows, *planes;    // offsets of the W lines; < 0: not in this slab
  bool whole;                             // the vector of columns does not run over the end of a row
};

/// Calls action(weight of the row, offset of the row).
template <int W, int D, class Action> void for_rows(const Stencil<W> &s, const Action &action)
{
  // Copies: the action may write to what, as far as the compiler knows, could be the stencil.
  double wy[W];
  long rows[W];
  for (int j = 0; j < W; ++j) {
    wy[j] = s.wy[j * batch];
    rows[j] = s.rows[j];
  }
  for (int k = 0; k < (D == 3 ? W : 1); ++k) {
    const long plane = D == 3 ? s.planes[k] : 0;
    const double wz = D == 3 ? s.wz[k * batch] : 1.0;
    if (plane < 0) continue;
    for (int j = 0; j < W; ++j)
      if (D == 3 || rows[j] >= 0) action(wz * wy[j], plane + rows[j]);
  }
}

/// field += products of the weights
template <int W, int D> void add(const Stencil<W> &s, double *field)
{
  if (s.whole)
    for_rows<W, D>(s, [wx = s.wx, first = field + s.columns[0]](double c, long row) {
      Columns<W> p = Columns<W>::at(first + row);
      p.v += c * wx.v;
      p.store(first + row);
    });
  else
    for_rows<W, D>(s, [&s, field](double c, long row) {
      for (int i = 0; i < W; ++i) field[row + s.columns[i]] += c * s.wx.v[i];
    });
}

/// sum of field * products of the weights
template <int W, int D> double gather(const Stencil<W> &s, const double *field)
{
  Columns<W> sum{};
  if (s.whole)
    for_rows<W, D>(s, [&sum, first = field + s.columns[0]](double c, long row) {
      sum.v += c * Columns<W>::at(first + row).v;
    });
  else
    for_rows<W, D>(s, [&s, &sum, field](double c, long row) {
      for (int i = 0; i < W; ++i) sum.v[i] += c * field[row + s.columns[i]];
    });
  double total = 0.0;
  for (int i = 0; i < W; ++i) total += s.wx.v[i] * sum.v[i];
  return total;
}

/// All weights of a batch of particles, and from them the stencil of each component.
template <class Kernel, int D> struct Footprints {
  static constexpr int W = Kernel::width;
  AxisWeights<Kernel> axis[D];

  /// own: weights along axis C to use in place of the kernel's face weights.
  template <int C> Stencil<W> stencil(int p, const BatchWeights<W> &own, const GridLines &lines) const
  {
    const double *w[3] = {nullptr, nullptr, nullptr};
    long first[3] = {0, 0, 0};
    for (int d = 0; d < D; ++d) {
      w[d] = (d == C ? own[0] : axis[d].centre[0]) + p;
      first[d] = d == C ? axis[d].first_face[p] : axis[d].first_centre[p];
    }
    Stencil<W> s;
    s.wx = Columns<W>{};
    for (int i = 0; i < W; ++i) s.wx.v[i] = w[0][i * batch];
    s.wy = w[1];
    s.wz = w[2];
    s.columns = lines.at(0, first[0]);
    s.rows = lines.at(1, first[1]);
    s.planes = lines.at(2, first[2]);
    s.whole = first[0] >= 0 && first[0] + Columns<W>::lanes <= lines.columns();
    return s;
  }
};

/// Calls action(component) with the component as a compile-time constant.
template <int D, class Action> void for_components(Action action)
{
  action(std::integral_constant<int, 0>{});
  action(std::integral_constant<int, 1>{});
  if constexpr (D == 3) action(std::integral_constant<int, 2>{});
}

}    // namespace

int kernel_width(IbKernel kernel) { return facts(kernel).width; }
const char *kernel_name(IbKernel kernel) { return facts(kernel).name; }
double radius_over_spacing(IbKernel kernel, int dim) { return facts(kernel).radius[dim - 2]; }
double radius_spread(IbKernel kernel, int dim) { return facts(kernel).spread[dim - 2]; }

IbKernel kernel_from_name(const std::string &name)
{
  for (const KernelFacts &f : kernel_facts)
    if (name == f.name) return f.kernel;
  throw InvalidOption("kernel", name, "must be roma3, peskin4 or bkp6");
}

/// Reads the rows ahead of the particles in the order of memory.  The particles of a row lie at random, and cache lines
/// that are fetched in random order arrive at a quarter of the rate (5 instead of 22 GB/s on an EPYC, with or without
/// prefetch instructions), slower still when a vector lies across two of them.
struct HostSpreader::ReadAhead {
  const HostSpreader &spreader;
  const FieldView &field;
  bool worthwhile;
  long tile = -1, next_plane = 0;

  ReadAhead(const HostSpreader &s, const FieldView &f) :
      spreader(s), field(f),
      worthwhile(static_cast<long>(s.original_.size()) * sparse > s.slab_.count * s.lines_.plane())
  {
  }

  /// Up to what particle p, in sorted order, may touch.
  void until(long p)
  {
    if (!worthwhile) return;
    const Grid &g = spreader.grid_;
    const long width = spreader.width_, rows = spreader.tile_rows_;
    const long plane = static_cast<long>(spreader.x_[g.slow_axis()][p]) - spreader.slab_.start;
    const long new_tile = g.dim == 3 ? static_cast<long>(spreader.x_[1][p]) / rows : 0;
    if (new_tile != tile) next_plane = plane - width;
    tile = new_tile;
    const long first_row = std::max(0L, tile * rows - width);
    const long last_row = g.dim == 3 ? std::min(g.n[1], (tile + 1) * rows + width) : 1;
    const long end = std::min(plane + width, spreader.slab_.count);
    for (next_plane = std::max(0L, next_plane); next_plane < end; ++next_plane)
      read(next_plane * spreader.lines_.plane(), first_row * spreader.lines_.row(), last_row * spreader.lines_.row());
  }

  void read(long plane, long begin, long end) const
  {
    constexpr long cache_line = 8;
    for (int d = 0; d < spreader.grid_.dim; ++d)
      for (long i = begin; i < end; i += cache_line) {
        const volatile double *p = field[d] + plane + i;
        static_cast<void>(*p);
      }
  }
};

/// The loops, compiled once per kernel and dimension.
struct HostSpreader::Impl {
  template <class Kernel, int D> static void spread(const HostSpreader &, const double *, double, const FieldView &);
  template <class Kernel, int D> static void interpolate(const HostSpreader &, const FieldView &, double *);

  /// Calls action.template operator()<Kernel, D>() for the spreader's kernel and dimension.
  template <class Action> static void dispatch(const HostSpreader &s, Action action)
  {
    if (s.grid_.dim == 3) {
      if (s.kernel_ == IbKernel::roma3) action(Roma3{}, std::integral_constant<int, 3>{});
      if (s.kernel_ == IbKernel::peskin4) action(Peskin4{}, std::integral_constant<int, 3>{});
      if (s.kernel_ == IbKernel::bkp6) action(BaoKayePeskin6{}, std::integral_constant<int, 3>{});
    } else {
      if (s.kernel_ == IbKernel::roma3) action(Roma3{}, std::integral_constant<int, 2>{});
      if (s.kernel_ == IbKernel::peskin4) action(Peskin4{}, std::integral_constant<int, 2>{});
      if (s.kernel_ == IbKernel::bkp6) action(BaoKayePeskin6{}, std::integral_constant<int, 2>{});
    }
  }

  /// Calls action(first particle, how many) in sorted order.
  template <class Action> static void for_batches(const HostSpreader &me, const FieldView &field, Action action)
  {
    const long n = static_cast<long>(me.original_.size());
    ReadAhead grid(me, field);
    for (long begin = 0; begin < n; begin += batch) {
      const int count = static_cast<int>(std::min<long>(batch, n - begin));
      grid.until(begin + count - 1);
      action(begin, count);
    }
  }
};

template <class Kernel, int D>
void HostSpreader::Impl::spread(const HostSpreader &me, const double *force, double drift_kT, const FieldView &field)
{
  constexpr int W = Kernel::width;
  const double inv_volume = 1.0 / me.grid_.cell_volume();
  const bool drift = drift_kT != 0.0;
  Footprints<Kernel, D> prints;
  for_batches(me, field, [&](long begin, int count) {
    for (int d = 0; d < D; ++d) prints.axis[d].compute(me.x_[d].data() + begin, drift);
    for_components<D>([&](auto c) {
      // weight along the component's own axis: F phi + kT phi'/h
      alignas(64) BatchWeights<W> own;
      double f[batch] = {};
      for (int p = 0; p < count; ++p) f[p] = inv_volume * force[3L * me.original_[begin + p] + c];
      const double t = inv_volume * drift_kT / me.grid_.h(c);
      for (int i = 0; i < W; ++i)
        for (int p = 0; p < batch; ++p)
          own[i][p] = f[p] * prints.axis[c].face[i][p] + (drift ? t * prints.axis[c].slope[i][p] : 0.0);
      for (int p = 0; p < count; ++p) add<W, D>(prints.template stencil<c>(p, own, me.lines_), field[c]);
    });
  });
}

template <class Kernel, int D>
void HostSpreader::Impl::interpolate(const HostSpreader &me, const FieldView &field, double *velocity)
{
  constexpr int W = Kernel::width;
  Footprints<Kernel, D> prints;
  for_batches(me, field, [&](long begin, int count) {
    for (int d = 0; d < D; ++d) prints.axis[d].compute(me.x_[d].data() + begin, false);
    for (int p = 0; p < count; ++p) {
      double *u = velocity + 3L * me.original_[begin + p];
      u[2] = 0.0;
      for_components<D>([&](auto c) {
        u[c] = gather<W, D>(prints.template stencil<c>(p, prints.axis[c].face, me.lines_), field[c]);
      });
    }
  });
}

GridLines::GridLines(const Grid &grid, const Slab &slab) :
    columns_(grid.n[0]), row_(2 * grid.half()), plane_(grid.dim == 3 ? row_ * grid.n[1] : row_)
{
  const long spacing[3] = {1, row_, plane_};
  for (int d = 0; d < 3; ++d)
    for (long i = -margin; i <= grid.n[d] + margin; ++i) {
      const long line = wrap(i, grid.n[d]);
      if (d != grid.slow_axis())
        offset_[d].push_back(line * spacing[d]);
      else
        offset_[d].push_back(slab.contains(line) ? (line - slab.start) * spacing[d] : -1);
    }
}

HostSpreader::HostSpreader(const Grid &grid, const Slab &slab, IbKernel kernel) :
    grid_(grid), slab_(slab), kernel_(kernel), width_(kernel_width(kernel)), lines_(grid, slab)
{
  const long row_bytes = static_cast<long>(sizeof(double)) * grid.dim * (width_ + 1) * lines_.row();
  tile_rows_ = std::clamp(tile_bytes / row_bytes - width_, 1L * width_, std::max(1L * width_, grid.n[1]));
}

long HostSpreader::first_plane(double x_slow) const
{
  const int d = grid_.slow_axis();
  // The first line of the centres; those of the faces begin there or one later, hence plane_reach.
  return static_cast<long>(std::floor((x_slow - grid_.lo[d]) / grid_.h(d) - 0.5 * (width_ - 1)));
}

void check_positions(const Grid &grid, const double *x, long n)
{
  for (long i = 0; i < n; ++i)
    for (int d = 0; d < grid.dim; ++d)
      if (!(std::fabs(x[3 * i + d] - grid.lo[d]) < 1e12 * grid.length[d]))
        throw BadParticle(i, "its position is not a finite number, or astronomically far away");
}

/// A position that rounds to n is as good as 0.
void HostSpreader::scale(const double *x, long n)
{
  for (int d = 0; d < grid_.dim; ++d) {
    scaled_[d].resize(static_cast<std::size_t>(n));
    double *to = scaled_[d].data();
    const double lo = grid_.lo[d], h = grid_.h(d), period = static_cast<double>(grid_.n[d]);
    BDH_INDEPENDENT
    for (long i = 0; i < n; ++i) {
      const double cells = (x[3 * i + d] - lo) / h;
      to[i] = cells - period * std::floor(cells / period);
    }
  }
}

/// key_ := place of each particle's grid row in the order tile, plane, row; bin_[k + 1] := particles with key k.
void HostSpreader::count_keys(long n)
{
  const bool planes = grid_.dim == 3;
  const long tile = planes ? tile_rows_ : 1, tiles = (grid_.n[1] + tile - 1) / tile;
  std::vector<int> row_key;
  for (long y = 0; y <= grid_.n[1]; ++y)
    row_key.push_back(static_cast<int>(std::min(y, grid_.n[1] - 1) / tile * tile * grid_.n[2] + y % tile));
  key_.resize(static_cast<std::size_t>(n));
  bin_.assign(static_cast<std::size_t>(tiles * tile * (grid_.n[2] + 1)) + 1, 0);
  for (long i = 0; i < n; ++i) {
    key_[i] = row_key[static_cast<long>(scaled_[1][i])];
    if (planes) key_[i] += static_cast<int>(tile * static_cast<long>(scaled_[2][i]));
    ++bin_[key_[i] + 1];
  }
}

void HostSpreader::bind(const double *x, long n)
{
  // Counting sort.
  scale(x, n);
  count_keys(n);
  for (std::size_t k = 1; k < bin_.size(); ++k) bin_[k] += bin_[k - 1];
  for (int d = 0; d < 3; ++d) x_[d].assign(static_cast<std::size_t>(n + batch), 0.0);    // batches are read whole
  original_.resize(static_cast<std::size_t>(n));
  for (long i = 0; i < n; ++i) {
    const int place = bin_[key_[i]]++;
    original_[place] = static_cast<int>(i);
    for (int d = 0; d < grid_.dim; ++d) x_[d][place] = scaled_[d][i];
  }
}

void HostSpreader::spread(const double *force, double drift_kT, const FieldView &field) const
{
  Impl::dispatch(*this, [&](auto kernel, auto dim) {
    Impl::spread<decltype(kernel), decltype(dim)::value>(*this, force, drift_kT, field);
  });
}

void HostSpreader::interpolate(const FieldView &field, double *velocity) const
{
  Impl::dispatch(*this, [&](auto kernel, auto dim) {
    Impl::interpolate<decltype(kernel), decltype(dim)::value>(*this, field, velocity);
  });
}

std::size_t HostSpreader::memory() const
{
  std::size_t bytes = (original_.capacity() + key_.capacity() + bin_.capacity()) * sizeof(int);
  for (int d = 0; d < 3; ++d) bytes += (x_[d].capacity() + scaled_[d].capacity()) * sizeof(double);
  return bytes;
}

}    // namespace bdh
