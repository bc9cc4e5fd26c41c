// The solver's side of the protocol (PROTOCOL.md) in C++17: derive from Solver, then call serve().
// One header; copy it. Needs nlohmann/json and POSIX.
//
//   struct Mine : foldproof_solver::Solver {
//     Mine() { declared.name = "mine"; declared.order = 1; }
//     foldproof_solver::Mapping prepare(const foldproof_solver::Scene& scene) override;
//     void advance(double dt, long steps) override;  // moves x and v, N x 3 numbers each
//   };
//   int main() { Mine mine; return foldproof_solver::serve(mine); }
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

namespace foldproof_solver {

using Json = nlohmann::json;
using Numbers = std::vector<double>;  // N x 3: x, y, z of particle 0, then of particle 1 ...
using Mapping = std::map<std::string, std::string>;

/// Thrown for anything the solver does not offer; the reason is printed in the report.
struct Declined : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The declaration, the answer to `start`.
struct Declared {
  std::string name = "unnamed", version = "0", level = "L1", precision = "f8", scheme = "unnamed";
  int order = 0;
  std::vector<std::string> capabilities;
  double solve_tolerance = 0;
  Json tunables = Json::object();  // as in PROTOCOL.md
  Json more = Json::object();      // further fields, as {{"contact_offset", 0.001}}
};

/// A scene: arrays by name (PROTOCOL.md lists them), and the header's object `scene`.
struct Scene {
  Json header;
  std::map<std::string, Numbers> numbers;
  std::map<std::string, std::vector<std::int32_t>> integers;

  /// Where the held particles are at a time [s]: H x 3 [m]; those that stay, too.
  Numbers held_at(double time) const;

  /// Where an obstacle is at a time [s]: its point X is at R X + T.
  struct Pose {
    double rotation[3][3], translation[3];  // R; T [m]
  };
  Pose pose_at(const Json& obstacle, double time) const;
};

/// An adapter overrides these. x [m] and v [m/s] are N x 3; forces [N] too; energy in J.
struct Solver {
  Declared declared;
  Numbers x, v;
  double time = 0;  // s

  virtual ~Solver() = default;

  /// The value of a tunable in a scene.
  double tuned(const Scene& scene, const char* name) const {
    const Json set = scene.header["scene"].value("tunables", Json::object());
    return set.contains(name) ? set[name] : declared.tunables[name]["value"];
  }

  virtual Mapping prepare(const Scene&) { throw Declined("scenes"); }
  virtual void advance(double, long) { throw Declined("steps"); }
  virtual void set_state(Numbers new_x, Numbers new_v, double new_time) {
    x = std::move(new_x), v = std::move(new_v), time = new_time;
  }
  /// The state before the latest, for schemes that look back; only with capability "history".
  virtual void set_state_before(Numbers, Numbers, double) {}
  virtual Numbers forces() { throw Declined("forces"); }
  virtual Numbers damping() { throw Declined("damping forces"); }
  /// Of the obstacles, the mean over the last `advance`.
  virtual Numbers contact_forces() { throw Declined("contact forces"); }
  virtual double energy() { throw Declined("energy"); }
  /// Work since the last answer, counted in units of your own; null: not counted.
  virtual Json work() { return nullptr; }

