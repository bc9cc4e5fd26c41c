#include "scripts/program/frame_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <sstream>

#include "reference/mesh/mesh_file.h"
#include "reference/mesh/text_file.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;

/// Files by the name of their sequence: what stands before the number, and the ending.
using Sequences = std::map<std::string, std::vector<fs::path>>;

/// The digits that a name without its ending ends with.
std::string number_of(const fs::path& file) {
  const std::string stem = file.stem().string();
  return stem.substr(stem.find_last_not_of("0123456789") + 1);
}

std::string sequence_of(const fs::path& file) {
  std::string stem = file.stem().string();
  stem.resize(stem.size() - number_of(file).size());
  while (!stem.empty() && std::string_view("._- ").find(stem.back()) != std::string_view::npos)
    stem.pop_back();
  return stem;
}

/// Whether a comes before b, by their numbers, of any length.
bool comes_before(const fs::path& a, const fs::path& b) {
  const auto key = [](const fs::path& file) {
    std::string digits = number_of(file);
    digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size()));
    return std::tuple(digits.size(), digits, file.string());
  };
  return key(a) < key(b);
}

Sequences sequences_in(const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw InputError(folder + ": there is no such folder; give one with OBJ or PLY frames");
  Sequences all;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path& file = entry->path();
    if (file.extension() == ".obj" || file.extension() == ".ply")
      all[sequence_of(file) + "*" + file.extension().string()].push_back(file);
  }
  if (error) throw InputError(folder + ": cannot be read: " + error.message());
  return all;
}

std::vector<fs::path> frame_files(const std::string& folder, const std::string& preferred) {
  Sequences all = sequences_in(folder);
  if (all.empty()) throw InputError(folder + ": holds no frame; frames end in .obj or .ply");
  auto chosen = all.begin();
  if (all.size() > 1) {
    chosen = all.find(preferred + "*.ply");
    if (chosen == all.end()) chosen = all.find(preferred + "*.obj");
  }
  if (chosen == all.end())
    throw InputError(
        fmt::format("{}: holds {} sequences of frames, such as {} and {}; give a folder with one",
                    folder, all.size(), all.begin()->first, std::next(all.begin())->first));
  std::ranges::sort(chosen->second, comes_before);
  return chosen->second;
}

/// The number that the frame's file ends with; none if it has no digits, or too many.
std::optional<long> frame_number(const fs::path& file) {
  const std::string digits = number_of(file);
  long number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || digits.empty()) return {};
  return number;
}

/// A rate counts frames, so their numbers must have one stride: the smallest that occurs. Throws
/// InputError naming the first missing number.
void require_even_numbers(const std::vector<fs::path>& files) {
  std::vector<long> numbers;
  for (const fs::path& file : files) {
    const std::optional<long> number = frame_number(file);
    if (!number) return;
    numbers.push_back(*number);
  }
  long stride = std::numeric_limits<long>::max();
  for (std::size_t k = 1; k < numbers.size(); ++k) {
    if (numbers[k] == numbers[k - 1])
      throw InputError(
          fmt::format("{} and {} have the same number; --times FILE states the time of each",
                      files[k - 1].string(), files[k].string()));
    stride = std::min(stride, numbers[k] - numbers[k - 1]);
  }
  for (std::size_t k = 1; k < numbers.size(); ++k)
    if (numbers[k] - numbers[k - 1] != stride)
      throw InputError(
          fmt::format("{}: frame {} is missing before it; --rate needs evenly numbered frames, "
                      "--times FILE states the time of each",
                      files[k].string(), numbers[k - 1] + stride));
}

struct Frame {
  TimedMesh mesh;
  std::optional<double> own_time;  // s
};

Frame read_frame(const fs::path& path) {
  const std::string file = path.string();
  MeshFile read = read_mesh_file(file);
  return {{file, 0, std::move(read.soup.rest), std::move(read.soup.triangles)}, read.time};
}

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

std::vector<double> times_of(const std::string& folder, const FrameTimes& typed,
                             const std::vector<Frame>& frames) {
  const std::string beside = folder + "/times.txt";
  std::vector<double> times;
  if (!typed.file.empty()) return times_in(typed.file);
  if (typed.rate > 0) {
    for (std::size_t k = 0; k < frames.size(); ++k)
      times.push_back(typed.start + double(k) / typed.rate);
    return times;
  }
  if (fs::exists(beside)) return times_in(beside);
  for (const Frame& frame : frames) {
    if (!frame.own_time)
      throw InputError(frame.mesh.file +
                       ": its time is not known; give --times FILE or --rate FPS");
    times.push_back(*frame.own_time);
  }
  return times;
}

}  // namespace

std::vector<TimedMesh> read_frames(const std::string& folder, const FrameTimes& typed,
                                   const std::string& preferred) {
  const std::vector<fs::path> files = frame_files(folder, preferred);
  if (typed.file.empty() && typed.rate > 0) require_even_numbers(files);
  std::vector<Frame> frames;
  for (const fs::path& file : files) frames.push_back(read_frame(file));
  const std::vector<double> times = times_of(folder, typed, frames);
  if (times.size() != frames.size())
    throw InputError(fmt::format("{}: {} times for {} frames; give one time a frame", folder,
                                 times.size(), frames.size()));
  std::vector<TimedMesh> all;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (k > 0 && !(times[k] > times[k - 1]))
      throw InputError(fmt::format("{}: time {:g} s does not come after {:g} s; times must ascend",
                                   frames[k].mesh.file, times[k], times[k - 1]));
    all.push_back(std::move(frames[k].mesh));
    all.back().time = times[k];
  }
  return all;
}

}  // namespace foldproof
