/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "fix_bd_pse.h"

#include "atom.h"
#include "base/rng_kernel.h"
#include "bdh_lammps.h"
#include "citeme.h"
#include "comm.h"
#include "domain.h"
#include "fix_deform.h"
#include "force.h"
#include "group.h"
#include "math_extra.h"
#include "modify.h"
#include "neigh_list.h"
#include "neigh_request.h"
#include "neighbor.h"
#include "pair.h"
#include "update.h"

#include <algorithm>
#include <cmath>

using namespace LAMMPS_NS;
using namespace FixConst;

static const char cite_fix_bd_pse[] =
    "fix bd/pse: doi:10.1063/1.4978242\n\n"
    "@Article{Fiore2017,\n"
    " author = {A. M. Fiore and F. {Balboa Usabiaga} and A. Donev and J. W. Swan},\n"
    " title = {Rapid sampling of stochastic displacements in {B}rownian dynamics simulations},\n"
    " journal = {J.~Chem.\\ Phys.},\n"
    " volume = {146},\n"
    " pages = {124116},\n"
    " year = {2017}\n"
    "}\n\n";

// Per particle; plans of xi auto have a tenth of it.
static constexpr double many_neighbors = 5000.0;

/// The group of comm_modify group, which LAMMPS shows to its own derived classes only.
struct BorderGroup : Comm {
  static int Comm::*of_comm() { return &BorderGroup::bordergroup; }
};

/* ----------------------------------------------------------------------
   vectors of the core, whose entries beyond this rank's particles are filled by LAMMPS'
communication
------------------------------------------------------------------------- */

class FixBDPse::Ghosts : public bdh::GhostExchange {
 public:
  explicit Ghosts(FixBDPse &fix) : fix_(fix) {}
  void forward(float *v) override { fix_.forward(v, Message::single_vector); }
  void forward(double *v) override { fix_.forward(v, Message::double_vector); }

 private:
  FixBDPse &fix_;
};

/* ----------------------------------------------------------------------
   what lies around the particles
------------------------------------------------------------------------- */

class FixBDPse::Around : public bdh::PseSurroundings<bdh::NeighborView> {
 public:
  explicit Around(FixBDPse &fix) : fix_(fix) {}
  bool look(bool mine) override
  {
    int here[2] = {fix_.group_atoms() != fix_.mapped_atoms_, mine},
        anywhere[2];    // a dynamic group may change on one rank alone
    MPI_Allreduce(here, anywhere, 2, MPI_INT, MPI_MAX, fix_.world);
    if (fix_.neighbors_changed_ || anywhere[0]) fix_.map_particles();
    return anywhere[1];
  }
  bdh::NeighborView neighbors() override { return fix_.neighbor_view(); }
  long all() override { return fix_.all_particles_; }
  bdh::KeptByAtom kept() override
  {
    const std::vector<int> &atoms = fix_.group_atoms();
    if (atoms.empty()) return {};
    double *carried = fix_.carried_[0];
    return {atoms.data(), carried + moved, split_columns, carried + last_noise, split_columns};
  }

 private:
  FixBDPse &fix_;
};

/* ---------------------------------------------------------------------- */

FixBDPse::FixBDPse(LAMMPS *lmp, int narg, char **arg) :
    FixBD(lmp, narg, arg), ghosts_(new Ghosts(*this)), around_(new Around(*this))
{
  if (lmp->citeme) lmp->citeme->add(cite_fix_bd_pse);
  run_core(
      error, name_,
      [&] {
        options_ = bdh::parse_pse_options({arg + 3, arg + narg});
      },
      [](long) { return std::string(); });
  if (options_.radius == 0.0 && !atom->radius_flag)
    error->all(
        FLERR,
        "{}: radius = atom, but the atoms of atom_style {} have no radius: give one as radius a",
        name_, atom->atom_style);
  comm_forward = 3;
  if (options_.parts) {
    peratom_flag = 1;
    size_peratom_cols = 6;
    peratom_freq = 1;
    create_attribute = 1;
  }
  if (options_.split) create_attribute = restart_peratom = 1;
  set_common(options_.temperature, options_.viscosity, options_.seed);
}

