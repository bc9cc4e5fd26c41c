#include "verification/faults/faults.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "reference/scene/key_file.h"
#include "verification/claims/read_claims.h"

namespace foldproof {

namespace {

struct Row {
  std::string name;
  std::shared_ptr<KeyTable> keys;
};

/// [fault.NAME], from the top of the file down.
std::vector<Row> rows_of(const KeyTable& root) {
  std::vector<Row> rows;
  if (const auto faults = root.table("fault"))
    for (const auto& [name, entry] : faults->entries) rows.push_back({name, faults->table(name)});
  const auto line = [](const Row& row) {
    return std::stol(row.keys->where().substr(row.keys->where().rfind(':') + 1));
  };
  std::ranges::sort(rows, {}, line);
  return rows;
}

/// What `edit` finds, and what it puts in its place: "a «+¦-» b" finds "a + b" and puts "a - b".
std::pair<std::string, std::string> find_and_replace(const KeyTable& row) {
  const std::string edit = row.text("edit"), marks[3] = {"«", "¦", "»"};
  const size_t from = edit.find(marks[0]), between = edit.find(marks[1]), to = edit.find(marks[2]);
  if (!(from < between && between < to && to != std::string::npos))
    throw InputError(row.where("edit") + ": 'edit' has no mark «is¦other»");
  const auto part = [&](size_t mark, size_t begin, size_t end) {
    begin += marks[mark].size();
    return edit.substr(begin, end - begin);
  };
  const std::string before = edit.substr(0, from), after = part(2, to, edit.size());
  return {before + part(0, from, between) + after, before + part(1, between, to) + after};
}

/// `file` is that of the row above; empty for the first row, which must name its own.
Fault fault_of(const std::string& name, const KeyTable& row, const std::string& file) {
  const auto [find, replace] =
      row.has("edit") ? find_and_replace(row) : std::pair(row.text("find"), row.text("replace"));
  Fault fault{name,
              row.has("file") || file.empty() ? row.text("file") : file,
              find,
              replace,
              row.text("law"),
              {},
              {},
              "not run"};
  if (row.has("equivalent")) fault.outcome = "equivalent: " + row.text("equivalent");
  if (row.has("caught_by"))
    for (const std::string& name : row.texts("caught_by"))
      for (const std::string& choice : choices_of(name)) fault.caught_by.push_back(choice);
  if (row.has("caught_by_tests")) fault.caught_by_tests = row.texts("caught_by_tests");
  fault.is_of_full_tier = row.flag_or("full", false);
  // for the runner alone
  for (const char* mark : {"fast", "loops", "crash"}) row.flag_or(mark, false);
  return fault;
}

std::vector<std::filesystem::path> files_of_faults(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  if (paths.empty()) throw InputError(folder + ": there is no list of faults, ROOM.toml");
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

std::string room_of(const std::string& file) {
  if (file.starts_with("convergence/")) return "convergence";
  if (file.starts_with("scripts/program/")) return "program";
  if (!file.starts_with("reference/") && !file.starts_with("verification/")) return "";
  const size_t start = file.find('/') + 1;
  return file.substr(start, file.find_first_of("/.", start) - start);
}

std::vector<Fault> read_faults(const std::string& folder) {
  std::vector<Fault> faults;
  std::map<std::string, std::string> places;  // of each name
  for (const std::filesystem::path& path : files_of_faults(folder)) {
    const auto root = parse_keys(read_text(path.string()), path.string());
    std::string file;
    for (const auto& [name, row] : rows_of(*root)) {
      faults.push_back(fault_of(name, *row, file));
      const Fault& fault = faults.back();
      file = fault.file;
      const auto [first, is_new] = places.try_emplace(name, row->where());
      if (!is_new)
        throw InputError(row->where() + ": the name '" + name + "' is taken at " + first->second);
      if (const std::string room = room_of(fault.file); room != path.stem())
        throw InputError(row->where("file") + ": a fault in '" + fault.file + "' belongs in " +
                         (room.empty() ? "no list" : room + ".toml"));
    }
    root->reject_unused();
  }
  return faults;
}

void name_faults(const std::vector<Fault>& faults, std::vector<Record>& records) {
  for (Record& record : records)
    for (const Fault& fault : faults)
      if (std::find(fault.caught_by.begin(), fault.caught_by.end(), record.name) !=
          fault.caught_by.end())
        record.faults.push_back(fault.name);
}

}  // namespace foldproof
