/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_fib_box.h"

#include "bdh_lammps.h"
#include "bdh_lammps_classes.h"
#include "domain.h"
#include "error.h"
#include "input/grid_choice.h"
#include "modify.h"
#include "update.h"

#include <algorithm>

using namespace LAMMPS_NS;

namespace {

bool same_grid(const bdh::Grid &a, const bdh::Grid &b)
{
  return a.n == b.n && a.lo == b.lo && a.length == b.length && a.boundary == b.boundary &&
         a.beyond == b.beyond && a.left_out == b.left_out;
}

}    // namespace

void FibBox::check() const
{
  if (domain->triclinic)
    error->all(FLERR, "{}: the box is triclinic, but must be orthogonal: use change_box all ortho",
               name_);
  for (int d = 0; d < 3; ++d)
    for (int side = 0; side < 2; ++side)
      if (domain->boundary[d][side] > 1 && !may_follow_atoms(d, side))
        error->all(FLERR,
                   "{}: face {} of the box is shrink-wrapped (boundary s or m), but walls must "
                   "stay in place: use boundary f, or p without walls{}",
                   name_, bdh::face_name(d, side),
                   options_.walls.face[d][side].kind == bdh::Boundary::open
                       ? "; an open face may be shrink-wrapped with keyword radius, opposite to a "
                         "no-slip wall"
                       : "");
  if (update->whichflag == 2) return;    // minimize moves no particle through the fluid
  for (int f = 0; f < modify->nfix; ++f)
    if (modify->fix[f]->box_change & (Fix::BOX_CHANGE_SIZE | Fix::BOX_CHANGE_SHAPE))
      error->all(FLERR,
                 "{}: fix {} {} changes the box during the run, but the grid is fixed to it: "
                 "remove that fix",
                 name_, modify->fix[f]->id, modify->fix[f]->style);
}

/// An open face may be shrink-wrapped where its place has no influence: opposite to a wall that
/// holds the fluid, if the spacing does not come from the height of the box.
bool FibBox::may_follow_atoms(int axis, int side) const
{
  const auto &faces = options_.walls.face[axis];
  return faces[side].kind == bdh::Boundary::open && faces[1 - side].kind == bdh::Boundary::noslip &&
         !options_.grid_given();
}

bdh::Grid FibBox::grid_of_box() const
{
  bdh::Grid grid = bdh::choose_grid(
      options_, domain->dimension, {domain->boxlo[0], domain->boxlo[1], domain->boxlo[2]},
      {domain->prd[0], domain->prd[1], domain->prd[2]},
      {domain->xperiodic != 0, domain->yperiodic != 0, domain->zperiodic != 0});
  for (std::size_t d = 0; d < 3; ++d)
    for (std::size_t side = 0; side < 2; ++side)
      if (domain->boundary[d][side] > 1)    // this face goes along with the atoms
        grid.left_out[d][side] = std::max(0L, bdh::most_cells - grid.n[d]) * grid.h(d);
  return grid;
}

bool FibBox::fit()
{
  const bdh::Grid before = grid_;
  grid_ = grid_of_box();
  walls_ = bdh::WallMotion(options_.walls, grid_, options_.kernel, options_.shear_rate);
  for (int d = 0; d < 3; ++d) faces_[d] = {domain->boxlo[d], domain->boxhi[d]};
  check_flow();
  check_stresslets();
  return !same_grid(grid_, before);
}

/// Refuses moving walls whose flow only the fluid solver can determine, if there is none.
void FibBox::check_flow() const
{
  if (options_.hydrodynamics || walls_.left_to_solver() == bdh::WallVectors{}) return;
  error->all(
      FLERR,
      "{}: with hydrodynamics no, the flow that moving walls drive in a duct or a closed box is "
      "not computed: keep the walls at rest, or use a slit, whose flow is known",
      name_);
}

void FibBox::check_stresslets() const
{
  if (!options_.stresslets) return;
  if (grid_.dim == 2)
    error->all(FLERR,
               "{}: stresslet = yes, but in two dimensions there are no spheres: remove stresslet",
               name_);
  if (walls_.left_to_solver() != bdh::WallVectors{})
    error->all(FLERR,
               "{}: stresslet = yes is not possible in a duct or a closed box with moving walls: "
               "keep the walls at rest, or use a slit",
               name_);
}

/// A face that goes along with the atoms may be anywhere.
void FibBox::check_unchanged() const
{
  const double *const faces[2] = {domain->boxlo, domain->boxhi};
  for (int d = 0; d < grid_.dim; ++d)
    for (int side = 0; side < 2; ++side)
      if (domain->boundary[d][side] <= 1 && faces[side][d] != faces_[d][side])
        error->all(FLERR,
                   "{}: step {}: the box has changed, now {:.6g} to {:.6g} along {}, but the grid "
                   "is fixed: use run with pre yes after a change of the box",
                   name_, update->ntimestep, domain->boxlo[d], domain->boxhi[d], "xyz"[d]);
}

bdh::Symmetric<double> FibBox::strain() const
{
  bdh::Symmetric<double> shear;
  if (!grid_.opens()) shear.xy = 0.5 * options_.shear_rate;
  const auto known = walls_.known_flow().strain();
  const auto walls = bdh::Symmetric<double>::of(known.data());
  return {walls.xx, walls.yy, walls.zz, walls.xy + shear.xy, walls.xz, walls.yz};
}

double FibBox::background_force(int axis, int side, int component, double viscosity) const
{
  const bdh::LinearFlow &flow = walls_.known_flow();
  if (!flow.flows() || flow.axis != axis || grid_.boundary[axis][side] == bdh::Boundary::open)
    return 0.0;
  return (side ? -1.0 : 1.0) * viscosity * flow.gradient[component] * grid_.cell_volume() *
         grid_.cells() / grid_.length[axis];
}