  /// To be called after each step of a long `advance`, with the part that is done, 0 to 1: says at
  /// most once a second that the solver is at work, so that it is not taken to hang.
  void progress(double part) const {
    if (tell) tell(part);
  }
  std::function<void(double)> tell;  // set by serve()
};

namespace detail {

/// The interval that holds a time, and the part of it that has passed; at rest outside.
inline std::pair<std::size_t, double> between(const Numbers& times, double time) {
  std::size_t k = 0;
  while (k + 2 < times.size() && times[k + 1] <= time) ++k;
  if (times.size() < 2) return {0, 0};
  const double part = (time - times[k]) / (times[k + 1] - times[k]);
  return {k, std::min(std::max(part, 0.0), 1.0)};
}

/// Rows k and the next one, so mixed; the last row alone where there is no other.
inline Numbers mixed(const Numbers& rows, std::size_t wide, std::pair<std::size_t, double> at) {
  Numbers row(rows.begin() + long(at.first * wide), rows.begin() + long((at.first + 1) * wide));
  if ((at.first + 2) * wide > rows.size()) return row;
  for (std::size_t i = 0; i < wide; ++i)
    row[i] += at.second * (rows[(at.first + 1) * wide + i] - row[i]);
  return row;
}

/// The quaternion (w, x, y, z) between two others, at a constant rate, the short way.
inline void turn(const double* one, const double* other, double part, double* q) {
  double cosine = 0;
  for (int i = 0; i < 4; ++i) cosine += one[i] * other[i];
  const double sign = cosine < 0 ? -1 : 1, angle = std::acos(std::min(sign * cosine, 1.0));
  const double a = angle < 1e-9 ? 1 : std::sin((1 - part) * angle) / std::sin(angle),
               b = angle < 1e-9 ? 0 : sign * std::sin(part * angle) / std::sin(angle);
  for (int i = 0; i < 4; ++i) q[i] = a * one[i] + b * other[i];
}

inline int descriptor(const char* name) {
  const char* text = std::getenv(name);
  if (!text)
    throw std::runtime_error(std::string(name) + " is not set: foldproof starts this program");
  return std::atoi(text);
}

/// Reads that many bytes; false at the end of the pipe.
inline bool read_all(int from, void* to, std::size_t bytes) {
  for (char* at = static_cast<char*>(to); bytes > 0;) {
    const ssize_t got = ::read(from, at, bytes);
    if (got <= 0) return false;
    at += got, bytes -= std::size_t(got);
  }
  return true;
}

inline void write_all(int to, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t sent = ::write(to, text.data() + done, text.size() - done);
    if (sent <= 0) std::exit(1);
    done += std::size_t(sent);
  }
}

inline bool read_header(int from, std::string& line) {
  line.clear();
  for (char c; read_all(from, &c, 1);) {
    if (c == '\n') return true;
    line += c;
  }
  return false;
}

template <class Number>
std::vector<Number> read_array(int from, std::size_t count) {
  std::vector<Number> numbers(count);
  if (!read_all(from, numbers.data(), count * sizeof(Number))) std::exit(1);
  return numbers;
}

inline void read_arrays(int from, Scene& message) {
  if (!message.header.contains("arrays")) return;
  for (const Json& entry : message.header["arrays"]) {
    std::size_t count = 1;
    for (const Json& extent : entry["shape"]) count *= extent.get<std::size_t>();
    const std::string name = entry["name"];
    if (entry["type"] == "i4")
      message.integers[name] = read_array<std::int32_t>(from, count);
    else
      message.numbers[name] = read_array<double>(from, count);
  }
}

/// An answer in the making.
struct Answer {
  Json header = Json::object();
  std::string bytes;

