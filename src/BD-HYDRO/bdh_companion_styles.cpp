/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "bdh_companion_styles.h"

#include "bdh_lammps.h"
#include "bdh_lammps_classes.h"
#include "domain.h"
#include "fix_bd.h"
#include "force.h"

using namespace LAMMPS_NS;

namespace {

const char velocities[] = "acts on velocities, which here are displacement/dt";
const char noise[] = "adds noise of its own";
const char own_fluid[] = "has a fluid of its own";

const char solvent_does_it[] = "friction and noise come from the fluid";
const char no_trajectory[] = "it changes no trajectory, and the temperature is that of the fluid";
const char no_flux[] = "its exchanges have no effect on the particles, and its flux is meaningless";
const char remove_it[] = "remove it";

/// LAMMPS has no flag that says what a fix does with velocities, so this list goes by name.  It
/// omits fixes that integrate, since those are refused for atoms of the group, and fixes that only
/// read velocities for output.
const Deed fixes[] = {
    // Forces that depend on velocities.
    {"langevin", velocities, solvent_does_it, remove_it},
    {"viscous", velocities, solvent_does_it, remove_it},
    {"gle", velocities, solvent_does_it, remove_it},
    {"gld", velocities, solvent_does_it, remove_it},
    {"qtb", velocities, solvent_does_it, remove_it},
    {"ttm", velocities, solvent_does_it, remove_it},
    {"electron/stopping", velocities, solvent_does_it, remove_it},
    {"wall/gran", velocities, "its friction responds to the noise of the step",
     "use a wall without friction, such as fix wall/harmonic"},
    {"wall/body", velocities, "its friction responds to the noise of the step",
     "use a wall without friction, such as fix wall/harmonic"},
    {"propel/self", velocities, "they are mostly noise and give no direction of swimming",
     "use fix addforce, or a force along a bond, to drive in a given direction"},
    {"flow/gauss", velocities, "it sustains a flow with inertia, and here it stops all flow",
     "use fix addforce, moving walls or fix deform for a flow"},

    // Velocities that are set, scaled or swapped.
    {"temp", velocities, no_trajectory, remove_it},
    {"momentum", velocities, "it changes no trajectory",
     "remove it, or use fix recenter if the center must stay"},
    {"lb/momentum", velocities, "it changes no trajectory", remove_it},
    {"viscosity", velocities, no_flux,
     "remove it, and measure the response to fix deform, moving walls or a force"},
    {"thermal/conductivity", velocities, no_flux, remove_it},
    {"heat", velocities, no_flux, remove_it},
    {"ehex", velocities, no_flux, remove_it},
    {"oneway", velocities, "it turns no particle around", "use a wall or a force instead"},
    {"shardlow", velocities, solvent_does_it, remove_it},
    {"smd/setvel", velocities, "it moves no particle",
     "use fix addforce, or fix move outside the group"},
    {"tmd", velocities, "it continues a motion that has no inertia here",
     "use fix spring or fix restrain"},

    // Explicit fluids.
    {"srd", own_fluid, "its friction acts on velocities, which here are displacement/dt",
     "use only one of the two"},
    {"lb/fluid", own_fluid, "its friction acts on velocities, which here are displacement/dt",
     "use only one of the two"},
    {"lb/viscous", own_fluid, "its friction acts on velocities, which here are displacement/dt",
     "use only one of the two"},
};

/// Most of these request the velocities of ghost atoms, but LAMMPS does not record which style did.
const Deed pairs[] = {
    {"dpd", velocities, solvent_does_it, "use a pair style without them, such as soft"},
    {"edpd", velocities, solvent_does_it, "use a pair style without them, such as soft"},
    {"mdpd", velocities, solvent_does_it, "use a pair style without them"},
    {"tdpd", velocities, solvent_does_it, "use a pair style without them, such as soft"},
    {"gran", velocities, "its friction responds to the noise of the step",
     "use a pair style without friction"},
    {"granular", velocities, "its friction responds to the noise of the step",
     "use a pair style without friction"},
    {"body/rounded", velocities, "its friction responds to the noise of the step",
     "use a pair style without friction"},
    {"lubricate", velocities, solvent_does_it, remove_it},
    {"lubricateU", velocities, solvent_does_it, remove_it},
    {"sph", velocities, "it is meant for a fluid with inertia", remove_it},
    {"smd", velocities, "it is meant for matter with inertia", remove_it},
    {"dsmc", velocities, "its collisions move no particle", remove_it},
    {"brownian", noise, solvent_does_it, remove_it},
};

/// Members that LAMMPS makes accessible only to derived classes.
struct SetForce : FixSetForce {
  static bool holds(const FixSetForce &fix, int d)
  {
    static char *FixSetForce::*const name[] = {&SetForce::xstr, &SetForce::ystr, &SetForce::zstr};
    static double FixSetForce::*const value[] = {&SetForce::xvalue, &SetForce::yvalue,
                                                 &SetForce::zvalue};
    return sets(fix, d) && !(fix.*name[d]) && fix.*value[d] == 0.0;
  }
  /// The keyword NULL leaves a component alone.
  static bool sets(const FixSetForce &fix, int d)
  {
    static int FixSetForce::*const style[] = {&SetForce::xstyle, &SetForce::ystyle,
                                              &SetForce::zstyle};
    return fix.*style[d] != 0;
  }
};

struct PressBerendsen : FixPressBerendsen {
  static int FixPressBerendsen::*carries_all() { return &PressBerendsen::allremap; }
};

struct NoseHoover : FixNH {
  static int FixNH::*carries_all() { return &NoseHoover::allremap; }
  static int FixNH::*group() { return &NoseHoover::dilate_group_bit; }
};

/// In mode velocity the force is left out of the virial; in the other two modes it is included.
bool propels_along_dipoles(const Fix &fix)
{
  return is_style(fix.style, {"propel/self"}) && fix.thermo_virial;
}

}    // namespace

