/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_adaptive_steps.h"

#include "base/comm.h"
#include "comm.h"
#include "error.h"
#include "update.h"

using namespace LAMMPS_NS;

void AdaptiveSteps::set(double tolerance, bool near, AtomGroup &group, StiffnessMonitor &stiffness)
{
  near_ = near;
  choice_ = bdh::PieceChoice(tolerance);
  stiffness.set_pieces(choice_.acts());
  if (!take_pieces()) return;
  group.need_forces_within_step(AtomGroup::ForcesFor::pieces);
}

double AdaptiveSteps::time_of_forces() const { return take_pieces() ? choice_.time() : update->dt; }

void AdaptiveSteps::end_step(double change)
{
  if (take_pieces()) choice_.end(bdh::Comm(world).greatest(change));
}

void AdaptiveSteps::describe(PlanText &text) const
{
  if (!choice_.acts()) return;
  text.line("adapt", fmt::format("{}, chosen beforehand: the change of forces within one is to "
                                 "move no particle by more than {} radii",
                                 near_ ? "near steps" : "steps in pieces", choice_.tolerance()));
}

void AdaptiveSteps::show()
{
  const bdh::PieceChoice::Seen seen = choice_.seen();
  choice_.clear();
  if (seen.pieces == 0.0 || comm->me) return;
  std::string text = fmt::format("{}: adapt: {:.3g} {} a step on average; the change of forces "
                                 "within a piece moves a particle by {:.2g} radii at most",
                                 name_, seen.pieces / MAX(update->nsteps, 1),
                                 near_ ? "near steps" : "pieces", seen.largest);
  if (seen.retries > 0.0) text += fmt::format("; {:.0f} pieces were halved again", seen.retries);
  utils::logmesg(lmp, text + "\n");
  if (seen.retries > 1e-5 * seen.pieces)
    error->warning(
        FLERR,
        "{}: {:.0f} of {:.0f} pieces were taken back and halved, since they would have "
        "ended the run, or led to forces that no piece could follow; more than one in "
        "100000 biases the noise: use a smaller tolerance of adapt, or a smaller timestep",
        name_, seen.retries, seen.pieces);
}
