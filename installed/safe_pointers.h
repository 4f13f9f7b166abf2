// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// A header that installed headers of LAMMPS include, but that Debian does not install.
#ifndef BDH_INSTALLED_SAFE_POINTERS_H
#define BDH_INSTALLED_SAFE_POINTERS_H

#include <cstdio>

namespace LAMMPS_NS {

class SafeFilePtr {
 public:
  ~SafeFilePtr();

 private:
  FILE *fp;
  bool use_pclose;
};

}    // namespace LAMMPS_NS
#endif
