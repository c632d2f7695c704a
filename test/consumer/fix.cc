// A C++ user's program: ranges to known points, and a session that is opened and closed.
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "lodemark/lodemark.h"

namespace {

struct Close {
  void operator()(lodemark_session* session) const { lodemark_session_close(session); }
};

int Fail() {
  std::fprintf(stderr, "%s\n", lodemark_last_error());
  return 1;
}

// Exact distances from the receiver to points around it, by their directions in its local frame.
bool MakeRanges(const double (&geodetic)[3], std::vector<lodemark_range>* ranges) {
  const double directions[][3] = {{20, 5, 1}, {-8, 30, 2}, {3, -25, 9}, {-30, -30, 12}};
  for (const double(&enu_m)[3] : directions) {
    lodemark_range range = {};
    range.struct_size = sizeof range;
    range.clock_group = LODEMARK_CLOCK_GROUP_NONE;
    range.range_m = std::hypot(enu_m[0], enu_m[1], enu_m[2]);
    range.sigma_m = 0.1;
    if (lodemark_ecef_from_enu(geodetic, enu_m, range.point_in_ecef_m) < 0) return false;
    ranges->push_back(range);
  }
  return true;
}

}  // namespace

int main() {
  lodemark_session* opened = nullptr;
  if (lodemark_session_open(nullptr, &opened) < 0) return Fail();
  const std::unique_ptr<lodemark_session, Close> session(opened);

  const double geodetic[3] = {48.2, 16.37, 180.0};
  std::vector<lodemark_range> ranges;
  if (!MakeRanges(geodetic, &ranges)) return Fail();
  lodemark_solve_options options = {};
  options.struct_size = sizeof options;
  options.present = LODEMARK_SOLVE_HAS_START;
  if (lodemark_ecef_from_geodetic(geodetic, options.start_in_ecef_m) < 0) return Fail();
  options.start_in_ecef_m[2] += 3.0;

  lodemark_solution solution = {};
  solution.struct_size = sizeof solution;
  const lodemark_status status = lodemark_position_solve(
      ranges.data(), static_cast<int32_t>(ranges.size()), &options, &solution, nullptr);
  if (status < 0) return Fail();
  std::printf("latitude %.5f longitude %.5f height %.0f m\n", solution.latitude_deg,
              solution.longitude_deg, solution.height_m);
  return status;
}
