// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "grid/fft.h"

#include "base/phases.h"
#include "base/ssize.h"

#include <algorithm>
#include <fftw3.h>
#include <numeric>
#include <stdexcept>

namespace bdh {

namespace {

/// FFTW's names in each precision.
template <class Real> struct Fftw;

template <> struct Fftw<double> {
  using Complex = fftw_complex;
  using PlanPointer = fftw_plan;
  static constexpr auto many_dft = fftw_plan_many_dft;
  static constexpr auto many_r2c = fftw_plan_many_dft_r2c;
  static constexpr auto many_c2r = fftw_plan_many_dft_c2r;
  static constexpr auto execute = fftw_execute_dft;
  static constexpr auto execute_r2c = fftw_execute_dft_r2c;
  static constexpr auto execute_c2r = fftw_execute_dft_c2r;
  static constexpr auto destroy = fftw_destroy_plan;
  static MPI_Datatype mpi_complex() { return MPI_C_DOUBLE_COMPLEX; }
};

template <> struct Fftw<float> {
  using Complex = fftwf_complex;
  using PlanPointer = fftwf_plan;
  static constexpr auto many_dft = fftwf_plan_many_dft;
  static constexpr auto many_r2c = fftwf_plan_many_dft_r2c;
  static constexpr auto many_c2r = fftwf_plan_many_dft_c2r;
  static constexpr auto execute = fftwf_execute_dft;
  static constexpr auto execute_r2c = fftwf_execute_dft_r2c;
  static constexpr auto execute_c2r = fftwf_execute_dft_c2r;
  static constexpr auto destroy = fftwf_destroy_plan;
  static MPI_Datatype mpi_complex() { return MPI_C_FLOAT_COMPLEX; }
};

template <class Real> struct PlanDeleter {
  void operator()(typename Fftw<Real>::PlanPointer p) const { Fftw<Real>::destroy(p); }
};
template <class Real> using Plan =
    std::unique_ptr<typename std::remove_pointer<typename Fftw<Real>::PlanPointer>::type,
                    PlanDeleter<Real>>;

template <class Real> typename Fftw<Real>::Complex *as_complex(Real *p)
{
  return reinterpret_cast<typename Fftw<Real>::Complex *>(p);
}

template <class Real> struct PlanPair {
  Plan<Real> forward, backward;
};

/// `many` transforms of length n whose neighbours lie side by side, in place; `stride` complex
/// numbers between points.
template <class Real>
PlanPair<Real> strided_plans(long length, long many, long stride, Real *array, unsigned flags)
{
  using F = Fftw<Real>;
  const int n = static_cast<int>(length), m = static_cast<int>(many), s = static_cast<int>(stride);
  auto *a = as_complex(array);
  PlanPair<Real> p;
  p.forward.reset(F::many_dft(1, &n, m, a, nullptr, s, 1, a, nullptr, s, 1, FFTW_FORWARD, flags));
  p.backward.reset(F::many_dft(1, &n, m, a, nullptr, s, 1, a, nullptr, s, 1, FFTW_BACKWARD, flags));
  return p;
}

/// `many` transforms of the slow axis, from the field (`pitch` between points) to a dense block and
/// back.
template <class Real> PlanPair<Real> block_plans(long length, long many, long pitch, Real *field,
                                                 Real *block, unsigned flags)
{
  using F = Fftw<Real>;
  const int n = static_cast<int>(length), m = static_cast<int>(many), s = static_cast<int>(pitch);
  auto *f = as_complex(field), *b = as_complex(block);
  PlanPair<Real> p;
  if (many == 0) return p;
  p.forward.reset(F::many_dft(1, &n, m, f, nullptr, s, 1, b, nullptr, m, 1, FFTW_FORWARD, flags));
  p.backward.reset(F::many_dft(1, &n, m, b, nullptr, m, 1, f, nullptr, s, 1, FFTW_BACKWARD, flags));
  return p;
}

/// `many` real transforms of `rank` axes (n: slowest first), in place in padded rows, `distance`
/// complex numbers apart.
template <class Real> PlanPair<Real> real_plans(int rank, const int *n, long many, long distance,
                                                Real *array, unsigned flags)
{
  using F = Fftw<Real>;
  const int m = static_cast<int>(many), d = static_cast<int>(distance);
  auto *a = as_complex(array);
  PlanPair<Real> p;
  p.forward.reset(F::many_r2c(rank, n, m, array, nullptr, 1, 2 * d, a, nullptr, 1, d, flags));
  p.backward.reset(F::many_c2r(rank, n, m, a, nullptr, 1, d, array, nullptr, 1, 2 * d, flags));
  return p;
}

// A block of the slow-axis stage, all components: larger ones fall out of a 1 MiB second-level
// cache.
constexpr long block_bytes = 1 << 19;

// Kept columns are rounded up to this, a vector register of complex floats, two of complex doubles.
// The slow axis is transformed for as many at once, in a tile that fits into the first-level cache:
// one plan serves blocks of any width, and can be a patient one.
constexpr long batch = 4;

long rounded_up(long n, long to) { return (n + to - 1) / to * to; }

// Whole planes up to this many points are planned with FFTW_PATIENT: that takes 1 s at 64^2 and 2 s
// at 128^2, and the solve at 64^3 and 96^3 takes 13 % and 20 % less than with FFTW_MEASURE.  Larger
// ones would take 10 s and more.
constexpr long patient_points = 128 * 128;
// Complex transforms of one axis up to this length: 1 s each at 180, and up to twice as fast.
constexpr long patient_length = 256;

unsigned planner_flag(FftEffort effort, bool patient)
{
  if (effort == FftEffort::estimate) return FFTW_ESTIMATE;
  return patient ? FFTW_PATIENT : FFTW_MEASURE;
}

/// Columns as keep() wants them, for the whole rectangle.
std::vector<long> rectangle(const Grid &grid, const KeptModes &kept)
{
  std::vector<long> columns(grid.n[1], 0);
  for (long y = 0; y < grid.n[1]; ++y)
    if (std::min(y, grid.n[1] - y) <= kept.y) columns[y] = kept.x + 1;
  return columns;
}

/// Part of a row of a plane of modes that one rank has after the hand-over.  Lengths in complex
/// numbers.
struct Piece {
  long y, first_x, columns;
  long before;    // place in a plane of the field
  long after;     // place in a plane of the rank's part, after the hand-over
};

}    // namespace

long next_fast_size(long n, long multiple)
{
  for (long candidate = (std::max(1L, n) + multiple - 1) / multiple * multiple;;
       candidate += multiple) {
    long rest = candidate;
    for (long p : {2, 3, 5, 7})
      while (rest % p == 0) rest /= p;
    if (rest == 1) return candidate;
  }
}

template <class Real> struct VectorFft<Real>::Impl {
  /// kept: null for all modes
  Impl(const Grid &grid, const Comm &comm, FftEffort effort, const KeptModes *kept,
       const Workers &workers);

  void plan_planes();
  void plan_slow_axis();
  void keep(const std::vector<long> &columns);
  void deal_rows(std::vector<long> columns);
  void deal_one_row();
  void count_parcels();

  void transform_planes(Real *field) const;
  void transform_planes_back(Real *field) const;
  template <class Action> void for_parcel(Action action) const;
  void hand_over(Real *field);
  void hand_back(Real *field);
  void slow_stage(const std::array<Real *, 3> &field, const Change &change, Input input);
  void transform_block(Real *modes, long columns, const Plan<Real> &plan, int worker);
  void to_block(Real *from, Real *modes, long columns, int worker);
  void from_block(Real *modes, Real *to, long columns, int worker);
  void one_block(const std::array<Real *, 3> &field, const Piece &part, const Change &change,
                 Input input, int worker);

  Grid grid;
  Comm comm;
  const Workers &workers;
  bool pruned;
  // The slow axis by FFTW's plans between field and block, instead of through tiles: 15 % faster
  // for all modes at 96^3. Not in float, where rows of the field may lie off the 16 bytes that FFTW
  // asks for.
  bool direct;
  KeptModes kept;
  FftEffort effort;
  long n_slow;
  Slab slab;           // of planes, before the hand-over
  long plane_modes;    // complex numbers per plane: rows of grid.half()
  long width;          // modes of a row that are transformed along y
  std::size_t allocation;

  // What is kept, by rank: pieces first_piece[r] .. first_piece[r + 1] - 1.  A component is [planes
  // of the slab][plane] before and [all planes][pieces of the rank] after the hand-over; on one
  // rank there is none, and nothing moves.
  std::vector<Piece> pieces;
  std::vector<std::size_t> first_piece;
  long pitch;    // complex numbers from plane to plane after the hand-over

  PlanPair<Real> planes;    // of a whole plane; pruned: of its rows
  PlanPair<Real> across;    // pruned: the y axis of a plane
  long chunk;               // modes along x per block
  PlanPair<Real> full,
      rest;               // direct: of a block of `chunk` columns, and of the last one of a row
  PlanPair<Real> slow;    // else: of a tile [rows][batch]
  struct Scratch {
    AlignedArray<Real> block;    // modes of one block
    AlignedArray<Real> tile;
  };
  std::vector<Scratch> scratch;    // by worker
  AlignedArray<Real> parcel;       // a component sorted by rank
  std::vector<int> slab_counts, slab_offsets, piece_counts,
      piece_offsets;    // complex numbers per rank
};

template <class Real> VectorFft<Real>::Impl::Impl(const Grid &g, const Comm &c, FftEffort e,
                                                  const KeptModes *k, const Workers &w) :
    grid(g),
    comm(c), workers(w), pruned(k != nullptr),
    direct(!pruned && sizeof(Real) == sizeof(double) && !g.walled(g.slow_axis())),
    kept(k ? *k : KeptModes{g.n[0] / 2, g.n[1] / 2}), effort(e), n_slow(g.n[g.slow_axis()]),
    slab(equal_part(n_slow, c.rank(), c.size())),
    plane_modes(g.dim == 3 ? g.half() * g.n[1] : g.half())
{
  if (pruned && (g.dim != 3 || kept.x < 0 || kept.y < 0))
    throw std::invalid_argument("VectorFft: KeptModes are for 3D, and not negative");
  kept.x = std::min(kept.x, g.n[0] / 2);
  width = pruned ? std::min(g.half(), rounded_up(kept.x + 1, batch)) : g.half();

  if (g.dim == 3)
    deal_rows(rectangle(g, kept));
  else
    deal_one_row();
  long modes = slab.count * plane_modes;
  if (c.size() > 1) {
    // keep() deals anew: a rank gets an equal part, up to half a row more or less at either end.
    const long rows = std::min(2 * kept.y + 1, g.n[1]);
    modes = std::max(
        modes,
        n_slow * (pruned ? std::min(rows * width, rows * width / c.size() + width + 1) : pitch));
    parcel.resize(2 * slab.count * plane_modes);
  }
  // A rank without planes still needs a valid array.
  allocation = 2 * std::max(1L, modes);
  plan_planes();
  plan_slow_axis();
}

template <class Real> void VectorFft<Real>::Impl::keep(const std::vector<long> &columns)
{
  const std::vector<long> most = rectangle(grid, kept);
  if (!pruned || columns.size() != most.size())
    throw std::invalid_argument("VectorFft::keep: not made for this");
  for (std::size_t y = 0; y < most.size(); ++y)
    if (columns[y] < 0 || columns[y] > most[y])
      throw std::invalid_argument("VectorFft::keep: beyond KeptModes");
  deal_rows(columns);
}

/// Rows go to ranks by the columns that they have, for equal work.
template <class Real> void VectorFft<Real>::Impl::deal_rows(std::vector<long> columns)
{
  const long ranks = comm.size(), half = grid.half();
  for (long &c : columns) c = std::min(width, rounded_up(c, pruned ? batch : 1));
  const long total = std::accumulate(columns.begin(), columns.end(), 0L);
  pieces.clear();
  first_piece.assign(1, 0);
  long sum = 0, mine = 0;
  for (long y = 0; y < grid.n[1]; ++y) {
    if (columns[y] == 0) continue;
    const long owner = (2 * sum + columns[y]) * ranks / (2 * total);
    for (; ssize(first_piece) <= owner; mine = 0) first_piece.push_back(pieces.size());
    pieces.push_back({y, 0, columns[y], y * half, ranks == 1 ? y * half : mine});
    sum += columns[y];
    mine += columns[y];
  }
  first_piece.resize(ranks + 1, pieces.size());
  count_parcels();
}

/// 2D: a plane is a row, and each rank has a piece of it.
template <class Real> void VectorFft<Real>::Impl::deal_one_row()
{
  pieces.clear();
  first_piece.assign(1, 0);
  for (int r = 0; r < comm.size(); ++r) {
    const Slab part = equal_part(grid.half(), r, comm.size());
    if (part.count) pieces.push_back({0, part.start, part.count, part.start, 0});
    first_piece.push_back(pieces.size());
  }
  count_parcels();
}

template <class Real> void VectorFft<Real>::Impl::count_parcels()
{
  std::vector<long> columns(comm.size(), 0);
  for (std::size_t r = 0; r < columns.size(); ++r)
    for (std::size_t i = first_piece[r]; i < first_piece[r + 1]; ++i)
      columns[r] += pieces[i].columns;
  pitch = comm.size() == 1 ? plane_modes : columns[comm.rank()];
  for (auto *v : {&slab_counts, &slab_offsets, &piece_counts, &piece_offsets}) v->clear();
  long start = 0;
  for (int r = 0; r < comm.size(); ++r) {
    const Slab theirs = equal_part(n_slow, r, comm.size());
    piece_counts.push_back(static_cast<int>(slab.count * columns[r]));
    piece_offsets.push_back(static_cast<int>(slab.count * start));
    slab_counts.push_back(static_cast<int>(theirs.count * pitch));
    slab_offsets.push_back(static_cast<int>(theirs.start * pitch));
    start += columns[r];
  }
}

template <class Real> void VectorFft<Real>::Impl::plan_planes()
{
  AlignedArray<Real> scratch(2 * plane_modes);
  const int n[2] = {static_cast<int>(grid.n[1]), static_cast<int>(grid.n[0])};
  // FFTW's vector code asks for 16 bytes; planes of complex floats may lie between.
  const bool aligned = plane_modes * 2 * sizeof(Real) % 16 == 0;
  const unsigned unaligned = aligned ? 0u : FFTW_UNALIGNED;
  const unsigned how = planner_flag(effort, grid.n[0] * grid.n[1] <= patient_points) | unaligned;
  if (pruned) {
    planes = real_plans(1, n + 1, grid.n[1], grid.half(), scratch.data(), how);
    across = strided_plans(grid.n[1], width, grid.half(), scratch.data(),
                           planner_flag(effort, grid.n[1] <= patient_length) | unaligned);
  } else {
    planes =
        real_plans(grid.dim - 1, grid.dim == 3 ? n : n + 1, 1, plane_modes, scratch.data(), how);
  }
}

/// Through tiles: rows are copied to the block and back.  With kept columns that takes down to two
/// thirds of the time of FFTW's plans on the field (180^3), whose radix passes jump from page to
/// page.
template <class Real> void VectorFft<Real>::Impl::plan_slow_axis()
{
  const long bytes = static_cast<long>(2 * sizeof(Real)) * grid.dim * n_slow;
  long longest = width;
  if (!pruned) {
    longest = 0;
    for (std::size_t i = first_piece[comm.rank()]; i < first_piece[comm.rank() + 1]; ++i)
      longest = std::max(longest, pieces[i].columns);
  }
  chunk = std::max(1L, std::min(longest, block_bytes / bytes));
  const long blocks = std::max(1L, (longest + chunk - 1) / chunk);
  chunk = std::max(1L, (longest + blocks - 1) / blocks);
  if (chunk < longest && !direct) chunk = rounded_up(chunk, batch);
  scratch.resize(workers.count());
  for (Scratch &s : scratch) s.block.resize(2 * grid.dim * chunk * n_slow);
  if (direct) {
    const unsigned how = planner_flag(effort, grid.n[0] * grid.n[1] <= patient_points);
    AlignedArray<Real> field(longest ? allocation : 0);
    Real *const block = scratch[0].block.data();
    full = block_plans(n_slow, std::min(chunk, longest), pitch, field.data(), block, how);
    rest = block_plans(n_slow, longest % chunk, pitch, field.data(), block, how);
    return;
  }
  for (Scratch &s : scratch) s.tile.assign(2 * batch * n_slow, Real(0));
  slow = strided_plans(n_slow, batch, batch, scratch[0].tile.data(),
                       planner_flag(effort, n_slow <= patient_length));
}

template <class Real> void VectorFft<Real>::Impl::transform_planes(Real *field) const
{
  using F = Fftw<Real>;
  workers.run(slab.count, [=](long p, int) {
    Real *plane = field + 2 * p * plane_modes;
    F::execute_r2c(planes.forward.get(), plane, as_complex(plane));
    if (pruned) F::execute(across.forward.get(), as_complex(plane), as_complex(plane));
  });
}

/// What was not kept is set to zero here, where the plane is needed in the cache anyway.
template <class Real> void VectorFft<Real>::Impl::transform_planes_back(Real *field) const
{
  using F = Fftw<Real>;
  const long half = grid.half();
  workers.run(slab.count, [=](long p, int) {
    Real *plane = field + 2 * p * plane_modes;
    if (pruned) {
      long row = 0;
      for (const Piece &piece : pieces) {
        for (; row < piece.y; ++row) std::fill_n(plane + 2 * row * half, 2 * width, Real(0));
        std::fill_n(plane + 2 * (row * half + piece.columns), 2 * (width - piece.columns), Real(0));
        ++row;
      }
      for (; row < grid.n[1]; ++row) std::fill_n(plane + 2 * row * half, 2 * width, Real(0));
      F::execute(across.backward.get(), as_complex(plane), as_complex(plane));
      for (row = 0; row < grid.n[1]; ++row)
        std::fill_n(plane + 2 * (row * half + width), 2 * (half - width), Real(0));
    }
    F::execute_c2r(planes.backward.get(), as_complex(plane), plane);
  });
}

/// action(place in a field, reals) for everything in the parcel, in its order: by rank, plane,
/// piece.
template <class Real> template <class Action>
void VectorFft<Real>::Impl::for_parcel(Action action) const
{
  for (int r = 0; r < comm.size(); ++r)
    for (long p = 0; p < slab.count; ++p)
      for (std::size_t i = first_piece[r]; i < first_piece[r + 1]; ++i)
        action(2 * (p * plane_modes + pieces[i].before), 2 * pieces[i].columns);
}

/// Not FFTW's transposition: the slow axis may keep its stride, so nothing needs to be rearranged
/// within a rank.
template <class Real> void VectorFft<Real>::Impl::hand_over(Real *field)
{
  if (comm.size() == 1) return;
  const PhaseScope handing(Phase::communicate);
  Real *to = parcel.data();
  for_parcel([&](long place, long count) { to = std::copy_n(field + place, count, to); });
  MPI_Alltoallv(parcel.data(), piece_counts.data(), piece_offsets.data(), Fftw<Real>::mpi_complex(),
                field, slab_counts.data(), slab_offsets.data(), Fftw<Real>::mpi_complex(),
                comm.handle());
}

template <class Real> void VectorFft<Real>::Impl::hand_back(Real *field)
{
  if (comm.size() == 1) return;
  const PhaseScope handing(Phase::communicate);
  MPI_Alltoallv(field, slab_counts.data(), slab_offsets.data(), Fftw<Real>::mpi_complex(),
                parcel.data(), piece_counts.data(), piece_offsets.data(), Fftw<Real>::mpi_complex(),
                comm.handle());
  const Real *from = parcel.data();
  for_parcel([&](long place, long count) {
    std::copy_n(from, count, field + place);
    from += count;
  });
}

/// In place, batch columns at a time; the last tile may be filled up with zeros.
template <class Real> void VectorFft<Real>::Impl::transform_block(Real *modes, long columns,
                                                                  const Plan<Real> &plan,
                                                                  int worker)
{
  if (grid.walled(grid.slow_axis())) return;
  const long row = 2 * columns, step = 2 * batch;
  AlignedArray<Real> &tile = scratch[worker].tile;
  Real *const t = tile.data();
  const auto transform = [&](Real *f, auto width) {
    const long count = width;
    for (long s = 0; s < n_slow; ++s) std::copy_n(f + s * row, count, t + s * step);
    Fftw<Real>::execute(plan.get(), as_complex(t), as_complex(t));
    for (long s = 0; s < n_slow; ++s) std::copy_n(t + s * step, count, f + s * row);
  };
  long first = 0;
  for (; first + step <= row; first += step)
    transform(modes + first,
              std::integral_constant<long, step>{});    // vector moves instead of calls
  if (first == row) return;
  // What is left alone would grow with every transform, to infinity.
  std::fill(tile.begin(), tile.end(), Real(0));
  transform(modes + first, row - first);
}

template <class Real>
void VectorFft<Real>::Impl::to_block(Real *from, Real *modes, long columns, int worker)
{
  if (direct)
    return Fftw<Real>::execute((columns == chunk ? full : rest).forward.get(), as_complex(from),
                               as_complex(modes));
  for (long s = 0; s < n_slow; ++s)
    std::copy_n(from + 2 * s * pitch, 2 * columns, modes + 2 * s * columns);
  transform_block(modes, columns, slow.forward, worker);
}

template <class Real>
void VectorFft<Real>::Impl::from_block(Real *modes, Real *to, long columns, int worker)
{
  if (direct)
    return Fftw<Real>::execute((columns == chunk ? full : rest).backward.get(), as_complex(modes),
                               as_complex(to));
  transform_block(modes, columns, slow.backward, worker);
  for (long s = 0; s < n_slow; ++s)
    std::copy_n(modes + 2 * s * columns, 2 * columns, to + 2 * s * pitch);
}

template <class Real> void VectorFft<Real>::Impl::one_block(const std::array<Real *, 3> &field,
                                                            const Piece &part, const Change &change,
                                                            Input input, int worker)
{
  const long size = 2 * part.columns * n_slow;
  AlignedArray<Real> &block = scratch[worker].block;
  ModeBlock<Real> modes{{nullptr, nullptr, nullptr}, n_slow, part.columns, part.first_x, part.y};
  for (int d = 0; d < grid.dim; ++d) {
    modes.f[d] = block.data() + d * size;
    if (input == Input::zero)
      std::fill_n(modes.f[d], size, Real(0));
    else
      to_block(field[d] + 2 * part.after, modes.f[d], part.columns, worker);
  }
  {
    const PhaseScope noise(Phase::modes);
    change(modes);
  }
  for (int d = 0; d < grid.dim; ++d)
    from_block(modes.f[d], field[d] + 2 * part.after, part.columns, worker);
}

template <class Real> void VectorFft<Real>::Impl::slow_stage(const std::array<Real *, 3> &field,
                                                             const Change &change, Input input)
{
  std::vector<Piece> blocks;
  for (std::size_t i = first_piece[comm.rank()]; i < first_piece[comm.rank() + 1]; ++i) {
    const Piece &piece = pieces[i];
    for (long done = 0; done < piece.columns; done += chunk)
      blocks.push_back({piece.y, piece.first_x + done, std::min(chunk, piece.columns - done), 0,
                        piece.after + done});
  }
  workers.run(ssize(blocks),
              [&](long i, int worker) { one_block(field, blocks[i], change, input, worker); });
}

template <class Real> VectorFft<Real>::VectorFft(const Grid &grid, const Comm &comm,
                                                 FftEffort effort, const Workers &workers) :
    impl_(std::make_unique<Impl>(grid, comm, effort, nullptr, workers))
{}

template <class Real>
VectorFft<Real>::VectorFft(const Grid &grid, const Comm &comm, FftEffort effort,
                           const KeptModes &kept, const Workers &workers) :
    impl_(std::make_unique<Impl>(grid, comm, effort, &kept, workers))
{}

template <class Real> VectorFft<Real>::~VectorFft() = default;

template <class Real> Slab VectorFft<Real>::slab() const { return impl_->slab; }

template <class Real> std::size_t VectorFft<Real>::allocation() const { return impl_->allocation; }

template <class Real> void VectorFft<Real>::keep(const std::vector<long> &columns)
{
  impl_->keep(columns);
}

template <class Real>
void VectorFft<Real>::solve(const std::array<Real *, 3> &field, const Change &change, Input input)
{
  Impl &m = *impl_;
  if (input == Input::field)
    for (int d = 0; d < m.grid.dim; ++d) {
      m.transform_planes(field[d]);
      m.hand_over(field[d]);
    }
  m.slow_stage(field, change, input);
  for (int d = 0; d < m.grid.dim; ++d) {
    m.hand_back(field[d]);
    m.transform_planes_back(field[d]);
  }
}

template <class Real> std::size_t VectorFft<Real>::memory() const
{
  std::size_t count = impl_->parcel.capacity();
  for (const auto &s : impl_->scratch) count += s.block.capacity() + s.tile.capacity();
  return count * sizeof(Real);
}

template <class Real> struct PlainFft<Real>::Plans {
  PlanPair<Real> pair;
};

template <class Real> PlainFft<Real>::PlainFft(int rank, const int *n, long many) :
    plans_(std::make_unique<Plans>())
{
  long modes = n[rank - 1] / 2 + 1;
  for (int d = 0; d < rank - 1; ++d) modes *= n[d];
  AlignedArray<Real> field(2 * modes * many);
  plans_->pair = real_plans<Real>(rank, n, many, modes, field.data(), FFTW_ESTIMATE);
}

template <class Real> PlainFft<Real>::~PlainFft() = default;

template <class Real> void PlainFft<Real>::forward(Real *field) const
{
  Fftw<Real>::execute_r2c(plans_->pair.forward.get(), field, as_complex(field));
}

template <class Real> void PlainFft<Real>::backward(Real *field) const
{
  Fftw<Real>::execute_c2r(plans_->pair.backward.get(), as_complex(field), field);
}

template class PlainFft<float>;
template class PlainFft<double>;
template class VectorFft<float>;
template class VectorFft<double>;

}    // namespace bdh
