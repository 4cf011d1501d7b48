// SPDX-License-Identifier: MIT
#include "tools/page/report_page.h"

#include <nlohmann/json.hpp>

#include "tools/page/page_template.h"
#include "tools/program/atomic_file.h"

namespace quincunx::tools {

std::string report_page(const RunReport& report) {
  return page_from_template({}, "report.html", {"elements.js", "report.js"},
                            {{"run", nlohmann::ordered_json::parse(to_json(report))}});
}

Status write_report(const std::string& base, const RunReport& report) {
  if (Status status = write_text(base + ".txt", to_text(report)); !status.ok()) return status;
  if (Status status = write_text(base + ".json", to_json(report)); !status.ok()) return status;
  return write_text(base + ".html", report_page(report));
}

}  // namespace quincunx::tools
