// SPDX-License-Identifier: MIT
// The page of a run as a reader has it: opened in headless Chromium, where a probe script looks at what was drawn.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "page_fixture.h"
#include "skip.h"
#include "tools/page/page.h"
#include "tools/page/scored_frames.h"

namespace quincunx::tools {
namespace {

using Json = nlohmann::json;

constexpr const char* kProbe = R"(<script>
probe.wait();
(async () => {
  const { all, chart, values } = probe;
  const seen = window.seen;
  const curves = (id) => chart(id).data.datasets.map(values);
  seen.title = document.title;
  seen.warnings = all("#warning-list li").map((item) => item.textContent);
  seen.sections = all("main section").map((section) => section.id);
  seen.links = all("nav a").map((link) => link.getAttribute("href"));
  const frames = document.getElementById("time-plot") !== null;
  if (frames) {
    seen.times = curves("time-plot");
    seen.ratios = curves("ratio-plot");
    const { canvas, tooltip } = chart("time-plot");
    canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight" }));
    seen.tip = tooltip.body[0].lines;
    seen.scores = curves("score-plot");
    probe.choose("score-measure", "flip");
    seen.otherScores = curves("score-plot");
    seen.lead = document.getElementById("scores-lead").textContent;
    document.querySelector("#time details").open = true;
    await probe.until(() => all("#frames-table tr").length);
    seen.frames = all("#frames-table tbody tr").map((row) => row.textContent);
  }
  seen.bars = curves("pass-plot")[0];
  seen.leftOut = document.getElementById("left-out-list").textContent;
  seen.facts = document.getElementById("fact-list").textContent;
  seen.misplaced = probe.misplaced();
  seen.wide = document.documentElement.scrollWidth > document.documentElement.clientWidth;
  probe.end();
})();
</script>)";

// Looks through the pictures and their maps.
constexpr const char* kPictureProbe = R"(<script>
probe.wait();
(async () => {
  const { all } = probe;
  const ready = () => probe.until(() => all("#viewer .stage[data-ready]").length);
  await ready();
  const seen = window.seen;
  const canvases = all("#viewer canvas");
  const stage = document.querySelector("#viewer .stage");
  const pixels = () => canvases.map((c) => [...c.getContext("2d").getImageData(1, 1, 1, 1).data].slice(0, 3));
  const choose = async (select, index) => {
    delete stage.dataset.ready;
    select.selectedIndex = index;
    select.dispatchEvent(new Event("change"));
    await ready();
    return pixels();
  };
  const [frame, left, right] = all("#viewer select");
  seen.frames = [...frame.options].map((option) => option.textContent);
  seen.kinds = [...left.options].map((option) => option.textContent);
  seen.size = [canvases[0].width, canvases[0].height];
  seen.first = pixels();
  seen.captions = all("#viewer .captions span").map((span) => span.textContent);
  seen.maps = [];
  for (let kind = 2; kind < left.options.length; ++kind) seen.maps.push((await choose(left, kind))[0]);
  seen.otherFrame = await choose(frame, 0);
  seen.otherCaption = document.querySelector("#viewer .captions span").textContent;
  const wipe = document.querySelector("#viewer .wipe");
  seen.wiped = [10, 90].map((value) => { wipe.value = value; wipe.dispatchEvent(new Event("input")); return canvases[0].style.clipPath; });
  probe.end();
})();
</script>)";

// 40x30 pixels of one linear value.
MeasuredPicture flat(float value) {
  return MeasuredPicture({40, 30}, std::vector<float>(40 * 30 * 4, value));
}

// Frames 100 and 101: truth is 1, which is 1/2 when tone-mapped; the picture darkens.
ReportPictures example_pictures() {
  const MeasuredPicture truth = flat(1), first = flat(1), second = flat(.25f);
  const std::vector<Vec2> still(4);
  ReportPictures pictures;
  EXPECT_TRUE(add_frame(pictures, 100, {.picture = first, .truth = truth, .motion = {{2, 2}, still}}).ok());
  EXPECT_TRUE(add_frame(pictures, 101,
                        {.picture = second,
                         .truth = truth,
                         .previous = &first,
                         .previous_truth = &truth,
                         .motion = {{2, 2}, still}})
                  .ok());
  return pictures;
}

