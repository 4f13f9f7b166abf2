/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Where the core meets LAMMPS: errors, and forces evaluated within a time step.
#ifndef LMP_BDH_LAMMPS_H
#define LMP_BDH_LAMMPS_H

#include "base/errors.h"
#include "error.h"
#include "fix.h"
#include "lammps.h"
#include "pointers.h"

#include <functional>
#include <initializer_list>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

namespace LAMMPS_NS {

// What differs between releases of LAMMPS.

/// Bits of atom_masks.h.
using AtomMask = decltype(Fix::datamask_read);

/// With the KOKKOS package: brings those copies of the atoms up to date that are read, and notes
/// which ones are modified.  Does nothing without it.
void sync_atoms(LAMMPS *lmp, ExecutionSpace where, AtomMask read, AtomMask modified);

/// Each process sends the numbers that the fix packs, `width` per atom, for those of its atoms that
/// are ghosts elsewhere.
void forward_numbers(class Comm &comm, Fix *fix, int width);

/// Required properties of a neighbor list.
struct ListWish {
  double reach = 0.0;            // without the skin [distance]
  bool full = false;             // each pair is in the rows of both atoms
  bool kokkos_device = false;    // of the KOKKOS package
  bool kokkos_host = false;
};
/// At init: requests a list for the fix, with pairs with ghosts in the rows of both atoms.
/// instance: the fix's own.
void request_list(class Neighbor &neighbor, Fix *fix, int instance, const ListWish &wish);
/// For a pair style that has requested a list, whose reach stays that of the style.
void change_request(Neighbor &neighbor, class Pair *pair, const ListWish &wish);

/// True if fix adapt changes radii of atoms.
bool adapts_radii(const Fix &fix);

/// Version of the package as the build gives it; "of unknown version" if the build gives none.
const char *package_version();

/// Runs body and turns errors of the core into LAMMPS errors.  Options are the same on all ranks,
/// so errors in them use all().  What happens to a particle is known to one rank only, so that uses
/// one(). describe(index): text that names the particle at that index of the arrays given to the
/// core.
template <class Body, class Describe>
void run_core(Error *error, const std::string &style, Body body, Describe describe)
{
  try {
    body();
  } catch (const bdh::InvalidOption &e) {
    error->all(FLERR, "{}: {}", style, e.what());
  } catch (const bdh::NotConverged &e) {
    error->all(FLERR, "{}: {}", style, e.what());
  } catch (const bdh::BadParticle &e) {
    error->one(FLERR, "{}: {}: {}", style, describe(e.index), e.what());
  } catch (const std::bad_alloc &) {
    error->one(FLERR, "{}: out of memory: use fewer grid cells, a larger radius or more processes",
               style);
  } catch (const std::length_error &) {
    error->one(FLERR,
               "{}: the grid is too large for this machine: use fewer cells, a larger radius or "
               "more processes",
               style);
  }
}

/// Runs the core on behalf of a fix: run_core() with the fix's name and its particles.
class CoreGuard {
 public:
  /// describe(index): names the particle at that index of the core's arrays.
  CoreGuard(LAMMPS *lmp, const std::string &name, std::function<std::string(long)> describe) :
      error_(lmp->error), name_(name), describe_(std::move(describe))
  {}
  template <class Body> void operator()(Body body) const
  {
    run_core(error_, name_, body, describe_);
  }

 private:
  Error *error_;
  const std::string name_;
  std::function<std::string(long)> describe_;
};

/// True if style is one of the names or a variant of one (NAME/...).  utils::strmatch() does not
/// support alternatives.
bool is_style(const char *style, std::initializer_list<const char *> names);

/// The names of fix bd/fib without suffixes.
inline constexpr std::initializer_list<const char *> fib_styles = {"bd/fib", "brownian/fib",
                                                                   "temp/bd/fib"};
/// The names of fix bd/pse without suffixes.
inline constexpr std::initializer_list<const char *> pse_styles = {"bd/pse", "brownian/pse",
                                                                   "temp/bd/pse"};

/// The name of a style as users write it, without a suffix of the KOKKOS package.
std::string plain_style(const std::string &style);

/// Gives a fix the state that a restart file holds for a fix of the same id whose style is one of
/// the names with another suffix (NAME/kk ...).  LAMMPS itself restores the state only if the
/// styles are equal. nlocal: number of atoms on this processor.
void restore_from_other_suffix(class Modify &modify, Fix &fix, int nlocal,
                               std::initializer_list<const char *> names);
/// Collective.  Number of atoms that are in both groups, given by their bits.
bigint count_in_both(LAMMPS *lmp, int groupbit, int other_groupbit);

/// Evaluates forces at positions within a time step by calling LAMMPS itself: ghosts, neighbor
/// lists, pair, bonded and long-range styles, and the forces that other fixes add.
///
/// With the KOKKOS package each style works on the host's or the device's copies of the atoms, and
/// its masks say what it reads and modifies.  Calls of sync_atoms() before and after each
/// style keep the copies consistent; without that package they do nothing.
class MidpointForces : protected Pointers {
 public:
  explicit MidpointForces(LAMMPS *lmp) : Pointers(lmp) {}
  ~MidpointForces() noexcept override {}    // newer releases let that of Pointers throw

  /// Refuses styles that keep a history from one force evaluation to the next, and warns about
  /// fixes that must act once a step. what: evaluates forces within the step; instead: what to use
  /// in place of it.
  void check(const std::string &style, const std::string &what, const std::string &instead) const;
  /// Collective.  atom->f := forces at atom->x.  Atoms may migrate, and the per-atom arrays of
  /// fixes go with them. where: which copies the caller has moved; afterwards those are up to date.
  void update(ExecutionSpace where = Host) const;

 protected:
  virtual void clear_forces() const;
  /// Returns once atom->f is complete and may be sent.
  virtual void wait_for_forces() const {}

 private:
  void refresh_ghosts() const;
};

}    // namespace LAMMPS_NS
#endif
