#include "bdh_fft.h"

#include <algorithm>
#include <fftw3.h>

namespace bdh {

namespace {

struct PlanDeleter {
  void operator()(fftw_plan p) const { fftw_destroy_plan(p); }
};
using Plan = std::unique_ptr<std::remove_pointer<fftw_plan>::type, PlanDeleter>;

fftw_complex *as_complex(double *p) { return reinterpret_cast<fftw_complex *>(p); }

// A block of the slow-axis stage, all components: larger ones fall out of a 1 MiB second-level cache.
constexpr long block_bytes = 1 << 19;

/// Consecutive, equal but for the last parts of an axis.
Slab part_of(long n, int rank, int ranks)
{
  const long size = (n + ranks - 1) / ranks, start = std::min(n, rank * size);
  return {start, std::min(size, n - start)};
}

// Planes up to this many points are planned with FFTW_PATIENT: that takes 1 s at 64^2 and 2 s at 128^2, and the solve at
// 64^3 and 96^3 takes 13 % and 20 % less than with FFTW_MEASURE.  Larger ones would take 10 s and more.
constexpr long patient_points = 128 * 128;

unsigned planner_flag(const Grid &grid, FftEffort effort)
{
  if (effort == FftEffort::estimate) return FFTW_ESTIMATE;
  return grid.n[0] * grid.n[1] <= patient_points ? FFTW_PATIENT : FFTW_MEASURE;
}

}    // namespace

long next_fast_size(long n)
{
  for (long candidate = std::max(1L, n);; ++candidate) {
    long rest = candidate;
    for (long p : {2, 3, 5, 7})
      while (rest % p == 0) rest /= p;
    if (rest == 1) return candidate;
  }
}

/// Plans for `columns` transforms of the slow axis, from the field to the block's buffer and back.
struct SlowPlans {
  long columns = 0;
  Plan forward, backward;
};

struct VectorFft::Impl {
  Impl(const Grid &grid, const Comm &comm, FftEffort effort);

  void make_plans();
  SlowPlans make_slow_plans(long width);
  void transform_planes(double *field, bool forward);
  void hand_over(double *field);
  void hand_back(double *field);
  void slow_stage(const std::array<double *, 3> &field, const std::function<void(const ModeBlock &)> &change);
  void one_block(const std::array<double *, 3> &field, long outer, long first, const SlowPlans &plans,
                 const std::function<void(const ModeBlock &)> &change);

  Grid grid;
  Comm comm;
  unsigned effort;
  long n_slow;
  Slab slab;                     // of planes, before the hand-over

  // A plane is a row of `columns` tuples, and a rank has a part of them after the hand-over: in 3D rows of x's modes,
  // in 2D single modes.  A component is [planes of the slab][all columns] before, [all planes][my columns] after.
  long columns, tuple;
  Slab mine;
  std::size_t allocation;
  long outer, inner;             // after the hand-over a plane is outer x inner modes, inner along x
  long chunk;                    // modes along x per block

