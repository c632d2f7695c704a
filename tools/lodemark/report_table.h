// The figures and the table of results at the top of the report page.
#pragma once

#include <string>
#include <vector>

#include "tools/lodemark/compare_table.h"
#include "tools/lodemark/run_errors.h"
#include "tools/lodemark/run_folder.h"
#include "tools/lodemark/text_table.h"
#include "tools/report/report.h"

namespace lodemark {

// Results where no truth is known: what the runs say about themselves.
TextTable UncheckedTable(const std::vector<RunFolder>& runs, const std::vector<std::string>& names);

// Errors at the times that every run answered: the fair comparison where some answer less. No rows
// where all answer the same epochs, or none in common.
TextTable CommonEpochsTable(const std::vector<RunErrors>& runs,
                            const std::vector<std::string>& names);

// The few numbers a reader wants first: of the runs compared with the truth, or where there are
// none of the table.
void AddFigures(const std::vector<ComparedRun>& compared, const TextTable& table, Report* report);

}  // namespace lodemark
