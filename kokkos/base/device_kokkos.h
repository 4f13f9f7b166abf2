// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Arrays and loops of the core in a Kokkos execution space: the basis of the device side of every
/// method.
#ifndef BDH_BASE_DEVICE_KOKKOS_H
#define BDH_BASE_DEVICE_KOKKOS_H

#include "base/portable.h"

#include <Kokkos_Core.hpp>

#include <cstddef>
#include <vector>

namespace bdh {

/// True if the host can read the memory of Exec.
template <class Exec> constexpr bool host_memory =
    Kokkos::SpaceAccessibility<Kokkos::HostSpace, typename Exec::memory_space>::accessible;

/// Contiguous numbers in the memory of Exec.  The array never gives up capacity.  Numbers added by
/// resize() have arbitrary values.
template <class T, class Exec> class DeviceArray {
 public:
  using value_type = T;
  using View = Kokkos::View<T *, typename Exec::memory_space>;
  using HostView = Kokkos::View<T *, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>>;
  using ConstHostView =
      Kokkos::View<const T *, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>>;

  DeviceArray() = default;
  explicit DeviceArray(const std::vector<T> &from) { assign(from.data(), from.size()); }

  T *data() const { return array_.data(); }
  std::size_t size() const { return size_; }
  std::size_t capacity() const { return array_.extent(0); }
  bool empty() const { return size_ == 0; }
  /// The numbers are lost if the array grows beyond its capacity.
  void resize(std::size_t size)
  {
    if (size > capacity())
      array_ = View(Kokkos::view_alloc(Kokkos::WithoutInitializing, "bdh"), size + size / 8);
    size_ = size;
  }
  void swap(DeviceArray &other)
  {
    std::swap(array_, other.array_);
    std::swap(size_, other.size_);
  }
  void clear_values()
  {
    if (size_) Kokkos::deep_copy(part(), T(0));
  }
  /// These functions copy to and from the host, and wait for the device.
  void assign(const T *from, std::size_t size)
  {
    resize(size);
    if (size) Kokkos::deep_copy(part(), ConstHostView(from, size));
  }
  void copy_to(T *to) const
  {
    if (size_) Kokkos::deep_copy(HostView(to, size_), part());
  }
  std::vector<T> to_host() const
  {
    std::vector<T> v(size_);
    copy_to(v.data());
    return v;
  }

 private:
  View part() const { return Kokkos::subview(array_, std::make_pair(std::size_t(0), size_)); }

  View array_;
  std::size_t size_ = 0;
};

/// Calls action(i) for i = 0 .. n - 1, all concurrently.  Later work in the same space waits for
/// it.
template <class Exec, class Action> void device_for(const char *name, long n, const Action &action)
{
  if (n > 0)
    Kokkos::parallel_for(name, Kokkos::RangePolicy<Exec, Kokkos::IndexType<long>>(0, n), action);
}

/// Returns the sum that action(i, sum) adds to for i = 0 .. n - 1.  The order of summation depends
/// on the space.
template <class Exec, class Action>
double device_sum(const char *name, long n, const Action &action)
{
  double sum = 0.0;
  if (n > 0)
    Kokkos::parallel_reduce(name, Kokkos::RangePolicy<Exec, Kokkos::IndexType<long>>(0, n), action,
                            sum);
  return sum;
}

/// Finds the greatest value of a term.
template <class Term> struct GreatestOf {
  Term term;
  BDH_FN void operator()(long i, double &greatest) const
  {
    const double value = term(i);
    if (value > greatest) greatest = value;
  }
};

/// Returns the greatest term(i) over i = 0 .. n - 1, and 0 if all are less.
template <class Exec, class Term> double device_greatest(const char *name, long n, const Term &term)
{
  double greatest = 0.0;
  if (n > 0)
    Kokkos::parallel_reduce(name, Kokkos::RangePolicy<Exec, Kokkos::IndexType<long>>(0, n),
                            GreatestOf<Term>{term}, Kokkos::Max<double>(greatest));
  return greatest > 0.0 ? greatest : 0.0;
}

/// Finds the smallest i for which a condition holds.
template <class Condition> struct FirstOf {
  Condition condition;
  BDH_FN void operator()(long i, long &first) const
  {
    if (i < first && condition(i)) first = i;
  }
};

/// Returns the smallest i in 0 .. n - 1 with condition(i), or -1.
template <class Exec, class Condition>
long device_first(const char *name, long n, const Condition &condition)
{
  long first = n;
  if (n > 0)
    Kokkos::parallel_reduce(name, Kokkos::RangePolicy<Exec, Kokkos::IndexType<long>>(0, n),
                            FirstOf<Condition>{condition}, Kokkos::Min<long>(first));
  return first < n ? first : -1;
}

}    // namespace bdh
#endif
