// Quantities of [expect] on a sheet with random places and speeds: each against its definition,
// worked out particle by particle.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "reference/bodies/level_set_provider.h"
#include "reference/mesh/shapes.h"
#include "verification/cases/face_depth.h"
#include "verification/cases/quantities.h"

using namespace foldproof;

namespace {

constexpr double degrees = 180 / pi;

Approx exactly(double value) { return Approx(value).epsilon(1e-10).margin(1e-13); }

PerParticle3 random_places(int count, double reach, unsigned seed) {
  std::mt19937 bits(seed);
  std::uniform_real_distribution<double> within(-reach, reach);
  PerParticle3 x(3, count);
  for (double& number : x.reshaped()) number = within(bits);
  return x;
}

/// Cloth of 20 particles in the plane z = 0.4, with all that quantities ask for.
Scene scene_of_everything() {
  TriangleMesh mesh = make_sheet({SheetPattern::union_jack, 0.5, 0.33, 4, 3});
  mesh.rest.row(2).setConstant(0.4);
  Scene scene = scene_at_rest(make_triangle_mesh(mesh.rest, mesh.triangles), 0.23);
  scene.gravity = Vector3(1, -7, 2);
  scene.stretch = StretchMaterial{30, 0, 0.93};
  scene.bending = BendingMaterial{1e-3};
  const PerParticle3 angles = random_places(int(scene.mesh.hinges.size()), 3.1, 7);
  for (std::size_t h = 0; h < scene.mesh.hinges.size(); ++h)
    scene.rest_angles.push_back(angles(1, Eigen::Index(h)));
  scene.strain_limits = StrainLimits{0.13, 0.07};
  scene.x += random_places(20, 0.05, 3);
  return scene;
}

State crumpled(const Scene& scene, unsigned seed, double reach = 0.06) {
  const int count = scene.mesh.particles();
  return {0.7, scene.x + random_places(count, reach, seed), random_places(count, 2, seed + 50)};
}

double value(const char* key, const Scene& scene, const State& s,
             std::span<const Object> objects = {}) {
  return value_at(*find_quantity(key), scene, objects, s);
}

/// From N1 to N2 about the hinge's edge [rad].
double angle_of(const Hinge& hinge, const PerParticle3& x) {
  const Vector3 x1 = x.col(hinge.particles[0]), x2 = x.col(hinge.particles[1]),
                x3 = x.col(hinge.particles[2]), x4 = x.col(hinge.particles[3]);
  const Vector3 n1 = (x1 - x3).cross(x1 - x4), n2 = (x2 - x4).cross(x2 - x3);
  return std::atan2(n1.cross(n2).dot((x4 - x3).normalized()), n1.dot(n2));
}

double length_of(const Edge& edge, const PerParticle3& x) {
  return (x.col(edge.a) - x.col(edge.b)).norm();
}

double area_of(const TriangleMesh& mesh, const PerParticle3& x) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vector3 a = x.col(t[0]), b = x.col(t[1]), c = x.col(t[2]);
    sum += (a - c).cross(b - c).norm() / 2;
  }
  return sum;
}

}  // namespace

