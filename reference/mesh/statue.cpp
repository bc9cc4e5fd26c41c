#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "reference/mesh/shapes.h"

namespace foldproof {
namespace {

// --- the statue: an implicit surface d(p) = 0 one metre high, d about the distance,
// negative inside ---

/// An ellipsoid (semi-axes `radii` [m]) swept from one place to another.
struct Limb {
  Vector3 from, to, radii;
};

std::vector<Limb> seated_figure() {
  std::vector<Limb> limbs = {
      {{0, 0.06, 0.00}, {0, 0.06, 0.00}, {0.35, 0.15, 0.25}},        // seat
      {{0, 0.08, 0.19}, {0, 0.08, 0.19}, {0.24, 0.09, 0.10}},        // crossed shins
      {{0, 0.20, -0.03}, {0, 0.20, -0.03}, {0.26, 0.12, 0.16}},      // hips
      {{0, 0.27, 0.00}, {0, 0.27, 0.00}, {0.17, 0.15, 0.14}},        // belly
      {{0, 0.45, -0.02}, {0, 0.45, -0.02}, {0.17, 0.17, 0.11}},      // chest
      {{0, 0.60, -0.01}, {0, 0.68, 0.00}, {0.06, 0.06, 0.06}},       // neck
      {{0, 0.765, 0.02}, {0, 0.765, 0.02}, {0.092, 0.12, 0.105}},    // head
      {{0, 0.905, -0.01}, {0, 0.905, -0.01}, {0.05, 0.047, 0.05}},   // knot of hair
      {{0, 0.78, 0.115}, {0, 0.745, 0.123}, {0.011, 0.012, 0.012}},  // nose
      {{0, 0.205, 0.17}, {0, 0.205, 0.17}, {0.10, 0.035, 0.06}},     // hands
  };
  const std::vector<Limb> left = {
      {{0.16, 0.11, 0.04}, {0.33, 0.07, 0.13}, {0.10, 0.095, 0.10}},      // thigh and knee
      {{0.17, 0.55, -0.02}, {0.25, 0.34, -0.01}, {0.062, 0.062, 0.062}},  // upper arm
      {{0.25, 0.30, 0.00}, {0.10, 0.20, 0.16}, {0.055, 0.075, 0.055}},    // forearm and sleeve
      {{0.095, 0.79, 0.01}, {0.10, 0.71, 0.01}, {0.018, 0.02, 0.028}},    // ear
  };
  const Vector3 mirror(-1, 1, 1);
  for (const Limb& limb : left) {
    limbs.push_back(limb);
    limbs.push_back({limb.from.cwiseProduct(mirror), limb.to.cwiseProduct(mirror), limb.radii});
  }
  return limbs;
}

/// Exactly 0 on the limb's surface, accurate to first order next to it [m].
double limb_distance(const Limb& limb, const Vector3& p) {
  const Vector3 axis = limb.to - limb.from;
  const double along = (p - limb.from).dot(axis) / std::max(axis.squaredNorm(), 1e-12);
  const Vector3 offset = p - limb.from - std::clamp(along, 0.0, 1.0) * axis;
  const Vector3 scaled = offset.cwiseQuotient(limb.radii);
  const double slope = scaled.cwiseQuotient(limb.radii).norm();  // 1/m
  return scaled.norm() * (scaled.norm() - 1) / std::max(slope, 1e-12);
}

/// 1 at s = 0, flat there, and near 0 beyond |s| = 1.5.
double window(double s) { return std::exp(-(s * s) * (s * s)); }

/// Height of the robe's folds [m]: slanting over the chest, upright round the legs.
double folds(const Vector3& p) {
  const double slant = p.y() / 0.085 + 3 * p.x() + 12 * p.x() * p.x();  // counts folds
  const double chest = window((p.y() - 0.40) / 0.13) * std::sin(2 * pi * slant);
  const double legs = window((p.y() - 0.09) / 0.06) * std::sin(14 * std::atan2(p.x(), p.z() + 0.1));
  return 0.005 * chest + 0.004 * legs;
}

/// The limbs in a smooth union, with folds, cut off smoothly by the floor y = 0 [m].
double figure_distance(const std::vector<Limb>& limbs, const Vector3& p) {
  const double blend = 0.018, rim = 0.02;  // m
  double sum = 0;
  for (const Limb& limb : limbs) sum += std::exp(-limb_distance(limb, p) / blend);
  const double body = -blend * std::log(sum) - folds(p);
  const double overlap = std::max(rim - std::abs(body + p.y()), 0.0);
  return std::max(body, -p.y()) + overlap * overlap / (4 * rim);
}

struct LocalDistance {
  double distance;   // m
  Vector3 gradient;  // 1

