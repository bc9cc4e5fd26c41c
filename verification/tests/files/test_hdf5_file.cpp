// HDF5 files: what is written is what the library itself reads; damaged files, and ones that claim
// more than they hold, are refused.
#include <catch2/catch.hpp>
#include <functional>
#include <numeric>

#include "verification/files/hdf5_file.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/files/hdf5_listing.h"

namespace foldproof {

namespace {

using Catch::Contains;
using Numbers = std::vector<double>;
using Texts = std::vector<std::string>;

Numbers rising(std::size_t count) {
  Numbers values(count);
  std::iota(values.begin(), values.end(), 7.25);
  return values;
}

/// A new file, in a folder of its own.
struct NewFile {
  ScratchFolder scratch;
  std::string path = scratch.file("a.h5");
  Hdf5 file = Hdf5::create_file(path);
};

/// A dataset is chunked if it has a length of chunks; chunks have a checksum, or are deflated.
struct Layout {
  Lengths chunk = {};
  bool is_deflated = false;
};

/// Adds a dataset of this name, filled with these values if there are some.
void add_set(hid_t file, const char* name, hid_t type, const Lengths& shape, const Layout& of,
             const void* values = nullptr) {
  const hid_t space = made(H5Screate_simple(int(shape.size()), shape.data(), nullptr)),
              layout = made(H5Pcreate(H5P_DATASET_CREATE));
  if (!of.chunk.empty()) {
    made(H5Pset_chunk(layout, int(of.chunk.size()), of.chunk.data()));
    made(of.is_deflated ? H5Pset_deflate(layout, 4) : H5Pset_fletcher32(layout));
  }
  const hid_t set = made(H5Dcreate2(file, name, type, space, H5P_DEFAULT, layout, H5P_DEFAULT));
  if (values) made(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
  H5Dclose(set), H5Pclose(layout), H5Sclose(space);
}

/// A new file that `fill` fills by the C interface.
std::string raw_file(const ScratchFolder& scratch, const std::function<void(hid_t)>& fill) {
  const std::string path = scratch.file("raw.h5");
  { const Hdf5 file = Hdf5::create_file(path); }
  const RawFile raw(path);
  fill(raw);
  return path;
}

void check_damaged(const std::string& path) {
  CHECK_THROWS_WITH(Hdf5::open_file(path), Contains(path + " (it is damaged)"));
}

/// The file is sound, and is refused when the byte where `mark` ends is another.
void check_damage_found(const std::string& path, const std::string& mark) {
  CHECK_NOTHROW(Hdf5::open_file(path));
  damage_after(path, mark);
  check_damaged(path);
}

}  // namespace

TEST_CASE("hdf5: attributes and arrays have their shape, their type and their values") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  const std::vector<int> counts = {-3, 5, 1 << 30, 7, 11, -13};
  const std::vector<unsigned char> marks = {255, 3, 128, 7};
  write_hdf5(path, [&](const Hdf5& file) {
    file.attribute("text", std::string("caf\xc3\xa9 and more"));
    file.attribute("number", -5.375);
    file.attribute("count", -1234567);
    file.attribute("texts", Texts{"first", "", "third one"});
    file.attribute("none", Texts{});
    CHECK(file.read_text("text") == "caf\xc3\xa9 and more");
    file.array("cube", {4, 3, 2}, rising(24).data()).attribute("unit", std::string("kg/s"));
    file.array("counts", {2, 3}, counts.data());
    file.array("marks", {4}, marks.data());
    file.array("one", {}, rising(1).data());
    file.dataset("list", Numbers{2.5, -7, 1e-300});
    file.dataset("empty", Numbers{});
    file.dataset("words", Texts{"some", "more words"});
    file.dataset("no words", Texts{});
    file.array("flat", {3, 0}, rising(1).data());
  });
  Listing expected;
  add_listed(expected, "/", R"(@text = café and more; @number = -5.375; @count = -1234567
    @texts = [3] first |  | third one; cube@unit = kg/s
    counts = [2 x 3] -3 | 5 | 1073741824 | 7 | 11 | -13; marks = [4] 255 | 3 | 128 | 7
    one = 7.25; list = [3] 2.5 | -7 | 1e-300; words = [2] some | more words)");
  expected["/cube"] = array_text({4, 3, 2}, rising(24));
  expected["/empty"] = expected["/no words"] = "[0] ";
  expected["/flat"] = "[3 x 0] ";
  CHECK(difference_of(hdf5_listing(path), expected) == "");
  const Hdf5 file = Hdf5::open_file(path);
  CHECK((file.read_doubles("cube") == rising(24) && file.read_ints("counts") == counts));
  CHECK((file.read_doubles("one") == Numbers{7.25} && file.read_doubles("empty").empty()));
}

TEST_CASE("hdf5: a slash in a name becomes a division slash, in groups and datasets") {
  const NewFile made;
  const Hdf5 group = made.file.group("km/h/s");
  group.dataset("to/day", Numbers{3.5});
  group.array("by/two", {1}, std::vector<int>{9}.data());
  CHECK((made.file.has("km/h/s") && !made.file.has("km")));
  CHECK(group.read_doubles("to/day") == Numbers{3.5});
  CHECK(made.file.open_group("km/h/s").read_ints("by/two") == std::vector<int>{9});
  made.file.flush();
  CHECK(hdf5_listing(made.path).contains("/km\u2215h\u2215s/to\u2215day"));
}

TEST_CASE("hdf5: what cannot be made or read is named") {
  const NewFile made_file;
  const Hdf5& file = made_file.file;
  const std::string nowhere = made_file.scratch.file("missing/a.h5");
  CHECK_THROWS_WITH(Hdf5::create_file(nowhere), Contains(nowhere));
  CHECK_THROWS_WITH(Hdf5::open_file(nowhere), Contains(nowhere + " (it is not there)"));
  file.group("twice");
  file.array("counts", {1}, std::vector<int>{9}.data());
  file.dataset("numbers", Numbers{3, 4});
  file.attribute("number", 3.5);
  file.attribute("texts", Texts{"one", "two"});
  const std::pair<const char*, std::function<void()>> rows[] = {
      {"make twice", [&] { file.group("twice"); }},
      {"make a description", [&] { file.attribute("number", 4); }},
      {"read missing", [&] { file.read_doubles("missing"); }},
      {"read number: it is no text", [&] { file.read_text("number"); }},
      {"read texts: it is no text", [&] { file.read_text("texts"); }},
      {"read numbers: it has another type", [&] { file.read_ints("numbers"); }},
      {"read counts: it has another type", [&] { file.read_doubles("counts"); }}};
  for (const auto& [why, act] : rows)
    CHECK_THROWS_WITH(act(), Catch::Equals(std::string("HDF5: cannot ") + why));
}

TEST_CASE("hdf5: a growing dataset holds every row, with its unit") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  const std::vector<Shape> shapes = {{}, {3}, {4}, {3, 5}, {2, 3, 4}};  // of rows
  Listing expected = {{"/", ""}, {"/empty", "[0 x 3] "}, {"/empty@unit", "J"}};
  {
    const Hdf5 file = Hdf5::create_file(path);
    for (const Shape& row : shapes) {
      const std::string name = std::to_string(row.size()) + (row == Shape{4} ? " more" : "");
      GrowingDataset grown(file, name, "m", row);
      std::size_t size = 1;
      for (const auto length : row) size *= length;
      const Numbers rows = rising(5 * size);
      for (std::size_t i = 0; i < 5; ++i) grown.add(rows.data() + i * size);
      Lengths shape = {5};
      shape.insert(shape.end(), row.begin(), row.end());
      expected["/" + name] = array_text(shape, rows);
      expected["/" + name + "@unit"] = "m";
    }
    GrowingDataset(file, "empty", "J", {3});
  }
  CHECK(difference_of(hdf5_listing(path), expected) == "");
}

