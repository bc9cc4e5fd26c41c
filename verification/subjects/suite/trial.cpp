#include "verification/subjects/suite/trial.h"

#include <fmt/format.h>

#include <chrono>
#include <limits>

namespace foldproof {

namespace {

constexpr int most_hangs = 3;  // each takes the whole limit of the clock

/// Adds up the seconds from its start to its end, even if an exception ends it.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds) {}
  ~Stopwatch() {
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

WatchedSolver& Trial::solver() {
  if (gave_up_) throw *gave_up_;
  if (running_) return *running_;
  try {
    running_.emplace(command_, observed_, heard_);
  } catch (const SolverFailure& failure) {
    gave_up_.emplace(failure);
    throw;
  }
  declared_ = running_->declaration();
  return *running_;
}

void Trial::tune(const std::map<std::string, double>& tunables) {
  command_.tunables = tunables;
  if (running_) running_->tune(tunables);
}

void Trial::restart() {
  running_.reset();
  solver();
}

const Declaration& Trial::declaration() {
  solver();
  return declared_;
}

void Trial::require_level(int level) {
  if (declaration().level < level)
    throw NotOffered{fmt::format("level L{} (it declares L{})", level, declared_.level)};
}

void Trial::require(const std::string& capability) {
  if (!declaration().offers(capability))
    throw NotOffered{fmt::format("capability '{}'", capability)};
}

void Trial::prepare(const PortableScene& scene) {
  for (auto& [key, value] : solver().prepare(scene)) {
    const std::pair row{key, value};
    if (std::find(mapping_.begin(), mapping_.end(), row) == mapping_.end()) mapping_.push_back(row);
  }
}

std::vector<Snapshot> Trial::motion(const PortableScene& scene, const std::vector<long>& steps) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  seconds_of_motion_ = 0, processor_seconds_of_motion_ = unknown;
  if (declaration().level > 0) prepare(scene);
  const double before = solver().processor_time().computing;
  std::vector<Snapshot> states = timed_motion(scene, steps);
  const double spent = solver().processor_time().computing - before;
  // less than nothing: of processes that have ended meanwhile
  processor_seconds_of_motion_ = spent >= 0 ? spent : unknown;
  return states;
}

std::vector<Snapshot> Trial::timed_motion(const PortableScene& scene,
                                          const std::vector<long>& steps) {
  const Stopwatch stopwatch(seconds_of_motion_);
  return declared_.level > 0 ? advance(scene.dt, steps) : solver().run(scene, steps);
}

std::vector<Snapshot> Trial::advance(double dt, const std::vector<long>& steps) {
  std::vector<Snapshot> states;
  long done = 0;
  for (const long count : steps) {
    states.push_back(solver().advance(dt, count - done, steps.back()));
    done = count;
  }
  return states;
}

void Trial::begin_law(double seconds) {
  observed_ = {};
  if (seconds > 0)
    observed_.end =
        std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::nanoseconds>(
                                               std::chrono::duration<double>(seconds));
}

bool Trial::deforms_when_stretched() {
  constexpr long steps = 20;
  const Observed before = observed_;
  PortableScene scene = solver().scene();
  if (scene.x.cols() == 0) return false;
  const Vector3 middle = scene.x.rowwise().mean();
  scene.name += ", stretched";
  scene.x = (1.01 * (scene.x.colwise() - middle)).colwise() + middle;
  scene.held.clear(), scene.moving_held = {}, scene.bodies.clear();
  scene.planes.clear(), scene.boxes.clear(), scene.spheres.clear(), scene.capsules.clear();
  observed_ = {};
  after(scene, steps);
  const bool deforms = observed_.nothing_happened(false, declared_.rounding()).empty();
  observed_ = before;
  return deforms;
}

void Trial::note(const SolverFailure& failure) {
  running_.reset();
  if (failure.cause != "hang" || ++hangs_ < most_hangs) return;
  gave_up_.emplace("hang",
                   fmt::format("{} hangs, not asked again; the last: {}", hangs_, failure.what()),
                   failure.kind);
}

}  // namespace foldproof
