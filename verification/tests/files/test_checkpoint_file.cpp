// Checkpoints: every number comes back, and one that is not what was written is left out.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/bodies/content_key.h"
#include "verification/files/checkpoint_file.h"
#include "verification/files/hdf5_file.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/files/raw_hdf5.h"

namespace foldproof {

namespace {

using Catch::Equals;

const RunIdentity mine{"a case", "0123456789abcdef", "foldproof 9.8 fedc"};

State state_specimen(double time, int particles, int bonds) {
  State s;
  s.time = time;
  s.x = PerParticle3(3, particles);
  s.v = PerParticle3(3, particles);
  for (Eigen::Index i = 0; i < s.x.size(); ++i) {
    s.x.data()[i] = time + 10.5 + 1.0 / double(i + 3);
    s.v.data()[i] = -time - 20.5 - 1.0 / double(i + 7);
  }
  for (int k = 0; k < bonds; ++k)
    s.bonds.push_back({3 + k, 11 + 2 * k, 29 + 3 * k, {0.125 + k, 0.375 + k, 5.5 + k}});
  return s;
}

/// Every number differs from all others.
CheckpointRecord record_specimen(long frame) {
  CheckpointRecord record;
  Checkpoint& c = record.at;
  c.past = {state_specimen(1.25 + double(frame), 4, 2), state_specimen(1.75 + double(frame), 4, 1)};
  c.frame = frame;
  c.steps = 9007199254740991 - frame;  // 2^53 - 1
  c.start_time = -0.1 - double(frame);
  c.size = 1.0 / 3 + double(frame);
  c.event_time = 1e-300;
  c.damping_work = -1e300;
  c.damping_power = 7.125;
  c.seconds = 31.5;
  double next = 1000.5;
  for_each_counter(
      c.work, [&](auto& number) { number = std::remove_reference_t<decltype(number)>(next += 3); });
  for (int k = 0; k < 2 + int(frame); ++k) {
    Diagnostics& row = record.rows.emplace_back();
    for_each_value(
        row, [&](auto& number) { number = std::remove_reference_t<decltype(number)>(next += 5); });
    row.seconds = next += 7;
  }
  return record;
}

std::vector<double> numbers_of(CheckpointRecord record) {
  const Checkpoint& c = record.at;
  std::vector<double> numbers = {double(c.frame), double(c.steps), c.start_time,    c.size,
                                 c.event_time,    c.damping_work,  c.damping_power, c.seconds};
  for_each_counter(c.work, [&](const auto& number) { numbers.push_back(double(number)); });
  for (const Diagnostics& row : record.rows) {
    for_each_value(row, [&](const auto& number) { numbers.push_back(double(number)); });
    numbers.push_back(row.seconds);
  }
  return numbers;
}

bool are_same(const State& a, const State& b) {
  bool same = a.time == b.time && a.x == b.x && a.v == b.v && a.bonds.size() == b.bonds.size();
  for (std::size_t k = 0; same && k < a.bonds.size(); ++k)
    same = a.bonds[k].patch == b.bonds[k].patch && a.bonds[k].triangle == b.bonds[k].triangle &&
           a.bonds[k].particle == b.bonds[k].particle && a.bonds[k].place == b.bonds[k].place;
  return same;
}

void check_same(const CheckpointRecord& a, const CheckpointRecord& b) {
  CHECK(numbers_of(a) == numbers_of(b));
  CHECK(a.rows.size() == b.rows.size());
  REQUIRE(a.at.past.size() == b.at.past.size());
  for (std::size_t k = 0; k < a.at.past.size(); ++k) CHECK(are_same(a.at.past[k], b.at.past[k]));
}

/// What a checkpoint file holds, to be written as it is, sound or not.
struct Parts {
  std::string format = "foldproof checkpoint 2";
  std::vector<double> numbers = numbers_of(record_specimen(0));
  // numbers and bonds of each state
  std::vector<std::pair<std::vector<double>, std::vector<int>>> past = {
      {{0.5, 1, 2, 3, 4, 5, 6, 0.1, 0.2, 0.3}, {7, 8, 9}}};
};

/// Writes the parts with a key that fits them.
void write_parts(const std::string& path, const Parts& parts) {
  ContentKey key;
  for (const std::string& text : {mine.case_text, mine.meshes, mine.program})
    key.add(std::vector<char>(text.begin(), text.end()));
  key.add(parts.numbers);
  write_hdf5(path, [&](const Hdf5& file) {
    file.attribute("format", parts.format);
    file.attribute("case_text", mine.case_text);
    file.attribute("meshes", mine.meshes);
    file.attribute("program", mine.program);
    file.dataset("numbers", parts.numbers);
    const Hdf5 past = file.group("past");
    for (std::size_t k = 0; k < parts.past.size(); ++k) {
      const auto& [numbers, bonds] = parts.past[k];
      key.add(numbers);
      key.add(bonds);
      const Hdf5 state = past.group(std::to_string(k));
      state.dataset("numbers", numbers);
      state.array("bonds", {bonds.size()}, bonds.data());
    }
    file.attribute("content", key.text());
  });
}

/// Why a folder whose only checkpoint is this file refuses it; "" if it does not.
std::string refusal(const ScratchFolder& scratch, const std::string& name) {
  const std::string folder = scratch.file(name), file = folder + "/000000.h5";
  std::string why;
  CheckpointFolder(folder, mine)
      .replay([](const CheckpointRecord&) {}, [&](const std::string& line) { why += line; });
  const std::string head = file + ": this checkpoint is damaged and left out: ";
  if (why.starts_with(head)) return why.substr(head.size());
  return why;
}

std::string refusal_of_parts(const Parts& parts) {
  const ScratchFolder scratch;
  std::filesystem::create_directory(scratch.file("run"));
  write_parts(scratch.file("run/000000.h5"), parts);
  return refusal(scratch, "run");
}

void overwrite(hid_t file, const char* name, std::size_t at, double value) {
  const hid_t set = made(H5Dopen2(file, name, H5P_DEFAULT)), space = H5Dget_space(set);
  std::vector<double> values(std::size_t(H5Sget_simple_extent_npoints(space)));
  made(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  values.at(at) = value;
  made(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  H5Sclose(space);
  H5Dclose(set);
}

void overwrite_text(hid_t file, const char* name, const char* text) {
  const hid_t id = made(H5Aopen(file, name, H5P_DEFAULT)), type = H5Aget_type(id);
  made(H5Awrite(id, type, &text));
  H5Tclose(type);
  H5Aclose(id);
}

const std::string changed = "its content is not what was written";

}  // namespace

TEST_CASE("checkpoints: each frame's numbers, rows, states and bonds come back to the bit") {
  const ScratchFolder scratch;
  const CheckpointFolder folder(scratch.file("new/run"), mine);
  for (const long frame : {0, 1, 2}) folder.write(record_specimen(frame));
  std::vector<CheckpointRecord> visited;
  const auto last = folder.replay([&](const CheckpointRecord& r) { visited.push_back(r); },
                                  [](const std::string& line) { FAIL(line); });
  REQUIRE(visited.size() == 3);
  for (const long frame : {0, 1, 2})
    check_same(visited[std::size_t(frame)], record_specimen(frame));
  REQUIRE(last);
  check_same({*last, {}}, {record_specimen(2).at, {}});
  for (const char* name : {"000000.h5", "000001.h5", "000002.h5"})
    CHECK(std::filesystem::exists(scratch.file("new/run/") + name));
}

TEST_CASE("checkpoints: a file holds the run's identity, the numbers, and arrays of each state") {
  const ScratchFolder scratch;
  const CheckpointRecord record = record_specimen(123456);
  CheckpointFolder(scratch.file("run"), mine).write({record.at, record_specimen(1).rows});
  const RawFile raw(scratch.file("run/123456.h5"));
  CHECK(raw.text("/", "format") == "foldproof checkpoint 2");
  CHECK(raw.text("/", "case_text") == mine.case_text);
  CHECK(raw.text("/", "meshes") == mine.meshes);
  CHECK(raw.text("/", "program") == mine.program);
  CHECK(raw.numbers("numbers") == numbers_of({record.at, record_specimen(1).rows}));
  for (const std::size_t k : {0, 1}) {
    const State& s = record.at.past[k];
    std::vector<double> numbers = {s.time}, bonds;
    numbers.insert(numbers.end(), s.x.data(), s.x.data() + 12);
    numbers.insert(numbers.end(), s.v.data(), s.v.data() + 12);
    for (const Bond& bond : s.bonds) {
      for (int i = 0; i < 3; ++i) numbers.push_back(bond.place[i]);
      for (const int name : {bond.patch, bond.triangle, bond.particle}) bonds.push_back(name);
    }
    CHECK(raw.numbers("past/" + std::to_string(k) + "/numbers") == numbers);
    CHECK(raw.numbers("past/" + std::to_string(k) + "/bonds") == bonds);
  }
  CHECK_FALSE(raw.has("past/2"));
}

TEST_CASE("checkpoints: any number or text that is not what was written is found") {
  using Change = std::function<void(hid_t)>;
  const std::vector<Change> changes = {
      [](hid_t f) { overwrite(f, "numbers", 0, 5); },
      [](hid_t f) { overwrite(f, "numbers", 40, 5); },
      [](hid_t f) { overwrite(f, "past/0/numbers", 7, 5); },
      [](hid_t f) { overwrite(f, "past/1/numbers", 0, 5); },
      [](hid_t f) { overwrite(f, "past/0/bonds", 4, 5); },
      [](hid_t f) { overwrite(f, "past/1/bonds", 0, 5); },
      [](hid_t f) { overwrite_text(f, "case_text", "another case"); },
      [](hid_t f) { overwrite_text(f, "meshes", "other meshes"); },
      [](hid_t f) { overwrite_text(f, "program", "another program"); },
      [](hid_t f) { overwrite_text(f, "content", "0123456789abcdef"); },
      [](hid_t f) { made(H5Ldelete(f, "past/1", H5P_DEFAULT)); }};
  for (std::size_t k = 0; k < changes.size(); ++k) {
    INFO(k);
    const ScratchFolder scratch;
    CheckpointFolder(scratch.file("run"), mine).write(record_specimen(0));
    {
      const RawFile raw(scratch.file("run/000000.h5"), H5F_ACC_RDWR);
      changes[k](raw);
    }
    CHECK(refusal(scratch, "run") == changed);
  }
}

TEST_CASE("checkpoints: a state of any number of particles is whole, even of none") {
  CHECK(refusal_of_parts({}) == "");
  Parts none;
  none.past = {{{0.5, 0.1, 0.2, 0.3}, {7, 8, 9}}};
  CHECK(refusal_of_parts(none) == "");
  none.past = {{{0.5}, {}}};
  CHECK(refusal_of_parts(none) == "");
  Parts two;
  two.past = {{std::vector<double>(13, 2.5), {}}};
  CHECK(refusal_of_parts(two) == "");
}

TEST_CASE("checkpoints: a state whose numbers do not fit its particles and bonds is refused") {
  const std::string why = "a state is not whole";
  const auto with = [](std::size_t numbers, std::size_t bonds) {
    Parts parts;
    parts.past = {{std::vector<double>(numbers, 2.5), std::vector<int>(bonds, 3)}};
    return refusal_of_parts(parts);
  };
  CHECK(with(10, 4) == why);  // one bond and a third
  CHECK(with(10, 5) == why);
  CHECK(with(9, 3) == why);
  CHECK(with(11, 3) == why);
  CHECK(with(13, 3) == why);
  CHECK(with(0, 0) == why);
  // fewer numbers than the bonds have: 3 - 7 is a multiple of 6 modulo 2^64
  CHECK(with(3, 6) == why);
  CHECK(with(6, 6) == why);
}

TEST_CASE("checkpoints: too few numbers, no state, another frame and another version are refused") {
  Parts parts;
  parts.numbers.pop_back();
  CHECK(refusal_of_parts(parts) == "it holds too few numbers");
  parts.numbers.resize(27);
  CHECK(refusal_of_parts(parts) == "it holds too few numbers");
  parts.numbers.resize(28);  // no rows, which is allowed
  CHECK(refusal_of_parts(parts) == "");
  parts.numbers[0] = 1;
  CHECK(refusal_of_parts(parts) == "it is that of another frame");
  parts = {};
  parts.past.clear();
  CHECK(refusal_of_parts(parts) == "it holds no state");
  parts = {};
  parts.format = "foldproof checkpoint 1";
  CHECK(refusal_of_parts(parts) == "it is of another version");
}

}  // namespace foldproof
