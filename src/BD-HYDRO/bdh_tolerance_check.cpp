/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_tolerance_check.h"

#include "base/errors.h"
#include "base/rng_kernel.h"
#include "comm.h"
#include "error.h"

#include <cmath>

using namespace LAMMPS_NS;

void ToleranceCheck::prepare(const bdh::PsePlan &plan, bdh::PseScene scene)
{
  plan_ = plan;
  ready_ = true;
  scene.tolerance = MAX(0.01 * plan.tolerance, 1e-12);
  scene.xi = 0.0;
  scene.substeps = 0;    // no steps are taken with it
  scene.precision = bdh::Precision::double_precision;
  const double limit = scene.largest_cutoff;
  scene.largest_cutoff = plan.r_cut;
  try {
    reference_ = bdh::plan_pse(scene);
  } catch (const bdh::InvalidOption &) {
    scene.largest_cutoff = limit;
    reference_ = bdh::plan_pse(scene);
  }
}

double ToleranceCheck::norm(const std::vector<double> &v) const
{
  double mine = 0.0, all = 0.0;
  for (double x : v) mine += x * x;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return std::sqrt(all);
}

/// |u - exact|/|exact|, or 0 if exact is 0.
double ToleranceCheck::difference(std::vector<double> u, const std::vector<double> &exact) const
{
  const double scale = norm(exact);
  for (size_t k = 0; k < u.size(); ++k) u[k] -= exact[k];
  return scale > 0.0 ? norm(u) / scale : 0.0;
}

/// Velocities and, where particles turn, angular velocities, each by itself.
void ToleranceCheck::compare(const std::string &what, const std::vector<double> &u,
                             const std::vector<double> &exact)
{
  if (!plan_.rotation) return report(what, difference(u, exact));
  const auto half = [](const std::vector<double> &v, int which) {
    const auto middle = v.begin() + v.size() / 2;
    return which == 0 ? std::vector<double>(v.begin(), middle)
                      : std::vector<double>(middle, v.end());
  };
  report(what, difference(half(u, 0), half(exact, 0)));
  report("  angular velocities:", difference(half(u, 1), half(exact, 1)));
}

/// Forces on the particles, followed by torques if their mobility has some: rigid spheres need not
/// turn.
std::vector<double> ToleranceCheck::present_loads(const AtomGroup &group) const
{
  const size_t size = bdh::dof * group.size();
  std::vector<double> loads(group.force(), group.force() + size);
  if (!plan_.rotation) return loads;
  loads.resize(2 * size, 0.0);
  if (turns_) std::copy_n(group.torque(), size, loads.data() + size);
  return loads;
}

/// Normals; torques are those of forces at the least radius.
std::vector<double> ToleranceCheck::random_loads(const AtomGroup &group, uint32_t seed) const
{
  std::vector<double> loads;
  for (int turn = 0; turn <= (plan_.rotation ? 1 : 0); ++turn) {
    const bdh::NoiseCounter counter{seed, bdh::Stream::finite_difference, 0, uint32_t(turn)};
    const double scale = turn ? plan_.least_radius : 1.0;
    for (long i = 0; i < group.size(); ++i) {
      double spare, r[bdh::dof];
      bdh::normal4(counter, group.ids()[i], r[0], r[1], r[2], spare);
      for (double c : r) loads.push_back(scale * c);
    }
  }
  return loads;
}

void ToleranceCheck::report(const std::string &what, double achieved)
{
  worst_ = MAX(worst_, achieved);
  text_ += fmt::format("  error {:<34} {:.2g}{}\n", what, achieved,
                       achieved <= plan_.tolerance ? "" : "  (above the tolerance)");
}

void ToleranceCheck::run(PseEngine &engine, AtomGroup &group, const bdh::PseStepPlan &step)
{
  turns_ = step.rotation;
  engine.look_again();
  const auto own = engine.probe(nullptr, step.viscosity);
  auto reference = engine.probe(&reference_, step.viscosity);

  std::vector<double> present = present_loads(group), random = random_loads(group, step.seed);
  text_ = fmt::format("{}: check of the tolerance {:g} against a solve to {:g} (xi = {:.4g}, {} "
                      "x {} x {} points)\n",
                      name_, plan_.tolerance, reference_.tolerance, reference_.xi, reference_.n[0],
                      reference_.n[1], reference_.n[2]);
  worst_ = 0.0;
  if (norm(present) > 0.0)
    compare("of M F, forces as they are:", own->apply(present), reference->apply(present));
  compare("of M F, random forces:", own->apply(random), reference->apply(random));
  if (step.kT > 0.0) {
    // The same noise, computed with more Lanczos iterations.
    bdh::PsePlan further = plan_;
    further.root_tolerance = MAX(0.01 * plan_.tolerance, plan_.single ? 1e-6 : 1e-11);
    const bdh::PseNoise noise{1.0, step.seed, step.step};
    reference.reset();    // frees its grid, which may be the largest
    compare("of the noise, by Lanczos:", own->random(noise),
            engine.probe(&further, step.viscosity)->random(noise));
  }
  if (comm->me) return;
  utils::logmesg(lmp, text_);
  if (worst_ > plan_.tolerance)
    error->warning(FLERR,
                   "{}: the error reaches {:.2g} for these particles, but tolerance = {:g} was "
                   "requested: use {}",
                   name_, worst_, plan_.tolerance,
                   plan_.single ? "precision double, or a tighter tolerance"
                                : "a tighter tolerance");
}
