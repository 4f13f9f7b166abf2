// fix bd/pse, scheme split: one trajectory whatever the number of ranks; run under mpirun -np 4.

#include "lammps_mobility.h"
#include "lammps_ranks.h"

// Atoms migrate between substeps, and take their noise and displacement along.
TEST(LammpsPseSplitRanks, SameTrajectory)
{
  bdh_test::expect_same_on_all_rank_counts(
      "fix move all bd/pse 0.7 0.9 4711 radius 0.5 xi 1.0 fft estimate precision double scheme split substeps 3", 15);
}
