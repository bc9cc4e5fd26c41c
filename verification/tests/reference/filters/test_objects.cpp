// Cloth points against objects: responses, the points of the cloth, and the filter that joins them.
#include <catch2/catch.hpp>
#include <numeric>

#include "reference/filters/object_collision.h"

using namespace foldproof;

namespace {

const Vector3 up(0, 0, 1);

ObjectPoint answer(double phi, const Vector3& normal, const Vector3& velocity, double friction) {
  return {phi, normal, velocity, 0, friction};
}

MovingPoint moving(const Vector3& v, const Span& span, double tau) {
  return {Vector3(0.3, 0.7, 0.2), v, span, tau};
}

Vector3 respond(std::string_view name, std::vector<ObjectPoint> answers, const MovingPoint& point) {
  return response_named(name).velocity(answers, point);
}

/// The floor z < height, moving.
Object floor_at(double height, const Vector3& velocity, double friction) {
  Motion motion;
  motion.velocity = velocity;
  Pose place;
  place.translation = Vector3(0.4, -0.3, height);
  return {"floor", RigidObject{HalfSpace{}, place, motion}, friction};
}

bool near(const Vector3& a, const Vector3& b) { return (a - b).norm() < 1e-13; }

const Span step{1, 1.5, 0.5};  // moves the cloth
const Span ends{1, 1, 0.5};    // only ends a step

}  // namespace

TEST_CASE("a forecast takes a point to the surface, relative to the object, with friction") {
  // forecast 0.2 + 0.5 * (-1.4 - 0.2) = -0.6: a push of 1.2
  const ObjectPoint at = answer(0.2, up, {0.3, -0.1, 0.2}, 0.25);
  const Vector3 v(0.9, 0.7, -1.4);  // slides at (0.6, 0.8), speed 1
  CHECK(near(forecast_velocity(at, v, 0.5), Vector3(0.3 + 0.6 * 0.7, -0.1 + 0.8 * 0.7, -0.2)));
  // friction stops it
  CHECK(near(forecast_velocity(answer(0.2, up, {0.3, -0.1, 0.2}, 2), v, 0.5),
             Vector3(0.3, -0.1, -0.2)));
  // straight down
  CHECK(near(forecast_velocity(at, {0.3, -0.1, -1.4}, 0.5), Vector3(0.3, -0.1, -0.2)));
  // a forecast on or beyond the surface changes no bit
  const Vector3 down(0.9, 0.7, -1);
  CHECK(forecast_velocity(answer(0.5, up, Vector3::Zero(), 1), down, 0.5) == down);
  CHECK(forecast_velocity(answer(0.75, up, Vector3::Zero(), 1), down, 0.5) == down);
}

TEST_CASE("a pinched point goes to the surface between two objects, with the friction of both") {
  // phi_a = -0.3, phi_b = -0.1; normals up and down; velocities differ
  const ObjectPoint a = answer(-0.3, up, {0.2, 0, 0.4}, 0.25),
                    b = answer(-0.1, -up, {0, 0.6, -0.2}, 0.5);
  const MovingPoint point = moving({0.7, 1.1, 0.1}, step, 0.5);
  // forecasts -0.3 + 0.5 * (0.1 - 0.4) = -0.45 and -0.1 - 0.5 * (0.1 + 0.2) = -0.25:
  // pushes 0.9 and 0.5; psi -0.2, so v_n rises by 0.2 / (0.5 * 2)
  const Vector3 sliding(0.6, 0.8, 0);  // against the mean (0.1, 0.3)
  const double stopped = 0.25 * 0.9 + 0.5 * 0.5;
  CHECK(near(velocity_between(a, b, point),
             Vector3(point.v - stopped * sliding + Vector3(0, 0, 0.2))));
  // an object that the point leaves pushes nothing: friction against the other alone
  const ObjectPoint left = answer(0.4, up, {0.2, 0, 0.4}, 9);
  // psi = 0.25 + 0.25
  CHECK(near(velocity_between(left, b, point),
             Vector3(point.v - 0.25 * sliding - Vector3(0, 0, 0.5))));
  // and the other way round
  CHECK(near(velocity_between(b, left, point),
             Vector3(point.v - 0.25 * sliding - Vector3(0, 0, 0.5))));
}

