// HDF5 files of strangers: damaged ones, and ones that claim more than they hold, are refused.
#include <catch2/catch.hpp>
#include <functional>

#include "verification/files/hdf5_file.h"
#include "verification/specimens/scratch_folder.h"
#include "verification/tests/files/raw_hdf5.h"

namespace foldproof {

namespace {

using Catch::Contains;
using Catch::Equals;
using Lengths = std::vector<hsize_t>;

enum class Packing { none, checksum, deflated };

/// A new dataset, chunked unless it is not packed; nothing is written into it.
hid_t new_set(hid_t file, const char* name, hid_t type, const Lengths& shape, Packing packing,
              const Lengths& chunk = {}) {
  const hid_t space = made(H5Screate_simple(int(shape.size()), shape.data(), nullptr)),
              layout = made(H5Pcreate(H5P_DATASET_CREATE));
  if (packing != Packing::none) made(H5Pset_chunk(layout, int(chunk.size()), chunk.data()));
  if (packing == Packing::checksum) made(H5Pset_fletcher32(layout));
  if (packing == Packing::deflated) made(H5Pset_deflate(layout, 4));
  const hid_t set = made(H5Dcreate2(file, name, type, space, H5P_DEFAULT, layout, H5P_DEFAULT));
  H5Pclose(layout);
  H5Sclose(space);
  return set;
}

/// A new file that `fill` fills by the C interface.
std::string raw_file(const ScratchFolder& scratch, const std::string& name,
                     const std::function<void(hid_t)>& fill) {
  const std::string path = scratch.file(name);
  { const Hdf5 file = Hdf5::create_file(path); }
  const RawFile raw(path, H5F_ACC_RDWR);
  fill(raw);
  return path;
}

std::string damaged(const std::string& path) {
  return "HDF5: cannot read " + path + " (it is damaged); is it there, and a whole HDF5 file?";
}

/// Writes the mark at the row of a set of bytes whose chunks are rows.
void mark_row(hid_t set, hsize_t row, hsize_t width, const std::string& mark) {
  const hsize_t start[] = {row, 0}, count[] = {1, width};
  const hid_t space = H5Dget_space(set), memory = H5Screate_simple(2, count, nullptr);
  H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr);
  std::string bytes(width, '\0');
  bytes.replace(5, mark.size(), mark);
  made(H5Dwrite(set, H5T_NATIVE_UCHAR, memory, space, H5P_DEFAULT, bytes.data()));
  H5Sclose(memory);
  H5Sclose(space);
}

void write_text_attribute(hid_t object, const char* name, const char* text) {
  const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  H5Tset_size(type, H5T_VARIABLE);
  const hid_t id = made(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT));
  made(H5Awrite(id, type, &text));
  H5Aclose(id);
  H5Sclose(space);
  H5Tclose(type);
}

/// A file whose root has an attribute of so many values of the type.
std::string file_of_attribute(const ScratchFolder& scratch, hid_t type, hsize_t count) {
  const std::string path = scratch.file("attribute.h5");
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  made(H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST));  // else 64 KB at most
  const hid_t file = made(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access)),
              space = made(H5Screate_simple(1, &count, nullptr)),
              id = made(H5Acreate2(file, "large", type, space, H5P_DEFAULT, H5P_DEFAULT));
  made(H5Awrite(id, type, std::vector<char>(count * H5Tget_size(type)).data()));
  H5Aclose(id);
  H5Sclose(space);
  H5Fclose(file);
  H5Pclose(access);
  return path;
}

}  // namespace

TEST_CASE("hdf5: a file that is missing, cut off or none is refused with the reason") {
  const ScratchFolder scratch;
  const std::string missing = scratch.file("missing.h5");
  CHECK_THROWS_WITH(Hdf5::open_file(missing),
                    Equals("HDF5: cannot read " + missing +
                           " (it is not there); is it there, and a whole HDF5 file?"));
  const std::string text = scratch.write("text.h5", "this is no such file");
  CHECK_THROWS_WITH(Hdf5::open_file(text), Equals(damaged(text)));
  const std::string cut = scratch.file("cut.h5");
  write_hdf5(cut, [](const Hdf5& file) { file.dataset("a", std::vector<double>(500, 3.5)); });
  std::filesystem::resize_file(cut, 3000);
  CHECK_THROWS_WITH(Hdf5::open_file(cut), Equals(damaged(cut)));
}

