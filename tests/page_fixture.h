// SPDX-License-Identifier: MIT
// Opens a page in headless Chromium, for tests that look at what it drew.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/temporary_folder.h"

namespace quincunx::testing {

// First in the page, so that nothing escapes it. Chromium dumps a page when it has loaded. A page that calls
// probe.wait() has not loaded before it calls probe.end(): a document within it is still being written.
inline constexpr const char* kListener = R"(<script>
window.seen = { errors: [] };
window.probe = {
  wait() {
    this.frame = document.createElement("iframe");
    this.frame.hidden = true;
    document.body.append(this.frame);
    this.frame.contentDocument.open();
  },
  end() {
    const output = document.createElement("pre");
    output.id = "probe";
    output.textContent = JSON.stringify(window.seen);
    document.body.append(output);
    this.frame.contentDocument.close();
  },
  all: (selector) => [...document.querySelectorAll(selector)],
  async until(there) {
    for (let i = 0; i < 1000 && !there(); ++i) await new Promise((done) => setTimeout(done, 20));
  },
  choose(id, value) {
    const select = document.getElementById(id);
    select.value = value;
    select.dispatchEvent(new Event("change"));
  },
  chart: (id) => Chart.getChart(document.querySelector(`#${id} canvas`)),
  // Values of a dataset; of all charts, how many points have no place.
  values: (dataset) => dataset.data.map((value) => (typeof value === "object" && value !== null ? value.y : value)),
  misplaced: () => window.probe.all(".plot canvas, .small canvas").map((canvas) => Chart.getChart(canvas)).flatMap((chart) =>
    chart.data.datasets.flatMap((dataset, i) => chart.getDatasetMeta(i).data.filter((point, at) =>
      window.probe.values(dataset)[at] !== null && !(Number.isFinite(point.x) && Number.isFinite(point.y))))).length,
};
const note = (text) => window.seen.errors.push(String(text));
addEventListener("error", (event) => note(event.message));
addEventListener("unhandledrejection", (event) => note(event.reason));
document.addEventListener("securitypolicyviolation", (event) => note(event.violatedDirective));
</script>)";

inline std::string with(std::string page, const std::string& after, const std::string& text) {
  const std::size_t at = page.find(after);
  EXPECT_NE(at, std::string::npos) << after;
  return page.insert(at + (after == "<head>" ? after.size() : 0), text);
}

class PageInBrowser : public ::testing::Test {
 protected:
  static bool there() { return std::system("command -v chromium >/dev/null") == 0; }

  // `options` of Chromium; gives what it writes on its standard output. On stderr it repeats the console.
  std::string browse(const std::string& page, const std::string& options) {
    std::ofstream(folder_.file("page.html"), std::ios::binary) << page;
    const int status = std::system(
        fmt::format("cd '{0}' && HOME='{0}' timeout 120 chromium --headless --no-sandbox --disable-gpu "
                    "--disable-dev-shm-usage --user-data-dir='{0}/profile' --enable-logging=stderr "
                    "{1} 'file://{0}/page.html' >out 2>err",
                    folder_.file("."), options)
            .c_str());
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << text_of("err");
    return text_of("out");
  }

  // Returns what `probe`, a script, left in window.seen of a page.
  nlohmann::json seen(std::string page, const char* probe, const std::string& options = "") {
    page = with(with(std::move(page), "<head>", kListener), "</body>", probe);
    const std::string dom = browse(page, options + " --dump-dom");
    const std::string mark = "<pre id=\"probe\">";
    const std::size_t at = dom.find(mark);
    EXPECT_NE(at, std::string::npos) << "the probe did not end\n" << text_of("err");
    if (at == std::string::npos) return {};
    return nlohmann::json::parse(dom.substr(at + mark.size(), dom.find("</pre>", at) - at - mark.size()));
  }

  std::string text_of(const std::string& name) const { return read_file(folder_.file(name)); }

  TemporaryFolder folder_;
};

}  // namespace quincunx::testing
