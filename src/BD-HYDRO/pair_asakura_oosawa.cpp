/* ----------------------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

#include "pair_asakura_oosawa.h"

#include "base/errors.h"
#include "input/depletion.h"
#include "input/words.h"
#include "pair/asakura_oosawa_kernel.h"

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "force.h"
#include "memory.h"
#include "neigh_list.h"
#include "update.h"
#include "utils.h"

#include <cmath>
#include <cstring>
#include <memory>
#include <sstream>

using namespace LAMMPS_NS;

using Words = std::vector<std::string>;

namespace {

/// Every message of this style starts alike.  All ranks find the same errors, hence error->all().
[[noreturn]] void refuse(Error *error, const std::string &message)
{
  error->all(FLERR, "Pair style asakura/oosawa: " + message);
}

bdh::Depletion parse(Error *error, const Words &words, const std::string &origin, double boltz)
{
  try {
    return bdh::parse_depletion(words, origin, boltz);
  } catch (const bdh::InvalidOption &e) {
    refuse(error, e.what());
  }
}

/// What rank 0 found in a parameter file.
struct Lookup {
  enum { unreadable = -1, other_units = -2 };
  int matches;    // number of lines that start with the entry's name, or one of the constants above
  std::string
      text;    // the entry's other words; without a match, the names in the file or its units
};

/// Splits a line at blanks.  utils::split_words() fails on an unpaired quote.
Words words_of(const std::string &text)
{
  std::istringstream stream(text);
  Words words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// Reads the next line of the file, of any length, without its comment; false at the end.
bool read_line(FILE *file, std::string &line)
{
  line.clear();
  int c = std::fgetc(file);
  if (c == EOF) return false;
  for (; c != EOF && c != '\n'; c = std::fgetc(file)) line += static_cast<char>(c);
  line = utils::trim_comment(line);
  return true;
}

Lookup search(FILE *file, const std::string &entry)
{
  Lookup found{0, ""};
  std::string names, line;
  while (read_line(file, line)) {
    const Words words = words_of(line);
    if (words.empty()) continue;
    names += " " + words[0];
    if (words[0] != entry) continue;
    found.matches++;
    for (std::size_t i = 1; i < words.size(); i++) found.text += words[i] + " ";
  }
  if (found.matches == 0) found.text = names;
  return found;
}

/// On rank 0: looks up an entry in a file, which may also be in one of LAMMPS' folders.
Lookup look_into(LAMMPS *lmp, const std::string &file, const std::string &entry)
{
  const std::string path = utils::get_potential_file_path(file);
  if (path.empty()) return {Lookup::unreadable, ""};
  const std::string units = utils::get_potential_units(path, "asakura/oosawa");
  if (!units.empty() && units != lmp->update->unit_style) return {Lookup::other_units, units};
  const auto close = [](FILE *open) { std::fclose(open); };
  std::unique_ptr<FILE, decltype(close)> open(utils::open_potential(file, lmp, nullptr), close);
  return open ? search(open.get(), entry) : Lookup{Lookup::unreadable, ""};
}

void broadcast(Lookup &found, MPI_Comm world)
{
  int length = found.text.size();
  MPI_Bcast(&found.matches, 1, MPI_INT, 0, world);
  MPI_Bcast(&length, 1, MPI_INT, 0, world);
  found.text.resize(length);
  MPI_Bcast(&found.text[0], length, MPI_CHAR, 0, world);
}

}    // namespace

/* ---------------------------------------------------------------------- */

PairAsakuraOosawa::PairAsakuraOosawa(LAMMPS *lmp) :
    Pair(lmp), cut_global(0.0), c(nullptr), D(nullptr), reach(nullptr)
{
  writedata = 1;
}

/* ---------------------------------------------------------------------- */

PairAsakuraOosawa::~PairAsakuraOosawa()
{
  if (copymode || !allocated) return;
  memory->destroy(setflag);
  memory->destroy(cutsq);
  memory->destroy(c);
  memory->destroy(D);
  memory->destroy(reach);
}

/* ---------------------------------------------------------------------- */