TEST_CASE("hdf5: a dataset may claim no more than its file can hold") {
  const ScratchFolder scratch;
  for (const Lengths& shape : {Lengths{5000}, {50, 100}, {1ULL << 40, 1ULL << 40}, {3, 5, 400}}) {
    const std::string path = raw_file(scratch, "claim.h5", [&](hid_t raw) {
      if (shape[0] < 1000000)
        H5Dclose(new_set(raw, "claim", H5T_NATIVE_DOUBLE, shape, Packing::none));
      else
        H5Dclose(new_set(raw, "claim", H5T_NATIVE_DOUBLE, shape, Packing::checksum, {1024, 16}));
    });
    CHECK_THROWS_WITH(Hdf5::open_file(path), Equals(damaged(path)));
    // asked of a file that is open already
    const Hdf5 file = Hdf5::create_file(scratch.file("open.h5"));
    const RawFile raw(scratch.file("open.h5"), H5F_ACC_RDWR);
    if (shape[0] > 1000000) continue;
    H5Dclose(new_set(raw, "claim", H5T_NATIVE_DOUBLE, shape, Packing::none));
    CHECK_THROWS_WITH(file.read_doubles("claim"),
                      Equals("HDF5: cannot read claim: it claims more than the file can hold"));
  }
}

TEST_CASE("hdf5: a packed dataset may be larger than its file, up to 2^28 values") {
  const ScratchFolder scratch;
  const Lengths limit = {(1ULL << 28) + 1};
  const std::string path = scratch.file("packed.h5");
  {
    const Hdf5 file = Hdf5::create_file(path);
    const RawFile raw(path, H5F_ACC_RDWR);
    const std::vector<int> same(50000, 77);
    const hid_t set = new_set(raw, "same", H5T_NATIVE_INT, {50000}, Packing::deflated, {50000});
    made(H5Dwrite(set, H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, same.data()));
    H5Dclose(set);
    CHECK(file.read_ints("same") == same);
    H5Dclose(new_set(raw, "large", H5T_NATIVE_INT, limit, Packing::checksum, {1024}));
    CHECK_THROWS_WITH(file.read_ints("large"),
                      Equals("HDF5: cannot read large: it claims more than the file can hold"));
  }
  CHECK_THROWS_WITH(Hdf5::open_file(path), Equals(damaged(path)));
}

TEST_CASE("hdf5: every row of a large dataset is read before the file is trusted") {
  const ScratchFolder scratch;
  const hsize_t width = 1 << 20;  // 16 rows are read at once
  for (const hsize_t row : {0, 15, 16, 31, 32}) {
    INFO(row);
    const std::string path = raw_file(scratch, "rows.h5", [&](hid_t raw) {
      const hid_t set =
          new_set(raw, "rows", H5T_NATIVE_UCHAR, {33, width}, Packing::checksum, {1, width});
      mark_row(set, row, width, "the marked row");
      H5Dclose(set);
    });
    CHECK_NOTHROW(Hdf5::open_file(path));
    damage_after(path, "the marked row");
    CHECK_THROWS_WITH(Hdf5::open_file(path), Equals(damaged(path)));
  }
}

TEST_CASE("hdf5: large datasets of any shape are read piece by piece") {
  const ScratchFolder scratch;
  for (const auto& [shape, chunk] : {std::pair(Lengths{20000000}, Lengths{1000000}),
                                     {{40, 700, 1000}, {1, 700, 1000}},
                                     {{2, 17000000}, {1, 1000000}},
                                     {{32, 1 << 20}, {1, 1 << 20}}}) {
    const std::string path = raw_file(scratch, "large.h5", [&](hid_t raw) {
      H5Dclose(new_set(raw, "large", H5T_NATIVE_UCHAR, shape, Packing::checksum, chunk));
    });
    CHECK_NOTHROW(Hdf5::open_file(path));
  }
}

