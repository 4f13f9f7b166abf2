// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "base/comm.h"

#include "base/phases.h"

namespace bdh {

Comm::Comm(MPI_Comm handle) : handle_(handle)
{
  MPI_Comm_rank(handle, &rank_);
  MPI_Comm_size(handle, &size_);
}

double Comm::sum(double mine) const
{
  if (size_ == 1) return mine;
  const PhaseScope sum(Phase::communicate);
  double all = 0.0;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, handle_);
  return all;
}

double Comm::greatest(double mine) const
{
  if (size_ == 1) return mine;
  const PhaseScope greatest(Phase::communicate);
  double all = 0.0;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_MAX, handle_);
  return all;
}

bool any_rank(const Comm &comm, bool mine)
{
  int flag = mine, any = 0;
  MPI_Allreduce(&flag, &any, 1, MPI_INT, MPI_MAX, comm.handle());
  return any != 0;
}

}    // namespace bdh
