#include "scripts/program/frame_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string_view>

#include "reference/mesh/mesh_frames.h"
#include "reference/mesh/text_file.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;

/// Numbers, one a line; blank lines and those that begin with # do not count.
std::vector<double> times_in(const std::string& file) {
  std::istringstream lines(plain_text(read_text_file(file, table_text_limits), file));
  std::vector<double> times;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    const std::size_t last = line.find_last_not_of(" \t\r") + 1;
    double time = 0;
    const auto [end, error] = std::from_chars(line.data() + first, line.data() + last, time);
    if (error != std::errc() || end != line.data() + last || !std::isfinite(time))
      throw InputError(
          fmt::format("{}:{}: is no time in seconds; write one number a line", file, number));
    times.push_back(time);
  }
  return times;
}

/// Beside the frames: in their folder, or in that of their cache.
std::string times_beside(const std::string& path) {
  const fs::path folder = fs::is_directory(path) ? fs::path(path) : fs::path(path).parent_path();
  return (folder / "times.txt").string();
}

/// A cache knows its times better than a file beside it; OBJ and PLY files come one by one.
bool is_cache_with_times(const std::vector<MeshFrame>& frames) {
  const auto has_time = [](const MeshFrame& frame) { return frame.time.has_value(); };
  return !fs::exists(frames.front().file) && std::ranges::all_of(frames, has_time);
}

std::vector<double> times_of(const std::string& path, const FrameTimes& typed,
                             const std::vector<MeshFrame>& frames) {
  std::vector<double> times;
  if (!typed.file.empty()) return times_in(typed.file);
  if (typed.rate > 0) {
    for (const MeshFrame& frame : frames)
      times.push_back(typed.start + (frame.number - frames.front().number) / typed.rate);
    return times;
  }
  const std::string beside = times_beside(path);
  if (!is_cache_with_times(frames) && fs::exists(beside)) return times_in(beside);
  for (const MeshFrame& frame : frames) {
    if (!frame.time)
      throw InputError(frame.file + ": its time is not known; give --times FILE or --rate FPS");
    times.push_back(*frame.time);
  }
  return times;
}

}  // namespace

std::vector<TimedMesh> read_frames(const std::string& path, const FrameTimes& typed,
                                   const std::string& preferred) {
  const bool is_counted = typed.file.empty() && typed.rate > 0;
  std::vector<MeshFrame> frames = read_mesh_frames(
      {.path = path,
       .preferred = preferred,
       .remedy = is_counted ? "--rate needs evenly numbered frames, --times FILE states the time "
                              "of each"
                            : ""});
  const std::vector<double> times = times_of(path, typed, frames);
  if (times.size() != frames.size())
    throw InputError(fmt::format("{}: {} times for {} frames; give one time a frame", path,
                                 times.size(), frames.size()));
  std::vector<TimedMesh> all;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    MeshFrame& frame = frames[k];
    if (k > 0 && !(times[k] > times[k - 1]))
      throw InputError(fmt::format("{}: time {:g} s does not come after {:g} s; times must ascend",
                                   frame.file, times[k], times[k - 1]));
    all.push_back({frame.file, times[k], std::move(frame.x), std::move(frame.triangles)});
  }
  return all;
}

}  // namespace foldproof
