// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Run by cmake: the installed LAMMPS library says what it is.
#include "library.h"

#include <cstdio>

int main()
{
  char name[] = "ask", log[] = "-log", screen[] = "-screen", none[] = "none";
  char *arg[] = {name, log, none, screen, none};
  void *lmp = lammps_open_no_mpi(5, arg, nullptr);
  if (!lmp) return 1;
  std::printf("version %d, bytes of bigint %d, of tagint %d, plugins %d, MPI %d\n",
              lammps_version(lmp), lammps_extract_setting(lmp, "bigint"),
              lammps_extract_setting(lmp, "tagint"), lammps_config_has_package("PLUGIN"),
              lammps_config_has_mpi_support() != 0);
  std::fflush(nullptr);
  lammps_close(lmp);
  return 0;
}
