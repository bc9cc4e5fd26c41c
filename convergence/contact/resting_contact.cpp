// resting-contact: cloth comes to rest on a ball under each response: what keeps moving, and
// what lies inside.

#include "convergence/contact/contact_runs.h"
#include "convergence/study.h"

namespace foldproof {

namespace {

constexpr double end = 1.1, settled = 0.9;  // of the run, and from when on it should be still [s]

/// Result of the same fall with one response.
struct Rest {
  std::string response;
  Table speeds{{"time", "s"}, {"speed", "m/s"}};  // root mean square over the particles
  // root mean square change of a particle's velocity in a step, over the step, after
  // `settled` [m/s^2]
  double jitter = 0;
  double speed = 0;  // largest of speeds after `settled` [m/s]
  double depth = 0;  // largest of a particle [m]
};

Scene cloth_over_ball(const std::string& response) {
  Scene scene = level_sheet(8, 0.34, {0.01, 0.203, -0.02});
  scene.stretch->damping = 0.3;
  scene.objects.push_back(solid_object("ball", Sphere{0.2}, 0.5));
  scene.collision.response = response;
  return scene;
}

Rest rest_of(const Subject& subject, const std::string& response) {
  const Scene scene = cloth_over_ball(response);
  const double h = usual_step(scene);
  Rest rest{response};
  PerParticle3 before = scene.v;
  double sum = 0;
  long steps = 0;
  Worst depth, speed;
  run_to_end(subject, scene, h, end, [&](const State& s) {
    const double speed_now = std::sqrt(s.v.squaredNorm() / double(s.v.cols()));
    rest.speeds.row(s.time, speed_now);
    depth.observe(depths_of(scene, s).particles);
    if (s.time > settled) {
      sum += (s.v - before).squaredNorm() / double(s.v.cols()) / (h * h);
      ++steps;
      speed.observe(speed_now);
    }
    before = s.v;
  });
  rest.jitter = std::sqrt(sum / double(steps));
  rest.speed = speed.value();
  rest.depth = depth.value();
  return rest;
}

Table compare(const std::vector<Rest>& rests) {
  Table table("response; shaking at rest [m/s^2]; speed at rest [m/s]; largest depth [m]");
  for (const Rest& rest : rests) table.row(rest.response, rest.jitter, rest.speed, rest.depth);
  return table;
}

constexpr const char* what_is_measured =
    "shaking is the root mean square acceleration from 0.9 s on";

NamedFinding quieter(const Rest& forecast, const Rest& push_out) {
  return {
      "resting-contact.quieter-than-push-out",
      "Cloth at rest shakes less than half as much under forecasting as when points found inside "
      "are pushed out.",
      {{forecast.jitter / push_out.jitter, 0.5, 0, "1",
        "two responses that are equally good differ by a twentieth here; half is far beyond that"},
       compare({forecast, push_out}),
       what_is_measured}};
}

NamedFinding alike(const Rest& forecast, const Rest& projection) {
  return {
      "resting-contact.projection-is-as-quiet",
      "Cloth at rest shakes as much under forecasting as when points are put on the surface after "
      "each step and lose their velocity into it.",
      {{std::abs(forecast.jitter / projection.jitter - 1), 0.1, 0, "1",
        "empirical: which of two like motions shakes more is chance; runs differ by a twentieth"},
       compare({forecast, projection}),
       what_is_measured}};
}

StudyResult run_resting_contact(const Subject& subject, Tier, const Progress& progress) {
  StudyResult result;
  std::vector<Rest> rests;
  Figure figure{"speed",
                "Cloth comes to rest on a ball",
                {"time", "s"},
                {"speed", "m/s", Scale::log},
                "Root mean square over the particles."};
  for (const char* response : {"forecast", "projection", "push_out"}) {
    rests.push_back(rest_of(subject, response));
    figure.curves.push_back(curve_of(response, rests.back().speeds, "time", "speed"));
    progress(double(rests.size()) / 3);
  }
  result.findings = {quieter(rests[0], rests[2]), alike(rests[0], rests[1])};
  result.figures.push_back(std::move(figure));
  result.tables.push_back({"responses", "Cloth on a ball, by response", compare(rests)});
  return result;
}

}  // namespace

Study resting_contact_study() {
  return {
      "resting-contact",
      "Cloth that lies on a ball shakes less than half as much under forecasting as when it is "
      "pushed out, and as much as when it is projected after each step.",
      {"quieter-than-push-out", "projection-is-as-quiet"},
      "BMF03 section 5.2",
      "A sheet falls on a ball and hangs over it. The paper's response corrects velocities before "
      "the cloth moves; the two responses compared with it act on positions after the move.",
      run_resting_contact};
}

}  // namespace foldproof