  /// The way to the surface [m], to first order.
  Vector3 to_surface() const { return -distance / gradient.squaredNorm() * gradient; }
};

/// From the four corners of a small tetrahedron, with an error of second order in its size.
LocalDistance local_distance(const std::vector<Limb>& limbs, const Vector3& p) {
  const double size = 1e-5;  // m
  LocalDistance local{0, Vector3::Zero()};
  for (const Vector3& corner :
       {Vector3(1, 1, 1), Vector3(1, -1, -1), Vector3(-1, 1, -1), Vector3(-1, -1, 1)}) {
    const double d = figure_distance(limbs, p + size * corner);
    local.distance += d / 4;
    local.gradient += d / (4 * size) * corner;
  }
  return local;
}

/// A ray from the figure's inner axis for every point of the unit sphere. From the lower pole to
/// the upper, origins climb the axis and rays turn from straight down to straight up. So no two
/// rays cross, and each leaves the figure once.
struct RayKnot {
  double height;     // on the unit sphere, from 0 to 1
  double origin;     // y on the axis [m]
  double elevation;  // degrees
};

Vector3 ray_direction(const Vector3& unit, double elevation) {
  const double angle = elevation * pi / 180,
               radius = std::max(std::hypot(unit.x(), unit.z()), 1e-12);
  const double outward = std::cos(angle) / radius;
  return Vector3(outward * unit.x(), std::sin(angle), outward * unit.z());
}

/// Where the ray that belongs to a point of the unit sphere leaves the figure.
Vector3 project_to_surface(const std::vector<Limb>& limbs, const Vector3& unit) {
  const std::array<RayKnot, 9> knots = {{{0, 0.08, -90},
                                         {0.22, 0.08, -15},
                                         {0.30, 0.09, 0},
                                         {0.42, 0.12, 25},
                                         {0.47, 0.20, 30},
                                         {0.70, 0.50, 40},
                                         {0.80, 0.66, 40},
                                         {0.92, 0.78, 50},
                                         {1, 0.88, 90}}};
  const double height = (1 + unit.y()) / 2;
  size_t k = 1;
  while (k + 1 < knots.size() && height > knots[k].height) ++k;
  const RayKnot &below = knots[k - 1], &above = knots[k];
  const double share = (height - below.height) / (above.height - below.height);
  const Vector3 origin(0, std::lerp(below.origin, above.origin, share), 0);
  const Vector3 direction = ray_direction(unit, std::lerp(below.elevation, above.elevation, share));

  double inside = 0.7;  // m
  const double step = 0.004;
  while (inside > 0 && !(figure_distance(limbs, origin + inside * direction) < 0)) inside -= step;
  double outside = inside + step;
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = 0.5 * (inside + outside);
    (figure_distance(limbs, origin + middle * direction) < 0 ? inside : outside) = middle;
  }
  return origin + inside * direction;
}

double cotangent(const Vector3& side1, const Vector3& side2) {
  return side1.dot(side2) / side1.cross(side2).norm();
}

bool has_edge(const TriangleMesh& mesh, int a, int b) {
  const std::pair<int, int> wanted = std::minmax({a, b});
  const auto before = [](const Edge& edge, const std::pair<int, int>& ab) {
    return std::pair{edge.a, edge.b} < ab;
  };
  const std::vector<Edge>::const_iterator edge =
      std::lower_bound(mesh.edges.begin(), mesh.edges.end(), wanted, before);
  return edge != mesh.edges.end() && std::pair{edge->a, edge->b} == wanted;
}

/// Flips edges whose two opposite angles add up to more than pi, as Delaunay does; at most one per
/// vertex.
void flip_edges(TriangleMesh& mesh) {
  std::vector<Triangle> triangles = mesh.triangles;
  std::vector<char> touched(mesh.particles(), 0);
  for (const Hinge& hinge : mesh.hinges) {
    const auto [v1, v2, v3, v4] = hinge.particles;
    if (touched[v1] || touched[v2] || touched[v3] || touched[v4] || has_edge(mesh, v1, v2))
      continue;
    const Vector3 x1 = mesh.rest.col(v1), x2 = mesh.rest.col(v2);
    const Vector3 x3 = mesh.rest.col(v3), x4 = mesh.rest.col(v4);
    if (!(cotangent(x3 - x1, x4 - x1) + cotangent(x3 - x2, x4 - x2) < -1e-6)) continue;
    triangles[mesh.edges[hinge.edge].triangles[0]] = {v1, v3, v2};
    triangles[mesh.edges[hinge.edge].triangles[1]] = {v2, v4, v1};
    for (int v : hinge.particles) touched[v] = 1;
  }
  mesh = make_triangle_mesh(mesh.rest, triangles);
}

/// Moves every vertex along the surface towards the mean centre of its triangles, and flips edges.
/// Triangles are weighted by their area to this power: the higher, the sooner they reach one size.
void relax(const std::vector<Limb>& limbs, int passes, int power, TriangleMesh& mesh) {
  for (int pass = 0; pass < passes; ++pass) {
    const Eigen::VectorXd areas = triangle_areas(mesh.triangles, mesh.rest);
    PerParticle3 centre = PerParticle3::Zero(3, mesh.particles());  // m times its weight
    PerParticle weight = PerParticle::Zero(mesh.particles());
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto [a, b, c] = mesh.triangles[t];
      const Vector3 middle = (mesh.rest.col(a) + mesh.rest.col(b) + mesh.rest.col(c)) / 3;
      const double weight_of_one = power == 1 ? areas[t] : std::pow(areas[t], power);
      for (int v : {a, b, c}) {
        centre.col(v) += weight_of_one * middle;
        weight[v] += weight_of_one;
      }
    }
    for (int v = 0; v < mesh.particles(); ++v) {
      const LocalDistance local = local_distance(limbs, mesh.rest.col(v));
      const Vector3 normal = local.gradient.normalized();
      const Vector3 pull = centre.col(v) / weight[v] - mesh.rest.col(v);
      mesh.rest.col(v) += 0.8 * (pull - pull.dot(normal) * normal) + local.to_surface();
    }
    flip_edges(mesh);
  }
}

