// SPDX-License-Identifier: MIT
#include "tools/page/report_page.h"

#include <nlohmann/json.hpp>

#include "tools/page/page_template.h"
#include "tools/program/atomic_file.h"

namespace quincunx::tools {
namespace {

using Json = nlohmann::ordered_json;

Json pictures_json(const ReportPictures& pictures) {
  if (pictures.frames.empty()) return nullptr;
  Json kinds = Json::array();
  for (const ReportPictures::Kind& kind : pictures.kinds)
    kinds.push_back({{"name", kind.name}, {"map", kind.is_map}});
  Json frames = Json::array();
  for (const ReportPictures::Frame& frame : pictures.frames) {
    Json pngs = Json::array();
    for (const std::vector<std::uint8_t>& png : frame.pngs)
      pngs.push_back(base64(png));
    frames.push_back({{"index", frame.index}, {"pngs", std::move(pngs)}});
  }
  return {
      {"width", pictures.crop.width}, {"height", pictures.crop.height}, {"x", pictures.x}, {"y", pictures.y},
      {"kinds", std::move(kinds)},    {"frames", std::move(frames)}};
}

}  // namespace

std::string report_page(const RunReport& report, const ReportPictures& pictures) {
  return page_from_template({.files = {},
                             .title = "run report",
                             .body = "report.html",
                             .scripts = {"elements.js", "viewer.js", "report.js"}},
                            {{"run", Json::parse(to_json(report))}, {"pictures", pictures_json(pictures)}});
}

Status write_report(const std::string& base, const RunReport& report, const ReportPictures& pictures) {
  if (Status status = write_text(base + ".txt", to_text(report)); !status.ok()) return status;
  if (Status status = write_text(base + ".json", to_json(report)); !status.ok()) return status;
  return write_text(base + ".html", report_page(report, pictures));
}

}  // namespace quincunx::tools
