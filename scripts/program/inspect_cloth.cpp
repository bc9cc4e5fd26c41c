#include "scripts/program/inspect_cloth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "reference/bodies/closed_mesh.h"
#include "reference/dynamics/system.h"
#include "reference/mesh/box_tree.h"
#include "reference/mesh/rigidity_map.h"
#include "reference/mesh/seams.h"
#include "reference/scene/scene.h"
#include "scripts/program/json_text.h"

namespace foldproof {

namespace {

/// A triangle, its longest side over the height on it, and where its centre is.
struct ThinTriangle {
  int triangle;   // from 0
  double aspect;  // 1; 1.15 if equilateral
  double height;  // m
  Vector3 centre;
};

struct PlaceOfAnisotropy {
  RigidityExtremes extremes;
  int particle;
};

struct ClothInspection {
  int particles, triangles;
  bool is_flat = false;
  Vector3 size = Vector3::Zero();  // m
  double area = 0;                 // m^2
  int pieces = 1;                  // connected by edges
  std::string open_seams = {};     // in words
  // D/ke, B/ke of a narrow strip, and Young's modulus over Y, every 15 degrees from x; flat meshes
  // only [1]
  std::vector<double> by_direction = {}, of_strips = {}, moduli = {};
  double least = 0, greatest = 0;              // of the whole flat mesh [1]
  std::vector<PlaceOfAnisotropy> places = {};  // most anisotropic first
  double median_anisotropy = 0;                // of the places
  // largest stable steps of springs and of hinges with density, Y and ke of 1: a step h is stable
  // below spring_limit sqrt(rho/Y) and hinge_limit sqrt(rho/ke) [m], [m^2]
  double spring_limit = 0, hinge_limit = 0;
  std::vector<ThinTriangle> thinnest = {};
};

ThinTriangle shape_of(const TriangleMesh& mesh, int t) {
  const Triangle& triangle = mesh.triangles[size_t(t)];
  const Vector3 a = mesh.rest.col(triangle[0]), b = mesh.rest.col(triangle[1]),
                c = mesh.rest.col(triangle[2]);
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  const double height = (b - a).cross(c - a).norm() / longest;
  return {t, longest / height, height, (a + b + c) / 3};
}

std::vector<ThinTriangle> thinnest_of(const TriangleMesh& mesh, size_t most) {
  std::vector<ThinTriangle> all;
  for (int t = 0; t < int(mesh.triangles.size()); ++t) all.push_back(shape_of(mesh, t));
  most = std::min(most, all.size());
  std::partial_sort(all.begin(), all.begin() + long(most), all.end(),
                    [](const ThinTriangle& a, const ThinTriangle& b) {
                      return a.aspect != b.aspect ? a.aspect > b.aspect : a.triangle < b.triangle;
                    });
  all.resize(most);
  return all;
}

double limit_with(const TriangleMesh& mesh, bool has_springs) {
  Scene scene = scene_at_rest(mesh, 1);
  if (has_springs) scene.stretch = StretchMaterial{1, 0, 1};
  if (!has_springs) {
    scene.bending = BendingMaterial{1, 0, Weighting::rest, DampingFactor::edge, "sine"};
    scene.rest_angles = hinge_angles(scene.mesh, scene.mesh.rest);
  }
  return elastic_limit(build_system(scene), start_state(scene));
}

ClothInspection inspect_as_cloth(const TriangleMesh& mesh) {
  ClothInspection found{mesh.particles(), int(mesh.triangles.size())};
  found.size = bounds_of(mesh.rest).sizes();
  found.area = triangle_areas(mesh.triangles, mesh.rest).sum();
  found.pieces = count_of_pieces(mesh);
  found.open_seams = open_seams_in_words(mesh);
  RestPlane plane;
  found.is_flat = is_flat(mesh, plane);
  if (found.is_flat && !mesh.hinges.empty()) {
    const Rigidity rigidity = rigidity_of(mesh, plane), membrane = membrane_of(mesh, plane);
    for (int k = 0; k < 12; ++k) {
      found.by_direction.push_back(rigidity.along(k * std::numbers::pi / 12));
      found.of_strips.push_back(rigidity.of_strip(k * std::numbers::pi / 12));
      found.moduli.push_back(membrane.of_strip(k * std::numbers::pi / 12));
    }
    found.least = extremes_of(rigidity).least;
    found.greatest = extremes_of(rigidity).greatest;
  }
  const std::vector<RigidityExtremes> around = rigidity_around_particles(mesh);
  for (size_t i = 0; i < around.size(); ++i)
    if (std::isfinite(around[i].greatest)) found.places.push_back({around[i], int(i)});
  std::stable_sort(found.places.begin(), found.places.end(),
                   [](const PlaceOfAnisotropy& a, const PlaceOfAnisotropy& b) {
                     return a.extremes.anisotropy() > b.extremes.anisotropy();
                   });
  if (!found.places.empty())
    found.median_anisotropy = found.places[found.places.size() / 2].extremes.anisotropy();
  if (found.places.size() > 3) found.places.resize(3);
  found.spring_limit = limit_with(mesh, true);
  if (!mesh.hinges.empty()) found.hinge_limit = limit_with(mesh, false);
  found.thinnest = thinnest_of(mesh, 3);
  return found;
}

/// "-" where a mesh of few hinges has none.
std::string or_none(double value, const char* digits) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(digits), value) : "-";
}

