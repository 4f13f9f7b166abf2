// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The stiffness of a step, over all particles: see base/stiffness_kernel.h.
#ifndef BDH_BASE_STIFFNESS_H
#define BDH_BASE_STIFFNESS_H

#include "base/stiffness_kernel.h"

#include <cmath>

namespace bdh {

/// Sums and the greatest number of the particles of one rank.
struct StepStiffness {
  double reaction = 0.0;    ///< sum of dt mu |dF|^2 [energy]
  double work = 0.0;        ///< sum of dF.dq [energy]
  double largest = 0.0;     ///< p
  double change = 0.0;      ///< the greatest |dF| [force]
  long stiffest = -1;       ///< the particle that has it; -1: no force has changed
};

template <class Execution>
StepStiffness stiffness_of_step(const Execution &execution, long n, const StiffnessOf &of)
{
  StepStiffness s;
  s.reaction = execution.sum("bdh::reaction", n, Reaction{of});
  if (!(s.reaction > 0.0)) return s;
  s.work = execution.sum("bdh::work", n, WorkOfChange{of});
  s.change = execution.greatest("bdh::change", n, ChangeOfForce{of});
  s.largest = execution.greatest("bdh::stiffness", n, StiffnessNumber{of});
  s.stiffest = execution.first("bdh::stiffest", n, IsAsStiffAs{of, s.largest});
  return s;
}

/// The number p of contacts on average, each of them weighted with its |dF.dq|; 0 if no force has
/// changed.
inline double mean_stiffness(double reaction, double work)
{
  return reaction > 0.0 && work != 0.0 ? reaction / std::fabs(work) : 0.0;
}

}    // namespace bdh
#endif
