// SPDX-License-Identifier: Apache-2.0
#include "completion.hpp"
#include "altiplan_build.hpp"

#include <algorithm>

namespace altiplan::cli {
namespace {

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : between) + word;
  }
  return text;
}

/// Each of the letters with a backslash before it.
std::string escaped(const std::string& text, const std::string& letters) {
  std::string result;
  for (const char c : text) {
    result += letters.find(c) != std::string::npos ? std::string("\\") + c : std::string(1, c);
  }
  return result;
}

/// For single quotes of a shell.
std::string quoted(const std::string& text) {
  std::string result;
  for (const char c : text) {
    result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return "'" + result + "'";
}

/// The commands, without the program.
std::vector<CommandText> commands_of(const std::vector<CommandText>& all) {
  return {all.begin() + 1, all.end()};
}

/// Every name of a command's options, and those of the program, which all commands take.
std::vector<std::string> names_of(const CommandText& command, const CommandText& program) {
  std::vector<std::string> names;
  for (const CommandText* text : {&command, &program}) {
    for (const OptionText& option : text->options) {
      const bool is_programs_own = text != &command && option.names.front() == "--version";
      if (!option.is_positional && !is_programs_own) {
        names.insert(names.end(), option.names.begin(), option.names.end());
      }
    }
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

std::string bash(const std::vector<CommandText>& all) {
  std::vector<std::string> commands;
  std::string options;
  std::string words;
  for (const CommandText& command : commands_of(all)) {
    commands.push_back(command.name);
    options += "      " + command.name +
               ") names=" + quoted(joined(names_of(command, all.front()), " ")) + " ;;\n";
    for (const OptionText& option : command.options) {
      if (option.words.empty()) {
        continue;
      }
      std::vector<std::string> patterns;
      for (const std::string& name : option.names) {
        patterns.push_back(command.name + ":" + (option.is_positional ? "" : name));
      }
      words += "    " + joined(patterns, "|") + (option.is_positional ? "*" : "") +
               ") COMPREPLY=($(compgen -W " + quoted(joined(option.words, " ")) +
               " -- \"$current\")); return ;;\n";
    }
  }
  return "# Completion of altiplan in bash: source <(altiplan completion bash)\n"
         "_altiplan() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
         "  local command= names= word\n"
         "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
         "    if [[ $word != -* ]]; then command=$word; break; fi\n"
         "  done\n"
         "  COMPREPLY=()\n"
         "  if [[ $current == -* ]]; then\n"
         "    case $command in\n" +
         options + "      *) names=" + quoted(joined(names_of(all.front(), all.front()), " ")) +
         " ;;\n"
         "    esac\n"
         "    COMPREPLY=($(compgen -W \"$names\" -- \"$current\"))\n"
         "    return\n"
         "  fi\n"
         "  if [[ -z $command ]]; then\n"
         "    COMPREPLY=($(compgen -W " +
         quoted(joined(commands, " ")) +
         " -- \"$current\"))\n"
         "    return\n"
         "  fi\n"
         "  case $command:$before in\n" +
         words +
         "  esac\n"
         "}\n"
         "complete -o default -F _altiplan altiplan\n";
}

/// The values of an option for zsh: its words, else files.
std::string zsh_values(const OptionText& option) {
  const std::string type = escaped(option.type.empty() ? "value" : option.type, ":[]");
  return ":" + type + ":" +
         (option.words.empty() ? "_files" : "(" + joined(option.words, " ") + ")");
}

std::string zsh(const std::vector<CommandText>& all) {
  std::string list;
  std::string cases;
  for (const CommandText& command : commands_of(all)) {
    list += "    " + quoted(command.name + ":" + escaped(command.sentence, ":")) + "\n";
    cases += "    " + command.name + ")\n      _arguments";
    for (const OptionText& option : command.options) {
      if (option.is_positional) {
        cases += " \\\n        " + quoted("*" + zsh_values(option));
        continue;
      }
      for (const std::string& name : option.names) {
        cases += " \\\n        " + quoted("*" + name + "[" + escaped(option.sentence, "[]:\\") +
                                          "]" + (option.takes_value ? zsh_values(option) : ""));
      }
    }
    cases += "\n      ;;\n";
  }
  return "#compdef altiplan\n"
         "_altiplan() {\n"
         "  local -a commands\n"
         "  commands=(\n" +
         list +
         "  )\n"
         "  if (( CURRENT == 2 )); then\n"
         "    _describe command commands\n"
         "    return\n"
         "  fi\n"
         "  local command=$words[2]\n"
         "  shift words\n"
         "  (( CURRENT-- ))\n"
         "  case $command in\n" +
         cases +
         "  esac\n"
         "}\n"
         "if [[ $funcstack[1] == _altiplan ]]; then\n"
         "  _altiplan \"$@\"\n"
         "else\n"
         "  compdef _altiplan altiplan\n"
         "fi\n";
}

std::string fish(const std::vector<CommandText>& all) {
  std::string text = "# Completion of altiplan in fish: altiplan completion fish | source\n";
  for (const CommandText& command : commands_of(all)) {
    text += "complete -c altiplan -n __fish_use_subcommand -f -a " + command.name + " -d " +
            quoted(command.sentence) + "\n";
    const std::string seen =
        "complete -c altiplan -n '__fish_seen_subcommand_from " + command.name + "'";
    for (const OptionText& option : command.options) {
      std::string line = seen;
      for (const std::string& name : option.names) {
        if (!option.is_positional) {
          line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
        }
      }
      if (!option.words.empty()) {
        line += (option.is_positional ? " -f -a " : " -x -a ") + quoted(joined(option.words, " "));
      } else if (option.is_positional) {
        continue;  // a file, which fish completes by itself
      } else if (option.takes_value) {
        line += " -r";
      }
      text += line + " -d " + quoted(option.sentence) + "\n";
    }
  }
  return text;
}

/// For a line of roff.
std::string roff(const std::string& text) {
  std::string result;
  for (const char c : escaped(text, "\\")) {
    result += c == '-' ? std::string("\\-") : std::string(1, c);
  }
  return result.starts_with(".") || result.starts_with("'") ? "\\&" + result : result;
}

std::string option_entry(const OptionText& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.names) {
    names.push_back("\\fB" + roff(name) + "\\fR");
  }
  const std::string value = option.takes_value && !option.is_positional && !option.type.empty()
                                ? " \\fI" + roff(option.type) + "\\fR"
                                : "";
  return ".TP\n" + joined(names, ", ") + value + "\n" + roff(option.sentence) + "\n";
}

std::string options_section(const CommandText& command) {
  std::string arguments;
  std::string options;
  for (const OptionText& option : command.options) {
    (option.is_positional ? arguments : options) += option_entry(option);
  }
  return (arguments.empty() ? "" : ".SH ARGUMENTS\n" + arguments) + ".SH OPTIONS\n" + options;
}
}  // namespace

std::string completion(const std::string& shell, const std::vector<CommandText>& all) {
  return shell == "bash" ? bash(all) : shell == "zsh" ? zsh(all) : fish(all);
}

std::string manual_page(const std::string& command, const std::vector<CommandText>& all) {
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const CommandText& text) { return text.name == command; });
  const bool is_program = found == all.begin();
  const std::string name = is_program ? "altiplan" : "altiplan-" + command;
  std::string page = ".TH " + escaped(name, "-") +
                     " 1 \"\" \"altiplan " ALTIPLAN_VERSION "\" \"User Commands\"\n.SH NAME\n" +
                     roff(name) + " \\- " + roff(found->sentence) + "\n.SH SYNOPSIS\n.B altiplan" +
                     (is_program ? "\n.I COMMAND\n" : " " + roff(command) + "\n");
  for (const OptionText& option : found->options) {
    page += option.is_positional ? ".I " + roff(option.names.front()) + "\n" : "";
  }
  page += "[\\fIoptions\\fR]\n";
  if (is_program) {
    page += ".SH COMMANDS\n";
    for (const CommandText& each : commands_of(all)) {
      page += ".TP\n\\fB" + roff(each.name) + "\\fR\n" + roff(each.sentence) + "\n";
    }
  }
  page += options_section(*found);
  if (!found->footer.empty()) {
    const std::string lead = "Example:\n  ";
    const std::size_t at = found->footer.find(lead);
    page += ".SH EXAMPLE\n.EX\n" +
            roff(at == std::string::npos ? found->footer : found->footer.substr(at + lead.size())) +
            "\n.EE\n";
  }
  return page + (is_program ? ".SH SEE ALSO\n.BR altiplan\\-go (1),\n.BR altiplan\\-run (1),\n.BR "
                              "altiplan\\-check (1)\n"
                            : ".SH SEE ALSO\n.BR altiplan (1)\n");
}
}  // namespace altiplan::cli
