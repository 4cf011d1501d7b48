// SPDX-License-Identifier: MIT
// The page of the traces as a reader has it: opened in headless Chromium, where a probe script looks at what
// was drawn and changes what is chosen.
#include "bench/traces/trace_page.h"

#include <nlohmann/json.hpp>

#include "page_fixture.h"
#include "skip.h"

namespace quincunx::traces {
namespace {

using testing::kListener;
using testing::PageInBrowser;
using testing::with;
using Json = nlohmann::json;

constexpr const char* kProbe = R"(<script>
probe.wait();
(async () => {
  const all = (selector) => [...document.querySelectorAll(selector)];
  const pause = () => new Promise((done) => setTimeout(done, 20));
  for (let i = 0; i < 1000 && !all("#time-plot svg").length; ++i) await pause();
  const seen = window.seen;
  const choose = (id, value) => {
    const select = document.getElementById(id);
    select.value = value;
    select.dispatchEvent(new Event("change"));
  };
  const areas = () => all("#time-plot .area").map((path) => path.getAttribute("d"));
  const shown = () => all("#rows-table tbody tr").filter((row) => !row.hidden).length;
  seen.totals = all("#totals-table tbody tr").length;
  seen.best = all("#totals-table td.best").length;
  seen.shown = shown();
  choose("rows-trace", "");
  seen.everything = shown();
  seen.controllers = all("#time-controller option").map((option) => option.value);
  seen.two = areas().length;
  choose("time-beside", "");
  seen.one = areas().length;
  seen.loads = all("#time-plot .load").length + all("#time-plot .oracle").length;
  choose("time-trace", "1");
  const before = areas()[0];
  choose("time-controller", "proportional [W]");
  seen.changes = before !== areas()[0];
  seen.drops = all("#time-plot .drop").map((mark) => mark.getAttribute("aria-label"));
  seen.pathsWithoutNumbers = all("svg path").filter((p) => /NaN|undefined|Infinity/.test(p.getAttribute("d"))).length;
  seen.title = document.getElementById("time-plot").textContent;
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
  std::string page = page_of(sample(), "quincunx-bench --traces");
  page = with(with(std::move(page), "<head>", kListener), "</body>", kProbe);
  const std::string dom = browse(page, "--dump-dom");
  const std::string mark = "<pre id=\"probe\">";
  const std::size_t start = dom.find(mark);
  ASSERT_NE(start, std::string::npos) << "the probe did not end\n" << text_of("err");
  const std::size_t end = dom.find("</pre>", start);
  const Json seen = Json::parse(dom.substr(start + mark.size(), end - start - mark.size()));

  const std::size_t controllers = controller_kinds().size();
  EXPECT_EQ(seen["errors"], Json::array());
  EXPECT_EQ(seen["totals"], controllers);
  EXPECT_GE(seen["best"], 3);
  EXPECT_EQ(seen["shown"], controllers) << "of the first trace";
  EXPECT_EQ(seen["everything"], 2 * controllers);
  EXPECT_EQ(seen["controllers"].size(), controllers);
  EXPECT_EQ(seen["two"], 2);
  EXPECT_EQ(seen["one"], 1);
  EXPECT_EQ(seen["loads"], 2);
  EXPECT_EQ(seen["changes"], true);
  ASSERT_GE(seen["drops"].size(), 1u) << "the slow controller meets the step";
  EXPECT_NE(seen["drops"][0].get<std::string>().find("proportional"), std::string::npos);
  EXPECT_EQ(seen["pathsWithoutNumbers"], 0);
}

}  // namespace
}  // namespace quincunx::traces
