#include "verification/files/hdf5_file.h"

#include <hdf5.h>

#include <algorithm>
#include <cstdio>
#include <mutex>
#include <stdexcept>
#include <type_traits>

#include "verification/files/isolated_reader.h"
#include "verification/files/atomic_file.h"

namespace foldproof {

static_assert(std::is_same_v<hid_t, std::int64_t> && std::is_same_v<herr_t, int>,
              "the header names the library's types without including it");
static_assert(std::is_same_v<hsize_t, Shape::value_type>);

namespace {

/// The library serves one thread at a time: whatever calls it holds this.
std::recursive_mutex library;

/// Errors are thrown, not printed; and what could not be written is not tried again when
/// the program ends.
void begin() {
  static const herr_t never_at_exit = H5dont_atexit();
  static_cast<void>(never_at_exit);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

void succeed(herr_t result, const std::string& what) {
  if (result < 0) throw std::runtime_error("HDF5: cannot write " + what);
}

void require(bool is_good, const std::string& what) {
  if (!is_good) throw std::runtime_error("HDF5: cannot read " + what);
}

/// '/' parts the names of groups in HDF5; in a name it becomes a division slash, which
/// looks the same.
std::string without_slash(const std::string& name) {
  std::string result;
  for (const char c : name) result += c == '/' ? std::string("\u2215") : std::string(1, c);
  return result;
}

/// Owns an identifier that never leaves this file: a type, a space, a list of properties.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id < 0) throw std::runtime_error("HDF5: cannot make a description");
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

Handle space_of(const Shape& shape) {
  if (shape.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
  return {H5Screate_simple(int(shape.size()), shape.data(), nullptr), H5Sclose};
}

void write_attribute(hid_t object, const std::string& name, hid_t type, const Shape& shape,
                     const void* data) {
  const Handle space = space_of(shape);
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  succeed(H5Awrite(attribute, type, data), name);
}

/// The identifier of a new dataset that holds these values.
hid_t write_values(hid_t parent, const std::string& name, hid_t type, const Shape& shape,
                   const void* data) {
  const Handle space = space_of(shape);
  const hid_t set = H5Dcreate2(parent, without_slash(name).c_str(), type, space, H5P_DEFAULT,
                               H5P_DEFAULT, H5P_DEFAULT);
  if (set >= 0 && data) succeed(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), name);
  return set;
}

std::vector<const char*> pointers(const std::vector<std::string>& texts) {
  std::vector<const char*> result;
  for (const std::string& text : texts) result.push_back(text.c_str());
  return result;
}

/// The identifier of a new, empty dataset that can grow along its first dimension.
hid_t growing(hid_t parent, const std::string& name, const Shape& row) {
  const std::lock_guard held(library);
  Shape start = row, most = row, chunk = row;
  start.insert(start.begin(), 0);
  most.insert(most.begin(), H5S_UNLIMITED);
  const bool is_small = row.empty() || (row.size() == 1 && row[0] == 3);
  chunk.insert(chunk.begin(), is_small ? 1024 : 1);
  const Handle space(H5Screate_simple(int(start.size()), start.data(), most.data()), H5Sclose);
  const Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(layout, int(chunk.size()), chunk.data());
  return H5Dcreate2(parent, name.c_str(), H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, layout,
                    H5P_DEFAULT);
}

Handle open_object(hid_t parent, const std::string& name) {
  const hid_t set = H5Dopen2(parent, name.c_str(), H5P_DEFAULT);
  require(set >= 0, name);
  return {set, H5Dclose};
}

Shape shape_of_space(hid_t space) {
  const int rank = H5Sget_simple_extent_ndims(space);
  require(rank >= 0, "the shape of a dataset");
  Shape shape(std::size_t(rank), 0);
  if (rank > 0) H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  return shape;
}

/// How many numbers a dataset may claim. Without compression it is stored as it is, so that the
/// file is larger; with it (other programs' files) this many are taken, 2 GB.
constexpr unsigned long long most_unpacked = 1ULL << 28;

unsigned long long most_values(hid_t set, std::size_t size_of_one) {
  const Handle layout(H5Dget_create_plist(set), H5Pclose);
  if (H5Pget_nfilters(layout) != 0) return most_unpacked;
  const Handle file(H5Iget_file_id(set), H5Fclose);
  hsize_t bytes = 0;
  require(H5Fget_filesize(file, &bytes) >= 0, "the size of the file");
  return bytes / size_of_one;
}

/// The number of values of the shape. Throws if there are more than `most`.
unsigned long long count_of(const Shape& shape, unsigned long long most, const std::string& name) {
  unsigned long long count = 1;
  for (const auto length : shape) {
    require(length == 0 || count <= most / length,
            name + ": it claims more than the file can hold");
    count *= length;
  }
  return count;
}

/// All values of a dataset of this very type, row by row.
template <class T>
std::vector<T> read_values(hid_t parent, const std::string& name, hid_t type) {
  const Handle set = open_object(parent, name);
  const Handle stored(H5Dget_type(set), H5Tclose);
  require(H5Tequal(stored, type) > 0, name + ": it has another type");
  const Shape shape = shape_of_space(Handle(H5Dget_space(set), H5Sclose));
  const auto count = count_of(shape, most_values(set, sizeof(T)), name);
  std::vector<T> values(count);
  if (count > 0)
    require(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0, name);
  return values;
}

constexpr hsize_t bytes_at_once = 1 << 24;

/// Reads a dataset, as many rows at once as fit the memory; false if it cannot be read.
bool is_readable(hid_t set) {
  const Handle type(H5Dget_type(set), H5Tclose), space(H5Dget_space(set), H5Sclose);
  Shape shape = shape_of_space(space);
  const std::size_t size = H5Tget_size(type);
  if (size == 0) return false;
  if (shape.empty()) shape = {1};
  const hsize_t rows = shape.front(),
                row = count_of({shape.begin() + 1, shape.end()}, most_unpacked, "a row");
  if (rows == 0 || row == 0) return true;
  count_of(shape, most_values(set, size), "a dataset");
  const hsize_t step = std::max<hsize_t>(1, bytes_at_once / (row * size));
  std::vector<char> values(std::min(rows, step) * row * size);
  if (H5Sget_simple_extent_ndims(space) == 0)
    return H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
  for (hsize_t first = 0; first < rows; first += step) {
    Shape start(shape.size(), 0), count = shape;
    start[0] = first;
    count[0] = std::min(step, rows - first);
    if (H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) <
        0)
      return false;
    if (H5Dread(set, type, space_of(count), space, H5P_DEFAULT, values.data()) < 0) return false;
  }
  return true;
}

/// Callbacks from the library must not throw through it.
template <class Act>
herr_t without_error_stack(const Act& act) {
  try {
    return act();
  } catch (const std::exception&) {
    return -1;
  }
}

herr_t read_attribute(hid_t object, const char* name, const H5A_info_t*, void*) {
  return without_error_stack([&] {
    const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
    const Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    if (count < 0 || hsize_t(count) > bytes_at_once / std::max<std::size_t>(1, H5Tget_size(type)))
      return -1;
    std::vector<char> values(std::size_t(count) * H5Tget_size(type));
    return count == 0 ? 0 : H5Aread(attribute, type, values.data());
  });
}

herr_t read_object(hid_t file, const char* name, const H5O_info_t* about, void*) {
  return without_error_stack([&] {
    const Handle object(H5Oopen(file, name, H5P_DEFAULT), H5Oclose);
    if (H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, read_attribute, nullptr) < 0)
      return -1;
    return about->type != H5O_TYPE_DATASET || is_readable(object) ? 0 : -1;
  });
}

/// Reads all that is in a file: groups, attributes, datasets. The library may crash or run without
/// end where the structures of a file are damaged, so this is done apart; it takes no lock, which a
/// copy of this process could not hold.
bool all_is_readable(const std::string& path) {
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  return H5Ovisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, read_object, nullptr) >= 0;
}

}  // namespace

