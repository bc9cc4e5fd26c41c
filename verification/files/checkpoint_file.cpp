#include "verification/files/checkpoint_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "verification/files/content_key.h"
#include "verification/files/hdf5_file.h"

namespace foldproof {

namespace {

const char* const checkpoint_format = "foldproof checkpoint 2";

/// Writes numbers one after the other, or reads them back; one list of fields serves both ways.
class Numbers64 {
 public:
  Numbers64() = default;
  explicit Numbers64(std::vector<double> stored) : values_(std::move(stored)), reads_(true) {}

  void pass(double& value) {
    if (reads_)
      value = next();
    else
      values_.push_back(value);
  }
  void pass(long& value) {  // exact up to 2^53
    if (reads_)
      value = long(next());
    else
      values_.push_back(double(value));
  }

  const std::vector<double>& values() const { return values_; }
  bool is_used_up() const { return at_ == values_.size(); }

 private:
  double next() {
    if (at_ == values_.size()) throw std::runtime_error("it holds too few numbers");
    return values_[at_++];
  }

  std::vector<double> values_;
  std::size_t at_ = 0;
  bool reads_ = false;
};

void pass(Diagnostics& row, Numbers64& numbers) {
  for_each_value(row, [&](auto& number) { numbers.pass(number); });
  numbers.pass(row.seconds);
}

/// All of a checkpoint but the states.
void pass(Checkpoint& c, Numbers64& numbers) {
  for (long* count : {&c.frame, &c.steps}) numbers.pass(*count);
  for (double* value :
       {&c.start_time, &c.size, &c.event_time, &c.damping_work, &c.damping_power, &c.seconds})
    numbers.pass(*value);
  for_each_counter(c.work, [&](auto& number) { numbers.pass(number); });
}

std::vector<double> numbers_of(const CheckpointRecord& record) {
  Numbers64 numbers;
  CheckpointRecord copy{record.at, record.rows};
  pass(copy.at, numbers);
  for (Diagnostics& row : copy.rows) pass(row, numbers);
  return numbers.values();
}

/// A state as two arrays: time, positions, velocities, places of bonds; and patch, triangle and
/// particle of each bond.
struct StateArrays {
  std::vector<double> numbers;
  std::vector<int> bonds;
};

StateArrays arrays_of(const State& s) {
  StateArrays arrays{{s.time}, {}};
  for (const PerParticle3* part : {&s.x, &s.v})
    arrays.numbers.insert(arrays.numbers.end(), part->data(), part->data() + part->size());
  for (const Bond& bond : s.bonds) {
    arrays.numbers.insert(arrays.numbers.end(), bond.place.data(), bond.place.data() + 3);
    arrays.bonds.insert(arrays.bonds.end(), {bond.patch, bond.triangle, bond.particle});
  }
  return arrays;
}

State state_of(const StateArrays& arrays) {
  const std::size_t bonds = arrays.bonds.size() / 3, numbers = arrays.numbers.size();
  if (arrays.bonds.size() % 3 != 0 || numbers < 1 + 3 * bonds || (numbers - 1 - 3 * bonds) % 6 != 0)
    throw std::runtime_error("a state is not whole");
  const auto particles = Eigen::Index((numbers - 1 - 3 * bonds) / 6);
  const double* at = arrays.numbers.data();
  State s;
  s.time = *at++;
  s.x = Eigen::Map<const PerParticle3>(at, 3, particles);
  s.v = Eigen::Map<const PerParticle3>(at + 3 * particles, 3, particles);
  at += 6 * particles;
  for (std::size_t k = 0; k < bonds; ++k, at += 3) {
    const int* names = arrays.bonds.data() + 3 * k;
    s.bonds.push_back({names[0], names[1], names[2], {at[0], at[1], at[2]}});
  }
  return s;
}

/// A checkpoint as it is stored.
struct StoredCheckpoint {
  RunIdentity identity;
  std::vector<double> numbers;
  std::vector<StateArrays> past;

