#include "reference/mesh/mesh_frames.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "reference/mesh/mesh_file.h"
#include "reference/mesh/text_file.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;

// A thousand frames of a cloth of 80,000 vertices in double precision.
constexpr std::size_t longest_cache = std::size_t(1) << 31;
constexpr TextLimits cache_limits = {longest_cache, longest_cache};

std::string ending_of(const fs::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

bool is_cache(const std::string& ending) {
  return ending == ".pc2" || ending == ".npz" || ending.starts_with(".usd");
}

/// A file of a sequence, by the last digits of its name without the ending.
struct NumberedFile {
  fs::path path;
  std::string sequence;  // the name with * for the digits, its ending in lower case
  std::string digits;    // without leading zeros; empty: there are none, or it is a cache
  bool is_numbered;
};

NumberedFile numbered(const fs::path& path) {
  const std::string stem = path.stem().string(), ending = ending_of(path);
  const std::size_t last = stem.find_last_of("0123456789");
  if (is_cache(ending) || last == std::string::npos) return {path, stem + ending, "", false};
  const std::size_t first = stem.find_last_not_of("0123456789", last) + 1;
  std::string before = stem.substr(0, first), digits = stem.substr(first, last + 1 - first);
  while (!before.empty() && std::string_view("._- ").find(before.back()) != std::string_view::npos)
    before.pop_back();
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size() - 1));
  return {path, before + "*" + stem.substr(last + 1) + ending, digits, true};
}

using Sequences = std::map<std::string, std::vector<NumberedFile>>;

Sequences sequences_in(const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw InputError(folder +
                     (fs::exists(folder, error) ? ": is no folder" : ": there is no such folder") +
                     "; give one with OBJ or PLY frames, or a .pc2, .npz or .usda file");
  Sequences all;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string(), ending = ending_of(entry->path());
    if (name.starts_with('.') || entry->is_directory(error)) continue;
    if (ending != ".obj" && ending != ".ply" && !is_cache(ending)) continue;
    NumberedFile file = numbered(entry->path());
    all[file.sequence].push_back(std::move(file));
  }
  if (error) throw InputError(folder + ": cannot be read: " + error.message());
  if (all.empty())
    throw InputError(folder + ": holds no frame; frames end in .obj, .ply, .pc2, .npz or .usda");
  return all;
}

/// A file that is called as the sequence, but for its number, is a template or a leftover.
void reject_stray_file(const Sequences& all, const std::string& chosen) {
  const std::size_t star = chosen.find('*');
  if (star == std::string::npos) return;
  const auto stray = all.find(chosen.substr(0, star) + chosen.substr(star + 1));
  if (stray != all.end())
    throw InputError(stray->second.front().path.string() + ": has no number, beside frames " +
                     chosen + " that have one; move it out of the folder");
}

std::vector<NumberedFile> chosen_files(const FrameSource& source) {
  Sequences all = sequences_in(source.path);
  auto chosen = all.begin();
  for (const char* form : {"*.ply", "*.obj", ".npz", ".usda", ".pc2"})
    if (all.size() > 1 && (chosen = all.find(source.preferred + form)) != all.end()) break;
  // without a preferred one the stray file is named, not the number of sequences
  for (const auto& [name, _] : all)
    reject_stray_file(all, chosen == all.end() ? name : chosen->first);
  if (chosen == all.end())
    throw InputError(source.path + ": holds " + std::to_string(all.size()) +
                     " sequences of frames, such as " + all.begin()->first + " and " +
                     std::next(all.begin())->first + "; give a folder with one");
  std::ranges::sort(chosen->second, {}, [](const NumberedFile& file) {
    return std::tuple(file.digits.size(), file.digits, file.path.string());
  });
  return chosen->second;
}

/// Throws InputError naming a number that occurs twice, or the first that is missing: the stride is
/// the smallest that occurs.
void require_even_numbers(const std::vector<NumberedFile>& files, const std::string& remedy) {
  std::vector<long> numbers;
  for (const NumberedFile& file : files) {
    long number = 0;
    const char* const end = file.digits.data() + file.digits.size();
    if (std::from_chars(file.digits.data(), end, number).ec != std::errc()) return;
    numbers.push_back(number);
  }
  long stride = std::numeric_limits<long>::max();
  for (std::size_t k = 1; k < files.size(); ++k) {
    if (numbers[k] == numbers[k - 1])
      throw InputError(files[k - 1].path.string() + " and " + files[k].path.string() +
                       " have the same number; move one of them out of the folder");
    stride = std::min(stride, numbers[k] - numbers[k - 1]);
  }
  for (std::size_t k = 1; k < numbers.size() && !remedy.empty(); ++k)
    if (numbers[k] - numbers[k - 1] != stride)
      throw InputError(files[k].path.string() + ": frame " +
                       std::to_string(numbers[k - 1] + stride) + " is missing before it; " +
                       remedy);
}

MeshFrame read_frame(const std::string& file, double number) {
  MeshFile read = read_mesh_file(file, Needs::vertices);
  return {file, number, read.time, std::move(read.soup.rest), std::move(read.soup.triangles)};
}

std::vector<MeshFrame> read_cache(const std::string& file) {
  const std::string bytes = read_text_file(file, cache_limits), ending = ending_of(file);
  return ending == ".pc2"   ? read_pc2_bytes(bytes, file)
         : ending == ".npz" ? read_npz_bytes(bytes, file)
                            : read_usda_text(bytes, file);
}

void reject_many(std::size_t count, const FrameSource& source) {
  if (count > source.most)
    throw InputError(source.path + ": " + std::to_string(count) + " frames; at most " +
                     std::to_string(source.most) + " are read");
}

}  // namespace

std::vector<MeshFrame> read_mesh_frames(const FrameSource& source) {
  std::string file = source.path;
  std::error_code unknown;
  if (!is_cache(ending_of(file)) || fs::is_directory(file, unknown)) {
    const std::vector<NumberedFile> files = chosen_files(source);
    file = files.front().path.string();
    if (!is_cache(ending_of(file))) {
      reject_many(files.size(), source);
      require_even_numbers(files, source.remedy);
      std::vector<MeshFrame> frames;
      for (const NumberedFile& each : files)
        frames.push_back(read_frame(each.path.string(), double(frames.size())));
      return frames;
    }
  }
  std::vector<MeshFrame> frames = read_cache(file);
  reject_many(frames.size(), source);
  return frames;
}

}  // namespace foldproof
