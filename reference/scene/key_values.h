// Values that several tables of a case file share, read and checked.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <utility>
#include <vector>

#include "reference/motion/motion.h"
#include "reference/scene/key_file.h"

namespace foldproof {

constexpr double radians_per_degree = pi / 180;

// Each throws InputError "file:line: ..." for a value out of its range.
double positive(const KeyTable& keys, const std::string& key);
double positive_or(const KeyTable& keys, const std::string& key, double fallback);
double non_negative_or(const KeyTable& keys, const std::string& key, double fallback);
long count_or(const KeyTable& keys, const std::string& key, long fallback);  // 1 .. 1,000,000,000

/// The value of the choice named by the key; the first is the default.
template <class Choice>
Choice choice(const KeyTable& keys, const std::string& key,
              std::vector<std::pair<std::string, Choice>> choices) {
  const std::string wanted = keys.text_or(key, choices.front().first);
  std::string known;
  for (const auto& [name, value] : choices) {
    if (name == wanted) return value;
    known += (known.empty() ? "" : ", ") + name;
  }
  throw InputError(keys.where(key) + ": unknown " + key + " '" + wanted + "'; known: " + known);
}

/// Returns make(); adds this place to an InputError that names none.
template <class Make>
auto with_error_location(const std::string& where, const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    const std::string message = error.what(), file = where.substr(0, where.find(':'));
    if (message.starts_with(file) || message.starts_with("--set")) throw;
    throw InputError(where + ": " + message);
  }
}

/// The closed-form motion of [[hold]] and [[object]]: velocity, amplitude, frequency, phase,
/// center, angular_velocity, from, until. At rest if none is given.
Motion read_motion(const KeyTable& keys);

/// turn = { axis, angle }, in degrees; no rotation if there is none.
Eigen::AngleAxisd read_turn(const KeyTable& keys);

/// The file or folder that the key names. In a case file it is relative to the file's folder and
/// may not leave it by an absolute path, by "..", or by a link. A value given by --set is used as
/// typed, relative to the working folder.
std::string path_of(const KeyTable& keys, const std::string& key, const std::string& folder);

/// Throws InputError, naming `where`, if the file does not lie in the folder or one below it,
/// links followed.
void reject_outside(const std::string& file, const std::string& folder, const std::string& where);

}  // namespace foldproof
