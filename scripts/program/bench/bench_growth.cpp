// How the costs of contact, of objects and of stored frames grow.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "reference/fast/kept_values.h"
#include "reference/dynamics/integrator.h"
#include "reference/filters/filter.h"
#include "scripts/program/bench/bench_load.h"
#include "scripts/program/bench/bench_parts.h"
#include "scripts/program/provenance.h"
#include "verification/files/trajectory_file.h"
#include "verification/processor_time.h"

namespace foldproof {

namespace {

const std::string linear =
    "work is proportional to it: 1; a twentieth is left for data that outgrow the caches";

/// The least processor time of at least three runs that fill a fifth of a second [s]: growth asks
/// for one thread, and other programs disturb it less than the clock.
double least_processor_seconds(const std::function<void()>& run) {
  double least = INFINITY, total = 0;
  for (int k = 0; k < 3 || total < 0.2; ++k) {
    const double start = processor_seconds();
    run();
    const double seconds = processor_seconds() - start;
    least = std::min(least, seconds);
    total += seconds;
  }
  return least;
}

/// Processor seconds against a size.
struct Growth {
  std::string name, of, size;
  std::vector<double> sizes = {}, seconds = {};
};

Record growth_rate(const Growth& growth) {
  return rate(
      growth.name,
      fmt::format(
          "Growth exponent of the time for {}, from {:.0f} to {:.0f} {}: {:.3g} to {:.3g} ms.",
          growth.of, growth.sizes.front(), growth.sizes.back(), growth.size,
          1e3 * growth.seconds.front(), 1e3 * growth.seconds.back()),
      growth_exponent(growth.sizes, growth.seconds), {1.05, "1", "lower", linear});
}

/// A step of eight layers that lie on each other.
double seconds_of_layers(const Scene& scene) {
  const System system = build_system(scene);
  const Integrator& scheme = integrator_named("C");
  State start = start_state(scene);
  const double h = 0.5 * elastic_limit(system, start);
  Work work;
  work.kept = std::make_shared<KeptValues>();
  begin_step(system, start, work);
  return least_processor_seconds([&] { scheme.step(system, {&start, 1}, h, work); });
}

Growth of_layers(double most_particles) {
  Growth growth{"growth-with-self-collision", "a step of scheme C of eight layers in contact",
                "particles"};
  for (const int columns : {35, 110, 349}) {  // 10k, 100k, 980k particles
    const Scene scene = stacked_sheets(columns);
    if (double(scene.x.cols()) > most_particles) break;
    growth.sizes.push_back(double(scene.x.cols()));
    growth.seconds.push_back(seconds_of_layers(scene));
  }
  return growth;
}

/// Spheres side by side under the sheet, one a tile; it just touches them.
std::vector<Object> tiles_of_spheres(const PerParticle3& x, int along, int across) {
  const Vector3 low = x.rowwise().minCoeff(), extent = x.rowwise().maxCoeff() - low;
  const double radius = 0.5 * std::min(extent.x() / along, extent.y() / across);
  std::vector<Object> objects;
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < across; ++j) {
      const Vector3 centre(low.x() + (i + 0.5) * extent.x() / along,
                           low.y() + (j + 0.5) * extent.y() / across, low.z() - radius);
      objects.push_back(
          {fmt::format("ball {} {}", i, j), RigidObject{Sphere{radius}, {}, Motion{}}, 0.3});
      std::get<RigidObject>(objects.back().body).place.translation = centre;
    }
  return objects;
}

Growth of_objects() {
  Growth growth{"growth-with-objects", "a correction of 10,000 particles against spheres",
                "objects"};
  const Load load = make_load(99);
  const PerParticle inverse_mass = PerParticle::Ones(load.scene.x.cols());
  for (const auto& [along, across] : {std::pair(4, 2), {4, 4}, {8, 4}, {8, 8}, {16, 8}}) {
    const ObjectCollision contact{
        tiles_of_spheres(load.state.x, along, across),
        collision_points(load.scene.mesh, inverse_mass, PointKind::particles), responses().front(),
        0};
    Work work;
    PerParticle3 v = load.state.v;
    growth.sizes.push_back(along * across);
    growth.seconds.push_back(least_processor_seconds([&] {
      v = load.state.v;
      contact.correct({0, load.limit / 2, load.limit / 2}, load.state, v, work);
    }));
  }
  return growth;
}

/// Writes that many frames of a small sheet, and deletes them.
double seconds_of_frames(int frames) {
  const Load load = make_load(9);
  const std::string folder =
      (std::filesystem::temp_directory_path() / ("foldproof-bench-" + std::to_string(getpid())))
          .string();
  std::filesystem::create_directories(folder);
  const double start = processor_seconds();
  {
    TrajectoryFile file(folder + "/frames.h5", load.scene, load.system, {}, provenance("bench"));
    State s = load.state;
    for (int k = 0; k < frames; ++k) {
      s.time = 0.001 * k;
      file.add_frame(s);
    }
    file.finish("", 0, {});
  }
  const double seconds = processor_seconds() - start;
  std::filesystem::remove_all(folder);
  return seconds;
}

Growth of_frames(int most_frames) {
  Growth growth{"growth-of-stored-frames", "writing frames of 100 particles", "frames"};
  for (int frames = 1000; frames <= most_frames; frames *= 10) {
    growth.sizes.push_back(frames);
    growth.seconds.push_back(seconds_of_frames(frames));
  }
  return growth;
}

}  // namespace

std::vector<Record> growth_rates(double most_particles) {
  return {growth_rate(of_layers(std::max(most_particles, 1e5))), growth_rate(of_objects()),
          growth_rate(of_frames(most_particles < 1e6 ? 10'000 : 100'000))};
}

}  // namespace foldproof
