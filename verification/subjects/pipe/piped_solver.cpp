#include "verification/subjects/pipe/piped_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "verification/subjects/pipe/declaration.h"
#include "verification/subjects/pipe/message.h"
#include "verification/subjects/pipe/scene_request.h"

namespace foldproof {

namespace {

using nlohmann::json;

constexpr size_t longest_header = 1 << 20;
constexpr double longest_progress = 10;  // times the limit of silence that a call may last

/// "by 20 steps of 0.002 s"
std::string steps_text(long steps, double dt) {
  return fmt::format("by {} step{} of {:.4g} s", steps, steps == 1 ? "" : "s", dt);
}

/// To follow "its last words": one line behind it, more below it.
std::string words_text(const std::vector<std::string>& lines) {
  if (lines.empty()) return " none";
  if (lines.size() == 1) return " " + lines[0];
  return fmt::format("\n    {}", fmt::join(lines, "\n    "));
}

}  // namespace

struct PipedSolver::Impl {
  /// The scene that the solver has, and its steps since the start.
  struct Whereabouts {
    std::string scene = {};
    long done = 0, of = 0;  // of: 0 if unknown

    /// "during 'advance' by 20 steps of 0.002 s, after 0 of 20 steps, in the scene 'falling sheet'"
    std::string during(const json& request) const {
      std::string text = fmt::format("during '{}'", request["op"].get<std::string>());
      if (request.contains("frames"))
        text += " " + steps_text(request["frames"].back(), request["scene"]["dt"]);
      if (request.contains("dt"))
        text += " " + steps_text(request.value("steps", 1L), request["dt"]);
      if (request.contains("steps"))
        text += of > 0 ? fmt::format(", after {} of {} steps,", done, of)
                       : fmt::format(", after {} steps,", done);
      return scene.empty() ? text : fmt::format("{} in the scene '{}'", text, scene);
    }
  };

  SolverCommand command;
  ChildProcess child;
  ChildProcess::Deadline last = {};  // of the current call
  Whereabouts where = {};
  long particles = 0, calls = 0;
  bool is_single = false;
  std::optional<SolverFailure> failed = {};

  explicit Impl(SolverCommand c) : command(std::move(c)), child(command.command, command.limits) {}

  ChildProcess::Deadline deadline(double times = 1) const {
    const auto seconds = std::chrono::duration<double>(command.limits.seconds * times);
    return std::min(command.limits.end,
                    std::chrono::steady_clock::now() +
                        std::chrono::duration_cast<std::chrono::steady_clock::duration>(seconds));
  }

  /// The header of the answer; each progress message renews the limit of silence.
  json receive_header() {
    while (true) {
      child.begin_answer();
      const auto until = std::min(last, deadline());
      json header = parse_header(child.read_line(longest_header, until));
      if (header.value("id", json()) != calls)
        throw SolverFailure("header", fmt::format("answered without the id {} of the call", calls));
      if (!header.contains("progress")) return header;
    }
  }

  Answer exchange(Request& request, const std::vector<WantedArray>& wanted) {
    if (child.has_unread_bytes())
      throw SolverFailure("oversized", "sent more bytes than its last answer says");
    request.header["id"] = ++calls;
    last = deadline(longest_progress);
    child.begin_answer();
    child.write(request.header.dump() + "\n", deadline());
    child.write(request.bytes, deadline());
    Answer answer{receive_header(), {}};
    if (answer.header.contains("declined")) throw NotOffered{text_of(answer.header, "declined")};
    if (answer.header.contains("error"))
      throw SolverFailure("error", "failed and said: " + text_of(answer.header, "error"));
    require_arrays(answer.header, wanted, is_single ? "f4" : "f8");
    answer.arrays = read_arrays(child, wanted, is_single, std::min(last, deadline()));
    return answer;
  }

  /// Sends a request and receives its answer, or tells what went wrong, and ends the solver.
  Answer ask(Request request, const std::vector<WantedArray>& wanted) {
    if (failed) throw *failed;
    try {
      return exchange(request, wanted);
    } catch (const SolverFailure& failure) {
      failed.emplace(told(failure, request.header));
    } catch (const TimedOut& late) {
      if (std::chrono::steady_clock::now() >= command.limits.end) throw TimeIsUp();
      failed.emplace(told(failure_of(late), request.header));
    }
    throw *failed;
  }

  SolverFailure failure_of(const TimedOut& late) const {
    const double seconds = command.limits.seconds;
    const std::string within =
        std::chrono::steady_clock::now() < last
            ? fmt::format("within {:g} s (--seconds)", seconds)
            : fmt::format("within {:g} s ({:g} times --seconds), but kept sending its progress",
                          seconds * longest_progress, longest_progress);
    if (late.bytes == 0) return {"hang", "did not answer " + within};
    return {"truncated", fmt::format("sent only {} bytes of its answer {}", late.bytes, within)};
  }

  /// The failure with its place and the last words.
  SolverFailure told(const SolverFailure& failure, const json& request) {
    const std::vector<std::string> words = child.last_words();
    if (failure.cause == "start" && request["op"] == "start")
      return {"start", fmt::format("cannot start {}: {}", command.command,
                                   words.empty() ? failure.what()
                                                 : fmt::format("{}", fmt::join(words, " ")))};
    return {failure.cause == "start" ? "exit" : failure.cause,
            fmt::format("the solver {} {}; its last words:{}", failure.what(),
                        where.during(request), words_text(words)),
            "the solver " + failure.kind};
  }

  Request request_of(const char* operation) const { return {{{"op", operation}}}; }

