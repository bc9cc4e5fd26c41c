#include "verification/cases/repetition.h"

#include <cmath>
#include <cstring>
#include <future>
#include <limits>

namespace foldproof {

namespace {

constexpr std::size_t steps_each = 10;

/// All numbers of a row but clock time.
std::vector<double> numbers_of(const Diagnostics& row) {
  std::vector<double> all;
  for_each_value(row, [&](auto number) { all.push_back(double(number)); });
  return all;
}

bool has_same_bits(const Diagnostics& a, const Diagnostics& b) {
  const std::vector<double> p = numbers_of(a), q = numbers_of(b);
  return std::memcmp(p.data(), q.data(), p.size() * sizeof(double)) == 0;
}

/// The rows of the next `count` steps.
std::vector<Diagnostics> rows_after(const Checkpoint& from, const Scene& scene,
                                    const LevelSetProvider& level_sets, std::size_t count) {
  std::vector<Diagnostics> rows;
  Schedule schedule = scene.schedule;
  schedule.max_steps = from.steps + long(count);
  resume(build(scene, level_sets).system, integrator_named(scene.integrator), from, schedule,
         {{}, [&](const Diagnostics& row) { rows.push_back(row); }});
  return rows;
}

}  // namespace

void Repetition::record(const Checkpoint& at) {
  const Schedule& schedule = scene_.schedule;
  const long last =
      std::lround(std::ceil((schedule.end - at.start_time) / schedule.frame_interval));
  if (at.frame == 0 || at.frame == last / 2 || at.frame == last - 1) parts_.push_back({at, {}});
}

void Repetition::record(const Diagnostics& row) {
  if (parts_.empty() || parts_.back().rows.size() == steps_each) return;
  parts_.back().rows.push_back(row);
}

double Repetition::count_differing_steps() const {
  std::size_t differing = 0, seen = 0;
  for (const Part& part : parts_) {
    const auto again = std::async(std::launch::async, [&] {
                         return rows_after(part.from, scene_, level_sets_, part.rows.size());
                       }).get();
    for (std::size_t k = 0; k < part.rows.size(); ++k)
      differing += k >= again.size() || !has_same_bits(part.rows[k], again[k]);
    seen += part.rows.size();
  }
  return seen > 0 ? double(differing) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace foldproof
