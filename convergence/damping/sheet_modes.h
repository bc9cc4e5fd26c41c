// The vibrations of a flat sheet, one by one: what each is by an oracle, and what a step of a
// method makes of it.
#pragma once

#include <vector>

#include "reference/dynamics/integrator.h"
#include "verification/oracles/amplification.h"
#include "verification/subject.h"

namespace foldproof {

/// stretch: in the plane of the sheet, where springs alone act; bending: across it, where
/// hinges alone do.
enum class ModeKind { stretch, bending };

/// One vibration of the undamped sheet, no rigid motion.
struct SheetMode {
  ModeKind kind;
  double frequency;    // omega [rad/s]
  PerParticle3 shape;  // 3 x N [kg^-1/2], with sum m |shape|^2 = 1
};

/// Damping of springs and hinges, over their stiffness [s]. A mode of the angular frequency omega
/// is then an oscillator of its own, with c = relaxation omega^2.
struct Relaxation {
  double stretch = 0, bending = 0;

  double of(ModeKind kind) const { return kind == ModeKind::stretch ? stretch : bending; }
};

/// A flat, free sheet of cells x cells squares about the origin, at rest. Bending is damped with
/// the factor |E|^2/(|N1| + |N2|), which makes its damping proportional to its stiffness.
Scene sheet_at_rest(int cells, const Relaxation& relaxation);

/// All vibrations of the scene's sheet, by the oracles' forces: ascending frequencies, stretch
/// before bending.
std::vector<SheetMode> modes_of(const Scene& scene);

double highest_frequency(const std::vector<SheetMode>& modes);  // rad/s
double lowest_frequency(const std::vector<SheetMode>& modes);   // rad/s

/// The oscillator that a mode is when damped.
oracles::Oscillator oscillator_of(const SheetMode& mode, const Relaxation& relaxation);

/// The factors by which steps of h [s] multiply each mode of the scene's sheet. All modes are
/// excited at once, by displacements in one run and by velocities in another, by a tenth of a
/// micrometre. Runs with the opposite start are subtracted, so that what nonlinearity remains is of
/// third order. A mode's factors are the eigenvalues of the 2 x 2 matrix that best maps its (omega
/// q, p) of each step to those of the next. skipped: steps that are left out first, until a method
/// of several steps has forgotten its start.
std::vector<oracles::Factors> measured_factors(const Subject& subject, const Scene& scene,
                                               const std::vector<SheetMode>& modes, double h,
                                               int skipped);

/// How far two pairs of factors are apart, whichever way they are paired [1].
double distance_of(const oracles::Factors& a, const oracles::Factors& b);

/// The larger modulus: what decides how fast the mode decays.
double decay_of(const oracles::Factors& factors);

/// Error bound of measured_factors [1], and its reason.
constexpr double factor_noise = 1e-7;
constexpr const char* why_factor_noise =
    "a thousand times the solver's tolerance of 1e-10, which is of the momentum of all modes "
    "together; displacements of 1e-7 m leave slopes of 1e-6, whose square is lost in that";

/// The undamped sheet of a study.
struct VibratingSheet {
  int cells;
  std::vector<SheetMode> modes;
  double limit;  // 2/omega_max [s]
};

VibratingSheet make_vibrating_sheet(int cells);

/// The factors of the method on that sheet with this damping, steps of h [s]. BDF2 takes 20 steps
/// first: its second root is a third where omega h is small.
std::vector<oracles::Factors> factors_of(const Subject& subject, const VibratingSheet& sheet,
                                         const Integrator& method, const Relaxation& relaxation,
                                         double h);

/// Amplitude lost in one period of the mode, as a part of it, while it is small: -(2 pi/omega
/// h) ln |factor|.
double loss_per_period(const SheetMode& mode, const oracles::Factors& factors, double h);

}  // namespace foldproof
