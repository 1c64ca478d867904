#include "app/manual.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/options.h"
#include "app/version.h"
#include "io/atomic_file.h"

namespace vkcppm {
namespace {

using Words = std::vector<std::string>;

Words split(const std::string& text, char at) {
    Words parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
    return parts;
}

/// `text` with `with` in place of every `what`.
std::string replaced(std::string text, std::string_view what, std::string_view with) {
    for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += with.size()) {
        text.replace(at, what.size(), with);
    }
    return text;
}

/// The words that its value is one of: a list, or a type of words in small letters, such as thin|solid.
Words choices_of(const OptionText& option) {
    if (!option.choices.empty()) return option.choices;
    const bool words = std::ranges::all_of(option.value, [](char c) { return (c >= 'a' && c <= 'z') || c == '|'; });
    return words ? split(option.value, '|') : Words();
}

bool is_file(const OptionText& option) {
    const auto has = [&](const char* part) { return option.value.find(part) != option.value.npos; };
    return option.positional || has("FILE") || has(".exr") || has("DIR");
}

/// The first line of its help.
std::string summary_of(const std::string& help) { return help.substr(0, help.find('\n')); }

/// Text as a word of a shell, in single quotes.
std::string single_quoted(const std::string& text) { return fmt::format("'{}'", replaced(text, "'", "'\\''")); }

Words names_of(const std::vector<CommandText>& commands) {
    Words names;
    for (const CommandText& command : commands) {
        if (!command.name.empty()) names.push_back(command.name);
    }
    return names;
}

/// Text that roff shows as it is.
std::string roff(const std::string& text) {
    const std::string shown = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
    return shown.starts_with('.') || shown.starts_with('\'') ? fmt::format("\\&{}", shown) : shown;
}

/// Lines of help: filled, but for a list of choices, which keeps its lines.
std::string roff_lines(const std::string& text, bool keep_lines) {
    Words lines = split(text, '\n');
    for (std::string& line : lines) line = roff(line);
    return fmt::format("{}\n", fmt::join(lines, keep_lines ? "\n.br\n" : "\n"));
}

std::string usage_of(const CommandText& command) {
    std::string usage = command.name.empty() ? "\\fBvkcppm\\fR" : fmt::format("\\fBvkcppm {}\\fR", command.name);
    usage += " [\\fIoptions\\fR]";
    for (const OptionText& option : command.options) {
        if (option.positional) usage += fmt::format(" \\fI{}\\fR", option.names.front());
    }
    return usage;
}

std::string options_of(const CommandText& command) {
    std::string text;
    for (const OptionText& option : command.options) {
        Words names = option.names;
        for (std::string& name : names) name = fmt::format("\\fB{}\\fR", roff(name));
        text += fmt::format(".TP\n{}", fmt::join(names, ", "));
        if (!option.value.empty()) text += fmt::format(" \\fI{}\\fR", roff(option.value));
        text += fmt::format("\n{}", roff_lines(option.help, !option.choices.empty()));
    }
    return text;
}

}  // namespace

std::string manual_page() {
    const std::vector<CommandText> commands = command_texts();
    std::string page = fmt::format(".TH VKCPPM 1 \"\" \"vkcppm {}\" \"User Commands\"\n", version());
    page += ".SH NAME\nvkcppm \\- progressive photon mapping on a Vulkan device\n.SH SYNOPSIS\n";
    for (const CommandText& command : commands) page += usage_of(command) + "\n.br\n";
    for (const CommandText& command : commands) {
        std::string title = command.name.empty() ? "DESCRIPTION" : fmt::format("vkcppm {}", command.name);
        std::ranges::transform(title, title.begin(), [](unsigned char c) { return char(std::toupper(c)); });
        page += fmt::format(".SH {}\n", title) + roff_lines(command.about, false) + options_of(command);
    }
    page += ".SH EXIT STATUS\n.nf\n" + roff_lines(commands.front().footer, false) + ".fi\n";
    return page;
}

