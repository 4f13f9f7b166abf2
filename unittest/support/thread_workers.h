// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Any number of workers made of plain threads.  Tests can compare one thread with several within a
/// process, and ThreadSanitizer, which does not understand an OpenMP runtime, can check them.
#ifndef BDH_TEST_THREAD_WORKERS_H
#define BDH_TEST_THREAD_WORKERS_H

#include "base/workers.h"

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace bdh_test {

class ThreadWorkers : public bdh::Workers {
 public:
  explicit ThreadWorkers(int count) : count_(count) {}
  int count() const override { return count_; }
  void run(long tasks, const std::function<void(long, int)> &task) const override
  {
    std::atomic<long> next{0};
    std::mutex mutex;
    std::exception_ptr failure;
    std::vector<std::thread> threads;
    for (int worker = 0; worker < count_; ++worker)
      threads.emplace_back([&, worker] {
        for (long i = next++; i < tasks; i = next++) {
          try {
            task(i, worker);
          } catch (...) {
            const std::lock_guard<std::mutex> lock(mutex);
            failure = std::current_exception();
          }
        }
      });
    for (std::thread &t : threads) t.join();
    if (failure) std::rethrow_exception(failure);
  }

 private:
  int count_;
};

}    // namespace bdh_test
#endif