RunReport example(int frames) {
  RunReport report;
  report.program = "quincunx-resolve";
  report.version = "0.1.0";
  report.method = "temporal:balanced";
  report.output = {640, 360};
  report.target = {320, 180};
  report.warnings = {"the sky </script> stands still & <b>rests</b>"};
  report.settings = {{"method chosen", "motion, depth and a jitter are known"}};
  report.left_out = {{"motion blur", "the shutter opens for no time"}};
  report.passes = {statistics_of("resolve_temporal", "OpenCL event", std::vector<double>{1, 2, 4})};
  report.steps = {statistics_of("upload", "host clock", std::vector<double>{3}),
                  statistics_of("never", "host clock", {})};
  for (int i = 0; i < frames; ++i) {
    FrameRow row;
    row.index = 100 + i;
    row.render = {320, 180};
    row.ratio = {.5f, i % 2 == 0 ? .5f : .6f};
    row.frame_ms = 10 + i;
    row.device_ms = i == 2 ? -1 : 5;  // not known: a gap
    report.frames.push_back(row);
    ScoreRow score;
    score.index = row.index;
    score.psnr_tone_mapped = i == 1 ? std::numeric_limits<double>::infinity() : 30 + i;
    score.flip = .1 * i;
    report.scores.push_back(score);
  }
  return report;
}

class ReportPage : public testing::PageInBrowser {
 protected:
  Json seen(const RunReport& report, const std::string& options = "--window-size=1200,900",
            const ReportPictures& pictures = {}, const char* probe = kProbe) {
    return PageInBrowser::seen(report_page(report, pictures), probe, options);
  }
};

TEST_F(ReportPage, DrawsWhatTheRunDid) {
  if (!there()) QUINCUNX_SKIP("chromium is not installed");
  const Json saw = seen(example(5));
  EXPECT_EQ(saw["errors"], Json::array());
  EXPECT_EQ(saw["title"], "quincunx-resolve: temporal:balanced");
  EXPECT_EQ(saw["warnings"].size(), 1u);
  EXPECT_EQ(saw["sections"],
            Json({"warnings", "scores", "time", "resolution", "passes", "facts", "left-out"}));
  EXPECT_EQ(saw["links"].size(), 7u);
  EXPECT_EQ(saw["times"], Json::parse("[[10, 11, 12, 13, 14], [5, 5, null, 5, 5]]"))
      << "the third frame's passes are not known";
  EXPECT_EQ(saw["ratios"].size(), 2u);
  EXPECT_EQ(saw["bars"], (Json{2, 3})) << "what never ran has no bar";
  EXPECT_EQ(saw["scores"][0], Json::parse("[30, null, 32, 33, 34]")) << "an infinite ratio is a gap";
  EXPECT_EQ(saw["frames"].size(), 5u);
  EXPECT_EQ(saw["frames"][2], "10212.0–0.5000.500");
  EXPECT_NE(saw["scores"], saw["otherScores"]);
  EXPECT_NE(saw["lead"].get<std::string>().find("Mean of 5 frames: 0.2000"), std::string::npos)
      << saw["lead"];
  EXPECT_NE(saw["leftOut"].get<std::string>().find("the shutter opens for no time"), std::string::npos);
  EXPECT_NE(saw["facts"].get<std::string>().find("motion, depth and a jitter are known"), std::string::npos);
  EXPECT_EQ(saw["tip"][0], "frame 100: 10.00 ms") << saw["tip"];
  EXPECT_EQ(saw["misplaced"], 0);
}

TEST_F(ReportPage, ShowsFramesBesideTheirTruthAndWhatIsWrong) {
  if (!there()) QUINCUNX_SKIP("chromium is not installed");
  const Json saw = seen(example(2), "--window-size=1200,900", example_pictures(), kPictureProbe);
  EXPECT_EQ(saw["errors"], Json::array());
  EXPECT_EQ(saw["frames"], Json({"100", "101"}));
  EXPECT_EQ(saw["kinds"], Json({"truth", "picture", "error", "flicker", "ghosts"}));
  EXPECT_EQ(saw["size"], Json({40, 30}));
  // sRGB of 1/2 and of .25/1.25, in 255 parts.
  EXPECT_EQ(saw["first"], Json::parse("[[124, 124, 124], [188, 188, 188]]"));
  EXPECT_EQ(saw["captions"][0], "pictureequals the truth") << "as its score says";
  EXPECT_EQ(saw["maps"].size(), 3u);
  const Json brightest =
      Json::parse("[252, 253, 191]");  // a change of 64/255, a quarter: all that a map can show
  EXPECT_EQ(saw["maps"][1], brightest);
  EXPECT_EQ(saw["maps"][2], brightest);
  EXPECT_EQ(saw["otherFrame"], Json::parse("[[0, 0, 4], [188, 188, 188]]")) << "before it there is no frame";
  EXPECT_EQ(saw["otherCaption"], "ghostsno frame before it");
  EXPECT_EQ(saw["wiped"][0], "inset(0px 90% 0px 0px)");
}