Hdf5::Hdf5(std::int64_t id, int (*close)(std::int64_t), const std::string& what)
    : id_(id), close_(close) {
  if (id < 0) throw std::runtime_error("HDF5: cannot make " + what);
}

Hdf5::~Hdf5() {
  const std::lock_guard held(library);
  if (id_ >= 0) close_(id_);
}

Hdf5 Hdf5::create_file(const std::string& path) {
  const std::lock_guard held(library);
  begin();
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (file < 0)
    throw std::runtime_error(path + ": cannot be written; is the folder there and writable?");
  return {file, H5Fclose, path};
}

Hdf5 Hdf5::group(const std::string& name) const {
  const std::lock_guard held(library);
  return {H5Gcreate2(id_, without_slash(name).c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
          H5Gclose, name};
}

void Hdf5::attribute(const std::string& name, const std::string& value) const {
  const std::lock_guard held(library);
  const char* text = value.c_str();
  write_attribute(id_, name, text_type(), {}, &text);
}

void Hdf5::attribute(const std::string& name, double value) const {
  const std::lock_guard held(library);
  write_attribute(id_, name, H5T_NATIVE_DOUBLE, {}, &value);
}

void Hdf5::attribute(const std::string& name, int value) const {
  const std::lock_guard held(library);
  write_attribute(id_, name, H5T_NATIVE_INT, {}, &value);
}

void Hdf5::attribute(const std::string& name, const std::vector<std::string>& values) const {
  const std::lock_guard held(library);
  // HDF5 1.10 has no empty simple attribute of texts; absent means none
  if (values.empty()) return;
  write_attribute(id_, name, text_type(), {values.size()}, pointers(values).data());
}

Hdf5 Hdf5::dataset(const std::string& name, const std::vector<double>& values) const {
  const std::lock_guard held(library);
  return array(name, {values.size()}, values.empty() ? nullptr : values.data());
}

Hdf5 Hdf5::dataset(const std::string& name, const std::vector<std::string>& values) const {
  const std::lock_guard held(library);
  const std::vector<const char*> texts = pointers(values);
  return {
      write_values(id_, name, text_type(), {texts.size()}, texts.empty() ? nullptr : texts.data()),
      H5Dclose, name};
}

Hdf5 Hdf5::array(const std::string& name, const Shape& shape, const double* values) const {
  const std::lock_guard held(library);
  return {write_values(id_, name, H5T_NATIVE_DOUBLE, shape, values), H5Dclose, name};
}

Hdf5 Hdf5::array(const std::string& name, const Shape& shape, const int* values) const {
  const std::lock_guard held(library);
  return {write_values(id_, name, H5T_NATIVE_INT, shape, values), H5Dclose, name};
}

Hdf5 Hdf5::array(const std::string& name, const Shape& shape, const unsigned char* values) const {
  const std::lock_guard held(library);
  return {write_values(id_, name, H5T_NATIVE_UCHAR, shape, values), H5Dclose, name};
}

Hdf5 Hdf5::open_file(const std::string& path) {
  const std::lock_guard held(library);
  begin();
  const std::string fate = failure_in_isolation(path, [&] { return all_is_readable(path); });
  const hid_t file = fate.empty() ? H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT) : -1;
  require(file >= 0,
          path + (fate.empty() ? "" : " (" + fate + ")") + "; is it there, and a whole HDF5 file?");
  return {file, H5Fclose, path};
}

