// When positions stop being predictable: motions whose growth of small differences is known.
#include <catch2/catch.hpp>
#include <random>

#include "convergence/any_case/predictability.h"
#include "reference/mesh/shapes.h"

using namespace foldproof;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Three particles, so that made-up motions of up to three bodies are runs of a scene.
Scene three_particles() {
  PerParticle3 x(3, 3);
  x << 0, 1, 0, 0, 0, 1, 0, 0, 0;
  Scene scene = scene_at_rest(make_triangle_mesh(x, {{{0, 1, 2}}}), 0.7);
  scene.x = x;
  scene.v = 0 * x;
  return scene;
}

/// Positions of three particles from a function of time and their number.
LevelRun made_up(double end, const std::function<Vector3(double, int)>& place) {
  LevelRun run;
  for (int k = 0; k <= 200; ++k) {
    const double t = end * k / 200;
    run.times.push_back(t);
    run.x.emplace_back(3, 3);
    for (int i = 0; i < 3; ++i) run.x.back().col(i) = place(t, i);
  }
  run.kinetic = run.elastic = run.contacts = std::vector<double>(201, 0);
  return run;
}

Predictability read(const LevelRun& first, const LevelRun& rounding, const LevelRun& error,
                    double size) {
  return predictability(three_particles(), first, {{1e-12, 1}, {size, 1}}, {rounding, error}, 0.1);
}

}  // namespace

TEST_CASE("twins part at their exponent, and the earlier of them ends what is predictable") {
  constexpr double exponent = 4.1;  // 1/s
  const auto run = [&](double apart) {
    return made_up(9, [&, apart](double t, int i) {
      return Vector3(std::sin(t) + apart * std::exp(exponent * t), 0, i);
    });
  };
  const Predictability p = read(run(0), run(1e-12), run(1e-4), 1e-4);
  CHECK(p.growth.rate == Approx(exponent).epsilon(1e-3));
  CHECK(p.horizon == p.error.horizon);
  const double later = std::log(1e-4 / 1e-12) / exponent;  // s
  CHECK(p.rounding.horizon - p.error.horizon == Approx(later).epsilon(1e-3));
}

TEST_CASE("differences of a damped oscillator decay at its rate, and have no horizon") {
  const auto run = [&](double amplitude) {
    return made_up(6, [&, amplitude](double t, int i) {
      return Vector3(std::exp(-0.4 * t) * amplitude * std::cos((7.1 + 1.3 * i) * t), 0, i);
    });
  };
  const Predictability p = read(run(1), run(1 + 1e-12), run(1.001), 1e-3);
  CHECK(p.horizon == infinity);
  CHECK(std::abs(growth_of(p.times, p.error.distances, 1).rate + 0.4) < 0.05);
  LevelRun stopped = run(1);
  stopped.stopped = "an edge lost its length";
  const Predictability cut = read(run(1), run(1), stopped, 1e-3);
  CHECK(std::isnan(cut.horizon));
  CHECK(in_words(cut).find("an edge lost its length") != std::string::npos);
  CHECK(std::isnan(read(run(0), run(0), run(0), 1e-3).horizon));  // at rest
}

TEST_CASE("an exponential's rate and crossing are found") {
  std::vector<double> times, apart;
  for (int k = 0; k < 60; ++k) {
    times.push_back(0.7 + k * 0.1);
    apart.push_back(1e-9 * std::exp(3.3 * 0.1 * k));
  }
  const Growth growth = growth_of(times, apart, 1e-4);
  CHECK(growth.rate == Approx(3.3));
  CHECK(growth.uncertainty < 1e-9);
  CHECK(growth.to < crossing_time(times, apart, 1e-4));
  CHECK(crossing_time({1, 2, 4}, {0.1, 0.3, 0.7}, 0.4) == Approx(2.5));
  CHECK(crossing_time({1, 2, 4}, {0.1, 0.3, 0.7}, 0.9) == infinity);
  CHECK(crossing_time({1, 2, 4}, {0.1, foldproof::nan, 0.7}, 0.9) == 2);
  CHECK(std::isnan(growth_of(times, std::vector<double>(60, 0.0), 1).rate));
}

TEST_CASE("the first level's error is taken before the levels part") {
  const PerParticle mass = PerParticle::Constant(3, 0.2);
  const LevelRun finest = made_up(2, [](double t, int i) { return Vector3(t, i, 0); });
  const LevelRun first =
      made_up(2, [](double t, int i) { return Vector3(t + 1e-3 + (t > 1 ? t - 1 : 0), i, 0); });
  LevelRun cut = finest;
  cut.stopped = "stopped";
  CHECK(error_of_first_level({first, first, finest, cut}, mass, 0.1) == Approx(1e-3));
  CHECK(error_of_first_level({first, finest}, mass, 1e-4) == Approx(1e-3));
}