TEST_F(ReportPage, ARunOfOneFrameOrNoneAndASmallScreenAreDrawnToo) {
  if (!there()) QUINCUNX_SKIP("chromium is not installed");
  const Json one = seen(example(1), "--window-size=500,900");
  EXPECT_EQ(one["errors"], Json::array());
  EXPECT_EQ(one["misplaced"], 0);
  EXPECT_EQ(one["wide"], false);
  RunReport report = example(0);
  report.warnings.clear();
  const Json none = seen(report);
  EXPECT_EQ(none["errors"], Json::array());
  EXPECT_EQ(none["sections"], Json({"passes", "facts", "left-out"}));
}

TEST_F(ReportPage, IsWrittenBesideTextAndJson) {
  ASSERT_TRUE(write_report(folder_.file("report"), example(3)).ok());
  for (const char* name : {"report.txt", "report.json", "report.html"})
    EXPECT_TRUE(std::filesystem::exists(folder_.file(name))) << name;
  EXPECT_EQ(folder_.entries(), 3);
  EXPECT_EQ(text_of("report.html"), report_page(example(3)));
}

std::vector<std::int64_t> numbers(std::int64_t first, std::int64_t last) {
  std::vector<std::int64_t> frames;
  for (std::int64_t frame = first; frame <= last; ++frame)
    frames.push_back(frame);
  return frames;
}

TEST(ScoredFrames, KeepsPicturesAtEvenDistancesAndTheLast) {
  const ScoredFrames scored(numbers(1, 60), true);
  for (const std::int64_t frame : numbers(1, 60))
    EXPECT_EQ(scored.keeps(frame), frame % 10 == 0) << frame;
  const ScoredFrames few(numbers(7, 9), true);
  for (const std::int64_t frame : numbers(7, 9))
    EXPECT_TRUE(few.keeps(frame));
  const ScoredFrames none(numbers(7, 9), false);
  EXPECT_FALSE(none.keeps(9));
}

TEST(ScoredFrames, FlickerIsKnownAfterTheFrameBefore) {
  ScoredFrames scored(std::vector<std::int64_t>{3, 4, 6}, true);
  const std::vector<Vec2> still(1);
  for (const std::int64_t frame : {3, 4, 6})
    ASSERT_TRUE(scored.add(frame, flat(static_cast<float>(frame)), flat(1), {{1, 1}, still}).ok());
  ASSERT_EQ(scored.rows().size(), 3u);
  EXPECT_EQ(scored.rows()[0].flicker, -1);
  // The truth rests. Luma of the pictures is sRGB of 3/4 and of 4/5.
  const auto srgb = [](double value) { return 1.055 * std::pow(value, 1 / 2.4) - .055; };
  EXPECT_NEAR(scored.rows()[1].flicker, srgb(.8) - srgb(.75), 1e-5);
  EXPECT_EQ(scored.rows()[2].flicker, -1) << "frame 5 is not known";
  ASSERT_EQ(scored.pictures().frames.size(), 3u);
  EXPECT_EQ(scored.pictures().frames[2].index, 6);
  EXPECT_EQ(scored.pictures().kinds.back().name, "ghosts");
}

TEST(ScoredFrames, ARepeatedFrameIsMeasuredAgainstTheTruthOfEachRefresh) {
  ScoredFrames scored(std::vector<std::int64_t>{0, 1}, false);
  scored.repeat(flat(1));
  EXPECT_TRUE(scored.rows().empty()) << "nothing was shown before the first frame";
  ASSERT_TRUE(scored.add(0, flat(1), flat(1), {}).ok());
  scored.repeat(flat(1));
  scored.repeat(flat(2));
  ASSERT_TRUE(scored.add(1, flat(2), flat(2), {}).ok());
  const std::vector<double>& repeated = scored.rows()[0].repeated_flip;
  ASSERT_EQ(repeated.size(), 2u);
  EXPECT_EQ(repeated[0], 0) << "the truth rests";
  EXPECT_GT(repeated[1], 0) << "it went on";
  const ShownError shown = shown_error(scored.rows());
  EXPECT_EQ(shown.refreshes, 4);
  EXPECT_EQ(shown.flip, repeated[1] / 4);
}

TEST(ScoredFrames, SmallPicturesAreRefusedByTheOptionsName) {
  EXPECT_TRUE(ScoredFrames::check({11, 11}, "--score").ok());
  EXPECT_EQ(ScoredFrames::check({640, 10}, "--score").message(),
            "--score needs an output of at least 11x11 pixels; this is 640x10");
}

}  // namespace

}  // namespace quincunx::tools
