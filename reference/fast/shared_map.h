// For speed only: a table of computed values that several threads fill and read at once.
#pragma once

#include <array>
#include <cstddef>
#include <mutex>
#include <unordered_map>

namespace foldproof {

/// Values by key. A value must depend only on its key: then it does not matter which thread
/// computes it.
template <class Key, class Value, class Hash>
class SharedMap {
 public:
  /// The value of the key, from make() if it has none. Meanwhile, threads that need other keys of
  /// the same part wait; make() must not use the map.
  template <class Make>
  const Value& at(const Key& key, const Make& make) {
    Part& part = part_of(key);
    const std::lock_guard lock(part.one_at_a_time);
    const auto found = part.values.find(key);
    return found != part.values.end() ? found->second
                                      : part.values.emplace(key, make()).first->second;
  }

  /// Null if the key has no value. Call only while no thread adds values.
  const Value* find(const Key& key) const {
    const Part& part = part_of(key);
    const auto found = part.values.find(key);
    return found != part.values.end() ? &found->second : nullptr;
  }

  /// While no thread adds values.
  long size() const {
    long sum = 0;
    for (const Part& part : parts_) sum += long(part.values.size());
    return sum;
  }

 private:
  struct Part {
    std::mutex one_at_a_time;
    std::unordered_map<Key, Value, Hash> values;
  };
  static std::size_t index_of(const Key& key) { return Hash()(key) >> 8 & 63; }
  Part& part_of(const Key& key) { return parts_[index_of(key)]; }
  const Part& part_of(const Key& key) const { return parts_[index_of(key)]; }

  std::array<Part, 64> parts_;  // each with a lock of its own: threads seldom wait
};

}  // namespace foldproof