void PairAsakuraOosawa::compute(int eflag, int vflag)
{
  ev_init(eflag, vflag);
  for (int ii = 0; ii < list->inum; ii++) add_neighbors_of(list->ilist[ii], eflag);
  if (vflag_fdotr) virial_fdotr_compute();
}

/* ----------------------------------------------------------------------
   forces, energy and virial of atom i with the atoms in its half list
------------------------------------------------------------------------- */

void PairAsakuraOosawa::add_neighbors_of(int i, int eflag)
{
  double *const *const x = atom->x;
  double *const *const f = atom->f;
  const int nlocal = atom->nlocal;
  const int newton_pair = force->newton_pair;
  const double *const c_i = c[atom->type[i]];
  const double *const D_i = D[atom->type[i]];

  for (int jj = 0; jj < list->numneigh[i]; jj++) {
    const double factor = force->special_lj[sbmask(list->firstneigh[i][jj])];
    const int j = list->firstneigh[i][jj] & NEIGHMASK;
    const int jtype = atom->type[j];

    const double delx = x[i][0] - x[j][0];
    const double dely = x[i][1] - x[j][1];
    const double delz = x[i][2] - x[j][2];
    const double rsq = delx * delx + dely * dely + delz * delz;
    if (rsq >= D_i[jtype] * D_i[jtype]) continue;

    const double r = sqrt(rsq);
    const double fpair = factor * bdh::ao_force_over_r(r, c_i[jtype], D_i[jtype]);
    f[i][0] += delx * fpair;
    f[i][1] += dely * fpair;
    f[i][2] += delz * fpair;
    if (newton_pair || j < nlocal) {
      f[j][0] -= delx * fpair;
      f[j][1] -= dely * fpair;
      f[j][2] -= delz * fpair;
    }

    if (!evflag) continue;
    const double evdwl = eflag ? factor * bdh::ao_energy(r, c_i[jtype], D_i[jtype]) : 0.0;
    ev_tally(i, j, nlocal, newton_pair, evdwl, 0.0, fpair, delx, dely, delz);
  }
}

/* ---------------------------------------------------------------------- */

void PairAsakuraOosawa::allocate()
{
  allocated = 1;
  const int n = atom->ntypes + 1;
  memory->create(setflag, n, n, "pair:setflag");
  memory->create(cutsq, n, n, "pair:cutsq");
  memory->create(c, n, n, "pair:c");
  memory->create(D, n, n, "pair:D");
  memory->create(reach, n, n, "pair:reach");

  // D = 0 means no interaction, as for type pairs that pair_style hybrid gives to another style
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      setflag[i][j] = 0;
      cutsq[i][j] = c[i][j] = D[i][j] = reach[i][j] = 0.0;
    }
}

/* ----------------------------------------------------------------------
   optional argument: smallest neighbor cutoff
------------------------------------------------------------------------- */

void PairAsakuraOosawa::settings(int narg, char **arg)
{
  if (narg > 1)
    refuse(error,
           fmt::format(
               "{} arguments, but at most one is allowed, the largest D that fix adapt may set; "
               "give c and D with pair_coeff",
               narg));
  cut_global = 0.0;
  if (narg == 0) return;

  cut_global = utils::numeric(FLERR, arg[0], false, lmp);
  if (!bdh::obeys(cut_global, bdh::Sign::positive))
    refuse(error, fmt::format("cutoff = {}, but it {}; leave it out to use D of each pair", arg[0],
                              bdh::rule(bdh::Sign::positive)));
}

/* ----------------------------------------------------------------------
   set coeffs for one or more type pairs
------------------------------------------------------------------------- */