  void add(const char* name, const Numbers& values, const std::string& precision,
           std::vector<std::size_t> shape) {
    header["arrays"].push_back({{"name", name}, {"type", precision}, {"shape", shape}});
    if (precision == "f8") {
      bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
      return;
    }
    const std::vector<float> single(values.begin(), values.end());
    bytes.append(reinterpret_cast<const char*>(single.data()), single.size() * sizeof(float));
  }
};

inline void add_state(const Solver& solver, Answer& answer) {
  answer.add("x", solver.x, solver.declared.precision, {solver.x.size() / 3, 3});
  answer.add("v", solver.v, solver.declared.precision, {solver.v.size() / 3, 3});
}

inline void declare(const Declared& d, Answer& answer) {
  answer.header = {{"protocol", 2},
                   {"name", d.name},
                   {"version", d.version},
                   {"level", d.level},
                   {"precision", d.precision},
                   {"scheme", {{"name", d.scheme}, {"order", d.order}}},
                   {"capabilities", d.capabilities},
                   {"solve_tolerance", d.solve_tolerance},
                   {"tunables", d.tunables}};
  answer.header.update(d.more);
}

inline void run(Solver& solver, const Scene& message, Answer& answer) {
  solver.prepare(message);
  Numbers all_x, all_v;
  long done = 0;
  for (const Json& frame : message.header["frames"]) {
    solver.advance(message.header["scene"]["dt"], frame.get<long>() - done);
    done = frame.get<long>();
    all_x.insert(all_x.end(), solver.x.begin(), solver.x.end());
    all_v.insert(all_v.end(), solver.v.begin(), solver.v.end());
  }
  const std::size_t frames = message.header["frames"].size(), particles = solver.x.size() / 3;
  answer.add("x", all_x, solver.declared.precision, {frames, particles, 3});
  answer.add("v", all_v, solver.declared.precision, {frames, particles, 3});
}

inline void take_state(Solver& solver, const Scene& message) {
  if (!message.numbers.count("x")) return;
  const double time = message.header.value("time", 0.0);
  solver.set_state(message.numbers.at("x"), message.numbers.at("v"), time);
  if (message.numbers.count("x_before"))
    solver.set_state_before(message.numbers.at("x_before"), message.numbers.at("v_before"),
                            message.header["time_before"]);
}

/// Operations that ask about the state.
inline void ask(Solver& solver, const Scene& message, const std::string& operation,
                Answer& answer) {
  take_state(solver, message);
  const std::size_t particles = solver.x.size() / 3;
  if (operation == "step") {
    solver.advance(message.header["dt"], 1);
    add_state(solver, answer);
    const Json work = solver.work();
    if (!work.is_null()) answer.header["work"] = work;
  } else if (operation == "forces") {
    answer.add("f", solver.forces(), solver.declared.precision, {particles, 3});
  } else if (operation == "damping") {
    answer.add("f", solver.damping(), solver.declared.precision, {particles, 3});
  } else if (operation == "contact_forces") {
    answer.add("f", solver.contact_forces(), solver.declared.precision, {particles, 3});
  } else if (operation == "energy") {
    answer.header["energy"] = solver.energy();
  } else {
    throw Declined("operation '" + operation + "'");
  }
}

inline void perform(Solver& solver, const Scene& message, Answer& answer) {
  const std::string operation = message.header["op"];
  if (operation == "start") {
    declare(solver.declared, answer);
  } else if (operation == "prepare") {
    answer.header["mapping"] = solver.prepare(message);
  } else if (operation == "run") {
    run(solver, message, answer);
  } else if (operation == "advance") {
    solver.advance(message.header["dt"], message.header["steps"]);
    add_state(solver, answer);
  } else if (operation == "get_state") {
    add_state(solver, answer);
  } else if (operation != "stop") {
    ask(solver, message, operation, answer);
  }
}

/// Sends progress on a call, at most once a second.
inline std::function<void(double)> teller(int out, const Json& id) {
  using Clock = std::chrono::steady_clock;
  return [out, id, told = Clock::now()](double part) mutable {
    if (Clock::now() - told < std::chrono::seconds(1)) return;
    told = Clock::now();
    write_all(out,
              Json({{"id", id}, {"progress", std::min(std::max(part, 0.0), 1.0)}}).dump() + "\n");
  };
}

}  // namespace detail

inline Numbers Scene::held_at(double time) const {
  const std::vector<std::int32_t>& held = integers.at("held");
  if (numbers.count("held_times"))
    return detail::mixed(numbers.at("held_x"), 3 * held.size(),
                         detail::between(numbers.at("held_times"), time));
  Numbers still;
  for (const std::int32_t i : held)
    for (int c = 0; c < 3; ++c) still.push_back(numbers.at("x")[std::size_t(3 * i + c)]);
  return still;
}

inline Scene::Pose Scene::pose_at(const Json& obstacle, double time) const {
  Pose pose{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};
  if (!obstacle.contains("motion")) return pose;
  const std::string name = "motion_" + std::to_string(obstacle["motion"].get<int>());
  const Numbers& poses = numbers.at(name + "_poses");
  const auto at = detail::between(numbers.at(name + "_times"), time);
  const Numbers row = detail::mixed(poses, 7, at);
  std::copy(row.begin(), row.begin() + 3, pose.translation);
  const double* const one = &poses[7 * at.first + 3];
  double q[4];
  detail::turn(one, 7 * (at.first + 2) > poses.size() ? one : one + 7, at.second, q);
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  const double rotation[3][3] = {
      {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
      {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
      {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
  std::memcpy(pose.rotation, rotation, sizeof rotation);
  return pose;
}

/// Answers until `stop` or the end of the pipe; returns the exit code.
inline int serve(Solver& solver) {
  const int in = detail::descriptor("FOLDPROOF_IN"), out = detail::descriptor("FOLDPROOF_OUT");
  for (std::string line; detail::read_header(in, line);) {
    Scene message{Json::parse(line), {}, {}};
    detail::read_arrays(in, message);
    detail::Answer answer;
    solver.tell = detail::teller(out, message.header["id"]);
    try {
      detail::perform(solver, message, answer);
    } catch (const Declined& reason) {
      answer = {{{"declined", reason.what()}}, ""};
    } catch (const std::exception& error) {
      answer = {{{"error", error.what()}}, ""};
    }
    answer.header["id"] = message.header["id"];
    detail::write_all(out, answer.header.dump() + "\n" + answer.bytes);
    if (message.header["op"] == "stop") break;
  }
  return 0;
}

}  // namespace foldproof_solver
