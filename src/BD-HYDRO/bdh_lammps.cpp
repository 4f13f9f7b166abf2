/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_lammps.h"

#include "angle.h"
#include "atom.h"
#include "bdh_lammps_classes.h"
#include "bond.h"
#include "comm.h"
#include "dihedral.h"
#include "domain.h"
#include "fix.h"
#include "force.h"
#include "improper.h"
#include "kspace.h"
#include "modify.h"
#include "neighbor.h"
#include "pair.h"

#ifdef LMP_KOKKOS
#include "atom_kokkos.h"
#endif

#include <cstring>

using namespace LAMMPS_NS;

/* ----------------------------------------------------------------------
   what differs between releases: of two functions that are given 0, the
   first one is chosen where it compiles
------------------------------------------------------------------------- */

namespace {

enum { REQ_NEWTON_OFF };    // for releases in which NeighConst lacks this name; hidden otherwise

}    // namespace

namespace LAMMPS_NS {

/// Flags for lists with pairs with ghosts in the rows of both atoms.
static int newton_off()
{
  using namespace NeighConst;
  return REQ_NEWTON_OFF;
}

}    // namespace LAMMPS_NS

namespace {

template <class C> auto forward(C &comm, Fix *fix, int width, int)
    -> decltype(comm.forward_comm_fix(fix, width))
{
  comm.forward_comm_fix(fix, width);
}
template <class C> void forward(C &comm, Fix *fix, int width, long)
{
  comm.forward_comm(fix, width);
}

template <class Request> auto grant(Request &request, const ListWish &wish, int)
    -> decltype(request.enable_full())
{
  request.set_kokkos_host(wish.kokkos_host);
  request.set_kokkos_device(wish.kokkos_device);
  if (wish.full) request.enable_full();
}
template <class Request> void grant(Request &request, const ListWish &wish, long)
{
  request.kokkos_host = wish.kokkos_host;
  request.kokkos_device = wish.kokkos_device;
  request.full = wish.full;
  request.half = !wish.full;
}

/// LAMMPS adds the skin to the reach.
template <class N> auto add_request(N &neighbor, Fix *fix, int, const ListWish &wish, int)
    -> decltype(neighbor.add_request(fix))
{
  auto *request = neighbor.add_request(fix, newton_off());
  request->set_cutoff(wish.reach);
  return request;
}
template <class N>
auto *add_request(N &neighbor, Fix *fix, int instance, const ListWish &wish, long)
{
  const int index = neighbor.request(fix, instance);    // may move the array of requests
  auto *request = neighbor.requests[index];
  request->pair = 0;
  request->fix = 1;
  request->newton = 2;
  request->cut = 1;
  request->cutoff = wish.reach + neighbor.skin;
  return request;
}

template <class F> auto changes_radii(const F &fix, int) -> decltype(fix.diam_flag)
{
  return fix.diam_flag;
}
template <class F> auto changes_radii(const F &fix, long) -> decltype(fix.diamflag)
{
  return fix.diamflag;
}

}    // namespace

#ifdef LMP_KOKKOS
void LAMMPS_NS::sync_atoms(LAMMPS *lmp, ExecutionSpace where, AtomMask read, AtomMask modified)
{
  if (!lmp->kokkos) return;
  auto &atoms = static_cast<AtomKokkos &>(*lmp->atom);
  atoms.sync(where, read);
  atoms.modified(where, modified);
}
#else
void LAMMPS_NS::sync_atoms(LAMMPS *, ExecutionSpace, AtomMask, AtomMask) {}
#endif

std::string LAMMPS_NS::plain_style(const std::string &style)
{
  return style.substr(0, style.find("/kk"));
}

void LAMMPS_NS::forward_numbers(Comm &comm, Fix *fix, int width) { forward(comm, fix, width, 0); }

void LAMMPS_NS::request_list(Neighbor &neighbor, Fix *fix, int instance, const ListWish &wish)
{
  grant(*add_request(neighbor, fix, instance, wish, 0), wish, 0);
}

void LAMMPS_NS::change_request(Neighbor &neighbor, Pair *pair, const ListWish &wish)
{
  grant(*neighbor.find_request(pair), wish, 0);
}

