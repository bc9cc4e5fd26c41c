// A table that several threads fill.
#include <atomic>
#include <catch2/catch.hpp>
#include <thread>

#include "reference/fast/shared_map.h"
#include "reference/fast/loops.h"

using namespace foldproof;

namespace {

/// 64 keys that follow each other are in 64 parts.
struct Hash {
  std::size_t operator()(int key) const { return std::size_t(key) << 8; }
};

using Squares = SharedMap<int, long, Hash>;

}  // namespace

TEST_CASE("a shared map makes each value once, and does not move it") {
  constexpr int keys = 3000;
  Squares squares;
  std::atomic<int> made = 0;
  std::vector<const long*> found(4 * keys);
  in_parallel(4, [&](int k) {
    for (int i = 0; i < keys; ++i) {
      const int key = k % 2 == 0 ? i : keys - 1 - i;
      const long& value = squares.at(key, [&] {
        ++made;
        return long(key) * key;
      });
      found[size_t(k * keys + key)] = &value;
    }
  });
  CHECK(made == keys);
  CHECK(squares.size() == keys);
  int wrong = 0;
  for (int k = 0; k < 4; ++k)
    for (int key = 0; key < keys; ++key) {
      const long* value = found[size_t(k * keys + key)];
      if (*value != long(key) * key || value != squares.find(key)) ++wrong;
    }
  CHECK(wrong == 0);
}

TEST_CASE("a shared map finds what somebody asked for, and nothing else") {
  Squares squares;
  CHECK(squares.size() == 0);
  squares.at(7, [] { return 49L; });
  squares.at(7, [] { return 50L; });
  REQUIRE(squares.find(7));
  CHECK(*squares.find(7) == 49);
  CHECK(!squares.find(8));
  CHECK(!squares.find(7 + 64));  // of the same part
  CHECK(squares.size() == 1);
}

TEST_CASE("a shared map's parts do not wait for each other") {
  Squares squares;
  std::atomic<bool> is_inside = false, may_end = false;
  std::jthread slow([&] {
    squares.at(1, [&] {
      is_inside = true;
      is_inside.notify_all();
      may_end.wait(false);
      return 1L;
    });
  });
  is_inside.wait(false);
  for (int key = 2; key <= 64; ++key) squares.at(key, [&] { return long(key); });
  may_end = true;
  may_end.notify_all();
  slow.join();
  CHECK(squares.size() == 64);
}
