// SPDX-License-Identifier: MIT
// The page as a reader has it: opened in headless Chromium, where a probe script looks at what the page drew,
// presses its buttons and leaves what it saw in the document.
#include <cstdlib>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/sample_result.h"
#include "bench/speed_error/bench_page.h"
#include "bench/traces/trace_command.h"
#include "page_fixture.h"
#include "skip.h"
#include "tools/image/image_io.h"

namespace quincunx::bench {
namespace {

using Json = nlohmann::json;

using testing::PageInBrowser;

constexpr Extent kCrop{16, 8};
constexpr int kPictures = 3;  // truth and two methods

constexpr const char* kProbe = R"(<script>
probe.wait();
(async () => {
  const { all, chart, choose } = probe;
  const frame = document.querySelector("#viewer .frame");
  const canvases = all("#viewer canvas");
  const pixels = () => canvases.map((c) => [...c.getContext("2d").getImageData(1, 1, 1, 1).data].slice(0, 3));
  const button = (name) => all("#viewer button").find((b) => b.textContent === name);
  // Waits until the pictures have changed; gives up where they do not.
  const chosen = async (select, index) => {
    const before = JSON.stringify(pixels());
    select.selectedIndex = index;
    select.dispatchEvent(new Event("change"));
    await probe.until(() => JSON.stringify(pixels()) !== before);
    return pixels();
  };
  await probe.until(() => all("#viewer .stage[data-ready]").length);
  const seen = window.seen;
  const marks = (of) => of.data.datasets.filter((dataset) => dataset.label !== "front");
  const plot = chart("plot");
  seen.points = marks(plot).map((dataset) => [dataset.label, dataset.pointStyle]);
  seen.errorBar = plot.data.datasets[0].data.map(({ x }) => x);
  seen.front = plot.data.datasets.at(-1).data.length;
  seen.axes = [plot.scales.x.type, plot.scales.copies.type, plot.scales.y.type];
  plot.canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight" }));
  seen.tip = [plot.tooltip.body[0].lines, plot.canvas.getAttribute("aria-label")];
  const small = all("#small-plots canvas").map((canvas) => Chart.getChart(canvas));
  seen.smallPlots = small.length;
  seen.smallPoints = small.flatMap(marks).length;
  seen.misplaced = probe.misplaced();
  const bars = () => chart("frame-plot").data.datasets.map(probe.values);
  seen.frameBars = bars();
  seen.seventy = chart("seventy-plot").data.datasets[0].explain(0);
  seen.findings = all("#findings .finding").length;
  choose("frame-clock", "processor_");
  seen.otherClock = bars();
  document.querySelector("#small-plots button:last-child").click();
  seen.enlarged = [document.getElementById("plot-scene").value, document.getElementById("plot-scale").value];

  choose("table-scale", "");
  const lines = () => all("#rows-table tbody tr").filter((r) => !r.hidden).map((r) => r.children[2].textContent + r.children[1].textContent);
  seen.unsorted = lines();
  const head = all("#rows-table th button").find((b) => b.textContent === "FLIP");
  head.click();
  seen.sorted = lines();
  head.click();
  seen.sortedBack = lines();

  const [scene, at, left, right] = all("#viewer select");
  seen.first = pixels();
  seen.otherMethod = await chosen(left, 1);
  seen.truthLeft = await chosen(left, 0);
  seen.errorMap = await chosen(left, 3);
  seen.otherScene = await chosen(scene, 1);
  button("flip").click();
  seen.flipped = [0, 1].map(() => { frame.dispatchEvent(new Event("pointerdown")); return getComputedStyle(canvases[0]).visibility; });
  button("wipe").click();
  const wipe = document.querySelector("#viewer .wipe");
  seen.wiped = [10, 90].map((value) => { wipe.value = value; wipe.dispatchEvent(new Event("input")); return canvases[0].style.clipPath; });
  probe.end();
})();
</script>)";

constexpr const char* kSections = R"(<script>
probe.wait();
window.seen.sections = probe.all("main section").map((section) => section.id);
window.seen.links = probe.all("nav a").map((link) => link.getAttribute("href"));
window.seen.canvases = probe.all(".plot canvas").length;
window.seen.rows = probe.all("#rows-table tbody tr").length;
window.seen.note = document.getElementById("no-plots")?.textContent ?? "";
probe.end();
</script>)";