void project(const std::vector<Limb>& limbs, PerParticle3& x) {
  for (int v = 0; v < int(x.cols()); ++v) x.col(v) += local_distance(limbs, x.col(v)).to_surface();
}

/// Puts a mesh one metre high on the ground y = 0, and scales it.
TriangleMesh set_up(TriangleMesh mesh, double height) {
  mesh.rest.row(1).array() -= mesh.rest.row(1).minCoeff();
  mesh.rest *= height / mesh.rest.row(1).maxCoeff();
  return mesh;
}

/// Carries the mesh of a unit sphere to the figure.
void carry(const std::vector<Limb>& limbs, PerParticle3& x) {
  for (int v = 0; v < int(x.cols()); ++v) x.col(v) = project_to_surface(limbs, x.col(v));
}

void divide(const std::vector<Limb>& limbs, int parts, int power, TriangleMesh& mesh) {
  mesh = divide_edges(mesh, parts);
  project(limbs, mesh.rest);
  relax(limbs, 15, power, mesh);
}

void require_height(const char* name, double height) {
  if (!(height > 0) || !std::isfinite(height))
    reject_argument(name, height, "give a positive length in m");
}

/// The smallest divisor >= 15; a smaller one leaves a limb without vertices. divisions >= 15.
int coarse_divisions(int divisions) {
  int coarse = 15;
  while (divisions % coarse != 0) ++coarse;
  return coarse;
}

}  // namespace

TriangleMesh make_statue(double height, int subdivisions) {
  require_height("make_statue: height", height);
  if (subdivisions < 3 || subdivisions > 8)
    reject_argument("make_statue: subdivisions", subdivisions, "give 3 to 8");
  const std::vector<Limb> limbs = seated_figure();
  const int coarse = std::min(subdivisions, 4);  // the first level that puts vertices on every limb
  TriangleMesh mesh = make_icosphere(1, coarse);
  carry(limbs, mesh.rest);
  relax(limbs, 100, 1, mesh);
  for (int level = coarse; level < subdivisions; ++level) divide(limbs, 2, 1, mesh);
  for (int pass = 0; pass < 3; ++pass) project(limbs, mesh.rest);
  return set_up(std::move(mesh), height);
}

TriangleMesh make_even_statue(double height, int divisions) {
  require_height("make_even_statue: height", height);
  if (divisions < 15 || divisions > 256 || coarse_divisions(divisions) > 29)
    reject_argument("make_even_statue: divisions", divisions,
                    "give 15 to 256, with a divisor from 15 to 29");
  const std::vector<Limb> limbs = seated_figure();
  const int coarse = coarse_divisions(divisions);
  TriangleMesh mesh = make_geodesic_sphere(1, coarse);
  carry(limbs, mesh.rest);
  relax(limbs, 400, 2, mesh);
  if (divisions > coarse) divide(limbs, divisions / coarse, 2, mesh);
  for (int pass = 0; pass < 3; ++pass) project(limbs, mesh.rest);
  return set_up(std::move(mesh), height);
}

}  // namespace foldproof
