// Builds a strain limiter: sorts its springs, and colours them if the order is coloured.
#include <algorithm>
#include <string>
#include <tuple>

#include "reference/filters/strain_limit.h"

namespace foldproof {

namespace {

[[noreturn]] void reject(const std::string& why) { throw InputError("strain limits: " + why); }

void check(const StrainRange& range) {
  if (!(range.extension >= 0)) reject("extension must be a number >= 0");
  if (!(range.compression >= 0 && range.compression < 1)) reject("compression must lie in [0, 1)");
}

void check(const StrainLimits& limits) {
  check(static_cast<const StrainRange&>(limits));
  if (!(limits.tolerance > 0)) reject("tolerance must be > 0");
  if (limits.sweeps < 1) reject("at least one sweep is needed");
}

/// The place of the range in the list, to which it is added if it is new.
int place_of(const StrainRange& range, std::vector<StrainRange>& ranges) {
  const auto found = std::ranges::find(ranges, range);
  if (found != ranges.end()) return int(found - ranges.begin());
  check(range);
  ranges.push_back(range);
  return int(ranges.size()) - 1;
}

/// For each spring, the first colour that no earlier spring has at either end.
std::vector<int> colours_of(const std::vector<LimitedSpring>& springs, Eigen::Index particles) {
  std::vector<std::vector<bool>> taken;  // by particle and colour
  taken.resize(size_t(particles));
  std::vector<int> colours;
  for (const LimitedSpring& spring : springs) {
    auto &at_a = taken[size_t(spring.a)], &at_b = taken[size_t(spring.b)];
    size_t colour = 0;
    while ((colour < at_a.size() && at_a[colour]) || (colour < at_b.size() && at_b[colour]))
      ++colour;
    for (auto* at : {&at_a, &at_b}) {
      if (at->size() <= colour) at->resize(colour + 1, false);
      (*at)[colour] = true;
    }
    colours.push_back(int(colour));
  }
  return colours;
}

/// Sorts the springs by colour, keeps their order within each, and returns where each begins.
void group_by_colour(StrainLimiter& limiter) {
  const std::vector<int> colour_of = colours_of(limiter.springs, limiter.inverse_mass.size());
  const int count =
      colour_of.empty() ? 0 : 1 + *std::max_element(colour_of.begin(), colour_of.end());
  std::vector<LimitedSpring> grouped;
  limiter.colours = {0};
  for (int colour = 0; colour < count; ++colour) {
    for (size_t i = 0; i < limiter.springs.size(); ++i)
      if (colour_of[i] == colour) grouped.push_back(limiter.springs[i]);
    limiter.colours.push_back(int(grouped.size()));
  }
  limiter.springs = std::move(grouped);
}

}  // namespace

StrainLimiter make_strain_limiter(const StrainLimits& limits, std::span<const Spring> springs,
                                  const PerParticle& inverse_mass,
                                  std::span<const StrainRange> ranges) {
  check(limits);
  StrainLimiter limiter{limits, {limits}, {}, {}, inverse_mass};
  for (size_t i = 0; i < springs.size(); ++i)
    limiter.springs.push_back({springs[i].a, springs[i].b, springs[i].rest_length,
                               ranges.empty() ? 0 : place_of(ranges[i], limiter.ranges)});
  const auto places = [](const LimitedSpring& s) { return std::tuple(s.a, s.b); };
  std::stable_sort(limiter.springs.begin(), limiter.springs.end(),
                   [&](const auto& one, const auto& other) { return places(one) < places(other); });
  if (limits.order == SweepOrder::coloured)
    group_by_colour(limiter);
  else
    limiter.colours = {0, int(limiter.springs.size())};
  return limiter;
}

}  // namespace foldproof