FixBDPse::~FixBDPse() = default;

int FixBDPse::setmask() { return FixBD::setmask() | POST_NEIGHBOR; }

void FixBDPse::grow_arrays(int nmax)
{
  FixBD::grow_arrays(nmax);
  array_atom = carried_;
  for (; arrays_size_ < nmax; ++arrays_size_) set_arrays(arrays_size_);
}

/// An atom that was not there at the last step has not been displaced.
void FixBDPse::set_arrays(int i)
{
  if (carried_) std::fill_n(carried_[i], carried_columns(), 0.0);
}

/// The last near noise: the next step needs it.
int FixBDPse::pack_restart(int i, double *buffer)
{
  buffer[0] = restart_columns;
  std::copy_n(carried_[i] + last_noise, 4, buffer + 1);
  return restart_columns;
}

void FixBDPse::unpack_restart(int i, int which)
{
  if (!options_.split) return;    // a run with scheme split that goes on with euler
  const double *values = atom->extra[i];
  for (int k = 0; k < which; ++k) values += static_cast<int>(values[0]);
  std::copy_n(values + 1, 4, carried_[i] + last_noise);
}

void FixBDPse::check_box() const
{
  if (lmp->kokkos && !kokkosable)
    error->all(FLERR,
               "{}: the KOKKOS package's copies of the atoms are not kept up to date: use "
               "bd/pse/kk (-sf kk), or run "
               "without -k on",
               name_);
  if (domain->dimension == 2)
    error->all(FLERR,
               "{}: the simulation is two-dimensional, but the Rotne-Prager-Yamakawa mobility is "
               "not: use fix bd/fib",
               name_);
  if (!domain->xperiodic || !domain->yperiodic || !domain->zperiodic)
    error->all(FLERR,
               "{}: the box must be periodic in all directions, since Ewald sums know no walls: "
               "use boundary p p p, "
               "or fix bd/fib for confined suspensions",
               name_);
  for (int f = 0; f < modify->nfix; ++f) {
    const FixDeform *deform = dynamic_cast<const FixDeform *>(modify->fix[f]);
    if (!deform) continue;
    if (deform->remapflag == Domain::V_REMAP)
      error->all(FLERR,
                 "{}: fix {} deform remaps velocities, which here are displacement/timestep: use "
                 "remap x, which "
                 "carries particles along with the flow",
                 name_, deform->id);
    if (deform->remapflag == Domain::NO_REMAP && comm->me == 0)
      error->warning(FLERR,
                     "{}: fix {} deform changes the box but does not carry particles along (remap "
                     "none): there is "
                     "no flow; use remap x for one",
                     name_, deform->id);
  }
}

