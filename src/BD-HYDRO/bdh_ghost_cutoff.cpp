/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_ghost_cutoff.h"

#include "bdh_lammps.h"
#include "comm.h"
#include "fix.h"
#include "force.h"
#include "modify.h"
#include "neighbor.h"
#include "pair.h"

using namespace LAMMPS_NS;

GhostCutoff::~GhostCutoff() noexcept
{
  if (may_lower()) comm->cutghostuser = others_;
}

/// True if nothing else has set the cutoff since.
bool GhostCutoff::is_own() const { return comm->cutghostuser == own_; }

void GhostCutoff::reach(double cutoff)
{
  if (is_own()) comm->cutghostuser = others_;
  others_ = comm->cutghostuser;
  own_ = 0.0;
  note_.clear();
  if (others_ >= cutoff) return;
  const double others = MAX(others_, force->pair ? force->pair->cutforce + neighbor->skin : 0.0);
  if (others < cutoff)
    note_ = fmt::format("kept within {:.4g} of each process' domain (the pair style and "
                        "comm_modify ask for {:.4g})",
                        cutoff, others);
  comm->cutghostuser = own_ = cutoff;
}

/// Another fix of this kind has asked for nothing if this one's cutoff was enough for both.
bool GhostCutoff::may_lower() const
{
  int fixes = 0;
  for (int f = 0; f < modify->nfix; ++f) {
    const Fix *fix = modify->fix[f];    // null while it is being replaced
    if (fix) fixes += is_style(fix->style, pse_styles);
  }
  return fixes <= 1 && is_own();
}

void GhostCutoff::shorten(double cutoff)
{
  if (may_lower()) comm->cutghostuser = own_ = MAX(cutoff, others_);
}
