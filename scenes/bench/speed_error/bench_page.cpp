// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_page.h"

#include <nlohmann/json.hpp>

#include "bench/page/bench_files.h"
#include "bench/speed_error/bench_findings.h"
#include "bench/speed_error/bench_statistics.h"
#include "tools/page/base64.h"
#include "tools/page/page_template.h"

namespace quincunx::bench {
namespace {

using Json = nlohmann::ordered_json;

Json gallery_json(const Gallery& gallery) {
  Json scenes = Json::array();
  for (const GalleryScene& scene : gallery.scenes) {
    Json sheets = Json::array();
    for (const Sheet& sheet : scene.sheets) {
      sheets.push_back({{"scale", sheet.scale},
                        {"pictures", tools::base64(sheet.pictures)},
                        {"errors", tools::base64(sheet.errors)}});
    }
    scenes.push_back({{"name", scene.name}, {"x", scene.x}, {"y", scene.y}, {"sheets", std::move(sheets)}});
  }
  return {{"width", gallery.crop.width},
          {"height", gallery.crop.height},
          {"frame", gallery.frame},
          {"names", gallery.names},
          {"scenes", std::move(scenes)}};
}

Json page_json(const BenchResult& result, const Gallery& gallery) {
  Json findings = Json::array();
  for (const Finding& finding : findings_of(result)) {
    findings.push_back(
        {{"figure", finding.figure}, {"heading", finding.heading}, {"sentence", finding.sentence}});
  }
  Json measures = Json::array();
  for (const ErrorMeasure& measure : error_measures()) {
    measures.push_back(
        {{"name", measure.name}, {"label", measure.label}, {"higher", measure.higher_is_better}});
  }
  const TypicalNoise noise = typical_noise(result);
  return {{"findings", std::move(findings)},          {"measures", std::move(measures)},
          {"cost_clock", cost_clock(result.machine)}, {"noise", {{"ms", noise.ms}, {"cost", noise.cost}}},
          {"result", Json::parse(to_json(result))},   {"gallery", gallery_json(gallery)}};
}

}  // namespace

std::string page_of(const BenchResult& result, const Gallery& gallery) {
  return tools::page_from_template(
      {.files = embedded_bench_files(),
       .title = "speed against error",
       .body = "bench.html",
       .scripts = {"elements.js", "data.js", "plots.js", "frames.js", "sorted_table.js", "tables.js",
                   "viewer.js", "gallery.js", "page.js"}},
      page_json(result, gallery));
}

}  // namespace quincunx::bench
