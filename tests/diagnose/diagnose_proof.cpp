// SPDX-License-Identifier: MIT
// Breaks whole sequences in every way that diagnose() knows and counts what it says of them. No test: run by hand with
// patterns of whole frames, as quincunx-dump --sequence writes them.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <random>
#include <set>

#include "diagnose_faults.h"
#include "tools/diagnose/resolve_diagnosis.h"

namespace quincunx::tools {
namespace {

using testing::Fault;
using testing::Frames;

struct Count {
  int named = 0, nearly = 0, open = 0, missed = 0;
};

struct Mode {
  bool pairs = false;  // two faults at a time
  bool worse = false;  // noise of a twentieth of the middle luminance, velocity in steps of a quarter pixel
};

void worsen(Frames& frames) {
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0, 1);
  for (DiagnosedFrame& frame : frames) {
    std::vector<float> sorted = frame.luminance;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                     sorted.end());
    for (float& value : frame.luminance)
      value += noise(random) * .05f * sorted[sorted.size() / 2];
    for (Vec2& v : frame.velocity)
      v = {std::round(v.x * 4) / 4, std::round(v.y * 4) / 4};
  }
}

// Sorts a case into the table: named in full, in what the frames can show, open as the diagnosis says, or missed.
const char* judge(const std::set<std::string>& expected, const Diagnosis& diagnosis, Count& count) {
  std::set<std::string> said, open;
  for (const Finding& finding : diagnosis.findings) {
    for (const std::string& fault : finding.faults)
      said.insert(finding.subject + ": " + fault);
    if (finding.verdict == Verdict::kUnknown) open.insert(finding.subject);
    for (const std::string& fault : finding.open)
      open.insert(finding.subject + ": " + fault);
  }
  if (said == expected) return ++count.named, "ok";
  std::set<std::string> missing;
  std::set_difference(expected.begin(), expected.end(), said.begin(), said.end(),
                      std::inserter(missing, missing.end()));
  bool excused = true;
  for (const std::string& fault : missing)
    excused &= open.contains(fault) || open.contains(fault.substr(0, fault.find(':')));
  const bool only_true = std::includes(expected.begin(), expected.end(), said.begin(), said.end());
  if (excused && only_true) return ++count.open, "open";
  // One sign of two where the other cannot be told; and motion beside a camera of another frame: either may be late.
  std::set<std::string> nearly = expected;
  if (nearly.erase("velocity: direction") > 0)
    nearly.insert(open.contains("velocity: sign of y") ? "velocity: sign of x" : "velocity: sign of y");
  if (nearly.erase("velocity: frame") > 0) nearly.insert("camera: frame");
  if (said == nearly) return ++count.nearly, "near";
  return ++count.missed, "BAD";
}

int prove(const std::string& argument, const Mode& mode, std::map<std::string, Count>& counts) {
  const bool sky = argument[0] == '+';  // it rests as drawn, and that is said
  ResolveOptions options;
  options.input = argument.substr(sky ? 1 : 0);
  options.resolve.method = Method::kTemporal;
  options.method_named = true;
  options.diagnose = true;
  if (sky) options.resolve.conventions.sky_motion = SkyMotion::kCamera;
  const auto task = prepare(options);
  if (!task.ok()) return fmt::print(stderr, "{}\n", task.status().message()), 1;
  auto whole = read_for_diagnosis(task.value());
  if (!whole.ok()) return fmt::print(stderr, "{}\n", whole.status().message()), 1;
  if (mode.worse) worsen(whole.value());
  std::vector<Fault> faults = testing::faults(task->format.near_plane);
  faults.push_back({"none", [](Frames&) {}});
  for (std::size_t i = 0; i < faults.size(); ++i) {
    const Fault& one = faults[i];
    const Fault& other = faults[mode.pairs ? (5 * i + 9) % faults.size() : faults.size() - 1];
    const auto subject = [](const Fault& fault) { return fault.name.substr(0, fault.name.find(':')); };
    if (sky && (one.name.starts_with("sky") || other.name.starts_with("sky"))) continue;
    if (mode.pairs && subject(one) == subject(other)) continue;
    Frames frames = whole.value();
    one.apply(frames);
    other.apply(frames);
    std::set<std::string> expected = {one.name, other.name};
    expected.erase("none");
    const auto start = std::chrono::steady_clock::now();
    const Diagnosis diagnosis = diagnose(frames, diagnosed_input(task.value()));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    const std::string name = fmt::format("{}", fmt::join(expected, " + "));
    const char* outcome = judge(expected, diagnosis, counts[name]);
    fmt::print("{:4} {:24} {:24} -> {:40} {:.2f}s", outcome, options.input, name, testing::named(diagnosis),
               took.count());
    for (const Finding& finding : diagnosis.findings)
      fmt::print(" | {} {} {:.1f} dB {:.0f}% {}", finding.subject, name_of(finding.verdict),
                 finding.margin_db, 100 * finding.share, fmt::join(finding.open, ","));
    fmt::print("\n");
    std::fflush(stdout);
  }
  return 0;
}

int run(int argc, char** argv) {
  Mode mode;
  std::map<std::string, Count> counts;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--pairs") {
      mode.pairs = true;
    } else if (argument == "--worse") {
      mode.worse = true;
    } else if (prove(argument, mode, counts) != 0) {
      return 1;
    }
  }
  for (const auto& [name, count] : counts)
    fmt::print("{:48} named {:3}  nearly {:3}  cannot tell {:3}  missed {:3}\n",
               name.empty() ? "whole" : name, count.named, count.nearly, count.open, count.missed);
  return 0;
}

}  // namespace
}  // namespace quincunx::tools

int main(int argc, char** argv) {
  return quincunx::tools::run(argc, argv);
}
