// How the command line is explained, and what is said of one that makes no sense.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace foldproof {

/// Help in words: names of values without their types, defaults and requirements in the text, at
/// most 100 columns.
class PlainHelp : public CLI::Formatter {
 public:
  PlainHelp();
  std::string make_usage(const CLI::App* app, std::string name) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* command) const override;
};

/// What is asked of a value before it is read; each says what would do.
CLI::Validator one_of(const std::vector<std::string>& names);
CLI::Validator whole_number(long least, long most);
CLI::Validator finite_number();
CLI::Validator positive_number();
CLI::Validator share();  // above 0 and below 1
CLI::Validator some_text(const std::string& wanted);

/// Ends a parse that failed: prints help if it was asked for, else one line on standard error, that
/// says what is wrong and what would do. Returns the exit code.
int end_parse(const CLI::App& app, const CLI::ParseError& error);

/// Says in one line that a command is missing, and which there are. Returns the exit code.
int reject_missing_command(const CLI::App& app);

}  // namespace foldproof
