// Quantities that a user defines for a run: [[quantity]] of a case file, each a value with a unit.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "reference/dynamics/simulate.h"
#include "reference/scene/scene.h"
#include "verification/cases/quantities.h"

namespace foldproof {

/// Particles of a cloth, as selected by the case; on a finer mesh a box contains more of them.
struct ParticleRegion {
  std::vector<int> particles;                      // by number
  std::optional<std::pair<Vector3, Vector3>> box;  // lowest and highest corner, of the start [m]
  // neither: all
};

/// The particles of the region, ascending in a box, else as listed.
std::vector<int> particles_in(const ParticleRegion& region, const Scene& scene);

enum class Instant { end, maximum, minimum, at_time };

/// One [[quantity]]: `name`, `what` it is, `of` which particles, and `when`.
struct Measurement {
  std::string name;
  std::string what;  // a row of measurable(), or a key of quantities()
  ParticleRegion of = {};
  Instant when = Instant::end;
  double time = 0;                  // of at_time: that of the nearest frame counts [s]
  Vector3 along = Vector3::Zero();  // of what = "position": a direction; zero: up
};

/// A run at one frame, as seen by a measurement.
struct FrameView {
  const Scene& scene;
  const System& system;
  std::span<const Object> objects;
  const State& state;
  long contacts;  // points whose motion objects corrected in the step that ended here
};

constexpr int any_region = 0, whole_cloth = -1;

/// A row of the table of what can be measured at a frame.
struct Measurable {
  const char *what, *unit, *meaning;
  int particles;  // number of particles that it needs by index; any_region; whole_cloth
  double (*at)(const FrameView& frame, const Measurement& m, const std::vector<int>& of);
};

const std::vector<Measurable>& measurable();

/// The unit of a measurement, of measurable() or of quantities().
std::string unit_of(const Measurement& m);

/// One entry of [[quantity]]. Throws InputError "file:line: ..." for an unknown `what` or `when`, a
/// region without particles, a quantity that makes no sense for the scene, and keys that it would
/// not use: `of` where the whole cloth is measured, `of` and `when` of a quantity of [expect].
Measurement read_measurement(const KeyTable& keys, const Scene& scene);

/// All tables of [[quantity]]. Throws InputError for a name that two of them have.
std::vector<Measurement> read_measurements(const KeyTable& keys, const Scene& scene);

/// The default measurements of a case without [[quantity]]: energies at the end, heights at the end
/// (where there is gravity), and the quantities of its expectations.
std::vector<Measurement> usual_measurements(const Scene& scene,
                                            const std::vector<std::string>& expected);

/// Takes measurements during a run: pass it every row and every frame, then call values().
class Measurer {
 public:
  /// All must outlive it.
  Measurer(const Scene& scene, const BuiltScene& built,
           const std::vector<Measurement>& measurements);

  void record(const Diagnostics& row);
  void record(const State& frame);

  /// One value per measurement; NaN if the run stopped before its time. Extremes are over the
  /// frames that exist.
  std::vector<double> values(const RunResult& result) const;

 private:
  double at_frame(size_t k, const State& frame) const;
  void record(size_t k, const State& frame);

  const Scene& scene_;
  const BuiltScene& built_;
  const std::vector<Measurement>& measurements_;
  std::vector<std::vector<int>> particles_;  // of each measurement
  DiagnosticsSummary summary_;
  long contacts_ = 0;
  std::vector<double> values_;   // of those that belong to frames
  std::vector<double> nearest_;  // of those of a time: how far the frame is from it [s]
  std::vector<bool> is_first_;   // of extremes: no frame was seen yet
};

}  // namespace foldproof
