// SPDX-License-Identifier: MIT
// Pages to look at: one HTML file each, which needs no network and no file beside it. Scripts of this folder draw them
// from a document of figures; plots are made by Chart.js.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

#include "embedded_file.h"
#include "tools/page/scored_frames.h"
#include "tools/program/run_report.h"

namespace quincunx::tools {

// Returns the text of an embedded file. Throws std::out_of_range for one that is not there.
std::string_view text_of(std::span<const EmbeddedFile> files, std::string_view name);

// The parts of a page that are its own.
struct PageParts {
  const char* title = nullptr;      // text without "<" and "&"
  std::string_view script;          // draws the page, with the parts of page.js and viewer.js
  const char* beside = "the .txt";  // file that says the same, for readers without scripts
};

// Returns the page of these figures, whatever names they hold. Chart.js is read from the file that the environment
// variable QUINCUNX_CHART_JS names, else from where Debian's package libjs-chart.js has it, and put into the page.
// Where it is missing the page has tables only, and says why; so does the log.
std::string make_page(const PageParts& parts, const nlohmann::ordered_json& figures);

// Returns bytes as text (RFC 4648, with padding), as pages carry pictures.
std::string base64(std::span<const std::uint8_t> bytes);

// Returns the report of a run as a page: warnings, frames beside their truth, scores, times and resolution over its
// frames, passes.
std::string report_page(const RunReport& report, const ReportPictures& pictures = {});

// Writes `base`.txt, `base`.json and `base`.html. Errors: kIoFailure.
Status write_report(const std::string& base, const RunReport& report, const ReportPictures& pictures = {});

}  // namespace quincunx::tools
