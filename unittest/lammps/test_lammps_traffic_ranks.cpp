// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// What a run sends: the numbers of ghosts are counted exactly, and the line below the timing table
// has the counters.  Run under mpirun -np 4, which takes the first 1, 2, 3 and 4 ranks in turn.

#include "support/mpi_traffic.h"

#include "bdh_ghosts.h"
#include "lammps/lammps_ranks.h"
#include "update.h"

using namespace bdh_test;

namespace {

/// A fix that exchanges numbers of its atoms, as fix bd/pse does.
class FixGhosts : public LAMMPS_NS::Fix {
 public:
  FixGhosts(LAMMPS_NS::LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg), ghosts_(lmp, this)
  {
    comm_forward = 3;
  }
  int setmask() override { return 0; }
  int pack_forward_comm(int n, int *list, double *buffer, int, int *) override
  {
    return ghosts_.pack(n, list, buffer);
  }
  void unpack_forward_comm(int n, int first, double *buffer) override
  {
    ghosts_.unpack(n, first, buffer);
  }
  /// Numbers all atoms, and sends a quad of each to its ghosts.
  void exchange()
  {
    std::vector<int> atoms(atom->nlocal);
    for (int i = 0; i < atom->nlocal; ++i) atoms[i] = i;
    ghosts_.map(atoms);
    std::vector<double> v(4 * ghosts_.all(), 1.0);
    ghosts_.forward(v.data(), 1);
  }

 private:
  LAMMPS_NS::GhostNumbers ghosts_;
};

/// Messages, bytes and sums a step in the line of the last run: mean and greatest.  Empty if there
/// is no line.
std::vector<double> line_of(const std::string &log)
{
  const std::string words = "Sent per step and process, mean (most): ";
  const std::size_t begin = log.rfind(words);
  if (begin == std::string::npos) return {};
  std::vector<double> v(6);
  std::sscanf(log.c_str() + begin + words.size(),
              "%lf (%lf) messages, %lf (%lf) bytes; %lf (%lf) sums", &v[0], &v[1], &v[2], &v[3],
              &v[4], &v[5]);
  return v;
}

}    // namespace

TEST(LammpsTraffic, GhostsAreCountedAsMpiSendsThem)
{
  for (int ranks = 1; ranks <= all_ranks(); ++ranks)
    for (const char *style : {"brick", "tiled"})
      on_ranks(ranks, bonded_suspension, "", [&](LammpsSession &lmp) {
        (*lmp->modify->fix_map)["bdh/ghosts"] = [](LAMMPS_NS::LAMMPS *l, int narg,
                                                   char **arg) -> LAMMPS_NS::Fix * {
          return new FixGhosts(l, narg, arg);
        };
        lmp.command(std::string("comm_style ") + style);
        lmp.command("comm_modify cutoff 3.0");
        if (std::string(style) == "tiled") lmp.command("balance 1.0 rcb");
        lmp.command("fix 1 all bdh/ghosts");
        lmp.command("run 0");
        const bdh::Traffic sent = sent_by(style + std::to_string(ranks), [&] {
          static_cast<FixGhosts *>(lmp.fix("1"))->exchange();
        });
        EXPECT_EQ(sent.bytes > 0, ranks > 1) << style << " " << ranks;
      });
}

TEST(LammpsTraffic, LineHasTheCounters)
{
  const int steps = 10;
  for (const char *fix : {"fix 1 all bd/fib 0.7 0.9 4711 grid 20 24 16",
                          "fix 1 all bd/pse 0.7 0.9 4711 radius 1.0 tolerance 1e-2"})
    for (int ranks = 1; ranks <= all_ranks(); ++ranks)
      on_ranks(ranks, bonded_suspension, "", [&](LammpsSession &lmp) {
        lmp.command(fix);
        lmp.command("run 1");
        const bdh::Traffic before = bdh::Traffic::mine();
        lmp.command("run " + std::to_string(steps) + " pre no");
        const bdh::Traffic sent = bdh::Traffic::mine().since(before);
        const double mine[3] = {double(sent.messages), double(sent.bytes), double(sent.sums)};
        double all[3], most[3];
        MPI_Allreduce(mine, all, 3, MPI_DOUBLE, MPI_SUM, lmp->world);
        MPI_Allreduce(mine, most, 3, MPI_DOUBLE, MPI_MAX, lmp->world);
        if (my_rank()) return;
        const std::vector<double> line = line_of(lmp.log());
        if (ranks == 1) {
          EXPECT_TRUE(line.empty());
          return;
        }
        ASSERT_EQ(line.size(), 6u);
        for (int k = 0; k < 3; ++k) {
          // The line has six digits.
          EXPECT_NEAR(line[2 * k], all[k] / steps / ranks, 1e-5 * line[2 * k]) << fix << " " << k;
          EXPECT_NEAR(line[2 * k + 1], most[k] / steps, 1e-5 * line[2 * k + 1]) << fix << " " << k;
        }
        EXPECT_GT(line[0], 0.0);
      });
}
