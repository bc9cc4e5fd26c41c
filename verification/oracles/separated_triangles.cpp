#include "verification/oracles/separated_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace foldproof::oracles {

namespace {

/// Do the two lie on different sides of a plane across d?
bool parted_along(const Vector3& d, const Corners3& s, const Corners3& t) {
  const auto [s_least, s_most] = std::minmax({d.dot(s[0]), d.dot(s[1]), d.dot(s[2])});
  const auto [t_least, t_most] = std::minmax({d.dot(t[0]), d.dot(t[1]), d.dot(t[2])});
  return s_most < t_least || t_most < s_least;
}

}  // namespace

Vector3 normal_of(const Corners3& t) { return (t[1] - t[0]).cross(t[2] - t[0]); }

bool are_separated(const Corners3& s, const Corners3& t) {
  const Vector3 m = normal_of(s), n = normal_of(t);
  bool is_separated = parted_along(m, s, t) || parted_along(n, s, t);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3 edge = s[(i + 1) % 3] - s[i], other = t[(i + 1) % 3] - t[i];
    is_separated |= parted_along(m.cross(edge), s, t) || parted_along(n.cross(other), s, t);
    for (std::size_t j = 0; j < 3; ++j)
      is_separated |= parted_along(edge.cross(t[(j + 1) % 3] - t[j]), s, t);
  }
  return is_separated;
}

}  // namespace foldproof::oracles
