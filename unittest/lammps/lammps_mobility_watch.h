// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Compares the velocities of every step with M F for the particles, the box and the forces at the
/// beginning of the step.  M F is computed by direct Ewald sums, or comes from another reference.
#ifndef BDH_TEST_LAMMPS_MOBILITY_WATCH_H
#define BDH_TEST_LAMMPS_MOBILITY_WATCH_H

#include "force.h"
#include "group.h"
#include "lammps/lammps_mobility.h"

#include <algorithm>
#include <vector>

namespace bdh_test {

/// A fix of LAMMPS that sees each step before and after our fix; it must be defined before that
/// one, with its group.  Any number of ranks.
class FixStepWatch : public LAMMPS_NS::Fix {
 public:
  FixStepWatch(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg)
  {
    time_integrate = 0;
    dynamic_group_allow = 1;
  }

  int setmask() override
  {
    return LAMMPS_NS::FixConst::INITIAL_INTEGRATE | LAMMPS_NS::FixConst::FINAL_INTEGRATE;
  }

  void initial_integrate(int) override
  {
    particles_ = gathered([&](int i, double *p) {
      if (!(atom->mask[i] & groupbit)) return;
      domain->unmap(atom->x[i], atom->image[i], p);
      for (int d = 0; d < 3; ++d) p[3 + d] = force->ftm2v * atom->f[i][d];
      p[6] = atom->radius ? atom->radius[i] : 0.0;
      p[7] = 1.0;
    });
    cell_ = cell_of(*domain);
  }

  /// By now atoms may have moved to another rank or disappeared.
  void final_integrate() override
  {
    const std::vector<double> after = gathered([&](int i, double *p) {
      std::copy_n(atom->v[i], 3, p);
      p[7] = 1.0;
    });
    std::vector<double> x, f, v, u;
    double radius = 0.0;
    for (size_t k = 0; k < particles_.size(); k += width)
      if (particles_[k + 7] > 0.0) {
        x.insert(x.end(), &particles_[k], &particles_[k] + 3);
        f.insert(f.end(), &particles_[k + 3], &particles_[k + 3] + 3);
        radius = particles_[k + 6];
      }
    if (x.empty()) return;
    const std::vector<double> right = reference(cell_, x, f, radius);
    for (size_t k = 0, p = 0; k < particles_.size(); k += width) {
      if (!(particles_[k + 7] > 0.0)) continue;
      if (k < after.size() && after[k + 7] > 0.0) {
        u.insert(u.end(), &right[p], &right[p] + 3);
        v.insert(v.end(), &after[k], &after[k] + 3);
      }
      p += 3;
    }
    if (u.empty()) return;
    ++steps;
    most_particles = std::max(most_particles, x.size() / 3);
    if (length_of(u) > 0.0) worst = std::max(worst, relative_error(v, u));
  }

  int steps = 0;    ///< compared so far
  double worst = 0.0;
  size_t most_particles = 0;

 protected:
  /// Collective.  Velocities of particles at x under forces f, in consistent units.  radius: that
  /// of the atoms, 0 if they have none.
  virtual std::vector<double> reference(const bdh::Cell &cell, const std::vector<double> &x,
                                        const std::vector<double> &f, double radius) = 0;

 private:
  static constexpr int width = 8;

  /// Eight numbers of each atom, ordered by id, on every rank; 0 for ids that do not exist.
  template <class Get> std::vector<double> gathered(Get get) const
  {
    LAMMPS_NS::tagint mine = 0, last = 0;
    for (int i = 0; i < atom->nlocal; ++i) mine = std::max(mine, atom->tag[i]);
    MPI_Allreduce(&mine, &last, 1, MPI_LMP_TAGINT, MPI_MAX, world);
    std::vector<double> here(width * last, 0.0), all(here.size());
    for (int i = 0; i < atom->nlocal; ++i) get(i, &here[width * (atom->tag[i] - 1)]);
    MPI_Allreduce(here.data(), all.data(), all.size(), MPI_DOUBLE, MPI_SUM, world);
    return all;
  }

  std::vector<double> particles_;    // when the step began: x, F, radius, 1 if it is in the group
  bdh::Cell cell_;
};

/// Direct Ewald sums:
///
///     fix ID group bdh/watch radius viscosity
///
/// radius 0: that of the atoms.
class FixMobilityWatch : public FixStepWatch {
 public:
  FixMobilityWatch(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg) :
      FixStepWatch(lmp, narg, arg), radius_(std::stod(arg[3])), viscosity_(std::stod(arg[4]))
  {}

 protected:
  std::vector<double> reference(const bdh::Cell &cell, const std::vector<double> &x,
                                const std::vector<double> &f, double radius) override
  {
    std::vector<double> u(x.size());
    bdh::dense_apply(cell, x.data(), x.size() / 3, radius_ > 0.0 ? radius_ : radius,
                     viscosity_ * force->vxmu2f * force->ftm2v, f.data(), u.data());
    return u;
  }

 private:
  double radius_, viscosity_;
};

/// Registers the style bdh/watch in a session.
inline void add_mobility_watch(LammpsSession &lmp)
{
  (*lmp->modify->fix_map)["bdh/watch"] = [](LAMMPS_NS::LAMMPS *l, int narg,
                                            char **arg) -> LAMMPS_NS::Fix * {
    return new FixMobilityWatch(l, narg, arg);
  };
}

inline const FixStepWatch &mobility_watch(LammpsSession &lmp, const std::string &id)
{
  return *static_cast<FixStepWatch *>(lmp.fix(id));
}

}    // namespace bdh_test
#endif
