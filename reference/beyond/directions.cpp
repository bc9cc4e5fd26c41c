#include "reference/beyond/directions.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "reference/types.h"

namespace foldproof {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// The sheet of the elements is linear in (Y, Y second, Y fourth).
class Sheet {
 public:
  Sheet(std::span<const FlatElement> elements, double warp) : elements_(elements), warp_(warp) {
    double area = 0;
    for (const FlatElement& element : elements) {
      const double angle = element.angle - warp;
      parts_[0] += element.energy;
      parts_[1] += std::cos(2 * angle) * element.energy;
      parts_[2] += std::cos(4 * angle) * element.energy;
      area += element.area;
    }
    for (Eigen::Matrix3d& part : parts_) part /= area;
  }

  /// Of a strip at the angle from the warp.
  double strip(const Eigen::Vector3d& p, double angle) const {
    return sum(p).of_strip(warp_ + angle);
  }

  /// How much a strip along the warp narrows over how much it lengthens [1].
  double poisson(const Eigen::Vector3d& p) const {
    const double c = std::cos(warp_), s = std::sin(warp_);
    const Eigen::Vector3d along(c * c, s * s, c * s), across(s * s, c * c, -c * s);
    const Eigen::Vector3d strain = sum(p).R.inverse() * along;
    return -across.dot(strain) / along.dot(strain);
  }

  /// The least factor of an element, over the mean [1].
  double least_factor(const Eigen::Vector3d& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (const FlatElement& element : elements_)
      least = std::min(least, factor(p).at(element.angle));
    return least;
  }

  ByDirection factor(const Eigen::Vector3d& p) const { return {p[1] / p[0], p[2] / p[0], warp_}; }

 private:
  Rigidity sum(const Eigen::Vector3d& p) const {
    return {p[0] * parts_[0] + p[1] * parts_[1] + p[2] * parts_[2]};
  }

  std::span<const FlatElement> elements_;
  double warp_;
  std::array<Eigen::Matrix3d, 3> parts_{Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero(),
                                        Eigen::Matrix3d::Zero()};
};

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", std::abs(value) < 1e-12 ? 0 : value);
  return text;
}

const std::array<double, 3> angles = {0, pi / 2, pi / 4};

/// Newton's method, whose derivatives are central differences; none if it does not end, or if an
/// element would be negative.
std::optional<Eigen::Vector3d> solution(const Sheet& sheet, const StripStiffness& wanted) {
  const Eigen::Vector3d target(wanted.warp, wanted.weft, wanted.bias);
  const int count = std::isnan(wanted.bias) ? 2 : 3;
  const auto misses = [&](const Eigen::Vector3d& p) {
    Eigen::Vector3d miss = Eigen::Vector3d::Zero();
    for (int k = 0; k < count; ++k)
      miss[k] = std::log(sheet.strip(p, angles[size_t(k)]) / target[k]);
    return miss;
  };
  Eigen::Vector3d p(std::sqrt(wanted.warp * wanted.weft) / sheet.strip({1, 0, 0}, 0), 0, 0);
  for (int round = 0; round < 100; ++round) {
    const Eigen::Vector3d miss = misses(p);
    if (!miss.allFinite()) return {};
    if (miss.cwiseAbs().maxCoeff() < 1e-13) break;
    Eigen::Matrix3d slope = Eigen::Matrix3d::Identity();
    for (int k = 0; k < count; ++k) {
      const Eigen::Vector3d step = 1e-6 * p[0] * Eigen::Vector3d::Unit(k);
      slope.col(k) = (misses(p + step) - misses(p - step)) / (2e-6 * p[0]);
    }
    Eigen::Vector3d change = slope.fullPivLu().solve(miss);
    change *= std::min(1.0, 0.3 * p[0] / change.norm());
    p -= change;
    if (!(p[0] > 0)) return {};
  }
  if (!(misses(p).cwiseAbs().maxCoeff() < 1e-9) || !(sheet.least_factor(p) >= 0)) return {};
  return p;
}

