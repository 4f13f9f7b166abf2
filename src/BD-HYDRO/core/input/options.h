// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// What the user may say after `fix ID group bd/fib` or `bd/pse`, parsed and checked without
/// LAMMPS.
#ifndef BDH_INPUT_OPTIONS_H
#define BDH_INPUT_OPTIONS_H

#include "fib/spread.h"
#include "fib/step.h"
#include "grid/fft.h"
#include "input/words.h"
#include "pse/plan.h"
#include "stokes/walls.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace bdh {

/// No axis of a grid has more cells.  32768^3 cells already are 800 TB; the limit keeps every
/// product of sizes far from overflow.
constexpr long most_cells = 32768;

/// Keyword rotation: whether particles turn.  automatic: where the atoms have an orientation.
enum class Rotation { automatic, yes, no };
enum class DriftChoice { automatic, exact, finite_difference, no };

/// Keyword hold: the atoms of a group have a given velocity.
struct Hold {
  std::string group;
  std::array<Quantity, 3> velocity;    ///< [length/time]
};

/// Motions that are given.
struct MotionOptions {
  bool stresslets = false;    ///< keyword stresslet: spheres do not strain
  std::vector<Hold> holds;
  bool control_variate = false;    ///< loads are reported without the noise of their step

  bool give_motions() const { return stresslets || !holds.empty(); }
};

struct FibOptions : MotionOptions {
  Quantity temperature;                  ///< [temperature], >= 0
  Quantity viscosity;                    ///< [dynamic viscosity of the units style], > 0
  uint32_t seed = 0;                     ///< > 0
  std::array<long, 3> cells{0, 0, 0};    ///< keyword grid; zeros: not given
  double radius = 0.0;                   ///< keyword radius [length]; 0: not given
  IbKernel kernel = IbKernel::peskin4;
  Scheme scheme = Scheme::midpoint;
  bool scheme_given = false;    ///< a scheme that the user named is never simplified
  DriftChoice drift = DriftChoice::automatic;
  Rotation rotation = Rotation::automatic;
  Precision precision = Precision::double_precision;    ///< see choose_precision()
  double shear_rate = 0.0;                              ///< [1/time]
  double delta = 1e-6;                                  ///< in units of h, from 1e-12 to 0.1
  double tolerance = 1e-8;               ///< relative residual, where the solver iterates
  double constraint_tolerance = 1e-3;    ///< of motions that are given
  WallOptions walls;
  std::array<double, 3> body_force{0.0, 0.0, 0.0};    ///< keyword force [force/volume]
  Crossing crossing = Crossing::error;
  bool hydrodynamics = true;    ///< false: self-mobility alone
  double adapt = 0.0;           ///< tolerance of steps in pieces, in radii; 0: no pieces
  bool check_dt = false;        ///< compare a step with its halves at the beginning of a run
  FftSetup fft = FftEffort::measure;

  bool grid_given() const { return cells[0] > 0; }
  bool has_body_force() const
  {
    return body_force[0] != 0.0 || body_force[1] != 0.0 || body_force[2] != 0.0;
  }
  /// How steps at this thermal energy find the thermal drift.
  Drift drift_at(double kT) const;
  /// Whether such steps of the midpoint scheme have its corrector.  Without noise and flow it gains
  /// nothing, since the scheme is first order with or without it.
  bool needs_corrector(double kT) const;
};

/// `words` is what follows the style name, "temperature viscosity seed keyword value ...".  Throws
/// InvalidOption.
FibOptions parse_fib_options(const std::vector<std::string> &words);

struct PseOptions : MotionOptions {
  Quantity temperature;       ///< [temperature], >= 0
  Quantity viscosity;         ///< [dynamic viscosity of the units style], > 0
  uint32_t seed = 0;          ///< > 0
  double radius = 0.0;        ///< keyword radius [length]; 0: that of the atoms
  double tolerance = 1e-3;    ///< relative error of U = M F and of the noise
  double xi = 0.0;            ///< splitting parameter [1/length]; 0: the cheapest
  Precision precision = Precision::automatic;
  int iterations = 100;         ///< limit of Lanczos
  bool hydrodynamics = true;    ///< false: self-mobility alone
  Rotation rotation = Rotation::automatic;
  bool check = false;       ///< measure the error at setup
  bool check_dt = false;    ///< compare a step with its halves at the beginning of a run
  bool parts = false;       ///< keep both parts of the displacement of each atom
  bool split = false;       ///< scheme split instead of euler
  double adapt = 0.0;       ///< tolerance of steps in pieces, in radii; 0: no pieces
  /// Near steps to a far step of scheme split; 0 with scheme euler.  Where near steps are chosen,
  /// what a plan is made for.
  int substeps = 0;
  bool choose_substeps = false;    ///< near steps follow from `adapt`
  FftSetup fft = FftEffort::measure;
};

/// The same for bd/pse.
PseOptions parse_pse_options(const std::vector<std::string> &words);

}    // namespace bdh
#endif
