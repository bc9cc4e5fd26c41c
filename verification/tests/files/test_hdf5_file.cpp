// HDF5 files: what is written is what the library itself reads, and all that cannot be is refused.
#include <catch2/catch.hpp>
#include <numeric>

#include "verification/files/hdf5_file.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/files/raw_hdf5.h"

namespace foldproof {

namespace {

using Catch::Contains;
using Catch::Equals;
using Lengths = std::vector<hsize_t>;

std::vector<double> rising(std::size_t count) {
  std::vector<double> values(count);
  std::iota(values.begin(), values.end(), 7.25);
  return values;
}

/// Objects of all open files that are open themselves.
long open_objects() { return H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_ALL); }

Lengths chunk_of(hid_t file, const std::string& name) {
  const hid_t set = made(H5Dopen2(file, name.c_str(), H5P_DEFAULT)),
              layout = H5Dget_create_plist(set);
  Lengths chunk(32);
  chunk.resize(std::size_t(H5Pget_chunk(layout, 32, chunk.data())));
  H5Pclose(layout);
  H5Dclose(set);
  return chunk;
}

}  // namespace

TEST_CASE("hdf5: attributes are scalars of variable UTF-8 texts, doubles and ints") {
  const long before = open_objects();
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  {
    const Hdf5 file = Hdf5::create_file(path);
    const Hdf5 group = file.group("some");
    group.attribute("text", std::string("caf\xc3\xa9 and more"));
    group.attribute("number", -5.375);
    group.attribute("count", -1234567);
    group.attribute("texts", std::vector<std::string>{"first", "", "third one"});
    group.attribute("none", std::vector<std::string>{});
    CHECK(group.read_text("text") == "caf\xc3\xa9 and more");
  }
  CHECK(open_objects() == before);
  const RawFile raw(path);
  CHECK(raw.text("some", "text") == "caf\xc3\xa9 and more");
  CHECK(raw.number("some", "number") == -5.375);
  CHECK(raw.number("some", "count") == -1234567);
  CHECK(raw.texts("some", "texts") == std::vector<std::string>{"first", "", "third one"});
  CHECK(H5Aexists_by_name(raw, "some", "none", H5P_DEFAULT) == 0);
  for (const auto& [name, rank] :
       {std::pair("text", 0), {"number", 0}, {"count", 0}, {"texts", 1}}) {
    INFO(name);
    const hid_t id = made(H5Aopen_by_name(raw, "some", name, H5P_DEFAULT, H5P_DEFAULT)),
                space = H5Aget_space(id), type = H5Aget_type(id);
    CHECK(H5Sget_simple_extent_ndims(space) == rank);
    CHECK(H5Sget_simple_extent_type(space) == (rank == 0 ? H5S_SCALAR : H5S_SIMPLE));
    const bool is_text = std::string(name).starts_with("text");
    CHECK(H5Tget_class(type) == (is_text                         ? H5T_STRING
                                 : std::string(name) == "number" ? H5T_FLOAT
                                                                 : H5T_INTEGER));
    if (is_text) {
      CHECK(H5Tis_variable_str(type) == 1);
      CHECK(H5Tget_cset(type) == H5T_CSET_UTF8);
    }
    H5Tclose(type);
    H5Sclose(space);
    H5Aclose(id);
  }
}

