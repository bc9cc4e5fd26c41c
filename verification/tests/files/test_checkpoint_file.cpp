// Checkpoints: every number comes back, one that is not what was written is left out, and a folder
// of them is used up to its first gap.
#include <catch2/catch.hpp>
#include <fstream>

#include "verification/files/checkpoint_file.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/files/hdf5_listing.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;
using Catch::Contains;
using Numbers = std::vector<double>;

const RunIdentity mine{"a case", "0123", "foldproof 9.8"};

State state_specimen(double time, int bonds) {
  State s;
  s.time = time;
  s.x = s.v = PerParticle3(3, 4);
  for (Eigen::Index i = 0; i < s.x.size(); ++i) {
    s.x.data()[i] = time + 10.5 + 1.0 / double(i + 3);
    s.v.data()[i] = -time - 20.5 - 1.0 / double(i + 7);
  }
  for (int k = 0; k < bonds; ++k)
    s.bonds.push_back({3 + k, 11 + 2 * k, 29 + 3 * k, {0.125 + k, 0.375 + k, 5.5 + k}});
  return s;
}

/// All numbers of a record but those of its states, in the order of its file.
template <class Visit>
void for_each_number(CheckpointRecord& record, const Visit& visit) {
  Checkpoint& c = record.at;
  for (long* count : {&c.frame, &c.steps}) visit(*count);
  for (double* value :
       {&c.start_time, &c.size, &c.event_time, &c.damping_work, &c.damping_power, &c.seconds})
    visit(*value);
  for_each_counter(c.work, visit);
  for (Diagnostics& row : record.rows) {
    for_each_value(row, visit);
    visit(row.seconds);
  }
}

/// Every number differs from all others.
CheckpointRecord record_specimen(long frame) {
  CheckpointRecord record;
  record.at.past = {state_specimen(1.25 + double(frame), 2),
                    state_specimen(1.75 + double(frame), 1)};
  record.rows.resize(2 + std::size_t(frame));
  double next = 1000.1;
  for_each_number(
      record, [&](auto& number) { number = std::remove_reference_t<decltype(number)>(next += 3); });
  record.at.frame = frame;
  record.at.steps = 9007199254740991 - frame;  // 2^53 - 1
  record.at.event_time = 1e-300, record.at.damping_work = -1e300;
  return record;
}

Numbers numbers_of(CheckpointRecord record) {
  Numbers numbers;
  for_each_number(record, [&](const auto& number) { numbers.push_back(double(number)); });
  return numbers;
}

Numbers numbers_of(const State& s) {
  Numbers numbers = {s.time};
  for (const PerParticle3* x : {&s.x, &s.v})
    numbers.insert(numbers.end(), x->data(), x->data() + x->size());
  for (const Bond& b : s.bonds)
    numbers.insert(numbers.end(), {double(b.patch), double(b.triangle), double(b.particle),
                                   b.place[0], b.place[1], b.place[2]});
  return numbers;
}

void check_same(const CheckpointRecord& a, const CheckpointRecord& b) {
  CHECK(numbers_of(a) == numbers_of(b));
  REQUIRE(a.at.past.size() == b.at.past.size());
  for (std::size_t k = 0; k < a.at.past.size(); ++k)
    CHECK(numbers_of(a.at.past[k]) == numbers_of(b.at.past[k]));
}

/// A folder of checkpoints of this run.
struct RunFolder {
  ScratchFolder scratch;
  CheckpointFolder folder{scratch.file("run"), mine};

  explicit RunFolder(long frames = 0) {
    for (long frame = 0; frame < frames; ++frame) folder.write(record_specimen(frame));
  }
  std::string path(long frame) const { return scratch.file(fmt::format("run/{:06}.h5", frame)); }
  void damage(long frame) const { std::ofstream(path(frame)) << "x"; }
  bool has(long frame) const { return fs::exists(path(frame)); }

  struct Replayed {
    std::vector<CheckpointRecord> records;
    std::string log;
    std::optional<Checkpoint> last;
  };
  Replayed replay() const {
    Replayed r;
    r.last = folder.replay([&](const CheckpointRecord& one) { r.records.push_back(one); },
                           [&](const std::string& line) { r.log += line; });
    return r;
  }
};

}  // namespace

TEST_CASE("checkpoints: each frame's numbers, rows, states and bonds come back to the bit") {
  const RunFolder run(3);
  const RunFolder::Replayed r = run.replay();
  REQUIRE((r.log == "" && r.records.size() == 3 && r.last));
  for (const long frame : {0, 1, 2}) {
    check_same(r.records[std::size_t(frame)], record_specimen(frame));
    CHECK(run.has(frame));
  }
  check_same({*r.last, {}}, {record_specimen(2).at, {}});
}