TEST_CASE("between normals that nearly coincide there is no surface: the first object alone") {
  const auto tilted = [](double angle) { return Vector3(std::sin(angle), 0, std::cos(angle)); };
  const MovingPoint point = moving({0.7, 1.1, 0.1}, step, 0.5);
  const auto alone = [&](const ObjectPoint& a) { return forecast_velocity(a, point.v, 0.5); };
  const ObjectPoint a = answer(-0.3, up, {0.2, 0, 0.4}, 0.25);
  // |N_a - N_b| = 2 sin(angle / 2)
  const ObjectPoint close = answer(-0.1, tilted(0.0999), {0, 0.6, -0.2}, 0.5),
                    apart = answer(-0.1, tilted(0.1002), {0, 0.6, -0.2}, 0.5);
  CHECK(velocity_between(a, close, point) == alone(a));
  CHECK(velocity_between(close, a, point) == alone(close));
  CHECK_FALSE(near(velocity_between(a, apart, point), alone(a)));
}

TEST_CASE("the table of responses begins with the paper's; an unknown name lists the known") {
  std::string names;
  for (const Response& response : responses()) {
    names += std::string(response.name) + " ";
    CHECK(&response_named(response.name) == &response);
    CHECK(response.query_time ==
          (response.name == "projection" ? QueryTime::at_end : QueryTime::at_start));
  }
  CHECK(names == "forecast forecast_deepest projection push_out ");
  CHECK_THROWS_WITH(
      response_named("forcast"),
      "unknown response 'forcast'; known: forecast, forecast_deepest, projection, push_out");
}

TEST_CASE("forecasting answers each object in turn, the deepest forecast first") {
  // walls with normals x and y, both to be entered: neither is forgotten
  const ObjectPoint x = answer(0.1, {1, 0, 0}, Vector3::Zero(), 0),
                    y = answer(0.05, {0, 1, 0}, Vector3::Zero(), 0),
                    z = answer(0.3, up, Vector3::Zero(), 0);
  const MovingPoint point = moving({-0.9, -0.4, 0.8}, step, 0.5);
  const Vector3 wanted(-0.2, -0.1, 0.8);
  for (const auto& order : {std::vector{x, y, z}, std::vector{z, y, x}, std::vector{y, z, x}})
    CHECK(near(respond("forecast", order, point), wanted));
  // the deepest or nearest alone is y
  for (const auto& order : {std::vector{x, y, z}, std::vector{z, y, x}})
    CHECK(near(respond("forecast_deepest", order, point), Vector3(-0.9, -0.1, 0.8)));
  CHECK(respond("forecast", {}, point) == point.v);
  // friction: of the deeper, x (forecast -0.35), first
  ObjectPoint rough_x = x, rough_y = y;
  rough_x.friction = 0.5, rough_y.friction = 0.25;
  const Vector3 first = forecast_velocity(rough_x, point.v, 0.5),
                then = forecast_velocity(rough_y, first, 0.5);
  CHECK(near(respond("forecast", {rough_y, rough_x}, point), then));
  CHECK_FALSE(
      near(forecast_velocity(rough_x, forecast_velocity(rough_y, point.v, 0.5), 0.5), then));
}

TEST_CASE("a way out of one object into another that faces it ends between them") {
  const auto facing = [&](double angle) {
    // the first pushes along x; the second's normal is turned by the angle, and lies in the way
    const ObjectPoint first = answer(-0.2, {1, 0, 0}, Vector3(0.1, 0, 0), 0.25),
                      second = answer(0.05, {std::cos(angle), std::sin(angle), 0},
                                      Vector3(0, 0.2, 0), 0.5);
    const MovingPoint point = moving({-0.3, 0.2, 0.4}, step, 0.5);
    const Vector3 one = forecast_velocity(first, point.v, 0.5);
    const Vector3 in_turn = forecast_velocity(second, one, 0.5);
    REQUIRE_FALSE(near(in_turn, one));
    const Vector3 found = respond("forecast", {second, first}, point);
    const bool is_between = near(found, velocity_between(first, second, point));
    CHECK(is_between != near(found, in_turn));
    return is_between;
  };
  CHECK(facing(pi));
  CHECK(facing(pi * 121 / 180));
  CHECK_FALSE(facing(pi * 119 / 180));
}

