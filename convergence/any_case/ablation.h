// Which parts does a scene need? Each is left out, or put in, and the difference measured.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "convergence/any_case/level_run.h"
#include "convergence/any_case/own_error.h"
#include "reference/bodies/level_set_provider.h"
#include "reference/dynamics/simulate.h"
#include "reference/scene/scene.h"
#include "verification/cases/expectations.h"

namespace foldproof {

// The parts that a scene names, or could name, one by one.

/// A part of a scene, and the same scene with it toggled.
struct ScenePart {
  std::string name;
  bool is_present;
  std::function<Scene(Scene)> toggled;  // without the part where it is present, else with it
};

/// All parts that the scene has: gravity, springs, a membrane, differences of fabrics, a flat
/// pattern, air, wind, bending, damping, rest angles, held particles, objects, their friction,
/// points between particles, strain limits, self-collision, sticky patches. And those that it lacks
/// and whose numbers can be said without its author: strain limits of 10 % extension and 0 %
/// compression (Provot 1995), collision points on edges and triangles, self-collision with a
/// thickness of a quarter of the least height of a triangle, without stiffness or friction. Springs
/// take their strain limits with them, and a part its damping.
std::vector<ScenePart> parts_of(const Scene& scene);

// Only what a scene needs: what each part of a scene changes, compared with the scene's own error,
// and what it costs.

/// The results by which runs of the same cloth are compared, over the frames that were reached.
struct ObservedRun : FramedRun {
  std::vector<double> energy;  // kinetic, elastic and of gravity, at each frame [J]
  double deepest = 0;          // inside an object, a particle that is free and not pinched [m]
  double crossings = 0;  // most pairs of an edge and a triangle of the cloth that meet in a frame
  long steps = 0;
  Work work;
  std::vector<std::string> expected_keys;  // keys of the case's expectations
  std::vector<std::string> failed_keys;    // of those that do not hold
};

/// Runs the case. particles: of these only, the first ones, positions are kept. level_sets: of its
/// bodies; they should remember those that were made (bodies/level_set_provider.h). An error in
/// building or running goes into `stopped`.
ObservedRun observe_run(const Case& input_case, const LevelSetProvider& level_sets, int particles);

/// The case with another scene: what is expected of the case and makes no sense for that
/// scene is left out.
Case with_scene(const Case& input_case, Scene scene);

enum class Need { needed, not_needed, missing, no_effect, cannot_tell };

// "needed", "not needed here", "missing here", "no effect if added", "cannot tell"
std::string_view name_of(Need need);

/// A part of a case, run without it if it is there, else with it.
struct JudgedPart {
  std::string name;
  bool is_present;
  Need need;
  std::string reason;
  double position_difference;  // m
  double energy_difference;    // largest over the frames [J]
  std::string declared;        // why the case has it, or leaves it out, all the same; or ""
  ObservedRun run;

  /// It is there and needed, or absent without effect; otherwise a reason is declared. A reason
  /// that is not needed is not justified. Where one cannot tell, a reason may be given, or none.
  bool is_justified() const;
};

/// How far the scene's own run is from the truth, by its steps and by its mesh.
struct DiscretisationError {
  ErrorPart time, mesh;
  double floor = 0;  // a millionth of the cloth's size: less than that no one asks for [m]

  /// A change of positions above it counts: the sum with error bars [m].
  double value() const;

  /// A change of positions up to it does not count: the sum without error bars [m].
  double seen() const;
};

/// needed / missing, if the part changes positions by more than the scene's own error, its bar
/// included; or if without it the run comes to no end, an expectation of the case fails or has no
/// meaning, the cloth crosses itself, or is deeper in objects by more than that error. Not needed /
/// no effect, if the change and the depth are within the error that is seen. Between the two one
/// cannot tell: finer steps or meshes would.
JudgedPart judge_part(const ScenePart& part, const ObservedRun& scene, ObservedRun toggled,
                      const DiscretisationError& error, const PerParticle& mass);

/// The name, in [ablation], of the run with triangles of half the size. A case whose mesh
/// approximates nothing, such as a single hinge, says so under this name; its own error is then
/// that of time alone.
constexpr std::string_view finer_mesh = "finer mesh";

/// The reason that the case declares for the part of this name, or for doing without a
/// finer mesh, or "".
std::string declared_reason(const Case& input_case, std::string_view name);

/// Throws InputError for a declared part that the scene neither has nor lacks.
void reject_unknown_parts(const Case& input_case, const std::vector<ScenePart>& parts);

}  // namespace foldproof