TEST_CASE("hdf5: arrays have their shape, row by row, their type, and units of their own") {
  const long before = open_objects();
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  const std::vector<double> values = rising(24);
  const std::vector<int> counts = {-3, 5, 1 << 30, 7, 11, -13};
  const std::vector<unsigned char> marks = {255, 3, 128, 7};
  {
    const Hdf5 file = Hdf5::create_file(path);
    file.array("cube", {4, 3, 2}, values.data()).attribute("unit", std::string("kg/s"));
    file.array("counts", {2, 3}, counts.data());
    file.array("marks", {4}, marks.data());
    file.array("one", {}, &values[5]);
    file.dataset("list", std::vector<double>{2.5, -7, 1e-300});
    file.dataset("single", std::vector<double>{-42.5});
    file.dataset("empty", std::vector<double>{});
    file.dataset("words", std::vector<std::string>{"some", "more words"});
    file.dataset("no words", std::vector<std::string>{});
    file.array("flat", {3, 0}, values.data());
  }
  CHECK(open_objects() == before);
  {
    const RawFile raw(path);
    CHECK(raw.shape("cube") == Lengths{4, 3, 2});
    CHECK(raw.numbers("cube") == values);
    CHECK(raw.text("cube", "unit") == "kg/s");
    CHECK(raw.shape("counts") == Lengths{2, 3});
    CHECK(raw.numbers("counts") == std::vector<double>(counts.begin(), counts.end()));
    CHECK(raw.numbers("marks") == std::vector<double>(marks.begin(), marks.end()));
    CHECK(raw.shape("one").empty());
    CHECK(raw.numbers("one") == std::vector<double>{12.25});
    CHECK(raw.shape("empty") == Lengths{0});
    CHECK(raw.shape("no words") == Lengths{0});
    CHECK(raw.shape("words") == Lengths{2});
    CHECK(raw.shape("flat") == Lengths{3, 0});
    const hid_t set = made(H5Dopen2(raw, "words", H5P_DEFAULT)), type = H5Dget_type(set);
    char* words[2] = {};
    made(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, words));
    CHECK(std::string(words[0]) == "some");
    CHECK(std::string(words[1]) == "more words");
    for (char* word : words) H5free_memory(word);
    H5Tclose(type);
    H5Dclose(set);
  }
  {
    const Hdf5 file = Hdf5::open_file(path);
    CHECK(file.read_doubles("cube") == values);
    CHECK(file.read_ints("counts") == counts);
    CHECK(file.read_doubles("one") == std::vector<double>{12.25});
    CHECK(file.read_doubles("list") == std::vector<double>{2.5, -7, 1e-300});
    CHECK(file.read_doubles("single") == std::vector<double>{-42.5});
    CHECK(file.read_doubles("empty").empty());
    CHECK(file.read_doubles("flat").empty());
  }
  CHECK(open_objects() == before);
}

TEST_CASE("hdf5: a slash in a name becomes a division slash, in groups and datasets") {
  const ScratchFolder scratch;
  const Hdf5 file = Hdf5::create_file(scratch.file("a.h5"));
  const Hdf5 group = file.group("km/h/s");
  group.dataset("to/day", std::vector<double>{3.5});
  group.array("by/two", {1}, std::vector<int>{9}.data());
  CHECK(file.has("km/h/s"));
  CHECK_FALSE(file.has("km"));
  CHECK(group.read_doubles("to/day") == std::vector<double>{3.5});
  CHECK(file.open_group("km/h/s").read_ints("by/two") == std::vector<int>{9});
  file.flush();
  const RawFile raw(scratch.file("a.h5"));
  CHECK(raw.has("km\u2215h\u2215s"));
  CHECK(raw.has("km\u2215h\u2215s/to\u2215day"));
}

TEST_CASE("hdf5: what cannot be made is named") {
  const ScratchFolder scratch;
  const std::string nowhere = scratch.file("missing/a.h5");
  CHECK_THROWS_WITH(Hdf5::create_file(nowhere),
                    Equals(nowhere + ": cannot be written; is the folder there and writable?"));
  const Hdf5 file = Hdf5::create_file(scratch.file("a.h5"));
  const double value = 2.5;
  file.group("twice");
  CHECK_THROWS_WITH(file.group("twice"), Equals("HDF5: cannot make twice"));
  CHECK_THROWS_WITH(file.array("twice", {1}, &value), Equals("HDF5: cannot make twice"));
  CHECK_THROWS_WITH(file.dataset("twice", std::vector<std::string>{"a"}),
                    Equals("HDF5: cannot make twice"));
  CHECK_THROWS_WITH(GrowingDataset(file, "twice", "m", {3}), Equals("HDF5: cannot make twice"));
  // more dimensions than the library knows
  CHECK_THROWS_WITH(file.array("deep", Shape(33, 1), &value),
                    Equals("HDF5: cannot make a description"));
  file.attribute("again", 3);
  CHECK_THROWS_WITH(file.attribute("again", 4), Equals("HDF5: cannot make a description"));
}

