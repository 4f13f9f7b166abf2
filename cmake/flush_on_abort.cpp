// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// With LAMMPS_EXCEPTIONS an error of a single rank ends in MPI_Abort() with the message still in stdio's buffers: a run
/// whose output goes to a file would end without a word.  This MPI_Abort, found before the library's, writes them first.
#include <cstdio>
#include <mpi.h>

extern "C" int MPI_Abort(MPI_Comm comm, int code)
{
  std::fflush(nullptr);
  return PMPI_Abort(comm, code);
}
