// Input files of a command, validated before anything is computed or written.
#pragma once

#include <string>

namespace foldproof {

/// A kind of file, known by the ending of its name.
struct FileKind {
  std::string ending;
  std::string what;        // with its article
  std::string other = "";  // another ending
};

extern const FileKind case_kind, run_kind, mesh_kind, table_kind;

/// In capitals, too.
bool has_ending(const std::string& path, const FileKind& kind);

/// Throws InputError unless there is such a file: one that is not empty, is no folder, and whose
/// name does not end as that of another kind does. Suggests names of files beside it, and of
/// shipped cases, where it is mistyped. Of what is no regular file (a pipe) nothing is asked but
/// that it is there.
void require_input(const std::string& path, const FileKind& kind);

/// The case file that a word names: a file, with or without .toml, or a shipped case. Throws
/// InputError as require_input does.
std::string case_file(const std::string& typed);

}  // namespace foldproof