TEST_CASE("hdf5: what cannot be read is named") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  const Hdf5 file = Hdf5::create_file(path);
  file.dataset("numbers", std::vector<double>{3, 4});
  file.array("counts", {1}, std::vector<int>{9}.data());
  file.attribute("number", 3.5);
  file.attribute("texts", std::vector<std::string>{"one", "two"});
  CHECK_THROWS_WITH(file.read_doubles("missing"), Equals("HDF5: cannot read missing"));
  CHECK_THROWS_WITH(file.open_group("no group"), Equals("HDF5: cannot read no group"));
  CHECK_THROWS_WITH(file.open_group("numbers"), Equals("HDF5: cannot read numbers"));
  CHECK_THROWS_WITH(file.read_text("no text"), Equals("HDF5: cannot read no text"));
  CHECK_THROWS_WITH(file.read_text("number"), Equals("HDF5: cannot read number: it is no text"));
  CHECK_THROWS_WITH(file.read_text("texts"), Equals("HDF5: cannot read texts: it is no text"));
  CHECK_THROWS_WITH(file.read_ints("numbers"),
                    Equals("HDF5: cannot read numbers: it has another type"));
  CHECK_THROWS_WITH(file.read_doubles("counts"),
                    Equals("HDF5: cannot read counts: it has another type"));
  const RawFile raw(path, H5F_ACC_RDWR);
  const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  H5Tset_size(type, 5);
  hid_t id = made(H5Acreate2(raw, "fixed", type, space, H5P_DEFAULT, H5P_DEFAULT));
  made(H5Awrite(id, type, "four"));
  H5Aclose(id);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  const char* nothing = nullptr;
  id = made(H5Acreate2(raw, "nothing", type, space, H5P_DEFAULT, H5P_DEFAULT));
  made(H5Awrite(id, type, &nothing));
  H5Aclose(id);
  H5Sclose(space);
  H5Tclose(type);
  CHECK_THROWS_WITH(file.read_text("fixed"), Equals("HDF5: cannot read fixed: it is no text"));
  CHECK_THROWS_WITH(file.read_text("nothing"), Equals("HDF5: cannot read nothing"));
}

TEST_CASE("hdf5: the library's own messages are silent once a file is made or opened") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  { Hdf5::create_file(path).attribute("a", 3); }
  const auto prints = [] {
    H5E_auto2_t print = nullptr;
    void* data = nullptr;
    H5Eget_auto2(H5E_DEFAULT, &print, &data);
    return print != nullptr;
  };
  const auto speak = [] {
    H5Eset_auto2(
        H5E_DEFAULT, [](hid_t, void*) { return herr_t(0); }, nullptr);
  };
  speak();
  REQUIRE(prints());
  { const Hdf5 opened = Hdf5::open_file(path); }
  CHECK_FALSE(prints());
  speak();
  { const Hdf5 file = Hdf5::create_file(path); }
  CHECK_FALSE(prints());
}