TEST_CASE("quantities of shape: plane, angles, lengths, extent and area") {
  const Scene scene = scene_of_everything();
  for (unsigned seed = 1; seed < 6; ++seed) {
    const State s = crumpled(scene, seed, 0.02 * seed);
    double plane = 0, change = 0, forward = -1e9, back = -1e9, length = 0, beyond = 0, longer = 0;
    for (Eigen::Index i = 0; i < 20; ++i) plane = std::max(plane, std::abs(s.x(2, i) - 0.4));
    for (std::size_t h = 0; h < scene.mesh.hinges.size(); ++h) {
      const double angle = angle_of(scene.mesh.hinges[h], s.x) * degrees;
      const double off = std::abs(angle - scene.rest_angles[h] * degrees);
      change = std::max(change, std::min(off, 360 - off));
      forward = std::max(forward, angle), back = std::max(back, -angle);
    }
    for (const Edge& edge : scene.mesh.edges) {
      const double strain = length_of(edge, s.x) / (0.93 * length_of(edge, scene.mesh.rest)) - 1;
      length = std::max(length, std::abs(strain)), longer = std::max(longer, strain);
      beyond = std::max({beyond, strain - 0.13, -strain - 0.07});
    }
    CHECK(value("stays_flat", scene, s) == exactly(plane));
    CHECK(value("leaves_its_plane", scene, s) == exactly(plane));
    CHECK(value("keeps_its_angles", scene, s) == exactly(change));
    CHECK(value("folds_to", scene, s) == exactly(forward));
    CHECK(value("folds_back_to", scene, s) == exactly(back));
    CHECK(value("keeps_its_lengths", scene, s) == exactly(length));
    CHECK(value("stretches_to", scene, s) == exactly(longer));
    CHECK(value("stays_within_strain_limits", scene, s) == exactly(beyond));
    CHECK(value("keeps_its_area", scene, s) ==
          exactly(1 - area_of(scene.mesh, s.x) / area_of(scene.mesh, scene.mesh.rest)));
    // the longest extent at rest is along x
    CHECK(value("lengthens_by", scene, s) ==
          exactly((s.x.row(0).maxCoeff() - s.x.row(0).minCoeff()) / 0.5 - 1));
  }
  State shrunk = start_state(scene);
  shrunk.x = 0.5 * scene.mesh.rest;  // every spring is too short
  CHECK(value("stays_within_strain_limits", scene, shrunk) == exactly(1 - 0.5 / 0.93 - 0.07));
  CHECK(value("keeps_its_lengths", scene, shrunk) == exactly(1 - 0.5 / 0.93));
  CHECK(value("stretches_to", scene, shrunk) == 0);
  CHECK(value("keeps_its_area", scene, shrunk) == exactly(0.75));
  shrunk.x(0, 3) = foldproof::nan;
  for (const char* key : {"folds_to", "folds_back_to", "keeps_its_angles", "stretches_to"})
    CHECK(std::isnan(value(key, scene, shrunk)));
}

TEST_CASE("quantities of shape: folds all to one side are far from the other") {
  TriangleMesh hinge = make_triangle_mesh(
      (PerParticle3(3, 4) << 0.5, 0.6, 0, 0, 1, -1, 0, 0, 0.4, 0.4, 0, 1).finished(),
      {{0, 2, 3}, {1, 3, 2}});
  const Scene scene = scene_at_rest(hinge, 0.2);
  REQUIRE(scene.mesh.hinges.size() == 1);
  const double angle = angle_of(scene.mesh.hinges[0], scene.x) * degrees;
  CHECK(std::abs(angle) > 30);
  CHECK(value("folds_to", scene, start_state(scene)) == exactly(angle));
  CHECK(value("folds_back_to", scene, start_state(scene)) == exactly(-angle));
}

TEST_CASE("quantities of place: speeds, turning rate and path lengths of the mean") {
  const Scene scene = scene_of_everything();
  const PerParticle mass = lumped_masses(scene.mesh, 0.23);
  for (unsigned seed = 1; seed < 6; ++seed) {
    const State s = crumpled(scene, seed);
    double speed = 0, momentum = 0, inertia = 0;
    Vector3 way = Vector3::Zero();
    for (Eigen::Index i = 0; i < 20; ++i) {
      const Vector3 x = s.x.col(i), v = s.v.col(i);
      speed = std::max(speed, v.norm());
      momentum += mass[i] * x.cross(v).y();
      inertia += mass[i] * (x.squaredNorm() - x.y() * x.y());
      way += (x - scene.x.col(i)) / 20;
    }
    CHECK(value("speed_is_limited", scene, s) == exactly(speed));
    CHECK(value("reaches_turning_rate", scene, s) ==
          exactly(std::abs(momentum) / inertia * degrees));
    CHECK(value("keeps_its_place", scene, s) == exactly(way.norm()));
    CHECK(value("is_carried", scene, s) == exactly(way.norm()));
    CHECK(value("is_carried_aside", scene, s) ==
          exactly(way.cross(scene.gravity->normalized()).norm()));
    const Vector3 up = -scene.gravity->normalized();
    CHECK(value("is_lifted", scene, s) ==
          exactly((up.transpose() * s.x).minCoeff() - (up.transpose() * scene.x).minCoeff()));
  }
}

namespace {

/// Spheres of these radii at these places.
std::vector<Object> spheres(const std::vector<std::pair<double, Vector3>>& all) {
  std::vector<Object> objects;
  for (const auto& [radius, place] : all) {
    RigidObject body{Sphere{radius}, {}, {}};
    body.place.translation = place;
    objects.push_back({"ball", body, 0.3});
  }
  return objects;
}

}  // namespace

