#include "verification/subjects/pipe/message.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

namespace foldproof {

static_assert(std::endian::native == std::endian::little, "arrays are sent as they lie in memory");

namespace {

void append(Request& request, const char* name, const char* type, std::vector<long> shape,
            std::string_view bytes) {
  request.header["arrays"].push_back({{"name", name}, {"type", type}, {"shape", shape}});
  request.bytes += bytes;
}

template <class Number>
std::string_view bytes_of(const Number* numbers, size_t count) {
  return {reinterpret_cast<const char*>(numbers), count * sizeof(Number)};
}

long count_of(const WantedArray& array) {
  long count = 1;
  for (const long extent : array.shape) count *= extent;
  return count;
}

/// Numbers from `at` on, which moves behind them, in lists of this shape.
template <class Number>
nlohmann::json nested(const char*& at, std::span<const long> shape) {
  if (shape.empty()) {
    Number value;
    std::memcpy(&value, std::exchange(at, at + sizeof value), sizeof value);
    return value;
  }
  nlohmann::json list = nlohmann::json::array();
  for (long k = 0; k < shape[0]; ++k) list.push_back(nested<Number>(at, shape.subspan(1)));
  return list;
}

/// "particle 5, x coordinate, of array 'x'"; of several frames: which one, too.
std::string place_in(const WantedArray& array, size_t k) {
  const size_t vector = k / 3;
  std::string place = fmt::format("particle {}", vector);
  if (array.shape.size() == 3)
    place = fmt::format("frame {}, particle {}", vector / size_t(array.shape[1]),
                        vector % size_t(array.shape[1]));
  return fmt::format("{}, {} coordinate, of array '{}'", place, "xyz"[k % 3], array.name);
}

template <class Number>
std::vector<double> finite_numbers(std::string_view bytes, const WantedArray& array) {
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));
  for (size_t k = 0; k < numbers.size(); ++k)
    if (!std::isfinite(numbers[k]))
      throw SolverFailure("nan", fmt::format("sent {} for {}", numbers[k], place_in(array, k)),
                          "sent a number that is not finite");
  return {numbers.begin(), numbers.end()};
}

/// Same but for the first extent?
bool differs_in_length_only(const nlohmann::json& shape, const std::vector<long>& wanted) {
  if (!shape.is_array() || shape.size() != wanted.size() || wanted.empty()) return false;
  for (size_t k = 0; k < wanted.size(); ++k)
    if (!shape[k].is_number_integer() || (k > 0 && shape[k] != wanted[k])) return false;
  return shape[0] != wanted[0];
}

void require_array(const nlohmann::json& entry, const WantedArray& wanted,
                   const std::string& type) {
  if (!entry.is_object() || entry.value("name", nlohmann::json()) != wanted.name)
    throw SolverFailure(
        "shape", fmt::format("sent {} where array '{}' is due",
                             entry.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace),
                             wanted.name));
  if (entry.value("type", nlohmann::json()) != type)
    throw SolverFailure("shape", fmt::format("sent array '{}' not as {}, its declared precision",
                                             wanted.name, type));
  const nlohmann::json shape = entry.value("shape", nlohmann::json());
  if (shape == nlohmann::json(wanted.shape)) return;
  const bool by_length = differs_in_length_only(shape, wanted.shape);
  const bool is_longer = by_length && shape[0] > wanted.shape[0];
  throw SolverFailure(!by_length  ? "shape"
                      : is_longer ? "oversized"
                                  : "truncated",
                      fmt::format("sent array '{}' of shape {} instead of {}", wanted.name,
                                  shape.dump(), nlohmann::json(wanted.shape).dump()));
}

}  // namespace

nlohmann::json lists_of(const Request& request) {
  nlohmann::json lists = nlohmann::json::object();
  const char* at = request.bytes.data();
  for (const nlohmann::json& entry : request.header.at("arrays")) {
    const std::vector<long> shape = entry.at("shape");
    lists[entry.at("name").get<std::string>()] =
        entry.at("type") == "i4" ? nested<int>(at, shape) : nested<double>(at, shape);
  }
  return lists;
}

void Request::add(const char* name, const PerParticle3& values) {
  append(*this, name, "f8", {long(values.cols()), 3},
         bytes_of(values.data(), size_t(values.size())));
}

void Request::add(const char* name, std::span<const double> values) {
  add(name, values, {long(values.size())});
}

void Request::add(const char* name, std::span<const double> values, std::vector<long> shape) {
  append(*this, name, "f8", std::move(shape), bytes_of(values.data(), values.size()));
}

void Request::add(const char* name, std::span<const int> values, int wide) {
  static_assert(sizeof(int) == 4);
  const long rows = long(values.size()) / wide;
  append(*this, name, "i4", wide == 1 ? std::vector<long>{rows} : std::vector<long>{rows, wide},
         bytes_of(values.data(), values.size()));
}

nlohmann::json parse_header(const std::string& line) {
  nlohmann::json header = nlohmann::json::parse(line, nullptr, false);
  if (header.is_object()) return header;
  std::string shown = line.substr(0, 60);
  for (char& c : shown)
    if (c < ' ' || c > '~') c = '?';
  throw SolverFailure("header", fmt::format("sent a header that is no JSON object: '{}'", shown));
}

void require_arrays(const nlohmann::json& header, const std::vector<WantedArray>& wanted,
                    const std::string& type) {
  const nlohmann::json arrays = header.value("arrays", nlohmann::json::array());
  if (!arrays.is_array() || arrays.size() != wanted.size())
    throw SolverFailure("shape", fmt::format("sent {} arrays instead of {}",
                                             arrays.is_array() ? arrays.size() : 0, wanted.size()));
  for (size_t k = 0; k < wanted.size(); ++k) require_array(arrays[k], wanted[k], type);
}

std::vector<std::vector<double>> read_arrays(ChildProcess& child,
                                             const std::vector<WantedArray>& wanted, bool is_single,
                                             ChildProcess::Deadline deadline) {
  std::vector<std::vector<double>> arrays;
  const size_t wide = is_single ? sizeof(float) : sizeof(double);
  for (const WantedArray& one : wanted) {
    std::string bytes(size_t(count_of(one)) * wide, '\0');
    child.read(bytes.data(), bytes.size(), deadline);
    arrays.push_back(as_numbers(bytes, is_single, one));
  }
  return arrays;
}

std::vector<double> as_numbers(std::string_view bytes, bool is_single, const WantedArray& array) {
  return is_single ? finite_numbers<float>(bytes, array) : finite_numbers<double>(bytes, array);
}

PerParticle3 as_particles(const std::vector<double>& values) {
  return Eigen::Map<const PerParticle3>(values.data(), 3, Eigen::Index(values.size() / 3));
}

}  // namespace foldproof
