// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// LAMMPS' interface to plugins, which is plain C and the same in all releases that have it.  Their
/// header lammpsplugin.h is not installed with the library.
#ifndef BDH_INSTALLED_LAMMPSPLUGIN_INTERFACE_H
#define BDH_INSTALLED_LAMMPSPLUGIN_INTERFACE_H

extern "C" {

using lammpsplugin_factory1 = void *(void *);                  // pair styles
using lammpsplugin_factory2 = void *(void *, int, char **);    // fixes and computes

struct lammpsplugin_t {
  const char *version;    // of LAMMPS
  const char *style;      // "fix", "pair", ...
  const char *name;
  const char *info;
  const char *author;
  union {
    lammpsplugin_factory1 *v1;
    lammpsplugin_factory2 *v2;
  } creator;
  void *handle;
};

using lammpsplugin_regfunc = void (*)(lammpsplugin_t *, void *);

void lammpsplugin_init(void *lmp, void *handle, void *regfunc);
}

#endif