/// What would hide pairs from the neighbour list, or make it unable to have a cutoff of its own.
void FixBDPse::check_neighbor_style() const
{
  if (neighbor->style != Neighbor::BIN)
    error->all(FLERR,
               "{}: neighbor style must be bin, which alone allows lists with a cutoff of their "
               "own: use neighbor {} bin",
               name_, neighbor->skin);
  if (comm->mode != Comm::SINGLE)
    error->all(
        FLERR,
        "{}: ghosts are needed up to one distance for all atoms: use comm_modify mode single",
        name_);
  const int with_ghosts = comm->*BorderGroup::of_comm();
  if (with_ghosts && with_ghosts != igroup)
    error->all(FLERR,
               "{}: comm_modify group {} keeps ghosts of other atoms from the fix: use comm_modify "
               "group {}",
               name_, group->names[with_ghosts], group->names[igroup]);
  // LAMMPS' own is a millimetre in units si.
  const double longest = MAX(MAX(domain->prd[0], domain->prd[1]), domain->prd[2]);
  if (neighbor->skin > longest)
    error->all(FLERR,
               "{}: neighbor skin = {}, but must be at most the longest edge of the box, {}: use "
               "neighbor {:.1g} bin",
               name_, neighbor->skin, longest, 0.3 * figures_.radius);
  if (neighbor->build_once)
    error->all(FLERR,
               "{}: neigh_modify once yes keeps the neighbor lists of the first step: use once no",
               name_);
  // neighbor->exclude is of the last run, before the first one of nothing.
  if (neighbor->nex_type || neighbor->nex_group || neighbor->nex_mol)
    error->all(FLERR,
               "{}: neigh_modify exclude keeps pairs out of all neighbor lists, but they interact "
               "through the fluid: "
               "use neigh_modify exclude none, and set the interactions to zero in the pair style",
               name_);
  if (neighbor->includegroup && neighbor->includegroup != igroup)
    error->all(FLERR,
               "{}: neigh_modify include keeps atoms of group {} out of the neighbor lists: use "
               "include {}",
               name_, group->names[igroup], group->names[igroup]);
  if (atom->molecular == Atom::TEMPLATE)
    error->all(
        FLERR,
        "{}: atom_style template is not supported: use atom_style bond, angle, molecular or full",
        name_);
}

/// Radius of all particles, given or of the atoms.
double FixBDPse::common_radius() const
{
  if (options_.radius > 0.0) return options_.radius;
  const std::array<double, 2> range = radius_range();
  const double least = range[0], greatest = range[1];
  if (least > greatest) return 1.0;    // an empty group
  if (!(least > 0.0))
    error->all(FLERR, "{}: an atom has radius {}, but must be > 0: use set ... diameter", name_,
               least);
  if (greatest - least > 1e-10 * greatest)
    error->all(FLERR,
               "{}: the atoms' radii go from {} to {}, but must be equal: set them with set ... "
               "diameter, or give "
               "one as radius a",
               name_, least, greatest);
  return greatest;
}

bdh::Cell FixBDPse::cell() const
{
  bdh::Cell c;
  for (int d = 0; d < 3; ++d) c.lo[d] = domain->boxlo[d];
  c.lx = domain->prd[0];
  c.ly = domain->prd[1];
  c.lz = domain->prd[2];
  if (domain->triclinic) {
    c.xy = domain->xy;
    c.xz = domain->xz;
    c.yz = domain->yz;
  }
  return c;
}

bdh::PseScene FixBDPse::scene() const
{
  bdh::Cell widest = cell();
  if (domain->box_change_shape) {    // the tilts between two flips
    widest.xy = MAX(std::fabs(widest.xy), 0.5 * widest.lx);
    widest.xz = MAX(std::fabs(widest.xz), 0.5 * widest.lx);
    widest.yz = MAX(std::fabs(widest.yz), 0.5 * widest.ly);
  }
  bdh::PseScene s;
  s.volume = widest.volume();
  for (int d = 0; d < 3; ++d) s.edge[d] = widest.edge(d);
  s.particles = MAX(static_cast<bigint>(1), group->count(igroup));
  s.radius = figures_.radius;
  s.noise = temperature_.is_variable() || temperature_.value > 0.0;
  s.tolerance = options_.tolerance;
  s.xi = options_.xi;
  s.substeps = options_.substeps;
  s.precision = options_.precision;
  return s;
}

