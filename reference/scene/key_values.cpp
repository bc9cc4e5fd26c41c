#include "reference/scene/key_values.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>

#include "reference/scene/scene_limits.h"

namespace foldproof {

double positive(const KeyTable& keys, const std::string& key) {
  const double value = keys.number(key);
  if (!(value > 0)) throw InputError(keys.where(key) + ": '" + key + "' must be > 0");
  return value;
}

double positive_or(const KeyTable& keys, const std::string& key, double fallback) {
  return keys.has(key) ? positive(keys, key) : fallback;
}

double non_negative_or(const KeyTable& keys, const std::string& key, double fallback) {
  const double value = keys.number_or(key, fallback);
  if (!(value >= 0)) throw InputError(keys.where(key) + ": '" + key + "' must not be negative");
  return value;
}

long count_or(const KeyTable& keys, const std::string& key, long fallback) {
  const long value = keys.integer_or(key, fallback);
  if (!(value >= 1 && value <= 1'000'000'000))
    throw InputError(keys.where(key) + ": '" + key + "' must lie in 1 .. 1,000,000,000");
  return value;
}

void reject_many_triangles(const KeyTable& keys, const std::string& key, double triangles,
                           const SceneLimits& limits) {
  if (triangles <= limits.triangles) return;
  char message[100];
  std::snprintf(message, sizeof message, " asks for %.4g triangles; %.4g at most are made",
                triangles, limits.triangles);
  throw InputError(keys.where(key) + ": '" + key + "'" + message);
}

Motion read_motion(const KeyTable& keys) {
  Motion motion;
  motion.velocity = keys.vector_or("velocity", Vector3::Zero());
  motion.amplitude = keys.vector_or("amplitude", Vector3::Zero());
  motion.frequency = keys.number_or("frequency", 0);
  motion.phase = keys.number_or("phase", 0) * radians_per_degree;
  motion.center = keys.vector_or("center", Vector3::Zero());
  motion.angular_velocity =
      keys.vector_or("angular_velocity", Vector3::Zero()) * radians_per_degree;
  motion.from = keys.number_or("from", 0);
  motion.until = keys.number_or("until", motion.until);
  if (!(motion.from >= 0)) throw InputError(keys.where("from") + ": 'from' must be a time >= 0 s");
  if (!(motion.until > motion.from))
    throw InputError(keys.where("until") + ": 'until' must be later than 'from', in s");
  return motion;
}

Eigen::AngleAxisd read_turn(const KeyTable& keys) {
  const auto turn = keys.table("turn");
  if (!turn) return Eigen::AngleAxisd::Identity();
  const Vector3 axis = turn->vector("axis");
  if (!(axis.norm() > 0)) throw InputError(turn->where("axis") + ": 'axis' must not be zero");
  return {turn->number("angle") * radians_per_degree, axis.normalized()};
}

void reject_outside(const std::string& file, const std::string& folder, const std::string& where) {
  namespace fs = std::filesystem;
  const fs::path inner = fs::weakly_canonical(fs::absolute(file));
  const fs::path outer = fs::weakly_canonical(fs::absolute(folder.empty() ? "." : folder));
  const auto [end, _] = std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end());
  if (end == outer.end() || (std::next(end) == outer.end() && end->empty())) return;
  throw InputError(where + ": '" + file +
                   "' lies outside the case file's folder; put it there, or name it by --set");
}

std::string path_of(const KeyTable& keys, const std::string& key, const std::string& folder) {
  const std::string where = keys.where(key);
  const std::filesystem::path named = keys.text(key);
  if (is_override(where) || named.empty()) return named.string();
  const std::string file = (folder / named).string();
  if (named.is_absolute() || std::ranges::find(named, "..") != named.end())
    throw InputError(where + ": '" + named.string() +
                     "' leaves the case file's folder; put the file there, or name it by --set");
  reject_outside(file, folder, where);
  return file;
}

}  // namespace foldproof
