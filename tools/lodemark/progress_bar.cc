#include "tools/lodemark/progress_bar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "tools/lodemark/command.h"

namespace lodemark {
namespace {

constexpr int kCells = 30;
constexpr auto kQuietFirst = std::chrono::milliseconds(700);
constexpr auto kBetweenDraws = std::chrono::milliseconds(100);

}  // namespace

std::string ProgressLine(const std::string& label, double share, double elapsed_s) {
  constexpr std::array<const char*, 8> kEighths = {" ", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};
  const double done = std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.0;
  const int eighths = static_cast<int>(std::floor(done * kCells * 8.0));
  std::string bar;
  for (int i = 0; i < kCells; ++i) {
    const int filled = std::clamp(eighths - 8 * i, 0, 8);
    bar += filled == 8 ? "█" : kEighths[static_cast<std::size_t>(filled)];
  }
  std::string line = label + " ▕" + bar + "▏" + Format("%4d %%", static_cast<int>(100.0 * done));
  if (done > 0.02 && done < 1.0) {
    const int left_s = static_cast<int>(std::lround(elapsed_s * (1.0 - done) / done));
    line += Format("  %d:%02d left", left_s / 60, left_s % 60);
  }
  return line;
}

ProgressBar::ProgressBar(std::string label, bool enabled)
    : label_(std::move(label)), enabled_(enabled), start_(Clock::now()), last_(start_) {}

ProgressBar::~ProgressBar() { Finish(); }

void ProgressBar::Update(double share) {
  if (!enabled_) return;
  const Clock::time_point now = Clock::now();
  if (now - start_ < kQuietFirst || now - last_ < kBetweenDraws) return;
  last_ = now;
  drawn_ = true;
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  std::fprintf(stderr, "\r\033[K%s", ProgressLine(label_, share, elapsed_s).c_str());
  std::fflush(stderr);
}

void ProgressBar::Finish() {
  if (!drawn_) return;
  drawn_ = false;
  std::fprintf(stderr, "\r\033[K");
  std::fflush(stderr);
}

}  // namespace lodemark
