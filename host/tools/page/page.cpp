// SPDX-License-Identifier: MIT
#include "tools/page/page.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "embedded_page_files.h"
#include "tools/program/atomic_file.h"

namespace quincunx::tools {
namespace {

using Json = nlohmann::ordered_json;

// Returns Chart.js; empty where it is missing.
std::string chart_library() {
  const char* const set = std::getenv("QUINCUNX_CHART_JS");
  const std::string path = set != nullptr ? set : "/usr/share/javascript/chart.js/chart.min.js";
  const Result<std::string> text = read_text(path);
  if (text.ok()) return text.value();
  spdlog::warn("the page has tables only: {}; for plots, install the Debian package libjs-chart.js",
               text.status().message());
  return {};
}

// JSON inside a script element: no "</script>" or "<!--" may end it, whatever a name holds.
std::string safe_in_script(const std::string& json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

// Replaces the first place where `mark` stands.
void put(std::string& page, std::string_view mark, std::string_view text) {
  page.replace(page.find(mark), mark.size(), text);
}

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

std::string text_in_script(const Json& figures) {
  return safe_in_script(figures.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string page_of(const PageParts& parts, std::string_view figures) {
  const auto shared = [](std::string_view name) { return text_of(embedded_page_files(), name); };
  std::string page{shared("page.html")};
  std::string script{shared("page.js")};
  script += shared("viewer.js");
  script += parts.script;
  // From the end to the beginning, so that no mark is found in what was put in.
  put(page, "/*script*/", script);
  put(page, "/*library*/", chart_library());
  put(page, "/*data*/", figures);
  put(page, "/*beside*/", parts.beside);
  put(page, "/*style*/", shared("page.css"));
  put(page, "/*title*/", parts.title);
  return page;
}

}  // namespace

std::string_view text_of(std::span<const EmbeddedFile> files, std::string_view name) {
  for (const EmbeddedFile& file : files) {
    if (file.name == name) return file.text;
  }
  throw std::out_of_range("page file " + std::string(name));
}

std::string make_page(const PageParts& parts, const Json& figures) {
  return page_of(parts, text_in_script(figures));
}

std::string base64(std::span<const std::uint8_t> bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t j = i; j < i + 3; ++j)
      group = group << 8 | (j < bytes.size() ? bytes[j] : 0u);
    for (std::size_t j = 0; j < 4; ++j)
      text += i + j <= bytes.size() ? kDigits[group >> (18 - 6 * j) & 63] : '=';
  }
  return text;
}

std::string report_page(const RunReport& report, const ReportPictures& pictures) {
  return page_of({.title = "run report", .script = text_of(embedded_page_files(), "report.js")},
                 fmt::format(R"({{"run":{},"pictures":{}}})", safe_in_script(to_json(report)),
                             text_in_script(pictures_json(pictures))));
}

Status write_report(const std::string& base, const RunReport& report, const ReportPictures& pictures) {
  if (Status status = write_text(base + ".txt", to_text(report)); !status.ok()) return status;
  if (Status status = write_text(base + ".json", to_json(report)); !status.ok()) return status;
  return write_text(base + ".html", report_page(report, pictures));
}

}  // namespace quincunx::tools
