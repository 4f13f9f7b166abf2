// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The package as a plugin, for LAMMPS libraries with the package PLUGIN: plugin load bdhplugin.so
#include "error.h"
#include "lammps.h"
#include "lammpsplugin_interface.h"
#include "styles.h"

using namespace LAMMPS_NS;

namespace {

class Plugins : public bdh::StyleTaker {
 public:
  Plugins(LAMMPS *lmp, void *handle, lammpsplugin_regfunc add) : lmp_(lmp), add_(add)
  {
    plugin_.version = lmp->version;
    plugin_.info = "BD-HYDRO " BDH_VERSION ": Brownian dynamics with hydrodynamic interactions";
    plugin_.author = "the BD-HYDRO authors";
    plugin_.handle = handle;
  }
  void take_fix(const char *name, bdh::NewFix create) override
  {
    plugin_.creator.v2 = reinterpret_cast<lammpsplugin_factory2 *>(create);
    add("fix", name);
  }
  void take_compute(const char *name, bdh::NewCompute create) override
  {
    plugin_.creator.v2 = reinterpret_cast<lammpsplugin_factory2 *>(create);
    add("compute", name);
  }
  void take_pair(const char *name, bdh::NewPair create) override
  {
    plugin_.creator.v1 = reinterpret_cast<lammpsplugin_factory1 *>(create);
    add("pair", name);
  }

 private:
  void add(const char *kind, const char *name)
  {
    plugin_.style = kind;
    plugin_.name = name;
    add_(&plugin_, lmp_);
  }

  LAMMPS *lmp_;
  lammpsplugin_regfunc add_;
  lammpsplugin_t plugin_{};
};

}    // namespace

/// Called by LAMMPS when it loads the library.
extern "C" __attribute__((visibility("default"))) void lammpsplugin_init(void *lammps, void *handle,
                                                                         void *add)
{
  auto *lmp = static_cast<LAMMPS *>(lammps);
  const std::string wrong = bdh::other_release(lmp, "The plugin BD-HYDRO");
  if (!wrong.empty()) lmp->error->all(FLERR, wrong);
  Plugins plugins(lmp, handle, reinterpret_cast<lammpsplugin_regfunc>(add));
  bdh::give_styles(plugins);
}
