/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_companions.h"

#include "atom.h"
#include "base/comm.h"
#include "bdh_companion_styles.h"
#include "bdh_lammps.h"
#include "bdh_lammps_classes.h"
#include "comm.h"
#include "domain.h"
#include "error.h"
#include "fix_bd.h"
#include "force.h"
#include "group.h"
#include "modify.h"
#include "neighbor.h"
#include "update.h"

using namespace LAMMPS_NS;

namespace {

/// What might rotate, as bits.
enum Rotation { torque = 1, dipole = 2, shape = 4, flat = 8 };

bool has_torque(const Atom &atom, int i)
{
  const double *t = atom.torque_flag ? atom.torque[i] : nullptr;
  return t && (t[0] != 0.0 || t[1] != 0.0 || t[2] != 0.0);
}

bool has_dipole(const Atom &atom, int i) { return atom.mu_flag && atom.mu[i][3] > 0.0; }

/// axes: the axes of the ellipsoids, by atom; null if there are none.
bool has_orientation(const double *const *axes, int i)
{
  return axes && (axes[i][0] != axes[i][1] || axes[i][1] != axes[i][2]);
}

/// Shapes that neither fix of this package turns.
bool has_flat_shapes(const Atom &atom) { return atom.line_flag || atom.tri_flag || atom.body_flag; }
bool has_flat_shape(const Atom &atom, int i)
{
  return (atom.line_flag && atom.line[i] >= 0) || (atom.tri_flag && atom.tri[i] >= 0) ||
         (atom.body_flag && atom.body[i] >= 0);
}

/// What might rotate among the atoms of a group on this process.
int rotations(const Atom &atom, const double *const *axes, int groupbit)
{
  int found = 0;
  for (int i = 0; i < atom.nlocal; ++i) {
    if (!(atom.mask[i] & groupbit)) continue;
    if (has_torque(atom, i)) found |= torque;
    if (has_dipole(atom, i)) found |= dipole;
    if (has_orientation(axes, i)) found |= shape;
    if (has_flat_shape(atom, i)) found |= flat;
  }
  return found;
}

/// Returns text such as "dipoles and torques".
std::string rotations_text(int found)
{
  std::string text;
  const auto add = [&](int bit, const char *word) {
    if (found & bit) text += (text.empty() ? "" : " and ") + std::string(word);
  };
  add(shape | flat, "orientations");
  add(dipole, "dipoles");
  add(torque, "torques");
  return text;
}

const char *remedy_of(int found)
{
  if (found & flat)
    return "lines, triangles and bodies keep their orientation; use dipoles or ellipsoids, or "
           "build such particles from several bonded atoms";
  return "use rotation yes (dipoles need atom_style hybrid sphere dipole)";
}

}    // namespace

int Companions::check(bool needs_list)
{
  if (utils::strmatch(update->integrate_style, "^respa"))
    error->all(FLERR, "{}: run_style respa has no meaning without inertia: use run_style verlet",
               name_);
  sync_atoms(lmp, Host, MASK_MASK, EMPTY_MASK);
  const int other_integrators = refuse_second_integrators();
  check_fixes();
  check_pairs();
  neighbor_builds_.begin_run(needs_list);
  note_old_velocities();
  velocities_.begin_run();
  return other_integrators;
}

/// Returns the group bits of all the other integrators.  AtomGroup uses them to find atoms that
/// join one of these groups during the run.
int Companions::refuse_second_integrators() const
{
  int bits = 0;
  for (int f = 0; f < modify->nfix; ++f) {
    const Fix *other = modify->fix[f];
    if (other == fix_ || !other->time_integrate) continue;
    refuse_integrator(*other);
    check_other_fluid(*other);
    bits |= other->groupbit;
  }
  return bits;
}

/// An atom that two fixes integrate would move too far, at the wrong temperature.
void Companions::refuse_integrator(const Fix &other) const
{
  const bigint shared = count_in_both(lmp, fix_->groupbit, other.groupbit);
  if (shared)
    error->all(FLERR,
               "{}: {} atoms of group {} are also integrated by fix {} {}: unfix it or separate "
               "the groups",
               name_, shared, group->names[fix_->igroup], other.id, other.style);
}

void Companions::check_other_fluid(const Fix &other) const
{
  const FixBD *fluid = dynamic_cast<const FixBD *>(&other);
  if (!fluid) return;
  if (fluid->solvent().seed() == seed_)
    error->all(FLERR,
               "{}: fix {} {} has the same seed {}, so their particles would get the same "
               "noise: give one of them another seed",
               name_, other.id, other.style, seed_);
  if (comm->me == 0)
    error->warning(FLERR,
                   "{}: fix {} {} has a fluid of its own, so particles of the two fixes do not "
                   "interact through a fluid: if they should, use one fix for both groups",
                   name_, other.id, other.style);
}

/// Two fixes with the same group overlap even if it has no atoms yet.
bool Companions::shares_atoms(const Fix &other) const
{
  return other.igroup == fix_->igroup || count_in_both(lmp, fix_->groupbit, other.groupbit) > 0;
}

bool Companions::first_mention(const std::string &what)
{
  return mentioned_.insert(what).second && comm->me == 0;
}

