// SPDX-License-Identifier: MIT
// The page of a diagnosis as a reader has it: opened in headless Chromium, where a probe looks at what was drawn.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "page_fixture.h"
#include "skip.h"
#include "tools/diagnose/resolve_diagnosis.h"

namespace quincunx::tools {
namespace {

using Json = nlohmann::json;

constexpr const char* kProbe = R"(<script>
probe.wait();
(async () => {
  const stage = document.querySelector("#viewer .stage");
  await probe.until(() => !stage || stage.dataset.ready);
  const seen = window.seen;
  seen.lead = document.getElementById("lead").textContent;
  seen.rows = [...document.querySelectorAll("#found tr")].map((row) => [...row.cells].map((cell) => cell.textContent));
  seen.pictures = document.getElementById("pictures") !== null;
  seen.frames = [...document.querySelectorAll("#viewer select")].map((select) => select.options.length);
  const pixel = (canvas) => [...canvas.getContext("2d").getImageData(1, 0, 1, 1).data.slice(0, 3)];
  seen.pixels = [...document.querySelectorAll("#viewer canvas")].map(pixel);
  probe.end();
})();
</script>)";

const std::string kJson = R"({"wrong": true, "findings": [
  {"subject": "velocity", "verdict": "wrong", "faults": ["sign of y"], "says": "fsr2", "fits": "y the other way",
   "not_shown": ["frame"], "margin_db": 2.5, "certainty": 16.4, "share": 1,
   "option": "--velocity-convention nuke"},
  {"subject": "cuts", "verdict": "cannot tell", "faults": [], "says": "marked", "fits": "", "not_shown": [],
   "margin_db": 0, "certainty": 0, "share": 0, "option": ""}]})";

class DiagnosisPage : public testing::PageInBrowser {
 protected:
  // Returns the probe's findings.
  Json seen(std::span<const FailureMap> maps) {
    const auto page = diagnosis_page("shot/a.%04d.exr", kJson, maps);
    EXPECT_TRUE(page.ok()) << page.status().message();
    return PageInBrowser::seen(page.value(), kProbe, "--window-size=1200,900");
  }
};

TEST_F(DiagnosisPage, ShowsFindingsAndWhereTheInputFails) {
  if (!there()) QUINCUNX_SKIP("chromium is not installed");
  const FailureMap map = {7, {2, 1}, {0, 1}, {0, 1}, .5};
  const Json saw = seen(std::vector<FailureMap>{map, map});
  EXPECT_EQ(saw["errors"], Json::array());
  EXPECT_EQ(saw["lead"], "shot/a.%04d.exr: velocity wrong.");
  ASSERT_EQ(saw["rows"].size(), 2u);
  EXPECT_EQ(saw["rows"][0], Json({"velocity", "wrong", "fsr2", "y the other way",
                                  "--velocity-convention nuke", "2.50 dB", "16 s.e.", "100 %", "frame"}));
  EXPECT_EQ(saw["rows"][1], Json({"cuts", "cannot tell", "marked", "", "", "", "", "", ""}));
  EXPECT_EQ(saw["pictures"], true);
  EXPECT_EQ(saw["frames"], Json({2, 2, 2}));
  EXPECT_EQ(saw["pixels"][0], Json({255, 255, 255}));
  EXPECT_EQ(saw["pixels"][1], Json({252, 253, 191})) << "the brightest of the map's colours";
}

TEST_F(DiagnosisPage, HasNoViewerWithoutPictures) {
  if (!there()) QUINCUNX_SKIP("chromium is not installed");
  const Json saw = seen({});
  EXPECT_EQ(saw["errors"], Json::array());
  EXPECT_EQ(saw["rows"].size(), 2u);
  EXPECT_EQ(saw["pictures"], false);
}

}  // namespace
}  // namespace quincunx::tools
