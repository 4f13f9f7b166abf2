// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// How much this process sends to others: exact counts, which only grow.
#ifndef BDH_BASE_TRAFFIC_H
#define BDH_BASE_TRAFFIC_H

#include <cstdint>

namespace bdh {

/// Counts of a thread since it began; what a part of a run sends is a difference of two.
struct Traffic {
  int64_t messages = 0;    ///< to other ranks; an empty one, or one to oneself, is none
  int64_t bytes = 0;       ///< in these
  int64_t sums = 0;        ///< collective sums and maxima of a few numbers, not in the above

  static Traffic &mine()
  {
    thread_local Traffic traffic;
    return traffic;
  }

  void add_message(int64_t size)
  {
    ++messages;
    bytes += size;
  }
  /// Takes back one message that was not sent after all.
  void remove_message(int64_t size)
  {
    --messages;
    bytes -= size;
  }
  Traffic since(const Traffic &before) const
  {
    return {messages - before.messages, bytes - before.bytes, sums - before.sums};
  }
  void add(const Traffic &other)
  {
    messages += other.messages;
    bytes += other.bytes;
    sums += other.sums;
  }
};

}    // namespace bdh
#endif
