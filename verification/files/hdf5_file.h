// Writing and reading HDF5. The only file that uses the library; everything else uses
// these two classes.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace foldproof {

// lengths of an array's dimensions, outermost first; {}: one number
using Shape = std::vector<unsigned long long>;

/// An open file, a group or a dataset; closed when it goes out of scope. Every call throws
/// std::runtime_error naming what could not be made, written or read. A '/' in a name becomes
/// U+2215, which looks the same.
class Hdf5 {
 public:
  /// A new file, in place of any that has this path.
  static Hdf5 create_file(const std::string& path);

  /// Opens an existing file for reading. All of it is first read once in a child process, so that a
  /// damaged file cannot crash this one.
  static Hdf5 open_file(const std::string& path);

  Hdf5(Hdf5&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5& operator=(Hdf5&&) = delete;
  ~Hdf5();

  Hdf5 group(const std::string& name) const;
  void attribute(const std::string& name, const std::string& value) const;
  void attribute(const std::string& name, double value) const;
  void attribute(const std::string& name, int value) const;
  // none: left out
  void attribute(const std::string& name, const std::vector<std::string>& values) const;
  Hdf5 dataset(const std::string& name, const std::vector<double>& values) const;
  Hdf5 dataset(const std::string& name, const std::vector<std::string>& values) const;

  /// An array of as many values as the shape says, row by row.
  Hdf5 array(const std::string& name, const Shape& shape, const double* values) const;
  Hdf5 array(const std::string& name, const Shape& shape, const int* values) const;
  Hdf5 array(const std::string& name, const Shape& shape, const unsigned char* values) const;

  /// Readers for data of any length. A type mismatch is refused, as is a dataset that claims more
  /// numbers than its file can hold.
  Hdf5 open_group(const std::string& name) const;
  bool has(const std::string& name) const;
  std::string read_text(const std::string& attribute) const;
  std::vector<double> read_doubles(const std::string& dataset) const;
  std::vector<int> read_ints(const std::string& dataset) const;

  /// Passes everything written so far to the operating system.
  void flush() const;

  /// Closes a file in which nothing is open any more; throws if buffered data cannot be written. A
  /// file that merely goes out of scope may be incomplete.
  void close();

 private:
  friend class GrowingDataset;
  Hdf5(std::int64_t id, int (*close)(std::int64_t), const std::string& what);

  std::int64_t id_;
  int (*close_)(std::int64_t);
};

/// Writes a new file with `write`, under the name "<path>.partial", and renames it when complete.
/// Throws std::runtime_error naming the file; what was at `path` is then still there, and no
/// partial file is left.
void write_hdf5(const std::string& path, const std::function<void(const Hdf5& file)>& write);

/// A dataset of doubles that grows along its first dimension, a row of the given shape at a time.
class GrowingDataset {
 public:
  GrowingDataset(const Hdf5& parent, const std::string& name, const std::string& unit, Shape row);
  void add(const double* row);

 private:
  Shape row_;
  Hdf5 set_;
  std::string name_;
  unsigned long long length_ = 0;
};

}  // namespace foldproof
