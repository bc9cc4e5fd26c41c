#include "reference/mesh/zip_archive.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "reference/types.h"

#ifdef FOLDPROOF_HAS_ZLIB
#include <zlib.h>
#endif

namespace foldproof {

namespace {

// APPNOTE.TXT of PKWARE, section 4.3; without ZIP64, which files of less than 4 GiB do not need.
constexpr std::string_view end_mark("PK\5\6", 4);
constexpr std::string_view entry_mark("PK\1\2", 4), member_mark("PK\3\4", 4);
constexpr std::size_t longest_member = std::size_t(1) << 31;  // bytes
constexpr std::size_t most_inflated = 1032;  // bytes that a byte of deflate can stand for

/// Records of an archive, little-endian, never past its end.
struct Archive {
  std::string_view bytes;
  const std::string& file;

  [[noreturn]] void reject(const std::string& reason) const {
    throw InputError(file + ": " + reason);
  }

  std::string_view part(std::size_t at, std::size_t count) const {
    if (at > bytes.size() || count > bytes.size() - at)
      reject("is cut off, or no ZIP archive; write it anew");
    return bytes.substr(at, count);
  }

  std::uint64_t number(std::size_t at, std::size_t count) const {
    std::uint64_t value = 0;
    std::memcpy(&value, part(at, count).data(), count);
    return value;
  }

  void require(std::size_t at, std::string_view mark) const {
    if (part(at, 4) != mark) reject("has a damaged directory; write it anew");
  }
};

}  // namespace

std::map<std::string, ZipMember> zip_members(std::string_view bytes, const std::string& file) {
  const Archive archive{bytes, file};
  const std::size_t end = bytes.rfind(end_mark);
  if (end == std::string_view::npos) archive.reject("is no ZIP archive, or is cut off");
  std::map<std::string, ZipMember> members;
  std::size_t at = archive.number(end + 16, 4);
  for (std::size_t left = archive.number(end + 10, 2); left > 0; --left) {
    archive.require(at, entry_mark);
    if (archive.number(at + 8, 2) & 1) archive.reject("is encrypted; write it without a password");
    const std::size_t packed = archive.number(at + 20, 4), size = archive.number(at + 24, 4);
    const std::size_t name = archive.number(at + 28, 2), place = archive.number(at + 42, 4);
    archive.require(place, member_mark);
    const std::size_t data =
        place + 30 + archive.number(place + 26, 2) + archive.number(place + 28, 2);
    members[std::string(archive.part(at + 46, name))] = {archive.part(data, packed), size,
                                                         unsigned(archive.number(at + 10, 2)),
                                                         unsigned(archive.number(at + 16, 4))};
    at += 46 + name + archive.number(at + 30, 2) + archive.number(at + 32, 2);
  }
  return members;
}

std::string unpacked(const ZipMember& member, const std::string& name, const std::string& file) {
  const auto reject = [&](const std::string& reason) {
    throw InputError(file + ": '" + name + "' " + reason);
  };
  if (member.size > longest_member) reject("is longer than 2 GiB, the most that is read");
  if (member.method != 0 && member.method != 8) reject("is packed by another method than deflate");
  if (member.size / most_inflated > member.packed.size()) reject("is damaged; write it anew");
  std::string bytes;
  if (member.method == 0) bytes = member.packed;
#ifdef FOLDPROOF_HAS_ZLIB
  if (member.method == 8) {
    bytes.resize(member.size);
    z_stream stream{};
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(member.packed.data()));
    stream.avail_in = uInt(std::min(member.packed.size(), longest_member));
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_out = uInt(bytes.size());
    const bool is_started = inflateInit2(&stream, -MAX_WBITS) == Z_OK;  // without zlib's own header
    if (!is_started || inflate(&stream, Z_FINISH) != Z_STREAM_END) bytes.clear();
    bytes.resize(std::min<std::size_t>(bytes.size(), stream.total_out));
    if (is_started) inflateEnd(&stream);
  }
  if (crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()) != member.crc)
    reject("is damaged: its checksum is another; write it anew");
#else
  if (member.method == 8) reject("is deflated, which this build cannot read; store it");
#endif
  if (bytes.size() != member.size) reject("is damaged or cut off; write it anew");
  return bytes;
}

}  // namespace foldproof
