// Content keys of 128 bits, for stores that many runs share.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace foldproof {

/// The 128-bit FNV-1a hash (Fowler, Noll, Vo) of texts, each with its length. Among 10^6 different
/// contents two collide with probability 10^-27; it is no defence against forgery.
class WideKey {
 public:
  void add(std::string_view text) {
    std::uint64_t length = text.size();
    for (int k = 0; k < 8; ++k, length >>= 8) add_byte(static_cast<unsigned char>(length));
    for (const char c : text) add_byte(static_cast<unsigned char>(c));
  }

  /// 32 hexadecimal digits.
  std::string text() const {
    constexpr char digits[] = "0123456789abcdef";
    std::string text(32, '0');
    Wide rest = hash_;
    for (int k = 31; k >= 0; --k, rest >>= 4) text[size_t(k)] = digits[int(rest & 15)];
    return text;
  }

 private:
  __extension__ using Wide = unsigned __int128;

  void add_byte(unsigned char byte) { hash_ = (hash_ ^ byte) * prime; }

  static constexpr Wide prime = (Wide(1) << 88) + 0x13b;
  Wide hash_ = (Wide(0x6c62272e07bb0142) << 64) + 0x62b821756295c58d;
};

}  // namespace foldproof
