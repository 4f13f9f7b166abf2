// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Transforms of fields in the memory of a device: cuFFT on a GPU of Nvidia, FFTW on the host.
#ifndef BDH_GRID_FFT_KOKKOS_H
#define BDH_GRID_FFT_KOKKOS_H

#include "grid/fft.h"
#include "grid/grid.h"
#include "grid/transposition_kokkos.h"

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

#ifdef KOKKOS_ENABLE_CUDA
#include <cufft.h>
#endif

namespace bdh {

/// The axes of a field that are transformed together, slowest first, and the number of such
/// transforms that follow one another.
struct FieldAxes {
  int rank, many;
  int n[3];
  /// All axes, but the slow one if it is between walls, as in VectorFft.
  explicit FieldAxes(const Grid &g) : FieldAxes(g, g.dim - int(g.walled(g.slow_axis()))) {}
  /// Those of `planes` planes alone.
  static FieldAxes of_planes(const Grid &g, long planes)
  {
    FieldAxes axes(g, g.dim - 1);
    axes.many = planes;
    return axes;
  }

 private:
  FieldAxes(const Grid &g, int transformed) :
      rank(transformed), many(transformed < g.dim ? g.n[g.slow_axis()] : 1)
  {
    for (int d = 0; d < rank; ++d) n[d] = g.n[rank - 1 - d];
  }
};

/// Transforms in place, one component at a time, not normalised, by a class of FFTW's plans.  This
/// is the general case, for devices that use the memory of the host.
template <class Plans, class Real, class Exec> class FftOfHost {
 public:
  static_assert(host_memory<Exec>, "there is no library of transforms for this device");
  template <class... Arguments> explicit FftOfHost(const Arguments &...arguments) :
      plans_(arguments...)
  {}
  void forward(Real *field) const
  {
    Exec().fence();
    plans_.forward(field);
  }
  void backward(Real *field) const
  {
    Exec().fence();
    plans_.backward(field);
  }
  std::size_t memory() const { return 0; }

 private:
  Plans plans_;
};

/// Real transforms of rows padded to 2 (n_x/2 + 1).  Real is float or double.
template <class Real, class Exec> class DeviceRealFft
    : public FftOfHost<PlainFft<Real>, Real, Exec> {
 public:
  explicit DeviceRealFft(const FieldAxes &axes) :
      FftOfHost<PlainFft<Real>, Real, Exec>(axes.rank, axes.n, axes.many)
  {}
};

/// Complex transforms of the first axis of an array [length][many].
template <class Real, class Exec> class DeviceLineFft
    : public FftOfHost<PlainLines<Real>, Real, Exec> {
 public:
  DeviceLineFft(int length, int many) : FftOfHost<PlainLines<Real>, Real, Exec>(length, many) {}
};

#ifdef KOKKOS_ENABLE_CUDA
/// A plan of cuFFT, which runs in the stream of Kokkos' default instance, so that no fence is
/// needed around it.
class CufftPlan {
 public:
  CufftPlan() = default;
  ~CufftPlan()
  {
    if (made_) cufftDestroy(plan_);
  }
  CufftPlan(const CufftPlan &) = delete;
  CufftPlan &operator=(const CufftPlan &) = delete;

  /// See cufftPlanMany().
  void make(int rank, int *n, int *inembed, int istride, int idist, int *onembed, int ostride,
            int odist, cufftType type, int batch)
  {
    check(cufftPlanMany(&plan_, rank, n, inembed, istride, idist, onembed, ostride, odist, type,
                        batch));
    made_ = true;
    check(cufftSetStream(plan_, Kokkos::Cuda().cuda_stream()));
    check(cufftGetSize(plan_, &bytes_));
  }
  void real_to_complex(float *f) const
  {
    check(cufftExecR2C(plan_, f, reinterpret_cast<cufftComplex *>(f)));
  }
  void real_to_complex(double *f) const
  {
    check(cufftExecD2Z(plan_, f, reinterpret_cast<cufftDoubleComplex *>(f)));
  }
  void complex_to_real(float *f) const
  {
    check(cufftExecC2R(plan_, reinterpret_cast<cufftComplex *>(f), f));
  }
  void complex_to_real(double *f) const
  {
    check(cufftExecZ2D(plan_, reinterpret_cast<cufftDoubleComplex *>(f), f));
  }
  void complex_to_complex(float *f, int direction) const
  {
    auto *z = reinterpret_cast<cufftComplex *>(f);
    check(cufftExecC2C(plan_, z, z, direction));
  }
  void complex_to_complex(double *f, int direction) const
  {
    auto *z = reinterpret_cast<cufftDoubleComplex *>(f);
    check(cufftExecZ2Z(plan_, z, z, direction));
  }
  std::size_t memory() const { return bytes_; }

 private:
  static void check(cufftResult r)
  {
    if (r != CUFFT_SUCCESS)
      throw std::runtime_error("cuFFT failed with code " + std::to_string(static_cast<int>(r)));
  }

