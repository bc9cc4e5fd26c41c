#include "verification/files/result_store.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "reference/types.h"
#include "verification/files/hdf5_file.h"

namespace foldproof {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string one_line(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// A name that no other process on any machine takes, for all that is likely.
std::string new_shard_name() {
  char host[64] = "host";
  gethostname(host, sizeof host - 1);
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::string(host) + "-" + std::to_string(getpid()) + "-" +
         std::to_string(std::chrono::duration_cast<std::chrono::microseconds>(now).count()) +
         ".jsonl";
}

/// The whole text in one call, so that lines of two writers never mix.
void append_to_file(const std::string& path, const std::string& text) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  const bool is_written =
      file >= 0 && write(file, text.data(), text.size()) == ssize_t(text.size());
  if (file >= 0) close(file);
  if (!is_written) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace

ResultStore::ResultStore(std::string folder) : folder_(std::move(folder)) {
  if (folder_.empty()) return;
  if (fs::exists(folder_) && !fs::is_directory(folder_))
    throw InputError(folder_ + ": results are kept in a folder, and this is none");
  shard_ = folder_ + "/shards/" + new_shard_name();
  if (!fs::is_directory(folder_ + "/shards")) return;
  for (const auto& entry : fs::directory_iterator(folder_ + "/shards")) {
    std::ifstream shard(entry.path());
    for (std::string line; std::getline(shard, line);) {
      const json record = json::parse(line, nullptr, false);
      if (!record.is_object()) continue;  // torn
      if (record.contains("start")) ++starts_[record["start"].get<std::string>()];
      if (record.contains("result"))
        texts_[record["result"].get<std::string>()] =
            record.value("texts", std::map<std::string, std::string>());
    }
  }
}

std::string ResultStore::arrays_file(const std::string& key) const {
  return folder_ + "/arrays/" + key.substr(0, 2) + "/" + key + ".h5";
}

std::optional<StoredResult> ResultStore::find(const std::string& key) const {
  StoredResult result;
  {
    const std::lock_guard held(mutex_);
    const auto kept = texts_.find(key);
    if (kept == texts_.end()) return {};
    result.texts = kept->second;
  }
  try {
    const Hdf5 file = Hdf5::open_file(arrays_file(key));
    for (const std::string& name :
         json::parse(file.read_text("names")).get<std::vector<std::string>>())
      result.arrays[name] = file.read_doubles(name);
  } catch (const std::exception&) {
    return {};  // as if it had never been made
  }
  return result;
}

void ResultStore::append(const std::string& line) {
  fs::create_directories(folder_ + "/shards");
  append_to_file(shard_, line + "\n");
}

void ResultStore::start(const std::string& key, const std::string& label) {
  if (folder_.empty()) return;
  const std::lock_guard held(mutex_);
  append(one_line({{"start", key}, {"label", label}}));
  ++starts_[key];
}

void ResultStore::keep(const std::string& key, const StoredResult& result) {
  if (folder_.empty()) return;
  const std::lock_guard held(mutex_);
  fs::create_directories(fs::path(arrays_file(key)).parent_path());
  json names = json::array(), lengths = json::object();
  write_hdf5(arrays_file(key), [&](const Hdf5& file) {
    for (const auto& [name, values] : result.arrays) {
      if (values.empty()) continue;
      file.dataset(name, values);
      names.push_back(name);
      lengths[name] = values.size();
    }
    file.attribute("names", names.dump());
  });
  append(one_line({{"result", key}, {"texts", result.texts}, {"arrays", lengths}}));
  texts_[key] = result.texts;
}

int ResultStore::starts(const std::string& key) const {
  const std::lock_guard held(mutex_);
  const auto found = starts_.find(key);
  return found == starts_.end() ? 0 : found->second;
}

}  // namespace foldproof
