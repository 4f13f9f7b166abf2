/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#ifdef FIX_CLASS
// clang-format off
FixStyle(bd/pse,FixBDPse);
FixStyle(brownian/pse,FixBDPse);
// clang-format on
#else

#ifndef LMP_FIX_BD_PSE_H
#define LMP_FIX_BD_PSE_H

#include "fib/host.h"
#include "fix_bd.h"
#include "pse/probe.h"
#include "pse/step.h"

#include <utility>

namespace LAMMPS_NS {

/// fix bd/pse: positively split Ewald, Fiore et al., J. Chem. Phys. 146, 124116 (2017).
class FixBDPse : public FixBD {
 public:
  FixBDPse(class LAMMPS *, int, char **);
  ~FixBDPse() override;

  int setmask() override;
  void init_list(int, class NeighList *) override;
  void setup(int) override;
  void setup_post_neighbor() override { post_neighbor(); }
  void post_neighbor() override;
  int pack_forward_comm(int, int *, double *, int, int *) override;
  void unpack_forward_comm(int, int, double *) override;
  void grow_arrays(int) override;
  void set_arrays(int) override;
  int pack_restart(int, double *) override;
  void unpack_restart(int, int) override;
  int maxsize_restart() override { return restart_columns; }
  int size_restart(int) override { return restart_columns; }

 protected:
  void check_box() const override;
  void build() override;
  std::string plan_text() const override;
  void step(bdh::Particles &particles) override;
  double longest_move() const override { return figures_.radius; }
  const char *longest_move_name() const override { return "the radius"; }
  double mobility_memory() const override;
  bool uses_midpoint_forces() const override { return options_.split; }
  const char *midpoint_scheme() const override { return "split"; }
  const char *other_scheme() const override { return "euler"; }
  bool uses_unwrapped_positions() const override { return false; }
  bool keeps_neighbor_list() const override { return true; }
  int carried_columns() const override
  {
    return options_.split ? split_columns : options_.parts ? 6 : 0;
  }
  virtual bdh::NeighborView neighbor_view() const;
  /// Leaves the pairs (i, j), i of this rank, that the neighbor list does not hold.
  virtual void drop_listed_pairs(std::vector<std::pair<int, int>> &pairs) const;
  /// Ghosts := where their atoms are.
  virtual void refresh_ghosts();
  /// Collective.  The mobility of plan_; its grid's bytes on this rank.
  virtual double make_mobility();
  /// Collective.  The mobility's cell := cell(); as PseMobility::set_cell().
  virtual bool update_cell() { return mobility_->set_cell(cell()); }
  /// Grid points along the edges, as the mobility has them now.
  virtual std::array<long, 3> grid_points() const { return mobility_->plan().n; }
  /// Of the neighbor list that was asked for last.
  virtual void adjust_request(class NeighRequest &) const {}

  bdh::Cell cell() const;
  /// Collective.  particle_of_ for atoms and ghosts as they are now.
  void map_particles();
  /// Collective.  What goes with the neighbor list and the group := as they are now.
  virtual void renew_neighbors() { map_particles(); }
  /// Collective, after renew_neighbors().  The mobility of the fix, or one that is made for another
  /// plan.
  virtual std::unique_ptr<bdh::PseProbe> probe(const bdh::PsePlan *other);
  /// Of a mobility that is made for a moment, whose noise is to be closer to its limit.
  int more_iterations() const { return 10 * options_.iterations; }
  void follow_box();
  /// Lanczos' complaint, with what to do about it.
  template <class Body> void with_remedy(Body body)
  {
    try {
      body();
    } catch (const bdh::NotConverged &e) {
      throw bdh::NotConverged(std::string(e.what()) +
                              ": use more iterations, a larger xi or a looser tolerance");
    }
  }

  bdh::PseStepPlan plan_step() const;
  void keep_report(const bdh::PseReport &report);
  /// One step of the scheme, and what it has to say.
  template <class Step> void take_with(Step &step, typename Step::Particles &particles,
                                       typename Step::Surroundings &around,
                                       typename Step::Mobility &mobility)
  {
    with_remedy([&] {
      const auto take = options_.split   ? &Step::split
                        : options_.parts ? &Step::euler_in_parts
                                         : &Step::euler;
      keep_report((step.*take)(particles, around, mobility, plan_step()));
    });
    if (options_.parts) keep_parts(step.by_forces(), step.by_noise());
  }

  // With scheme split, after those of forces within the step: the last near noise in units of the
  // root of the mobility, 1 if there is one, and the displacement since the beginning of the step.
  static constexpr int last_noise = midpoint_columns, has_noise = last_noise + 3,
                       moved = has_noise + 1, split_columns = moved + 3;

  class NeighList *list_ = nullptr;
  bdh::PseOptions options_;
  bdh::PsePlan plan_;
  bdh::PsePlan check_plan_;    // of keyword check
  bool neighbors_changed_ = true;
  std::vector<int> particle_of_;    // by atom, ghosts included: place among the particles; -1: none
  std::vector<std::pair<int, int>> unlisted_;    // pairs that special_bonds keeps out of the list;
                                                 // of two atoms of this rank once

 private:
  class Ghosts;
  friend class Ghosts;
  class Around;
  friend class Around;
  using HostStep = bdh::PseStep<bdh::HostBackend, bdh::NeighborView>;
  enum class Message { owners, single_vector, double_vector };

  double common_radius() const;
  void check_neighbor_style() const;
  bdh::PseScene scene() const;
  void request_neighbors();
  void allow_neighbors(double cutoff);
  void map_ghosts();
  void find_unlisted_pairs();
  std::string scheme_text() const;
  double far_stiffness() const;
  void keep_parts(const std::vector<double> &by_forces, const std::vector<double> &by_noise);
  bdh::PsePlan plan_of_check() const;
  double list_cutoff() const;
  void check_tolerance(const bdh::Particles &particles);
  double norm(const std::vector<double> &v) const;
  double relative_difference(std::vector<double> u, const std::vector<double> &exact) const;
  void forward(void *vector, Message message);
  double entry(int p, int c) const;
  void set_entry(int p, int c, double value);

  static constexpr int restart_columns = 5;

  bool has_mobility_ = false;
  double grid_memory_ = 0.0;    // bytes on this rank when the grid was made
  double split_price_ =
      0.0;    // of plan_, if its splitting was chosen for scheme split: pse_split_price()
  std::string ghost_note_;
  double ghost_cutoff_ = 0.0;    // for which the note was made
  std::unique_ptr<Ghosts> ghosts_;
  std::unique_ptr<Around> around_;
  std::unique_ptr<bdh::PseMobility> mobility_;
  std::unique_ptr<HostStep> step_{new HostStep};

  std::vector<int> mapped_atoms_;    // group_atoms() for which particle_of_ was made
  std::vector<int> owner_;           // by atom: its rank
  long all_particles_ = 0;           // with ghosts of other ranks

  int arrays_size_ = 0;    // atoms that carried_ has been cleared for
  Message message_ = Message::owners;
  void *vector_ = nullptr;
};

}    // namespace LAMMPS_NS
#endif
#endif