const Deed *LAMMPS_NS::deed_of(const Fix &fix)
{
  if (dynamic_cast<const FixBD *>(&fix) || propels_along_dipoles(fix)) return nullptr;
  for (const Deed &deed : fixes)
    if (is_style(fix.style, {deed.style})) return &deed;
  return nullptr;
}

const Deed *LAMMPS_NS::deed_of_pair(Force &force, int which)
{
  if (!force.pair) return nullptr;
  for (const Deed &deed : pairs) {
    const std::string name = std::string("^") + deed.style;
    if ((force.pair_match(name + "$", 0, 1) || force.pair_match(name + "/", 0, 1)) && which-- == 0)
      return &deed;
  }
  return nullptr;
}

bool LAMMPS_NS::may_change_velocities(const Fix &fix)
{
  return is_style(fix.style,
                  {"wall/reflect", "wall/piston", "enforce2d", "gcmc", "widom", "deposit"});
}

std::string LAMMPS_NS::holds_atoms(const Fix &fix)
{
  if (is_style(fix.style, {"freeze"})) return "where they are";
  if (is_style(fix.style, {"planeforce"})) return "in a plane";
  if (is_style(fix.style, {"lineforce"})) return "on a line";
  const auto *force = dynamic_cast<const FixSetForce *>(&fix);
  if (!force) return "";
  std::string axes;
  for (int d = 0; d < 3; ++d) {
    if (SetForce::sets(*force, d) && !SetForce::holds(*force, d)) return "";    // it drives
    if (SetForce::holds(*force, d)) axes += "xyz"[d];
  }
  if (axes.empty()) return "";
  return axes.size() == 3 ? "where they are" : "at their " + axes;
}

int LAMMPS_NS::carried_group(const Fix &fix)
{
  const auto *deform = dynamic_cast<const FixDeform *>(&fix);
  if (deform) return deform->remapflag == Domain::X_REMAP ? deform->groupbit : 0;
  const auto *berendsen = dynamic_cast<const FixPressBerendsen *>(&fix);
  if (berendsen) return berendsen->*PressBerendsen::carries_all() ? 0 : berendsen->groupbit;
  const auto *barostat = dynamic_cast<const FixNH *>(&fix);
  if (barostat && barostat->box_change && !(barostat->*NoseHoover::carries_all()))
    return barostat->*NoseHoover::group();
  return 0;
}
