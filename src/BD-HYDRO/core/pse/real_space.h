// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The real-space part of positively split Ewald: M_r v over the pairs within r_cut.
/// See PSE (10), App. A.
#ifndef BDH_PSE_REAL_SPACE_H
#define BDH_PSE_REAL_SPACE_H

#include "base/aligned.h"
#include "base/workers.h"
#include "grid/grid.h"
#include "pse/pair_kinds.h"
#include "pse/particles.h"
#include "pse/strain_pairs.h"

#include <utility>
#include <vector>

namespace bdh {

/// A neighbour list as LAMMPS makes it with newton off: pairs of two atoms of this rank once, pairs
/// with a ghost in the list of the atom of this rank.  Atoms are those of this rank first, then
/// ghosts: periodic images of any atom.
struct NeighborView {
  long rows = 0;                            ///< lists
  const int *atom = nullptr;                ///< atom of each list
  const int *count = nullptr;               ///< by atom
  const int *const *neighbors = nullptr;    ///< by atom
  int mask = -1;                            ///< bits of an entry that are the neighbour
  int local_atoms = 0;
  const double *x = nullptr;    ///< by atom, dim each; ghosts where they are
  /// The particle that an atom is, or is an image of: 0 .. owned - 1, from owned on one of another
  /// rank, -1 for none.
  const int *particle = nullptr;
  /// Further entries that the lists of this rank's atoms leave out.
  const std::vector<std::pair<int, int>> *extra = nullptr;
};

/// Fills the entries of v, of `quads` quads per particle, from `owned` on with those of the ranks
/// that own them.  Collective.
struct GhostExchange {
  virtual ~GhostExchange() = default;
  virtual void forward(float *v, int quads) = 0;
  virtual void forward(double *v, int quads) = 0;
};

/// Real: precision of pairs and vectors.  Kind: what the particles are (pse/pair_kinds.h).
///
/// Each worker has a block of particles, a layer of space, and pairs of two blocks are kept by
/// both: no worker writes to what another one may write to.  The order of the sums, and with it
/// their rounding, depends on the number of workers.
template <class Real, class Kind> class RealSpace {
 public:
  /// Has slots entries for each particle, which are whole vector registers.
  using Vector = AlignedArray<Real>;
  using Particles = PseParticles<NeighborView>;

  static constexpr int slots = Kind::slots;

  explicit RealSpace(const PsePlan &plan, const Workers &workers = Workers::one());

  /// Pairs := those of the particles' list within r_cut.  Throws BadParticle for a position that is
  /// not finite.
  void bind(const Particles &particles);
  /// u := M_r v.  v must hold the particles of other ranks too.
  void apply(const Vector &v, Vector &u) const;
  /// The same from stresslets to strains: the other numbers of u are arbitrary.
  void apply_strains(const Vector &v, Vector &u) const;
  /// Both at once: u := M_r v for pairs that are used only once (without noise) and not kept.
  void bind_and_apply(const Particles &particles, const Vector &v, Vector &u);

  long owned() const { return owned_; }
  long all() const { return all_; }
  /// Pairs that the last bind found; those with other ranks count for half.
  double pairs() const;
  std::size_t memory() const;

 private:
  using Pairs = typename Kind::Store;
  /// Pairs of one particle: first those that act on both, then those that act on this one only.
  struct Row {
    int particle;
    long mutual, end;    // ends in the arrays of pairs
  };
  using Direction = PairDirection<Real>;
  /// Pairs of one atom that its row holds, not rounded to Real yet; work space.
  struct Candidates {
    std::vector<int> other;
    AlignedVector separation;    // quads
    AlignedVector r, inverse;    // distance, and 1/distance, or 0 for centers at one place
    void resize(std::size_t n);
  };

  /// A pair with a particle of another block, as that block needs it.
  struct Shared {
    int particle, other;
    typename Kind::Entry entry;
  };
  /// Has cache lines of its own, since workers write to its counts for every pair.
  struct alignas(128) Block {
    std::vector<Row> rows;
    Pairs pairs, one_sided;
    Candidates candidates;
    std::vector<std::vector<Shared>> shared;    // with particles of other blocks, by block
    // Those that other blocks share with particles of this one, by particle.
    std::vector<const Shared *> found;
    std::vector<long> place;    // work space of their sort
    double count = 0.0;
  };

  void divide(const NeighborView &list);
  bool is_in(const Block &block, int particle) const
  {
    return blocks_.size() == 1 || &blocks_[block_of_[particle]] == &block;
  }
  template <class Use> void for_rows(const NeighborView &list, Block &block, Use use);
  long collect(const NeighborView &list, int atom, const int *neighbors, int count,
               Candidates &found) const;
  void tabulate(int particle, long candidates, Block &block) const;
  static Row close_row(int particle, Block &block);
  void adopt(std::size_t b);
  void start(const Vector &v, Vector &u) const;
  void finish(Vector &u) const;
  template <bool strains> void apply_rows(const Vector &v, Vector &u) const;
  template <bool strains>
  static void apply_row(const Pairs &pairs, const Row &row, long first, const Real *v, Real *u);

  const Workers &workers_;
  Kind kind_;
  long owned_ = 0, all_ = 0;
  std::vector<Block> blocks_;    // by worker
  std::vector<int> block_of_;    // by particle of this rank; unused if there is one block
};

extern template class RealSpace<float, EqualSpheres<float>>;
extern template class RealSpace<double, EqualSpheres<double>>;
extern template class RealSpace<float, SizedSpheres<float, Moments::none>>;
extern template class RealSpace<double, SizedSpheres<double, Moments::none>>;
extern template class RealSpace<float, SizedSpheres<float, Moments::torque>>;
extern template class RealSpace<double, SizedSpheres<double, Moments::torque>>;
extern template class RealSpace<float, StrainingSpheres<float>>;
extern template class RealSpace<double, StrainingSpheres<double>>;

}    // namespace bdh
#endif
