// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "grid/fft.h"

#include "base/phases.h"
#include "base/ssize.h"
#include "grid/plane_transforms.h"
#include "grid/row_transposition.h"
#include "grid/slow_axis.h"
#include "grid/transposition.h"

#include <algorithm>
#include <complex>
#include <numeric>
#include <stdexcept>

namespace bdh {

namespace {

/// The columns of the whole rectangle of kept modes, in the form that keep() takes.
std::vector<long> rectangle(const Grid &grid, const KeptModes &kept)
{
  std::vector<long> columns(grid.n[1], 0);
  for (long y = 0; y < grid.n[1]; ++y)
    if (std::min(y, grid.n[1] - y) <= kept.y) columns[y] = kept.x + 1;
  return columns;
}

/// In 3D, rows are dealt to the ranks so that all get about as many columns, which begin at
/// `first`.
PartsOfRanks deal_rows(const Grid &grid, const std::vector<long> &columns, long first, long ranks)
{
  PartsOfRanks parts(ranks);
  const long total = std::accumulate(columns.begin(), columns.end(), 0L);
  long sum = 0;
  for (long y = 0; y < grid.n[1]; ++y) {
    if (columns[y] == 0) continue;
    const long owner = (2 * sum + columns[y]) * ranks / (2 * total);
    parts[owner].push_back({y * grid.half() + first, columns[y]});
    sum += columns[y];
  }
  return parts;
}

/// In 2D a plane is a row, and each rank gets a part of it.
PartsOfRanks deal_one_row(const Grid &grid, int ranks)
{
  PartsOfRanks parts(ranks);
  for (int r = 0; r < ranks; ++r) {
    const Slab part = equal_part(grid.half(), r, ranks);
    if (part.count) parts[r].push_back({part.start, part.count});
  }
  return parts;
}

long longest(const std::vector<PlanePart> &parts)
{
  long most = 0;
  for (const PlanePart &part : parts) most = std::max(most, part.count);
  return most;
}

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
  /// `kept` is null for all modes.
  Impl(const Grid &grid, const Comm &comm, const FftSetup &setup, const KeptModes *kept,
       const Workers &workers, int fields);

  void keep(const std::vector<long> &columns);
  template <class Action> void for_planes(Real *component, const Action &action);
  void forward(Real *const *component);
  void solve(Real *const *component, int fields, const Change &change, Input input);
  void slow_stage(Real *const *component, const Change &change, Input input);
  void one_block(Real *const *component, const PlanePart &part, const Change &change, Input input,
                 int worker);
  void backward(Real *const *component);

  KeptModes clipped(const KeptModes *wanted) const;
  PartsOfRanks deal(std::vector<long> dealt) const;
  std::size_t largest_field() const;

