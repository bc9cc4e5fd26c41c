// What keeps cloth out of objects and out of itself, point by point.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/filters/collision_points.h"
#include "reference/filters/impact_zones.h"
#include "reference/filters/object_collision.h"
#include "reference/filters/object_response.h"
#include "reference/filters/untangling.h"
#include "reference/mesh/shapes.h"

using namespace foldproof;

namespace {

const Vector3 N = Vector3(0.36, -0.48, 0.8), along = Vector3(0.8, 0.6, 0);  // perpendicular

ObjectPoint surface_at(double phi, const Vector3& velocity, double friction) {
  return {phi, N, velocity, 0, friction};
}

}  // namespace

// ----
// points --------------------------------------------------------------------------------------

TEST_CASE("collision points: centres, then midpoints, then particles, but none that cannot move") {
  PerParticle3 rest(3, 4);
  rest << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
  const TriangleMesh mesh = make_triangle_mesh(rest, {{0, 1, 2}, {0, 2, 3}});
  const PerParticle inverse_mass = (PerParticle(4) << 2, 0, 3, 0).finished();
  const auto faces = collision_points(mesh, inverse_mass, PointKind::faces);
  REQUIRE(faces.size() == 2 + 5 + 2);
  CHECK(faces[0].count == 3);
  CHECK(faces[0].particles == std::array{0, 1, 2});
  CHECK((faces[0].shares - Vector3(2, 0, 3) * 3 / 5).norm() < 1e-15);
  CHECK(faces[2].count == 2);
  CHECK(faces[2].particles[2] == -1);
  CHECK(faces[7].particles[0] == 0);
  CHECK(faces[8].particles[0] == 2);
  CHECK(faces[8].count == 1);
  CHECK(faces[8].shares == Vector3(1, 0, 0));
  for (const CollisionPoint& point : faces)
    CHECK(point.shares.sum() / point.count == Approx(1).epsilon(1e-14));
  CHECK(collision_points(mesh, inverse_mass, PointKind::edges).size() == 7);
  CHECK(collision_points(mesh, inverse_mass, PointKind::particles).size() == 2);
  CHECK((faces[0].mean(rest) - Vector3(2, 1, 0) / 3).norm() < 1e-15);
  CHECK(faces[8].mean(rest) == rest.col(2));
  // all edges but those with two prescribed ends
  const PerParticle held = (PerParticle(4) << 0, 0, 3, 0).finished();
  CHECK(collision_points(mesh, held, PointKind::edges).size() == 3 + 1);
}

TEST_CASE("object collision: a midpoint's correction goes to its free ends by their shares") {
  PerParticle3 rest(3, 3);
  rest << 0, 1, 0.5, 0, 0, 0.8, 0.3, 0.3, 0.9;
  const TriangleMesh mesh = make_triangle_mesh(rest, {{0, 1, 2}});
  const PerParticle inverse_mass = (PerParticle(3) << 0, 2, 4).finished();
  ObjectCollision filter;
  // a ball below the first side's middle alone
  filter.objects = {{"ball", RigidObject{Sphere{0.2}, {{}, {0.5, 0, 0}}, Motion{}}, 0}};
  filter.points = collision_points(mesh, inverse_mass, PointKind::edges);
  State s;
  s.x = rest, s.v = PerParticle3::Zero(3, 3);
  PerParticle3 v = PerParticle3::Zero(3, 3);
  v.row(2).setConstant(-1.5);
  Work work;
  filter.correct({0, 0.1, 0.1}, s, v, work);
  CHECK(work.object_contacts == 1);
  CHECK((v(2, 0) + v(2, 1)) / 2 == Approx(-1));  // .1 above the ball, for .1 s
  CHECK(v(2, 0) == -1.5);                        // prescribed
  CHECK(v(2, 2) == -1.5);                        // of no corrected point
  filter.use_threads(4, 3);
  CHECK(filter.threads == 1);  // points share particles
  filter.points = collision_points(mesh, inverse_mass, PointKind::particles);
  filter.use_threads(4, 3);
  CHECK(filter.threads == 4);
}

TEST_CASE("object collision: the forecast time is the step's, unless one is given") {
  ObjectCollision filter;
  filter.objects = {{"floor", RigidObject{HalfSpace{}, {}, Motion{}}, 0}};
  const CollisionPoint point{{0, -1, -1}, 1, {1, 0, 0}};
  filter.points = {point};
  State s;
  s.x = Vector3(0.2, 0.1, 0.3), s.v = PerParticle3::Zero(3, 1);
  const auto after = [&](double speed) {
    PerParticle3 v = Vector3(0, 0, -speed);
    Work work;
    filter.correct({0, 0.1, 0.1}, s, v, work);
    return v(2, 0);
  };
  CHECK(after(2) == -2);
  CHECK(after(5) == Approx(-3));
  filter.forecast_time = 0.2;
  CHECK(after(2) == Approx(-1.5));
  CHECK(after(1) == -1);
}

// ----
// responses -----------------------------------------------------------------------------------

