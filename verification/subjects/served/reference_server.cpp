#include "verification/subjects/served/reference_server.h"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <utility>
#include <vector>

#include "reference/dynamics/integrator.h"
#include "verification/subjects/reference_subject.h"
#include "verification/files/content_key.h"
#include "verification/subjects/pipe/declaration.h"
#include "verification/subjects/served/scene_message.h"

namespace foldproof {

namespace {

using foldproof_solver::Json;
using foldproof_solver::Numbers;

Numbers as_rows(const PerParticle3& columns) {
  return {columns.data(), columns.data() + columns.size()};
}

Json counted(const Work& work) {
  Json counts = Json::array();
  for_each_counter(work, [&](auto count) { counts.push_back(count); });
  return counts;
}

/// The reference keeps the states that its integrator looks back on; a state that is
/// set forgets them.
struct ReferenceSolver : foldproof_solver::Solver {
  Subject subject = reference_subject();
  ServedReference served;
  std::unique_ptr<PreparedScene> prepared;
  std::vector<State> past;
  MeshSequence path;  // of the held particles
  int history = 1;
  Work counts;
  Numbers contact;  // mean forces of the obstacles in the last advance [N]

  explicit ReferenceSolver(const ServedReference& s) : served(s) {
    const Integrator& integrator = integrator_named(served.integrator);
    declared.name = subject.name, declared.version = subject.version;
    declared.level = "L2", declared.precision = served.is_single ? "f4" : "f8";
    declared.scheme = integrator.title, declared.order = integrator.order;
    declared.capabilities.assign(known_capabilities().begin(), known_capabilities().end());
    declared.solve_tolerance =
        integrator.family == Family::fully_explicit ? 0 : SolverSettings{}.tolerance;
  }

  foldproof_solver::Mapping prepare(const foldproof_solver::Scene& message) override {
    Scene scene = reference_scene(message);
    const Json& constants = message.header.at("scene");
    const bool is_own = constants.contains("extension");
    if (!is_own) scene.integrator = served.integrator;
    prepared = subject.prepare(scene);
    record_contact(*prepared);
    path = is_own ? MeshSequence{} : held_path(message);
    if (constants.at("own_masses")) give_masses(message.numbers.at("mass"));
    history = integrator_named(scene.integrator).history;
    State start{0, scene.x, scene.v};
    if (!is_own && path.times.empty()) start = start_state(scene);
    set_state(as_rows(start.x), as_rows(start.v), 0);
    contact.assign(x.size(), 0);
    return {{"stretch", "a spring per edge, of stiffness Y A_e/L0^2 [N/m]"},
            {"bending", "ke = 4 B [J]: exact on equilateral meshes"},
            {"damping", "kd_s [N s/m] and kd [N s] of the paper"},
            {"integrator", scene.integrator}};
  }

  void give_masses(const Numbers& masses) {
    set_masses(*prepared,
               Eigen::Map<const PerParticle>(masses.data(), Eigen::Index(masses.size())));
  }

  /// For a step, held particles move as evenly as they come to their place at its end.
  void move_held(double from, double dt) {
    const PerParticle3 start = positions_at(path, from), end = positions_at(path, from + dt);
    std::vector<PrescribedParticle>& all = prescribed_of(*prepared);
    for (size_t k = 0; k < all.size(); ++k) {
      all[k].start = start.col(Eigen::Index(k));
      all[k].motion.velocity = (end.col(Eigen::Index(k)) - all[k].start) / dt;
      all[k].motion.from = from;
    }
  }

  void set_state(Numbers new_x, Numbers new_v, double new_time) override {
    Solver::set_state(std::move(new_x), std::move(new_v), new_time);
    past = {{time, as_columns(x), as_columns(v)}};
  }

  void set_state_before(Numbers x_before, Numbers v_before, double time_before) override {
    past.insert(past.begin(), {time_before, as_columns(x_before), as_columns(v_before)});
  }

  void advance(double dt, long steps) override {
    for (long k = 0; k < steps; ++k) {
      if (!path.times.empty()) move_held(past.back().time, dt);
      past.push_back(subject.step(*prepared, past, dt, counts));
      if (past.size() > size_t(history)) past.erase(past.begin());
    }
    time = past.back().time;
    x = as_rows(past.back().x), v = as_rows(past.back().v);
    const PerParticle3 impulses = take_contact_impulses(*prepared);
    contact = as_rows(impulses / (dt * double(std::max(steps, 1L))));
  }

  Numbers contact_forces() override { return contact; }
  Json work() override { return counted(std::exchange(counts, Work{})); }
  Numbers forces() override { return as_rows(subject.elastic_forces(*prepared, past.back())); }
  Numbers damping() override {
    return as_rows(subject.damping_forces(*prepared, past.back(), past.back().v));
  }
  double energy() override { return subject.potential_energy(*prepared, past.back()); }
};

/// Numbers of JSON as floats: other machines differ in the last digits.
void round_numbers(Json& json) {
  if (json.is_number_float()) json = double(float(json.get<double>()));
  if (json.is_structured())
    for (Json& part : json) round_numbers(part);
}

std::string hash_of(const foldproof_solver::Scene& message) {
  ContentKey key;
  Json constants = message.header.at("scene");
  round_numbers(constants);
  const std::string text = constants.dump();
  key.add(text.data(), text.size());
  for (const auto& [name, values] : message.numbers) {
    key.add(name.data(), name.size());
    for (const double value : values) key.add(double(float(value)) + 0.0);  // -0 is 0
  }
  for (const auto& [name, values] : message.integers) key.add(values);
  return key.text();
}

struct StillSolver : foldproof_solver::Solver {
  StillSolver() {
    declared.name = "still", declared.version = "1", declared.level = "L2";
    declared.precision = "f8", declared.scheme = "none", declared.order = 2;
    declared.capabilities.assign(known_capabilities().begin(), known_capabilities().end());
  }
  foldproof_solver::Mapping prepare(const foldproof_solver::Scene& message) override {
    set_state(message.numbers.at("x"), message.numbers.at("v"), 0);
    return {{"scene", hash_of(message)}};
  }
  void advance(double, long) override {}
  Numbers forces() override { return Numbers(x.size()); }
  Numbers damping() override { return Numbers(x.size()); }
  double energy() override { return 0; }
  Numbers contact_forces() override { return Numbers(x.size()); }
};

void require_pipe() {
  for (const char* name : {"FOLDPROOF_IN", "FOLDPROOF_OUT"})
    if (!std::getenv(name))
      throw InputError(
          std::string(name) +
          " is not set: start this command with `foldproof judge --solver \"foldproof serve\"`");
}

}  // namespace

int serve_still() {
  StillSolver solver;
  require_pipe();
  return foldproof_solver::serve(solver);
}

int serve_reference(const ServedReference& served) {
  ReferenceSolver solver(served);
  require_pipe();
  return foldproof_solver::serve(solver);
}

}  // namespace foldproof
