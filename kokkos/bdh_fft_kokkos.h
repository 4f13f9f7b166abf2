/// Real transforms of whole fields in the memory of a device: cuFFT on a GPU of Nvidia, FFTW on the host.
#ifndef BDH_FFT_KOKKOS_H
#define BDH_FFT_KOKKOS_H

#include "bdh_types.h"

#include <Kokkos_Core.hpp>

#include <stdexcept>
#include <string>

#ifdef KOKKOS_ENABLE_CUDA
#include <cufft.h>
#endif
#include <fftw3.h>

namespace bdh {

/// Reals per component of a field: rows padded to 2 (n_x/2 + 1), as in VectorFft.
inline std::size_t field_size(const Grid &g) { return static_cast<std::size_t>(2 * g.half() * g.n[1] * g.n[2]); }

/// How the axes of a field are cut into transforms, slowest axis first.
struct FieldLayout {
  int rank;
  int n[3];
  int modes;       ///< complex numbers per transform
  int many;        ///< transforms, one after the other

  /// slow_axis: false leaves the slow axis out, for planes between walls.
  FieldLayout(const Grid &g, bool slow_axis)
  {
    const int x = static_cast<int>(g.n[0]), y = static_cast<int>(g.n[1]), z = static_cast<int>(g.n[2]);
    const int half = static_cast<int>(g.half());
    rank = (g.dim == 3 ? 2 : 1) + (slow_axis ? 1 : 0);
    const int all[3] = {z, y, x};
    const int first = g.dim == 3 ? (slow_axis ? 0 : 1) : (slow_axis ? 1 : 2);
    for (int d = 0; d < rank; ++d) n[d] = all[first + d];
    modes = half;
    for (int d = 0; d < rank - 1; ++d) modes *= n[d];
    many = half * y * z / modes;
  }
};

/// In place, one component at a time, not normalised.  Real: float or double.  The general case: memory of the host.
template <class Real, class Exec> class DeviceFft;

template <class Real> struct HostFftw;
template <> struct HostFftw<double> {
  using Plan = fftw_plan;
  static Plan forward(const FieldLayout &l, double *f)
  {
    return fftw_plan_many_dft_r2c(l.rank, l.n, l.many, f, nullptr, 1, 2 * l.modes, reinterpret_cast<fftw_complex *>(f), nullptr, 1,
                                  l.modes, FFTW_ESTIMATE);
  }
  static Plan backward(const FieldLayout &l, double *f)
  {
    return fftw_plan_many_dft_c2r(l.rank, l.n, l.many, reinterpret_cast<fftw_complex *>(f), nullptr, 1, l.modes, f, nullptr, 1,
                                  2 * l.modes, FFTW_ESTIMATE);
  }
  static void r2c(Plan p, double *f) { fftw_execute_dft_r2c(p, f, reinterpret_cast<fftw_complex *>(f)); }
  static void c2r(Plan p, double *f) { fftw_execute_dft_c2r(p, reinterpret_cast<fftw_complex *>(f), f); }
  static void destroy(Plan p) { fftw_destroy_plan(p); }
};
template <> struct HostFftw<float> {
  using Plan = fftwf_plan;
  static Plan forward(const FieldLayout &l, float *f)
  {
    return fftwf_plan_many_dft_r2c(l.rank, l.n, l.many, f, nullptr, 1, 2 * l.modes, reinterpret_cast<fftwf_complex *>(f), nullptr, 1,
                                   l.modes, FFTW_ESTIMATE);
  }
  static Plan backward(const FieldLayout &l, float *f)
  {
    return fftwf_plan_many_dft_c2r(l.rank, l.n, l.many, reinterpret_cast<fftwf_complex *>(f), nullptr, 1, l.modes, f, nullptr, 1,
                                   2 * l.modes, FFTW_ESTIMATE);
  }
  static void r2c(Plan p, float *f) { fftwf_execute_dft_r2c(p, f, reinterpret_cast<fftwf_complex *>(f)); }
  static void c2r(Plan p, float *f) { fftwf_execute_dft_c2r(p, reinterpret_cast<fftwf_complex *>(f), f); }
  static void destroy(Plan p) { fftwf_destroy_plan(p); }
};

template <class Real, class Exec> class DeviceFft {
 public:
  DeviceFft(const Grid &grid, bool slow_axis = true) : layout_(grid, slow_axis)
  {
    AlignedArray<Real> field(field_size(grid));
    forward_ = HostFftw<Real>::forward(layout_, field.data());
    backward_ = HostFftw<Real>::backward(layout_, field.data());
  }
  ~DeviceFft()
  {
    HostFftw<Real>::destroy(forward_);
    HostFftw<Real>::destroy(backward_);
  }
  DeviceFft(const DeviceFft &) = delete;
  DeviceFft &operator=(const DeviceFft &) = delete;

  void forward(Real *field) const
  {
    Exec().fence();
    HostFftw<Real>::r2c(forward_, field);
  }
  void backward(Real *field) const
  {
    Exec().fence();
    HostFftw<Real>::c2r(backward_, field);
  }
  std::size_t memory() const { return 0; }

 private:
  FieldLayout layout_;
  typename HostFftw<Real>::Plan forward_, backward_;
};

#ifdef KOKKOS_ENABLE_CUDA
/// In the stream of Kokkos' default instance, so that no fence is needed around it.
template <class Real> class DeviceFft<Real, Kokkos::Cuda> {
 public:
  DeviceFft(const Grid &grid, bool slow_axis = true)
  {
    FieldLayout l(grid, slow_axis);
    const bool single = sizeof(Real) == sizeof(float);
    int real_rows[3], modes[3];
    for (int d = 0; d < l.rank; ++d) real_rows[d] = modes[d] = l.n[d];
    modes[l.rank - 1] = static_cast<int>(grid.half());
    real_rows[l.rank - 1] = 2 * modes[l.rank - 1];
    check(cufftPlanMany(&forward_, l.rank, l.n, real_rows, 1, 2 * l.modes, modes, 1, l.modes, single ? CUFFT_R2C : CUFFT_D2Z, l.many));
    check(cufftPlanMany(&backward_, l.rank, l.n, modes, 1, l.modes, real_rows, 1, 2 * l.modes, single ? CUFFT_C2R : CUFFT_Z2D, l.many));
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

  void forward(float *f) const { check(cufftExecR2C(forward_, f, reinterpret_cast<cufftComplex *>(f))); }
  void forward(double *f) const { check(cufftExecD2Z(forward_, f, reinterpret_cast<cufftDoubleComplex *>(f))); }
  void backward(float *f) const { check(cufftExecC2R(backward_, reinterpret_cast<cufftComplex *>(f), f)); }
  void backward(double *f) const { check(cufftExecZ2D(backward_, reinterpret_cast<cufftDoubleComplex *>(f), f)); }
  std::size_t memory() const { return memory_; }

 private:
  static void check(cufftResult r)
  {
    if (r != CUFFT_SUCCESS) throw std::runtime_error("cuFFT failed with code " + std::to_string(static_cast<int>(r)));
  }

  cufftHandle forward_ = 0, backward_ = 0;
  std::size_t memory_ = 0;
};
#endif

}    // namespace bdh
#endif
