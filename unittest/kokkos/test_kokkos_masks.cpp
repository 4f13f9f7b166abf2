// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Checks which copies of the atoms are up to date when forces are evaluated within a step, as on a
// machine whose device has its own memory.  Here both copies share the same memory, so trajectories
// cannot show a difference.  Instead, an atom style keeps the records that the KOKKOS package would
// keep, and styles of the test check them: a pair style and a fix that claim to work on the device,
// and a fix of the host.
//
// A copy counts as modified when sync_atoms() or LAMMPS itself says so.  The test also detects
// values that have changed although neither copy was marked as modified since both were equal.

#include "kokkos/kokkos_trajectories.h"

#include "atom_kokkos.h"
#include "atom_vec_atomic_kokkos.h"
#include "atom_vec_sphere_kokkos.h"
#include "bdh_lammps.h"
#include "force.h"
#include "memory.h"
#include "pair.h"

#include <algorithm>
#include <cmath>
#include <set>

using namespace LAMMPS_NS;
using namespace bdh_test;

namespace {

/// Some releases have a name of its own for the host's copy in the layout of Kokkos.  It is the
/// same memory as the host's other copy wherever both have one layout, as here: see
/// expect_no_fault().
ExecutionSpace memory_of(ExecutionSpace space)
{
  return space == ExecutionSpaceFromDevice<LMPHostType>::space ? Host : space;
}

/// The records of one session.
class Account {
 public:
  void start(const Atom &atom)
  {
    *this = Account();
    on_ = true;
    for (Field &f : fields_) f.equal = values(atom, f);
  }
  void stop() { on_ = false; }

  void modified(ExecutionSpace space, AtomMask mask)
  {
    for (Field &f : fields_)
      if (on_ && (mask & f.mask)) {
        // LAMMPS clears forces on the device whatever their state; read() finds a style that adds
        // to outdated ones.
        const bool cleared =
            (f.mask == F_MASK || f.mask == TORQUE_MASK) && space == Device && mask == f.mask;
        if (f.newest != both && f.newest != space && !cleared)
          fault(f.name + " of both copies are modified, which loses one");
        f.newest = space;
      }
  }
  void synced(const Atom &atom, ExecutionSpace space, AtomMask mask)
  {
    for (Field &f : fields_)
      if (on_ && (mask & f.mask)) {
        if (f.newest == both && space == Device) check_unchanged(atom, f, "LAMMPS on the device");
        if (f.newest == both || f.newest == space) continue;
        f.newest = both;
        f.equal = values(atom, f);
      }
  }
  /// Records that a style working in that space reads data of owned atoms.
  void read(const Atom &atom, ExecutionSpace space, AtomMask mask, const std::string &reader)
  {
    if (!on_) return;
    ++reads;
    for (const Field &f : fields_) {
      if (!(mask & f.mask)) continue;
      if (f.newest != both && f.newest != space) fault(reader + " reads old " + f.name);
      if (f.newest == both) check_unchanged(atom, f, reader);
    }
  }
  std::set<std::string> faults;
  int reads = 0;

 private:
  static constexpr int both = -1;
  struct Field {
    AtomMask mask;
    std::string name;
    int newest = both;
    std::vector<double> equal = {};    // the values when both copies were made equal
  };
  static std::vector<double> values(const Atom &atom, const Field &f)
  {
    const size_t n = atom.nlocal;
    if (f.mask == MASK_MASK) return {atom.mask, atom.mask + n};
    if (f.mask == TAG_MASK) return {atom.tag, atom.tag + n};
    double *const *const v = f.mask == X_MASK   ? atom.x
                             : f.mask == V_MASK ? atom.v
                             : f.mask == F_MASK ? atom.f
                                                : atom.torque;
    return n && v ? std::vector<double>(v[0], v[0] + 3 * n) : std::vector<double>();
  }
  void check_unchanged(const Atom &atom, const Field &f, const std::string &reader)
  {
    if (f.equal != values(atom, f))
      fault(reader + " reads " + f.name + " that were changed without notice");
  }
  void fault(const std::string &text) { faults.insert(text); }

