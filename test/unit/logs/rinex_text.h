// Builds the lines of RINEX files that tests read.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

namespace lodemark::test {

inline std::string HeaderLine(std::string content, const std::string& label) {
  content.resize(60, ' ');
  return content + label + "\n";
}

inline std::string Header(std::string version, const std::string& type,
                          const std::string& more = {}) {
  version.resize(4, ' ');
  return HeaderLine("     " + version + "           " + type, "RINEX VERSION / TYPE") + more +
         HeaderLine("", "END OF HEADER");
}

// Numbers of 19 columns after the given beginning.
inline std::string NumberLine(std::string line, const std::vector<double>& numbers) {
  for (const double number : numbers) {
    char text[32];
    std::snprintf(text, sizeof text, "%19.12E", number);
    line += text;
  }
  return line + "\n";
}

// An epoch line with three numbers, then lines of four.
inline std::string RecordText(const std::string& epoch, std::size_t indent,
                              const std::vector<double>& numbers) {
  std::string text = NumberLine(epoch, {numbers.begin(), numbers.begin() + 3});
  for (std::size_t i = 3; i < numbers.size(); i += 4) {
    const std::size_t end = std::min(i + 4, numbers.size());
    text +=
        NumberLine(std::string(indent, ' '), {numbers.begin() + static_cast<std::ptrdiff_t>(i),
                                              numbers.begin() + static_cast<std::ptrdiff_t>(end)});
  }
  return text;
}

}  // namespace lodemark::test