  cufftHandle plan_ = 0;
  bool made_ = false;
  std::size_t bytes_ = 0;
};

template <class Real> class DeviceRealFft<Real, Kokkos::Cuda> {
 public:
  explicit DeviceRealFft(const FieldAxes &axes)
  {
    FieldAxes l(axes);
    const bool single = sizeof(Real) == sizeof(float);
    int real_rows[3], modes[3], reals = 1;
    for (int d = 0; d < l.rank; ++d) real_rows[d] = modes[d] = l.n[d];
    modes[l.rank - 1] = l.n[l.rank - 1] / 2 + 1;
    real_rows[l.rank - 1] = 2 * modes[l.rank - 1];
    for (int d = 0; d < l.rank; ++d) reals *= real_rows[d];
    forward_.make(l.rank, l.n, real_rows, 1, reals, modes, 1, reals / 2,
                  single ? CUFFT_R2C : CUFFT_D2Z, l.many);
    backward_.make(l.rank, l.n, modes, 1, reals / 2, real_rows, 1, reals,
                   single ? CUFFT_C2R : CUFFT_Z2D, l.many);
  }
  void forward(Real *field) const { forward_.real_to_complex(field); }
  void backward(Real *field) const { backward_.complex_to_real(field); }
  std::size_t memory() const { return forward_.memory() + backward_.memory(); }

 private:
  CufftPlan forward_, backward_;
};

template <class Real> class DeviceLineFft<Real, Kokkos::Cuda> {
 public:
  DeviceLineFft(int length, int many)
  {
    plan_.make(1, &length, &length, many, 1, &length, many, 1,
               sizeof(Real) == sizeof(float) ? CUFFT_C2C : CUFFT_Z2Z, many);
  }
  void forward(Real *field) const { plan_.complex_to_complex(field, CUFFT_FORWARD); }
  void backward(Real *field) const { plan_.complex_to_complex(field, CUFFT_INVERSE); }
  std::size_t memory() const { return plan_.memory(); }

 private:
  CufftPlan plan_;
};
#endif

/// The modes that a rank has between DeviceFft::forward() and backward(): those of some consecutive
/// columns, row by row of the slow axis.
struct RankModes {
  long rows, columns;
  long first;    ///< column; they are numbered along x and, in 3D, y, as in a plane of the field
  BDH_FN long count() const { return rows * columns; }
  BDH_FN long row(long i) const { return i / columns; }
  BDH_FN long column(long i) const { return first + i % columns; }
};

/// Transforms of one component of a field at a time, in place, not normalised.  The planes of the
/// slow axis are dealt to the ranks in slabs.  On one rank the library transforms all axes at once.
template <class Real, class Exec> class DeviceFft {
 public:
  /// Collective.
  DeviceFft(const Grid &grid, const Comm &comm) :
      parts_(grid, comm, 1), rows_(grid.n[grid.slow_axis()]),
      plane_(grid.dim == 3 ? grid.half() * grid.n[1] : grid.half()),
      transposition_(comm, rows_, plane_, 2)
  {
    const long planes = slab().count, columns = modes().columns;
    if (comm.size() == 1) {
      planes_ = std::make_unique<RealFft>(FieldAxes(grid));
    } else {
      if (planes > 0) planes_ = std::make_unique<RealFft>(FieldAxes::of_planes(grid, planes));
      if (columns > 0 && !grid.walled(grid.slow_axis()))
        lines_ = std::make_unique<DeviceLineFft<Real, Exec>>(rows_, columns);
    }
  }

  /// Slabs.
  const GridParts &parts() const { return parts_; }
  Slab slab() const { return transposition_.slab(); }
  RankModes modes() const
  {
    const Slab &columns = transposition_.columns();
    return {rows_, columns.count, columns.start};
  }
  /// Reals that each component's array must have; a rank without planes has one, too.
  std::size_t allocation() const
  {
    return 2 * std::max(1L, std::max(slab().count * plane_, modes().count()));
  }

  /// Collective.
  void forward(Real *field)
  {
    if (planes_) planes_->forward(field);
    transposition_.hand_over(field);
    if (lines_) lines_->forward(field);
  }
  /// Collective.
  void backward(Real *field)
  {
    if (lines_) lines_->backward(field);
    transposition_.hand_back(field);
    if (planes_) planes_->backward(field);
  }
  std::size_t memory() const
  {
    return transposition_.memory() + (planes_ ? planes_->memory() : 0) +
           (lines_ ? lines_->memory() : 0);
  }

 private:
  using RealFft = DeviceRealFft<Real, Exec>;

  GridParts parts_;
  long rows_, plane_;    // planes, and modes in each
  DeviceTransposition<Real, Exec> transposition_;
  std::unique_ptr<RealFft> planes_;
  std::unique_ptr<DeviceLineFft<Real, Exec>> lines_;
};

}    // namespace bdh
#endif
