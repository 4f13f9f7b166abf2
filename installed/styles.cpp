// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "styles.h"

#include "compute_temp_brownian.h"
#include "fix_bd_fib.h"
#include "fix_bd_pse.h"
#include "library.h"
#include "pair_asakura_oosawa.h"

using namespace LAMMPS_NS;

namespace {

template <class Style> Fix *new_fix(LAMMPS *lmp, int narg, char **arg)
{
  return new Style(lmp, narg, arg);
}
template <class Style> Compute *new_compute(LAMMPS *lmp, int narg, char **arg)
{
  return new Style(lmp, narg, arg);
}
template <class Style> Pair *new_pair(LAMMPS *lmp)
{
  return new Style(lmp);
}

}    // namespace

/// The lists of names are in the headers of the styles, in the form that LAMMPS' own build reads.
void bdh::give_styles(StyleTaker &taker)
{
#define FIX_CLASS
#define FixStyle(name, Style) taker.take_fix(#name, &new_fix<Style>)
#include "fix_bd_fib.h"
#include "fix_bd_pse.h"
#undef FixStyle
#undef FIX_CLASS

#define COMPUTE_CLASS
#define ComputeStyle(name, Style) taker.take_compute(#name, &new_compute<Style>)
#include "compute_temp_brownian.h"
#undef ComputeStyle
#undef COMPUTE_CLASS

#define PAIR_CLASS
#define PairStyle(name, Style) taker.take_pair(#name, &new_pair<Style>)
#include "pair_asakura_oosawa.h"
#undef PairStyle
#undef PAIR_CLASS
}

std::string bdh::other_release(LAMMPS *lmp, const std::string &program)
{
  const int built_for = BDH_LAMMPS_DATE, found = lammps_version(lmp);
  if (found == built_for) return "";
  return program + " was built for LAMMPS " + std::to_string(built_for) +
      " (year, month, day), but the LAMMPS library is version " + std::to_string(found) +
      ": build BD-HYDRO again for this library, or install the version it was built for";
}
