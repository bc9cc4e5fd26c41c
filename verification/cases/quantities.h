// Quantities that a case can put bounds on, measured while it runs, each with its
// unit and its claim.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "reference/dynamics/simulate.h"
#include "reference/scene/scene.h"
#include "verification/cases/repetition.h"
#include "verification/verdict.h"

namespace foldproof {

/// Summary of all rows of diagnostics.
struct DiagnosticsSummary {
  Diagnostics start;  // the first row
  // |kinetic + elastic + gravitational energy - work of damping - that at the start| [J]
  Worst balance;
  double largest_exchange = 0;                   // the largest change of one form of energy [J]
  double largest_kinetic = 0, last_kinetic = 0;  // J
  Worst linear, angular;  // change of momentum since the start [kg m/s], [kg m^2/s]
  long contacts = 0;      // largest number of points whose motion objects corrected in one step
  // energy balance over the first and the last tenth of the run [J s] ...
  double early = 0, late = 0;
  double early_time = 0, late_time = 0;  // ... and how long these are [s]

  /// end: of the run [s].
  void record(const Diagnostics& row, double end);

 private:
  bool is_begun_ = false;
};

/// A run, as seen by its quantities.
struct RunView {
  const Scene& scene;
  const DiagnosticsSummary& summary;
  const RunResult& result;
  const Repetition& repetition;
  std::span<const Object> objects = {};
};

enum class Sense { at_most, at_least };

/// Scope of a bound on the quantity: any cloth, because the method or its forces guarantee it; or
/// only the mesh and objects of the case, because others give other values.
enum class Scope { any_cloth, this_shape };

struct Quantity {
  const char *key, *unit;
  const char* claim;  // one sentence, true when the expectation holds
  Sense sense;
  Scope scope;
  /// At one frame's state; the largest over all frames counts. nullptr: the quantity belongs to the
  /// whole run, or needs the objects.
  double (*of_frame)(const Scene& scene, const State& frame);
  double (*of_run)(const RunView& run);  // nullptr: the quantity belongs to frames
  // why it is meaningless for the scene, or ""; nullptr: never
  std::string (*rejection)(const Scene& scene);
  /// As of_frame, for a quantity that needs the objects.
  double (*of_objects)(const Scene& scene, std::span<const Object> objects,
                       const State& frame) = nullptr;
};

/// The quantity's value at a frame; it must not belong to the whole run. objects: the
/// scene's, as built.
double value_at(const Quantity& quantity, const Scene& scene, std::span<const Object> objects,
                const State& frame);

/// The row of whole triangles against objects (face_quantities.cpp).
std::vector<Quantity> face_quantities();

/// The rows of cloth that sticks (sticking_quantities.cpp).
std::vector<Quantity> sticking_quantities();

/// The rows of cloth with strain limits, and of its extension and area (strain_quantities.cpp).
std::vector<Quantity> strain_quantities();

/// The rows of shells that stand or collapse (standing_quantities.cpp).
std::vector<Quantity> standing_quantities();

/// The rows of cloth with wrinkles (wrinkle_quantities.cpp).
std::vector<Quantity> wrinkle_quantities();

/// The table of quantities.
const std::vector<Quantity>& quantities();

/// Why a quantity of springs, hinges, objects, or the vertical is meaningless for the scene, or "".
std::string without_springs(const Scene& scene);
std::string without_bending(const Scene& scene);
std::string without_gravity(const Scene& scene);
std::string without_objects(const Scene& scene);

/// Against gravity; +y without it.
Vector3 up_in(const Scene& scene);

/// Length over rest length, less 1, of each edge. Rest lengths are those of the springs, if the
/// scene has springs.
std::vector<double> strains_of(const Scene& scene, const PerParticle3& x);

/// The row of the key; nullptr if there is none.
const Quantity* find_quantity(std::string_view key);

}  // namespace foldproof
