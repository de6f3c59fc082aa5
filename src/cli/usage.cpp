// The parser of the command line tells what it expected in its own terms; here that becomes what
// was written and what would be right. Which option it is about stands before the colon (or the
// equals sign) of its message.
#include "cli/usage.h"

#include <cstdio>

#include "base/text.h"
#include "cli/exit_code.h"

namespace aircut::cli {

namespace {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> out;
  for (const CLI::App* sub : app.get_subcommands({})) out.push_back(sub->get_name());
  return out;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> out;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) out.push_back("--" + name);
  return out;
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> out(1);
  for (const char c : text) {
    if (c == at)
      out.emplace_back();
    else
      out.back() += c;
  }
  return out;
}

// "--size WxH", "-m MACHINE", "PROGRAM"
std::string written(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name(true);
  const std::string type = option.get_items_expected_max() > 0 ? " " + option.get_type_name() : "";
  return option.get_name() + type;
}

// The option that the message is about.
const CLI::Option* option_of(const CLI::App& command, const std::string& message) {
  for (std::size_t end : {message.find(':'), message.find(" is required")}) {
    if (end == std::string::npos) continue;
    if (const auto* option = command.get_option_no_throw(message.substr(0, end))) return option;
  }
  const std::string converting = "Could not convert: ";
  if (!message.starts_with(converting)) return nullptr;
  const std::string rest = message.substr(converting.size());
  return command.get_option_no_throw(rest.substr(0, rest.find(" =")));
}

// The first line: the others are examples.
std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

std::string missing(const CLI::Option& option) {
  return written(option) + " is missing: " + first_line(option.get_description());
}

std::string wrong_number(const CLI::Option& option, const std::string& value) {
  if (option.results().size() > 1)
    return written(option) + " is given " + std::to_string(option.results().size()) +
           " times; give it once";
  return value.empty() ? written(option) + ": the value is missing"
                       : option.get_name() + " takes no value";
}

// "… not in range 0.000000 to 1000.000000" → "a number from 0 to 1000"; empty: it is none of these.
std::string range_in(const std::string& message) {
  const std::string before = " not in range ", between = " to ";
  const std::size_t at = message.rfind(before);
  if (at == std::string::npos) return "";
  const std::string range = message.substr(at + before.size());
  const std::size_t middle = range.find(between);
  if (middle == std::string::npos) return "";
  const auto low = parse_number(range.substr(0, middle));
  const auto high = parse_number(range.substr(middle + between.size()));
  if (!low || !high) return "";
  const std::string from = shortest(*low);
  return *high > 1e15 ? "write a number of " + from + " or more"
                      : "write a number from " + from + " to " + shortest(*high);
}

std::string wrong_value(const CLI::Option& option, const std::string& message) {
  std::string value = option.results().empty() ? "" : option.results().back();
  for (const std::string& given : option.results())
    if (!given.empty() && message.find(given) != std::string::npos) value = given;
  const std::string name = option.get_name() + " '" + printable(value) + "': ";
  const std::vector<std::string> words = split(option.get_type_name(), '|');
  const bool of_a_list = message.find(" not in {") != std::string::npos ||
                         message.find(" value in {") != std::string::npos;
  if (of_a_list && words.size() > 1)
    return name + "write one of " + joined(words) + "." + did_you_mean(value, words);
  if (const std::string range = range_in(message); !range.empty()) return name + range;
  if (message.starts_with("Could not convert"))
    return name +
           (option.get_items_expected_max() == 0 ? "this option takes no value" : "write a number");
  const std::string own = option.get_name() + ": ";
  const std::string told = message.starts_with(own) ? message.substr(own.size()) : message;
  return told.find(option.get_name()) == std::string::npos ? name + told : told;
}

std::string text_of_rest(const CLI::App& command) {
  const std::vector<std::string> rest = command.remaining(), commands = command_names(command);
  const std::string& first = rest.front();
  if (!commands.empty() && !first.starts_with("-"))
    return "there is no command '" + printable(first) + "'." + did_you_mean(first, commands) +
           " There are " + joined(commands) + ".";
  // An option that is not known comes with its value among the rest.
  for (const std::string& word : rest)
    if (word.starts_with("-"))
      return "there is no option '" + printable(word) + "'." +
             did_you_mean(word.substr(0, word.find('=')), option_names(command));
  return "'" + printable(first) + "' is one argument too many";
}

std::string text_of(const CLI::App& command, const CLI::ParseError& error) {
  const std::string message = error.what();
  const bool extras = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  if (extras && !command.remaining().empty()) return text_of_rest(command);
  const CLI::Option* option = option_of(command, message);
  const std::vector<std::string> commands = command_names(command);
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    if (!command.remaining().empty()) return text_of_rest(command);
    if (option != nullptr) return missing(*option);
    if (!commands.empty()) return "name a command: " + joined(commands);
  }
  if (option == nullptr) return message;
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr)
    return wrong_number(*option, option->results().empty() ? "" : option->results().back());
  return wrong_value(*option, message);
}

}  // namespace

const CLI::App* active_command(const CLI::App& app) {
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().front();
  return at;
}

std::string full_name(const CLI::App* command) {
  if (command->get_parent() == nullptr) return "";
  const std::string before = full_name(command->get_parent());
  return (before.empty() ? "" : before + " ") + command->get_name();
}

Diagnostic usage_diagnostic(const CLI::App& app, const CLI::ParseError& error) {
  return make_error("usage", text_of(*active_command(app), error));
}

int usage_error(const Diagnostic& error, const CLI::App* command) {
  std::fputs(format_human(error, {}).c_str(), stderr);
  const std::string name = full_name(command);
  std::fprintf(stderr, "see aircut %s--help\n", name.empty() ? "" : (name + " ").c_str());
  return code(ExitCode::unknown);
}

}  // namespace aircut::cli
