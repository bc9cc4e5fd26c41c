// For speed alone: how many bits of a byte are set, from a table. Without the processor's own
// instruction std::popcount is a call.
#pragma once

#include <array>
#include <bit>

namespace foldproof {

inline constexpr std::array<unsigned char, 256> set_bits = [] {
  std::array<unsigned char, 256> count{};
  for (int byte = 1; byte < 256; ++byte) count[byte] = (unsigned char)(count[byte / 2] + byte % 2);
  return count;
}();

/// Is the table std::popcount of every byte? The compiler asks.
constexpr bool set_bits_are_counted() {
  for (unsigned byte = 0; byte < 256; ++byte)
    if (int(set_bits[byte]) != std::popcount(byte)) return false;
  return true;
}
static_assert(set_bits_are_counted());

}  // namespace foldproof