std::string bash_completion() {
    std::string options, values;
    std::set<std::string> told;  // an option is the same in every command
    const std::vector<CommandText> commands = command_texts();
    for (const CommandText& command : commands) {
        Words names;
        for (const OptionText& option : command.options) {
            if (option.positional) continue;
            names.insert(names.end(), option.names.begin(), option.names.end());
            if (option.value.empty() || !told.insert(option.names.front()).second) continue;
            const Words choices = choices_of(option);
            const std::string action =
                !choices.empty()  ? fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$word\"))", fmt::join(choices, " "))
                : is_file(option) ? ":"
                                  : "compopt +o default";
            values += fmt::format("        {}) {}; return ;;\n", fmt::join(option.names, "|"), action);
        }
        const std::string line = fmt::format("options='{}' ;;\n", fmt::join(names, " "));
        // The first command is that of all other words, the last case.
        options = command.name.empty() ? fmt::format("        *) {}", line)
                                       : fmt::format("        {}) {}{}", command.name, line, options);
    }
    return "# Completes command lines of vkcppm in bash, which completes names of files itself.\n"
           "_vkcppm() {\n"
           "    local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} options\n"
           "    COMPREPLY=()\n"
           "    case ${COMP_WORDS[1]} in\n" +
           options +
           "    esac\n"
           "    case $previous in\n" +
           values +
           "    esac\n"
           "    if [[ $word == -* ]]; then\n"
           "        COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n"
           "    elif [[ $COMP_CWORD -eq 1 ]]; then\n" +
           fmt::format("        COMPREPLY=($(compgen -W '{}' -- \"$word\"))\n", fmt::join(names_of(commands), " ")) +
           "    fi\n"
           "}\n"
           "complete -o default -F _vkcppm vkcppm\n";
}

std::string zsh_completion() {
    const std::vector<CommandText> commands = command_texts();
    std::string cases;
    for (const CommandText& command : commands) {
        std::string specs;
        for (const OptionText& option : command.options) {
            const Words choices = choices_of(option);
            const std::string action = !choices.empty()  ? fmt::format("({})", fmt::join(choices, " "))
                                       : is_file(option) ? "_files"
                                                         : " ";
            const std::string value = fmt::format(
                ":{}:{}", replaced(option.value.empty() ? option.names.front() : option.value, ":", "\\:"), action);
            if (option.positional) {
                // The first word may be a command as well.
                const bool first = command.name.empty();
                specs += fmt::format("            {}\n", single_quoted(first ? "1:SCENE:_vkcppm_first" : value));
                continue;
            }
            std::string help = summary_of(option.help);
            for (const char* special : {"\\", "[", "]"}) help = replaced(help, special, std::string("\\") + special);
            for (const std::string& name : option.names) {
                const bool equals = name.starts_with("--") && !option.value.empty();
                specs += fmt::format("            {}\n",
                                     single_quoted(fmt::format("{}{}[{}]{}", name, equals ? "=" : "", help,
                                                               option.value.empty() ? "" : value)));
            }
        }
        const std::string text = fmt::format("        {}) _arguments \\\n{}            ;;\n",
                                             command.name.empty() ? "*" : command.name, replaced(specs, "\n", " \\\n"));
        cases = command.name.empty() ? text : text + cases;
    }
    return "#compdef vkcppm\n"
           "# Completes command lines of vkcppm in zsh.\n"
           "_vkcppm_first() {\n" +
           fmt::format("    _alternative 'commands:command:({})' 'files:scene:_files'\n",
                       fmt::join(names_of(commands), " ")) +
           "}\n"
           "_vkcppm() {\n"
           "    local command=\n"
           "    (( CURRENT > 2 )) && command=$words[2]\n"
           "    case $command in\n" +
           fmt::format("        {}) shift words; (( CURRENT-- )) ;;\n", fmt::join(names_of(commands), "|")) +
           "    esac\n"
           "    case $command in\n" +
           cases +
           "    esac\n"
           "}\n"
           "_vkcppm \"$@\"\n";
}

std::string fish_completion() {
    const std::vector<CommandText> commands = command_texts();
    const auto quoted = [](const std::string& text) {
        return fmt::format("'{}'", replaced(replaced(text, "\\", "\\\\"), "'", "\\'"));
    };
    const std::string any = fmt::format("{}", fmt::join(names_of(commands), " "));
    std::string text = "# Completes command lines of vkcppm in fish.\n";
    for (const CommandText& command : commands) {
        if (!command.name.empty()) {
            text += fmt::format("complete -c vkcppm -n __fish_use_subcommand -a {} -d {}\n", command.name,
                                quoted(summary_of(command.about)));
        }
        const std::string where = command.name.empty() ? "not __fish_seen_subcommand_from " + any
                                                       : "__fish_seen_subcommand_from " + command.name;
        for (const OptionText& option : command.options) {
            if (option.positional) continue;
            std::string line = fmt::format("complete -c vkcppm -n {}", quoted(where));
            for (const std::string& name : option.names)
                line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
            const Words choices = choices_of(option);
            if (!choices.empty()) line += " -x -a " + quoted(fmt::format("{}", fmt::join(choices, " ")));
            else if (!option.value.empty()) line += is_file(option) ? " -r -F" : " -x";
            text += fmt::format("{} -d {}\n", line, quoted(summary_of(option.help)));
        }
    }
    return text;
}

void write_manual(const std::filesystem::path& folder) {
    write_file(folder / "vkcppm.1", manual_page());
    write_file(folder / "vkcppm.bash", bash_completion());
    write_file(folder / "_vkcppm", zsh_completion());
    write_file(folder / "vkcppm.fish", fish_completion());
}

}  // namespace vkcppm
