// A progress bar on stderr for work of more than a second; silent when stderr is no terminal.
#pragma once

#include <chrono>
#include <string>

namespace lodemark {

class ProgressBar {
 public:
  // enabled: draw on stderr. The caller decides, usually by StderrIsTerminal().
  ProgressBar(std::string label, bool enabled);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // Share done, 0..1. Cheap to call often: draws at most ten times a second.
  void Update(double share);

  // Clears the line. Also done by the destructor.
  void Finish();

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool enabled_;
  bool drawn_ = false;
  Clock::time_point start_;
  Clock::time_point last_;
};

// "label [████▌     ]  45 %  0:12 left", without the cursor movements around it.
std::string ProgressLine(const std::string& label, double share, double elapsed_s);

}  // namespace lodemark