void PairAsakuraOosawa::coeff(int narg, char **arg)
{
  if (narg < 3)
    refuse(error, "pair_coeff has no values, but needs them after the two atom types; "
                  "write 'pair_coeff I J direct c D'");
  if (!allocated) allocate();

  int ilo, ihi, jlo, jhi;
  utils::bounds(FLERR, arg[0], 1, atom->ntypes, ilo, ihi, error);
  utils::bounds(FLERR, arg[1], 1, atom->ntypes, jlo, jhi, error);

  Words words(arg + 2, arg + narg);
  std::string origin = "pair_coeff";
  if (words[0] == "file") {
    if (words.size() != 3)
      refuse(error,
             fmt::format(
                 "pair_coeff has {} words after 'file', but needs 2; write 'file FILENAME ENTRY'",
                 words.size() - 1));
    origin = fmt::format("entry {} of file {}", words[2], words[1]);
    words = file_entry(words[1], words[2]);
  }
  const bdh::Depletion depletion = parse(error, words, origin, force->boltz);

  int count = 0;
  for (int i = ilo; i <= ihi; i++)
    for (int j = MAX(jlo, i); j <= jhi; j++) {
      c[i][j] = depletion.c;
      D[i][j] = depletion.D;
      setflag[i][j] = 1;
      count++;
    }
  if (count == 0)
    refuse(error,
           fmt::format("pair_coeff {} {} selects no pair I <= J; write the lower atom type first",
                       arg[0], arg[1]));
}

/* ----------------------------------------------------------------------
   reads the words that follow the name of an entry in a parameter file, on rank 0
------------------------------------------------------------------------- */

Words PairAsakuraOosawa::file_entry(const std::string &file, const std::string &entry) const
{
  Lookup found{Lookup::unreadable, ""};
  if (comm->me == 0) found = look_into(lmp, file, entry);
  broadcast(found, world);

  if (found.matches == Lookup::other_units)
    refuse(error, fmt::format("file {} is for units {}, but the units are {}; use a file for those",
                              file, found.text, update->unit_style));
  if (found.matches == Lookup::unreadable)
    refuse(error, fmt::format("file {} cannot be read, but must be a readable parameter file; "
                              "give its path, or put it in the LAMMPS potentials folder",
                              file));
  if (found.matches == 0)
    refuse(error, fmt::format("entry {} is not in file {}, but must be one of its entries:{}",
                              entry, file, found.text));
  if (found.matches > 1)
    refuse(error, fmt::format(
                      "entry {} occurs {} times in file {}, but must occur once; rename the others",
                      entry, found.matches, file));
  return words_of(found.text);
}

/* ----------------------------------------------------------------------
   sets the neighbor cutoffs of this run; fix adapt may then change D up to them
------------------------------------------------------------------------- */

void PairAsakuraOosawa::init_style()
{
  for (int i = 1; i <= atom->ntypes; i++)
    for (int j = i; j <= atom->ntypes; j++) {
      if (!setflag[i][j]) continue;
      if (cut_global > 0.0 && D[i][j] > cut_global)
        refuse(error, fmt::format("cutoff = {}, but it must be >= D = {} of atom types {} and {}; "
                                  "raise it in pair_style, or leave it out",
                                  cut_global, D[i][j], i, j));
      reach[i][j] = reach[j][i] = MAX(cut_global, D[i][j]);
    }
  Pair::init_style();
}

/* ----------------------------------------------------------------------
   init for one type pair i,j and corresponding j,i
   also called by fix adapt after it has changed c or D
------------------------------------------------------------------------- */

double PairAsakuraOosawa::init_one(int i, int j)
{
  if (setflag[i][j] == 0)
    refuse(
        error,
        fmt::format("atom types {0} and {1} have no coefficients, and there is no mixing rule for "
                    "spheres of different sizes; add 'pair_coeff {0} {1} direct c D' "
                    "(c = 0 for no attraction)",
                    i, j));
  check_values(i, j);
  c[j][i] = c[i][j];
  D[j][i] = D[i][j];
  return reach[i][j];
}

/* ----------------------------------------------------------------------
   needed at every change, since fix adapt sets values without knowing the rules
------------------------------------------------------------------------- */