TEST_CASE("forecasting holds a point inside two objects between the two deepest") {
  const ObjectPoint a = answer(-0.3, up, {0.2, 0, 0.4}, 0.25),
                    b = answer(-0.1, Vector3(0.6, 0, -0.8), {0, 0.6, -0.2}, 0.5),
                    c = answer(-0.05, Vector3(1, 0, 0), Vector3::Zero(), 0);
  const MovingPoint point = moving({0.7, 1.1, 0.1}, step, 0.5);
  CHECK(respond("forecast", {c, b, a}, point) == velocity_between(a, b, point));
  CHECK(respond("forecast", {c, b}, point) == velocity_between(b, c, point));
  CHECK(respond("forecast_deepest", {c, b, a}, point) == forecast_velocity(a, point.v, 0.5));
  // on the surface of one is not inside it
  const ObjectPoint on = answer(0, Vector3(1, 0, 0), Vector3::Zero(), 0);
  CHECK(near(respond("forecast", {on, a}, point), forecast_velocity(a, point.v, 0.5)));
}

TEST_CASE("projection puts a point that ends inside on the surface, with friction") {
  // found 0.2 deep after a step of 0.5: pushed by 0.4; slides at (0.6, 0.8)
  const ObjectPoint at = answer(-0.2, up, {0.1, 0.3, 0.7}, 0.5);
  const MovingPoint point = moving({0.7, 1.1, -0.1}, step, 9);
  CHECK(near(respond("projection", {at}, point), Vector3(0.7 - 0.2 * 0.6, 1.1 - 0.2 * 0.8, 0.3)));
  CHECK(near(respond("projection", {answer(0.1, {1, 0, 0}, Vector3::Zero(), 9), at}, point),
             Vector3(0.7 - 0.2 * 0.6, 1.1 - 0.2 * 0.8, 0.3)));
  for (const double outside : {0.0, 0.05})
    CHECK(respond("projection", {answer(outside, up, {0.1, 0.3, 0.7}, 0.5)}, point) == point.v);
  // a velocity that ends the step: at 0.8 inwards, the surface is nearer than 0.5 * 0.8 / 1000
  const MovingPoint at_end = moving({0.7, 1.1, -0.1}, ends, 9);
  const Vector3 stopped(0.7 - 0.4 * 0.6, 1.1 - 0.4 * 0.8, 0.7);
  for (const double depth : {-0.2, 0.0, 0.000399})
    CHECK(near(respond("projection", {answer(depth, up, {0.1, 0.3, 0.7}, 0.5)}, at_end), stopped));
  CHECK(respond("projection", {answer(0.000401, up, {0.1, 0.3, 0.7}, 0.5)}, at_end) == at_end.v);
  // one that leads out is kept
  const MovingPoint leaves = moving({0.7, 1.1, 0.9}, ends, 9);
  CHECK(respond("projection", {at}, leaves) == leaves.v);
}

TEST_CASE("a point pushed out is found inside after a step, and leaves in the next") {
  const ObjectPoint at = answer(-0.2, up, {0.1, 0.3, 0.7}, 0.5),
                    other = answer(-0.1, {1, 0, 0}, Vector3::Zero(), 0.5);
  const MovingPoint during = moving({0.7, 1.1, -0.1}, step, 9), after = moving(during.v, ends, 9);
  CHECK(respond("push_out", {at}, during) == during.v);
  CHECK(respond("push_out", {other, at}, after) == forecast_velocity(at, after.v, 0.5));
  CHECK(respond("push_out", {answer(0, up, {0.1, 0.3, 9}, 0.5)}, after) == after.v);
}

