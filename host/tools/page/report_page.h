// SPDX-License-Identifier: MIT
// The report of a run as a page to look at: warnings, frames beside their truth, scores, times and resolution over its
// frames, passes.
#pragma once

#include <string>

#include "tools/page/scored_frames.h"
#include "tools/program/run_report.h"

namespace quincunx::tools {

// One HTML file that needs nothing else: no network, no file beside it. Pure.
std::string report_page(const RunReport& report, const ReportPictures& pictures = {});

// Writes `base`.txt, `base`.json and `base`.html. Errors: kIoFailure.
Status write_report(const std::string& base, const RunReport& report, const ReportPictures& pictures = {});

}  // namespace quincunx::tools