TEST_CASE(
    "hdf5: a file that is written whole takes the place of the one before, but of no folder") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5"), partial = path + ".partial",
                    folder = scratch.file("folder");
  scratch.write("a.h5", "as it was");
  write_hdf5(path, [&](const Hdf5& file) {
    CHECK((std::filesystem::exists(partial) && bytes_of_file(path) == "as it was"));
    file.dataset("numbers", Numbers{4.5});
  });
  const auto fail = [](const Hdf5& file) {
    file.group("new");
    throw std::runtime_error("the reason");
  };
  CHECK_THROWS_WITH(write_hdf5(path, fail), Contains(path) && Contains("(the reason)"));
  CHECK_FALSE(std::filesystem::exists(partial));
  CHECK(hdf5_listing(path).at("/numbers") == "[1] 4.5");
  std::filesystem::create_directory(folder);
  CHECK_THROWS_WITH(write_hdf5(folder, [](const Hdf5&) { FAIL("it is written"); }),
                    Contains(folder) && Contains("what is there is no file"));
}

TEST_CASE("hdf5: a dataset may claim no more than its file can hold, packed 2^28 values") {
  const NewFile whole;
  const RawFile raw(whole.path);
  add_set(raw, "flat", H5T_NATIVE_INT, {3, 5, 800}, {});
  add_set(raw, "packed", H5T_NATIVE_INT, {(1ULL << 28) + 1}, {{1024}});
  for (const char* name : {"flat", "packed"})
    CHECK_THROWS_WITH(whole.file.read_ints(name), Contains("claims more than the file can hold"));
  const std::vector<int> same(50000, 77);  // is larger than the file
  add_set(raw, "same", H5T_NATIVE_INT, {50000}, {{50000}, true}, same.data());
  CHECK(whole.file.read_ints("same") == same);
  check_damaged(raw_file(whole.scratch, [&](hid_t to) {
    add_set(to, "claim", H5T_NATIVE_INT, {1ULL << 40, 1ULL << 40}, {{1024, 16}});
  }));
}

