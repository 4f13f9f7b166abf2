// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// lmp_bdh: LAMMPS from an installed library, with the styles of this package, for libraries that
/// cannot load plugins.  Takes the arguments of lmp.
#include "error.h"
#include "input.h"
#include "lammps.h"
#include "force.h"
#include "modify.h"
#include "styles.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <exception>
#include <mpi.h>

using namespace LAMMPS_NS;

namespace {

/// LAMMPS' own tables of styles.
class Tables : public bdh::StyleTaker {
 public:
  explicit Tables(LAMMPS *lmp) : lmp_(lmp) {}
  void take_fix(const char *name, bdh::NewFix create) override
  {
    (*lmp_->modify->fix_map)[name] = create;
  }
  void take_compute(const char *name, bdh::NewCompute create) override
  {
    (*lmp_->modify->compute_map)[name] = create;
  }
  void take_pair(const char *name, bdh::NewPair create) override
  {
    (*lmp_->force->pair_map)[name] = create;
  }

 private:
  LAMMPS *lmp_;
};

void add_styles(LAMMPS *lmp)
{
  Tables tables(lmp);
  bdh::give_styles(tables);
}

[[noreturn]] void stop(const std::string &message)
{
  std::fprintf(stderr, "ERROR: %s\n", message.c_str());
  std::fflush(nullptr);
  MPI_Abort(MPI_COMM_WORLD, 1);
  std::abort();
}

void run(int narg, char **arg)
{
  LAMMPS *lmp = new LAMMPS(narg, arg, MPI_COMM_WORLD);
  const std::string wrong = bdh::other_release(lmp, "lmp_bdh");
  if (!wrong.empty()) stop(wrong);
  add_styles(lmp);
  lmp->input->file();
  delete lmp;
}

}    // namespace

/// The command clear makes new tables of styles, and then calls this function.  The dynamic linker
/// finds this one before that of the library.
void LAMMPS::post_create()
{
  using Function = void (*)(LAMMPS *);
  static const auto original =
      reinterpret_cast<Function>(dlsym(RTLD_NEXT, "_ZN9LAMMPS_NS6LAMMPS11post_createEv"));
  if (!original) stop("lmp_bdh: the LAMMPS library has no LAMMPS::post_create(): use another one");
  original(this);
  add_styles(this);
}

int main(int narg, char **arg)
{
  MPI_Init(&narg, &arg);
  int status = 0;
  try {
    run(narg, arg);
  } catch (const std::exception &) {    // LAMMPS has printed its message
    std::fflush(nullptr);
    status = 1;
  }
  MPI_Finalize();
  return status;
}
