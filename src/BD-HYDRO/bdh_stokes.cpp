#include "bdh_stokes.h"

#include <algorithm>
#include <cmath>

namespace bdh {

struct PeriodicStokes::Scales {
  double response, amplitude;
};

namespace {

constexpr long strip = 64;    // modes whose normals are drawn together; the buffers stay in the first-level cache

/// Normals of a strip of modes, already combined over the draws of the problem.  z[m]: real or imaginary part m.
struct StripNormals {
  alignas(64) double z[4][strip];
};

/// E|z|^2 = 1 per complex number: each part has variance 1/2.
void draw_strip(const StokesProblem &p, uint64_t first_index, long count, StripNormals &out)
{
  for (auto &part : out.z) std::fill_n(part, count, 0.0);
  for (const StressDraw &draw : p.stress) {
    const NoiseCounter counter{p.seed, Stream::fluid, p.step, draw.stage};
    const double weight = draw.weight * 0.70710678118654752440;
    // Two loops: g++ vectorises each, but not both as one.
    alignas(64) uint32_t w[4][strip];
    BDH_INDEPENDENT
    for (long i = 0; i < count; ++i) {
      const r123array4x32 r = random_words(counter, first_index + static_cast<uint64_t>(i));
      w[0][i] = r.v[0];
      w[1][i] = r.v[1];
      w[2][i] = r.v[2];
      w[3][i] = r.v[3];
    }
    BDH_INDEPENDENT
    for (long i = 0; i < count; ++i) {
      double z0, z1, z2, z3;
      normal_pair(w[0][i], w[1][i], z0, z1);
      normal_pair(w[2][i], w[3][i], z2, z3);
      out.z[0][i] += weight * z0;
      out.z[1][i] += weight * z1;
      out.z[2][i] += weight * z2;
      out.z[3][i] += weight * z3;
    }
  }
}

/// One mode in place; re, im: per component.
template <int D>
inline void solve_mode(const AxisSymbol *const *symbol, double response, double amplitude, const double *z, double *re,
                       double *im)
{
  for (int d = 0; d < D; ++d) to_corner(*symbol[d], re[d], im[d]);
  if (D == 3)
    corner_velocity_3d(symbol[0]->s, symbol[1]->s, symbol[2]->s, response, amplitude, z, re, im);
  else
    corner_velocity_2d(symbol[0]->s, symbol[1]->s, response, amplitude, z, re, im);
  for (int d = 0; d < D; ++d) to_face(*symbol[d], re[d], im[d]);
}

}    // namespace

PeriodicStokes::PeriodicStokes(const Grid &grid, const Comm &comm, FftEffort effort) :
    grid_(grid), fft_(grid, comm, effort)
{
  for (int d = 0; d < grid.dim; ++d)
    for (long i = 0; i < grid.n[d]; ++i) symbol_[d].push_back(axis_symbol(i, grid.n[d], grid.h(d)));
}

void PeriodicStokes::solve(const FieldView &field, const StokesProblem &problem)
{
  const double cells = static_cast<double>(grid_.cells());
  Scales scales;
  scales.response = 1.0 / (problem.viscosity * cells);
  scales.amplitude = std::sqrt(2.0 * problem.kT_over_dt / (problem.viscosity * grid_.cell_volume() * cells));
  fft_.solve(field, [&](const ModeBlock &block) { solve_block(block, problem, scales); });
}

void PeriodicStokes::solve_block(const ModeBlock &block, const StokesProblem &problem, const Scales &scales) const
{
  for (long row = 0; row < block.rows; ++row) {
    if (grid_.dim == 3)
      solve_row<3>(block, row, problem, scales);
    else
      solve_row<2>(block, row, problem, scales);
  }
}

/// Modes with 0 < k_x < n_x/2 stand for themselves and their conjugates; the two edge columns hold both and are apart.
template <int D>
void PeriodicStokes::solve_row(const ModeBlock &block, long row, const StokesProblem &problem, const Scales &scales) const
{
  const long begin = std::max(0L, 1 - block.first_x);
  const long end = std::min(block.columns, (grid_.n[0] + 1) / 2 - block.first_x);
  const AxisSymbol y = symbol_[1][D == 3 ? block.y : row], z = D == 3 ? symbol_[2][row] : AxisSymbol{};
  const AxisSymbol *x_symbols = symbol_[0].data() + block.first_x;
  const uint64_t row_index = static_cast<uint64_t>((D == 3 ? row * grid_.n[1] + block.y : row) * grid_.half());
  const bool noisy = scales.amplitude > 0.0 && !problem.stress.empty();

  StripNormals normals;
  if (!noisy)
    for (auto &part : normals.z) std::fill_n(part, strip, 0.0);
  for (long first = begin; first < end; first += strip) {
    const long count = std::min(strip, end - first);
    if (noisy) draw_strip(problem, row_index + static_cast<uint64_t>(block.first_x + first), count, normals);
    double *f[D];
    for (int d = 0; d < D; ++d) f[d] = block.f[d] + 2 * (row * block.columns + first);
    BDH_INDEPENDENT
    for (long i = 0; i < count; ++i) {
      const AxisSymbol x = x_symbols[first + i];
      const AxisSymbol *symbol[3] = {&x, &y, &z};
      const double n[4] = {normals.z[0][i], normals.z[1][i], normals.z[2][i], normals.z[3][i]};
      double re[D], im[D];
      for (int d = 0; d < D; ++d) {
        re[d] = f[d][2 * i];
        im[d] = f[d][2 * i + 1];
      }
      solve_mode<D>(symbol, scales.response, scales.amplitude, n, re, im);
      for (int d = 0; d < D; ++d) {
        f[d][2 * i] = re[d];
        f[d][2 * i + 1] = im[d];
      }
    }
  }
  for (long column = 0; column < block.columns; ++column)
    if (column < begin || column >= end) solve_edge<D>(block, row, column, problem, scales);
}

/// A mode with k_x = 0 or n_x/2.  Its conjugate is stored too: both take the draw of the one with the smaller row number,
/// and a mode that is its own conjugate is real.
template <int D>
void PeriodicStokes::solve_edge(const ModeBlock &block, long row, long column, const StokesProblem &problem,
                                const Scales &scales) const
{
  const long kx = block.first_x + column, ky = D == 3 ? block.y : row, kz = D == 3 ? row : 0;
  const long cy = ky ? grid_.n[1] - ky : 0, cz = kz ? grid_.n[2] - kz : 0;
  const long mine = kz * grid_.n[1] + ky, other = cz * grid_.n[1] + cy;
  const bool self = mine == other, conjugate = other < mine;

  double *f[D];
  double re[D], im[D];
  for (int d = 0; d < D; ++d) {
    f[d] = block.f[d] + 2 * (row * block.columns + column);
    re[d] = f[d][0];
    im[d] = f[d][1];
  }
  const AxisSymbol *symbol[3] = {&symbol_[0][kx], &symbol_[1][ky], D == 3 ? &symbol_[2][kz] : nullptr};
  double lambda = 0.0;
  for (int d = 0; d < D; ++d) lambda += symbol[d]->s * symbol[d]->s;
  if (lambda == 0.0) {    // k = 0: a mean pressure gradient balances the net force, and the mean velocity is 0
    for (int d = 0; d < D; ++d) f[d][0] = f[d][1] = 0.0;
    return;
  }
  const double no_normals[4] = {0.0, 0.0, 0.0, 0.0};
  solve_mode<D>(symbol, scales.response, 0.0, no_normals, re, im);

  if (scales.amplitude > 0.0 && !problem.stress.empty()) {
    StripNormals strip_normals;
    draw_strip(problem, static_cast<uint64_t>(std::min(mine, other) * grid_.half() + kx), 1, strip_normals);
    double z[4], nre[3] = {0.0, 0.0, 0.0}, nim[3] = {0.0, 0.0, 0.0};
    for (int m = 0; m < 4; ++m) z[m] = strip_normals.z[m][0];
    // Self-conjugate: g is real, every phase is that of a real number, and the whole variance is in the real part.
    const double root2 = 1.41421356237309504880;
    if (self) {
      z[0] *= root2;
      z[2] *= root2;
      z[1] = z[3] = 0.0;
    }
    // k_x is its own conjugate here, so only y and z change.
    const long drawn_k[3] = {kx, conjugate ? cy : ky, conjugate ? cz : kz};
    AxisSymbol drawn[3];
    const AxisSymbol *drawn_at[3];
    for (int d = 0; d < D; ++d) {
      drawn[d] = symbol_[d][drawn_k[d]];
      if (self) drawn[d] = {drawn[d].s, 1.0, 0.0};
      drawn_at[d] = &drawn[d];
    }
    solve_mode<D>(drawn_at, 0.0, scales.amplitude, z, nre, nim);
    for (int d = 0; d < D; ++d) {
      re[d] += nre[d];
      im[d] += conjugate ? -nim[d] : nim[d];
    }
  }
  for (int d = 0; d < D; ++d) {
    f[d][0] = re[d];
    f[d][1] = im[d];
  }
}

}    // namespace bdh
