#include "verification/files/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <system_error>

namespace foldproof {

namespace {

[[noreturn]] void cannot_write(const std::string& path, int error) {
  throw std::runtime_error(path + ": cannot be written (" + std::generic_category().message(error) +
                           "); are its folder and the space left as they should be?");
}

/// An open file; closed when it goes out of scope.
class Descriptor {
 public:
  Descriptor(const std::string& path, int flags)
      : id_(open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~Descriptor() {
    if (id_ >= 0) close(id_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int id() const { return id_; }

 private:
  int id_;
};

/// The error of writing all of the text and having it on the disk; 0 if that is done.
int write_error(const std::string& path, const std::string& text) {
  const Descriptor out(path, O_WRONLY | O_CREAT | O_TRUNC);
  if (out.id() < 0) return errno;
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = write(out.id(), text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    done += std::size_t(count);
  }
  return fsync(out.id()) == 0 ? 0 : errno;
}

/// A new name is on the disk when its folder is. Folders of some file systems cannot be synced, or
/// not be opened to be read: there the system's own word has to do.
void sync_folder_of(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const Descriptor open_folder(folder.empty() ? "." : folder.string(), O_RDONLY | O_DIRECTORY);
  if (open_folder.id() < 0 || fsync(open_folder.id()) == 0) return;
  if (errno != EINVAL && errno != ENOTSUP && errno != EROFS) cannot_write(path, errno);
}

}  // namespace

void durable_rename(const std::string& from, const std::string& to) {
  {
    const Descriptor written(from, O_RDONLY);
    if (written.id() < 0 || fsync(written.id()) != 0) cannot_write(to, errno);
  }
  if (std::rename(from.c_str(), to.c_str()) != 0) cannot_write(to, errno);
  sync_folder_of(to);
}

void write_text(const std::string& path, const std::string& text) {
  const std::string partial = path + ".partial";
  if (const int error = write_error(partial, text); error != 0) {
    std::remove(partial.c_str());
    cannot_write(path, error);
  }
  durable_rename(partial, path);
}

void require_replaceable(const std::string& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw std::runtime_error(path + ": cannot be written: what is there is no file");
}

}  // namespace foldproof
