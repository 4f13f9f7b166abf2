/// The fluctuating Stokes solvers of periodic boxes and of slits on a device.              [FIB sec. III B, eq. (28)-(30)]
#ifndef BDH_STOKES_KOKKOS_H
#define BDH_STOKES_KOKKOS_H

#include "bdh_any_stokes.h"
#include "bdh_device_kokkos.h"
#include "bdh_fft_kokkos.h"
#include "bdh_slit.h"

#include <cmath>
#include <stdexcept>
#include <vector>

namespace bdh {

/// Random stresses of a solve, as modes draw them.
struct DeviceDraws {
  static constexpr int most = 4;
  int count;
  double weight[most];
  NoiseCounter counter[most];
  const double *given;    ///< 4 numbers per mode in place of the generator's, already added up; or null

  /// z[0] .. z[3], E|z|^2 = 1 per complex number for weights whose squares add up to 1
  BDH_FN void get(uint64_t number, double *z) const
  {
    for (int m = 0; m < 4; ++m) z[m] = given ? given[4 * number + m] : 0.0;
    if (given) return;
    for (int i = 0; i < count; ++i) {
      double n[4];
      normal4(counter[i], number, n[0], n[1], n[2], n[3]);
      for (int m = 0; m < 4; ++m) z[m] += weight[i] * n[m];
    }
  }
};

/// One mode from force to velocity; index: its place in the padded arrays of complex numbers, which have no other modes.
template <int D> struct SolveMode {
  long n[3], half;
  double h[3];
  double *field[3];
  double response, amplitude;
  DeviceDraws draws;

  BDH_FN AxisSymbol symbol(int d, long k) const { return axis_symbol(k, n[d], h[d]); }

  BDH_FN void operator()(long index) const
  {
    const long k[3] = {index % half, index / half % n[1], index / (half * n[1])};
    AxisSymbol axis[3] = {symbol(0, k[0]), symbol(1, k[1]), symbol(2, k[2])};
    double re[3] = {}, im[3] = {}, z[4] = {};
    for (int d = 0; d < D; ++d) {
      re[d] = field[d][2 * index];
      im[d] = field[d][2 * index + 1];
    }
    const bool noisy = amplitude != 0.0, edge = noisy && is_edge_column(n, k[0]);
    if (noisy && !edge) draws.get(mode_number(n, k[0], k[1], k[2]), z);
    solve_mode<D>(axis, response, edge ? 0.0 : amplitude, z, re, im);
    if (edge) add_edge_noise(k, re, im);
    for (int d = 0; d < D; ++d) {
      field[d][2 * index] = re[d];
      field[d][2 * index + 1] = im[d];
    }
  }

  BDH_FN void add_edge_noise(const long *k, double *re, double *im) const
  {
    const DrawnMode draw = drawn_mode(n, k);
    AxisSymbol axis[3] = {symbol(0, draw.k[0]), symbol(1, draw.k[1]), symbol(2, draw.k[2])};
    double z[4], noise_re[3] = {}, noise_im[3] = {};
    draws.get(draw.number, z);
    prepare_draw(draw.role, axis, z);
    solve_mode<D>(axis, 0.0, amplitude, z, noise_re, noise_im);
    for (int d = 0; d < D; ++d) {
      re[d] += noise_re[d];
      im[d] += draw.role == DrawnMode::conjugate ? -noise_im[d] : noise_im[d];
    }
  }
};

/// One mode of a slit from force to velocity, by one thread; index: as for SolveMode, but of a plane.  Threads beyond the modes
/// have a direction of the mean mode each: apart from the others, whose warp would wait for them.  Lines lie in the field
/// itself; what the way down needs besides has the field's layout, so that neighbours read what lies side by side.
template <int D> struct SolveSlitMode {
  SlitChannel channel;
  double *field[3];
  double *l1, *inv_d, *transverse_inv_d;    // a real number for each mode and row
  double body_force[3];
  double *wall_force;                       // [lower, upper][component]
  DeviceDraws draws;

  static long threads(long modes) { return modes + D; }

  BDH_FN void operator()(long index) const
  {
    const long modes = channel.modes(), half = channel.n[0] / 2 + 1;
    if (index >= modes) return solve_mean(static_cast<int>(index - modes));
    if (index == 0) return;
    SlitModes<1> mode(channel, index / half);
    mode.set(channel, 0, index % half);
    Strip strip{*this, index, index % half, index / half};
    solve_slit_modes<D>(channel, mode, strip);
  }

  /// As solve_slit_modes() wants it, for one mode.
  struct Strip {
    const SolveSlitMode &s;
    long index, kx, ky;

    struct Complex {
      double *re, *im;
    };
    struct Normals {
      double z[4][1];
    };

    BDH_FN long at(long row) const { return row * s.channel.modes() + index; }
    BDH_FN Complex component(int d, long row) const { return {s.field[d] + 2 * at(row), s.field[d] + 2 * at(row) + 1}; }
    BDH_FN void load(long row, ComplexLanes<1> *u) const
    {
      for (int d = 0; d < D; ++d) {
        u[d].re[0] = *component(d, row).re;
        u[d].im[0] = *component(d, row).im;
      }
    }
    BDH_FN void store(long row, const ComplexLanes<1> *u) const
    {
      for (int d = 0; d < D; ++d) {
        *component(d, row).re = u[d].re[0];
        *component(d, row).im = u[d].im[0];
      }
    }
    BDH_FN Normals normals(long row) const { return s.normals(kx, ky, row); }
    BDH_FN Complex normal(long row) const { return component(D - 1, row); }
    BDH_FN Complex transverse(long row) const { return component(1, row); }
    BDH_FN double *l1(long row) const { return s.l1 + at(row); }
    BDH_FN double *inv_d(long row) const { return s.inv_d + at(row); }
    BDH_FN double *transverse_inv_d(long row) const { return s.transverse_inv_d + at(row); }
  };

  BDH_FN typename Strip::Normals normals(long kx, long ky, long row) const
  {
    double z[4];
    draws.get(slit_draw(channel, kx, ky) + static_cast<uint64_t>(row * channel.modes()), z);
    make_edge_real(channel, kx, ky, z[0], z[1], z[2], z[3]);
    return {{{z[0]}, {z[1]}, {z[2]}, {z[3]}}};
  }

  struct MeanNormals {
    const SolveSlitMode &s;
    int part;
    BDH_FN double operator()(long row) const { return s.normals(0, 0, row).z[part][0]; }
  };

  BDH_FN void solve_mean(int d) const
  {
    const long stride = 2 * channel.modes();
    double &lower = wall_force[d], &upper = wall_force[3 + d];
    if (d == D - 1)
      solve_mean_pressure(channel, body_force[d], field[d], stride, lower, upper);
    else
      solve_mean_flow(channel, body_force[d], MeanNormals{*this, 2 * d}, field[d], stride, lower, upper);
  }
};

/// As PeriodicStokes and SlitStokes; one process, pointers of the device.  Other boxes: std::invalid_argument.
template <class Exec> class DeviceStokes : public StokesSolver {
 public:
  DeviceStokes(const Grid &grid, const Comm &comm, FftEffort, const Workers & = Workers::one()) : grid_(grid), fft_(grid)
  {
    if (comm.size() > 1 || !can_solve(grid))
      throw std::invalid_argument("DeviceStokes: for periodic boxes and slits, and one process");
    if (!is_slit()) return;
    lines_.resize(static_cast<std::size_t>(grid.dim) * modes());
    wall_force_.resize(6);
    wall_force_.clear_values();
  }
  static bool can_solve(const Grid &grid)
  {
    return solver_kind(grid) == SolverKind::periodic || solver_kind(grid) == SolverKind::slit;
  }

  Slab slab() const override { return {0, grid_.n[grid_.slow_axis()]}; }
  std::size_t allocation() const override { return field_size(grid_); }
  std::size_t memory() const override { return fft_.memory() + lines_.capacity() * sizeof(double); }

  SolveReport solve(const FieldView &field, const StokesProblem &problem) override
  {
    for (int d = 0; d < grid_.dim; ++d) fft_.forward(field[d]);
    if (is_slit())
      grid_.dim == 3 ? solve_slit<3>(field, problem) : solve_slit<2>(field, problem);
    else
      grid_.dim == 3 ? solve_modes<3>(field, problem) : solve_modes<2>(field, problem);
    for (int d = 0; d < grid_.dim; ++d) fft_.backward(field[d]);
    return report();
  }

 private:
  bool is_slit() const { return grid_.walled_axes() > 0; }
  /// Complex numbers of a component.
  std::size_t modes() const { return field_size(grid_) / 2; }

  template <int D> void solve_modes(const FieldView &field, const StokesProblem &p)
  {
    const double cells = static_cast<double>(grid_.cells());
    SolveMode<D> s{};
    for (int d = 0; d < 3; ++d) {
      s.n[d] = grid_.n[d];
      s.h[d] = grid_.h(d);
      s.field[d] = field[d];
    }
    s.half = grid_.half();
    s.response = 1.0 / (p.viscosity * cells);
    if (p.noisy()) {
      s.amplitude = std::sqrt(2.0 * p.kT_over_dt / (p.viscosity * grid_.cell_volume() * cells));
      s.draws = draws(p);
    }
    device_for<Exec>("bdh::modes", static_cast<long>(modes()), s);
  }

  template <int D> void solve_slit(const FieldView &field, const StokesProblem &p)
  {
    SolveSlitMode<D> s{};
    s.channel = slit_channel(grid_, p);
    for (int d = 0; d < 3; ++d) {
      s.field[d] = field[d];
      s.body_force[d] = p.body_force[static_cast<std::size_t>(d)];
    }
    s.l1 = lines_.data();
    s.inv_d = s.l1 + modes();
    s.transverse_inv_d = D == 3 ? s.inv_d + modes() : nullptr;
    s.wall_force = wall_force_.data();
    if (p.noisy()) s.draws = draws(p);
    device_for<Exec>("bdh::slit", SolveSlitMode<D>::threads(s.channel.modes()), s);
  }

  /// Waits for the device; in a slit by copying six numbers, whether they are read or not.
  SolveReport report() const
  {
    SolveReport r;
    if (!is_slit()) {
      Exec().fence();
      return r;
    }
    double force[2][3];
    wall_force_.copy_to(force[0]);
    for (std::size_t side = 0; side < 2; ++side)
      for (std::size_t d = 0; d < 3; ++d) r.wall_force[static_cast<std::size_t>(grid_.slow_axis())][side][d] = force[side][d];
    return r;
  }

  DeviceDraws draws(const StokesProblem &p)
  {
    if (p.stress.size() > DeviceDraws::most) throw std::invalid_argument("DeviceStokes: more random stresses than any scheme has");
    const double half = 0.70710678118654752440;    // each part of a complex number has variance 1/2
    DeviceDraws draws{};
    for (const StressDraw &draw : p.stress) {
      draws.weight[draws.count] = half * draw.weight;
      draws.counter[draws.count++] = {p.seed, Stream::fluid, p.step, draw.stage};
    }
    if (!p.normals) return draws;
    std::vector<double> all(4 * modes(), 0.0);
    for (const StressDraw &draw : p.stress)
      for (std::size_t i = 0; i < all.size() / 4; ++i) {
        double z[4];
        p.normals->get(draw.stage, i, z);
        for (std::size_t m = 0; m < 4; ++m) all[4 * i + m] += half * draw.weight * z[m];
      }
    given_.assign(all.data(), all.size());
    draws.given = given_.data();
    return draws;
  }

  Grid grid_;
  DeviceFft<double, Exec> fft_;
  DeviceArray<double, Exec> given_;
  DeviceArray<double, Exec> lines_, wall_force_;    // of slits
};

}    // namespace bdh
#endif