// Picture k of scene s at scale index z: every pixel of one colour.
std::uint8_t level_of(int scene, int scale, int picture) {
  return static_cast<std::uint8_t>(100 * scene + 40 * picture + scale);
}

std::vector<std::uint8_t> sheet_of(int scene, int scale, int channels) {
  std::vector<std::uint8_t> texels;
  for (int y = 0; y < kCrop.height; ++y) {
    for (int picture = 0; picture < kPictures; ++picture) {
      const std::uint8_t level = channels == 1 && picture == 0 ? 0 : level_of(scene, scale, picture);
      texels.insert(texels.end(), static_cast<std::size_t>(kCrop.width * channels), level);
    }
  }
  auto png = tools::encode_png({kCrop.width, kCrop.height * kPictures}, channels, texels);
  EXPECT_TRUE(png.ok());
  return png.value();
}

Gallery sample_gallery() {
  Gallery gallery{.crop = kCrop, .frame = 1, .names = {"truth", "bilinear", "quincunx:mean"}, .scenes = {}};
  for (int scene = 0; scene < 2; ++scene) {
    gallery.scenes.push_back({.name = scene == 0 ? "pan" : "wires", .x = 3, .y = 4, .sheets = {}});
    int index = 0;
    for (const double scale : {0.5, 0.7, 0.85, 1.0}) {
      gallery.scenes.back().sheets.push_back({scale, sheet_of(scene, index, 3), sheet_of(scene, index, 1)});
      ++index;
    }
  }
  return gallery;
}

BenchResult sample_of_two_scenes() {
  BenchResult result = testing::sample_result();
  const BenchResult one = result;
  result.scenes.push_back({"wires", "wires", "thin lines", 0.02, 0.1, {}});
  const auto repeat = [](auto& rows, const auto& from) {
    for (auto row : from) {
      row.scene = "wires";
      rows.push_back(row);
    }
  };
  repeat(result.rows, one.rows);
  repeat(result.copies, one.copies);
  repeat(result.frames, one.frames);
  for (Row& row : result.rows)
    row.quality.flip += row.scene == "wires" ? 0.01 : 0;
  return result;
}

Json grey(int scene, int scale, int picture) {
  const int level = level_of(scene, scale, picture);
  return {level, level, level};
}

