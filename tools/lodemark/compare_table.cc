#include "tools/lodemark/compare_table.h"

#include <cmath>

#include "tools/lodemark/command.h"

namespace lodemark {
namespace {

std::string Percent(const Share& share) {
  return share.of > 0 ? Format("%.1f", 100.0 * share.value()) : "";
}

// One value per run, by a function of its statistics.
template <typename Function>
std::vector<std::string> Each(const std::vector<ComparedRun>& runs, Function function) {
  std::vector<std::string> values;
  for (const ComparedRun& run : runs) values.push_back(function(run.statistics));
  return values;
}

using SpreadMember = Spread ErrorStatistics::*;
using ValueMember = double Spread::*;

bool AnyHas(const std::vector<ComparedRun>& runs, SpreadMember spread) {
  for (const ComparedRun& run : runs) {
    if ((run.statistics.*spread).count > 0) return true;
  }
  return false;
}

void AddSpreadRow(const char* label, const std::vector<ComparedRun>& runs, SpreadMember spread,
                  ValueMember value, const char* unit, TextTable* table) {
  if (!AnyHas(runs, spread)) return;
  table->AddRow(label,
                Each(runs,
                     [=](const ErrorStatistics& statistics) {
                       const Spread& of = statistics.*spread;
                       return of.count > 0 ? MetresText(of.*value) : std::string();
                     }),
                unit);
}

}  // namespace

std::string MetresText(double value) {
  return Format(std::abs(value) >= 1000.0 ? "%.0f" : "%.2f", value);
}

TextTable CompareTable(const std::vector<ComparedRun>& runs) {
  std::vector<std::string> names;
  for (const ComparedRun& run : runs) names.push_back(Printable(run.name));
  TextTable table(std::move(names));
  table.AddSection("Coverage");
  table.AddRow("epochs expected",
               Each(runs, [](const ErrorStatistics& s) { return GroupDigits(s.expected_epochs); }));
  table.AddRow("epochs answered",
               Each(runs, [](const ErrorStatistics& s) { return GroupDigits(s.answered_epochs); }));
  table.AddRow(
      "coverage",
      Each(runs, [](const ErrorStatistics& s) { return Format("%.1f", 100.0 * s.coverage()); }),
      "%");

  table.AddSection("Horizontal error");
  AddSpreadRow("mean", runs, &ErrorStatistics::horizontal_m, &Spread::mean, "m", &table);
  AddSpreadRow("RMSE", runs, &ErrorStatistics::horizontal_m, &Spread::rmse, "m", &table);
  AddSpreadRow("50 % below", runs, &ErrorStatistics::horizontal_m, &Spread::p50, "m", &table);
  AddSpreadRow("68 % below", runs, &ErrorStatistics::horizontal_m, &Spread::p68, "m", &table);
  AddSpreadRow("95 % below", runs, &ErrorStatistics::horizontal_m, &Spread::p95, "m", &table);
  AddSpreadRow("largest", runs, &ErrorStatistics::horizontal_m, &Spread::max, "m", &table);

  if (AnyHas(runs, &ErrorStatistics::up_m)) {
    table.AddSection("Height and 3D error");
    AddSpreadRow("up, mean", runs, &ErrorStatistics::up_m, &Spread::mean, "m", &table);
    AddSpreadRow("up, RMSE", runs, &ErrorStatistics::up_m, &Spread::rmse, "m", &table);
    AddSpreadRow("up, 95 % below", runs, &ErrorStatistics::up_m, &Spread::p95, "m", &table);
    AddSpreadRow("3D, RMSE", runs, &ErrorStatistics::three_d_m, &Spread::rmse, "m", &table);
    AddSpreadRow("3D, 95 % below", runs, &ErrorStatistics::three_d_m, &Spread::p95, "m", &table);
  }
  if (AnyHas(runs, &ErrorStatistics::horizontal_velocity_mps)) {
    const SpreadMember horizontal = &ErrorStatistics::horizontal_velocity_mps;
    table.AddSection("Velocity error");
    AddSpreadRow("horizontal, RMSE", runs, horizontal, &Spread::rmse, "m/s", &table);
    AddSpreadRow("horizontal, 50 % below", runs, horizontal, &Spread::p50, "m/s", &table);
    AddSpreadRow("horizontal, 95 % below", runs, horizontal, &Spread::p95, "m/s", &table);
    AddSpreadRow("up, RMSE", runs, &ErrorStatistics::up_velocity_mps, &Spread::rmse, "m/s", &table);
  }

  table.AddSection("Honesty");
  AddSpreadRow("stated accuracy, mean", runs, &ErrorStatistics::stated_accuracy_m, &Spread::mean,
               "m", &table);
  table.AddRow("within stated accuracy (68 %)",
               Each(runs, [](const ErrorStatistics& s) { return Percent(s.within_accuracy); }),
               "%");
  table.AddRow("beyond 3 sigma (1.1 %)",
               Each(runs, [](const ErrorStatistics& s) { return Percent(s.beyond_3_sigma); }), "%");
  AddSpreadRow("NEES, mean (3)", runs, &ErrorStatistics::nees, &Spread::mean, "", &table);
  const auto violations = [](const Share& share) {
    return share.of > 0 ? GroupDigits(share.count) : std::string();
  };
  const auto add_violations = [&](const char* label, Share ErrorStatistics::* share) {
    const auto counts = Each(runs, [&](const ErrorStatistics& s) { return violations(s.*share); });
    const bool one = runs.size() == 1 && counts.front() == "1";
    table.AddRow(label, counts, one ? "epoch" : "epochs");
  };
  add_violations("beyond protection level", &ErrorStatistics::beyond_protection);
  add_violations("beyond vertical one", &ErrorStatistics::beyond_vertical_protection);
  return table;
}

}  // namespace lodemark