Hdf5 Hdf5::open_group(const std::string& name) const {
  const std::lock_guard held(library);
  const hid_t group = H5Gopen2(id_, without_slash(name).c_str(), H5P_DEFAULT);
  require(group >= 0, name);
  return {group, H5Gclose, name};
}

bool Hdf5::has(const std::string& name) const {
  const std::lock_guard held(library);
  return H5Lexists(id_, without_slash(name).c_str(), H5P_DEFAULT) > 0;
}

std::string Hdf5::read_text(const std::string& attribute) const {
  const std::lock_guard held(library);
  const hid_t id = H5Aopen(id_, attribute.c_str(), H5P_DEFAULT);
  require(id >= 0, attribute);
  const Handle open(id, H5Aclose), space(H5Aget_space(id), H5Sclose),
      type(H5Aget_type(id), H5Tclose);
  require(H5Sget_simple_extent_npoints(space) == 1 && H5Tis_variable_str(type) > 0,
          attribute + ": it is no text");
  char* text = nullptr;
  require(H5Aread(open, text_type(), &text) >= 0 && text, attribute);
  const std::string result = text;
  H5free_memory(text);
  return result;
}

std::vector<double> Hdf5::read_doubles(const std::string& dataset) const {
  const std::lock_guard held(library);
  return read_values<double>(id_, without_slash(dataset), H5T_NATIVE_DOUBLE);
}

std::vector<int> Hdf5::read_ints(const std::string& dataset) const {
  const std::lock_guard held(library);
  return read_values<int>(id_, without_slash(dataset), H5T_NATIVE_INT);
}

void Hdf5::flush() const {
  const std::lock_guard held(library);
  succeed(H5Fflush(id_, H5F_SCOPE_LOCAL), "what was buffered");
}

void Hdf5::close() {
  const std::lock_guard held(library);
  succeed(close_(std::exchange(id_, -1)), "what was buffered");
}

void write_hdf5(const std::string& path, const std::function<void(const Hdf5& file)>& write) {
  const std::string partial = path + ".partial";
  require_replaceable(path);
  try {
    Hdf5 file = Hdf5::create_file(partial);
    write(file);
    file.flush();
    file.close();
  } catch (const std::runtime_error& error) {
    std::remove(partial.c_str());
    throw std::runtime_error(path + ": cannot be written (" + error.what() + ")");
  }
  durable_rename(partial, path);
}

GrowingDataset::GrowingDataset(const Hdf5& parent, const std::string& name, const std::string& unit,
                               Shape row)
    : row_(std::move(row)), set_(growing(parent.id_, name, row_), H5Dclose, name), name_(name) {
  const std::lock_guard held(library);
  set_.attribute("unit", unit);
}

void GrowingDataset::add(const double* row) {
  const std::lock_guard held(library);
  Shape size = row_, start(row_.size() + 1, 0), count = row_;
  size.insert(size.begin(), length_ + 1);
  count.insert(count.begin(), 1);
  start[0] = length_++;
  succeed(H5Dset_extent(set_.id_, size.data()), name_);
  const Handle file_space(H5Dget_space(set_.id_), H5Sclose);
  H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  const Handle memory = space_of(count);
  succeed(H5Dwrite(set_.id_, H5T_NATIVE_DOUBLE, memory, file_space, H5P_DEFAULT, row), name_);
}

}  // namespace foldproof