  std::vector<Field> fields_ = {{X_MASK, "positions"}, {V_MASK, "velocities"},
                                {F_MASK, "forces"},    {TORQUE_MASK, "torques"},
                                {MASK_MASK, "groups"}, {TAG_MASK, "ids"}};
  bool on_ = false;
};

Account account;

/// An atom style of the KOKKOS package that keeps the records.
template <class Style> class Accounted : public Style {
 public:
#if BDH_LAMMPS_DATE < 20250204
  using Style::Style;
#else
  explicit Accounted(LAMMPS *lmp) : AtomVec(lmp), Style(lmp) {}    // a virtual base
#endif
  void sync(ExecutionSpace space, AtomMask mask) override
  {
    account.synced(*this->atom, memory_of(space), mask);
    Style::sync(space, mask);
  }
  void modified(ExecutionSpace space, AtomMask mask) override
  {
    account.modified(memory_of(space), mask);
    Style::modified(space, mask);
  }
};

/// Adds forces towards planes of the box, and torques.
void add_forces(const Atom &atom, double strength)
{
  for (int i = 0; i < atom.nlocal; ++i)
    for (int d = 0; d < 3; ++d) {
      const double force = strength * std::sin(0.25 * M_PI * atom.x[i][d] + d);
      atom.f[i][d] += force;
      if (atom.torque_flag) atom.torque[i][d] += force;
    }
}

constexpr AtomMask changed_by_styles = F_MASK | TORQUE_MASK,
                   read_by_pairs = X_MASK | changed_by_styles,
                   changed_by_fixes = changed_by_styles | V_MASK,
                   read_by_fixes = read_by_pairs | V_MASK | MASK_MASK | TAG_MASK;

class PairOfDevice : public Pair {
 public:
  explicit PairOfDevice(LAMMPS *lmp) : Pair(lmp)
  {
    kokkosable = 1;
    execution_space = Device;
    datamask_read = read_by_pairs;
    datamask_modify = changed_by_styles;
    memory_of_pair();
  }
  void compute(int, int) override
  {
    account.read(*atom, Device, read_by_pairs, "a pair style of the device");
    add_forces(*atom, 3.0);
  }
  void settings(int, char **) override {}
  void coeff(int, char **) override
  {
    for (int i = 1; i <= atom->ntypes; ++i)
      for (int j = 1; j <= atom->ntypes; ++j) setflag[i][j] = 1;
  }
  void init_style() override {}
  double init_one(int, int) override { return 2.0; }

 private:
  void memory_of_pair()
  {
    const int n = atom->ntypes + 1;
    memory->create(setflag, n, n, "pair:setflag");
    memory->create(cutsq, n, n, "pair:cutsq");
    memory->create(cutghost, n, n, "pair:cutghost");
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) setflag[i][j] = 0;
    allocated = 1;
  }
};

template <ExecutionSpace space> class FixOf : public Fix {
 public:
  FixOf(LAMMPS *lmp, int narg, char **arg) : Fix(lmp, narg, arg)
  {
    if (space == Host) return;    // the defaults of LAMMPS
    kokkosable = 1;
    execution_space = space;
    datamask_read = read_by_fixes;
    datamask_modify = changed_by_fixes;
  }
  int setmask() override { return FixConst::INITIAL_INTEGRATE | FixConst::POST_FORCE; }
  void initial_integrate(int) override
  {
    account.read(*atom, space, read_by_fixes, "an integrator");
  }
  void post_force(int) override
  {
    account.read(*atom, space, read_by_fixes,
                 space == Host ? "a fix of the host" : "a fix of the device");
    add_forces(*atom, space == Host ? 1.0 : 2.0);
    for (int i = 0; i < atom->nlocal; ++i) atom->v[i][0] += 0.001;
  }
};

template <class Style> AtomVec *make_avec(LAMMPS *lmp) { return new Style(lmp); }
template <class Style> Pair *make_pair(LAMMPS *lmp) { return new Style(lmp); }
template <class Style> Fix *make_fix(LAMMPS *lmp, int narg, char **arg)
{
  return new Style(lmp, narg, arg);
}

/// A fix that moves the group some, and the number of times it evaluates forces within a step.
struct Case {
  std::string name, fix;
  int evaluations;
};

