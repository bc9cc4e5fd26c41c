// A scene stepped by a subject.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "reference/dynamics/integrator.h"
#include "verification/subject.h"

namespace foldproof {

/// A scene prepared and stepped by a subject.
class Stepper {
 public:
  Stepper(const Subject& subject, Scene scene, const std::string& integrator);

  const Scene& scene() const { return scene_; }
  State start() const { return start_state(scene_); }
  State step(const State& s, double h);                        // h [s]
  State step_after(const std::vector<State>& past, double h);  // the latest state last
  State run(State s, double h, int steps);
  PerParticle3 elastic_forces(const State& s) const;                         // 3 x N [N]
  PerParticle3 damping_forces(const State& s, const PerParticle3& v) const;  // 3 x N [N]
  const Work& work() const { return work_; }                                 // of all steps so far

 private:
  const Subject& subject_;
  Scene scene_;
  std::unique_ptr<PreparedScene> prepared_;
  Work work_;
};

/// One step of h [s] of the reference, from s alone.
State step_once(const std::string& integrator, const System& system, const State& s, double h);

/// Largest growth factor of a small initial disturbance during `steps` steps of h [1], at least 1.
/// The disturbance is random, its velocities scaled by 1/(steps h); rounding errors made during the
/// steps grow no faster.
double growth(Stepper& stepper, const State& start, double h, int steps);

}  // namespace foldproof