void print(const std::string& file, const TriangleMesh& mesh, const ClothInspection& found) {
  fmt::print("{}: a cloth of {} particles, {} triangles, {}\n", file, found.particles,
             found.triangles, found.is_flat ? "flat" : "not flat");
  fmt::print("size {:.3g} x {:.3g} x {:.3g} m, area {:.4g} m^2\n", found.size.x(), found.size.y(),
             found.size.z(), found.area);
  if (found.pieces > 1) fmt::print("the cloth is in {} pieces\n", found.pieces);
  if (!found.open_seams.empty()) fmt::print("{}\n", found.open_seams);
  if (!found.by_direction.empty()) {
    fmt::print("rigidity D/ke by direction from x: {:.4g} to {:.4g}, ratio {}\n", found.least,
               found.greatest, or_none(found.greatest / found.least, "{:.3g}"));
    fmt::print("{:>11}  {:>8}  {:>22}  {:>18}\n", "direction", "D/ke", "B/ke of a narrow strip",
               "Young's modulus/Y");
    for (size_t k = 0; k < found.by_direction.size(); ++k)
      fmt::print("{:>3} degrees  {:8.4f}  {:>22}  {:>18}\n", 15 * k, found.by_direction[k],
                 or_none(found.of_strips[k], "{:.4f}"), or_none(found.moduli[k], "{:.4f}"));
  }
  if (!found.places.empty())
    fmt::print(
        "around single particles the stiffest direction is {:.3g} times the softest in the median; "
        "most at\n",
        found.median_anisotropy);
  for (const PlaceOfAnisotropy& place : found.places)
    fmt::print("  particle {} at {}: {:.3g} times (D/ke {:.3g} to {:.3g})\n", place.particle,
               point(mesh.rest.col(place.particle)), place.extremes.anisotropy(),
               place.extremes.least, place.extremes.greatest);
  fmt::print("elastic limit of a step: springs {:.4g} m sqrt(density/Y)", found.spring_limit);
  if (found.hinge_limit > 0) fmt::print("; hinges {:.4g} m^2 sqrt(density/ke)", found.hinge_limit);
  fmt::print("\nthinnest triangles (longest side over height; 1.15 if equilateral):\n");
  for (const ThinTriangle& thin : found.thinnest)
    fmt::print("  triangle {} at {}: {:.3g}, {:.3g} m high\n", thin.triangle, point(thin.centre),
               thin.aspect, thin.height);
}

nlohmann::json to_json(const std::string& file, const ClothInspection& found) {
  nlohmann::json places = nlohmann::json::array(), thinnest = nlohmann::json::array();
  for (const PlaceOfAnisotropy& place : found.places)
    places.push_back({{"particle", place.particle},
                      {"least", place.extremes.least},
                      {"greatest", place.extremes.greatest},
                      {"anisotropy", place.extremes.anisotropy()}});
  for (const ThinTriangle& thin : found.thinnest)
    thinnest.push_back(
        {{"triangle", thin.triangle}, {"aspect", thin.aspect}, {"height", thin.height}});
  return {{"file", file},
          {"particles", found.particles},
          {"triangles", found.triangles},
          {"is_flat", found.is_flat},
          {"rigidity_every_15_degrees", found.by_direction},
          {"strip_rigidity_every_15_degrees", found.of_strips},
          {"modulus_every_15_degrees", found.moduli},
          {"size", {found.size.x(), found.size.y(), found.size.z()}},
          {"area", found.area},
          {"pieces", found.pieces},
          {"open_seams", found.open_seams},
          {"median_anisotropy", found.median_anisotropy},
          {"most_anisotropic", places},
          {"spring_limit", found.spring_limit},
          {"hinge_limit", found.hinge_limit},
          {"thinnest", thinnest}};
}

}  // namespace

std::string point(const Vector3& p) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x(), p.y(), p.z());
}

int inspect_cloth(const Options& options, TriangleSoup soup) {
  const TriangleMesh mesh =
      make_triangle_mesh(std::move(soup.rest), std::move(soup.triangles), soup.origin);
  const ClothInspection found = inspect_as_cloth(mesh);
  if (options.json)
    fmt::print("{}\n", json_text(to_json(options.file, found)));
  else
    print(options.file, mesh, found);
  return all_hold;
}

}  // namespace foldproof
