#include "verification/subjects/suite/conformance.h"

#include <fmt/format.h>

#include <functional>
#include <optional>

#include "verification/subjects/suite/scenes.h"

namespace foldproof {

namespace {

constexpr long steps = 3;

struct Demand {
  const char* text;
  int level;                                      // the least level that must keep it
  const char* capability;                         // that must be declared, or ""
  std::function<std::string(PipedSolver&)> keep;  // returns a note
};

Snapshot start_of(const PortableScene& scene) { return {scene.x, scene.v}; }

std::string mapping_text(PipedSolver& solver) {
  std::string text;
  for (const auto& [key, value] : solver.prepare(suite::moving_sheet()))
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", key, value);
  return text.empty() ? "no mapping is stated" : text;
}

std::string run_twice_as_far(PipedSolver& solver) {
  const PortableScene scene = suite::moving_sheet();
  const std::vector<Snapshot> frames = solver.run(scene, {steps, 2 * steps});
  return fmt::format("{} frames of {} particles", frames.size(), frames[0].x.cols());
}

std::string step_once(PipedSolver& solver) {
  const PortableScene scene = suite::moving_sheet();
  solver.step({start_of(scene)}, {0}, scene.dt);
  return "";
}

std::string start_other_scene(PipedSolver& solver) {
  const PortableScene scene = suite::small_sheet();
  solver.prepare(scene);
  const long particles = solver.advance(scene.dt, steps).x.cols();
  return fmt::format("{} particles", particles);
}

/// The small sheet is put above an obstacle, which it meets in the first step.
Demand meets(const char* demand, const char* capability, void (*put)(PortableScene&)) {
  return {demand, 1, capability, [put](PipedSolver& solver) {
            PortableScene scene = suite::small_sheet();
            scene.gravity = Vector3(0, 0, -9.81);
            put(scene);
            solver.prepare(scene);
            solver.advance(scene.dt, steps);
            return std::string();
          }};
}

void put_plane(PortableScene& s) { s.planes = {{Vector3::Zero(), Vector3::UnitZ(), 0.3}}; }
void put_box(PortableScene& s) { s.boxes = {{{0.1, 0.1, -0.5}, {1, 1, 0.5}, 0.3}}; }
void put_sphere(PortableScene& s) { s.spheres = {{{0.1, 0.1, -0.4}, 0.4, 0.3}}; }
void put_capsule(PortableScene& s) { s.capsules = {{{-1, 0.1, -0.1}, {1, 0.1, -0.1}, 0.1, 0.3}}; }

void put_body(PortableScene& s) {
  PortableBody body{PerParticle3(3, 4), {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}, 0.3};
  body.vertices << -1, 1, 0, 0, -1, -1, 1, 0, -1, -1, -1, 0;
  s.bodies = {body};
}
void put_moving(PortableScene& s) {
  put_plane(s);
  s.planes[0].motion = {{{0, {}}, {1, {Eigen::Quaterniond::Identity(), Vector3(0.1, 0, 0)}}}};
}
void lead_corner(PortableScene& s) {
  s.held = {0};
  s.moving_held = {{0, 1}, {s.x.col(0), Vector3(s.x.col(0)) + Vector3(0.1, 0, 0)}};
}
void put_materials(PortableScene& s) {
  s.materials = {s.material, s.material};
  s.material_of_triangle.resize(s.mesh.triangles.size(), 1);
}
void rub_by_material(PortableScene& s) {
  put_plane(s), put_materials(s);
  s.materials[1].friction = 0.5;
}
void weave(PortableScene& s) {
  s.material.membrane = {5, 4, 1, 0.2};
  s.material.young = 0;
  for (const Triangle& t : s.mesh.triangles)
    s.warp.push_back((s.mesh.rest.col(t[1]) - s.mesh.rest.col(t[0])).normalized());
}
void limit_strain(PortableScene& s) { s.strain_limits = {0.1, 0.1}; }
void put_air(PortableScene& s) { s.air = {1.2, Vector3(1, 0, 0), 1.17, 0.02}; }
void rub_layers(PortableScene& s) { s.thickness = 0.01, s.layer_friction = 0.3; }

/// Each tunable at the least of its range, and at its own value: the sheet is moved.
std::string tune(PipedSolver& solver) {
  const auto& tunables = solver.declaration().tunables;
  if (tunables.empty()) return "none are declared";
  std::string names;
  for (const Tunable& tunable : tunables) {
    names += (names.empty() ? "" : ", ") + tunable.name;
    for (const double value : {tunable.least, tunable.value}) {
      solver.tune({{tunable.name, value}});
      solver.prepare(suite::moving_sheet());
      solver.advance(suite::moving_sheet().dt, 1);
    }
  }
  solver.tune({});
  return names;
}

std::string read_contact(PipedSolver& solver) {
  PortableScene scene = suite::small_sheet();
  put_plane(scene);
  solver.prepare(scene);
  solver.advance(scene.dt, 1);
  solver.contact_forces();
  return "";
}

std::string ask_declined(PipedSolver& solver) {
  if (!solver.declines_unknown_operation())
    throw SolverFailure("header", "answered an operation that does not exist");
  return "";
}

std::vector<Demand> all_demands() {
  const auto state = [] { return start_of(suite::moving_sheet()); };
  return {
      {"run returns the frames", 0, "", run_twice_as_far},
      {"prepare states the mapping", 1, "", mapping_text},
      {"advance returns the state", 1, "",
       [](PipedSolver& s) { return s.advance(suite::moving_sheet().dt, steps), std::string(); }},
      {"get_state returns the state", 1, "",
       [](PipedSolver& s) { return s.get_state(), std::string(); }},
      {"step moves a given state", 1, "set_state", step_once},
      {"forces are returned", 2, "",
       [state](PipedSolver& s) { return s.forces(state(), 0), std::string(); }},
      {"damping forces are returned", 2, "",
       [state](PipedSolver& s) { return s.damping(state(), 0), std::string(); }},
      {"energy is returned", 2, "",
       [state](PipedSolver& s) { return fmt::format("{:.3g} J", s.energy(state(), 0)); }},
      {"an unknown operation is declined", 0, "", ask_declined},
      {"a second scene of other size is accepted", 1, "", start_other_scene},
      meets("a sheet on a plane is moved", "planes", put_plane),
      meets("a sheet on a box is moved", "boxes", put_box),
      meets("a sheet on a sphere is moved", "spheres", put_sphere),
      meets("a sheet on a capsule is moved", "capsules", put_capsule),
      meets("a sheet on a body is moved", "bodies", put_body),
      meets("a sheet on a moving plane is moved", "moving_obstacles", put_moving),
      meets("a sheet with a led corner is moved", "moving_held", lead_corner),
      meets("a sheet of two materials is moved", "materials", put_materials),
      meets("a sheet of a material with friction is moved", "material_friction", rub_by_material),
      meets("a woven sheet is moved", "membrane", weave),
      meets("a sheet with strain limits is moved", "strain_limits", limit_strain),
      meets("a sheet in air is moved", "air", put_air),
      meets("a sheet with friction of layers is moved", "layer_friction", rub_layers),
      {"contact forces are returned", 1, "contact_forces", read_contact},
      {"scenes set the tunables", 1, "", tune},
      {"stop is answered, and nothing else is sent", 0, "",
       [](PipedSolver& s) { return s.stop(), std::string(); }},
  };
}

ConformanceRow try_demand(const Demand& demand, PipedSolver& solver) {
  try {
    return {demand.text, Conformity::kept, demand.keep(solver)};
  } catch (const NotOffered& missing) {
    return {demand.text, Conformity::declined, missing.operation};
  } catch (const SolverFailure& failure) {
    return {demand.text, Conformity::broken, failure.what()};
  }
}

std::string describe(const Declaration& d) {
  std::string all;
  for (const std::string& capability : d.capabilities) all += " " + capability;
  return fmt::format("{} {}: L{}, {}, {} of order {}; capabilities:{}", d.name, d.version, d.level,
                     d.is_single ? "f4" : "f8", d.scheme, d.order, all.empty() ? " none" : all);
}

}  // namespace

std::vector<ConformanceRow> check_conformance(const SolverCommand& command) {
  std::vector<ConformanceRow> rows;
  std::optional<PipedSolver> solver;
  try {
    solver.emplace(command);
  } catch (const SolverFailure& failure) {
    if (failure.cause == "start") throw InputError(failure.what());
    return {{"start is answered by a declaration", Conformity::broken, failure.what()}};
  }
  const Declaration& declared = solver->declaration();
  rows.push_back({"start is answered by a declaration", Conformity::kept, describe(declared)});
  for (const Demand& demand : all_demands()) {
    if (declared.level < demand.level) continue;
    if (*demand.capability && !declared.offers(demand.capability)) continue;
    rows.push_back(try_demand(demand, *solver));
    if (rows.back().conformity == Conformity::broken) break;
  }
  return rows;
}

}  // namespace foldproof