  json ask_to_start(int protocol) {
    Request request = request_of("start");
    request.header["protocol"] = protocol;
    return ask(std::move(request), {}).header;
  }

  /// In the latest protocol, or in that of 1 if the solver refuses it.
  json start() {
    try {
      return ask_to_start(protocol_version);
    } catch (const SolverFailure& failure) {
      if (failure.cause != "error") throw;
    } catch (const NotOffered&) {
    }
    failed.reset();
    return ask_to_start(1);
  }

  std::vector<WantedArray> state_arrays() const {
    return {{"x", {particles, 3}}, {"v", {particles, 3}}};
  }

  Snapshot ask_state(Request request, Work* counted = nullptr) {
    const Answer answer = ask(std::move(request), state_arrays());
    if (counted) *counted = work_of(answer.header);
    return {as_particles(answer.arrays[0]), as_particles(answer.arrays[1])};
  }

  Request about(const char* operation, const Snapshot& state, double time) const {
    Request request = request_of(operation);
    request.header["time"] = time;
    request.add("x", state.x);
    request.add("v", state.v);
    return request;
  }

  PerParticle3 ask_forces(Request request) {
    return as_particles(ask(std::move(request), {{"f", {particles, 3}}}).arrays[0]);
  }
};

PipedSolver::PipedSolver(SolverCommand command)
    : impl_(std::make_unique<Impl>(std::move(command))) {
  const json header = impl_->start();
  try {
    declaration_ = read_declaration(header);
  } catch (const SolverFailure& failure) {
    throw SolverFailure(failure.cause, fmt::format("the solver {} during 'start'", failure.what()));
  }
  impl_->is_single = declaration_.is_single;
}

PipedSolver::~PipedSolver() = default;
PipedSolver::PipedSolver(PipedSolver&&) noexcept = default;
PipedSolver& PipedSolver::operator=(PipedSolver&&) noexcept = default;

void PipedSolver::tune(const std::map<std::string, double>& tunables) {
  impl_->command.tunables = tunables;
}

std::vector<std::pair<std::string, std::string>> PipedSolver::prepare(const PortableScene& scene) {
  Request request = impl_->request_of("prepare");
  add_scene(scene, {impl_->command.settings, impl_->command.tunables}, request);
  impl_->where = {scene.name};
  impl_->particles = scene.x.cols();
  const json mapping = impl_->ask(std::move(request), {}).header.value("mapping", json::object());
  std::vector<std::pair<std::string, std::string>> rows;
  if (mapping.is_object())
    for (const auto& [key, value] : mapping.items())
      rows.emplace_back(key, value.is_string() ? value.get<std::string>() : value.dump());
  return rows;
}

Snapshot PipedSolver::advance(double dt, long steps, long of) {
  Request request = impl_->request_of("advance");
  request.header["dt"] = dt;
  request.header["steps"] = steps;
  impl_->where.of = of;
  Snapshot state = impl_->ask_state(std::move(request));
  impl_->where.done += steps;
  return state;
}

Snapshot PipedSolver::get_state() { return impl_->ask_state(impl_->request_of("get_state")); }

Snapshot PipedSolver::step(const std::vector<Snapshot>& past, const std::vector<double>& times,
                           double dt) {
  Request request = impl_->about("step", past.back(), times.back());
  request.header["dt"] = dt;
  if (past.size() > 1) {
    request.header["time_before"] = times.front();
    request.add("x_before", past.front().x);
    request.add("v_before", past.front().v);
  }
  return impl_->ask_state(std::move(request), &last_work_);
}

PerParticle3 PipedSolver::forces(const Snapshot& state, double time) {
  return impl_->ask_forces(impl_->about("forces", state, time));
}

PerParticle3 PipedSolver::damping(const Snapshot& state, double time) {
  return impl_->ask_forces(impl_->about("damping", state, time));
}

PerParticle3 PipedSolver::contact_forces() {
  return impl_->ask_forces(impl_->request_of("contact_forces"));
}

double PipedSolver::energy(const Snapshot& state, double time) {
  const Answer answer = impl_->ask(impl_->about("energy", state, time), {});
  return number_of(answer.header, "energy", nan);
}

std::vector<Snapshot> PipedSolver::run(const PortableScene& scene,
                                       const std::vector<long>& frames) {
  Request request = impl_->request_of("run");
  add_scene(scene, {impl_->command.settings, impl_->command.tunables}, request);
  request.header["frames"] = frames;
  impl_->where = {scene.name};
  const long n = scene.x.cols(), count = long(frames.size());
  const Answer answer =
      impl_->ask(std::move(request), {{"x", {count, n, 3}}, {"v", {count, n, 3}}});
  std::vector<Snapshot> states;
  const auto frame = [n](const std::vector<double>& all, long k) {
    return PerParticle3(Eigen::Map<const PerParticle3>(all.data() + 3 * n * k, 3, n));
  };
  for (long k = 0; k < count; ++k)
    states.push_back({frame(answer.arrays[0], k), frame(answer.arrays[1], k)});
  return states;
}

ProcessorTime PipedSolver::processor_time() const { return impl_->child.processor_time(); }

bool PipedSolver::has_failed() const { return impl_->failed.has_value(); }

bool PipedSolver::declines_unknown_operation() {
  try {
    impl_->ask(impl_->request_of("no_such_operation"), {});
  } catch (const NotOffered&) {
    return true;
  }
  return false;
}

void PipedSolver::stop() {
  impl_->ask(impl_->request_of("stop"), {});
  if (impl_->child.has_unread_bytes())
    throw SolverFailure("oversized", "the solver sent more bytes than its last answer says");
}

}  // namespace foldproof
