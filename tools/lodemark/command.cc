#include "tools/lodemark/command.h"

#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "core/geo/time.h"
#include "tools/lodemark/output_file.h"

namespace lodemark {
namespace {

bool MayDecorate(int descriptor) {
  const char* no_color = std::getenv("NO_COLOR");
  if (no_color != nullptr && no_color[0] != '\0') return false;
  const char* terminal = std::getenv("TERM");
  if (terminal != nullptr && std::strcmp(terminal, "dumb") == 0) return false;
  return isatty(descriptor) == 1;
}

Error SystemError(const std::string& path, const char* what, int number) {
  return {ErrorCode::kIo, path + ": " + what + ": " + std::strerror(number)};
}

}  // namespace

std::string VersionText() { return LODEMARK_VERSION; }

std::string Format(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  std::va_list again;
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, arguments);
  va_end(arguments);
  std::string text(length > 0 ? static_cast<std::size_t>(length) : 0, '\0');
  if (length > 0) std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  return text;
}

std::string GroupDigits(std::int64_t number) {
  std::string text = std::to_string(number);
  const std::size_t first = number < 0 ? 1 : 0;
  for (std::size_t at = text.size(); at > first + 3; at -= 3) text.insert(at - 3, 1, ',');
  return text;
}

std::string Counted(std::int64_t number, std::string_view noun) {
  return GroupDigits(number) + " " + std::string(noun) + (number == 1 ? "" : "s");
}

std::string CalendarText(std::int64_t time_gps_ns) {
  const CalendarTime c = CalendarFromNanoseconds(time_gps_ns);
  return Format("%04d-%02d-%02d %02d:%02d:%02d", c.year, c.month, c.day, c.hour, c.minute,
                static_cast<int>(c.second));
}

void PrintMessage(std::string_view message) {
  std::fprintf(stderr, "lodemark: %.*s\n", static_cast<int>(message.size()), message.data());
}

int ReportError(const Error& error) {
  PrintMessage(error.message);
  switch (error.code) {
    case ErrorCode::kInvalidArgument:
    case ErrorCode::kUnsupported:
      return kExitUsage;
    case ErrorCode::kOutOfOrder:
    case ErrorCode::kIo:
    case ErrorCode::kBadData:
    case ErrorCode::kOutOfMemory:
      return kExitInput;
    case ErrorCode::kQueueFull:
    case ErrorCode::kInternal:
      break;
  }
  return kExitBug;
}

void PrintResult(std::string_view text) { std::fwrite(text.data(), 1, text.size(), stdout); }

bool FlushResults() { return std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }

bool StdoutIsTerminal() { return MayDecorate(STDOUT_FILENO); }
bool StderrIsTerminal() { return MayDecorate(STDERR_FILENO); }

Status WriteFileWhole(const std::string& path, std::string_view content) {
  OutputFile file;
  const Status opened = file.Open(path);
  if (!opened.ok()) return opened;
  file.Append(content);
  return file.Finish();
}

Result<std::string> ReadFileWhole(const std::string& path, std::size_t limit_bytes) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return Error{ErrorCode::kIo, path + ": is a folder, a file is needed"};
  }
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return SystemError(path, "cannot be read", errno);
  std::string content;
  char block[65536];
  std::size_t count = 0;
  while ((count = std::fread(block, 1, sizeof block, file)) > 0) {
    content.append(block, count);
    if (content.size() > limit_bytes) break;
  }
  const bool failed = std::ferror(file) != 0;
  const int failure = errno;
  std::fclose(file);
  if (failed) return SystemError(path, "cannot be read", failure);
  if (content.size() > limit_bytes) {
    return Error{ErrorCode::kBadData,
                 path + Format(": is larger than the %zu bytes such a file may have", limit_bytes)};
  }
  return content;
}

}  // namespace lodemark
