// All of an HDF5 file as texts, read through the library itself: for tests of what writes it.
#pragma once

#include <fmt/format.h>
#include <hdf5.h>

#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace foldproof {

/// "GROUP/" without a value, "SET" with "[2 x 3] a | b | ...", "OBJECT@ATTRIBUTE" with its
/// value or values.
using Listing = std::map<std::string, std::string>;

/// The values of a dataset or an attribute. `read` gets the type in memory, and where to read to.
inline std::string values_in(hid_t type, hid_t space,
                             const std::function<int(hid_t, void*)>& read) {
  std::vector<hsize_t> shape(std::size_t(H5Sget_simple_extent_ndims(space)));
  if (!shape.empty()) H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  const auto count = std::size_t(H5Sget_simple_extent_npoints(space));
  std::vector<std::string> values;
  const auto numbers = [&](auto one, hid_t in_memory) {
    std::vector<decltype(one)> all(count);
    if (read(in_memory, all.data()) < 0) throw std::runtime_error("a value cannot be read");
    for (const auto& value : all) values.push_back(fmt::format("{}", value));
  };
  if (H5Tget_class(type) == H5T_STRING)
    numbers(static_cast<const char*>(nullptr), type);
  else if (H5Tget_class(type) == H5T_INTEGER)
    numbers(0, H5T_NATIVE_INT);
  else
    numbers(0.0, H5T_NATIVE_DOUBLE);
  const std::string joined = fmt::format("{}", fmt::join(values, " | "));
  return shape.empty() ? joined : fmt::format("[{}] {}", fmt::join(shape, " x "), joined);
}

inline void list_attributes(hid_t object, const std::string& name, Listing& listing) {
  const auto count = hsize_t(H5Aget_num_attrs(object));
  for (hsize_t k = 0; k < count; ++k) {
    const hid_t one =
        H5Aopen_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, k, H5P_DEFAULT, H5P_DEFAULT);
    char text[256];
    H5Aget_name(one, sizeof text, text);
    const hid_t type = H5Aget_type(one), space = H5Aget_space(one);
    listing[name + "@" + text] = values_in(
        type, space, [&](hid_t in_memory, void* to) { return H5Aread(one, in_memory, to); });
    H5Sclose(space), H5Tclose(type), H5Aclose(one);
  }
}

/// Adds what is in an object; its name ends in '/' if it is a group.
inline void list_object(hid_t object, const std::string& name, Listing& listing) {
  list_attributes(object, name, listing);
  if (H5Iget_type(object) == H5I_DATASET) {
    const hid_t type = H5Dget_type(object), space = H5Dget_space(object);
    listing[name] = values_in(type, space, [&](hid_t in_memory, void* to) {
      return H5Dread(object, in_memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, to);
    });
    H5Sclose(space), H5Tclose(type);
    return;
  }
  listing[name] = "";
  H5G_info_t info;
  H5Gget_info(object, &info);
  for (hsize_t k = 0; k < info.nlinks; ++k) {
    char text[256];
    H5Lget_name_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, k, text, sizeof text, H5P_DEFAULT);
    const hid_t child = H5Oopen(object, text, H5P_DEFAULT);
    const bool is_group = H5Iget_type(child) == H5I_GROUP;
    list_object(child, name + text + (is_group ? "/" : ""), listing);
    H5Oclose(child);
  }
}

inline Listing hdf5_listing(const std::string& path) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) throw std::runtime_error(path + ": is no HDF5 file");
  const hid_t root = H5Gopen2(file, "/", H5P_DEFAULT);
  Listing listing;
  list_object(root, "/", listing);
  H5Gclose(root), H5Fclose(file);
  return listing;
}

/// The lines in which two listings differ, for a message: "" if they agree.
inline std::string difference_of(const Listing& is, const Listing& expected) {
  std::string lines;
  for (const auto& [name, value] : is)
    if (!expected.contains(name))
      lines += "not expected: " + name + " = " + value + "\n";
    else if (expected.at(name) != value)
      lines += name + " = " + value + "; expected: " + expected.at(name) + "\n";
  for (const auto& [name, value] : expected)
    if (!is.contains(name)) lines += "missing: " + name + " = " + value + "\n";
  return lines;
}

}  // namespace foldproof