TEST_CASE("points of the cloth: triangle centres, edge midpoints, particles, in this order") {
  PerParticle3 rest(3, 4);
  rest << 0.1, 1.2, 1.1, -0.2, 0.2, 0.1, 1.3, 0.9, 0.5, 0.6, 0.4, 0.7;
  const TriangleMesh mesh = make_triangle_mesh(rest, {{0, 1, 2}, {0, 2, 3}});
  PerParticle w(4);
  w << 0.3, 0.5, 0, 0.7;
  const auto points = collision_points(mesh, w, PointKind::faces);
  REQUIRE(points.size() == 2 + 5 + 3);
  CHECK(points[0].particles == std::array<int, 3>{0, 1, 2});
  CHECK(points[0].count == 3);
  // equal weights of a third: shares w_i / (sum of w / 3)
  CHECK(near(points[0].shares, Vector3(0.3, 0.5, 0) * 3 / 0.8));
  CHECK(near(points[1].shares, Vector3(0.3, 0, 0.7) * 3 / 1));
  CHECK(near(points[1].mean(rest), (rest.col(0) + rest.col(2) + rest.col(3)) / 3));
  CHECK(points[2].particles == std::array<int, 3>{0, 1, -1});
  CHECK(points[2].count == 2);
  CHECK(near(points[2].shares, Vector3(0.3, 0.5, 0) * 2 / 0.8));
  CHECK(near(points[2].mean(rest), (rest.col(0) + rest.col(1)) / 2));
  std::vector<int> last;
  for (size_t i = 7; i < 10; ++i) {
    last.push_back(points[i].particles[0]);
    CHECK(points[i].count == 1);
    CHECK(near(points[i].shares, Vector3(1, 0, 0)));
    CHECK(points[i].mean(rest) == rest.col(points[i].particles[0]));
  }
  CHECK(last == std::vector<int>{0, 1, 3});
  CHECK(collision_points(mesh, w, PointKind::edges).size() == 5 + 3);
  CHECK(collision_points(mesh, w, PointKind::edges)[0].count == 2);
  CHECK(collision_points(mesh, w, PointKind::particles).size() == 3);
  w << 0, 0, 0, 0.7;  // edge 0-3, 2-3 and one triangle have a free particle
  CHECK(collision_points(mesh, w, PointKind::faces).size() == 1 + 2 + 1);
}

TEST_CASE("the filter corrects points in order, and counts its queries and moving contacts") {
  // a particle about to enter, one far above at rest, a pair of particles, one that flies along
  ObjectCollision filter;
  filter.objects = {floor_at(0.125, Vector3::Zero(), 0)};
  CollisionPoint first, far, pair;
  first.particles[0] = 0, first.count = 1, first.shares = Vector3(1, 0, 0);
  far.particles[0] = 1, far.count = 1, far.shares = Vector3(1, 0, 0);
  pair.particles = {2, 3, -1}, pair.count = 2, pair.shares = Vector3(0.5, 1.5, 0);
  filter.points = {first, far, pair};
  State s;
  s.x = PerParticle3(3, 4);
  s.x << 0.3, 0.4, 0.5, 0.6, 0.1, 0.2, 0.3, 0.4, 0.25, 5, 0.25, 0.5;
  PerParticle3 v(3, 4);
  v << 0.5, 0.1, 0.2, 0.4, 0.3, 0.7, 0.9, 0.8, -1, -0.5, -2, -3;
  Work work;
  work.object_queries = 10, work.object_contacts = 20;
  PerParticle3 now = v;
  filter.correct(step, s, now, work);
  // the particle: to z = 0.125 in 0.5 s; the midpoint, at 0.375 and -2.5: to -0.5, so by 2
  CHECK(near(now.col(0), Vector3(0.5, 0.3, -0.25)));
  CHECK(now.col(1) == v.col(1));
  CHECK(near(now.col(2), v.col(2) + Vector3(0, 0, 1)));
  CHECK(near(now.col(3), v.col(3) + Vector3(0, 0, 3)));
  CHECK(work.object_queries == 13);
  CHECK(work.object_contacts == 22);

  now = v;  // a velocity that ends a step is corrected, too, but is no moving contact
  filter.correct(ends, s, now, work);
  CHECK(near(now.col(0), Vector3(0.5, 0.3, -0.25)));
  CHECK(work.object_queries == 16);
  CHECK(work.object_contacts == 22);

  now = v;  // a forecast time of its own
  filter.forecast_time = 0.25;
  filter.correct(step, s, now, work);
  CHECK(near(now.col(0), Vector3(0.5, 0.3, -0.5)));
  CHECK(near(now.col(2), v.col(2) + Vector3(0, 0, 0.75)));
}