void FixBDPse::build()
{
  figures_.radius = common_radius();
  check_neighbor_style();
  const bdh::PsePlan plan = bdh::plan_pse(scene());
  const bool same = has_mobility_ && plan.xi == plan_.xi && plan.r_cut == plan_.r_cut &&
                    plan.k_cut == plan_.k_cut && plan.n == plan_.n && plan.radius == plan_.radius &&
                    plan.volume == plan_.volume && plan.window.width == plan_.window.width &&
                    plan.window.beta == plan_.window.beta;
  plan_ = plan;
  if (plan_.neighbors > many_neighbors && comm->me == 0)
    error->warning(FLERR,
                   "{}: xi = {} makes about {:.0f} neighbors per particle, which take long and "
                   "much memory: use a larger one, or "
                   "xi auto",
                   name_, plan_.xi, plan_.neighbors);
  if (options_.check) check_plan_ = plan_of_check();
  if (!same) grid_memory_ = make_mobility();
  if (!same && options_.split && options_.xi == 0.0)
    split_price_ = bdh::pse_split_price(plan, scene());
  has_mobility_ = true;
  update_cell();
  figures_.spacing = plan_.spacing;
  if (options_.split && far_stiffness() > 1.0 && comm->me == 0)
    error->warning(FLERR,
                   "{}: xi = {}: a far step is {:.3g} times as stiff as a near one, but should be "
                   "at most as stiff: use "
                   "xi auto, or fewer substeps",
                   name_, plan_.xi, far_stiffness());
  request_neighbors();
}

double FixBDPse::make_mobility()
{
  mobility_.reset();    // frees its memory first
  mobility_ = bdh::make_pse(plan_, bdh::Comm(world), options_.effort, options_.iterations,
                            ghosts_.get(), workers());
  return static_cast<double>(mobility_->grid_memory());
}

/// Of the neighbor list [distance].
double FixBDPse::list_cutoff() const
{
  return MAX(plan_.r_cut, options_.check ? check_plan_.r_cut : 0.0) + neighbor->skin;
}

void FixBDPse::request_neighbors()
{
  const int index = neighbor->request(this, instance_me);
  NeighRequest &request = *neighbor->requests[index];
  request.pair = 0;
  request.fix = 1;
  request.newton = 2;
  request.cut = 1;
  request.cutoff = list_cutoff();
  adjust_request(request);
  allow_neighbors(request.cutoff);
  if (comm->cutghostuser >= request.cutoff) {
    if (ghost_cutoff_ != request.cutoff)
      ghost_note_.clear();    // else it was this fix that set it, in a run before
    return;
  }
  ghost_note_.clear();
  ghost_cutoff_ = request.cutoff;
  const double others =
      MAX(comm->cutghostuser, force->pair ? force->pair->cutforce + neighbor->skin : 0.0);
  if (others < request.cutoff)
    ghost_note_ = fmt::format("kept within {:.4g} of each process' domain (the pair style and "
                              "comm_modify ask for {:.4g})",
                              request.cutoff, others);
  comm->cutghostuser = request.cutoff;
}

/// LAMMPS' own limit of neighbors per atom is meant for pair styles: room for spheres that touch,
/// or thrice the average.
void FixBDPse::allow_neighbors(double cutoff)
{
  const double across = cutoff / plan_.radius,
               average = plan_.neighbors * std::pow(cutoff / plan_.r_cut, 3.0);
  const int most =
      static_cast<int>(MIN(1e7, MAX(0.74 * across * across * across, 3.0 * average + 200.0)));
  if (neighbor->oneatom < most) neighbor->oneatom = most;
  if (neighbor->pgsize < 10 * neighbor->oneatom) neighbor->pgsize = 10 * neighbor->oneatom;
}

void FixBDPse::init_list(int, NeighList *list) { list_ = list; }

void FixBDPse::refresh_ghosts() { comm->forward_comm(); }

double FixBDPse::mobility_memory() const
{
  return mobility_ ? static_cast<double>(mobility_->grid_memory() + mobility_->particle_memory() +
                                         step_->memory())
                   : 0.0;
}

/* ---------------------------------------------------------------------- */

