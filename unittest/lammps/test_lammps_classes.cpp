// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// bdh_lammps_declarations.h, for LAMMPS libraries that are installed without some of LAMMPS'
// headers, against these headers: each member that the package reads has the same offset.
//
// Nothing is run.  The tests compare what the compiler reports for both declarations.
#include "bdh_lammps.h"
#include "bdh_lammps_classes.h"
#include "compute.h"
#include "fix.h"
#include "pointers.h"

#include <cstddef>
#include <gtest/gtest.h>

namespace LAMMPS_NS {
namespace declared {
#include "bdh_lammps_declarations.h"
}    // namespace declared
}    // namespace LAMMPS_NS

namespace {

using namespace LAMMPS_NS;

/// The member's distance from the beginning of an object, which is never made.
template <class Object, class Member> std::ptrdiff_t place(Member Object::*member)
{
  alignas(Object) static char room[sizeof(Object)];
  auto *object = reinterpret_cast<Object *>(room);
  return reinterpret_cast<char *>(&(object->*member)) - room;
}

/// Shows the protected members of a class of LAMMPS and of its declaration here.
#define COMPARE(Class, member)                                                                     \
  {                                                                                                \
    struct Theirs : LAMMPS_NS::Class {                                                             \
      static auto at() { return place(&Theirs::member); }                                          \
    };                                                                                             \
    struct Ours : LAMMPS_NS::declared::Class {                                                     \
      static auto at() { return place(&Ours::member); }                                            \
    };                                                                                             \
    EXPECT_EQ(Ours::at(), Theirs::at());                                                           \
  }

}    // namespace

TEST(LammpsClasses, PlacesOfMembers)
{
  COMPARE(AtomVec, forceclearflag);
  COMPARE(FixDeform, remapflag);
  COMPARE(FixPressBerendsen, allremap);
  COMPARE(FixNH, allremap);
  COMPARE(FixNH, dilate_group_bit);
  COMPARE(ComputePressure, keflag);
  COMPARE(ComputePressure, id_temp);
}

TEST(LammpsClasses, PlacesInFixSetForce)
{
  COMPARE(FixSetForce, xvalue);
  COMPARE(FixSetForce, yvalue);
  COMPARE(FixSetForce, zvalue);
  COMPARE(FixSetForce, xstr);
  COMPARE(FixSetForce, ystr);
  COMPARE(FixSetForce, zstr);
  COMPARE(FixSetForce, xstyle);
  COMPARE(FixSetForce, ystyle);
  COMPARE(FixSetForce, zstyle);
}

// Newer releases have functions for these.
#if BDH_LAMMPS_DATE < 20250204
TEST(LammpsClasses, PlacesOfMembersWithoutFunctions)
{
  COMPARE(FixAdapt, diamflag);
  COMPARE(NeighRequest, pair);
  COMPARE(NeighRequest, fix);
  COMPARE(NeighRequest, half);
  COMPARE(NeighRequest, full);
  COMPARE(NeighRequest, newton);
  COMPARE(NeighRequest, kokkos_host);
  COMPARE(NeighRequest, kokkos_device);
  COMPARE(NeighRequest, cut);
  COMPARE(NeighRequest, cutoff);
}
#endif
