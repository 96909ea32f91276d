#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "flexura/app/program_help.h"

namespace flexura {
namespace {

// Escapes text for roff: backslashes, leading dots and quotes have a meaning there, and lines may break at a
// plain hyphen.
std::string roff(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else {
      if ((c == '.' || c == '\'') && (escaped.empty() || escaped.back() == '\n')) escaped += "\\&";
      escaped += c;
    }
  }
  return escaped;
}

// Escapes text and keeps its line breaks.
std::string roff_lines(const std::string& text) {
  std::string lines;
  for (const char c : roff(text)) lines += c == '\n' ? std::string("\n.br\n") : std::string(1, c);
  return lines;
}

std::string entry(const OptionHelp& option) {
  std::vector<std::string> names;
  names.reserve(option.names.size());
  for (const std::string& name : option.names) names.push_back("\\fB" + roff(name) + "\\fR");
  const bool has_value =
      option.takes != Takes::nothing && !option.value.empty() && option.value != option.names.front();
  return fmt::format(".TP\n{}{}\n{}\n", fmt::join(names, ", "),
                     has_value ? " \\fI" + roff(option.value) + "\\fR" : "", roff_lines(option.meaning));
}

}  // namespace

std::string manual_page(const ProgramHelp& help) {
  std::string page = fmt::format(
      ".TH {0} 1 \"\" \"{0} {1}\" \"User commands\"\n.SH NAME\n{0} \\- {2}\n"
      ".SH SYNOPSIS\n.B {0}\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n",
      help.name, roff(help.version), roff(help.meaning));
  std::string group;
  for (const CommandHelp& command : help.commands) {
    if (command.group != group) {
      group = command.group;
      std::string heading = group;
      for (char& c : heading)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
      page += ".SH \"" + roff(heading) + "\"\n";
    }
    page += fmt::format(".SS \"{} {}\"\n{}.\n", help.name, roff(command.name), roff(command.meaning));
    for (const OptionHelp& positional : command.positionals) page += entry(positional);
    for (const OptionHelp& option : command.options) page += entry(option);
    if (!command.example.empty())
      page += fmt::format(".PP\nExample:\n.PP\n.nf\n.RS\n{}\n.RE\n.fi\n", roff(command.example));
  }
  return page +
         ".SH \"EXIT STATUS\"\n.TP\n.B 0\nDone.\n.TP\n.B 1\nUnsafe, or a target was not reached.\n.TP\n.B "
         "2\nBad "
         "input: one line states the file, the line, what is wrong and what was expected.\n.TP\n.B 3\nThe "
         "system failed: for example, a file could not be written.\n";
}

}  // namespace flexura
