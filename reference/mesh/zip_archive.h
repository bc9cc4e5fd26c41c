// ZIP archives: members by name, stored or deflated.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace foldproof {

/// A member as it lies in the archive.
struct ZipMember {
  std::string_view packed;
  std::size_t size;      // unpacked [bytes]
  unsigned method, crc;  // 0: stored, 8: deflated; CRC-32 of the unpacked bytes
};

/// The members by their names; views into `bytes`. Throws InputError
/// "FILE: ..." for bytes that are no archive, or one that is encrypted, damaged or cut off.
std::map<std::string, ZipMember> zip_members(std::string_view bytes, const std::string& file);

/// Throws InputError "FILE: NAME ...": another method, more than 2 GiB, or damaged.
std::string unpacked(const ZipMember& member, const std::string& name, const std::string& file);

}  // namespace foldproof