TEST_F(PageInBrowser, DrawsItsPlotsSortsItsTablesAndSwitchesItsPictures) {
  if (!there()) QUINCUNX_SKIP("there is no chromium");
  const Json seen = this->seen(page_of(sample_of_two_scenes(), sample_gallery()), kProbe);
  EXPECT_EQ(seen["errors"], Json::array());
  EXPECT_EQ(seen["points"], Json::parse(R"([["bilinear", "circle"], ["quincunx:mean", "rectRot"]])"));
  EXPECT_EQ(seen["errorBar"], (Json{.99, 1, 1.01}));
  EXPECT_EQ(seen["front"],
            2 + 3);  // the one is quicker, the other better; and the corners before and behind them
  EXPECT_EQ(seen["axes"], (Json{"logarithmic", "logarithmic", "linear"}));
  EXPECT_EQ(seen["tip"][0][0], "bilinear at scale 0.7");
  EXPECT_EQ(seen["tip"][1].get<std::string>().find("bilinear at scale 0.7"), 0u);
  EXPECT_EQ(seen["smallPlots"], 2 * 4);
  EXPECT_EQ(seen["smallPoints"], 2 * 4 * 2);
  EXPECT_EQ(seen["misplaced"], 0);
  EXPECT_EQ(seen["frameBars"].size(), 3u);
  EXPECT_EQ(seen["frameBars"][2], (Json{1, 1, 1, 1})) << "the resolve at each scale";
  EXPECT_NE(seen["frameBars"], seen["otherClock"]);
  EXPECT_EQ(seen["enlarged"], (Json{"wires", "1"}));
  EXPECT_EQ(seen["seventy"].get<std::string>().find("pan: 70 % of the time on the wall"), 0u)
      << seen["seventy"];
  EXPECT_GE(seen["findings"], 5);

  EXPECT_EQ(seen["unsorted"].size(), 16u);
  EXPECT_EQ(seen["sorted"][0], "quincunx:mean0.5");  // the least FLIP first
  EXPECT_EQ(seen["sortedBack"][0], "bilinear0.5");
  EXPECT_NE(seen["unsorted"], seen["sorted"]);

  EXPECT_EQ(seen["first"], (Json{grey(0, 0, 2), grey(0, 0, 0)}));  // the last method beside truth
  EXPECT_EQ(seen["otherMethod"], (Json{grey(0, 0, 1), grey(0, 0, 0)}));
  EXPECT_EQ(seen["truthLeft"], (Json{grey(0, 0, 0), grey(0, 0, 0)}));
  EXPECT_EQ(seen["errorMap"][1], grey(0, 0, 0));
  EXPECT_NE(seen["errorMap"][0], grey(0, 0, 1));  // in false colour
  EXPECT_EQ(seen["otherScene"][1], grey(1, 0, 0));
  EXPECT_EQ(seen["flipped"], (Json{"hidden", "visible"}));
  EXPECT_NE(seen["wiped"][0], seen["wiped"][1]);
}

TEST_F(PageInBrowser, ShowsSomething) {
  if (!there()) QUINCUNX_SKIP("there is no chromium");
  browse(page_of(sample_of_two_scenes(), sample_gallery()),
         "--hide-scrollbars --window-size=900,1600 --screenshot='" + folder_.file("shot.png") + "'");
  const auto shot = tools::read_image(folder_.file("shot.png"));
  ASSERT_TRUE(shot.ok()) << shot.status().message();
  EXPECT_EQ(shot->extent, (Extent{900, 1600}));
  std::set<std::tuple<float, float, float>> colours;
  for (int y = 0; y < 1600; ++y) {
    for (int x = 0; x < 900; ++x)
      colours.insert({shot->at(x, y, 0), shot->at(x, y, 1), shot->at(x, y, 2)});
  }
  EXPECT_EQ(text_of("err").find("CONSOLE"), std::string::npos) << text_of("err");
  EXPECT_GT(colours.size(), 100u);  // text has some dozen levels of one colour; plots and bars add theirs
}

TEST_F(PageInBrowser, WithoutPicturesHasNoViewer) {
  if (!there()) QUINCUNX_SKIP("there is no chromium");
  const Json seen = this->seen(page_of(testing::sample_result(), {}), kSections);
  EXPECT_EQ(seen["errors"], Json::array());
  EXPECT_EQ(seen["links"], (Json{"#error", "#frame", "#figures", "#method"}));
  EXPECT_EQ(seen["canvases"], 3);
  EXPECT_EQ(seen["note"], "");
}

TEST_F(PageInBrowser, WithoutTheLibraryHasTablesAndNamesThePackage) {
  if (!there()) QUINCUNX_SKIP("there is no chromium");
  setenv("QUINCUNX_CHART_JS", "/no/such/chart.js", 1);
  const std::string page = page_of(sample_of_two_scenes(), sample_gallery());
  unsetenv("QUINCUNX_CHART_JS");
  const Json seen = this->seen(page, kSections);
  EXPECT_EQ(seen["errors"], Json::array());
  EXPECT_EQ(seen["sections"], (Json{"findings", "pictures", "figures", "method"}));
  EXPECT_EQ(seen["canvases"], 0);
  EXPECT_EQ(seen["rows"], 16);
  EXPECT_NE(seen["note"].get<std::string>().find("libjs-chart.js"), std::string::npos) << seen["note"];
}

}  // namespace

}  // namespace quincunx::bench