TEST_CASE("hdf5: a growing dataset holds every row, in chunks that suit its row, with its unit") {
  const long before = open_objects();
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  struct Grown {
    const char* name;
    Shape row;
    Lengths chunk;
  };
  const std::vector<Grown> sets = {{"number", {}, {1024}},
                                   {"vector", {3}, {1024, 3}},
                                   {"quaternion", {4}, {1, 4}},
                                   {"places", {3, 5}, {1, 3, 5}},
                                   {"cube", {2, 3, 4}, {1, 2, 3, 4}}};
  const auto size_of = [](const Shape& row) {
    std::size_t size = 1;
    for (const auto length : row) size *= length;
    return size;
  };
  {
    const Hdf5 file = Hdf5::create_file(path);
    std::vector<GrowingDataset> grown;
    for (const Grown& set : sets)
      grown.emplace_back(file, set.name, std::string("m/") + set.name, set.row);
    for (std::size_t k = 0; k < sets.size(); ++k) {
      const std::vector<double> rows = rising(5 * size_of(sets[k].row));
      for (int i = 0; i < 5; ++i) grown[k].add(rows.data() + std::size_t(i) * size_of(sets[k].row));
    }
    GrowingDataset(file, "empty", "J", {3});
  }
  CHECK(open_objects() == before);
  const RawFile raw(path);
  for (const Grown& set : sets) {
    INFO(set.name);
    Lengths shape(set.row.begin(), set.row.end());
    shape.insert(shape.begin(), 5);
    CHECK(raw.shape(set.name) == shape);
    CHECK(raw.numbers(set.name) == rising(5 * size_of(set.row)));
    CHECK(raw.text(set.name, "unit") == std::string("m/") + set.name);
    CHECK(chunk_of(raw, set.name) == set.chunk);
    const hid_t id = made(H5Dopen2(raw, set.name, H5P_DEFAULT)), space = H5Dget_space(id);
    Lengths most(shape.size());
    H5Sget_simple_extent_dims(space, nullptr, most.data());
    CHECK(most[0] == H5S_UNLIMITED);
    most[0] = 5;
    CHECK(most == shape);
    H5Sclose(space);
    H5Dclose(id);
  }
  CHECK(raw.shape("empty") == Lengths{0, 3});
}

TEST_CASE("hdf5: what was flushed lies in the file, though it is still open") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5"), copy = scratch.file("copy.h5");
  const Hdf5 file = Hdf5::create_file(path);
  file.dataset("numbers", rising(9));
  file.flush();
  std::filesystem::copy_file(path, copy);
  CHECK(Hdf5::open_file(copy).read_doubles("numbers") == rising(9));
}

TEST_CASE("hdf5: a write that fails names the file") {
  const ScratchFolder scratch;
  {
    const Hdf5 file = Hdf5::create_file(scratch.file("a.h5"));
    GrowingDataset rows(file, "rows", "m", {200000});  // a chunk that is too large to be buffered
    const FileSizeLimit limit(60000);
    CHECK_THROWS_WITH(file.dataset("many", rising(20000)), Equals("HDF5: cannot write many"));
    CHECK_THROWS_WITH(rows.add(rising(200000).data()), Equals("HDF5: cannot write rows"));
  }
  Hdf5 buffered = Hdf5::create_file(scratch.file("b.h5"));
  for (int k = 0; k < 40; ++k) buffered.group("group " + std::to_string(k));
  const FileSizeLimit limit(900);
  CHECK_THROWS_WITH(buffered.flush(), Equals("HDF5: cannot write what was buffered"));
  CHECK_THROWS_WITH(buffered.close(), Equals("HDF5: cannot write what was buffered"));
}

TEST_CASE("hdf5: a file that is written whole takes the place of the one before") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5"), partial = path + ".partial";
  for (const double value : {3.5, 4.5}) {
    write_hdf5(path, [&](const Hdf5& file) {
      CHECK(std::filesystem::exists(partial));
      CHECK(std::filesystem::exists(path) == (value == 4.5));
      file.dataset("numbers", std::vector<double>{value});
    });
    CHECK(RawFile(path).numbers("numbers") == std::vector<double>{value});
    CHECK_FALSE(std::filesystem::exists(partial));
  }
  CHECK_THROWS_WITH(write_hdf5(path,
                               [&](const Hdf5& file) {
                                 file.group("new");
                                 throw std::runtime_error("the reason");
                               }),
                    Equals(path + ": cannot be written (the reason)"));
  CHECK_FALSE(std::filesystem::exists(partial));
  CHECK(RawFile(path).numbers("numbers") == std::vector<double>{4.5});
}

TEST_CASE("hdf5: no file is written in place of a folder") {
  const ScratchFolder scratch;
  const std::string path = scratch.file("a.h5");
  std::filesystem::create_directory(path);
  CHECK_THROWS_WITH(write_hdf5(path, [](const Hdf5&) {}),
                    Contains(path) && Contains("what is there is no file"));
  CHECK_FALSE(std::filesystem::exists(path + ".partial"));
}

}  // namespace foldproof
