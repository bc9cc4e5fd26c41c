#include "scripts/program/provenance.h"

#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

#include "convergence/campaigns/job_keys.h"
#include "verification/files/content_key.h"

#include "build_facts.h"  // written by every build: commit, tree, compiler, flags

namespace foldproof {

namespace {

std::string cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  return text;
}

}  // namespace

Provenance provenance(const std::string& command) {
  Provenance p;
  p.version = FOLDPROOF_VERSION;
  p.commit = FOLDPROOF_COMMIT;
  p.tree = FOLDPROOF_TREE;
  p.compiler = FOLDPROOF_COMPILER;
  p.flags = FOLDPROOF_FLAGS;
  p.build_type = FOLDPROOF_BUILD_TYPE;
  p.cpu = cpu_name();
  p.cores = int(std::thread::hardware_concurrency());
  p.date = utc_now();
  p.command = command;
  return p;
}

std::string program_identity() {
  std::ifstream code("/proc/self/exe", std::ios::binary);
  std::error_code none;  // without /proc nothing is read
  const auto size = std::filesystem::file_size("/proc/self/exe", none);
  std::vector<char> bytes(none ? 0 : size);
  code.read(bytes.data(), std::streamsize(bytes.size()));
  ContentKey key;
  key.add(bytes);
  return std::string(FOLDPROOF_VERSION) + ", commit " + FOLDPROOF_COMMIT + ", code " + key.text();
}

std::string program_digest() { return file_digest("/proc/self/exe"); }

std::string program_commit() { return FOLDPROOF_COMMIT; }

std::string provenance_date() { return utc_now(); }

std::string program_file() { return std::filesystem::read_symlink("/proc/self/exe").string(); }

std::string source_folder() { return FOLDPROOF_FOLDER; }

}  // namespace foldproof
