// Content keys for caches: equal keys mean equal content.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace foldproof {

/// The 64-bit FNV-1a hash (Fowler, Noll, Vo) of the values, in the order they are added.
class ContentKey {
 public:
  template <class T>
  void add(const T* values, std::size_t count) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values);
    for (std::size_t i = 0; i < count * sizeof(T); ++i) hash_ = (hash_ ^ bytes[i]) * 0x100000001b3;
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add(std::uint64_t(values.size()));
    add(values.data(), values.size());
  }
  void add(double value) { add(&value, 1); }
  void add(int value) { add(&value, 1); }
  void add(std::uint64_t value) { add(&value, 1); }

  /// 16 hexadecimal digits; two different contents collide with probability 2^-64.
  std::string text() const {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash_));
    return digits;
  }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325;
};

}  // namespace foldproof
