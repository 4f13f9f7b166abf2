// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// With LAMMPS_EXCEPTIONS an error on a single rank ends in MPI_Abort() while the message is still
/// in the buffers of stdio.  If the output goes to a file, the run would end without a message. The
/// linker finds this MPI_Abort before that of the library; it flushes the buffers first.
#include <cstdio>
#include <mpi.h>

extern "C" int MPI_Abort(MPI_Comm comm, int code)
{
  std::fflush(nullptr);
  return PMPI_Abort(comm, code);
}
