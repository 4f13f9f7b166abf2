// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Threads of a Kokkos execution space on the host, for the loops of the core.
#ifndef BDH_BASE_WORKERS_KOKKOS_H
#define BDH_BASE_WORKERS_KOKKOS_H

#include "base/workers.h"

#include <Kokkos_Core.hpp>
#include <exception>
#include <mutex>

namespace bdh {

/// Exec is Kokkos::Serial, Kokkos::OpenMP or Kokkos::Threads.  Kokkos must have been initialised.
template <class Exec> class KokkosWorkers : public Workers {
 public:
  KokkosWorkers() : token_() {}
  int count() const override { return Exec().concurrency(); }

  /// Tasks are handed out one by one, so that threads with short tasks do more of them.
  void run(long tasks, const std::function<void(long, int)> &task) const override
  {
    if (tasks == 0) return;
    std::mutex mutex;
    std::exception_ptr failure;
    long failed = tasks;
    const auto token = token_;
    Kokkos::parallel_for("bdh::KokkosWorkers", Policy(Exec(), 0, tasks, Kokkos::ChunkSize(1)),
                         [&](const long i) {
                           const int worker = token.acquire();
                           try {
                             task(i, worker);
                           } catch (...) {
                             const std::lock_guard<std::mutex> lock(mutex);
                             if (i < failed) {
                               failed = i;
                               failure = std::current_exception();
                             }
                           }
                           token.release(worker);
                         });
    Exec().fence();
    if (failure) std::rethrow_exception(failure);
  }

 private:
  using Policy =
      Kokkos::RangePolicy<Exec, Kokkos::Schedule<Kokkos::Dynamic>, Kokkos::IndexType<long>>;
  Kokkos::Experimental::UniqueToken<Exec> token_;
};

/// The workers of the host; the whole run uses one set.  It is never destroyed: after Kokkos has
/// been finalized that would be an error.
inline const Workers &host_workers()
{
  static const auto *const workers = new KokkosWorkers<Kokkos::DefaultHostExecutionSpace>;
  return *workers;
}

}    // namespace bdh
#endif
