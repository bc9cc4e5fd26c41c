#include "scripts/program/judge/trial_progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "scripts/program/command_line/suggestions.h"
#include "scripts/program/judge/law_sizes.h"
#include "scripts/program/progress.h"
#include "scripts/program/provenance.h"
#include "verification/files/atomic_file.h"
#include "verification/subjects/pipe/scene_request.h"

namespace foldproof {

namespace {

constexpr double longest_quick = 25;  // s of a numpy solver; all of them: less than 5 minutes

const LawSize* size_of(const Law& law) {
  const auto* const found = std::ranges::find(law_sizes, law.name, &LawSize::name);
  return found == std::end(law_sizes) ? nullptr : found;
}

double numpy_seconds(double steps, double particle_steps) {
  constexpr double seconds_a_step = 2e-3, particles = 400;
  return seconds_a_step * std::max(steps, particle_steps / particles);
}

/// Of a law whose size was never recorded: it may be slow.
double numpy_seconds(const Law& law) {
  const LawSize* const size = size_of(law);
  return size ? numpy_seconds(size->steps, size->particle_steps) : longest_quick;
}

bool is_quick(const Law& law) { return numpy_seconds(law) <= longest_quick; }

void require_known(const std::vector<Law>& laws, const std::string& name) {
  const auto is_chosen = [&](const Law& law) { return chooses_law(name, law.name); };
  if (std::ranges::any_of(laws, is_chosen)) return;
  std::vector<std::string> known;
  for (const Law& law : laws)
    known.insert(known.end(), {law.name, law.name.substr(0, law.name.find('.'))});
  const std::string meant = did_you_mean(nearest_names(name, known));
  throw InputError(fmt::format("there is no law '{}' (`foldproof list laws` shows all){}", name,
                               meant.empty() ? "; is CMD in quotes?" : meant));
}

JobSettings kept_in(const Options& options) {
  JobSettings settings;
  settings.keep_in = options.out;
  settings.resumes = options.resumes;
  settings.restarts = options.restarts;
  return settings;
}

RunRecord begun_run(const Options& options) {
  RunRecord run;
  run.provenance = provenance(options.command);
  run.tier = options.tier;
  run.seed = options.seed_shift;
  return run;
}

/// 3 x N as N rows.
nlohmann::json rows_of(const PerParticle3& x) {
  nlohmann::json rows = nlohmann::json::array();
  for (Eigen::Index i = 0; i < x.cols(); ++i) rows.push_back({x(0, i), x(1, i), x(2, i)});
  return rows;
}

}  // namespace

bool chooses_law(const std::string& wanted, const std::string& name) {
  return !wanted.empty() && name.starts_with(wanted);
}

std::vector<Law> chosen_laws(const std::vector<std::string>& names,
                             const std::vector<std::string>& skipped) {
  std::vector<Law> laws = portable_laws();
  for (const auto* typed : {&names, &skipped})
    for (const std::string& name : *typed) require_known(laws, name);
  const auto is_among = [](const std::vector<std::string>& typed, const Law& law) {
    return std::ranges::any_of(typed, [&](auto& name) { return chooses_law(name, law.name); });
  };
  std::erase_if(laws, [&](const Law& law) {
    return (!names.empty() && !is_among(names, law)) || is_among(skipped, law);
  });
  std::ranges::stable_sort(laws, {}, [](const Law& law) {
    return law.name.starts_with("smoke.") ? -1 : is_quick(law) ? 0 : numpy_seconds(law);
  });
  return laws;
}

double seconds_of_a_numpy_solver(const Observed& asked) {
  return numpy_seconds(asked.steps, asked.particle_steps);
}

TrialProgress::TrialProgress(const Options& options, const std::vector<Law>& laws)
    : options_(options),
      kept_(kept_in(options), begun_run(options)),
      key_(fmt::format("{}\n{}\n{}", options.solver, fmt::join(options.settings, "\n"),
                       laws.size())) {}

void TrialProgress::tell_size(const Law& law) const {
  const LawSize* const size = size_of(law);
  if (!size) return show_line(law.name + " ...");
  std::string text =
      fmt::format("{}: {} scene{}, {} steps of up to {} particles", law.name, size->scenes,
                  size->scenes == 1 ? "" : "s", size->steps, size->particles);
  if (seconds_ > 1)
    text += fmt::format(
        ", about {:.2g} s at the pace so far",
        seconds_ * std::max(size->steps / steps_, size->particle_steps / particle_steps_));
  show_line(text);
}

void TrialProgress::end_law(const Record& record, const Observed& asked) {
  end_dump();
  dumped_ = {};
  if (asked.steps > 0) {
    seconds_ += record.seconds, steps_ += asked.steps, particle_steps_ += asked.particle_steps;
    asked_[record.name] = asked;
  }
  log_line(
      fmt::format("{:<14} {:<60} {:.1f} s", outcome_text(record), record.name, record.seconds));
  if (did_not_run(record)) return;
  RunRecord part;
  part.records = {record};
  kept_.keep(record.name + "\n" + key_, part);
}

std::string TrialProgress::asked_text() const {
  Observed sum;
  long laws = 0;
  for (const Law& law : portable_laws()) {
    const auto found = asked_.find(law.name);
    if (found == asked_.end() || !is_quick(law)) continue;
    ++laws;
    sum.advances += found->second.advances, sum.steps += found->second.steps;
    sum.particle_steps += found->second.particle_steps;
  }
  if (laws == 0) return "";
  return fmt::format(
      "{} quick laws asked {} calls of advance, {:.0f} steps, {:.3g} particle-steps: {:.0f} s of a "
      "solver that takes 2 ms a step of 400 particles\n",
      laws, sum.advances, sum.steps, sum.particle_steps, seconds_of_a_numpy_solver(sum));
}

/// Keeps the scene as it was sent, with its latest answer, until another one comes.
void TrialProgress::dump(const Law& law, const PortableScene& scene, long steps,
                         const Snapshot& now) {
  if (law.name != dumped_.law) end_dump(), dumped_ = {}, dumped_.law = law.name;
  if (dumped_.number == 0 || steps <= dumped_.steps) {  // another scene, or the same again
    end_dump();
    ++dumped_.number, dumped_.scene = scene;
  }
  dumped_.steps = steps, dumped_.now = now;
}

void TrialProgress::end_dump() {
  if (dumped_.number == 0) return;
  Request request;
  add_scene(dumped_.scene, {}, request);
  nlohmann::json file = lists_of(request);
  file["scene"] = request.header["scene"];
  file["answer"] = {
      {"steps", dumped_.steps}, {"x", rows_of(dumped_.now.x)}, {"v", rows_of(dumped_.now.v)}};
  const std::string folder = options_.dump + "/" + dumped_.law;
  std::filesystem::create_directories(folder);
  write_text(fmt::format("{}/{:03}.json", folder, dumped_.number), file.dump() + "\n");
}

TrialWatch TrialProgress::watch() {
  TrialWatch watch;
  watch.law_seconds = options_.law_seconds;
  watch.before = [this](const Law& law) { tell_size(law); };
  watch.kept = [this](const Law& law) -> std::optional<Record> {
    const auto part = kept_.found(law.name + "\n" + key_);
    if (!part) return {};
    return part->records.at(0);
  };
  watch.done = [this](const Record& record, const Observed& asked) { end_law(record, asked); };
  if (!options_.dump.empty())
    watch.heard = [this](const Law& law, const PortableScene& scene, long steps,
                         const Snapshot& now) { dump(law, scene, steps, now); };
  return watch;
}

}  // namespace foldproof
