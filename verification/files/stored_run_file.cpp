#include "verification/files/stored_run_file.h"

#include <stdexcept>
#include <utility>

#include "verification/files/hdf5_file.h"

namespace foldproof {

namespace {

/// A case text as it is stored: that of the file, and a line "# --set KEY=VALUE" for each override.
Scene scene_of_text(const std::string& text, const std::string& path) {
  const std::string mark = "\n# --set ";
  std::vector<std::string> overrides;
  std::size_t end = text.size(), at = text.rfind(mark);
  while (at != std::string::npos && text.find('\n', at + 1) >= end) {  // the last lines only
    overrides.insert(overrides.begin(), text.substr(at + mark.size(), end - at - mark.size()));
    end = at;
    at = at == 0 ? std::string::npos : text.rfind(mark, at - 1);
  }
  return read_scene_text(text.substr(0, end), path, overrides);
}

}  // namespace

State StoredRun::frame(std::size_t k) const {
  const Eigen::Index particles = scene.mesh.particles();
  const auto of = [&](const std::vector<double>& rows) {
    return PerParticle3(Eigen::Map<const PerParticle3>(
        rows.data() + 3 * particles * Eigen::Index(k), 3, particles));
  };
  return {times[k], of(positions), of(velocities)};
}

PerParticle3 StoredFrames::frame(std::size_t k) const {
  const Eigen::Index particles = Eigen::Index(positions.size() / times.size() / 3);
  return Eigen::Map<const PerParticle3>(positions.data() + 3 * particles * Eigen::Index(k), 3,
                                        particles);
}

StoredFrames read_stored_frames(const std::string& path) {
  StoredFrames run;
  std::vector<int> corners;
  try {
    const Hdf5 file = Hdf5::open_file(path);
    corners = file.open_group("mesh").read_ints("triangles");
    run.times = file.open_group("frames").read_doubles("time");
    run.positions = file.open_group("frames").read_doubles("positions");
  } catch (const std::runtime_error& error) {
    throw InputError(path + ": is no stored simulation: " + error.what());
  }
  if (run.times.empty() || run.positions.size() % (3 * run.times.size()) != 0 ||
      corners.size() % 3 != 0)
    throw InputError(
        path +
        ": its positions are not three a particle in every frame, or its triangles not of three");
  const auto particles = int(run.positions.size() / run.times.size() / 3);
  for (const int corner : corners)
    if (corner < 0 || corner >= particles)
      throw InputError(path + ": a triangle names particle " + std::to_string(corner) + " of " +
                       std::to_string(particles));
  for (std::size_t k = 0; k < corners.size(); k += 3)
    run.triangles.push_back({corners[k], corners[k + 1], corners[k + 2]});
  return run;
}

StoredRun read_stored_run(const std::string& path) {
  StoredRun run;
  try {
    const Hdf5 file = Hdf5::open_file(path);
    const std::string case_file =
        file.read_text("case_folder") + "/" + file.read_text("case_name") + ".toml";
    run.scene = scene_of_text(file.read_text("case_text"), case_file);
    run.scene.title = file.read_text("title");
    const Hdf5 frames = file.open_group("frames");
    run.times = frames.read_doubles("time");
    run.positions = frames.read_doubles("positions");
    run.velocities = frames.read_doubles("velocities");
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw InputError(path + ": is no stored simulation: " + error.what());
  }
  const std::size_t numbers = run.times.size() * 3 * std::size_t(run.scene.mesh.particles());
  if (run.times.empty() || run.positions.size() != numbers || run.velocities.size() != numbers)
    throw InputError(path + ": its frames are not of the " +
                     std::to_string(run.scene.mesh.particles()) + " particles that its case says");
  return run;
}

}  // namespace foldproof