TEST_CASE("a disturbance has its size, leaves prescribed particles alone and keeps layers apart") {
  Scene scene = scene_at_rest(make_sheet({SheetPattern::alternating, 0.8, 0.5, 9, 6}), 0.3);
  scene.x = scene.mesh.rest;
  scene.v = 0 * scene.x;
  scene.prescribed = {{4, scene.x.col(4), {}}, {11, scene.x.col(11), {}}};
  const PerParticle mass = lumped_masses(scene.mesh, scene.density);
  const double size = largest_disturbance(scene);
  const PerParticle3 u = displacement_of({size, 3}, scene);
  CHECK(std::sqrt(u.colwise().squaredNorm().dot(mass.transpose()) / mass.sum()) == Approx(size));
  CHECK(u.col(4).norm() + u.col(11).norm() == 0);
  CHECK(u == displacement_of({size, 3}, scene));
  CHECK((u - displacement_of({size, 4}, scene)).norm() > 0.3 * u.norm());
  for (const Edge& e : scene.mesh.edges)
    CHECK((u.col(e.a) - u.col(e.b)).norm() < 0.8 * (scene.x.col(e.a) - scene.x.col(e.b)).norm());
}

TEST_CASE("a twin takes the steps of the run that it is compared with") {
  const Level level{"trial", {three_particles(), {}}, {}, 3};
  const auto twin = [&](unsigned seed) {
    return disturbed_level(level, {0.1, 0.3, 1}, {1e-3, seed});
  };
  const Scene scene = twin(2).input_case.scene;
  CHECK(scene.schedule.step.ends == std::vector<double>{0.1, 0.3, 1});
  CHECK(scene.x != level.input_case.scene.x);
  CHECK(key_of(twin(2), "p") != key_of(twin(3), "p"));
}

TEST_CASE("orders are asked before the horizon only") {
  LevelRun run = made_up(2, [](double t, int i) { return Vector3(t, i, 0); }), other = run;
  other.contacts[50] = 7;  // t = 0.5 s
  CHECK(frames_until({run}, 1).front().x.size() == 101);
  Predictability p;
  p.times = run.times;
  p.end = 2;
  p.horizon = 1;
  LadderAnswer answer;
  answer.quantities.resize(4);
  for (QuantityOverLevels& q : answer.quantities) q.bar.reading = Reading::asymptotic;
  answer.quantities[1].bar.reading = Reading::not_asymptotic;
  limit_to_horizon({{"early", "height", {}, Instant::at_time, 0.8},
                    {"late", "height", {}, Instant::at_time, 1.2},
                    {"end", "height"}},
                   {run, other}, p, answer);
  CHECK(answer.quantities[0].bar.reading == Reading::asymptotic);
  CHECK(answer.quantities[1].bar.reading == Reading::not_asymptotic);
  CHECK(answer.quantities[1].bar.reason.find("from t = 0.5 s") != std::string::npos);
  for (const size_t k : {2, 3}) {
    CHECK(answer.quantities[k].bar.reading == Reading::inconclusive);
    CHECK(answer.quantities[k].bar.reason.find("beyond t = 1 s") != std::string::npos);
  }
}

TEST_CASE("statistics are means over the frames beyond the horizon") {
  Scene scene = three_particles();
  scene.gravity = Vector3(0, -9.81, 0);
  LevelRun run = made_up(2, [](double t, int) { return Vector3(0, t > 1 ? 3 : 50, 0); });
  for (size_t k = 0; k < run.times.size(); ++k) {
    run.kinetic[k] = run.times[k] > 1 ? 4 : 1;
    run.elastic[k] = 5, run.contacts[k] = 6;
  }
  const std::vector<MotionStatistic> all = motion_statistics(scene, run, 1);
  for (size_t k = 0; k < 4; ++k) CHECK(all.at(k).value == Approx(3 + double(k)));
}

TEST_CASE("95 of 100 further runs lie within the reach of an ensemble's mean") {
  std::mt19937 bits(7);
  std::normal_distribution<double> normal(3, 0.4);
  const Scene scene = three_particles();
  const auto run = [&] {
    LevelRun one;
    one.times = {0.5};
    one.x = {scene.x};
    one.kinetic = one.contacts = {0};
    one.elastic = {normal(bits)};
    return one;
  };
  CHECK(reach_factor(5) == Approx(2.776 * std::sqrt(1.2)));
  CHECK(reach_factor(13) == Approx(2.179 * std::sqrt(1 + 1.0 / 13)).epsilon(0.002));
  int inside = 0;
  for (int k = 0; k < 4000; ++k)
    inside += statistics_over_runs(scene, {run(), run(), run()}, {run()}, 0)[1].agrees[0];
  INFO(inside << " of 4000");
  CHECK(std::abs(inside - 3800) < 60);  // four standard deviations of such a count
  CHECK_FALSE(statistics_over_runs(scene, {run()}, {run()}, 0)[1].agrees[0]);
}