TEST_CASE("hdf5: every row of a large dataset is read before the file is trusted") {
  const ScratchFolder scratch;
  const hsize_t width = 1 << 20;  // 16 rows are read at once
  const std::string bytes = "the marked row" + std::string(width, '.');
  for (const hsize_t row : {0, 15, 16, 31, 32}) {
    const std::string path = raw_file(scratch, [&](hid_t raw) {
      add_set(raw, "rows", H5T_NATIVE_UCHAR, {33, width}, {{1, width}});
      const hid_t set = made(H5Dopen2(raw, "rows", H5P_DEFAULT)), space = H5Dget_space(set);
      const hsize_t start[] = {row, 0}, count[] = {1, width};
      H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr);
      const hid_t memory = made(H5Screate_simple(2, count, nullptr));
      made(H5Dwrite(set, H5T_NATIVE_UCHAR, memory, space, H5P_DEFAULT, bytes.data()));
      H5Sclose(memory), H5Sclose(space), H5Dclose(set);
    });
    check_damage_found(path, "the marked row");
  }
}

TEST_CASE(
    "hdf5: attributes are read before the file is trusted, of groups too and after empty ones") {
  for (const bool is_in_group : {false, true}) {
    const ScratchFolder scratch;
    const std::string path = scratch.file("a.h5");
    {
      const Hdf5 file = Hdf5::create_file(path), first = file.group("a"), group = file.group("b");
      const RawFile raw(path);
      const hid_t nothing = H5Screate(H5S_NULL);
      H5Aclose(made(H5Acreate2(raw, "a", H5T_NATIVE_INT, nothing, H5P_DEFAULT, H5P_DEFAULT)));
      H5Sclose(nothing);
      (is_in_group ? group : file).attribute("b", std::string("a text"));
    }
    check_damage_found(path, "GCOL");  // the place of texts
  }
}

}  // namespace foldproof
