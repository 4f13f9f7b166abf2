/// The host's answers to "what differs between host and device".
#ifndef BDH_HOST_H
#define BDH_HOST_H

#include "bdh_any_stokes.h"
#include "bdh_comm.h"
#include "bdh_spread.h"
#include "bdh_types.h"

namespace bdh {

/// A backend names its vector, and its loop nests for spreading and for the modes.  Algorithms are templates over it.
struct HostBackend {
  using Vector = AlignedVector;
  using Spreader = HostSpreader;
  using Stokes = AnyStokes;
};

}    // namespace bdh
#endif
