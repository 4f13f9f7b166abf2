// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Formatted messages where LAMMPS was installed without the headers of its own copy of the library
/// fmt.  These functions are declared by LAMMPS; the library has them for the types of its copy, and
/// here they are for the types of the system's fmt.
#include "error.h"
#include "utils.h"

using namespace LAMMPS_NS;

void Error::_all(const std::string &file, int line, fmt::string_view format, fmt::format_args args)
{
  all(file, line, fmt::vformat(format, args));
}

void Error::_one(const std::string &file, int line, fmt::string_view format, fmt::format_args args)
{
  one(file, line, fmt::vformat(format, args));
}

void Error::_warning(const std::string &file, int line, fmt::string_view format,
                     fmt::format_args args)
{
  warning(file, line, fmt::vformat(format, args));
}

void utils::fmtargs_logmesg(LAMMPS *lmp, fmt::string_view format, fmt::format_args args)
{
  logmesg(lmp, fmt::vformat(format, args));
}
