#include "bdh_slit.h"

#include "bdh_slit_kernel.h"
#include "bdh_stokes_noise.h"

#include <algorithm>
#include <cmath>

namespace bdh {

namespace {

constexpr long width = 16;    // modes solved together: their lines, some 20 numbers each, stay in the second-level cache

/// One number for each mode of a strip.
struct Lane {
  alignas(64) double v[width];
  double &operator[](long i) { return v[i]; }
  double operator[](long i) const { return v[i]; }
};

struct ComplexLane {
  Lane re, im;
};

/// A line of a strip for each row across the channel.
using Lines = std::vector<ComplexLane, AlignedAllocator<ComplexLane>>;
using RealLines = std::vector<Lane, AlignedAllocator<Lane>>;

/// What the modes of a strip are, and their normals.
struct StripModes {
  Lane nx, ny;                  // s_x/s, s_y/s
  AxisSymbol x[width], y;
  Lane s, sigma;                // s, s^2 h^2
  uint64_t first_draw[width];   // index of row 0 of the mode whose normals these are
};

}    // namespace

/// Buffers of one width, row by row.
struct SlitStokes::Work {
  Lines longitudinal, transverse, normal;
  RealLines inv_d, l1;
  std::vector<StripNormals, AlignedAllocator<StripNormals>> z;

  explicit Work(long rows)
  {
    const std::size_t n = static_cast<std::size_t>(rows);
    longitudinal.resize(n);
    transverse.resize(n);
    normal.resize(n + 1);
    inv_d.resize(n + 2);
    l1.resize(n + 2);
    z.resize(n);
  }
  std::size_t memory() const
  {
    return (longitudinal.size() + transverse.size() + normal.size()) * sizeof(ComplexLane) +
        (inv_d.size() + l1.size()) * sizeof(Lane) + z.size() * sizeof(StripNormals);
  }
};

/// The work on the modes of one solve.
struct SlitStokes::Modes {
  const Grid &grid;
  const StokesProblem &problem;
  double response, amplitude;    // of bdh_stokes_kernel.h, with the transforms along the walls only
  long n;                        // rows across the channel
  double h;                      // their spacing
  double lower, upper;           // wall_term() of the walls
  Work &work;
  WallVectors &wall_force;

  Modes(const Grid &g, const StokesProblem &p, Work &w, WallVectors &forces) :
      grid(g), problem(p), n(g.n[g.slow_axis()]), h(g.h(g.slow_axis())),
      lower(wall_term(g.boundary[g.slow_axis()][0] == Boundary::noslip)),
      upper(wall_term(g.boundary[g.slow_axis()][1] == Boundary::noslip)), work(w), wall_force(forces)
  {
    const double lines = points();
    response = 1.0 / (p.viscosity * lines);
    amplitude = std::sqrt(2.0 * p.kT_over_dt / (p.viscosity * g.cell_volume() * lines));
  }

  /// Grid points of a plane parallel to the walls.
  double points() const { return static_cast<double>(grid.cells()) / static_cast<double>(n); }
  double ends(long row, long first, long last) const { return (row == first ? lower : 0.0) + (row == last ? upper : 0.0); }
  bool noisy() const { return problem.noisy(); }