  Plan plane_forward, plane_backward;
  SlowPlans full, rest;
  AlignedVector block;           // modes of one block
  AlignedVector parcel;          // a component sorted by rank
  std::vector<int> slab_counts, slab_offsets, column_counts, column_offsets;    // complex numbers per rank
};

VectorFft::Impl::Impl(const Grid &g, const Comm &c, FftEffort e) :
    grid(g), comm(c), effort(planner_flag(g, e)), n_slow(g.n[g.slow_axis()]),
    slab(part_of(n_slow, c.rank(), c.size())), columns(g.dim == 3 ? g.n[1] : g.half()),
    tuple(g.dim == 3 ? g.half() : 1), mine(part_of(columns, c.rank(), c.size()))
{
  const long modes = tuple * std::max(slab.count * columns, n_slow * mine.count);
  // A rank without planes still needs a valid array.
  allocation = static_cast<std::size_t>(2 * std::max(1L, modes));
  outer = g.dim == 3 ? mine.count : 1;
  inner = g.dim == 3 ? tuple : mine.count;
  if (c.size() > 1) parcel.resize(static_cast<std::size_t>(2 * slab.count * columns * tuple));
  for (int r = 0; r < c.size(); ++r) {
    const Slab theirs = part_of(columns, r, c.size()), planes = part_of(n_slow, r, c.size());
    column_counts.push_back(static_cast<int>(slab.count * theirs.count * tuple));
    column_offsets.push_back(static_cast<int>(slab.count * theirs.start * tuple));
    slab_counts.push_back(static_cast<int>(planes.count * mine.count * tuple));
    slab_offsets.push_back(static_cast<int>(planes.start * mine.count * tuple));
  }
  make_plans();
}

SlowPlans VectorFft::Impl::make_slow_plans(long width)
{
  SlowPlans p;
  p.columns = width;
  if (width == 0 || outer == 0) return p;
  AlignedVector scratch(allocation);
  const int n = static_cast<int>(n_slow), many = static_cast<int>(width);
  const int from = static_cast<int>(outer * inner);
  fftw_complex *field = as_complex(scratch.data()), *modes = as_complex(block.data());
  p.forward.reset(
      fftw_plan_many_dft(1, &n, many, field, nullptr, from, 1, modes, nullptr, many, 1, FFTW_FORWARD, effort));
  p.backward.reset(
      fftw_plan_many_dft(1, &n, many, modes, nullptr, many, 1, field, nullptr, from, 1, FFTW_BACKWARD, effort));
  return p;
}

void VectorFft::Impl::make_plans()
{
  AlignedVector scratch(std::max(allocation, static_cast<std::size_t>(2 * columns * tuple)));
  double *real = scratch.data();
  fftw_complex *modes = as_complex(real);
  const int sizes[2] = {static_cast<int>(grid.n[1]), static_cast<int>(grid.n[0])};
  // Planes and blocks are executed at any multiple of 16 bytes, which is all the alignment that FFTW asks for.
  if (grid.dim == 3) {
    plane_forward.reset(fftw_plan_dft_r2c(2, sizes, real, modes, effort));
    plane_backward.reset(fftw_plan_dft_c2r(2, sizes, modes, real, effort));
  } else {
    plane_forward.reset(fftw_plan_dft_r2c(1, sizes + 1, real, modes, effort));
    plane_backward.reset(fftw_plan_dft_c2r(1, sizes + 1, modes, real, effort));
  }
  chunk = std::max(1L, std::min(inner, block_bytes / (16 * grid.dim * n_slow)));
  const long blocks = std::max(1L, (inner + chunk - 1) / chunk);
  chunk = std::max(1L, (inner + blocks - 1) / blocks);
  block.resize(static_cast<std::size_t>(2 * grid.dim * chunk * n_slow));
  full = make_slow_plans(chunk);
  rest = make_slow_plans(inner % chunk);
}

void VectorFft::Impl::transform_planes(double *field, bool forward)
{
  const long size = 2 * columns * tuple;
  for (long p = 0; p < slab.count; ++p) {
    double *plane = field + p * size;
    if (forward)
      fftw_execute_dft_r2c(plane_forward.get(), plane, as_complex(plane));
    else
      fftw_execute_dft_c2r(plane_backward.get(), as_complex(plane), plane);
  }
}

/// Not FFTW's transposition: the slow axis may keep its stride, so nothing needs to be rearranged within a rank.
void VectorFft::Impl::hand_over(double *field)
{
  if (comm.size() == 1) return;
  double *to = parcel.data();
  for (int r = 0; r < comm.size(); ++r) {
    const Slab theirs = part_of(columns, r, comm.size());
    for (long p = 0; p < slab.count; ++p)
      to = std::copy_n(field + 2 * tuple * (p * columns + theirs.start), 2 * tuple * theirs.count, to);
  }
  MPI_Alltoallv(parcel.data(), column_counts.data(), column_offsets.data(), MPI_C_DOUBLE_COMPLEX, field,
                slab_counts.data(), slab_offsets.data(), MPI_C_DOUBLE_COMPLEX, comm.handle());
}

void VectorFft::Impl::hand_back(double *field)
{
  if (comm.size() == 1) return;
  MPI_Alltoallv(field, slab_counts.data(), slab_offsets.data(), MPI_C_DOUBLE_COMPLEX, parcel.data(),
                column_counts.data(), column_offsets.data(), MPI_C_DOUBLE_COMPLEX, comm.handle());
  const double *from = parcel.data();
  for (int r = 0; r < comm.size(); ++r) {
    const Slab theirs = part_of(columns, r, comm.size());
    const long size = 2 * tuple * theirs.count;
    for (long p = 0; p < slab.count; ++p, from += size)
      std::copy_n(from, size, field + 2 * tuple * (p * columns + theirs.start));
  }
}

void VectorFft::Impl::one_block(const std::array<double *, 3> &field, long o, long first, const SlowPlans &plans,
                                const std::function<void(const ModeBlock &)> &change)
{
  const long offset = 2 * (o * inner + first), size = 2 * plans.columns * n_slow;
  ModeBlock modes{{nullptr, nullptr, nullptr}, n_slow, plans.columns, first, mine.start + o};
  if (grid.dim == 2) {
    modes.first_x = mine.start + first;
    modes.y = 0;
  }
  for (int d = 0; d < grid.dim; ++d) {
    modes.f[d] = block.data() + d * size;
    fftw_execute_dft(plans.forward.get(), as_complex(field[d] + offset), as_complex(modes.f[d]));
  }
  change(modes);
  for (int d = 0; d < grid.dim; ++d)
    fftw_execute_dft(plans.backward.get(), as_complex(modes.f[d]), as_complex(field[d] + offset));
}

void VectorFft::Impl::slow_stage(const std::array<double *, 3> &field,
                                 const std::function<void(const ModeBlock &)> &change)
{
  for (long o = 0; o < outer; ++o) {
    for (long first = 0; first + chunk <= inner; first += chunk) one_block(field, o, first, full, change);
    if (rest.columns) one_block(field, o, inner - rest.columns, rest, change);
  }
}

VectorFft::VectorFft(const Grid &grid, const Comm &comm, FftEffort effort) :
    impl_(std::make_unique<Impl>(grid, comm, effort))
{
}

VectorFft::~VectorFft() = default;

Slab VectorFft::slab() const { return impl_->slab; }

std::size_t VectorFft::allocation() const { return impl_->allocation; }

void VectorFft::solve(const std::array<double *, 3> &field, const std::function<void(const ModeBlock &)> &change)
{
  Impl &m = *impl_;
  for (int d = 0; d < m.grid.dim; ++d) {
    m.transform_planes(field[d], true);
    m.hand_over(field[d]);
  }
  m.slow_stage(field, change);
  for (int d = 0; d < m.grid.dim; ++d) {
    m.hand_back(field[d]);
    m.transform_planes(field[d], false);
  }
}

std::size_t VectorFft::memory() const { return (impl_->block.capacity() + impl_->parcel.capacity()) * sizeof(double); }

}    // namespace bdh
