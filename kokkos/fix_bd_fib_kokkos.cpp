/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/, Sandia National Laboratories

   This software is distributed under the GNU General Public License.
------------------------------------------------------------------------- */

#include "fix_bd_fib_kokkos.h"

#include "bdh_lammps_kokkos.h"

using namespace LAMMPS_NS;

FixBDFibKokkos::FixBDFibKokkos(LAMMPS *lmp, int narg, char **arg) : FixBDFib(lmp, narg, arg)
{
  use_kokkos(this, lmp, name_);
}

const bdh::Workers &FixBDFibKokkos::workers() const { return bdh::host_workers(); }

std::string FixBDFibKokkos::plan_text() const
{
  std::string text = FixBDFib::plan_text() + fmt::format("  {:<10} {}\n", "threads", threads_text());
  if (workers().count() > 1 && !bdh::solver_has_workers(bdh::solver_kind(grid())))
    text += "             the solver between walls works on one of them: give it processes rather than threads\n";
  return text;
}