bool LAMMPS_NS::adapts_radii(const Fix &fix)
{
  const auto *adapt = dynamic_cast<const FixAdapt *>(&fix);
  return adapt && changes_radii(*adapt, 0);
}

/* ----------------------------------------------------------------------
   the same in all releases
------------------------------------------------------------------------- */

const char *LAMMPS_NS::package_version()
{
#if defined(BDH_VERSION)
  return BDH_VERSION;
#else
  return "of unknown version";
#endif
}

bool LAMMPS_NS::is_style(const char *style, std::initializer_list<const char *> names)
{
  for (const char *name : names) {
    const size_t length = strlen(name);
    if (strncmp(style, name, length) == 0 && (style[length] == '\0' || style[length] == '/'))
      return true;
  }
  return false;
}

bigint LAMMPS_NS::count_in_both(LAMMPS *lmp, int groupbit, int other_groupbit)
{
  Atom &atom = *lmp->atom;
  sync_atoms(lmp, Host, MASK_MASK, EMPTY_MASK);
  bigint mine = 0, all = 0;
  for (int i = 0; i < atom.nlocal; ++i)
    if ((atom.mask[i] & groupbit) && (atom.mask[i] & other_groupbit)) ++mine;
  MPI_Allreduce(&mine, &all, 1, MPI_LMP_BIGINT, MPI_SUM, lmp->world);
  return all;
}

namespace {

/// The restart data that LAMMPS makes accessible only to derived classes.
struct RestartEntries : Modify {
  static auto global_ids() { return &RestartEntries::id_restart_global; }
  static auto global_styles() { return &RestartEntries::style_restart_global; }
  static auto global_states() { return &RestartEntries::state_restart_global; }
  static auto global_used() { return &RestartEntries::used_restart_global; }
  static auto atom_ids() { return &RestartEntries::id_restart_peratom; }
  static auto atom_styles() { return &RestartEntries::style_restart_peratom; }
  static auto atom_index() { return &RestartEntries::index_restart_peratom; }
  static auto atom_used() { return &RestartEntries::used_restart_peratom; }
};

/// Fixes that draw random numbers, count calls or integrate something themselves whenever forces
/// are evaluated.
bool acts_once_a_step(const char *style)
{
  return is_style(style,
                  {"langevin", "gle",      "gld",           "qtb",        "ttm",
                   "colvars",  "plumed",   "lb/fluid",      "srd",        "ti/spring",
                   "hyper",    "external", "ipi",           "mdi",        "smd",
                   "imd",      "pafi",     "python/invoke", "flow/gauss", "electron/stopping"});
}

/// True if the atom style has more to clear than forces and torques, with a function of its own.
bool has_more_forces(const Atom &atom) { return atom.avec->forceclearflag != 0; }

/// f += forces of a style, using the copies of the atoms that it works on.
template <class Style> void add_forces(LAMMPS *lmp, Style &style)
{
  sync_atoms(lmp, style.execution_space, style.datamask_read, EMPTY_MASK);
  style.compute(0, 0);
  sync_atoms(lmp, style.execution_space, EMPTY_MASK, style.datamask_modify);
}

}    // namespace

void LAMMPS_NS::restore_from_other_suffix(Modify &modify, Fix &fix, int nlocal,
                                          std::initializer_list<const char *> names)
{
  using E = RestartEntries;
  const auto is_ours = [&](const char *id, const char *style) {
    return strcmp(id, fix.id) == 0 && strcmp(style, fix.style) != 0 && is_style(style, names);
  };
  for (int i = 0; i < modify.nfix_restart_global; ++i) {
    if (!is_ours((modify.*E::global_ids())[i], (modify.*E::global_styles())[i])) continue;
    fix.restart((modify.*E::global_states())[i]);
    (modify.*E::global_used())[i] = 1;
  }
  for (int i = 0; i < modify.nfix_restart_peratom; ++i) {
    if (!is_ours((modify.*E::atom_ids())[i], (modify.*E::atom_styles())[i])) continue;
    for (int j = 0; j < nlocal; ++j) fix.unpack_restart(j, (modify.*E::atom_index())[i]);
    (modify.*E::atom_used())[i] = 1;
  }
}

