// Records which functions of a program run. Part of the programs that are built with REACH
// (CMakeLists.txt), where the compiler calls the hook below at each entry of a function.
// The record is a shared mapping of the file named by REACH_RECORD and the program's name, with one
// bit for each byte of code: it survives a crash or a kill, and child processes add to it.

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

extern "C" char __executable_start, etext;  // of the linker

namespace {

std::uint8_t unused;  // stands for the record where none is asked for

/// The file must exist and be large enough: a child process may not be allowed to make it so.
std::uint8_t* open_record() {
  const char* path = std::getenv("REACH_RECORD");
  if (!path) return &unused;
  char name[4096];
  std::snprintf(name, sizeof name, "%s.%s", path, program_invocation_short_name);
  const std::size_t bytes = (&etext - &__executable_start) / 8 + 1;
  const int file = open(name, O_RDWR | O_CLOEXEC);
  void* start = file < 0 || lseek(file, 0, SEEK_END) < off_t(bytes)
                    ? MAP_FAILED
                    : mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (start == MAP_FAILED) {  // a record with holes would leave out tests that reach an edit
    std::perror(name);
    _exit(97);
  }
  close(file);
  return static_cast<std::uint8_t*>(start);
}

}  // namespace

extern "C" void __cyg_profile_func_enter(void* function, void*) {
  static std::uint8_t* record = nullptr;  // threads that open it at once map the same file
  std::uint8_t* bits = __atomic_load_n(&record, __ATOMIC_ACQUIRE);
  if (!bits) {
    bits = open_record();
    __atomic_store_n(&record, bits, __ATOMIC_RELEASE);
  }
  if (bits == &unused) return;
  const std::size_t place = static_cast<char*>(function) - &__executable_start;
  const auto bit = static_cast<std::uint8_t>(1U << place % 8);
  if (!(__atomic_load_n(&bits[place / 8], __ATOMIC_RELAXED) & bit))
    __atomic_fetch_or(&bits[place / 8], bit, __ATOMIC_RELAXED);
}

extern "C" void __cyg_profile_func_exit(void*, void*) {}