TEST_CASE("quantities of objects: depths of free particles, and what two objects pinch") {
  Scene scene = scene_of_everything();
  const Vector3 middle(0.25, 0.16, 0.4);
  const std::vector<std::pair<double, Vector3>> balls = {
      {0.17, middle + Vector3(-0.12, 0.02, 0.05)},
      {0.21, middle + Vector3(0.1, -0.03, -0.06)},
      {0.14, middle + Vector3(0.02, 0.15, 0.01)}};
  const std::vector<Object> objects = spheres(balls);
  int pinched_somewhere = 0, faces_deeper = 0;
  for (unsigned seed = 1; seed < 12; ++seed) {
    scene.prescribed.clear();
    for (const unsigned held : {seed, seed + 5, 19u})
      scene.prescribed.push_back({int(held), Vector3::Zero(), {}});
    const State s = crumpled(scene, seed, 0.1);
    double depth = 0, off_centre = 0, of_faces = 0;
    int pinched = 0;
    std::vector<bool> counts(20, true);
    for (Eigen::Index i = 0; i < 20; ++i) {
      std::vector<std::pair<double, Vector3>> found;  // phi and normal
      for (const auto& [radius, place] : balls) {
        const Vector3 from = s.x.col(i) - place;
        found.emplace_back(from.norm() - radius, from.normalized());
      }
      std::ranges::sort(found, {}, [](const auto& one) { return one.first; });
      const bool is_pinched = found[1].first < 0;
      const bool is_held = i == seed || i == seed + 5 || i == 19;
      counts[std::size_t(i)] = !is_pinched && !is_held;
      pinched += is_pinched;
      if (is_pinched)
        off_centre = std::max(off_centre, (found[1].first - found[0].first) /
                                              (found[1].second - found[0].second).norm());
      if (!is_pinched && !is_held) depth = std::max(depth, -found[0].first);
    }
    for (const Triangle& t : scene.mesh.triangles)
      for (const auto& [radius, place] : balls)
        if (counts[std::size_t(t[0])] && counts[std::size_t(t[1])] && counts[std::size_t(t[2])])
          of_faces = std::max(
              of_faces, deepest_point(Sphere{radius}, {s.x.col(t[0]) - place, s.x.col(t[1]) - place,
                                                       s.x.col(t[2]) - place}));
    CHECK(value("stays_outside", scene, s, objects) == exactly(depth));
    CHECK(value("is_pinched", scene, s, objects) == pinched);
    CHECK(value("stays_between", scene, s, objects) == exactly(off_centre));
    CHECK(value("faces_outside", scene, s, objects) == exactly(of_faces));
    RunResult result;
    result.last = s;
    const DiagnosticsSummary summary;
    const Repetition repetition(scene, computing_provider());
    CHECK(find_quantity("lies_inside")->of_run({scene, summary, result, repetition, objects}) ==
          exactly(depth));
    pinched_somewhere += pinched > 1, faces_deeper += of_faces > depth + 1e-3;
  }
  CHECK(pinched_somewhere > 5);
  CHECK(faces_deeper > 2);
}

TEST_CASE("quantities of objects: a face that only its middle brings into a small ball") {
  Scene scene = scene_of_everything();
  State s = start_state(scene);
  s.x = scene.mesh.rest;
  for (const Triangle& t : scene.mesh.triangles) {
    const Vector3 a = s.x.col(t[0]), b = s.x.col(t[1]), c = s.x.col(t[2]);
    const double radius = 0.02;
    const std::vector<Object> objects =
        spheres({{0.1, {9, 9, 9}}, {radius, (a + b + c) / 3 + Vector3(0, 0, 0.005)}});
    CHECK(value("stays_outside", scene, s, objects) == 0);
    CHECK(value("faces_outside", scene, s, objects) == exactly(radius - 0.005));
  }
}

TEST_CASE("quantities of objects: a ring is searched to a thousandth of the longest side") {
  Scene scene = scene_of_everything();
  State s = start_state(scene);
  s.x = scene.mesh.rest;
  RigidObject body{Torus{0.12, 0.03}, {}, {}};  // about z, its middle above the sheet
  body.place.translation = Vector3(0.23, 0.17, 0.41);
  const std::vector<Object> objects = {{"ring", body, 0.1}};
  double longest = 0;
  for (const Edge& edge : scene.mesh.edges) longest = std::max(longest, length_of(edge, s.x));
  const double found = value("faces_outside", scene, s, objects);
  CHECK(found >= 0.02 - 1e-12);
  CHECK(found <= 0.02 + 1.001e-3 * longest);
  CHECK(found > 0.02 + 0.3e-3 * longest);  // the bound of a search, not the depth
}
