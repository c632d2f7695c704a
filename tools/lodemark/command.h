// What every subcommand shares: exit codes, messages, formatting, and writing files safely.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace lodemark {

enum ExitCode : int {
  kExitGood = 0,
  kExitUsage = 1,
  kExitInput = 2,   // unreadable or malformed input, or output that cannot be written
  kExitMissed = 3,  // ran, but no estimate, or a limit was missed
  kExitBug = 70,
};

std::string VersionText();  // "0.1.0"

// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string Format(const char* format, ...);

// "12,345"
std::string GroupDigits(std::int64_t number);

// "1 row", "12,345 rows"
std::string Counted(std::int64_t number, std::string_view noun);

// "2024-05-01 08:00:00" in GPS time.
std::string CalendarText(std::int64_t time_gps_ns);

// One line on stderr: "lodemark: message".
void PrintMessage(std::string_view message);

// Prints the error and gives the exit code that belongs to it.
int ReportError(const Error& error);

// Results on stdout. False once stdout has failed (a full disk, a closed pipe).
void PrintResult(std::string_view text);
bool FlushResults();

// May colours and cursor movements be used on the stream (a terminal, and NO_COLOR is unset)?
bool StdoutIsTerminal();
bool StderrIsTerminal();

// The file appears whole under its name, or not at all: written beside it first, then renamed.
Status WriteFileWhole(const std::string& path, std::string_view content);

// The whole file; an error for a directory, a missing file, or one above limit_bytes.
Result<std::string> ReadFileWhole(const std::string& path, std::size_t limit_bytes);

}  // namespace lodemark
