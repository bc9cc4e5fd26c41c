#include "convergence/any_case/ablation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <utility>

#include "verification/cases/judge.h"
#include "verification/cases/quantities.h"
#include "verification/cases/self_crossings.h"
#include "verification/processor_time.h"

namespace foldproof {

namespace {

/// Depth inside an object at a frame [m]; 0 where there is none.
double depth_at(const Scene& scene, std::span<const Object> objects, const State& frame) {
  return objects.empty() ? 0 : value_at(*find_quantity("stays_outside"), scene, objects, frame);
}

ObservedRun simulate_observed(const Case& input_case, const LevelSetProvider& level_sets,
                              int particles) {
  const Scene& scene = input_case.scene;
  const BuiltScene built = build(scene, level_sets);
  const std::span<const Object> objects = built.objects;
  ObservedRun run;
  std::map<double, double> energy;
  CaseJudge judge(input_case, objects, level_sets);
  Worst deepest, crossings;
  const Observer observer{[&](const State& s) {
                            judge.record(s);
                            run.times.push_back(s.time);
                            run.x.push_back(s.x.leftCols(particles));
                            deepest.observe(depth_at(scene, objects, s));
                            crossings.observe(self_crossings(scene, s));
                          },
                          [&](const Diagnostics& row) {
                            judge.record(row);
                            energy[row.time] = row.energy.total();
                          }};
  const RunResult result = simulate(built.system, integrator_named(scene.integrator), built.start,
                                    scene.schedule, observer);
  for (const double t : run.times) run.energy.push_back(energy.contains(t) ? energy.at(t) : nan);
  run.deepest = deepest.value();
  run.crossings = crossings.value();
  run.steps = result.steps;
  run.work = result.work;
  if (result.stop) run.stopped = describe(*result.stop);
  const std::vector<Record> records = judge.records(result);
  for (size_t k = 0; k < records.size(); ++k) {
    if (!input_case.expectations[k].not_asked.empty()) continue;
    run.expected_keys.push_back(input_case.expectations[k].key);
    if (records[k].outcome != Outcome::holds)
      run.failed_keys.push_back(input_case.expectations[k].key);
  }
  return run;
}

/// Those of `keys` that are not among `others`.
std::vector<std::string> not_in(const std::vector<std::string>& keys,
                                const std::vector<std::string>& others) {
  std::vector<std::string> left;
  for (const std::string& key : keys)
    if (std::ranges::find(others, key) == others.end()) left.push_back(key);
  return left;
}

double energy_difference(const ObservedRun& a, const ObservedRun& b) {
  Worst worst;
  for (size_t k = 0; k < std::min(a.energy.size(), b.energy.size()); ++k)
    worst.observe(std::abs(a.energy[k] - b.energy[k]));
  return worst.value();
}

/// Why the run without the part is no run of the same scene, in words; "" if it is.
std::string reason(const ObservedRun& without, const ObservedRun& with, double moved,
                   const DiscretisationError& error) {
  if (!without.stopped.empty() && with.stopped.empty())
    return "without it the run stops early: " + without.stopped;
  if (const auto failed_keys = not_in(without.failed_keys, with.failed_keys); !failed_keys.empty())
    return fmt::format("without it this expectation fails: {}", fmt::join(failed_keys, ", "));
  if (const auto meaningless = not_in(with.expected_keys, without.expected_keys);
      without.stopped.empty() && !meaningless.empty())
    return fmt::format("without it this expectation has no meaning: {}",
                       fmt::join(meaningless, ", "));
  if (without.crossings > 0 && with.crossings == 0)
    return fmt::format("without it the cloth crosses itself, in {:g} places of a frame",
                       without.crossings);
  if (!(without.deepest <= with.deepest + error.value()))
    return fmt::format("without it cloth is {:.3g} m deep in an object, with it {:.3g} m",
                       without.deepest, with.deepest);
  if (!(moved <= error.value()))
    return fmt::format(
        "the motion differs by {:.3g} m, more than the scene's own error of {:.3g} m", moved,
        error.value());
  return "";
}

/// Why one cannot tell whether the run without the part is another one, in words; "" if it is none.
std::string doubt(const ObservedRun& without, const ObservedRun& with, double moved,
                  const DiscretisationError& error) {
  const double deeper = without.deepest - with.deepest;
  if (std::max(moved, deeper) <= error.seen()) return "";
  const std::string what = moved > error.seen()
                               ? fmt::format("the motion differs by {:.3g} m", moved)
                               : fmt::format("without it cloth is {:.3g} m deeper", deeper);
  return fmt::format("{}; the scene's own error is {:.3g} m, {:.3g} m with its error bar", what,
                     error.seen(), error.value());
}

double sum_of_known(double time, double mesh) {
  return (std::isnan(time) ? 0 : time) + (std::isnan(mesh) ? 0 : mesh);
}

}  // namespace

std::string_view name_of(Need need) {
  constexpr std::string_view names[] = {"needed", "not needed here", "missing here",
                                        "no effect if added", "cannot tell"};
  return names[size_t(need)];
}

ObservedRun observe_run(const Case& input_case, const LevelSetProvider& level_sets, int particles) {
  const double start = processor_seconds();
  ObservedRun run;
  try {
    run = simulate_observed(input_case, level_sets, particles);
  } catch (const std::exception& error) {
    run.stopped = error.what();
  }
  run.seconds = processor_seconds() - start;
  return run;
}

Case with_scene(const Case& input_case, Scene scene) {
  Case changed{std::move(scene), {}, {}};
  for (const Expectation& expectation : input_case.expectations) {
    const auto rejection = find_quantity(expectation.key)->rejection;
    if (!rejection || rejection(changed.scene).empty()) changed.expectations.push_back(expectation);
  }
  return changed;
}

bool JudgedPart::is_justified() const {
  const bool is_plain = need == Need::needed || need == Need::no_effect;
  return need == Need::cannot_tell || is_plain == declared.empty();
}

std::string declared_reason(const Case& input_case, std::string_view name) {
  for (const DeclaredPart& one : input_case.declared)
    if (one.part == name) return one.why;
  return "";
}

void reject_unknown_parts(const Case& input_case, const std::vector<ScenePart>& parts) {
  for (const DeclaredPart& one : input_case.declared) {
    if (one.part == finer_mesh ||
        std::ranges::find(parts, one.part, &ScenePart::name) != parts.end())
      continue;
    std::vector<std::string> known = {std::string(finer_mesh)};
    for (const ScenePart& part : parts) known.push_back(part.name);
    throw InputError(
        fmt::format("{}: [ablation] names a part '{}' that cannot be toggled; known: {}",
                    input_case.scene.name, one.part, fmt::join(known, ", ")));
  }
}

double DiscretisationError::value() const {
  return std::max(sum_of_known(time.value, mesh.value), floor);
}

double DiscretisationError::seen() const {
  return std::max(sum_of_known(time.seen, mesh.seen), floor);
}

JudgedPart judge_part(const ScenePart& part, const ObservedRun& scene, ObservedRun toggled,
                      const DiscretisationError& error, const PerParticle& mass) {
  JudgedPart result{part.name, part.is_present, Need::needed, "", 0, 0, "", {}};
  result.position_difference = largest_difference(scene.x, toggled.x, mass);
  result.energy_difference = energy_difference(scene, toggled);
  const ObservedRun &with = part.is_present ? scene : toggled,
                    &without = part.is_present ? toggled : scene;
  result.reason = reason(without, with, result.position_difference, error);
  const std::string in_doubt = doubt(without, with, result.position_difference, error);
  if (!result.reason.empty()) {
    result.need = part.is_present ? Need::needed : Need::missing;
  } else if (!in_doubt.empty()) {
    result.need = Need::cannot_tell;
    result.reason = in_doubt;
  } else {
    result.need = part.is_present ? Need::not_needed : Need::no_effect;
    result.reason = fmt::format("the motion differs by {:.3g} m; the scene's own error is {:.3g} m",
                                result.position_difference, error.seen());
  }
  result.run = std::move(toggled);
  return result;
}

// The parts of a scene.

namespace {

using Parts = std::vector<ScenePart>;

void add(Parts& parts, bool applies, bool is_present, const std::string& name,
         std::function<void(Scene&)> toggle) {
  if (!applies) return;
  parts.push_back({name, is_present, [toggle = std::move(toggle)](Scene scene) {
                     toggle(scene);
                     return scene;
                   }});
}

void add_present(Parts& parts, bool applies, const std::string& name,
                 std::function<void(Scene&)> remove) {
  add(parts, applies, true, name, std::move(remove));
}

void add_absent(Parts& parts, bool applies, const std::string& name,
                std::function<void(Scene&)> put) {
  add(parts, applies, false, name, std::move(put));
}

void add_forces(const Scene& scene, Parts& parts) {
  add_present(parts, scene.gravity && scene.gravity->norm() > 0, "gravity",
              [](Scene& s) { s.gravity.reset(); });
  add_present(parts, scene.stretch.has_value(), "springs", [](Scene& s) {
    s.stretch.reset();
    s.strain_limits.reset();
  });
  const std::vector<ClothFabric> fabrics = fabrics_of(scene);
  const auto any = [&](auto has) { return std::ranges::any_of(fabrics, has); };
  const bool springs_damp = any([](const ClothFabric&of) { return of.stretch.damping > 0; }),
             hinges_damp = any([](const ClothFabric&of) { return of.bending.damping > 0; });
  add_present(parts, springs_damp, "damping of springs", [](Scene& s) {
    s.stretch->damping = 0;
    for (ClothFabric& fabric : s.fabrics.fabrics) fabric.stretch.damping = 0;
  });
  add_present(parts, scene.membrane.has_value(), "membrane", [](Scene& s) { s.membrane.reset(); });
  add_present(parts, !scene.fabrics.empty(), "differences of fabrics",
              [](Scene& s) { s.fabrics = {}; });
  add_present(parts, !scene.mesh.pattern.empty(), "flat pattern", [](Scene& s) {
    s.mesh.pattern.clear();  // its rest shape is then the start
    if (s.bending) s.rest_angles = hinge_angles(s.mesh, s.mesh.rest);
  });
  add_present(parts, scene.air.has_value(), "air", [](Scene& s) { s.air.reset(); });
  add_present(parts, scene.air && !scene.air->wind.isZero(0), "wind",
              [](Scene& s) { s.air->wind.setZero(); });
  add_present(parts, scene.bending.has_value(), "bending", [](Scene& s) {
    s.bending.reset();
    s.rest_angles.clear();
  });
  add_present(parts, hinges_damp, "damping of bending", [](Scene& s) {
    s.bending->damping = 0;
    for (ClothFabric& fabric : s.fabrics.fabrics) fabric.bending.damping = 0;
  });
  constexpr double flat = 1e-9;  // rad: what rounding makes of a flat sheet
  const bool is_shaped =
      std::ranges::any_of(scene.rest_angles, [](double angle) { return std::abs(angle) > flat; });
  add_present(parts, is_shaped, "rest angles",
              [](Scene& s) { std::ranges::fill(s.rest_angles, 0.0); });
}

void add_objects(const Scene& scene, Parts& parts) {
  for (size_t k = 0; k < scene.objects.size(); ++k)
    add_present(parts, true, "object '" + scene.objects[k].object.name + "'",
                [k](Scene& s) { s.objects.erase(s.objects.begin() + std::ptrdiff_t(k)); });
  const bool rubs =
      std::ranges::any_of(scene.objects,
                          [](const SceneObject& part) { return part.object.friction > 0; }) ||
      std::ranges::any_of(scene.fabrics.fabrics,
                          [](const ClothFabric& fabric) { return fabric.friction > 0; });
  add_present(parts, rubs && !scene.objects.empty(), "friction of objects", [](Scene& s) {
    for (SceneObject& part : s.objects) part.object.friction = 0;
    for (ClothFabric& fabric : s.fabrics.fabrics) fabric.friction = 0;
  });
  add_present(parts, !scene.objects.empty() && scene.collision.points != PointKind::particles,
              "points between particles",
              [](Scene& s) { s.collision.points = PointKind::particles; });
  add_absent(parts, !scene.objects.empty() && scene.collision.points == PointKind::particles,
             "points between particles", [](Scene& s) { s.collision.points = PointKind::faces; });
}

void add_constraints(const Scene& scene, Parts& parts) {
  add_present(parts, !scene.prescribed.empty(), "held particles",
              [](Scene& s) { s.prescribed.clear(); });
  for (size_t k = 0; k < scene.sticky.size(); ++k)
    add_present(parts, true, "sticky '" + scene.sticky[k].name + "'",
                [k](Scene& s) { s.sticky.erase(s.sticky.begin() + std::ptrdiff_t(k)); });
  add_present(parts, scene.strain_limits.has_value(), "strain limits",
              [](Scene& s) { s.strain_limits.reset(); });
  add_absent(parts, scene.stretch && !scene.strain_limits, "strain limits",
             [](Scene& s) { s.strain_limits = StrainLimits{}; });
  add_present(parts, scene.self_collision.has_value(), "self-collision",
              [](Scene& s) { s.self_collision.reset(); });
  add_absent(parts, !scene.self_collision, "self-collision", [](Scene& s) {
    s.self_collision = SelfCollisionSettings{};
    s.self_collision->thickness = smallest_height(s.mesh.triangles, s.mesh.rest) / 4;
  });
}

}  // namespace

std::vector<ScenePart> parts_of(const Scene& scene) {
  Parts parts;
  add_forces(scene, parts);
  add_objects(scene, parts);
  add_constraints(scene, parts);
  return parts;
}

}  // namespace foldproof