TEST_CASE("response: the forecast of a point that stays outside is its velocity, bit for bit") {
  const Vector3 v = -2 * N + 0.7 * along, moving(0.1, -0.3, 0.2);
  // phi_new = phi + tau (v - moving).N
  const double closing = -(v - moving).dot(N), tau = 0.25;
  CHECK(forecast_velocity(surface_at(closing * tau * 1.001, moving, 0.5), v, tau) == v);
  const Vector3 kept = forecast_velocity(surface_at(0.3 * closing * tau, moving, 0), v, tau);
  CHECK((kept - moving).dot(N) == Approx(-0.3 * closing).epsilon(1e-13));
  const Vector3 sliding = (v - moving) + closing * N;
  CHECK(((kept - moving) + 0.3 * closing * N - sliding).norm() < 1e-14);
}

TEST_CASE("response: friction is Coulomb's, against the motion relative to the object") {
  const Vector3 v = -2 * N + 0.7 * along;
  // on the surface, at rest: pushed by 2 m/s, friction takes .2 of .7
  const Vector3 slowed = forecast_velocity(surface_at(0, Vector3::Zero(), 0.1), v, 0.25);
  CHECK((slowed - 0.5 * along).norm() < 1e-14);
  const Vector3 stuck = forecast_velocity(surface_at(0, Vector3::Zero(), 0.4), v, 0.25);
  CHECK(stuck.norm() < 1e-14);
}

TEST_CASE("response: known names, and what each asks") {
  CHECK(responses().size() == 4);
  CHECK(response_named("projection").query_time == QueryTime::at_end);
  for (const char* name : {"forecast", "forecast_deepest", "push_out"})
    CHECK(response_named(name).query_time == QueryTime::at_start);
  CHECK_THROWS_WITH(
      response_named("glue"),
      "unknown response 'glue'; known: forecast, forecast_deepest, projection, push_out");
}

TEST_CASE("response: projection puts a point on the surface, and stops it where it is on it") {
  const auto projected = [](double phi, const Vector3& v, const Span& span, double friction) {
    std::vector<ObjectPoint> answers{surface_at(phi, Vector3::Zero(), friction)};
    return response_named("projection").velocity(answers, {{}, v, span, 0.1});
  };
  const Span moves{0, 0.1, 0.1}, ends{0.1, 0.1, 0.1};
  const Vector3 v = -2 * N + 0.7 * along;
  CHECK((projected(-0.05, v, moves, 0) - (v + 0.5 * N)).norm() < 1e-14);
  CHECK((projected(-0.05, v, moves, 0.4) - (v + 0.5 * N - 0.2 * along)).norm() < 1e-14);
  CHECK(projected(0, v, moves, 0) == v);
  CHECK((projected(0, v, ends, 0) - 0.7 * along).norm() < 1e-14);
  // reached within a thousandth of the step: 2 m/s * .1 s / 1000
  CHECK((projected(1.9e-4, v, ends, 0) - 0.7 * along).norm() < 1e-14);
  CHECK(projected(2.1e-4, v, ends, 0) == v);
  CHECK(projected(-0.05, -v, ends, 0) == -v);  // on its way out
}

TEST_CASE("response: a point found inside after a step is pushed out in the next") {
  const auto pushed = [](double phi, const Span& span) {
    std::vector<ObjectPoint> answers{surface_at(phi, Vector3::Zero(), 0)};
    return response_named("push_out").velocity(answers, {{}, 0.7 * along - N, span, 9});
  };
  const Vector3 v = 0.7 * along - N;
  CHECK(pushed(-0.05, {0, 0.1, 0.1}) == v);
  CHECK((pushed(-0.05, {0.1, 0.1, 0.1}) - (0.7 * along + 0.5 * N)).norm() < 1e-14);
  CHECK(pushed(0, {0.1, 0.1, 0.1}) == v);
}

TEST_CASE("response: inside two objects a point is led to where both are equally deep") {
  const Vector3 up = Vector3::UnitZ();
  const ObjectPoint a{-0.03, up, Vector3::Zero(), 0, 0.2}, b{-0.01, -up, Vector3::Zero(), 1, 0.3};
  const MovingPoint point{{}, {0.9, 0, 0.1}, {0, 0.1, 0.1}, 0.1};
  const Vector3 v = velocity_between(a, b, point);
  // psi = phi_a - phi_b = -.02 + .2 t (v.up): zero after .1 s if v.up = .1
  CHECK(-0.02 + 2 * 0.1 * v.z() == Approx(0).margin(1e-15));
  // pushes: a alone (.03 - .1 * .1)/.1 = .2, b alone (.01 + .01)/.1 = .2; friction .04 + .06
  CHECK(v.x() == Approx(0.9 - 0.1).epsilon(1e-13));
  CHECK(v.y() == 0);
  // the same the other way round
  CHECK((velocity_between(b, a, point) - v).norm() < 1e-15);
  // where the normals nearly agree there is nothing between
  const ObjectPoint same{-0.01, Vector3(0.05, 0, 1).normalized(), Vector3::Zero(), 1, 0.3};
  CHECK(velocity_between(a, same, point) == forecast_velocity(a, point.v, point.tau));
}

