#include "reference/scene/field_accuracy.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <utility>
#include <vector>

namespace foldproof {

namespace {

constexpr int samples = 8000;
constexpr int first_cells = 16;
constexpr double band = 3;  // cells to each side

/// Points spread evenly over the area, moved along the face normals by a random fraction (-1 to 1)
/// of a distance.
class SurfaceSamples {
 public:
  explicit SurfaceSamples(const MeshDistance& mesh) : mesh_(mesh) {
    const Eigen::VectorXd areas = triangle_areas(mesh.triangles, mesh.x);
    double sum = 0;
    for (const double area : areas) until_.push_back(sum += area);
  }

  Vector3 next(double distance) {
    const double where = share() * until_.back();
    const auto at = std::ranges::lower_bound(until_, where);
    const Triangle& corners = mesh_.triangles[std::size_t(at - until_.begin())];
    const Vector3 a = mesh_.x.col(corners[0]), b = mesh_.x.col(corners[1]) - a,
                  c = mesh_.x.col(corners[2]) - a;
    double u = share(), v = share();
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    return a + u * b + v * c + (2 * share() - 1) * distance * b.cross(c).normalized();
  }

 private:
  double share() { return (double(random_()) + 0.5) / 4294967296.0; }

  const MeshDistance& mesh_;
  std::vector<double> until_;  // cumulative areas of the triangles [m^2]
  std::mt19937 random_{71993};
};

std::string in_units(const char* format, double a, double b, double c) {
  char text[200];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

}  // namespace

double field_error(const MeshDistance& exact, const Solid& field, double cell) {
  SurfaceSamples points(exact);
  double largest = 0;
  for (int k = 0; k < samples; ++k) {
    const Vector3 p = points.next(band * cell);
    update_worst(largest, std::abs(distance_to(field, p).phi - exact.at(p).phi));
  }
  return largest;
}

double field_bytes(const Solid& field) {
  if (const auto* grid = std::get_if<GridSolid>(&field))
    return double(sizeof(double)) * double(grid->grid->phi.size());
  if (const auto* octree = std::get_if<OctreeSolid>(&field)) return double(bytes(*octree->tree));
  return 0;
}

MeasuredField field_of_accuracy(const MeshDistance& exact, double longest, double accuracy,
                                const std::function<Solid(int cells)>& make, double most_bytes) {
  for (int cells = first_cells;;) {
    const Solid solid = make(cells);
    const MeasuredField field{solid, cells, field_error(exact, solid, longest / cells),
                              field_bytes(solid)};
    if (field.error <= accuracy) return field;
    const double finer = std::clamp(field.error / accuracy, 1.25, 2.0);
    // a grid grows with the third power of its cells, an octree with the second or more
    const double growth = std::pow(finer, std::holds_alternative<GridSolid>(field.solid) ? 3 : 2);
    if (!(field.bytes * growth <= most_bytes))
      throw InputError(
          in_units("an error of %.3g m cannot be had; %.0f cells have one of %.3g m, ", accuracy,
                   cells, field.error) +
          in_units("and %.0f would take more than %.0f MB; give a larger accuracy, or cells",
                   std::ceil(cells * finer), most_bytes / 1048576, 0));
    cells = int(std::ceil(cells * finer));
  }
}

std::string describe(const MeasuredField& field) {
  return in_units("%.0f cells, error %.3g m, %.3g MB", field.cells, field.error,
                  field.bytes / 1048576);
}

}  // namespace foldproof