/// Expects no fault during a run.
void expect_no_fault(const Case &c, const std::string &package, const std::string &fixes_after,
                     bool spheres = false)
{
  // In communication between ranks on the device, LAMMPS names the space sometimes by its memory,
  // which without a GPU is that of the host, and sometimes as the device.  Its records of positions
  // are therefore only meaningful on one rank.
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (ranks > 1 && package.find("comm device") != std::string::npos) return;
  LammpsSession lmp(MPI_COMM_WORLD, kokkos_options(package));
  (*lmp->atom->avec_map)["accounted/kk"] = &make_avec<Accounted<AtomVecAtomicKokkos>>;
  (*lmp->atom->avec_map)["accounted/sphere/kk"] = &make_avec<Accounted<AtomVecSphereKokkos>>;
  (*lmp->force->pair_map)["of/device"] = &make_pair<PairOfDevice>;
  (*lmp->modify->fix_map)["of/device"] = &make_fix<FixOf<Device>>;
  (*lmp->modify->fix_map)["of/host"] = &make_fix<FixOf<Host>>;
  std::string scene =
      with(with(lattice_suspension, "pair_style lj/cut 2.5", "pair_style of/device"),
           "pair_coeff 1 1 1.0 1.0", "pair_coeff * *");
  scene = with(scene, "atom_style atomic",
               spheres ? "atom_style accounted/sphere" : "atom_style accounted");
  lmp.script(spheres ? with(scene, "mass 1 1.0", "set type 1 diameter 1.0") : scene);
  lmp.script("neighbor 0.1 bin\ngroup some id 1:40\ngroup rest id 41:64\n" + c.fix + "\n" +
             fixes_after);
  lmp.command("run 0");
  ASSERT_EQ(lmp->atomKK->k_x.view<LMPHostType>().data(), lmp->atom->x[0]);
  ASSERT_EQ(lmp->atomKK->k_f.view<LMPHostType>().data(), lmp->atom->f[0]);
  account.start(*lmp->atom);
  lmp.command("run 8 pre no");
  account.stop();
  for (const std::string &fault : account.faults)
    ADD_FAILURE() << c.fix << ", " << package << ", " << fixes_after << ": " << fault;
  EXPECT_GE(account.reads,
            8 * (1 + c.evaluations));    // by the pair style, at and within each step
}

const std::string fib = " 1.0 1.0 4711 grid 16 20 24", improved = fib + " scheme improved",
                  pse = " 1.0 1.0 4711 radius 0.5 xi 1.0 fft estimate precision double",
                  split = pse + " scheme split substeps 3";

class KokkosMasks : public testing::TestWithParam<Case> {};

}    // namespace

TEST_P(KokkosMasks, NoStyleReadsOutdatedCopies)
{
  for (const std::string package : {"newton on neigh half comm no", "newton off neigh half comm no",
                                    "newton on neigh half comm device"})
    for (const std::string fixes_after :
         {"", "fix a all of/host", "fix a all of/device", "fix a all of/host\nfix b all of/device",
          "fix a all of/device\nfix b all of/host"})
      expect_no_fault(GetParam(), package, "fix inertia rest nve\n" + fixes_after);
  // There is no other integrator to transfer velocities between the fix of the device that changes
  // them and this one.
  expect_no_fault(GetParam(), "newton on neigh half comm no", "fix a all of/device");
  // There is no other integrator to mark velocities as modified.
  for (const std::string fixes_after :
       {"fix a all of/host", "fix a all of/device\nfix b all of/host"})
    expect_no_fault(GetParam(), "newton on neigh half comm no", fixes_after, true);
}

INSTANTIATE_TEST_SUITE_P(
    Fixes, KokkosMasks,
    testing::Values(Case{"FibOfTheHost", "fix move some bd/fib/kk/host" + improved, 1},
                    Case{"PseOfTheHost", "fix move some bd/pse/kk/host" + split, 3},
                    Case{"FibPlain", "suffix off\nfix move some bd/fib" + improved + "\nsuffix on",
                         1},
                    Case{"FibOfTheDevice", "fix move some bd/fib/kk/device" + fib, 0},
                    Case{"FibOfTheDeviceImproved", "fix move some bd/fib/kk/device" + improved, 1},
                    Case{"PseOfTheDevice", "fix move some bd/pse/kk/device" + pse, 0},
                    Case{"PseOfTheDeviceInParts",
                         "fix move some bd/pse/kk/device" + pse + " parts yes check yes", 0},
                    Case{"PseOfTheDeviceSplit", "fix move some bd/pse/kk/device" + split, 3}),
    [](const auto &test) { return test.param.name; });