std::string FixBDPse::plan_text() const
{
  const double a = figures_.radius;
  std::string out = fmt::format("{}: plan (BD-HYDRO {})\n", name_, package_version());
  const auto line = [&out](const char *what, const std::string &text) {
    out += fmt::format("  {:<12} {}\n", what, text);
  };
  line("tolerance", fmt::format("{:g}: relative error of the velocities M F{}", plan_.tolerance,
                                kT_ > 0.0 ? " and of the random ones" : ""));
  line("radius",
       fmt::format("{:.6g} ({})", a, options_.radius > 0.0 ? "as given" : "of the atoms"));
  line("splitting",
       fmt::format("xi = {:.4g} = {:.4g}/radius ({})", plan_.xi, plan_.xi * a,
                   options_.xi > 0.0 ? "as given"
                   : options_.split  ? "the cheapest by the cost model for these substeps"
                                     : "the cheapest by the cost model"));
  line("real space",
       fmt::format("pairs within r_c = {:.4g} = {:.3g} radii, about {:.0f} neighbors per particle",
                   plan_.r_cut, plan_.r_cut / a, plan_.neighbors));
  line("wave space",
       fmt::format(
           "{} x {} x {} points, window of {} points per axis, modes with |k| <= k_c = {:.4g}",
           plan_.n[0], plan_.n[1], plan_.n[2], plan_.window.width, plan_.k_cut));
  const bdh::PseErrors &e = plan_.errors;
  line("errors",
       fmt::format(
           "expected {:.2g}: real space {:.1g}, wave space {:.1g}, window {:.1g}, rounding {:.1g}",
           e.total(), e.real_space, e.wave_space, e.window, e.rounding));
  line("precision",
       fmt::format("{} for grid, transforms and pairs ({}); all else in double",
                   plan_.single ? "single" : "double",
                   options_.precision != bdh::Precision::automatic ? "as given"
                   : plan_.single                                  ? "tolerance 1e-4 or looser"
                   : plan_.tolerance < 1e-4                        ? "tolerance tighter than 1e-4"
                                            : "the rounding of so many pairs adds up"));
  line("scheme", scheme_text());
  line("noise", kT_ > 0.0 ? fmt::format("real space by Lanczos, about {} iterations; wave space "
                                        "within the transforms of the forces",
                                        plan_.iterations)
                          : "off: temperature 0, so neither Lanczos nor random numbers");
  line("drift", "none: div M = 0 in a periodic box");
  if (options_.parts)
    line("parts",
         "kept per atom: the forces and the noise need a set of transforms each (keyword parts)");
  if (domain->box_change_shape || domain->box_change_size)
    line("box", "changes during the run: wave vectors follow it, and the grid when it must");
  if (!ghost_note_.empty()) line("ghosts", ghost_note_);
  if (temperature_.is_variable() || viscosity_.is_variable())
    line("variables", fmt::format("temperature {:.6g} and viscosity {:.6g} now",
                                  figures_.temperature, figures_.viscosity));
  line("cost",
       fmt::format(
           "{:.2g} s in real space, {:.2g} s in wave space per step on one core, by the cost model",
           plan_.real_seconds, plan_.wave_seconds));
  if (options_.split && options_.xi == 0.0)
    line("", fmt::format("a unit of time costs {:.2g} times as much as with scheme euler at "
                         "timestep {:.4g}; forces not counted",
                         split_price_, update->dt / options_.substeps));
  line("memory",
       fmt::format("{:.3g} MB for the grid on the first process", grid_memory_ / 1048576.0));
  return out;
}

std::string FixBDPse::scheme_text() const
{
  if (!options_.split) return "Euler-Maruyama: 1 evaluation of the mobility, forces once a step";
  const int n = options_.substeps;
  return fmt::format("split: 1 far step of {:.4g}, then {} near step{} of {:.4g}, forces {} times "
                     "a step; for touching spheres a far "
                     "step is {:.2g} times as stiff as a near one",
                     update->dt, n, n > 1 ? "s" : "", update->dt / n, n + 1, far_stiffness());
}

/// How stiff a far step is beside a near one: k mu dt of two touching spheres along their line.
double FixBDPse::far_stiffness() const
{
  const double share = bdh::pse_far_share(plan_.xi * plan_.radius);
  return options_.substeps * share / (1.0 - share);
}