  Grid grid;
  GridParts parts;
  const Workers &workers;
  int components;    // of the fields that are transformed
  bool pruned;
  KeptModes kept;
  long width;    // modes of a row that are transformed along y
  std::unique_ptr<RowTransposition<std::complex<Real>>> rows;    // for pencils
  Slab columns;    // of a row that this rank transforms along y
  Transposition<std::complex<Real>> transposition;
  std::size_t allocation;
  PlaneTransforms<Real> planes;
  SlowAxis<Real> slow_axis;
};

template <class Real>
VectorFft<Real>::Impl::Impl(const Grid &g, const Comm &c, const FftSetup &setup, const KeptModes *k,
                            const Workers &w, int fields) :
    grid(g),
    parts(g, c, setup.share), workers(w), components(fields * g.dim), pruned(k != nullptr),
    kept(clipped(k)),
    width(pruned ? std::min(g.half(), SlowAxis<Real>::whole_batches(kept.x + 1)) : g.half()),
    rows(parts.pencils()
             ? std::make_unique<RowTransposition<std::complex<Real>>>(parts, g.half(), width)
             : nullptr),
    columns(rows ? rows->columns() : Slab{0, width}),
    transposition(parts.same_rows(), parts.groups(), g.n[g.slow_axis()],
                  g.dim == 3 ? g.half() * g.n[1] : g.half(), deal(rectangle(g, kept))),
    allocation(largest_field()),
    planes(g, setup.effort, pruned, width, parts.rows(), columns, w.count()),
    slow_axis(g, setup.effort,
              {pruned ? columns.count : longest(transposition.own_parts()), transposition.pitch(),
               pruned, !pruned || c.size() == 1, components},
              allocation, w)
{}

template <class Real> KeptModes VectorFft<Real>::Impl::clipped(const KeptModes *wanted) const
{
  if (!wanted) return {grid.n[0] / 2, grid.n[1] / 2};
  if (grid.dim != 3 || wanted->x < 0 || wanted->y < 0)
    throw std::invalid_argument("VectorFft: KeptModes are for 3D, and not negative");
  return {std::min(wanted->x, grid.n[0] / 2), wanted->y};
}

template <class Real> void VectorFft<Real>::Impl::keep(const std::vector<long> &columns)
{
  const std::vector<long> most = rectangle(grid, kept);
  if (!pruned || columns.size() != most.size())
    throw std::invalid_argument("VectorFft::keep: not made for this");
  for (std::size_t y = 0; y < most.size(); ++y)
    if (columns[y] < 0 || columns[y] > most[y])
      throw std::invalid_argument("VectorFft::keep: beyond KeptModes");
  transposition.deal(deal(columns));
}

template <class Real> PartsOfRanks VectorFft<Real>::Impl::deal(std::vector<long> dealt) const
{
  const int ranks = parts.same_rows().size();
  if (grid.dim == 2) return deal_one_row(grid, ranks);
  for (long &c : dealt) {
    c = std::min(width, pruned ? SlowAxis<Real>::whole_batches(c) : c);
    c = std::clamp(c - columns.start, 0L, columns.count);
  }
  return deal_rows(grid, dealt, columns.start, ranks);
}

/// Reals that a component needs before and after the hand-over, whichever are more.
template <class Real> std::size_t VectorFft<Real>::Impl::largest_field() const
{
  long after = transposition.pitch();
  const int ranks = parts.same_rows().size();
  if (pruned && ranks > 1) {
    // keep() deals the rows again.  A rank then gets an equal part, give or take half a row at
    // either end.
    const long all = std::min(2 * kept.y + 1, grid.n[1]) * columns.count;
    after = std::min(all, all / ranks + columns.count + 1);
  }
  const long before = transposition.slab().count * transposition.plane_size();
  // A rank without planes still needs a valid array.
  return 2 * std::max(1L, std::max(before, transposition.planes() * after));
}

template <class Real> std::complex<Real> *as_complex(Real *p)
{
  return reinterpret_cast<std::complex<Real> *>(p);
}

/// Calls action(plane of a component, worker) for this rank's planes.
template <class Real> template <class Action>
void VectorFft<Real>::Impl::for_planes(Real *component, const Action &action)
{
  workers.run(transposition.slab().count, [&](long p, int worker) {
    action(component + 2 * p * transposition.plane_size(), worker);
  });
}

template <class Real> void VectorFft<Real>::Impl::forward(Real *const *component)
{
  for (int d = 0; d < components; ++d) {
    for_planes(component[d], [&](Real *plane, int worker) {
      planes.rows_forward(plane, worker);
      if (!rows) planes.columns_forward(plane);
    });
    if (rows) {
      rows->hand_over(as_complex(component[d]));
      for_planes(component[d], [&](Real *plane, int) { planes.columns_forward(plane); });
    }
    transposition.hand_over(as_complex(component[d]));
  }
}

template <class Real> void VectorFft<Real>::Impl::backward(Real *const *component)
{
  for (int d = 0; d < components; ++d) {
    transposition.hand_back(as_complex(component[d]));
    if (rows) {
      for_planes(component[d],
                 [&](Real *plane, int) { planes.columns_backward(plane, transposition.parts()); });
      rows->hand_back(as_complex(component[d]));
    }
    for_planes(component[d], [&](Real *plane, int worker) {
      if (!rows) planes.columns_backward(plane, transposition.parts());
      planes.rows_backward(plane, worker);
    });
    if (rows) parts.clear_others(component[d]);
  }
}

template <class Real>
void VectorFft<Real>::Impl::one_block(Real *const *component, const PlanePart &part,
                                      const Change &change, Input input, int worker)
{
  const long rows = transposition.planes(), size = slow_axis.block_size(part.count),
             pitch = transposition.pitch();
  ModeBlock<Real> modes{{}, rows, part.count, part.before % grid.half(), part.before / grid.half()};
  for (int d = 0; d < components; ++d) {
    modes.f[d] = slow_axis.block(worker) + d * size;
    if (input == Input::zero)
      std::fill_n(modes.f[d], size, Real(0));
    else
      slow_axis.forward(component[d] + 2 * part.after, pitch, modes.f[d], part.count, worker);
  }
  {
    const PhaseScope noise(Phase::modes);
    change(modes);
  }
  for (int d = 0; d < components; ++d)
    slow_axis.backward(modes.f[d], component[d] + 2 * part.after, pitch, part.count, worker);
}

template <class Real>
void VectorFft<Real>::Impl::slow_stage(Real *const *component, const Change &change, Input input)
{
  const long chunk = slow_axis.chunk();
  std::vector<PlanePart> blocks;
  for (const PlanePart &part : transposition.own_parts())
    for (long done = 0; done < part.count; done += chunk)
      blocks.push_back({part.before + done, std::min(chunk, part.count - done), part.after + done});
  workers.run(ssize(blocks),
              [&](long i, int worker) { one_block(component, blocks[i], change, input, worker); });
}

template <class Real> void VectorFft<Real>::Impl::solve(Real *const *component, int fields,
                                                        const Change &change, Input input)
{
  components = fields * grid.dim;
  if (input == Input::field) forward(component);
  slow_stage(component, change, input);
  backward(component);
}

template <class Real> VectorFft<Real>::VectorFft(const Grid &grid, const Comm &comm,
                                                 const FftSetup &setup, const Workers &workers) :
    impl_(std::make_unique<Impl>(grid, comm, setup, nullptr, workers, 1))
{}

template <class Real>
VectorFft<Real>::VectorFft(const Grid &grid, const Comm &comm, const FftSetup &setup,
                           const KeptModes &kept, const Workers &workers, int fields) :
    impl_(std::make_unique<Impl>(grid, comm, setup, &kept, workers, fields))
{}

template <class Real> VectorFft<Real>::~VectorFft() = default;

template <class Real> const GridParts &VectorFft<Real>::parts() const { return impl_->parts; }

template <class Real> std::size_t VectorFft<Real>::allocation() const { return impl_->allocation; }

template <class Real> void VectorFft<Real>::keep(const std::vector<long> &columns)
{
  impl_->keep(columns);
}

template <class Real>
void VectorFft<Real>::solve(const std::array<Real *, 3> &field, const Change &change, Input input)
{
  impl_->solve(field.data(), 1, change, input);
}

template <class Real>
void VectorFft<Real>::solve(const std::array<Real *, 6> &fields, const Change &change, Input input)
{
  impl_->solve(fields.data(), 2, change, input);
}

template <class Real> std::size_t VectorFft<Real>::memory() const
{
  return impl_->transposition.memory() + (impl_->rows ? impl_->rows->memory() : 0) +
         impl_->planes.memory() + impl_->slow_axis.memory();
}

template <class Real> struct PlainFft<Real>::Plans {
  FftwPlanPair<Real> pair;
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
  Fftw<Real>::execute_r2c(plans_->pair.forward.get(), field, as_fftw_complex(field));
}

template <class Real> void PlainFft<Real>::backward(Real *field) const
{
  Fftw<Real>::execute_c2r(plans_->pair.backward.get(), as_fftw_complex(field), field);
}

template <class Real> struct PlainLines<Real>::Plans {
  FftwPlanPair<Real> pair;
};

template <class Real> PlainLines<Real>::PlainLines(int length, int many) :
    plans_(std::make_unique<Plans>())
{
  AlignedArray<Real> field(2L * length * many);
  plans_->pair = strided_plans<Real>(length, many, many, field.data(), FFTW_ESTIMATE);
}

template <class Real> PlainLines<Real>::~PlainLines() = default;

template <class Real> void PlainLines<Real>::forward(Real *field) const
{
  Fftw<Real>::execute(plans_->pair.forward.get(), as_fftw_complex(field), as_fftw_complex(field));
}

template <class Real> void PlainLines<Real>::backward(Real *field) const
{
  Fftw<Real>::execute(plans_->pair.backward.get(), as_fftw_complex(field), as_fftw_complex(field));
}

template class PlainLines<float>;
template class PlainLines<double>;
template class PlainFft<float>;
template class PlainFft<double>;
template class VectorFft<float>;
template class VectorFft<double>;

}    // namespace bdh
