#include "convergence/campaigns/job_keys.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace foldproof {

namespace {

namespace fs = std::filesystem;

/// Adds the meshes and folders of frames that a case file names, with their content.
void add_files(const KeyTable& table, const fs::path& folder, WideKey& key) {
  const auto add_below = [&](const KeyValue& value) {
    if (const auto* below = std::get_if<std::shared_ptr<KeyTable>>(&value.data))
      add_files(**below, folder, key);
  };
  for (const auto& [name, value] : table.entries) {
    add_below(value);
    if (const auto* list = std::get_if<std::vector<KeyValue>>(&value.data))
      for (const KeyValue& entry : *list) add_below(entry);
    const auto* text = std::get_if<std::string>(&value.data);
    if (!text) continue;
    std::error_code none;
    if (fs::is_regular_file(folder / *text, none)) key.add(file_digest((folder / *text).string()));
    if (name == "frames" && fs::is_directory(folder / *text, none))
      key.add(folder_digest((folder / *text).string()));
  }
}

bool names_a_folder(const std::string& key) { return key == "frames" || key.ends_with(".frames"); }

}  // namespace

std::string file_digest(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file) throw InputError(path + ": cannot be read");
  WideKey key;
  key.add(bytes);
  return key.text();
}

std::string folder_digest(const std::string& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::ranges::sort(files);
  WideKey key;
  for (const fs::path& file : files) {
    key.add(file.filename().string());
    key.add(file_digest(file.string()));
  }
  return key.text();
}

JobKeys::JobKeys(const Campaign& campaign, const std::string& program,
                 std::function<std::string(const std::string&)> find_case)
    : find_case_(std::move(find_case)) {
  for (const std::string& part : {campaign.run, program, campaign.quantities}) start_.add(part);
}

const JobKeys::KnownCase& JobKeys::known_case(const std::string& name) {
  const auto found = cases_.find(name);
  if (found != cases_.end()) return found->second;
  KnownCase known{find_case_(name), start_};
  const std::string text = read_text(known.file);
  known.key.add(text);
  add_files(*parse_keys(text, known.file), fs::path(known.file).parent_path(), known.key);
  return cases_.emplace(name, known).first->second;
}

const std::string& JobKeys::files_in(const std::string& value, bool is_folder) {
  const auto found = digests_.find(value);
  if (found != digests_.end()) return found->second;
  std::string digests;
  std::error_code none;
  std::istringstream words(value);  // a solver is a command, of several words
  for (std::string word; words >> word;)
    if (fs::is_regular_file(word, none)) digests += file_digest(word);
  if (is_folder && fs::is_directory(value, none)) digests += folder_digest(value);
  return digests_.emplace(value, digests).first->second;
}

std::string JobKeys::case_file_of(const std::vector<Assignment>& set) {
  const auto of = std::ranges::find(set, "case", &Assignment::key);
  return of == set.end() ? "" : known_case(of->value).file;
}

std::string JobKeys::key_of(const std::vector<Assignment>& set) {
  const auto of = std::ranges::find(set, "case", &Assignment::key);
  WideKey key = of == set.end() ? start_ : known_case(of->value).key;
  for (const Assignment& a : set) {
    if (a.key == "case") continue;
    key.add(a.key);
    const std::string& files = files_in(a.value, names_a_folder(a.key));
    key.add(files.empty() ? a.value : files);
  }
  return key.text();
}

}  // namespace foldproof