/* ----------------------------------------------------------------------
   particles and ghosts
------------------------------------------------------------------------- */

/// particle_of_ for atoms and ghosts.
void FixBDPse::map_particles()
{
  const std::vector<int> &atoms = group_atoms();
  const int all = atom->nlocal + atom->nghost;
  mapped_atoms_ = atoms;
  particle_of_.assign(all, -1);
  for (size_t p = 0; p < atoms.size(); ++p) particle_of_[atoms[p]] = static_cast<int>(p);
  map_ghosts();
  neighbors_changed_ = false;
}

/// Images of this rank's particles get the particle's own place, the others places after them.  A
/// ghost of a ghost may have come home again, so the owner is passed on with it.
void FixBDPse::map_ghosts()
{
  owner_.assign(particle_of_.size(), comm->me);
  forward(nullptr, Message::owners);
  all_particles_ = bdh::ssize(mapped_atoms_);
  for (int i = atom->nlocal; i < atom->nlocal + atom->nghost; ++i)
    if (particle_of_[i] >= 0 && owner_[i] != comm->me)
      particle_of_[i] = static_cast<int>(all_particles_++);
}

void FixBDPse::post_neighbor()
{
  neighbors_changed_ = true;
  find_unlisted_pairs();
}

/// Bonded atoms with special_bonds 0 are missing in the list as far as they are nearest images, of
/// which the plain and the KOKKOS package have different notions: hence the look into the list.  To
/// be called at the positions of the list.
void FixBDPse::find_unlisted_pairs()
{
  unlisted_.clear();
  if (atom->molecular == Atom::ATOMIC) return;
  double *const *const x = atom->x;
  const double cutoff = list_cutoff();
  for (int i = 0; i < atom->nlocal; ++i)
    for (int level = 0, k = 0; level < 3; ++level)
      for (; k < atom->nspecial[i][level]; ++k) {
        if (neighbor->special_flag[level + 1] != 0) continue;
        for (int j = atom->map(atom->special[i][k]); j >= 0; j = atom->sametag[j])
          if ((j >= atom->nlocal || i < j) && MathExtra::distsq3(x[i], x[j]) <= cutoff * cutoff)
            unlisted_.emplace_back(i, j);
      }
  drop_listed_pairs(unlisted_);
}

void FixBDPse::drop_listed_pairs(std::vector<std::pair<int, int>> &pairs) const
{
  if (pairs.empty()) return;
  const bdh::NeighborView list = neighbor_view();
  const auto holds = [&](int i, int j) {
    const int *row = list.neighbors[i], *end = row + list.count[i];
    return std::any_of(row, end, [&](int entry) { return (entry & list.mask) == j; });
  };
  const auto is_listed = [&](const std::pair<int, int> &p) {
    return holds(p.first, p.second) || (p.second < list.local_atoms && holds(p.second, p.first));
  };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), is_listed), pairs.end());
}

void FixBDPse::forward(void *vector, Message message)
{
  const bdh::PhaseScope forwarding(bdh::Phase::communicate);
  message_ = message;
  vector_ = vector;
  comm->forward_comm_fix(this, message == Message::owners ? 2 : 3);
}

int FixBDPse::pack_forward_comm(int n, int *list, double *buf, int, int *)
{
  int m = 0;
  for (int k = 0; k < n; ++k) {
    const int i = list[k], p = particle_of_[i];
    if (message_ == Message::owners) {
      buf[m++] = owner_[i];
      buf[m++] = p;
    } else {
      for (int c = 0; c < 3; ++c) buf[m++] = p < 0 ? 0.0 : entry(p, c);
    }
  }
  return m;
}

void FixBDPse::unpack_forward_comm(int n, int first, double *buf)
{
  const int owned = static_cast<int>(mapped_atoms_.size());
  int m = 0;
  for (int i = first; i < first + n; ++i) {
    if (message_ == Message::owners) {
      owner_[i] = static_cast<int>(buf[m++]);
      particle_of_[i] = static_cast<int>(buf[m++]);
      continue;
    }
    const int p = particle_of_[i];
    if (p >= owned) {
      for (int c = 0; c < 3; ++c) set_entry(p, c, buf[m + c]);
      set_entry(p, 3, 0.0);
    }
    m += 3;
  }
}