void MidpointForces::check(const std::string &style, const std::string &what,
                           const std::string &instead) const
{
  const char *several = what == "scheme improved" ? "twice" : "several times";
#ifdef BDH_INSTALLED_LAMMPS
  if (has_more_forces(*atom))
    error->all(FLERR,
               "{}: {} evaluates forces {} a step, which atom_style {} allows only in a LAMMPS "
               "that is built from source with this package: build one, or use {}",
               style, what, several, plain_style(atom->atom_style), instead);
#endif
  for (int i = 0; i < modify->nfix; ++i) {
    const Fix *other = modify->fix[i];
    if (is_style(other->style, {"NEIGH_HISTORY", "wall/gran"}))
      error->all(FLERR,
                 "{}: {} evaluates forces {} a step, which contact history (fix {} {}) "
                 "does not allow: use {}",
                 style, what, several, other->id, other->style, instead);
    if (acts_once_a_step(other->style) && comm->me == 0)
      error->warning(
          FLERR,
          "{}: {} evaluates forces {} a step, and fix {} {} is meant to act once a step: "
          "use {}, or check that calling it {} is right",
          style, what, several, other->id, other->style, instead, several);
  }
  for (const char *noisy : {"^dpd", "^brownian", "^tdpd", "^edpd", "^mdpd"})
    if (force->pair && force->pair_match(noisy, 0, 1) && comm->me == 0)
      error->warning(FLERR, "{}: {} draws the random forces of pair style {} {} a step", style,
                     what, noisy + 1, several);
}

void MidpointForces::update(ExecutionSpace where) const
{
  sync_atoms(lmp, where, EMPTY_MASK, X_MASK);
  refresh_ghosts();
  clear_forces();
  if (modify->n_pre_force) modify->pre_force(0);
  if (force->pair && force->pair->compute_flag) add_forces(lmp, *force->pair);
  if (atom->molecular != Atom::ATOMIC) {
    if (force->bond) add_forces(lmp, *force->bond);
    if (force->angle) add_forces(lmp, *force->angle);
    if (force->dihedral) add_forces(lmp, *force->dihedral);
    if (force->improper) add_forces(lmp, *force->improper);
  }
  if (force->kspace && force->kspace->compute_flag) add_forces(lmp, *force->kspace);
  if (modify->n_pre_reverse) modify->pre_reverse(0, 0);
  if (force->newton) {
    wait_for_forces();
    comm->reverse_comm();
  }
  modify->post_force(0);
  sync_atoms(lmp, where, ALL_MASK, EMPTY_MASK);
}

/// Does what Verlet::run() does, except that it does not count as a step and does not let fixes
/// insert or delete atoms.
void MidpointForces::refresh_ghosts() const
{
  const bool moved_far = !neighbor->dist_check || neighbor->check_distance();
  if (neighbor->build_once || !moved_far) {
    comm->forward_comm();
    return;
  }
  if (domain->triclinic) domain->x2lamda(atom->nlocal);
  domain->pbc();
  if (domain->box_change) {
    domain->reset_box();
    comm->setup();
    if (neighbor->style) neighbor->setup_bins();
  }
  comm->exchange();
  comm->borders();
  if (domain->triclinic) domain->lamda2x(atom->nlocal + atom->nghost);
  if (modify->n_pre_neighbor) modify->pre_neighbor();
  neighbor->build(1);
  if (modify->n_post_neighbor) modify->post_neighbor();
}

/// Clears the forces on the host.
void MidpointForces::clear_forces() const
{
  const int count = force->newton ? atom->nlocal + atom->nghost : atom->nlocal;
  if (count == 0) return;
  const AtomMask cleared = has_more_forces(*atom) ? ALL_MASK : F_MASK | TORQUE_MASK;
  sync_atoms(lmp, Host, cleared, EMPTY_MASK);
  const size_t bytes = sizeof(double) * count;
  memset(&atom->f[0][0], 0, 3 * bytes);
  if (atom->torque_flag) memset(&atom->torque[0][0], 0, 3 * bytes);
#ifndef BDH_INSTALLED_LAMMPS
  if (has_more_forces(*atom)) atom->avec->force_clear(0, bytes);
#endif
  sync_atoms(lmp, Host, EMPTY_MASK, cleared);
}
