#include "bdh_fft.h"

#include <algorithm>
#include <fftw3-mpi.h>
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

/// fftw_mpi_init once a process; FFTW wants it before the first plan, and never again after cleanup.
void start_fftw_mpi()
{
  static const bool started = [] {
    fftw_mpi_init();
    return true;
  }();
  (void) started;
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

  void decompose();
  void make_plans();
  SlowPlans make_slow_plans(long columns);
  void transform_planes(double *field, bool forward);
  void slow_stage(const std::array<double *, 3> &field, const std::function<void(const ModeBlock &)> &change);
  void one_block(const std::array<double *, 3> &field, long outer, long first, const SlowPlans &plans,
                 const std::function<void(const ModeBlock &)> &change);

  Grid grid;
  Comm comm;
  unsigned effort;
  long n_slow, plane_rows;       // rows of x in one plane of the slow axis
  Slab slab;                     // of planes, before the hand-over
  std::size_t allocation;

  // After the hand-over: `outer` groups of `inner` columns; mode (s, o, i) lies at s * stride + o * inner + i.
  long outer, first_outer, inner, stride, outer_step;
  long chunk;                    // columns per block

  Plan plane_forward, plane_backward, transpose_out, transpose_back;
  SlowPlans full, rest;
  AlignedVector buffer;
};

VectorFft::Impl::Impl(const Grid &g, const Comm &c, FftEffort e) :
    grid(g), comm(c), effort(e == FftEffort::measure ? FFTW_MEASURE : FFTW_ESTIMATE), n_slow(g.n[g.slow_axis()]),
    plane_rows(g.dim == 3 ? g.n[1] : 1)
{
  start_fftw_mpi();
  decompose();
  make_plans();
}

/// Slabs of the slow axis before, of the next distributable axis after the hand-over: y in 3D, x's modes in 2D.
void VectorFft::Impl::decompose()
{
  const long half = grid.half();
  if (comm.size() == 1) {
    slab = {0, n_slow};
    allocation = static_cast<std::size_t>(2 * half * plane_rows * n_slow);
    outer = plane_rows;
    first_outer = 0;
    inner = half;
    stride = half * plane_rows;
    outer_step = half;
    return;
  }
  const long columns = grid.dim == 3 ? plane_rows : half;
  const long tuple = grid.dim == 3 ? 2 * half : 2;
  const ptrdiff_t sizes[2] = {n_slow, columns};
  ptrdiff_t count0, start0, count1, start1;
  allocation = static_cast<std::size_t>(fftw_mpi_local_size_many_transposed(
      2, sizes, tuple, FFTW_MPI_DEFAULT_BLOCK, FFTW_MPI_DEFAULT_BLOCK, comm.handle(), &count0, &start0, &count1, &start1));
  // A rank without planes still takes part in every collective call and needs a valid array.
  allocation = std::max<std::size_t>(allocation, 16);
  slab = {start0, count0};
  outer = count1;
  first_outer = start1;
  inner = tuple / 2;
  stride = inner;
  outer_step = inner * n_slow;
}

SlowPlans VectorFft::Impl::make_slow_plans(long columns)
{
  SlowPlans p;
  p.columns = columns;
  if (columns == 0 || outer == 0) return p;
  AlignedVector scratch(allocation);
  const int n = static_cast<int>(n_slow), many = static_cast<int>(columns);
  const int from = static_cast<int>(stride);
  fftw_complex *field = as_complex(scratch.data()), *block = as_complex(buffer.data());
  p.forward.reset(
      fftw_plan_many_dft(1, &n, many, field, nullptr, from, 1, block, nullptr, many, 1, FFTW_FORWARD, effort));
  p.backward.reset(
      fftw_plan_many_dft(1, &n, many, block, nullptr, many, 1, field, nullptr, from, 1, FFTW_BACKWARD, effort));
  return p;
}

void VectorFft::Impl::make_plans()
{
  const long half = grid.half();
  AlignedVector scratch(std::max(allocation, static_cast<std::size_t>(2 * half * plane_rows)));
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
  const long blocks = (inner + chunk - 1) / chunk;
  chunk = (inner + blocks - 1) / blocks;
  buffer.resize(static_cast<std::size_t>(2 * grid.dim * chunk * n_slow));
  full = make_slow_plans(chunk);
  rest = make_slow_plans(inner % chunk);
  if (comm.size() == 1) return;
  const long columns = grid.dim == 3 ? plane_rows : half;
  transpose_out.reset(fftw_mpi_plan_many_transpose(n_slow, columns, 2 * inner, FFTW_MPI_DEFAULT_BLOCK,
                                                   FFTW_MPI_DEFAULT_BLOCK, real, real, comm.handle(), effort));
  transpose_back.reset(fftw_mpi_plan_many_transpose(columns, n_slow, 2 * inner, FFTW_MPI_DEFAULT_BLOCK,
                                                    FFTW_MPI_DEFAULT_BLOCK, real, real, comm.handle(), effort));
}

void VectorFft::Impl::transform_planes(double *field, bool forward)
{
  const long size = 2 * grid.half() * plane_rows;
  for (long p = 0; p < slab.count; ++p) {
    double *plane = field + p * size;
    if (forward)
      fftw_execute_dft_r2c(plane_forward.get(), plane, as_complex(plane));
    else
      fftw_execute_dft_c2r(plane_backward.get(), as_complex(plane), plane);
  }
}

void VectorFft::Impl::one_block(const std::array<double *, 3> &field, long o, long first, const SlowPlans &plans,
                                const std::function<void(const ModeBlock &)> &change)
{
  const long offset = 2 * (o * outer_step + first), block_size = 2 * plans.columns * n_slow;
  ModeBlock block{{nullptr, nullptr, nullptr}, n_slow, plans.columns, first, first_outer + o};
  if (grid.dim == 2) {
    block.first_x = comm.size() == 1 ? first : first_outer + o;
    block.y = 0;
  }
  for (int d = 0; d < grid.dim; ++d) {
    block.f[d] = buffer.data() + d * block_size;
    fftw_execute_dft(plans.forward.get(), as_complex(field[d] + offset), as_complex(block.f[d]));
  }
  change(block);
  for (int d = 0; d < grid.dim; ++d)
    fftw_execute_dft(plans.backward.get(), as_complex(block.f[d]), as_complex(field[d] + offset));
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
    if (m.transpose_out) fftw_mpi_execute_r2r(m.transpose_out.get(), field[d], field[d]);
  }
  m.slow_stage(field, change);
  for (int d = 0; d < m.grid.dim; ++d) {
    if (m.transpose_back) fftw_mpi_execute_r2r(m.transpose_back.get(), field[d], field[d]);
    m.transform_planes(field[d], false);
  }
}

std::size_t VectorFft::memory() const { return impl_->buffer.capacity() * sizeof(double); }

}    // namespace bdh
