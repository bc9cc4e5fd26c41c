#include "scripts/program/campaign/run_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "convergence/campaigns/wide_key.h"
#include "scripts/program/provenance.h"
#include "scripts/program/run_case.h"
#include "verification/processor_time.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;

std::string digest_of(const State& s) {
  WideKey key;
  const auto add = [&](const double* values, Eigen::Index count) {
    key.add({reinterpret_cast<const char*>(values), size_t(count) * sizeof(double)});
  };
  add(&s.time, 1);
  add(s.x.data(), s.x.size());
  add(s.v.data(), s.v.size());
  return key.text();
}

/// The case with the job's overrides, and the campaign's quantities beside its own.
Case case_of(const BatchTerms& terms, const BatchJob& job) {
  std::string file;
  std::vector<std::string> overrides;
  for (const Assignment& a : job.set)
    if (a.key == "case")
      file = a.value;
    else
      overrides.push_back(a.key + "=" + a.value);
  Case input_case = read_case(file, overrides);
  if (terms.quantities.empty()) return input_case;
  const auto keys = parse_keys(terms.quantities, "[[quantity]] of the campaign");
  for (const Measurement& m : read_measurements(*keys, input_case.scene)) {
    std::erase_if(input_case.quantities,
                  [&](const Measurement& own) { return own.name == m.name; });
    input_case.quantities.push_back(m);
  }
  return input_case;
}

/// What answered contacts of the cloth with itself, summed over all steps; without contacts, no
/// share is known.
void add_answers(const Work& work, const auto& add) {
  const double repulsions = double(work.close_pairs), impulses = double(work.crossings);
  add("repulsions", repulsions, "1");
  add("impulses", impulses, "1");
  add("zone_particles", double(work.zone_particles), "1");
  add("share_of_impulses", impulses / (repulsions + impulses), "1");
}

void add_values(const CaseRun& run, const Case& input_case, JobAnswer& answer) {
  const auto add = [&](const std::string& name, double value, const std::string& unit) {
    answer.result.values[name] = value;
    answer.units[name] = unit;
  };
  add("steps", double(run.result.steps), "1");
  add("end_time", run.result.last.time, "s");
  add("cg_iterations", double(run.result.work.cg_iterations), "1");
  if (input_case.scene.self_collision) add_answers(run.result.work, add);
  for (const MeasuredQuantity& quantity : run.quantities)
    add(quantity.name, quantity.value, quantity.unit);
  for (size_t k = 0; k < run.findings.size() && k < input_case.expectations.size(); ++k) {
    const Verdict& v = run.findings[k].finding.verdict;
    add("expect." + input_case.expectations[k].key, v.measured, v.unit);
  }
}

/// Which expectations failed, in a line.
std::string failures_of(const CaseRun& run) {
  std::string names;
  for (const Record& record : run.findings)
    if (record.outcome == Outcome::fails || record.outcome == Outcome::inconclusive)
      names += (names.empty() ? "" : ", ") + record.name;
  return names;
}

long bytes_below(const std::string& folder) {
  long bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) bytes += long(entry.file_size());
  return bytes;
}

JobAnswer simulate_job(const BatchTerms& terms, const BatchJob& job,
                       const LevelSetProvider& level_sets) {
  const BuiltCase of = built_case(case_of(terms, job), level_sets);
  // each job has a folder of its own, so no variant overwrites another's files
  const std::string kept = "runs/" + job.key.substr(0, 2) + "/" + job.key;
  const std::string folder = terms.store + "/" + kept;
  const Progress no_one = [](double) {};
  if (terms.keep != Keep::none) fs::create_directories(folder);
  const CaseRun run = terms.keep == Keep::none
                          ? run_case_without_files(of, no_one)
                          : run_case(of, folder, provenance("campaign " + terms.campaign), no_one);
  JobAnswer answer;
  JobResult& result = answer.result;
  const std::string failures = failures_of(run);
  result.end = run.result.stop ? JobEnd::stopped : failures.empty() ? JobEnd::holds : JobEnd::fails;
  result.reason = run.result.stop ? run.record.stopped : failures;
  result.digest = digest_of(run.result.last);
  add_values(run, of.input_case, answer);
  if (terms.keep == Keep::failures && result.end == JobEnd::holds)
    fs::remove_all(folder);
  else if (terms.keep != Keep::none)
    result.kept = kept, result.bytes = bytes_below(folder);
  return answer;
}

}  // namespace

void sign(JobResult& result) {
  static const Provenance of = provenance("");
  result.host = host_name();
  result.date = provenance_date();
  result.commit = of.commit;
}

JobAnswer run_job(const BatchTerms& terms, const BatchJob& job,
                  const LevelSetProvider& level_sets) {
  const double start = processor_seconds();
  const auto clock_start = std::chrono::steady_clock::now();
  JobAnswer answer;
  try {
    answer =
        terms.run == "simulate" ? simulate_job(terms, job, level_sets) : command_job(terms, job);
  } catch (const std::bad_alloc&) {
    answer.result.end = JobEnd::out_of_memory;
    answer.result.reason = fmt::format("took more than {:.0f} MB", terms.limits.memory / 1e6);
  } catch (const InputError& error) {
    answer.result.end = JobEnd::refused;
    answer.result.reason = error.what();
  } catch (const std::exception& error) {
    if (terms.keep != Keep::none) throw;
    answer.result.end = JobEnd::stopped;
    answer.result.reason = std::string("error: ") + error.what();
  }
  if (answer.result.seconds == 0) answer.result.seconds = processor_seconds() - start;
  answer.result.clock =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - clock_start).count();
  sign(answer.result);
  return answer;
}

}  // namespace foldproof