double FixBDPse::entry(int p, int c) const
{
  return message_ == Message::single_vector ? static_cast<const float *>(vector_)[4L * p + c]
                                            : static_cast<const double *>(vector_)[4L * p + c];
}

void FixBDPse::set_entry(int p, int c, double value)
{
  if (message_ == Message::single_vector)
    static_cast<float *>(vector_)[4L * p + c] = static_cast<float>(value);
  else
    static_cast<double *>(vector_)[4L * p + c] = value;
}

bdh::NeighborView FixBDPse::neighbor_view() const
{
  bdh::NeighborView v;
  v.rows = list_->inum;
  v.atom = list_->ilist;
  v.count = list_->numneigh;
  v.neighbors = list_->firstneigh;
  v.mask = NEIGHMASK;
  v.local_atoms = atom->nlocal;
  v.x = atom->nlocal + atom->nghost ? atom->x[0] : nullptr;
  v.particle = particle_of_.data();
  v.extra = &unlisted_;
  return v;
}

/* ----------------------------------------------------------------------
   one step
------------------------------------------------------------------------- */

/// Collective.
void FixBDPse::follow_box()
{
  if (!domain->box_change || !update_cell() || comm->me) return;
  const std::array<long, 3> n = grid_points();
  utils::logmesg(lmp, "{}: step {}: the box has changed, new grid {} x {} x {}\n", name_,
                 update->ntimestep, n[0], n[1], n[2]);
}

void FixBDPse::step(bdh::Particles &particles)
{
  // They are where they were before the box, or another fix, moved atoms since the last forces.
  refresh_ghosts();
  follow_box();
  take_with(*step_, particles, *around_, *mobility_);
}

bdh::PseStepPlan FixBDPse::plan_step() const
{
  bdh::PseStepPlan p;
  p.dt = update->dt;
  p.kT = kT_;
  p.viscosity = core_viscosity_;
  p.substeps = options_.substeps;
  p.seed = seed_;
  p.step = static_cast<uint64_t>(update->ntimestep);
  return p;
}

void FixBDPse::keep_report(const bdh::PseReport &report)
{
  figures_.lanczos_iterations = report.iterations;
  figures_.error_estimate = report.root_error;
}

/// Keyword parts: the displacements of this step by both, by atom.
void FixBDPse::keep_parts(const std::vector<double> &by_forces, const std::vector<double> &by_noise)
{
  const std::vector<int> &atoms = group_atoms();
  for (int i = 0; i < atom->nlocal; ++i) set_arrays(i);    // of atoms that have left the group
  for (size_t p = 0; p < atoms.size(); ++p)
    for (int c = 0; c < 3; ++c) {
      carried_[atoms[p]][c] = update->dt * by_forces[3 * p + c];
      carried_[atoms[p]][3 + c] = update->dt * by_noise[3 * p + c];
    }
}

/* ---------------------------------------------------------------------- */

void FixBDPse::setup(int vflag)
{
  FixBD::setup(vflag);
  if (!options_.check) return;
  run_core(
      error, name_, [this] { with_remedy([this] { check_tolerance(gather_particles()); }); },
      [this](long i) { return describe(i); });
}

double FixBDPse::norm(const std::vector<double> &v) const
{
  double mine = 0.0, all = 0.0;
  for (double x : v) mine += x * x;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
  return std::sqrt(all);
}

/// |u - exact|/|exact|, 0 if exact is.
double FixBDPse::relative_difference(std::vector<double> u, const std::vector<double> &exact) const
{
  const double scale = norm(exact);
  for (size_t k = 0; k < u.size(); ++k) u[k] -= exact[k];
  return scale > 0.0 ? norm(u) / scale : 0.0;
}

