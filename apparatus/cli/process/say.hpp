#pragma once

// What the program prints. A stream that is closed, full or read by nobody loses its messages; it ends no command.

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace tremie::cli {

/// Keeps the numbers of the standard streams from the files that are opened later, and a pipe without a reader from
/// ending the program. First of all.
void secure_streams();

void write_text_to(std::FILE* stream, const std::string& text);

template <class... Parts>
void say(std::FILE* stream, fmt::format_string<Parts...> form, Parts&&... parts) {
  write_text_to(stream, fmt::format(form, std::forward<Parts>(parts)...));
}
template <class... Parts>
void say(fmt::format_string<Parts...> form, Parts&&... parts) {
  write_text_to(stdout, fmt::format(form, std::forward<Parts>(parts)...));
}

/// Prints what the user asked for: the command has failed where it does not arrive.
void answer(const std::string& text);

/// The exit code, once all is printed: `exit_code`, or `fault` in place of 0 where an answer was lost on a full disk. Who closes a
/// pipe has read what they wanted; who closes the standard output wants the exit code alone.
int exit_code_once_printed(int exit_code, int fault);

}  // namespace tremie::cli