TEST_CASE(
    "response: of several objects that will be entered, each counts once, the deepest first") {
  const ObjectPoint floor{0.01, Vector3::UnitZ(), Vector3::Zero(), 0, 0},
      wall{0.02, Vector3::UnitX(), Vector3::Zero(), 1, 0};
  const MovingPoint point{{}, {-0.5, 0.3, -0.9}, {0, 0.1, 0.1}, 0.1};
  std::vector<ObjectPoint> answers{wall, floor};
  const Vector3 v = response_named("forecast").velocity(answers, point);
  CHECK((v - Vector3(-0.2, 0.3, -0.1)).norm() < 1e-14);
  answers = {wall, floor};
  const Vector3 alone = response_named("forecast_deepest").velocity(answers, point);
  CHECK((alone - Vector3(-0.5, 0.3, -0.1)).norm() < 1e-14);  // the nearest is the floor
}

// ---- zones and
// tangles ---------------------------------------------------------------------------

TEST_CASE("a zone moves rigidly with its own momentum") {
  PerParticle3 x(3, 5), v(3, 5);
  x << 0.1, 1.2, 0.3, 9, -0.4, 0.2, 0.1, 0.9, 9, 0.5, 0.3, -0.2, 0.4, 9, 1.1;
  v << 0.5, -0.2, 0.3, 7, 0.1, 0.4, 0.8, -0.6, 7, 0.2, -0.3, 0.1, 0.7, 7, 0.9;
  const PerParticle mass = (PerParticle(5) << 1, 2, 0.5, 3, 4).finished();
  const std::vector<int> zone{0, 1, 2, 4};
  const auto momenta = [&](const PerParticle3& of) {
    Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
    for (const int i : zone) {
      sum.head<3>() += mass[i] * of.col(i);
      sum.tail<3>() += mass[i] * Vector3(x.col(i)).cross(Vector3(of.col(i)));
    }
    return sum;
  };
  PerParticle3 after = v;
  CHECK(move_as_one(zone, x, mass, mass.cwiseInverse(), after) == 0);
  CHECK((momenta(after) - momenta(v)).norm() < 1e-13);
  for (const int i : zone)
    for (const int j : zone)  // no distance changes
      CHECK(std::abs((x.col(i) - x.col(j)).dot(after.col(i) - after.col(j))) < 1e-13);
  CHECK(after.col(3) == v.col(3));

  PerParticle inverse_mass = mass.cwiseInverse();
  inverse_mass[1] = 0;  // led
  after = v;
  CHECK(move_as_one(zone, x, mass, inverse_mass, after) < 1e-13);
  CHECK(after.col(1) == v.col(1));
  inverse_mass[0] = inverse_mass[2] = 0;
  after = v;
  CHECK(move_as_one(zone, x, mass, inverse_mass, after) > 0.01);  // these three deform
}

TEST_CASE("tangles: pairs are listed, their particles marked, and pairs of them left out") {
  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  CHECK(list_triangles({{0, 1}, {0, 2}}) == "2 pairs of triangles: 0 and 1, 0 and 2");
  const CrossingTriangles many{{0, 1}, {0, 2}, {1, 2}, {0, 1}, {0, 2}, {1, 2}};
  CHECK(list_triangles(many) ==
        "6 pairs of triangles: 0 and 1, 0 and 2, 1 and 2, 0 and 1, 0 and 2, ...");
  CHECK(list_triangles({many.begin(), many.begin() + 5}).ends_with("0 and 2"));
  const std::vector<char> tangled = tangled_particles({{0, 2}}, triangles, 10);
  CHECK(tangled == std::vector<char>{1, 1, 1, 0, 0, 0, 1, 1, 1, 0});
  std::vector<FeaturePair> pairs{{PairKind::edge_edge, {0, 1, 6, 8}},
                                 {PairKind::edge_edge, {0, 1, 6, 9}},
                                 {PairKind::vertex_triangle, {7, 0, 1, 2}},
                                 {PairKind::vertex_triangle, {3, 0, 1, 2}}};
  remove_tangled_pairs(tangled, pairs);
  REQUIRE(pairs.size() == 2);
  CHECK(pairs[0].particles[3] == 9);
  CHECK(pairs[1].particles[0] == 3);
}

TEST_CASE("tangles: a corner that pierces is pulled back out, without momentum") {
  PerParticle3 x(3, 6);
  x << -1, 1, 0, 0.1, 0.3, 0.0, -1, -1, 1.5, 0.1, 0.2, -0.3, 0, 0, 0, -0.2, 1, 1.1;
  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}};
  const PerParticle mass = (PerParticle(6) << 1, 2, 3, 4, 5, 6).finished();
  PerParticle3 v = PerParticle3::Zero(3, 6);
  push_out_of_tangle({{0, 1}}, triangles, x, 0.5, mass.cwiseInverse(), v);
  CHECK(v(2, 3) > 0);  // the corner below the first triangle
  CHECK((v * mass).norm() < 1e-14);
  PerParticle3 held = PerParticle3::Zero(3, 6);
  push_out_of_tangle({{0, 1}}, triangles, x, 0.5, PerParticle::Zero(6), held);
  CHECK(held == PerParticle3::Zero(3, 6));
}