  std::string content_key() const {
    ContentKey key;
    for (const std::string* text : {&identity.case_text, &identity.meshes, &identity.program})
      key.add(std::vector<char>(text->begin(), text->end()));
    key.add(numbers);
    for (const StateArrays& state : past) {
      key.add(state.numbers);
      key.add(state.bonds);
    }
    return key.text();
  }
};

void write_stored(const Hdf5& file, const StoredCheckpoint& stored) {
  file.attribute("format", std::string(checkpoint_format));
  file.attribute("case_text", stored.identity.case_text);
  file.attribute("meshes", stored.identity.meshes);
  file.attribute("program", stored.identity.program);
  file.attribute("content", stored.content_key());
  file.dataset("numbers", stored.numbers);
  const Hdf5 past = file.group("past");
  for (std::size_t k = 0; k < stored.past.size(); ++k) {
    const Hdf5 state = past.group(std::to_string(k));
    state.dataset("numbers", stored.past[k].numbers);
    state.array("bonds", {stored.past[k].bonds.size()}, stored.past[k].bonds.data());
  }
}

/// Throws std::runtime_error if it is not what was written.
StoredCheckpoint read_stored(const std::string& path) {
  const Hdf5 file = Hdf5::open_file(path);
  if (file.read_text("format") != checkpoint_format)
    throw std::runtime_error("it is of another version");
  StoredCheckpoint stored{
      {file.read_text("case_text"), file.read_text("meshes"), file.read_text("program")},
      file.read_doubles("numbers"),
      {}};
  const Hdf5 past = file.open_group("past");
  for (int k = 0; past.has(std::to_string(k)); ++k) {
    const Hdf5 state = past.open_group(std::to_string(k));
    stored.past.push_back({state.read_doubles("numbers"), state.read_ints("bonds")});
  }
  if (stored.content_key() != file.read_text("content"))
    throw std::runtime_error("its content is not what was written");
  return stored;
}

CheckpointRecord record_of(const StoredCheckpoint& stored) {
  CheckpointRecord record;
  Numbers64 numbers(stored.numbers);
  pass(record.at, numbers);
  while (!numbers.is_used_up()) pass(record.rows.emplace_back(), numbers);
  for (const StateArrays& state : stored.past) record.at.past.push_back(state_of(state));
  if (record.at.past.empty()) throw std::runtime_error("it holds no state");
  return record;
}

/// How `stored` differs from `mine`; "" if they are the same.
std::string difference(const RunIdentity& stored, const RunIdentity& mine) {
  std::string what;
  if (stored.case_text != mine.case_text) what = "another case text, or other overrides";
  if (stored.meshes != mine.meshes) what += std::string(what.empty() ? "" : "; ") + "other meshes";
  if (stored.program != mine.program)
    what += std::string(what.empty() ? "" : "; ") + "another program (" + stored.program +
            ", this is " + mine.program + ")";
  return what;
}

void reject_other(const std::string& path, const RunIdentity& stored, const RunIdentity& mine) {
  if (const std::string what = difference(stored, mine); !what.empty())
    throw InputError(
        path + ": this checkpoint is of " + what +
        ". Resume with what it was made with, or start over with --restart, which deletes it");
}

/// The number in the name of a checkpoint; -1 for other files.
long number_in(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  long number = -1;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  const bool is_one = error == std::errc() && end == stem.data() + stem.size() && number >= 0;
  return is_one && file.extension() == ".h5" && stem.size() >= 6 ? number : -1;
}

void add(const PerParticle3& x, ContentKey& key) {
  key.add(std::uint64_t(x.cols()));
  key.add(x.data(), std::size_t(x.size()));
}

}  // namespace

RunIdentity identity_of(const Scene& scene, const std::string& program) {
  ContentKey key;
  for (const PerParticle3* x : {&scene.mesh.rest, &scene.x, &scene.v}) add(*x, key);
  key.add(scene.mesh.triangles);
  for (const FlatTriangle& flat : scene.mesh.pattern)
    for (const Eigen::Vector2d& corner : flat) key.add(corner.data(), 2);
  if (!scene.fabrics.empty()) key.add(scene.fabrics.of_triangle);
  for (const SceneObject& part : scene.objects) {
    add(part.vertices, key);
    key.add(part.triangles);
    if (part.animation)
      for (const PerParticle3& x : part.animation->positions) add(x, key);
  }
  for (const StickyPatch& patch : scene.sticky) {
    key.add(patch.triangles);
    key.add(patch.particles);
  }
  return {scene.text, key.text(), program};
}

CheckpointFolder::CheckpointFolder(std::string folder, RunIdentity identity)
    : folder_(std::move(folder)), identity_(std::move(identity)) {}

std::string CheckpointFolder::file(long frame) const {
  return fmt::format("{}/{:06}.h5", folder_, frame);
}

void CheckpointFolder::write(const CheckpointRecord& record) const {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw std::runtime_error(folder_ + ": cannot make this folder: " + error.message());
  StoredCheckpoint stored{identity_, numbers_of(record), {}};
  for (const State& s : record.at.past) stored.past.push_back(arrays_of(s));
  write_hdf5(file(record.at.frame), [&](const Hdf5& made) { write_stored(made, stored); });
}

std::optional<Checkpoint> CheckpointFolder::replay(
    const std::function<void(const CheckpointRecord&)>& visit,
    const std::function<void(const std::string&)>& log_line) const {
  std::optional<Checkpoint> last;
  long frame = 0;
  for (; std::filesystem::exists(file(frame)); ++frame) {
    CheckpointRecord record;
    try {
      const StoredCheckpoint stored = read_stored(file(frame));
      reject_other(file(frame), stored.identity, identity_);
      record = record_of(stored);
      if (record.at.frame != frame) throw std::runtime_error("it is that of another frame");
    } catch (const InputError&) {
      throw;
    } catch (const std::exception& error) {
      log_line(file(frame) + ": this checkpoint is damaged and left out: " + error.what());
      break;
    }
    visit(record);
    last = std::move(record.at);
  }
  remove_from(frame);
  return last;
}

std::optional<KeptRun> CheckpointFolder::kept_run() const {
  long frames = 0;
  while (std::filesystem::exists(file(frames))) ++frames;
  if (frames == 0) return std::nullopt;
  for (long frame = frames - 1; frame >= 0; --frame) {
    try {
      const StoredCheckpoint stored = read_stored(file(frame));
      return KeptRun{frame, record_of(stored).at.past.back().time,
                     difference(stored.identity, identity_)};
    } catch (const std::exception&) {  // damaged: the one before it counts
    }
  }
  return KeptRun{};
}

void CheckpointFolder::remove_from(long first) const {
  std::vector<std::pair<long, std::filesystem::path>> found;
  std::error_code ignored;
  const auto status = std::filesystem::status(folder_, ignored);
  if (!std::filesystem::exists(status)) return;
  if (!std::filesystem::is_directory(status))
    throw std::runtime_error(folder_ + ": is no folder; checkpoints would come to lie there");
  for (const auto& entry : std::filesystem::directory_iterator(folder_, ignored)) {
    const std::filesystem::path path = entry.path();
    const bool is_partial = path.extension() == ".partial";
    const long number = number_in(is_partial ? path.parent_path() / path.stem() : path);
    if (number >= first || (is_partial && number >= 0)) found.emplace_back(number, path);
  }
  std::ranges::sort(found, std::greater<>());
  for (const auto& [number, path] : found)
    if (!std::filesystem::remove(path, ignored) && ignored)
      throw std::runtime_error(path.string() + ": cannot be removed: " + ignored.message());
  std::filesystem::remove(folder_, ignored);  // if nothing is left in it
}

}  // namespace foldproof
