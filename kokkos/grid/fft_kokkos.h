// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Real transforms of fields in the memory of a device: cuFFT on a GPU of Nvidia, FFTW on the host.
#ifndef BDH_GRID_FFT_KOKKOS_H
#define BDH_GRID_FFT_KOKKOS_H

#include "grid/fft.h"
#include "grid/grid.h"

#include <Kokkos_Core.hpp>

#include <stdexcept>
#include <string>

#ifdef KOKKOS_ENABLE_CUDA
#include <cufft.h>
#endif

namespace bdh {

/// Reals per component of a field: rows padded to 2 (n_x/2 + 1), as in VectorFft.
inline std::size_t field_size(const Grid &g) { return 2 * g.half() * g.n[1] * g.n[2]; }

/// The axes of a field that are transformed, slowest first, and the number of such transforms that
/// follow one another.  A slow axis between walls is not transformed, as in VectorFft.
struct FieldAxes {
  int rank, many;
  int n[3];
  explicit FieldAxes(const Grid &g) : rank(g.dim), many(1)
  {
    if (g.walled(g.slow_axis())) many = g.n[--rank];
    for (int d = 0; d < rank; ++d) n[d] = g.n[rank - 1 - d];
  }
};

/// Transforms in place, one component at a time, not normalised.  Real is float or double.  This is
/// the general case, for devices that use the memory of the host.
template <class Real, class Exec> class DeviceFft {
 public:
  explicit DeviceFft(const Grid &grid) : DeviceFft(FieldAxes(grid)) {}
  explicit DeviceFft(const FieldAxes &axes) : fft_(axes.rank, axes.n, axes.many) {}
  void forward(Real *field) const
  {
    Exec().fence();
    fft_.forward(field);
  }
  void backward(Real *field) const
  {
    Exec().fence();
    fft_.backward(field);
  }
  std::size_t memory() const { return 0; }

 private:
  PlainFft<Real> fft_;
};

#ifdef KOKKOS_ENABLE_CUDA
/// cuFFT runs in the stream of Kokkos' default instance, so that no fence is needed around it.
template <class Real> class DeviceFft<Real, Kokkos::Cuda> {
 public:
  explicit DeviceFft(const Grid &grid)
  {
    FieldAxes l(grid);
    const int reals = field_size(grid) / l.many;
    const bool single = sizeof(Real) == sizeof(float);
    int real_rows[3], modes[3];
    for (int d = 0; d < l.rank; ++d) real_rows[d] = modes[d] = l.n[d];
    modes[l.rank - 1] = grid.half();
    real_rows[l.rank - 1] = 2 * modes[l.rank - 1];
    check(cufftPlanMany(&forward_, l.rank, l.n, real_rows, 1, reals, modes, 1, reals / 2,
                        single ? CUFFT_R2C : CUFFT_D2Z, l.many));
    check(cufftPlanMany(&backward_, l.rank, l.n, modes, 1, reals / 2, real_rows, 1, reals,
                        single ? CUFFT_C2R : CUFFT_Z2D, l.many));
    for (cufftHandle plan : {forward_, backward_}) {
      std::size_t bytes = 0;
      check(cufftSetStream(plan, Kokkos::Cuda().cuda_stream()));
      check(cufftGetSize(plan, &bytes));
      memory_ += bytes;
    }
  }
  ~DeviceFft()
  {
    cufftDestroy(forward_);
    cufftDestroy(backward_);
  }
  DeviceFft(const DeviceFft &) = delete;
  DeviceFft &operator=(const DeviceFft &) = delete;

  void forward(float *f) const
  {
    check(cufftExecR2C(forward_, f, reinterpret_cast<cufftComplex *>(f)));
  }
  void forward(double *f) const
  {
    check(cufftExecD2Z(forward_, f, reinterpret_cast<cufftDoubleComplex *>(f)));
  }
  void backward(float *f) const
  {
    check(cufftExecC2R(backward_, reinterpret_cast<cufftComplex *>(f), f));
  }
  void backward(double *f) const
  {
    check(cufftExecZ2D(backward_, reinterpret_cast<cufftDoubleComplex *>(f), f));
  }
  std::size_t memory() const { return memory_; }

 private:
  static void check(cufftResult r)
  {
    if (r != CUFFT_SUCCESS)
      throw std::runtime_error("cuFFT failed with code " + std::to_string(static_cast<int>(r)));
  }

  cufftHandle forward_ = 0, backward_ = 0;
  std::size_t memory_ = 0;
};
#endif

}    // namespace bdh
#endif
