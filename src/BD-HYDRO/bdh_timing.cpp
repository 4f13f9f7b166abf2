/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_timing.h"

#include "comm.h"
#include "input.h"
#include "timer.h"
#include "update.h"

#include <cmath>
#include <cstring>

using namespace LAMMPS_NS;

bool TimingTable::is_silent_run() const
{
  if (!timer->has_normal()) return true;
  for (int k = 0; k + 1 < input->narg; ++k)
    if (strcmp(input->arg[k], "post") == 0 && strcmp(input->arg[k + 1], "no") == 0) return true;
  return false;
}

/// The time of a phase over the ranks, in LAMMPS' own format; empty if no rank spent any in it.
/// Collective.
std::string TimingTable::line(int phase, double all) const
{
  double mine[2] = {times_[phase], times_[phase] * times_[phase]}, range[2] = {-mine[0], mine[0]};
  double sum[2], extreme[2];    // minus the least, and the greatest
  MPI_Allreduce(mine, sum, 2, MPI_DOUBLE, MPI_SUM, world);
  MPI_Allreduce(range, extreme, 2, MPI_DOUBLE, MPI_MAX, world);
  const double average = sum[0] / comm->nprocs;
  if (extreme[1] == 0.0) return "";
  const double spread = sum[1] / comm->nprocs / average - average;
  const bool varies = average > 0.001 && spread > 1e-10;
  return fmt::format("{:<8s}| {:<10.5g} | {:<10.5g} | {:<10.5g} |{:6.1f} |{:6.2f}\n",
                     bdh::phase_name(phase), -extreme[0], average, extreme[1],
                     varies ? 100.0 * std::sqrt(spread) : 0.0, 100.0 * average / all);
}

/// Mean and greatest numbers over the ranks, per step; empty on one rank.  Collective.
std::string TimingTable::traffic_line() const
{
  if (comm->nprocs == 1 || update->nsteps == 0) return "";
  const double steps = update->nsteps;
  const double mine[3] = {traffic_.messages / steps, traffic_.bytes / steps, traffic_.sums / steps};
  double mean[3], greatest[3];
  MPI_Allreduce(mine, mean, 3, MPI_DOUBLE, MPI_SUM, world);
  MPI_Allreduce(mine, greatest, 3, MPI_DOUBLE, MPI_MAX, world);
  for (double &m : mean) m /= comm->nprocs;
  return fmt::format("Sent per step and process, mean (most): {:.6g} ({:.6g}) messages, "
                     "{:.6g} ({:.6g}) bytes; {:.6g} ({:.6g}) sums\n",
                     mean[0], greatest[0], mean[1], greatest[1], mean[2], greatest[2]);
}

void TimingTable::show(const char *id, const char *style) const
{
  double mine = 0.0, all = 0.0;
  for (double t : times_) mine += t;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  if (is_silent_run() || all == 0.0) return;
  all /= comm->nprocs;
  std::string text =
      fmt::format("\nTiming breakdown of fix {} {}: {:.6g} s for {} steps\n"
                  "Section |  min time  |  avg time  |  max time  |%varavg| %total\n"
                  "---------------------------------------------------------------\n",
                  id, style, all, update->nsteps);
  for (int p = 0; p < bdh::phase_count; ++p) text += line(p, all);
  text += traffic_line();
  if (comm->me == 0) utils::logmesg(lmp, text + "\n");
}