  template <int D> void solve_block(const ModeBlock<double> &block);
  template <int D> StripModes describe(const ModeBlock<double> &block, long first, long count) const;
  void draw(const StripModes &modes, const ModeBlock<double> &block, long first, long count);
  void make_edge_real(const ModeBlock<double> &block, long kx, long lane);
  template <int D> void load(const ModeBlock<double> &block, long first, long count, const StripModes &modes);
  template <int D> void store(const ModeBlock<double> &block, long first, long count, const StripModes &modes);
  void solve_transverse(const StripModes &modes);
  void solve_normal(const StripModes &modes);
  void project_forces(const StripModes &modes);
  void factor_and_eliminate(const StripModes &modes);
  void substitute_back(const StripModes &modes);
  template <int D> void solve_mean(const std::vector<double> &force, const ModeBlock<double> &block);
  std::vector<double> mean_velocity(const std::vector<double> &f, double scale, int normals) const;
  void report_mean(const std::vector<double> &u, int component);
  void report_pressure(const std::vector<double> &f);
};

/// Symbols of a strip.  The mode k = 0 gets those of some other one: solve_mean() replaces its result.
template <int D> StripModes SlitStokes::Modes::describe(const ModeBlock<double> &block, long first, long count) const
{
  StripModes m{};
  m.y = D == 3 ? axis_symbol(block.y, grid.n[1], grid.h(1)) : AxisSymbol{0.0, 1.0, 0.0};
  for (long i = 0; i < width; ++i) {
    const long kx = block.first_x + first + std::min(i, count - 1);
    m.x[i] = axis_symbol(kx, grid.n[0], grid.h(0));
    const double s2 = m.x[i].s * m.x[i].s + m.y.s * m.y.s;
    m.s[i] = s2 > 0.0 ? std::sqrt(s2) : 1.0 / h;
    m.nx[i] = s2 > 0.0 ? m.x[i].s / m.s[i] : 1.0;
    m.ny[i] = m.y.s / m.s[i];
    m.sigma[i] = m.s[i] * m.s[i] * h * h;
    const bool edge = kx == 0 || 2 * kx == grid.n[0];
    const long ky = D == 3 && edge ? std::min(block.y, (grid.n[1] - block.y) % grid.n[1]) : block.y;
    m.first_draw[i] = static_cast<uint64_t>(ky * grid.half() + kx);
  }
  return m;
}

/// Normals of all rows: z[0], z[1] of the normal velocity, z[2], z[3] of the transverse one.
void SlitStokes::Modes::draw(const StripModes &modes, const ModeBlock<double> &block, long first, long count)
{
  const uint64_t plane = static_cast<uint64_t>(grid.half() * (grid.dim == 3 ? grid.n[1] : 1));
  for (long row = 0; row < n; ++row)
    draw_strip(
        problem, [&](long i) { return modes.first_draw[i] + static_cast<uint64_t>(row) * plane; }, width,
        work.z[static_cast<std::size_t>(row)]);
  for (long i = 0; i < count; ++i) {
    const long kx = block.first_x + first + i;
    if (kx == 0 || 2 * kx == grid.n[0]) make_edge_real(block, kx, i);
  }
}

/// Where a mode's conjugate is stored too, both take the draw of the one with the smaller index, and a mode that is its
/// own conjugate is real: its whole variance is in one part.  With the phases of bdh_stokes_kernel.h, at theta = pi
/// e^{-i theta/2} = -i = its own conjugate's negative, hence the signs of the transverse part.
void SlitStokes::Modes::make_edge_real(const ModeBlock<double> &block, long kx, long lane)
{
  const long ny = grid.dim == 3 ? grid.n[1] : 1, ky = block.y, minus = (ny - ky) % ny;
  const bool real = ky == minus, conjugate = ky > minus;
  const bool half_x = kx != 0, half_y = real && ky != 0;
  const double root2 = 1.41421356237309504880;
  for (StripNormals &normals : work.z) {
    double *z[4] = {normals.z[0] + lane, normals.z[1] + lane, normals.z[2] + lane, normals.z[3] + lane};
    if (real) {
      const double t = root2 * *z[2];
      *z[0] *= root2;
      *z[1] = 0.0;
      *z[2] = half_x && half_y ? 0.0 : t;
      *z[3] = half_x && half_y ? t : 0.0;
    } else if (conjugate) {
      *z[1] = -*z[1];
      *z[half_x ? 2 : 3] *= -1.0;
    }
  }
}

/// From velocity components on their faces to longitudinal, transverse and normal parts.
template <int D>
void SlitStokes::Modes::load(const ModeBlock<double> &block, long first, long count, const StripModes &modes)
{
  for (long row = 0; row < n; ++row) {
    const long offset = 2 * (row * block.columns + first);
    const std::size_t j = static_cast<std::size_t>(row);
    ComplexLane &l = work.longitudinal[j], &t = work.transverse[j], &w = work.normal[j];
    for (long i = 0; i < count; ++i) {
      double xr = block.f[0][offset + 2 * i], xi = block.f[0][offset + 2 * i + 1], yr = 0.0, yi = 0.0;
      to_corner(modes.x[i], xr, xi);
      if (D == 3) {
        yr = block.f[1][offset + 2 * i];
        yi = block.f[1][offset + 2 * i + 1];
        to_corner(modes.y, yr, yi);
      }
      l.re[i] = modes.nx[i] * xr + modes.ny[i] * yr;
      l.im[i] = modes.nx[i] * xi + modes.ny[i] * yi;
      t.re[i] = modes.nx[i] * yr - modes.ny[i] * xr;
      t.im[i] = modes.nx[i] * yi - modes.ny[i] * xi;
      w.re[i] = block.f[D - 1][offset + 2 * i];
      w.im[i] = block.f[D - 1][offset + 2 * i + 1];
    }
    for (long i = count; i < width; ++i)
      l.re[i] = l.im[i] = t.re[i] = t.im[i] = w.re[i] = w.im[i] = 0.0;
  }
}

template <int D>
void SlitStokes::Modes::store(const ModeBlock<double> &block, long first, long count, const StripModes &modes)
{
  for (long row = 0; row < n; ++row) {
    const long offset = 2 * (row * block.columns + first);
    const std::size_t j = static_cast<std::size_t>(row);
    const ComplexLane &l = work.longitudinal[j], &t = work.transverse[j], &w = work.normal[j];
    for (long i = 0; i < count; ++i) {
      double xr = modes.nx[i] * l.re[i] - modes.ny[i] * t.re[i], xi = modes.nx[i] * l.im[i] - modes.ny[i] * t.im[i];
      double yr = modes.ny[i] * l.re[i] + modes.nx[i] * t.re[i], yi = modes.ny[i] * l.im[i] + modes.nx[i] * t.im[i];
      to_face(modes.x[i], xr, xi);
      block.f[0][offset + 2 * i] = xr;
      block.f[0][offset + 2 * i + 1] = xi;
      if (D == 3) {
        to_face(modes.y, yr, yi);
        block.f[1][offset + 2 * i] = yr;
        block.f[1][offset + 2 * i + 1] = yi;
      }
      block.f[D - 1][offset + 2 * i] = w.re[i];
      block.f[D - 1][offset + 2 * i + 1] = w.im[i];
    }
  }
}

/// h^2 (-L) = R^T R;  u_t := response h^2 R^-1 R^-T f_t + amplitude h R^-1 z.
void SlitStokes::Modes::solve_transverse(const StripModes &modes)
{
  const double force = response * h * h, noise = noisy() ? amplitude * h : 0.0;
  Lane before{};
  ComplexLane y{};
  for (long row = 0; row < n; ++row) {
    const std::size_t j = static_cast<std::size_t>(row);
    const double end = ends(row, 0, n - 1);
    ComplexLane &t = work.transverse[j];
    Lane &inv_d = work.inv_d[j];
    BDH_INDEPENDENT
    for (long i = 0; i < width; ++i) {
      y.re[i] = force * t.re[i] + before[i] * y.re[i];
      y.im[i] = force * t.im[i] + before[i] * y.im[i];
      const double d = next_tridiagonal(modes.sigma[i], end, before[i]), root = noise * std::sqrt(d);
      inv_d[i] = before[i] = d;
      t.re[i] = y.re[i] * d + root * work.z[j].z[2][i];
      t.im[i] = y.im[i] * d + root * work.z[j].z[3][i];
    }
  }
  for (long row = n - 2; row >= 0; --row) {
    const std::size_t j = static_cast<std::size_t>(row);
    ComplexLane &t = work.transverse[j];
    const ComplexLane &above = work.transverse[j + 1];
    BDH_INDEPENDENT
    for (long i = 0; i < width; ++i) {
      t.re[i] += work.inv_d[j][i] * above.re[i];
      t.im[i] += work.inv_d[j][i] * above.im[i];
    }
  }
}

/// normal := Z* f on the inner faces.
void SlitStokes::Modes::project_forces(const StripModes &modes)
{
  for (long row = 1; row < n; ++row) {
    const std::size_t j = static_cast<std::size_t>(row);
    const ComplexLane &below = work.longitudinal[j - 1], &above = work.longitudinal[j];
    ComplexLane &w = work.normal[j];
    BDH_INDEPENDENT
    for (long i = 0; i < width; ++i) {
      const double inv_hs = 1.0 / (h * modes.s[i]);
      w.re[i] += inv_hs * (below.im[i] - above.im[i]);
      w.im[i] -= inv_hs * (below.re[i] - above.re[i]);
    }
  }
}

/// normal := D^-1 L^-1 g response s^2 h^4 + D^-1/2 z amplitude s h^2, with P = L D L^T.
void SlitStokes::Modes::factor_and_eliminate(const StripModes &modes)
{
  const double h2 = h * h, noise = noisy() ? amplitude * h2 : 0.0;
  ComplexLane y1{}, y2{};          // of the row before, and before that
  Lane d1{}, d2{}, l1{};
  for (long row = 1; row < n; ++row) {
    const std::size_t j = static_cast<std::size_t>(row);
    const double end = ends(row, 1, n - 1);
    ComplexLane &w = work.normal[j];
    BDH_INDEPENDENT
    for (long i = 0; i < width; ++i) {
      const PentadiagonalRow p = next_pentadiagonal(modes.sigma[i], end, {l1[i], d1[i]}, {0.0, d2[i]});
      const double s = modes.s[i], scale = response * s * s * h2 * h2, root = noise * s * std::sqrt(p.inv_d);
      const double re = scale * w.re[i] - p.l1 * y1.re[i] - d2[i] * y2.re[i];
      const double im = scale * w.im[i] - p.l1 * y1.im[i] - d2[i] * y2.im[i];
      y2.re[i] = y1.re[i];
      y2.im[i] = y1.im[i];
      y1.re[i] = re;
      y1.im[i] = im;
      w.re[i] = re * p.inv_d + root * work.z[j].z[0][i];
      w.im[i] = im * p.inv_d + root * work.z[j].z[1][i];
      work.l1[j][i] = l1[i] = p.l1;
      work.inv_d[j][i] = p.inv_d;
      d2[i] = d1[i];
      d1[i] = p.inv_d;
    }
  }
}

/// normal := L^-T normal; longitudinal := that of Z w.
void SlitStokes::Modes::substitute_back(const StripModes &modes)
{
  ComplexLane w1{}, w2{};          // of the row after, and after that
  Lane l1{}, l2{};                 // L's entries in their columns
  work.normal[static_cast<std::size_t>(n)] = ComplexLane{};
  for (long row = n - 1; row >= 0; --row) {
    const std::size_t j = static_cast<std::size_t>(row);
    ComplexLane &w = work.normal[j], &u = work.longitudinal[j];
    if (row == 0) w = ComplexLane{};
    BDH_INDEPENDENT
    for (long i = 0; i < width; ++i) {
      const double re = row == 0 ? 0.0 : w.re[i] - l1[i] * w1.re[i] - l2[i] * w2.re[i];
      const double im = row == 0 ? 0.0 : w.im[i] - l1[i] * w1.im[i] - l2[i] * w2.im[i];
      const double inv_hs = 1.0 / (h * modes.s[i]);
      u.re[i] = -inv_hs * (w1.im[i] - im);
      u.im[i] = inv_hs * (w1.re[i] - re);
      w2.re[i] = w1.re[i];
      w2.im[i] = w1.im[i];
      w.re[i] = w1.re[i] = re;
      w.im[i] = w1.im[i] = im;
      l1[i] = work.l1[j][i];
      l2[i] = row >= 2 ? work.inv_d[j - 1][i] : 0.0;
    }
  }
}

void SlitStokes::Modes::solve_normal(const StripModes &modes)
{
  project_forces(modes);
  factor_and_eliminate(modes);
  substitute_back(modes);
}

/// Velocity of the mean mode along one direction from its force, or, with `normals` >= 0, from those normals.
/// Between two free-slip walls the matrix has the null vector 1: it is made regular in the first row, and the mean is
/// taken off before and after, which leaves the pseudo-inverse.
std::vector<double> SlitStokes::Modes::mean_velocity(const std::vector<double> &f, double scale, int normals) const
{
  const bool singular = lower < 0.0 && upper < 0.0;
  const auto take_off_mean = [this, singular](std::vector<double> &v) {
    double sum = 0.0;
    for (double a : v) sum += a;
    if (singular)
      for (double &a : v) a -= sum / static_cast<double>(n);
  };
  std::vector<double> u(f), inv_d(f.size());
  take_off_mean(u);
  double before = 0.0;
  for (long row = 0; row < n; ++row) {
    const std::size_t j = static_cast<std::size_t>(row);
    const double y = (row ? u[j - 1] : 0.0) + scale * u[j];
    before = inv_d[j] = next_tridiagonal(0.0, ends(row, 0, n - 1) + (singular && row == 0 ? 1.0 : 0.0), before);
    u[j] = y * inv_d[j];
  }
  if (normals >= 0)
    for (std::size_t j = 0; j < u.size(); ++j) u[j] = scale * std::sqrt(inv_d[j]) * work.z[j].z[normals][0];
  for (long row = n - 2; row >= 0; --row) {
    const std::size_t j = static_cast<std::size_t>(row);
    u[j] += inv_d[j] * u[j + 1];
  }
  take_off_mean(u);
  return u;
}

/// Viscous stress of the mean flow on the walls: between the wall and the first line lies h/2.
void SlitStokes::Modes::report_mean(const std::vector<double> &u, int component)
{
  const double area = points() * grid.cell_volume() / h, factor = 2.0 * problem.viscosity / h * area;
  const int axis = grid.slow_axis();
  if (lower > 0.0) wall_force[axis][0][component] = factor * u.front();
  if (upper > 0.0) wall_force[axis][1][component] = factor * u.back();
}

/// Pressure on the walls, whose mean over the channel is taken as 0.  f: mean normal force density per face.
void SlitStokes::Modes::report_pressure(const std::vector<double> &f)
{
  const double area = points() * grid.cell_volume() / h;
  const int axis = grid.slow_axis();
  double rise = 0.0, mean = 0.0;
  for (long row = 1; row < n; ++row) {
    rise += h * f[static_cast<std::size_t>(row)];
    mean += rise / static_cast<double>(n);
  }
  wall_force[axis][0][axis] = mean * area;
  wall_force[axis][1][axis] = (rise - mean) * area;
}

/// k = 0: no normal flow, no pressure gradient along the walls.  force: row by row, all components, of column 0 of the
/// block, which gets the velocity.
template <int D> void SlitStokes::Modes::solve_mean(const std::vector<double> &force, const ModeBlock<double> &block)
{
  for (int d = 0; d < D; ++d) {
    std::vector<double> f(static_cast<std::size_t>(n));
    for (long row = 0; row < n; ++row)
      f[static_cast<std::size_t>(row)] =
          force[static_cast<std::size_t>(D * row + d)] + points() * problem.body_force[static_cast<std::size_t>(d)];
    std::vector<double> u(f.size(), 0.0);
    if (d < D - 1) {
      u = mean_velocity(f, response * h * h, -1);
      report_mean(u, d);
      if (noisy()) {
        const std::vector<double> noise = mean_velocity(f, amplitude * h, 2 * d);
        for (std::size_t j = 0; j < u.size(); ++j) u[j] += noise[j];
      }
    } else {
      for (double &a : f) a /= points();
      report_pressure(f);
    }
    for (long row = 0; row < n; ++row) {
      block.f[d][2 * row * block.columns] = u[static_cast<std::size_t>(row)];
      block.f[d][2 * row * block.columns + 1] = 0.0;
    }
  }
}

template <int D> void SlitStokes::Modes::solve_block(const ModeBlock<double> &block)
{
  for (long first = 0; first < block.columns; first += width) {
    const long count = std::min(width, block.columns - first);
    const bool mean = block.first_x + first == 0 && block.y == 0;
    std::vector<double> mean_force;
    if (mean)
      for (long row = 0; row < n; ++row)
        for (int d = 0; d < D; ++d) mean_force.push_back(block.f[d][2 * row * block.columns]);
    const StripModes modes = describe<D>(block, first, count);
    if (noisy()) draw(modes, block, first, count);
    load<D>(block, first, count, modes);
    if (D == 3) solve_transverse(modes);
    solve_normal(modes);
    store<D>(block, first, count, modes);
    if (mean) solve_mean<D>(mean_force, block);
  }
}

SlitStokes::SlitStokes(const Grid &grid, const Comm &comm, FftEffort effort, const Workers &workers) :
    grid_(grid), fft_(grid, comm, effort, workers)
{
  for (int w = 0; w < workers.count(); ++w) idle_.push_back(std::make_unique<Work>(grid.n[grid.slow_axis()]));
}

SlitStokes::~SlitStokes() = default;

/// There are as many as workers.
std::unique_ptr<SlitStokes::Work> SlitStokes::take_buffers()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  std::unique_ptr<Work> work = std::move(idle_.back());
  idle_.pop_back();
  return work;
}

void SlitStokes::give_back(std::unique_ptr<Work> work)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  idle_.push_back(std::move(work));
}

SolveReport SlitStokes::solve(const FieldView &field, const StokesProblem &problem)
{
  SolveReport report;
  fft_.solve(field, [&](const ModeBlock<double> &block) {
    std::unique_ptr<Work> work = take_buffers();
    Modes modes(grid_, problem, *work, report.wall_force);    // the block of the mean mode alone writes the forces
    grid_.dim == 3 ? modes.solve_block<3>(block) : modes.solve_block<2>(block);
    give_back(std::move(work));
  });
  return report;
}

std::size_t SlitStokes::memory() const
{
  std::size_t bytes = fft_.memory();
  for (const auto &work : idle_) bytes += work->memory();
  return bytes;
}

}    // namespace bdh