TEST_CASE("checkpoints: any number or text that is not what was written is found") {
  const std::pair<const char*, std::size_t> changes[] = {
      {"numbers", 40}, {"past/1/numbers", 0}, {"past/0/bonds", 4}, {"@case_text", 0},
      {"@meshes", 0},  {"@program", 0},       {"@content", 0},     {"past/1", 0}};
  for (const auto& [name, at] : changes) {
    INFO(name << " " << at);
    const RunFolder run(1);
    {
      const RawFile raw(run.path(0));
      if (name[0] == '@')
        overwrite_text(raw, name + 1, "another");
      else if (std::string(name) == "past/1")
        made(H5Ldelete(raw, name, H5P_DEFAULT));
      else
        overwrite(raw, name, at, 5);
    }
    CHECK_THAT(run.replay().log, Contains("damaged and left out: its content is not what was"));
  }
  const RunFolder run(2);
  fs::rename(run.path(1), run.path(0));
  CHECK_THAT(run.replay().log, Contains("another frame"));
  run.folder.write({});
  CHECK_THAT(run.replay().log, Contains("no state"));
  run.folder.write(record_specimen(0));
  overwrite_text(RawFile(run.path(0)), "format", "foldproof checkpoint 1");
  CHECK_THAT(run.replay().log, Contains("another version"));
}

TEST_CASE("checkpoints: those of another case, other meshes or another program are named") {
  const RunFolder run(2);
  const std::string text = "another case text, or other overrides", meshes = "other meshes",
                    program = "another program (foldproof 9.8, this is new)";
  const std::vector<std::pair<RunIdentity, std::string>> others = {
      {{"b", "0123", "foldproof 9.8"}, text},
      {{"a case", "b", "foldproof 9.8"}, meshes},
      {{"a case", "0123", "new"}, program},
      {{"b", "b", "new"}, text + "; " + meshes + "; " + program}};
  for (const auto& [identity, differs] : others) {
    const CheckpointFolder folder(run.scratch.file("run"), identity);
    CHECK_THROWS_AS(folder.replay({}, {}), InputError);
    CHECK_THROWS_WITH(folder.replay({}, {}),
                      Contains(run.path(0)) && Contains(" is of " + differs + ". "));
    const auto kept = folder.kept_run();
    REQUIRE(kept);
    CHECK((kept->differs == differs && kept->frame == 1));
  }
  CHECK(run.has(1));
}

TEST_CASE(
    "checkpoints: a folder is replayed up to the first damaged one, which goes with the rest") {
  const RunFolder run(5);
  run.damage(3);
  const RunFolder::Replayed r = run.replay();
  REQUIRE((r.records.size() == 3 && r.last));
  CHECK_THAT(r.log, Catch::StartsWith(run.path(3) + ": ") && Contains("left out: HDF5"));
  CHECK((r.last->frame == 2 && run.has(2) && !run.has(3) && !run.has(4)));
  fs::remove(run.path(1));  // after a gap
  CHECK(run.replay().records.size() == 1);
  CHECK((run.has(0) && !run.has(2)));
  fs::remove(run.path(0));
  for (int twice = 0; twice < 2; ++twice) {
    const RunFolder::Replayed none = run.replay();
    CHECK((!none.last && none.log.empty()));
    CHECK_FALSE(fs::exists(run.scratch.file("run")));
  }
}

TEST_CASE("checkpoints: the run that is kept is that of the last sound one before a gap") {
  const RunFolder run;
  CHECK_FALSE(run.folder.kept_run());
  const auto check_kept = [&](long frame, double time) {
    const auto kept = run.folder.kept_run();
    REQUIRE(kept);
    CHECK((kept->frame == frame && kept->time == time && kept->differs == ""));
  };
  for (const long frame : {0, 1, 2, 3, 4}) run.folder.write(record_specimen(frame));
  check_kept(4, 5.75);
  run.damage(4), run.damage(3);
  check_kept(2, 3.75);
  fs::remove(run.path(2));
  check_kept(1, 2.75);
  for (const long frame : {0, 1}) run.damage(frame);
  check_kept(-1, 0);
  CHECK(run.has(4));
}

TEST_CASE(
    "checkpoints: from one on they are removed, partial ones all, files of other names never") {
  const RunFolder run;
  fs::create_directory(run.scratch.file("run"));
  // removed from 5 on are those that end in '+', from 0 on those in '-' too
  std::istringstream names(
      "000005.h5+ 1234567.h5+ 000000.h5.partial+ 000009.h5.partial+ 000000.h5- 000004.h5- "
      "00007.h5 00008x.h5 x00007.h5 -00007.h5 000007.txt notes.partial 000007.partial 000007 "
      "000007.txt.partial 99999999999999999999.h5 00007.h5.partial");
  std::map<std::string, long> files;  // by name; the first one to remove so that it stays
  for (std::string name; names >> name;) {
    const char kind = name.back();
    if (kind == '+' || kind == '-') name.pop_back();
    files[run.scratch.write("run/" + name, "x")] = kind == '+' ? 9 : kind == '-' ? 5 : 0;
  }
  for (const long first : {5, 0}) {
    run.folder.remove_from(first);
    for (const auto& [path, stays_from] : files) {
      INFO(path);
      CHECK(fs::exists(path) == (first >= stays_from));
    }
  }
}

}  // namespace foldproof