/// Values within a factor of a thousand of `middle` that the mesh can have, the least and the
/// greatest of 201; "" if there are none.
template <class Wanted>
std::string range_of(const Sheet& sheet, double middle, Wanted wanted) {
  double least = none, greatest = none;
  for (int k = -100; k <= 100; ++k) {
    const double value = middle * std::pow(1000, k / 100.0);
    if (!solution(sheet, wanted(value))) continue;
    if (!(least <= value)) least = value;
    greatest = value;
  }
  return std::isnan(least) ? "" : number(least) + " to " + number(greatest);
}

/// The bias or weft that the mesh can have with the wanted warp, in words.
std::string possible(const Sheet& sheet, const StripStiffness& wanted) {
  if (const auto p = solution(sheet, {wanted.warp, wanted.weft, none})) {
    const std::string range = range_of(sheet, sheet.strip(*p, pi / 4), [&](double bias) {
      return StripStiffness{wanted.warp, wanted.weft, bias};
    });
    return "without 'bias' it has " + number(sheet.strip(*p, pi / 4)) + " there" +
           (range.empty() ? "" : ", and can have " + range);
  }
  const std::string range = range_of(sheet, wanted.warp, [&](double weft) {
    return StripStiffness{wanted.warp, weft, none};
  });
  return range.empty() ? "nor any other weft beside this warp"
                       : "along the weft it can have " + range + " beside this warp";
}

}  // namespace

std::vector<FlatTriangle> flat_corners(const TriangleMesh& mesh, const std::string& part) {
  if (!mesh.pattern.empty()) return mesh.pattern;
  RestPlane plane;
  if (!is_flat(mesh, plane))
    throw InputError(part +
                     ": the rest shape is not flat; give [cloth] pattern, which says where warp "
                     "and weft run");
  std::vector<FlatTriangle> corners;
  for (const Triangle& t : mesh.triangles) {
    FlatTriangle flat;
    for (size_t k = 0; k < 3; ++k)
      flat[k] = {plane.first.dot(mesh.rest.col(t[k])), plane.second.dot(mesh.rest.col(t[k]))};
    corners.push_back(flat);
  }
  return corners;
}

std::vector<std::array<double, 2>> angles_of_edges(const TriangleMesh& mesh) {
  const std::vector<FlatTriangle> corners = flat_corners(mesh, "warp and weft");
  const auto angle_in = [&](const Edge& edge, int t) {
    if (t < 0) return 0.0;
    const auto place = [&](int particle) {
      const Triangle& triangle = mesh.triangles[size_t(t)];
      return corners[size_t(t)][size_t(std::ranges::find(triangle, particle) - triangle.begin())];
    };
    const Eigen::Vector2d along = place(edge.b) - place(edge.a);
    return std::atan2(along.y(), along.x());
  };
  std::vector<std::array<double, 2>> angles;
  for (const Edge& edge : mesh.edges)
    angles.push_back({angle_in(edge, edge.triangles[0]), angle_in(edge, edge.triangles[1])});
  return angles;
}

double ByDirection::at(double angle) const {
  return 1 + second * std::cos(2 * (angle - warp)) + fourth * std::cos(4 * (angle - warp));
}

DirectedStiffness fit_directions(std::span<const FlatElement> elements,
                                 const StripStiffness& wanted, double warp) {
  const Sheet sheet(elements, warp);
  const std::optional<Eigen::Vector3d> p = solution(sheet, wanted);
  if (!p)
    throw InputError("this mesh cannot have " + number(wanted.warp) + " along the warp, " +
                     number(wanted.weft) + " along the weft" +
                     (std::isnan(wanted.bias) ? "" : ", " + number(wanted.bias) + " on the bias") +
                     ": an element would push where it should pull; " + possible(sheet, wanted));
  const auto at = [&](double degrees) { return number(sheet.strip(*p, degrees * pi / 180)); };
  return {(*p)[0], sheet.factor(*p),
          "strips of this mesh have " + at(0) + " along the warp, " + at(22.5) + ", " + at(45) +
              " and " + at(67.5) + " at 22.5, 45 and 67.5 degrees, " + at(90) +
              " along the weft; one along the warp narrows by " + number(sheet.poisson(*p)) +
              " of its strain, which cannot be chosen"};
}

}  // namespace foldproof
