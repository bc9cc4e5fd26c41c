// Cloth points against objects: responses, and how far ahead they look.
#include <catch2/catch.hpp>

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

bool near(const Vector3& a, const Vector3& b) { return (a - b).norm() < 1e-13; }

const Span step{1, 1.5, 0.5};

}  // namespace

TEST_CASE("forecasting answers each object in turn, the deepest forecast first") {
  // walls with normals x and y, both to be entered: neither is forgotten
  const ObjectPoint x = answer(0.1, {1, 0, 0}, Vector3::Zero(), 0.5),
                    y = answer(0.05, {0, 1, 0}, Vector3::Zero(), 0.25),
                    z = answer(0.3, up, Vector3::Zero(), 0);
  const MovingPoint point = moving({-0.9, -0.4, 0.8}, step, 0.5);
  // friction: of the deeper, x (forecast -0.35), first
  const Vector3 first = forecast_velocity(x, point.v, 0.5);
  for (const auto& order : {std::vector{x, y, z}, std::vector{z, y, x}, std::vector{y, z, x}}) {
    CHECK(near(respond("forecast", order, point), forecast_velocity(y, first, 0.5)));
    // the deepest or nearest alone is y
    CHECK(near(respond("forecast_deepest", order, point), forecast_velocity(y, point.v, 0.5)));
  }
  CHECK(respond("forecast", {}, point) == point.v);
}

TEST_CASE("forecasting holds a point inside two objects between the two deepest") {
  const ObjectPoint a = answer(-0.3, up, {0.2, 0, 0.4}, 0.25),
                    b = answer(-0.1, Vector3(0.6, 0, -0.8), {0, 0.6, -0.2}, 0.5),
                    c = answer(-0.05, Vector3(1, 0, 0), Vector3::Zero(), 0);
  const MovingPoint point = moving({0.7, 1.1, 0.1}, step, 0.5);
  CHECK(respond("forecast", {c, b, a}, point) == velocity_between(a, b, point));
  // on the surface of one is not inside it
  const ObjectPoint on = answer(0, Vector3(1, 0, 0), Vector3::Zero(), 0);
  CHECK(near(respond("forecast", {on, a}, point), forecast_velocity(a, point.v, 0.5)));
}

TEST_CASE("a forecast longer than the step reaches as far for every point") {
  ObjectCollision filter;
  filter.objects = {{"floor", RigidObject{HalfSpace{}, {}, {}}, 0}};
  filter.forecast_time = 2;  // within which both enter, in the step neither
  filter.points.resize(2);
  for (int i = 0; i < 2; ++i) {
    CollisionPoint& point = filter.points[size_t(i)];
    point.particles[0] = i, point.count = 1, point.shares = Vector3(1, 0, 0);
  }
  State s;
  s.x = Vector3(0.3, 0.1, 1).replicate(1, 2);
  PerParticle3 v = Vector3(0.5, 0.3, -1).replicate(1, 2);
  Work work;
  filter.correct(step, s, v, work);
  for (int i = 0; i < 2; ++i) CHECK(near(v.col(i), Vector3(0.5, 0.3, -0.5)));
}
