// HDF5 by its own C interface: what the project's classes wrote is read without them, and files are
// made that they would never write.
#pragma once

#include <hdf5.h>

#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace foldproof {

inline hid_t made(hid_t id) {
  if (id < 0) throw std::runtime_error("HDF5 refuses what a test asks for");
  return id;
}

/// A file, open by the C interface; closed when it goes out of scope.
class RawFile {
 public:
  /// Opens a file for reading, or for writing too.
  explicit RawFile(const std::string& path, unsigned access = H5F_ACC_RDONLY)
      : id_(made(H5Fopen(path.c_str(), access, H5P_DEFAULT))) {}
  ~RawFile() { H5Fclose(id_); }
  RawFile(const RawFile&) = delete;
  RawFile& operator=(const RawFile&) = delete;
  operator hid_t() const { return id_; }

  bool has(const std::string& path) const { return H5Lexists(id_, path.c_str(), H5P_DEFAULT) > 0; }

  std::vector<hsize_t> shape(const std::string& path) const {
    const hid_t set = made(H5Dopen2(id_, path.c_str(), H5P_DEFAULT)), space = H5Dget_space(set);
    std::vector<hsize_t> lengths(std::size_t(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, lengths.data(), nullptr);
    H5Sclose(space);
    H5Dclose(set);
    return lengths;
  }

  std::vector<double> numbers(const std::string& path) const {
    hsize_t count = 1;
    for (const hsize_t length : shape(path)) count *= length;
    std::vector<double> values(count);
    const hid_t set = made(H5Dopen2(id_, path.c_str(), H5P_DEFAULT));
    made(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    H5Dclose(set);
    return values;
  }

  double number(const std::string& object, const std::string& attribute) const {
    const hid_t id = opened(object, attribute);
    double value = 0;
    made(H5Aread(id, H5T_NATIVE_DOUBLE, &value));
    H5Aclose(id);
    return value;
  }

  std::vector<std::string> texts(const std::string& object, const std::string& attribute) const {
    const hid_t id = opened(object, attribute), space = H5Aget_space(id), type = H5Aget_type(id);
    std::vector<char*> pointers(std::size_t(H5Sget_simple_extent_npoints(space)));
    made(H5Aread(id, type, pointers.data()));
    std::vector<std::string> result;
    for (char* text : pointers) {
      result.emplace_back(text);
      H5free_memory(text);
    }
    H5Tclose(type);
    H5Sclose(space);
    H5Aclose(id);
    return result;
  }

  std::string text(const std::string& object, const std::string& attribute) const {
    return texts(object, attribute).at(0);
  }

 private:
  hid_t opened(const std::string& object, const std::string& attribute) const {
    return made(H5Aopen_by_name(id_, object.c_str(), attribute.c_str(), H5P_DEFAULT, H5P_DEFAULT));
  }

  hid_t id_;
};

inline std::string bytes_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Changes the byte where `text` ends in the file, the only place where it stands.
inline void damage_after(const std::string& path, const std::string& text) {
  std::string bytes = bytes_of_file(path);
  const std::size_t at = bytes.find(text);
  if (at == std::string::npos || bytes.find(text, at + 1) != std::string::npos)
    throw std::runtime_error("a test's mark does not stand once in the file");
  bytes[at + text.size() - 1] ^= 0x55;
  std::ofstream(path, std::ios::binary | std::ios::in) << bytes;
}

/// While it lives, no file grows beyond so many bytes.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const struct rlimit limit = {bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  struct rlimit before_ = {};
  void (*handler_)(int) = nullptr;
};

}  // namespace foldproof