std::unique_ptr<bdh::PseProbe> FixBDPse::probe(const bdh::PsePlan *other)
{
  std::unique_ptr<bdh::PseMobility> made;
  if (other) {
    made = bdh::make_pse(*other, bdh::Comm(world), bdh::FftEffort::estimate, more_iterations(),
                         ghosts_.get(), workers());
    made->set_cell(cell());
  }
  return std::make_unique<bdh::PseProbeOn<bdh::HostBackend, bdh::NeighborView>>(
      gather_particles(), *around_, core_viscosity_, mobility_.get(), std::move(made));
}

/// Plan of a solve with a hundredth of the tolerance: with pairs within the neighbor list that the
/// fix has anyway, else with a longer one.
bdh::PsePlan FixBDPse::plan_of_check() const
{
  bdh::PseScene tighter = scene();
  tighter.tolerance = MAX(0.01 * plan_.tolerance, 1e-12);
  tighter.xi = 0.0;
  tighter.substeps = 0;    // no steps are taken with it
  tighter.precision = bdh::Precision::double_precision;
  tighter.largest_cutoff = plan_.r_cut;
  try {
    return bdh::plan_pse(tighter);
  } catch (const bdh::InvalidOption &) {
    tighter.largest_cutoff = 0.0;
    return bdh::plan_pse(tighter);
  }
}

/// Keyword check: the error that is really achieved for the particles as they are, beside the solve
/// of check_plan_.
void FixBDPse::check_tolerance(const bdh::Particles &particles)
{
  const bdh::PsePlan &plan = check_plan_;
  renew_neighbors();
  const auto own = probe(nullptr);
  auto reference = probe(&plan);

  const size_t size = 3 * particles.size();
  std::vector<double> present(particles.force(), particles.force() + size), random(size);
  const bdh::NoiseCounter counter{seed_, bdh::Stream::finite_difference, 0, 0};
  for (long i = 0; i < particles.size(); ++i) {
    double spare;
    bdh::normal4(counter, particles.ids()[i], random[3 * i], random[3 * i + 1], random[3 * i + 2],
                 spare);
  }
  std::string out = fmt::format(
      "{}: check of the tolerance {:g} beside a solve to {:g} (xi = {:.4g}, {} x {} x {} points)\n",
      name_, plan_.tolerance, plan.tolerance, plan.xi, plan.n[0], plan.n[1], plan.n[2]);
  double worst = 0.0;
  const auto line = [&](const char *what, double achieved) {
    worst = MAX(worst, achieved);
    out += fmt::format("  error {:<34} {:.2g}{}\n", what, achieved,
                       achieved <= plan_.tolerance ? "" : "  (above the tolerance)");
  };
  if (norm(present) > 0.0)
    line("of M F, forces as they are:",
         relative_difference(own->apply(present), reference->apply(present)));
  line("of M F, random forces:", relative_difference(own->apply(random), reference->apply(random)));
  if (kT_ > 0.0) {    // the noise of this step, beside the same noise with the Lanczos iteration
                      // run further
    bdh::PsePlan further = plan_;
    further.root_tolerance = MAX(0.01 * plan_.tolerance, plan_.single ? 1e-6 : 1e-11);
    const bdh::PseNoise noise{1.0, seed_, static_cast<uint64_t>(update->ntimestep)};
    reference.reset();    // its grid may be the largest
    line("of the noise, by Lanczos:",
         relative_difference(own->random(noise), probe(&further)->random(noise)));
  }
  if (comm->me == 0) utils::logmesg(lmp, out);
  if (worst > plan_.tolerance && comm->me == 0)
    error->warning(FLERR,
                   "{}: the error reaches {:.2g} for these particles, but tolerance = {:g} is "
                   "asked for: use {}",
                   name_, worst, plan_.tolerance,
                   plan_.single ? "precision double, or a tighter tolerance"
                                : "a tighter tolerance");
}