TEST_CASE("the projecting filter asks where the points end, of objects where they end") {
  ObjectCollision filter;
  filter.response = response_named("projection");
  filter.objects = {floor_at(0.125, {0, 0, 0.5}, 0)};  // at 1.5 s: 0.875
  CollisionPoint point;
  point.particles[0] = 0, point.count = 1, point.shares = Vector3(1, 0, 0);
  filter.points = {point};
  State s;
  s.x = Vector3(0.3, 0.1, 1);
  PerParticle3 v = Vector3(0.5, 0.3, -1);
  Work work;
  filter.correct(step, s, v, work);
  CHECK(near(v.col(0), Vector3(0.5, 0.3, -0.25)));  // to 0.875
  CHECK(work.object_contacts == 1);
}

TEST_CASE("points that share no particles are corrected on several threads, others on one") {
  PerParticle3 rest(3, 4);
  rest << 0.1, 1.2, 1.1, -0.2, 0.2, 0.1, 1.3, 0.9, 0.5, 0.6, 0.4, 0.7;
  const TriangleMesh mesh = make_triangle_mesh(rest, {{0, 1, 2}, {0, 2, 3}});
  const PerParticle w = PerParticle::Constant(4, 0.3);
  ObjectCollision filter;
  CHECK(filter.team.threads() == 1);
  CHECK(filter.forecast_time == 0);
  CHECK(filter.response.name == "forecast");
  filter.points = collision_points(mesh, w, PointKind::particles);
  filter.set_team(3, 4);
  CHECK(filter.team.threads() == 3);
  filter.points = collision_points(mesh, w, PointKind::edges);
  filter.set_team(3, 4);
  CHECK(filter.team.threads() == 1);
}

TEST_CASE("many points are corrected in blocks, each once, on any number of threads") {
  const int n = 2 * 8192 + 5;
  ObjectCollision filter;
  filter.objects = {floor_at(0.125, Vector3::Zero(), 0)};
  State s;
  s.x = PerParticle3(3, n);
  for (int i = 0; i < n; ++i) {
    CollisionPoint point;
    point.particles[0] = i, point.count = 1, point.shares = Vector3(1, 0, 0);
    filter.points.push_back(point);
    s.x.col(i) << 0.3, 0.1, 0.25;
  }
  for (const int threads : {1, 3}) {
    filter.team = threads;
    PerParticle3 v(3, n);
    v.colwise() = Vector3(0.5, 0.3, -1);
    Work work;
    filter.correct(step, s, v, work);
    CHECK((v.colwise() - Vector3(0.5, 0.3, -0.25)).cwiseAbs().maxCoeff() < 1e-13);
    CHECK(work.object_queries == n);
    CHECK(work.object_contacts == n);
  }
}

TEST_CASE("a forecast longer than the step, or a step longer than it, is not cut short") {
  ObjectCollision filter;
  filter.objects = {floor_at(0.125, Vector3::Zero(), 0)};
  for (int i = 0; i < 2; ++i) {
    CollisionPoint point;
    point.particles[0] = i, point.count = 1, point.shares = Vector3(1, 0, 0);
    filter.points.push_back(point);
  }
  State s;
  s.x = PerParticle3(3, 2);
  s.x.colwise() = Vector3(0.3, 0.1, 1.125);
  PerParticle3 v(3, 2);
  v.colwise() = Vector3(0.5, 0.3, -1);
  filter.forecast_time = 2;  // within which both enter, in the step neither
  Work work;
  filter.correct(step, s, v, work);
  for (int i = 0; i < 2; ++i) CHECK(near(v.col(i), Vector3(0.5, 0.3, -0.5)));

  // a point is on the surface if it would reach it in a thousandth of the step
  filter.response = response_named("projection");
  filter.forecast_time = 1e-4;
  s.x.row(2).setConstant(0.125 + 0.0003);
  v.colwise() = Vector3(0, 0, -1);
  filter.correct(ends, s, v, work);
  for (int i = 0; i < 2; ++i) CHECK(near(v.col(i), Vector3::Zero()));
}