TEST_CASE("hdf5: a damaged dataset of one row, or of rows of one value, is refused") {
  const ScratchFolder scratch;
  for (const Lengths& shape : {Lengths{1, 64}, {64}, {64, 1}}) {
    const std::string path = raw_file(scratch, "small.h5", [&](hid_t raw) {
      const hid_t set = new_set(raw, "small", H5T_NATIVE_UCHAR, shape, Packing::checksum, shape);
      const std::string text = "the only sixty-four bytes that this small dataset is made of ...";
      REQUIRE(text.size() == 64);
      made(H5Dwrite(set, H5T_NATIVE_UCHAR, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()));
      H5Dclose(set);
    });
    CHECK_NOTHROW(Hdf5::open_file(path));
    damage_after(path, "the only sixty");
    CHECK_THROWS_WITH(Hdf5::open_file(path), Equals(damaged(path)));
  }
}

TEST_CASE("hdf5: what is damaged after the file was opened is not read") {
  const ScratchFolder scratch;
  const std::string path = raw_file(scratch, "a.h5", [](hid_t raw) {
    const hid_t set = new_set(raw, "numbers", H5T_NATIVE_INT, {9}, Packing::checksum, {9});
    const char text[] = "thirty-six bytes, as nine ints have";
    static_assert(sizeof text == 36);
    made(H5Dwrite(set, H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, text));
    H5Dclose(set);
  });
  const Hdf5 file = Hdf5::open_file(path);
  damage_after(path, "thirty-six");
  CHECK_THROWS_WITH(file.read_ints("numbers"), Equals("HDF5: cannot read numbers"));
}

TEST_CASE("hdf5: a scalar dataset is read too before the file is trusted") {
  const ScratchFolder scratch;
  const std::string path = raw_file(scratch, "scalar.h5", [](hid_t raw) {
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    H5Tset_size(type, H5T_VARIABLE);
    const hid_t set =
        made(H5Dcreate2(raw, "word", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    const char* text = "a word";
    made(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &text));
    H5Dclose(set);
    H5Sclose(space);
    H5Tclose(type);
  });
  CHECK_NOTHROW(Hdf5::open_file(path));
  damage_after(path, "GCOL");  // the place of texts
  CHECK_THROWS_WITH(Hdf5::open_file(path), Contains("it is damaged"));
}

TEST_CASE(
    "hdf5: attributes are read before the file is trusted, of groups too and after empty ones") {
  const ScratchFolder scratch;
  for (const bool is_in_group : {false, true}) {
    const std::string path = raw_file(scratch, "attributes.h5", [&](hid_t raw) {
      const hid_t nothing = H5Screate(H5S_NULL);
      H5Aclose(made(H5Acreate2(raw, "a", H5T_NATIVE_INT, nothing, H5P_DEFAULT, H5P_DEFAULT)));
      H5Sclose(nothing);
      const hid_t first = H5Gcreate2(raw, "a", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                  group = H5Gcreate2(raw, "b", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      write_text_attribute(is_in_group ? group : raw, "b", "a text");
      H5Gclose(group);
      H5Gclose(first);
    });
    CHECK_NOTHROW(Hdf5::open_file(path));
    damage_after(path, "GCOL");
    CHECK_THROWS_WITH(Hdf5::open_file(path), Contains("it is damaged"));
  }
}

TEST_CASE("hdf5: an attribute has no more than 16 MB") {
  const ScratchFolder scratch;
  CHECK_NOTHROW(Hdf5::open_file(file_of_attribute(scratch, H5T_NATIVE_UCHAR, 1 << 24)));
  CHECK_NOTHROW(Hdf5::open_file(file_of_attribute(scratch, H5T_NATIVE_DOUBLE, 1 << 21)));
  const std::string path = file_of_attribute(scratch, H5T_NATIVE_DOUBLE, (1 << 21) + 1);
  CHECK_THROWS_WITH(Hdf5::open_file(path), Equals(damaged(path)));
}

}  // namespace foldproof
