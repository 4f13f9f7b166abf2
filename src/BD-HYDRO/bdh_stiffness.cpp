/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_stiffness.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "force.h"
#include "update.h"

#include <cmath>

using namespace LAMMPS_NS;

/* ----------------------------------------------------------------------
   forces at both ends of a step
------------------------------------------------------------------------- */

void HostForceWatch::keep()
{
  for (int i = 0; i < atom->nlocal; ++i) {
    double *kept = columns_.of(column_, i);
    const bool mine = atom->mask[i] & groupbit_;
    for (int d = 0; d < 3; ++d) kept[d] = mine ? atom->f[i][d] : 0.0;
    kept[3] = mine ? 1.0 : 0.0;
  }
  if (group_.pieces()) keep_piece();
}

void HostForceWatch::keep_piece()
{
  const std::vector<int> &atoms = group_.atoms();
  const std::vector<double> &before = group_.pieces()->force_before(atoms),
                            &velocity = group_.pieces()->last_velocity();
  for (size_t p = 0; p < atoms.size(); ++p)
    for (int d = 0; d < 3; ++d) {
      columns_.of(column_, atoms[p])[d] = before[3 * p + d] / force->ftm2v;
      columns_.of(column_, atoms[p])[4 + d] = velocity[3 * p + d];
    }
}

SeenStiffness HostForceWatch::compare(const bdh::StiffnessScale &scale, bool radii)
{
  const double to_core = force->ftm2v;
  local_.clear();
  for (int i = 0; i < atom->nlocal; ++i)
    if (columns_.of(column_, i)[3] > 0.0) local_.push_back(i);
  before_.resize(3 * local_.size());
  after_.resize(before_.size());
  velocity_.resize(before_.size());
  radius_.resize(radii ? local_.size() : 0);
  for (size_t p = 0; p < local_.size(); ++p) {
    const int i = local_[p];
    for (int d = 0; d < 3; ++d) {
      before_[3 * p + d] = to_core * columns_.of(column_, i)[d];
      after_[3 * p + d] = to_core * atom->f[i][d];
      velocity_[3 * p + d] = group_.pieces() ? columns_.of(column_, i)[4 + d] : atom->v[i][d];
    }
    if (radii) radius_[p] = atom->radius[i];
  }
  SeenStiffness seen;
  seen.step = bdh::stiffness_of_step(
      bdh::HostExecution(), local_.size(),
      {scale, before_.data(), after_.data(), velocity_.data(), radii ? radius_.data() : nullptr});
  if (seen.step.stiffest >= 0) seen.atom = atom->tag[local_[seen.step.stiffest]];
  return seen;
}

/* ----------------------------------------------------------------------
   what the schemes make of it
------------------------------------------------------------------------- */

double LAMMPS_NS::excess_of_euler(double p) { return p < 2.0 ? p / (2.0 - p) : HUGE_VAL; }

/// From the variance of FIB eq. (38) for a linear force, (2 - 2p + p^2)/(2 - 2p + p^2 - p^3/4).
double LAMMPS_NS::excess_of_improved(double p)
{
  const double exact = 2.0 - 2.0 * p + p * p, rest = exact - 0.25 * p * p * p;
  return rest > 0.0 ? exact / rest - 1.0 : HUGE_VAL;
}

/// That of a linear force is exact.
double LAMMPS_NS::excess_of_split(double p) { return p < 2.0 ? 0.0 : HUGE_VAL; }

/* ----------------------------------------------------------------------
   the monitor
------------------------------------------------------------------------- */

void StiffnessMonitor::Sums::add(const SeenStiffness &seen, bigint now)
{
  reaction += seen.step.reaction;
  work += seen.step.work;
  if (!(seen.step.largest > largest)) return;
  largest = seen.step.largest;
  atom = seen.atom;
  step = now;
}

StiffnessMonitor::Sums StiffnessMonitor::over_ranks(const Sums &mine) const
{
  Sums all;
  const double sums[2] = {mine.reaction, mine.work};
  double of_all[2];
  MPI_Allreduce(sums, of_all, 2, MPI_DOUBLE, MPI_SUM, world);
  all.reaction = of_all[0];
  all.work = of_all[1];
  MPI_Allreduce(&mine.largest, &all.largest, 1, MPI_DOUBLE, MPI_MAX, world);
  const bool has_it = mine.largest == all.largest;
  const double where[2] = {has_it ? mine.atom : 0.0, has_it ? mine.step : 0.0};
  MPI_Allreduce(where, of_all, 2, MPI_DOUBLE, MPI_MAX, world);
  all.atom = of_all[0];
  all.step = of_all[1];
  return all;
}

void StiffnessMonitor::begin_run()
{
  lately_ = run_ = Sums();
  steps_lately_ = 0;
}

void StiffnessMonitor::add(const SeenStiffness &seen)
{
  last_ = Sums();
  for (Sums *sums : {&last_, &lately_, &run_}) sums->add(seen, update->ntimestep);
  if (++steps_lately_ < 100) return;
  warn();
  lately_ = Sums();
  steps_lately_ = 0;
}

double StiffnessMonitor::mean() const
{
  const Sums all = over_ranks(last_);
  return bdh::mean_stiffness(all.reaction, all.work);
}

double StiffnessMonitor::largest() const { return over_ranks(last_).largest; }

/// A time step for p = 0.1, which gives an excess of 5 %.
std::string StiffnessMonitor::advice(double p) const
{
  if (in_pieces_) return "use a smaller tolerance of adapt";
  return fmt::format("use timestep {:.1g} for 5 %, or adapt", update->dt * 0.1 / p);
}

void StiffnessMonitor::warn()
{
  if (warned_) return;
  const Sums all = over_ranks(lately_);
  const double p = bdh::mean_stiffness(all.reaction, all.work);
  if (!(p >= 0.5)) return;
  warned_ = true;
  if (comm->me == 0)
    error->warning(
        FLERR,
        "{}: step {}: forces are too stiff for the time step: contacts have p = {:.2g} on "
        "average and {:.2g} at most (atom {:.0f}), where p = 2 is the limit of "
        "stability: {}",
        name_, update->ntimestep, p, all.largest, all.atom, advice(p));
}

void StiffnessMonitor::show()
{
  const Sums all = over_ranks(run_);
  const double p = bdh::mean_stiffness(all.reaction, all.work);
  if (p == 0.0 || comm->me) return;
  const double excess = excess_(p);
  std::string text =
      fmt::format("{}: stiffness of contacts{}: p = {:.2g} on average, {:.2g} at most (atom "
                  "{:.0f}, step {:.0f})",
                  name_, pieces_ > 1 ? " in near steps" : "", p, all.largest, all.atom, all.step);
  if (excess == HUGE_VAL)
    text += ": not stable: " + advice(p);
  else if (excess >= 0.01)
    text +=
        fmt::format("; such distances fluctuate {:.2g} % too much: {}", 100.0 * excess, advice(p));
  utils::logmesg(lmp, text + "\n");
}
