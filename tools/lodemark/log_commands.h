// lodemark log info, check and convert.
#pragma once

#include <string>
#include <vector>

namespace lodemark {

struct LogOptions {
  std::vector<std::string> files;  // or folders, whose files are meant
  std::string out;                 // convert: a folder
  bool json = false;
};

int RunLogInfo(const LogOptions& options);
int RunLogCheck(const LogOptions& options);
int RunLogConvert(const LogOptions& options);

}  // namespace lodemark
