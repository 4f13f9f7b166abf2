/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_pse_restart.h"

#include <cmath>
#include <cstring>
#include <tuple>
#include <type_traits>

using namespace LAMMPS_NS;

namespace {

constexpr int version = 6;    // raise it when the meaning of a plan's members changes

/// Calls f for every number of a structure, in order.  The lists of members must be complete, or
/// else this does not compile.
template <class F> class Numbers {
 public:
  explicit Numbers(F f) : f_(f) {}

  template <class T> void of(T &v) const
  {
    using Type = std::remove_const_t<T>;
    if constexpr (std::is_arithmetic_v<Type> || std::is_enum_v<Type>) {
      f_(v);
    } else if constexpr (std::is_same_v<Type, PseRestart>) {
      auto &[plan, made_for, split_price, narrow] = v;
      of_all(plan, made_for, split_price, narrow);
    } else if constexpr (std::is_same_v<Type, bdh::PsePlan>) {
      of_plan(v);
    } else if constexpr (std::is_same_v<Type, bdh::PseScene>) {
      of_members(bdh::PseScene::members(v));
    } else if constexpr (std::is_same_v<Type, bdh::RadiusClasses>) {
      of_members(bdh::RadiusClasses::members(v));
    } else if constexpr (std::is_same_v<Type, bdh::PseErrors>) {
      auto &[real_space, wave_space, window, rounding] = v;
      of_all(real_space, wave_space, window, rounding);
    } else if constexpr (std::is_same_v<Type, bdh::Window>) {
      auto &[width, beta, continuous] = v;
      of_all(width, beta, continuous);
    } else {    // an array
      for (auto &x : v) of(x);
    }
  }

 private:
  template <class... T> void of_all(T &...v) const { (of(v), ...); }
  template <class Members> void of_members(const Members &members) const
  {
    std::apply([this](auto &...v) { of_all(v...); }, members);
  }
  template <class Plan> void of_plan(Plan &plan) const
  {
    auto &[radius, volume, least_radius, rotation, stresslets, hydrodynamics, tolerance,
           root_tolerance, splitting, xi, r_cut, k_cut, spacing, n, window, window_error,
           table_error, single, errors, neighbors, most_neighbors, modes, iterations, real_seconds,
           wave_seconds, grid_bytes, pair_bytes, limit] = plan;
    of_all(radius, volume, least_radius, rotation, stresslets, hydrodynamics, tolerance,
           root_tolerance, splitting, xi);
    of_all(r_cut, k_cut, spacing, n, window);
    of_all(window_error, table_error, single, errors, neighbors, most_neighbors, modes, iterations);
    of_all(real_seconds, wave_seconds, grid_bytes, pair_bytes, limit);
  }

  F f_;
};

bool is_sound(const bdh::PsePlan &plan)
{
  if (!(plan.least_radius > 0.0 && plan.radius >= plan.least_radius)) return false;
  if (!plan.hydrodynamics) return true;
  const bool split =
      plan.splitting == bdh::Splitting::hasimoto || plan.splitting == bdh::Splitting::kaiser_bessel;
  return split && plan.xi > 0.0 && std::isfinite(plan.xi) && plan.r_cut > 0.0 &&
         std::isfinite(plan.r_cut) && plan.spacing > 0.0 &&
         bdh::Window::is_width(plan.window.width, plan.single) && plan.n[0] > 0 && plan.n[1] > 0 &&
         plan.n[2] > 0;
}

}    // namespace

std::vector<char> LAMMPS_NS::bytes_of(const PseRestart &restart)
{
  std::vector<char> bytes;
  const auto append = [&](const auto &number) {
    char own[sizeof number];
    memcpy(own, &number, sizeof number);
    bytes.insert(bytes.end(), own, own + sizeof number);
  };
  append(version);
  Numbers(append).of(restart);
  return bytes;
}

bool LAMMPS_NS::from_bytes(const char *bytes, std::size_t size, PseRestart &restart)
{
  if (size != bytes_of({}).size()) return false;
  const auto take = [&](auto &number) {
    memcpy(&number, bytes, sizeof number);
    bytes += sizeof number;
  };
  int its_version = 0;
  take(its_version);
  if (its_version != version) return false;
  PseRestart read;
  Numbers(take).of(read);
  if (!is_sound(read.plan)) return false;
  restart = read;
  return true;
}
