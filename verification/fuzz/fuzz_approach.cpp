// Do two moving features meet? The reference's answer against the exact judge's: a meeting that is
// not told is a finding, and so are a time too late or outside the motion, a number that is none,
// and features that come nearer than promised.
//
// An input is a byte of kind, one of scale, one of what is to be kept, and 24 whole numbers of one
// byte or of two.
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "reference/filters/approach.h"
#include "verification/fuzz/finding.h"
#include "verification/oracles/exact_crossing_times.h"

namespace foldproof {

namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();

struct Query {
  PairKind kind;
  Corners4 x, displacement;  // m
  double keep;               // m
};

/// Coordinates up to 128 or 32768 units of 2^-10 to 2^10 m, near the origin or up to 2^20
/// units away from it.
bool read_query(const std::uint8_t* data, std::size_t size, Query& query) {
  const std::size_t bytes = size >= 51 ? 2 : 1;
  if (size < 3 + 24 * bytes) return false;
  const double unit = std::ldexp(1.0, int(data[1] % 21) - 10), far = data[1] >= 128 ? 0x1p20 : 0;
  std::array<double, 24> numbers;
  for (std::size_t k = 0; k < 24; ++k) {
    const std::uint8_t* at = data + 3 + k * bytes;
    const int value = bytes == 1 ? std::int8_t(at[0]) : std::int16_t(at[0] | at[1] << 8);
    numbers[k] = unit * (value + (k < 12 ? far : 0));
  }
  query.kind = data[0] % 2 == 0 ? PairKind::vertex_triangle : PairKind::edge_edge;
  query.x = Eigen::Map<const Corners4>(numbers.data());
  query.displacement = Eigen::Map<const Corners4>(numbers.data() + 12);
  query.keep = unit * std::ldexp(1.0, int(data[2] % 32) - 24);
  return true;
}

void require_valid_approach(const Query& query, const Approach& approach, double noise) {
  require(approach.time >= 0 && approach.time <= 1,
          "an approach is told at a time within the motion");
  require(std::isfinite(approach.at.distance) && approach.at.distance >= 0,
          "its distance is a number");
  require(approach.at.weights.allFinite() && approach.at.normal.allFinite(),
          "its place is a place");
  const Corners4 then = query.x + approach.time * query.displacement;
  require(std::abs((then * approach.at.weights).norm() - approach.at.distance) <= noise,
          "its weights lead over its distance");
}

/// Of features that are told not to come together: at some times, that they have not.
void require_apart(const Query& query, double kept, double noise) {
  for (const double t : {0.0, 0.25, 0.5, 0.8125, 1.0})
    require(nearness(query.kind, query.x + t * query.displacement).distance >= kept - noise,
            "features of which nothing is told stay farther apart than what is kept");
}

/// Does the first feature stay beyond the second all the time, seen along one of 26 directions?
/// Sums of three whole numbers of the unit have no rounding, so that such features need not be
/// shown to the exact judge.
bool stay_beyond(const Query& query) {
  const int first = query.kind == PairKind::vertex_triangle ? 1 : 2;
  const Corners4 end = query.x + query.displacement;
  for (int direction = 0; direction < 27; ++direction) {
    const Vector3 N(direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1);
    const Eigen::RowVector4d at_start = N.transpose() * query.x, at_end = N.transpose() * end;
    const Eigen::RowVector4d low = at_start.cwiseMin(at_end), high = at_start.cwiseMax(at_end);
    if (low.head(first).minCoeff() > high.tail(4 - first).maxCoeff()) return true;
  }
  return false;
}

/// Until so much of the motion is over.
bool truly_meet(const Query& query, double until) {
  const auto features = query.kind == PairKind::vertex_triangle
                            ? oracles::Features::vertex_and_triangle
                            : oracles::Features::edge_and_edge;
  return oracles::ever_meet(
      features, oracles::until(oracles::exact_motion(query.x, query.displacement), until));
}

}  // namespace
}  // namespace foldproof

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace foldproof;
  Query query;
  if (!read_query(data, size, query)) return -1;
  const auto approach = first_approach(query.kind, query.x, query.displacement, query.keep);
  // rounding of coordinates in the sums of a few products that lead from them to a distance
  const double noise =
      64 * rounding * (query.x.cwiseAbs().maxCoeff() + query.displacement.cwiseAbs().maxCoeff());
  if (approach) require_valid_approach(query, *approach, noise);
  const double distance = nearness(query.kind, query.x).distance;
  // as near to `keep` as rounding, seen from here and from there, less is promised
  const double kept = distance > query.keep + noise ? query.keep : distance / 2;
  if (kept <= noise) return 0;  // not beyond rounding: nothing is promised
  if (!approach) require_apart(query, kept, noise);
  if (!approach && !stay_beyond(query)) require(!truly_meet(query, 1), "no meeting is missed");
  if (approach && approach->time > 0)
    require(!truly_meet(query, std::nextafter(approach->time, 0)), "no meeting is told too late");
  return 0;
}