void PairAsakuraOosawa::check_values(int i, int j) const
{
  if (!bdh::obeys(c[i][j], bdh::Sign::not_negative))
    refuse(error, fmt::format("c = {} for atom types {} and {}, but it {}; correct what sets it",
                              c[i][j], i, j, bdh::rule(bdh::Sign::not_negative)));
  if (!bdh::obeys(D[i][j], bdh::Sign::positive))
    refuse(error, fmt::format("D = {} for atom types {} and {}, but it {}; correct what sets it",
                              D[i][j], i, j, bdh::rule(bdh::Sign::positive)));
  if (D[i][j] > reach[i][j])
    refuse(error,
           fmt::format(
               "D = {} for atom types {} and {} during a run, but it must be <= {}, the cutoff "
               "of the neighbor lists; give the largest D as the argument of pair_style",
               D[i][j], i, j, reach[i][j]));
}

/* ----------------------------------------------------------------------
   proc 0 writes to restart file
------------------------------------------------------------------------- */

void PairAsakuraOosawa::write_restart(FILE *fp)
{
  write_restart_settings(fp);
  for (int i = 1; i <= atom->ntypes; i++)
    for (int j = i; j <= atom->ntypes; j++) {
      fwrite(&setflag[i][j], sizeof(int), 1, fp);
      fwrite(&c[i][j], sizeof(double), 1, fp);
      fwrite(&D[i][j], sizeof(double), 1, fp);
    }
}

/* ----------------------------------------------------------------------
   proc 0 reads from restart file, bcasts
------------------------------------------------------------------------- */

void PairAsakuraOosawa::read_restart(FILE *fp)
{
  read_restart_settings(fp);
  if (!allocated) allocate();
  for (int i = 1; i <= atom->ntypes; i++)
    for (int j = i; j <= atom->ntypes; j++) {
      if (comm->me == 0) {
        utils::sfread(FLERR, &setflag[i][j], sizeof(int), 1, fp, nullptr, error);
        utils::sfread(FLERR, &c[i][j], sizeof(double), 1, fp, nullptr, error);
        utils::sfread(FLERR, &D[i][j], sizeof(double), 1, fp, nullptr, error);
      }
      MPI_Bcast(&setflag[i][j], 1, MPI_INT, 0, world);
      MPI_Bcast(&c[i][j], 1, MPI_DOUBLE, 0, world);
      MPI_Bcast(&D[i][j], 1, MPI_DOUBLE, 0, world);
    }
}

/* ---------------------------------------------------------------------- */

void PairAsakuraOosawa::write_restart_settings(FILE *fp)
{
  fwrite(&cut_global, sizeof(double), 1, fp);
}

/* ---------------------------------------------------------------------- */

void PairAsakuraOosawa::read_restart_settings(FILE *fp)
{
  if (comm->me == 0) utils::sfread(FLERR, &cut_global, sizeof(double), 1, fp, nullptr, error);
  MPI_Bcast(&cut_global, 1, MPI_DOUBLE, 0, world);
}

/* ----------------------------------------------------------------------
   proc 0 writes to data file; {} prints the shortest number that reads back exactly
------------------------------------------------------------------------- */

void PairAsakuraOosawa::write_data(FILE *fp)
{
  for (int i = 1; i <= atom->ntypes; i++)
    fputs(fmt::format("{} {} {}\n", i, c[i][i], D[i][i]).c_str(), fp);
}

/* ---------------------------------------------------------------------- */

void PairAsakuraOosawa::write_data_all(FILE *fp)
{
  for (int i = 1; i <= atom->ntypes; i++)
    for (int j = i; j <= atom->ntypes; j++)
      fputs(fmt::format("{} {} {} {}\n", i, j, c[i][j], D[i][j]).c_str(), fp);
}

/* ---------------------------------------------------------------------- */

double PairAsakuraOosawa::single(int /*i*/, int /*j*/, int itype, int jtype, double rsq,
                                 double /*factor_coul*/, double factor_lj, double &fforce)
{
  const double r = sqrt(rsq);
  fforce = factor_lj * bdh::ao_force_over_r(r, c[itype][jtype], D[itype][jtype]);
  return factor_lj * bdh::ao_energy(r, c[itype][jtype], D[itype][jtype]);
}

/* ---------------------------------------------------------------------- */

void *PairAsakuraOosawa::extract(const char *name, int &dim)
{
  dim = 2;
  if (strcmp(name, "c") == 0) return (void *) c;
  if (strcmp(name, "D") == 0) return (void *) D;
  return nullptr;
}
