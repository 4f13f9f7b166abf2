// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Compares M F from LAMMPS with the dense oracle at the current positions: forces by atom id, and
/// cells.
#ifndef BDH_TEST_LAMMPS_MOBILITY_H
#define BDH_TEST_LAMMPS_MOBILITY_H

#include "fix_external.h"
#include "lammps/lammps_session.h"
#include "oracle/dense_rpy.h"

#include <cmath>
#include <functional>
#include <random>

namespace bdh_test {

/// Calls a function of the test whenever LAMMPS evaluates forces, and adds its result to them.
/// There can be one in each session.
class AtForces {
 public:
  struct Call {
    LAMMPS_NS::bigint step;
    int atoms;    // number on this rank
    const LAMMPS_NS::tagint *id;
    double **x, **force;
  };
  AtForces(LammpsSession &lmp, std::function<void(const Call &)> function) :
      function_(std::move(function))
  {
    lmp.command("fix at_forces all external pf/callback 1 1");
    static_cast<LAMMPS_NS::FixExternal *>(lmp.fix("at_forces"))
        ->set_callback(&AtForces::called, this);
  }
  AtForces(const AtForces &) = delete;
  AtForces &operator=(const AtForces &) = delete;

 private:
  static void called(void *self, LAMMPS_NS::bigint step, int n, LAMMPS_NS::tagint *id, double **x,
                     double **f)
  {
    for (int i = 0; i < n; ++i)
      for (int d = 0; d < 3; ++d) f[i][d] = 0.0;
    static_cast<AtForces *>(self)->function_({step, n, id, x, f});
  }
  std::function<void(const Call &)> function_;
};

/// Constant forces by atom id, 3 numbers each.  The object must outlive the runs.
class GivenForces {
 public:
  GivenForces(LammpsSession &lmp, std::vector<double> force) :
      force_(std::move(force)), hook_(lmp, [this](const AtForces::Call &call) {
        for (int i = 0; i < call.atoms; ++i)
          for (int d = 0; d < 3; ++d) call.force[i][d] = force_[3 * (call.id[i] - 1) + d];
      })
  {}
  const std::vector<double> &operator()() const { return force_; }

 private:
  std::vector<double> force_;
  AtForces hook_;
};

inline std::vector<double> random_vector(size_t n, unsigned seed)
{
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<double> v(n);
  for (double &a : v) a = normal(engine);
  return v;
}

/// Commands for the region and the box of a cell with corner `lo`, for one type of atom.
inline std::string box_commands(const bdh::Cell &c)
{
  const bool tilted = c.xy != 0.0 || c.xz != 0.0 || c.yz != 0.0;
  std::string line = tilted ? "region box prism" : "region box block";
  const double length[3] = {c.lx, c.ly, c.lz};
  for (int d = 0; d < 3; ++d) line += " " + text(c.lo[d]) + " " + text(c.lo[d] + length[d]);
  if (tilted) line += " " + text(c.xy) + " " + text(c.xz) + " " + text(c.yz);
  return line + " units box\ncreate_box 1 box\n";
}

/// Creates atoms 1 ... n at x, which LAMMPS wraps into the box.  For one rank.
inline void create_atoms(LammpsSession &lmp, const std::vector<double> &x)
{
  const size_t n = x.size() / 3;
  lmp.command("create_atoms 1 random " + std::to_string(n) + " 12345 NULL");
  LAMMPS_NS::Atom &atom = *lmp->atom;
  for (int i = 0; i < atom.nlocal; ++i) {
    for (int d = 0; d < 3; ++d) atom.x[i][d] = x[3 * (atom.tag[i] - 1) + d];
    lmp->domain->remap(atom.x[i], atom.image[i]);
  }
}

inline bdh::Cell cell_of(const LAMMPS_NS::Domain &domain)
{
  bdh::Cell c;
  for (int d = 0; d < 3; ++d) c.lo[d] = domain.boxlo[d];
  c.lx = domain.boxhi[0] - domain.boxlo[0];
  c.ly = domain.boxhi[1] - domain.boxlo[1];
  c.lz = domain.boxhi[2] - domain.boxlo[2];
  c.xy = domain.xy;
  c.xz = domain.xz;
  c.yz = domain.yz;
  return c;
}

inline bdh::Cell cell_of(LammpsSession &lmp) { return cell_of(*lmp->domain); }

/// M F of all atoms at their current positions, by direct Ewald sums.
inline std::vector<double> exact_velocities(LammpsSession &lmp, double radius, double viscosity,
                                            const std::vector<double> &force)
{
  const std::vector<double> x = lmp.unwrapped_positions();
  std::vector<double> u(x.size());
  bdh::dense_apply(cell_of(lmp), x.data(), x.size() / 3, radius, viscosity, force.data(), u.data());
  return u;
}

inline double length_of(const std::vector<double> &v)
{
  double s = 0.0;
  for (double a : v) s += a * a;
  return std::sqrt(s);
}

/// |u - exact|/|exact|
inline double relative_error(const std::vector<double> &u, const std::vector<double> &exact)
{
  if (u.size() != exact.size()) return 1e300;
  std::vector<double> difference(u);
  for (size_t i = 0; i < u.size(); ++i) difference[i] -= exact[i];
  return length_of(difference) / length_of(exact);
}

}    // namespace bdh_test
#endif