void Companions::check_fixes()
{
  for (int f = 0; f < modify->nfix; ++f) {
    const Fix &other = *modify->fix[f];
    if (&other == fix_) continue;
    if (is_style(other.style, {"shake", "rattle"}) && shares_atoms(other))
      error->all(FLERR,
                 "{}: fix {} {} predicts positions from velocities, which have no inertia here: "
                 "use stiff bonds instead",
                 name_, other.id, other.style);
    const Deed *deed = deed_of(other);
    if (deed && (is_style(other.style, {"srd"}) || shares_atoms(other)) &&
        first_mention(std::string("deed ") + other.id))
      error->warning(FLERR, "{}: fix {} {} {}: {}, so {}", name_, other.id, other.style, deed->deed,
                     deed->effect, deed->remedy);
    check_held_atoms(other);
    check_carried_atoms(other);
  }
}

void Companions::check_pairs()
{
  for (int p = 0; const Deed *deed = deed_of_pair(*force, p); ++p)
    if (first_mention(std::string("pair ") + deed->style))
      error->warning(FLERR, "{}: pair style {} {}: {}, so {}", name_, deed->style, deed->deed,
                     deed->effect, deed->remedy);
}

/// In two dimensions nothing moves out of the plane anyway.
void Companions::check_held_atoms(const Fix &other)
{
  const std::string where = holds_atoms(other);
  if (where.empty() || !shares_atoms(other)) return;
  if (domain->dimension == 2 && (where == "at their z" || where == "in a plane")) return;
  if (first_mention(std::string("held ") + other.id))
    error->warning(FLERR,
                   "{}: fix {} {} removes forces, as if to hold atoms {}, but the fluid and its "
                   "noise still move them: to hold them, leave them out of group {} (the fluid "
                   "then flows through them), or tie them with fix spring/self",
                   name_, other.id, other.style, where, group->names[fix_->igroup]);
}

/// A change of the box that does not carry these atoms along leaves them behind.
void Companions::check_carried_atoms(const Fix &other)
{
  const int carried = carried_group(other);
  if (!carried) return;
  const bigint behind = count_in_both(lmp, fix_->groupbit, fix_->groupbit) -
                        count_in_both(lmp, fix_->groupbit, carried);
  if (behind && first_mention(std::string("carried ") + other.id))
    error->warning(
        FLERR,
        "{}: fix {} {} changes the box and carries the atoms of its group along, but not "
        "{} atoms of group {}, which the flow therefore leaves behind: let it carry "
        "group all",
        name_, other.id, other.style, behind, group->names[fix_->igroup]);
}

/// The noise is a function of the seed and the step, and a data file does not store the step.
void Companions::note_old_velocities()
{
  if (update->ntimestep != 0 || last_step_ >= 0 || noted_velocities_) return;
  sync_atoms(lmp, Host, V_MASK, EMPTY_MASK);
  int mine = 0, any = 0;
  for (int i = 0; i < atom->nlocal; ++i) {
    const double *v = atom->v[i];
    if ((atom->mask[i] & fix_->groupbit) && (v[0] != 0.0 || v[1] != 0.0 || v[2] != 0.0)) mine = 1;
  }
  MPI_Allreduce(&mine, &any, 1, MPI_INT, MPI_MAX, world);
  noted_velocities_ = any;
  if (any && comm->me == 0)
    utils::logmesg(lmp,
                   "{}: the step is 0, but atoms have velocities: if they come from a data file of "
                   "an earlier run with seed {}, this run repeats its noise from the first step "
                   "on; then continue from a restart file, or use another seed\n",
                   name_, seed_);
}

void Companions::look_for_rotations()
{
  if (warned_rotations_ || (turns_ && !has_flat_shapes(*atom))) return;
  sync_atoms(lmp, Host, ALL_MASK, EMPTY_MASK);
  int mine = 0, all = 0;
  if (atom->ellipsoid_flag) {
    const std::string axes = std::string("bdh_axes_") + fix_->id;
    Compute *shapes = modify->add_compute(axes + " all property/atom shapex shapey shapez");
    shapes->compute_peratom();
    mine = rotations(*atom, shapes->array_atom, fix_->groupbit);
    modify->delete_compute(axes);
  } else
    mine = rotations(*atom, nullptr, fix_->groupbit);
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_BOR, world);
  if (turns_) all &= flat;
  if (!all) return;
  warned_rotations_ = true;
  if (comm->me) return;
  error->warning(FLERR, "{}: atoms of group {} have {}, but nothing rotates them: {}", name_,
                 group->names[fix_->igroup], rotations_text(all), remedy_of(all));
}

/// Torques may set in at any time, so this looks for them whenever neighbor lists were rebuilt.
void Companions::begin_step()
{
  velocities_.before_step();
  const bool changed = neighbor->ago == 0 || update->ntimestep == update->firststep + 1;
  if (changed && atom->torque_flag) look_for_rotations();
  neighbor_builds_.begin_step();
  watch_step_number();
}

/// The noise is a function of the step, so a step taken twice would draw the same noise.
void Companions::watch_step_number()
{
  if (update->ntimestep <= last_step_ && !warned_replay_ && comm->me == 0) {
    warned_replay_ = true;
    error->warning(FLERR,
                   "{}: step {} was taken before (reset_timestep?): the same noise is drawn again, "
                   "unless the fix is defined again with another seed",
                   name_, update->ntimestep);
  }
  last_step_ = update->ntimestep;
}
