#include "bdh_spread.h"

#include "bdh_errors.h"
#include "bdh_ib_kernel.h"

#include <algorithm>
#include <cmath>

namespace bdh {

namespace {

struct KernelFacts {
  IbKernel kernel;
  const char *name;
  int width;
  double radius[2], spread[2];    // 2D, 3D
};

// Measured by bench/kernel_radius.py on this package and agreeing with shared independent values: README of bench.
constexpr KernelFacts kernel_facts[] = {
    {IbKernel::roma3, "roma3", 3, {0.745, 0.908}, {0.031, 0.018}},
    {IbKernel::peskin4, "peskin4", 4, {1.042, 1.2544}, {0.0093, 0.0054}},
    {IbKernel::bkp6, "bkp6", 6, {1.227, 1.4685}, {0.00026, 0.0002}},
};

const KernelFacts &facts(IbKernel kernel) { return kernel_facts[static_cast<int>(kernel)]; }

long wrap(long i, long n)
{
  i %= n;
  return i < 0 ? i + n : i;
}

/// Weights of one particle along one axis, on the axis' own faces and on the lines half a spacing away.
template <class Kernel> struct AxisWeights {
  static constexpr int W = Kernel::width;
  double face[W], centre[W], slope[W];
  long first_face, first_centre;
};

template <class Kernel> AxisWeights<Kernel> axis_weights(double x, bool with_slope)
{
  AxisWeights<Kernel> a;
  double r;
  a.first_face = static_cast<long>(Kernel::first(x, r));
  Kernel::weights(r, a.face);
  if (with_slope) Kernel::derivatives(r, a.slope);
  a.first_centre = static_cast<long>(Kernel::first(x - 0.5, r));
  Kernel::weights(r, a.centre);
  return a;
}

/// The faces of one component under one particle: weights per axis and where the rows begin.
template <int W> struct Stencil {
  const double *wx, *wy, *wz;
  long x, y[W], z[W];    // x: first column, may run over the end; y, z: wrapped; z < 0: not in this slab
};

struct Layout {
  long nx, row, plane;    // row length with padding, doubles per plane
};

/// field += weight products * (already scaled) wx.
template <int W, int D> void add(const Stencil<W> &s, const Layout &l, double *field)
{
  const bool inside = s.x + W <= l.nx;
  for (int k = 0; k < (D == 3 ? W : 1); ++k) {
    if (D == 3 && s.z[k] < 0) continue;
    for (int j = 0; j < W; ++j) {
      if (D == 2 && s.y[j] < 0) continue;
      const double c = D == 3 ? s.wz[k] * s.wy[j] : s.wy[j];
      double *row = field + (D == 3 ? s.z[k] * l.plane : 0) + s.y[j] * l.row;
      if (inside) {
        double *p = row + s.x;
        for (int i = 0; i < W; ++i) p[i] += c * s.wx[i];
      } else {
        for (int i = 0; i < W; ++i) row[s.x + i < l.nx ? s.x + i : s.x + i - l.nx] += c * s.wx[i];
      }
    }
  }
}

/// sum of weight products * field.
template <int W, int D> double gather(const Stencil<W> &s, const Layout &l, const double *field)
{
  double column[W] = {};
  const bool inside = s.x + W <= l.nx;
  for (int k = 0; k < (D == 3 ? W : 1); ++k) {
    if (D == 3 && s.z[k] < 0) continue;
    for (int j = 0; j < W; ++j) {
      if (D == 2 && s.y[j] < 0) continue;
      const double c = D == 3 ? s.wz[k] * s.wy[j] : s.wy[j];
      const double *row = field + (D == 3 ? s.z[k] * l.plane : 0) + s.y[j] * l.row;
      if (inside) {
        const double *p = row + s.x;
        for (int i = 0; i < W; ++i) column[i] += c * p[i];
      } else {
        for (int i = 0; i < W; ++i) column[i] += c * row[s.x + i < l.nx ? s.x + i : s.x + i - l.nx];
      }
    }
  }
  double total = 0.0;
  for (int i = 0; i < W; ++i) total += s.wx[i] * column[i];
  return total;
}

/// All weights of one particle, and from them the stencil of each component.
template <class Kernel, int D> struct Footprint {
  static constexpr int W = Kernel::width;
  AxisWeights<Kernel> axis[D];

  Footprint(const double *x, bool with_slope)
  {
    for (int d = 0; d < D; ++d) axis[d] = axis_weights<Kernel>(x[d], with_slope);
  }

  /// own: weights along axis c to use in place of the kernel's face weights.
  Stencil<W> stencil(int c, const double *own, const Grid &grid, const Slab &slab) const
  {
    Stencil<W> s;
    const double *w[3] = {nullptr, nullptr, nullptr};
    long first[3] = {0, 0, 0};
    for (int d = 0; d < D; ++d) {
      w[d] = d == c ? own : axis[d].centre;
      first[d] = d == c ? axis[d].first_face : axis[d].first_centre;
    }
    s.wx = w[0];
    s.wy = w[1];
    s.wz = w[2];
    s.x = wrap(first[0], grid.n[0]);
    for (int j = 0; j < W; ++j) {
      s.y[j] = wrap(first[1] + j, grid.n[1]);
      if (D == 2) s.y[j] = slab.contains(s.y[j]) ? s.y[j] - slab.start : -1;
      if (D == 3) {
        const long z = wrap(first[2] + j, grid.n[2]);
        s.z[j] = slab.contains(z) ? z - slab.start : -1;
      }
    }
    return s;
  }
};

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

