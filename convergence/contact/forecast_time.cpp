// forecast-time: where a point is after it was forecast to lie on the surface, and what the
// forecast time does.

#include "convergence/contact/contact_runs.h"
#include "convergence/study.h"
#include "reference/mesh/shapes.h"
#include "verification/oracles/dense_algebra.h"

namespace foldproof {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double radius = 0.3;  // of the ball [m]

/// Particles that nothing holds together, just above the object, all with the same velocity.
Scene swarm(const SceneObject& object, const Vector3& velocity) {
  Scene scene = scene_at_rest(make_sheet({SheetPattern::one_diagonal, 0.3, 0.3, 9, 9}), 0.2);
  scene.objects.push_back(object);
  for (Eigen::Index i = 0; i < scene.x.cols(); ++i) {
    Vector3 p(scene.mesh.rest(0, i) - 0.15, 0.4, scene.mesh.rest(1, i) - 0.15);
    for (int k = 0; k < 40; ++k) {  // down to where they almost touch
      p.y() -= distance_at(scene, p, 0) - 1e-6;
    }
    scene.x.col(i) = p;
    scene.v.col(i) = velocity;
  }
  return scene;
}

SceneObject floor_object(const Motion& motion) {
  SceneObject part = solid_object("floor", HalfSpace{}, 0);
  std::get<RigidObject>(part.object.body).place.rotation =
      oracles::rotation_between(Vector3::UnitZ(), Vector3::UnitY());
  std::get<RigidObject>(part.object.body).motion = motion;
  return part;
}

SceneObject ball_object(const Motion& motion) {
  SceneObject part = solid_object("ball", Sphere{radius}, 0);
  std::get<RigidObject>(part.object.body).motion = motion;
  return part;
}

/// The largest |phi| right after the step in which all points were forecast to lie on
/// the surface [m].
double forecast_miss(const Subject& subject, const Scene& scene, double h) {
  const State end = run_to_end(subject, scene, h, h);
  Worst worst;
  for (Eigen::Index i = 0; i < end.x.cols(); ++i)
    worst.observe(std::abs(distance_at(scene, end.x.col(i), end.time)));
  return worst.value();
}

struct Setting {
  std::string name, words;
  Scene scene;
};

/// Of objects that are curved or turn.
std::vector<Setting> bent_settings() {
  const Vector3 slanting(1.1, -1.7, 0.4);
  Motion moving, turning;
  moving.velocity = {-0.6, 0.8, 0.3};
  turning.velocity = {0.3, 0.2, -0.1};
  turning.angular_velocity = {1.9, -2.7, 1.1};
  turning.center = {0.2, 0.1, 0.3};
  return {{"resting-ball", "a ball at rest", swarm(ball_object({}), slanting)},
          {"moving-ball", "a ball that moves", swarm(ball_object(moving), slanting)},
          {"turning-ball", "a ball on a bent path", swarm(ball_object(turning), slanting)},
          {"turning-plane", "a plane that turns", swarm(floor_object(turning), slanting)}};
}

NamedFinding flat_finding(const Subject& subject) {
  const double h = 0.004;
  const double off = forecast_miss(subject, swarm(floor_object({}), {1.1, -1.7, 0.4}), h);
  return {"forecast-time.exact-on-a-plane",
          "On a plane at rest, a point that is forecast to lie on the surface lies on it after the "
          "step.",
          {{off / (epsilon * (0.4 + 2 * h)), 20, 0, "epsilon of the extent",
            "one multiplication and one addition after the correction, which itself takes a dozen "
            "roundings"},
           Table{{"step", "s"}, {"largest distance from the plane", "m"}}.with_row(h, off)}};
}

/// Error against the step, for one setting.
Table misses(const Subject& subject, const Setting& setting, const std::vector<double>& steps) {
  return refine({{"step", "s"}, {"miss", "m"}}, steps, [&](double h) {
    return std::tuple{h, forecast_miss(subject, setting.scene, h)};
  });
}

/// With what rounding leaves as the floor.
Convergence errors_of(const Table& misses) {
  Convergence errors = convergence_of(misses, "miss");
  errors.floor = 1e-15;
  return errors;
}

NamedFinding order_finding(const Setting& setting, const Table& misses) {
  return {
      "forecast-time.second-order-on-a-" + setting.name,
      "On " + setting.words + ", it misses the surface by the square of the step.",
      {order_verdict(
           errors_of(misses), 2, 2, 0.1,
           "a first-order miss would be off by one: the forecast would then have the wrong "
           "direction or velocity; the next term is smaller by the distance moved in a step over "
           "the radius, a hundredth"),
       misses, "measured is |order - 2| of the last two pairs"}};
}

/// A point that comes down on a floor at forecast time tau: phi shrinks by the factor
/// 1 - h/tau a step.
struct Decay {
  Table heights{{"time", "s"}, {"phi", "m"}};
  double off = 0;  // |factor - derived|, the largest
};

Decay decay_of(const Subject& subject, double tau_over_h) {
  const double h = 0.004;
  Scene scene = swarm(floor_object({}), {0, -0.9, 0});
  scene.x.row(1).setConstant(3e-3);
  scene.collision.forecast_time = tau_over_h * h;
  Decay decay;
  run_to_end(subject, scene, h, 30 * h,
             [&](const State& s) { decay.heights.row(s.time, s.x(1, 0)); });
  const std::vector<double>& phi = decay.heights.numbers("phi");
  Worst off;
  for (size_t n = 0; n + 1 < phi.size(); ++n) {
    const bool is_treated = phi[n] - tau_over_h * h * 0.9 < 0 || n > 6;
    if (is_treated && std::abs(phi[n]) > 1e-6)
      off.observe(std::abs(phi[n + 1] / phi[n] - (1 - 1 / tau_over_h)));
  }
  decay.off = off.value();
  return decay;
}

/// The first step of the same fall with a forecast time of five steps, and with the point put on
/// the object that it would be inside at the next step.
NamedFinding next_step_finding(const Subject& subject) {
  const double h = 0.004, height = 3e-3;
  Table heights{{"response", ""}, {"height after a step", "m"}};
  for (const char* response : {"forecast", "projection"}) {
    Scene scene = swarm(floor_object({}), {0, -0.9, 0});
    scene.x.row(1).setConstant(height);
    scene.collision.response = response;
    scene.collision.forecast_time = 5 * h;
    heights.row(response, run_to_end(subject, scene, h, h).x(1, 0));
  }
  const std::vector<double>& after = heights.numbers("height after a step");
  return {"forecast-time.long-forecast-is-no-step-prediction",
          "With a forecast time of five steps a point is still above a floor that it would have "
          "passed at the next step.",
          {{std::abs(after[1]) / after[0], 1e-6, 0, "1",
            "otherwise it would be on the floor up to rounding; with forecasts four fifths of the "
            "height are left"},
           heights,
           "measured is the height with the next step's object over that with the forecast"}};
}

StudyResult run_forecast_time(const Subject& subject, Tier tier, const Progress& progress) {
  StudyResult result;
  result.findings.push_back(flat_finding(subject));
  std::vector<double> steps = {0.016, 0.008, 0.004, 0.002, 0.001};
  if (tier == Tier::full) steps.insert(steps.end(), {0.0005, 0.00025});
  Figure figure{"miss",
                "How far a point that was forecast to lie on the surface is from it",
                {"step", "s", Scale::log},
                {"distance", "m", Scale::log},
                2,
                "After the step for which the forecast was made. Points slide on a frictionless "
                "ball of radius 0.3 m, or on a frictionless plane."};
  for (const Setting& setting : bent_settings()) {
    const Table of = misses(subject, setting, steps);
    result.findings.push_back(order_finding(setting, of));
    Curve curve = curve_of(setting.words, of, "step", "miss");
    curve.pair_orders = pair_orders(errors_of(of));
    figure.curves.push_back(std::move(curve));
    progress(double(result.findings.size()) / 8);
  }
  result.figures.push_back(figure);

  Figure approach{
      "approach",
      "A point comes down on a floor",
      {"time", "s"},
      {"height", "m"},
      "At 0.9 m/s, steps of 4 ms. The height is multiplied by 1 - h/tau in every step: a longer "
      "forecast time is a softer landing. A forecast time shorter than the step overshoots: the "
      "point is inside after the step, and the push outwards throws it off."};
  Table decays{{"forecast time over the step", "1"}, {"off", "1"}};
  const Decay thrown = decay_of(subject, 0.7);
  approach.curves.push_back(curve_of("tau = 0.7 h", thrown.heights, "time", "phi"));
  for (const double ratio : {1.0, 2.0, 5.0}) {
    const Decay decay = decay_of(subject, ratio);
    approach.curves.push_back(
        curve_of(fmt::format("tau = {} h", ratio), decay.heights, "time", "phi"));
    decays.row(ratio, decay.off);
  }
  result.figures.push_back(approach);
  result.findings.push_back(
      {"forecast-time.decay-is-as-derived",
       "With a forecast time of a step or more, a treated point's distance from a plane is "
       "multiplied by 1 - h/tau in every step.",
       judge_worst(
           decays, 1e-9,
           "heights above a millionth of a metre, known to roundings of 0.4 m: 1e-10 of them")});
  result.findings.push_back(next_step_finding(subject));
  return result;
}

}  // namespace

Study forecast_time_study() {
  return {"forecast-time",
          "A forecast is exact on planes at rest, and of second order on balls and on what turns.",
          {"exact-on-a-plane", "second-order-on-a-resting-ball", "second-order-on-a-moving-ball",
           "second-order-on-a-turning-ball", "second-order-on-a-turning-plane"},
          "BMF03 section 5.2",
          "The response makes a point's forecast exact: phi + tau (v_p - v).N = 0. The point's "
          "true place after that time may differ: the surface curves away under a sliding point, "
          "and the object's normals turn. The forecast time need not be the step: it is the time a "
          "point takes to reach the surface.",
          run_forecast_time};
}

}  // namespace foldproof
