#include "verification/files/level_set_folder.h"

#include <filesystem>
#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "verification/files/deforming_content.h"
#include "verification/files/grid_content.h"
#include "verification/files/hdf5_file.h"
#include "verification/files/level_set_cache_file.h"

namespace foldproof {

namespace {

const char* const grid_format = "foldproof grid 1";

void write_grid(const std::string& path, const Grid& grid, const std::string& origin) {
  write_hdf5(path, [&](const Hdf5& file) {
    file.attribute("format", std::string(grid_format));
    file.attribute("origin", origin);
    file.attribute("content", content_key(grid));
    const Lattice& lattice = grid.lattice;
    file.array("nodes", {3}, lattice.nodes.data());
    file.array("corner", {3}, lattice.origin.data()).attribute("unit", std::string("m"));
    file.array("spacing", {1}, &lattice.spacing).attribute("unit", std::string("m"));
    file.array("phi", {grid.phi.size()}, grid.phi.data()).attribute("unit", std::string("m"));
  });
}

/// Throws std::runtime_error saying why the file is refused.
std::shared_ptr<const Grid> read_grid(const std::string& path, const std::string& origin) {
  const Hdf5 file = Hdf5::open_file(path);
  const auto require = [&](bool is_met, const std::string& why) {
    if (!is_met) throw std::runtime_error(path + ": " + why);
  };
  require(file.read_text("format") == grid_format, "it holds no grid of this version");
  require(file.read_text("origin") == origin, "it was computed from another mesh or settings");
  const std::vector<double> corner = file.read_doubles("corner"),
                            spacing = file.read_doubles("spacing");
  const std::vector<int> nodes = file.read_ints("nodes");
  require(corner.size() == 3 && spacing.size() == 1 && nodes.size() == 3,
          "its lattice is not whole");
  const Lattice lattice{
      {corner[0], corner[1], corner[2]}, spacing[0], {nodes[0], nodes[1], nodes[2]}};
  auto grid = std::make_shared<const Grid>(Grid{lattice, file.read_doubles("phi")});
  require(content_key(*grid) == file.read_text("content"), "its content is not what was written");
  require_valid_content(*grid);
  return grid;
}

/// Of cases that run at the same time and name the same body, the second finds the first's file.
std::mutex one_at_a_time;

/// The content of the file, or else a newly built result, which is then written; `read` throws
/// std::runtime_error for a file that it refuses.
template <class Read, class Make, class Write>
auto kept(const std::string& path, const std::function<void(const std::string&)>& log_line,
          const Read& read, const Make& make, const Write& write) {
  const std::lock_guard held(one_at_a_time);
  if (std::filesystem::exists(path)) {
    try {
      auto loaded = read();
      log_line("level sets loaded from " + path);
      return loaded;
    } catch (const std::runtime_error& error) {
      log_line(std::string("level sets computed anew, for a file is refused: ") + error.what());
    }
  }
  auto made = make();
  write(*made);
  log_line("level sets kept in " + path);
  return made;
}

}  // namespace

LevelSetProvider caching_provider(const std::string& folder,
                                  std::function<void(const std::string&)> log_line, int threads) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError(folder + ": cannot make this folder for level sets: " + error.message() +
                     "; choose another --cache");
  const auto file = [folder](const std::string& key) {
    return (std::filesystem::path(folder) / (key + ".h5")).string();
  };
  const LevelSetProvider compute = computing_provider(threads);
  return {[=](const TriangleSoup& soup, const GridMethod& method, Repair repair) {
            const std::string origin = input_key(soup, method, repair), path = file(origin);
            return kept(
                path, log_line, [&] { return read_grid(path, origin); },
                [&] { return compute.make_level_set(soup, method, repair); },
                [&](const Grid& grid) { write_grid(path, grid, origin); });
          },
          [=](const MeshSequence& sequence, const OctreeSettings& settings, BetweenFrames between) {
            const std::string origin = input_key(sequence, settings), path = file(origin);
            const auto read = [&] {
              return std::make_shared<const DeformingBody>(
                  read_level_sets(path, origin, settings, between));
            };
            return kept(
                path, log_line, read,
                [&] { return compute.make_deforming_body(sequence, settings, between); },
                [&](const DeformingBody& body) { write_level_sets(path, body, origin); });
          }};
}

namespace {

/// Results by the key of their input.
template <class Field>
class Remembered {
 public:
  template <class Make>
  std::shared_ptr<const Field> get(const std::string& key, const Make& make) {
    const std::lock_guard lock(one_at_a_time_);
    const auto found = made_.find(key);
    return found != made_.end() ? found->second : made_.emplace(key, make()).first->second;
  }

 private:
  std::mutex one_at_a_time_;
  std::map<std::string, std::shared_ptr<const Field>> made_;
};

}  // namespace

LevelSetProvider memoizing_provider(const LevelSetProvider& provider) {
  const auto grids = std::make_shared<Remembered<Grid>>();
  const auto bodies = std::make_shared<Remembered<DeformingBody>>();
  return {[=](const TriangleSoup& soup, const GridMethod& method, Repair repair) {
            return grids->get(input_key(soup, method, repair),
                              [&] { return provider.make_level_set(soup, method, repair); });
          },
          [=](const MeshSequence& sequence, const OctreeSettings& settings, BetweenFrames between) {
            return bodies->get(input_key(sequence, settings) + std::to_string(int(between)), [&] {
              return provider.make_deforming_body(sequence, settings, between);
            });
          }};
}

}  // namespace foldproof