namespace quincunx::traces {

// The page of the traces as a reader has it: opened in headless Chromium, where a probe script looks at what
// was drawn and changes what is chosen.

namespace {

using testing::PageInBrowser;
using Json = nlohmann::json;

constexpr const char* kProbe = R"(<script>
probe.wait();
(async () => {
  const { all, choose } = probe;
  const seen = window.seen;
  const chart = () => probe.chart("time-plot");
  const curves = (axis) => chart().data.datasets.filter((dataset) => dataset.yAxisID === axis);
  const shown = () => all("#rows-table tbody tr").filter((row) => !row.hidden).length;
  seen.totals = all("#totals-table tbody tr").length;
  seen.best = all("#totals-table td.best").length;
  seen.shown = shown();
  choose("rows-trace", "");
  seen.everything = shown();
  seen.controllers = all("#time-controller option").map((option) => option.value);
  seen.two = curves("area").map((curve) => curve.label);
  choose("time-beside", "");
  seen.one = curves("area").length;
  seen.loads = curves("load").length;
  choose("time-trace", "1");
  const before = probe.values(curves("area")[0]);
  choose("time-controller", "proportional [W]");
  seen.changes = JSON.stringify(before) !== JSON.stringify(probe.values(curves("area")[0]));
  const [drops] = curves("drops");
  seen.drops = drops.data.map((_, i) => drops.explain(i));
  seen.count = chart().scales.drops.ticks.map((tick) => tick.label);
  seen.misplaced = probe.misplaced();
  probe.end();
})();
</script>)";

// Two loads of 300 frames: one that fits, one that trebles in the middle.
TraceRun sample() {
  TraceSettings settings{.seeds = {1}};
  settings.lists = {{"a </script> list", [](std::uint64_t) {
                       LoadTrace calm{.name = "calm",
                                      .frames = std::vector<FrameLoad>(300, {.fixed = .2, .scaling = .4})};
                       LoadTrace step = calm;
                       step.name = "step";
                       for (std::size_t i = 150; i < 300; ++i)
                         step.frames[i].scaling = 1.8;
                       step.steps_up = {150};
                       return std::vector<LoadTrace>{calm, step};
                     }}};
  return run_traces(settings);
}

TEST_F(PageInBrowser, DrawsControllersOverTime) {
  if (!there()) QUINCUNX_SKIP("there is no chromium");
  const Json seen = this->seen(page_of(sample(), "quincunx-bench --traces"), kProbe);
  const std::size_t controllers = controller_kinds().size();
  EXPECT_EQ(seen["errors"], Json::array());
  EXPECT_EQ(seen["totals"], controllers);
  EXPECT_GE(seen["best"], 3);
  EXPECT_EQ(seen["shown"], controllers) << "of the first trace";
  EXPECT_EQ(seen["everything"], 2 * controllers);
  EXPECT_EQ(seen["controllers"].size(), controllers);
  EXPECT_EQ(seen["two"], (Json{"predictive", "proportional [W]", "the oracle's resolution"}));
  EXPECT_EQ(seen["one"], 2);
  EXPECT_EQ(seen["loads"], 2);
  EXPECT_EQ(seen["changes"], true);
  ASSERT_GE(seen["drops"].size(), 1u) << "the slow controller meets the step";
  EXPECT_NE(seen["drops"][0].get<std::string>().find("proportional"), std::string::npos);
  EXPECT_EQ(seen["count"][0].get<std::string>().find("proportional [W]: "), 0u) << seen["count"];
  EXPECT_EQ(seen["misplaced"], 0);
}

}  // namespace

}  // namespace quincunx::traces
