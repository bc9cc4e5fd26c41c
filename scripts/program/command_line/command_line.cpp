#include "scripts/program/command_line/command_line.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <sstream>

#include "scripts/program/options.h"
#include "scripts/program/progress.h"
#include "scripts/program/command_line/suggestions.h"

namespace foldproof {

namespace {

constexpr size_t page = 100, indent = 28;  // columns

/// Lines of at most `width` columns.
std::string wrapped(const std::string& text, size_t width) {
  std::istringstream words(text);
  std::string lines, line;
  for (std::string word; words >> word;) {
    if (!line.empty() && line.size() + 1 + word.size() > width) {
      lines += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return lines + line;
}

bool takes_value(const CLI::Option& option) { return option.get_expected_max() > 0; }

bool takes_many(const CLI::Option& option) { return option.get_expected_max() > 1; }

bool is_switch(const CLI::Option* option) {
  return option->nonpositional() && !option->get_positional();
}

/// "foldproof evaluate bending"
std::string full_name(const CLI::App& app) {
  return app.get_parent() ? full_name(*app.get_parent()) + " " + app.get_name() : "foldproof";
}

/// The command that was typed, as far as it is one.
const CLI::App& innermost(const CLI::App& app) {
  const std::vector<CLI::App*> typed = app.get_subcommands();
  return typed.empty() ? app : innermost(*typed.front());
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// Required arguments, and whether more are allowed.
std::string usage_of(const CLI::App& app) {
  std::string usage = full_name(app);
  if (!commands_of(app).empty()) usage += " COMMAND";
  for (const CLI::Option* option : app.get_options()) {
    if (is_switch(option)) continue;
    std::string name = option->get_name(true, false);
    if (takes_many(*option)) name += "...";
    usage += option->get_required() ? " " + name : " [" + name + "]";
  }
  for (const CLI::Option* option : app.get_options(is_switch))
    if (option->get_required())
      usage += fmt::format(" {} {}", option->get_name(false, true), option->get_type_name());
  return usage + " [OPTIONS]";
}

/// "--out DIR" with what it means
std::string explained(const CLI::Option& option) {
  std::string text = option.get_description();
  if (!option.get_default_str().empty())
    text += fmt::format(" (default: {})", option.get_default_str());
  if (option.get_required() && is_switch(&option)) text += " (required)";
  return text;
}

std::string unknown_word(const CLI::App& app, const std::string& word) {
  std::vector<std::string> known;
  if (word.starts_with("-")) {
    for (const CLI::Option* option : app.get_options())
      for (const std::string& name : option->get_lnames()) known.push_back(name);
    std::vector<std::string> near = nearest_names(word.substr(word.find_first_not_of('-')), known);
    for (std::string& name : near) name.insert(0, "--");
    return fmt::format("unknown option '{}'{}", word, did_you_mean(near));
  }
  for (const CLI::App* command : commands_of(app)) known.push_back(command->get_name());
  if (known.empty()) return fmt::format("unexpected word '{}'; usage: {}", word, usage_of(app));
  const std::vector<std::string> near = nearest_names(word, known);
  const std::string meant =
      near.empty() ? fmt::format("; known: {}", fmt::join(known, ", ")) : did_you_mean(near);
  return fmt::format("unknown command '{}'{}", word, meant);
}

/// An option that has too few values, or too many.
std::string mismatch(const CLI::App& app, const std::string& what) {
  const std::string name = what.substr(0, what.find_first_of(": "));
  const CLI::Option* option = app.get_option_no_throw(name);
  // the library names a flag without its dashes
  if (!option) return "--" + name + " takes no value";
  if (what.find("At Most") == std::string::npos)
    return fmt::format("{} needs a value: {} {}", name, name, option->get_type_name());
  if (is_switch(option)) return name + " is given more than once";
  return fmt::format("too many words; usage: {}", usage_of(app));
}

/// The error in one line.
std::string describe(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = innermost(app);
  const std::string what = error.what(), kind = error.get_name();
  if (kind == "ValidationError") return what;
  if (const std::vector<std::string> words = app.remaining(true); !words.empty())
    return unknown_word(command, words.front());
  if (kind == "RequiredError") {
    std::string name = what.substr(0, what.find(' '));
    if (const CLI::Option* option = command.get_option_no_throw(name);
        option && option->get_positional())
      name = option->get_name(true, false);
    return fmt::format("{} is missing; usage: {}", name, usage_of(command));
  }
  if (kind == "ArgumentMismatch") return mismatch(command, what);
  if (kind == "ExcludesError") return what + "; give one of them";
  return what;
}

bool is_whole(const std::string& text, long& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

/// Nothing, or the option behind the one that lacks its value.
bool is_no_value(const std::string& typed) { return typed.empty() || typed.starts_with("--"); }

/// A value that is refused is shown with what would do; "" lets it pass.
CLI::Validator validator(const std::string& wanted,
                         const std::function<bool(const std::string&)>& suits) {
  return {[=](std::string& typed) {
            if (is_no_value(typed)) return "a value is missing; give " + wanted;
            return suits(typed) ? "" : fmt::format("'{}' is not {}", typed, wanted);
          },
          ""};
}

}  // namespace

PlainHelp::PlainHelp() {
  column_width(indent);
  label("Positionals", "Arguments");
}

std::string PlainHelp::make_usage(const CLI::App* app, std::string) const {
  return "Usage: " + usage_of(*app) + "\n";
}

std::string PlainHelp::make_option(const CLI::Option* option, bool is_positional) const {
  std::string name = option->get_name(is_positional, !is_positional);
  if (const size_t comma = name.find(','); comma != std::string::npos) name.insert(comma + 1, " ");
  if (is_positional && takes_many(*option)) name += "...";
  if (!is_positional && takes_value(*option)) name += " " + option->get_type_name();
  std::stringstream out;
  CLI::detail::format_help(out, name, wrapped(explained(*option), page - indent), indent);
  return out.str();
}

std::string PlainHelp::make_subcommand(const CLI::App* command) const {
  std::stringstream out;
  CLI::detail::format_help(out, command->get_name(),
                           wrapped(command->get_description(), page - indent / 2), indent / 2);
  return out.str();
}

CLI::Validator one_of(const std::vector<std::string>& names) {
  return {[=](std::string& typed) {
            const std::string known = fmt::format("{}", fmt::join(names, ", "));
            if (std::ranges::find(names, typed) != names.end()) return std::string();
            if (is_no_value(typed)) return "a value is missing; give one of " + known;
            return fmt::format("'{}' is not one of {}{}", typed, known,
                               did_you_mean(nearest_names(typed, names)));
          },
          ""};
}

CLI::Validator whole_number(long least, long most) {
  return validator(fmt::format("a whole number from {} to {}", least, most),
                   [=](const std::string& typed) {
                     long value = 0;
                     return is_whole(typed, value) && value >= least && value <= most;
                   });
}

CLI::Validator finite_number() {
  return validator("a finite number, such as 0.01", [](const std::string& typed) {
    double value = 0;
    return CLI::detail::lexical_cast(typed, value) && std::isfinite(value);
  });
}

CLI::Validator positive_number() {
  return validator("a number above 0", [](const std::string& typed) {
    double value = 0;
    return CLI::detail::lexical_cast(typed, value) && value > 0 && std::isfinite(value);
  });
}

CLI::Validator share() {
  return validator("a number above 0 and below 1", [](const std::string& typed) {
    double value = 0;
    return CLI::detail::lexical_cast(typed, value) && value > 0 && value < 1;
  });
}

CLI::Validator some_text(const std::string& wanted) {
  return validator(wanted, [](const std::string&) { return true; });
}

int end_parse(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = innermost(app);
  if (error.get_exit_code() == 0) return app.exit(error);
  if (const CLI::Option* help = command.get_help_ptr(); help && help->count() > 0) {
    fmt::print("{}", command.help());
    return all_hold;
  }
  log_line(
      fmt::format("foldproof: {} (see `{} --help`)", describe(app, error), full_name(command)));
  return bad_input;
}

int reject_missing_command(const CLI::App& app) {
  const CLI::App& typed = innermost(app);
  std::vector<std::string> known;
  for (const CLI::App* command : commands_of(typed)) known.push_back(command->get_name());
  log_line(fmt::format("foldproof: a command is missing, one of {} (see `{} --help`)",
                       fmt::join(known, ", "), full_name(typed)));
  return bad_input;
}

}  // namespace foldproof