  static Layout layout(const Grid &g) { return {g.n[0], 2 * g.half(), 2 * g.half() * (g.dim == 3 ? g.n[1] : 1)}; }
};

template <class Kernel, int D>
void HostSpreader::Impl::spread(const HostSpreader &me, const double *force, double drift_kT, const FieldView &field)
{
  constexpr int W = Kernel::width;
  const Layout l = layout(me.grid_);
  const double inv_volume = 1.0 / me.grid_.cell_volume();
  const bool drift = drift_kT != 0.0;
  for (std::size_t p = 0; p < me.original_.size(); ++p) {
    const Footprint<Kernel, D> print(me.x_.data() + 3 * p, drift);
    const double *F = force + 3L * me.original_[p];
    for (int c = 0; c < D; ++c) {
      // weight along the component's own axis: F phi + kT phi'/h
      double own[W];
      const double f = F[c] * inv_volume, t = drift_kT * inv_volume / me.grid_.h(c);
      for (int i = 0; i < W; ++i) own[i] = f * print.axis[c].face[i];
      if (drift)
        for (int i = 0; i < W; ++i) own[i] += t * print.axis[c].slope[i];
      add<W, D>(print.stencil(c, own, me.grid_, me.slab_), l, field[c]);
    }
  }
}

template <class Kernel, int D>
void HostSpreader::Impl::interpolate(const HostSpreader &me, const FieldView &field, double *velocity)
{
  constexpr int W = Kernel::width;
  const Layout l = layout(me.grid_);
  for (std::size_t p = 0; p < me.original_.size(); ++p) {
    const Footprint<Kernel, D> print(me.x_.data() + 3 * p, false);
    double *u = velocity + 3L * me.original_[p];
    u[2] = 0.0;
    for (int c = 0; c < D; ++c)
      u[c] = gather<W, D>(print.stencil(c, print.axis[c].face, me.grid_, me.slab_), l, field[c]);
  }
}

HostSpreader::HostSpreader(const Grid &grid, const Slab &slab, IbKernel kernel) :
    grid_(grid), slab_(slab), kernel_(kernel), width_(kernel_width(kernel))
{
}

long HostSpreader::first_plane(double x_slow) const
{
  const int d = grid_.slow_axis();
  // The first line of the centres; those of the faces begin there or one later, hence plane_reach.
  return static_cast<long>(std::floor((x_slow - grid_.lo[d]) / grid_.h(d) - 0.5 * (width_ - 1)));
}

/// Row of the grid in which the particle's cell lies, counted through the slab.
int HostSpreader::row_of(const double *x) const
{
  long cell[3] = {0, 0, 0};
  for (int d = 1; d < grid_.dim; ++d)
    cell[d] = wrap(static_cast<long>(std::floor((x[d] - grid_.lo[d]) / grid_.h(d))), grid_.n[d]);
  return static_cast<int>(grid_.dim == 3 ? cell[2] * grid_.n[1] + cell[1] : cell[1]);
}

void check_positions(const Grid &grid, const double *x, long n)
{
  for (long i = 0; i < n; ++i)
    for (int d = 0; d < grid.dim; ++d)
      if (!(std::fabs(x[3 * i + d] - grid.lo[d]) < 1e12 * grid.length[d]))
        throw BadParticle(i, "its position is not a finite number, or astronomically far away");
}

void HostSpreader::bind(const double *x, long n)
{
  // Counting sort by grid row.
  const long rows = grid_.dim == 3 ? grid_.n[1] * grid_.n[2] : grid_.n[1];
  x_.resize(static_cast<std::size_t>(3 * n));
  original_.resize(static_cast<std::size_t>(n));
  key_.resize(static_cast<std::size_t>(n));
  bin_.assign(static_cast<std::size_t>(rows) + 1, 0);
  for (long i = 0; i < n; ++i) {
    key_[i] = row_of(x + 3 * i);
    ++bin_[key_[i] + 1];
  }
  for (long r = 0; r < rows; ++r) bin_[r + 1] += bin_[r];
  for (long i = 0; i < n; ++i) {
    const int place = bin_[key_[i]]++;
    original_[place] = static_cast<int>(i);
    for (int d = 0; d < 3; ++d) x_[3 * place + d] = d < grid_.dim ? (x[3 * i + d] - grid_.lo[d]) / grid_.h(d) : 0.0;
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
  return x_.capacity() * sizeof(double) + (original_.capacity() + key_.capacity() + bin_.capacity()) * sizeof(int);
}

}    // namespace bdh
