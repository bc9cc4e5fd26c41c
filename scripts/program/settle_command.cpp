// foldproof settle: where a case's cloth comes to rest, without a guessed damping.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "reference/dynamics/settle.h"
#include "reference/mesh/rigidity_map.h"
#include "reference/mesh/shapes.h"
#include "scripts/program/command_line/input_files.h"
#include "scripts/program/command_line/options_of_commands.h"
#include "scripts/program/command_line/out_folder.h"
#include "scripts/program/command_line/typed_words.h"
#include "scripts/program/json_text.h"
#include "scripts/program/listing.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_all.h"
#include "scripts/program/run_case.h"
#include "verification/cases/cantilever.h"
#include "verification/cases/judge.h"
#include "verification/files/trajectory_file.h"

namespace foldproof {

namespace {

struct SettleOptions : Options {
  int steps = 1000;
  double force = 1e-8;  // over the weight [1]
};

constexpr int most_saddles = 5;
constexpr int steps_watched = 50;  // of the method, from the rest that was found

/// A rest, and what the method makes of it.
struct SettledCase {
  Rest rest;
  double step = 0;      // of the method [s]
  double rounding = 0;  // of the positions alone, as a force over the weight [1]
  double speed = 0;     // largest in the watched steps [m/s]
  std::string stopped;  // why the watched steps ended early; or ""
  std::optional<ClampedStrip> strip;
  double seconds = 0;
};

double step_of(const Scene& scene, const System& system, const State& start) {
  const double fixed = scene.schedule.step.fixed;
  return fixed > 0 ? fixed : scene.schedule.step.safety * elastic_limit(system, start);
}

/// The case's own method, from the rest on.
void watch(const BuiltCase& of, SettledCase& settled) {
  const Scene& scene = of.input_case.scene;
  Schedule schedule = scene.schedule;
  schedule.step = {.fixed = settled.step};
  schedule.rest = std::nullopt;
  schedule.frame_interval = settled.step;
  schedule.end = settled.rest.state.time + steps_watched * settled.step;
  const RunResult run =
      simulate(of.built.system, integrator_named(scene.integrator), settled.rest.state, schedule,
               {[&](const State& s) {
                  settled.speed = std::max(settled.speed, s.v.colwise().norm().maxCoeff());
                },
                {}});
  if (run.stop) settled.stopped = describe(*run.stop);
}

SettledCase settled_case(const BuiltCase& of, const SettleOptions& options) {
  const Scene& scene = of.input_case.scene;
  const auto begin = std::chrono::steady_clock::now();
  SettledCase settled;
  settled.step = step_of(scene, of.built.system, of.built.start);
  settled.rounding = rounding_over_weight(of.built.system, of.built.start);
  settled.rest = settle(of.built.system, of.built.start,
                        {std::max(options.force, settled.rounding),
                         2 * smallest_height(scene.mesh.triangles, scene.mesh.rest), settled.step,
                         options.steps, most_saddles});
  watch(of, settled);
  settled.strip = clamped_strip(scene, settled.rest.state.x);
  settled.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return settled;
}

Record finding(const Scene& scene, const std::string& name, std::string claim, Verdict verdict,
               std::string note) {
  Record record;
  record.name = "settle." + scene.name + "." + name;
  record.kind = "case";
  record.claim = std::move(claim);
  record.finding.verdict = std::move(verdict);
  record.finding.note = std::move(note);
  record.outcome = outcome_of(record.finding.verdict);
  return record;
}

std::vector<Record> findings_of(const Scene& scene, const SettledCase& settled,
                                const SettleOptions& options) {
  const Rest& rest = settled.rest;
  const double limit = std::max(options.force, settled.rounding);
  std::vector<Record> findings{
      finding(scene, "is-at-rest", "The forces that the filters leave vanish beside the weight.",
              {rest.unbalanced.over_weight, limit, 0, "1",
               limit > options.force ? "what rounding of the positions alone changes"
                                     : "the limit asked for"},
              rest.steps < options.steps
                  ? ""
                  : fmt::format("the largest is on particle {}, after all {} steps: either nothing "
                                "holds the cloth, or the way is longer (--steps)",
                                rest.unbalanced.particle, options.steps)),
      finding(scene, "is-stable", "No small displacement lets the cloth fall farther.",
              {std::max(0.0, -rest.smallest_eigenvalue), 1e-6 * neutral_scale(rest.state.x), 0,
               "1/s^2", "a millionth of how strongly gravity holds a pendulum of the cloth's size"},
              "the smallest eigenvalue of the stiffness over the masses, as a negative number"),
      finding(
          scene, "stays",
          fmt::format("The case's own method, started there, stays for {} steps.", steps_watched),
          {settled.stopped.empty() ? settled.speed : nan, 1e-6, 0, "m/s",
           "a thousandth of a millimetre a second is seen by nobody"},
          settled.stopped)};
  if (rest.used_friction > 0)
    findings.push_back(finding(
        scene, "within-friction", "No touching point needs more friction than its load gives it.",
        {rest.used_friction, 1 + 1e4 * limit, 0, "1",
         "Coulomb's cone; on a point that bears a ten-thousandth of its weight the limit is that "
         "much"},
        "other shapes may be at rest, too: compare no single one with them"));
  return findings;
}

void print(const Scene& scene, const SettledCase& settled) {
  const Rest& rest = settled.rest;
  const auto line = [](const std::string& name, const std::string& value) {
    fmt::print("  {:<38} {}\n", name, value);
  };
  line(
      "unbalanced force / weight",
      fmt::format("{:.3g}, on particle {}", rest.unbalanced.over_weight, rest.unbalanced.particle));
  line("largest speed, watched",
       fmt::format("{:.3g} m/s in {} steps of {} by {:.3g} s", settled.speed, steps_watched,
                   scene.integrator, settled.step));
  line("smallest eigenvalue", fmt::format("{:.6g} 1/s^2", rest.smallest_eigenvalue));
  line("steps", fmt::format("{}", rest.steps));
  line("force evaluations", fmt::format("{}, and {} factorisations", rest.work.elastic_evaluations,
                                        rest.factorisations));
  if (rest.touching > 0)
    line("points on objects",
         fmt::format("{}, {} of them held by friction", rest.touching, rest.sticking));
  if (!settled.strip) return;
  const ClampedStrip& strip = *settled.strip;
  line("tip below the clamp",
       fmt::format("{:.6g} m; elastica: {:.6g} m", strip.drop, strip.elastica_drop));
  line("tip out from the clamp",
       fmt::format("{:.6g} m; elastica: {:.6g} m", strip.reach, strip.elastica_reach));
  line("strip", fmt::format("L = {:.4g} m, B = {:.4g} N m, rho g L^3/B = {:.4g}", strip.length,
                            strip.rigidity, strip.gamma));
}

nlohmann::json to_json(const SettledCase& settled, const std::vector<Record>& findings,
                       const std::string& file) {
  const Rest& rest = settled.rest;
  nlohmann::json json = {{"file", file},
                         {"unbalanced_over_weight", rest.unbalanced.over_weight},
                         {"particle", rest.unbalanced.particle},
                         {"speed", settled.speed},
                         {"smallest_eigenvalue", rest.smallest_eigenvalue},
                         {"steps", rest.steps},
                         {"elastic_evaluations", rest.work.elastic_evaluations},
                         {"factorisations", rest.factorisations},
                         {"touching", rest.touching},
                         {"sticking", rest.sticking},
                         {"used_friction", rest.used_friction},
                         {"seconds", settled.seconds},
                         {"findings", nlohmann::json::array()}};
  for (const Record& record : findings)
    json["findings"].push_back({{"name", record.name},
                                {"outcome", outcome_text(record)},
                                {"measured", record.finding.verdict.measured},
                                {"bound", record.finding.verdict.bound},
                                {"note", record.finding.note}});
  if (const auto& strip = settled.strip)
    json["cantilever"] = {{"drop", strip->drop},
                          {"reach", strip->reach},
                          {"elastica_drop", strip->elastica_drop},
                          {"elastica_reach", strip->elastica_reach},
                          {"length", strip->length},
                          {"rigidity", strip->rigidity},
                          {"gamma", strip->gamma}};
  return json;
}

int settle_case(const SettleOptions& options) {
  Case input_case = read_case(case_file(options.file), options.overrides);
  const OutFolder folder(options.out);
  const BuiltCase of =
      built_case(std::move(input_case), provider_for(options.cache, threads_of(options.running)));
  const Scene& scene = of.input_case.scene;
  log_warnings(scene);
  const std::string name = scene.name + ".h5";
  TrajectoryFile file((std::filesystem::path(options.out) / name).string(), scene, of.built.system,
                      of.built.objects, provenance(options.command));
  const SettledCase settled = settled_case(of, options);
  const std::vector<Record> findings = findings_of(scene, settled, options);
  State last = settled.rest.state;
  last.time += scene.schedule.frame_interval;  // it has no time; a file's frames ascend
  file.add_frame(of.built.start);
  file.add_frame(last);
  file.finish("", settled.seconds, findings);
  RunRecord record;
  record.records = findings;
  if (options.json) {
    fmt::print("{}\n", json_text(to_json(settled, findings, options.out + "/" + name)));
  } else {
    fmt::print("{}", listing(record));
    print(scene, settled);
    fmt::print("{}/{}: the start, and the rest as frame 1; {:.1f} s\n", options.out, name,
               settled.seconds);
  }
  return exit_code(record);
}

constexpr const char* below_settle =
    R"(Follows the forces without inertia or a guessed damping: steps of backward Euler that
forget their velocity and grow to Newton's. Velocities and damping of the case count for nothing;
what holds and touches the cloth must stand still, and strain limits be unset. The force is what
contact and friction leave. A rest with friction is one of many: its shape depends on the way. A
saddle is left along its falling mode. A strip that is clamped at one end (cases/cantilever.toml)
is compared with the elastica of its rigidity.

Examples:
  foldproof settle hanging_sheet --out mine
  foldproof settle cantilever --set cloth.fabric=wool --out mine

Exit codes:
  0    at rest, stable, and the case's own method stays there
  1    not at rest within --steps, or a saddle; the findings say which
  2    bad input, or a file that cannot be written)";

}  // namespace

void add_settle_command(CLI::App& app, Program& program) {
  auto [settle, options] = add_command(
      app, program,
      {"settle", "Find where a case's cloth comes to rest; writes NAME.h5 and NAME.xdmf",
       below_settle},
      settle_case);
  add_input(settle, "CASE", options.file, case_words);
  add_overrides(settle, options);
  settle->add_option("--steps", options.steps, "Most steps")
      ->type_name("N")
      ->check(whole_number(1, 1000000))
      ->capture_default_str();
  settle->add_option("--force", options.force, "Limit of the unbalanced force over the weight")
      ->type_name("F")
      ->capture_default_str();
  add_cache(settle, options);
  add_folder(settle, options, "Folder for results")->capture_default_str();
  add_json(settle, options);
}

}  // namespace foldproof
