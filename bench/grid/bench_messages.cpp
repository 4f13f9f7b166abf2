// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Times of messages: every rank sends as much to each other one, as in the hand-over of a grid,
/// and of collective sums.
///
///     mpirun -n 2 bench_messages [largest message in MB, default 64]
///
/// Times are medians over repetitions on the slowest rank.  The last two lines have the latency and
/// the bandwidth of a rank, as bench/scaling_model.py takes them.
#include "base/aligned.h"
#include "base/comm.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

using namespace bdh;

namespace {

/// Seconds that `action` takes on the slowest rank, median of `repetitions`.
template <class Action> double seconds(const Comm &comm, int repetitions, Action action)
{
  using Clock = std::chrono::steady_clock;
  std::vector<double> times;
  for (int i = 0; i < repetitions; ++i) {
    comm.sum(0.0);    // all begin together
    const Clock::time_point begin = Clock::now();
    action();
    times.push_back(comm.greatest(std::chrono::duration<double>(Clock::now() - begin).count()));
  }
  std::nth_element(times.begin(), times.begin() + repetitions / 2, times.end());
  return times[repetitions / 2];
}

void measure(const Comm &comm, long most)
{
  const long others = comm.size() - 1;
  double latency = 0.0, bandwidth = 0.0;
  if (comm.rank() == 0) std::printf("%12s %14s %12s\n", "bytes", "time [us]", "GB/s a rank");
  for (long bytes = 8; bytes <= most; bytes *= 8) {
    const int numbers = bytes / sizeof(double);
    const MessageSizes sizes(std::vector<int>(comm.size(), numbers), 1);
    AlignedVector from(numbers * comm.size(), 1.0), to(numbers * comm.size(), 0.0);
    const int repetitions = std::clamp<long>(200000000 / bytes, 7, 2001);
    const double time =
        seconds(comm, repetitions, [&] { comm.exchange(from.data(), sizes, to.data(), sizes); });
    const double rate = bytes * others / time;
    if (comm.rank() == 0) std::printf("%12ld %14.2f %12.2f\n", bytes, 1e6 * time, 1e-9 * rate);
    if (bytes == 8) latency = time / others;
    bandwidth = rate;
  }
  const double sum = seconds(comm, 2001, [&] { comm.sum(1.0); });
  if (comm.rank() > 0) return;
  std::printf("a sum takes %.2f us\n", 1e6 * sum);
  std::printf("latency of a message %.2f us\nbandwidth of a rank %.2f GB/s\n", 1e6 * latency,
              1e-9 * bandwidth);
}

}    // namespace

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  const Comm comm(MPI_COMM_WORLD);
  if (comm.size() == 1)
    std::fprintf(stderr, "run it on several ranks: mpirun -n 2 bench_messages\n");
  else
    measure(comm, 1000000L * (argc > 1 ? std::atol(argv[1]) : 64));
  MPI_Finalize();
}
