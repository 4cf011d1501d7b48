// SPDX-License-Identifier: MIT
// Breaks whole sequences in every way that diagnose() knows and counts what it says of them. No test: run by hand with
// patterns of whole frames, as quincunx-dump --sequence writes them.
//
//   diagnose_proof [--pairs N] [--varied] [--only TEXT] [--every] [--threads N] [+]PATTERN ...
//
// +: the sky rests as drawn, and that is said. --pairs: every Nth pair of faults instead of none and one. --varied:
// each case three times: as drawn, with noise, with 8-bit velocity. --only: faults whose names hold TEXT. What was not
// named and not left open (--every: every case) is printed with all findings; then come counts by fault and by
// variation, and what was mistaken for what. A fault that changes nothing, such as one of motion where nothing moves,
// has no effect; nothing may be said of it.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <mutex>
#include <random>
#include <set>
#include <thread>

#include "diagnose_faults.h"
#include "tools/diagnose/resolve_diagnosis.h"

namespace quincunx::tools {
namespace {

using testing::Fault;
using testing::Frames;

enum class Variation : std::uint8_t { kAsDrawn, kNoise, kEightBits };

constexpr const char* kVariations[] = {"as drawn", "noise of 16 samples a pixel", "velocity of 8 bits"};

struct Mode {
  std::size_t pairs = 0;  // every so manieth pair of faults; 0: none and one
  bool varied = false;
  bool every = false;  // prints each case
  std::string only;    // faults whose names hold this
  int threads = 1;
};

struct Sequence {
  std::string pattern;
  bool sky = false;
  Frames frames = {};
  DiagnosedInput input = {};
};

struct Break {
  const Fault* fault;
  bool idle;  // leaves the frames as they are, as one of motion does where nothing moves
};

struct Case {
  const Sequence* sequence;
  Variation variation;
  std::vector<Break> breaks;
};

struct Count {
  int idle = 0, named = 0, nearly = 0, partly = 0, open = 0, missed = 0;

  int all() const { return idle + named + nearly + partly + open + missed; }

  void operator+=(const Count& other) {
    idle += other.idle, named += other.named, nearly += other.nearly;
    partly += other.partly, open += other.open, missed += other.missed;
  }
};

// Each pixel's light as the mean of 16 samples whose light is distributed exponentially.
void add_noise(Frames& frames) {
  constexpr float kSamples = 16;
  std::mt19937 random(1);
  std::gamma_distribution<float> noise(kSamples, 1 / kSamples);
  for (DiagnosedFrame& frame : frames) {
    for (std::size_t i = 0; i < frame.luminance.size(); ++i) {
      const float factor = noise(random);
      frame.luminance[i] *= factor;
      for (std::size_t k = 0; k < 3 && !frame.colour.empty(); ++k)
        frame.colour[i][k] *= factor;
    }
  }
}

// Velocity in steps of a quarter pixel, 8 bits from -32 to 32.
void round_velocity(Frames& frames) {
  const auto rounded = [](float v) { return std::clamp(std::round(v * 4), -128.0f, 127.0f) / 4; };
  for (DiagnosedFrame& frame : frames) {
    for (Vec2& v : frame.velocity)
      v = {rounded(v.x), rounded(v.y)};
  }
}

Result<Sequence> read(const std::string& argument) {
  Sequence sequence = {.pattern = argument.substr(argument[0] == '+' ? 1 : 0), .sky = argument[0] == '+'};
  ResolveOptions options;
  options.input = sequence.pattern;
  options.resolve.method = Method::kTemporal;
  options.method_named = true;
  options.diagnose = true;
  if (sequence.sky) options.resolve.conventions.sky_motion = SkyMotion::kCamera;
  const auto task = prepare(options);
  if (!task.ok()) return task.status();
  auto whole = read_for_diagnosis(task.value());
  if (!whole.ok()) return whole.status();
  sequence.frames = std::move(whole->frames);
  sequence.input = whole->input;
  return sequence;
}

std::string subject_of(const std::string& fault) {
  return fault.substr(0, fault.find(':'));
}

bool is_idle(const Sequence& sequence, Variation variation, const Fault& fault) {
  static const std::set<std::string> kMay = {"velocity", "velocity's size", "dilation",
                                             "sky",      "objects",         "camera"};
  if (!kMay.contains(subject_of(fault.name))) return false;
  Frames whole = sequence.frames, broken = whole;
  fault.apply(broken);
  if (variation == Variation::kEightBits) round_velocity(whole), round_velocity(broken);
  const std::size_t gone = whole.size() - broken.size();
  for (std::size_t i = 0; i < broken.size(); ++i) {
    const DiagnosedFrame &x = whole[i + gone], &y = broken[i];
    if (x.jitter != y.jitter || x.luminance != y.luminance || x.velocity != y.velocity ||
        x.depth != y.depth || x.world_to_ndc != y.world_to_ndc)
      return false;
  }
  return true;
}

// Sorts a case into the table: named in full, in what the frames can show, one of two, open as the diagnosis says, or
// missed.
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
  const bool excused = std::all_of(missing.begin(), missing.end(), [&](const std::string& fault) {
    return open.contains(fault) || open.contains(subject_of(fault));
  });
  const bool only_true = std::includes(expected.begin(), expected.end(), said.begin(), said.end());
  if (excused && only_true) return ++count.open, "open";
  // One sign of two, or both, where the other cannot be told; and motion beside a camera of another frame: either may
  // be late.
  std::set<std::string> nearly = expected;
  if (nearly.erase("velocity: direction") > 0)
    nearly.insert(open.contains("velocity: sign of y") ? "velocity: sign of x" : "velocity: sign of y");
  for (const char* axis : {"x", "y"}) {
    const std::string other = fmt::format("velocity: sign of {}", *axis == 'x' ? 'y' : 'x');
    if (said.contains("velocity: direction") && open.contains(other) &&
        nearly.erase(fmt::format("velocity: sign of {}", axis)) > 0)
      nearly.insert("velocity: direction");
  }
  if (nearly.erase("velocity: frame") > 0) nearly.insert("camera: frame");
  if (said == nearly) return ++count.nearly, "near";
  if (only_true && !said.empty()) return ++count.partly, "part";
  return ++count.missed, "BAD";
}

class Proof {
 public:
  Proof(const std::vector<Case>& cases, const Mode& mode) : cases_(cases), mode_(mode) {}

  void run() {
    std::vector<std::thread> helpers;
    for (int i = 1; i < mode_.threads; ++i)
      helpers.emplace_back([this] { work(); });
    work();
    for (std::thread& helper : helpers)
      helper.join();
    Count sum;
    for (const auto& [name, count] : counts_) {
      print(name, count);
      sum += count;
    }
    print("all", sum);
    for (const auto& [variation, count] : by_variation_)
      print(kVariations[static_cast<std::size_t>(variation)], count);
    for (const auto& [confusion, times] : confusions_)
      fmt::print("{:4} times {}\n", times, confusion);
  }

 private:
  static void print(const std::string& name, const Count& count) {
    fmt::print(
        "{:50} {:5} cases: no effect {:4}  named {:5}  nearly {:3}  partly {:3}  cannot tell {:4}  missed "
        "{:3}\n",
        name, count.all(), count.idle, count.named, count.nearly, count.partly, count.open, count.missed);
  }

  void work() {
    for (std::size_t i; (i = next_.fetch_add(1)) < cases_.size();)
      prove(cases_[i]);
  }

  void prove(const Case& one) {
    Frames frames = one.sequence->frames;
    DiagnosedInput input = one.sequence->input;
    std::set<std::string> expected, faults, subjects;
    if (one.variation == Variation::kNoise) add_noise(frames);
    for (const bool draws : {true, false}) {
      for (const auto& [fault, idle] : one.breaks) {
        if (fault->draws == draws) fault->apply(frames);
      }
      if (draws && one.variation == Variation::kEightBits) round_velocity(frames);
    }
    for (const auto& [fault, idle] : one.breaks) {
      fault->say(input);
      if (!idle) expected.insert(fault->name);
      faults.insert(fault->name);
      subjects.insert(subject_of(fault->name));
    }
    const auto start = std::chrono::steady_clock::now();
    const Diagnosis diagnosis = diagnose(frames, input);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    const std::string broken = faults.empty() ? "whole" : fmt::format("{}", fmt::join(faults, " + "));
    const std::string row = one.breaks.size() < 2 ? broken : fmt::format("{}", fmt::join(subjects, " and "));
    const std::lock_guard lock(mutex_);
    Count count;
    const std::string outcome = judge(expected, diagnosis, count);
    if (outcome == "ok" && expected.empty() && !faults.empty()) count = {.idle = 1};
    counts_[row] += count;
    by_variation_[one.variation] += count;
    if ((outcome == "ok" || outcome == "open") && !mode_.every) return;
    const std::string said = testing::named(diagnosis);
    if (outcome != "open" && outcome != "ok") ++confusions_[broken + " -> " + said];
    fmt::print("{:4} {} {}: {} -> {} {:.2f}s", outcome, one.sequence->pattern,
               kVariations[static_cast<std::size_t>(one.variation)], broken, said, took.count());
    for (const Finding& finding : diagnosis.findings)
      fmt::print(" | {} {} {:.1f} dB {:.0f}% {}", finding.subject, name_of(finding.verdict),
                 finding.margin_db, 100 * finding.share, fmt::join(finding.open, ","));
    fmt::print("\n");
    std::fflush(stdout);
  }

  const std::vector<Case>& cases_;
  const Mode& mode_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;
  std::map<std::string, Count> counts_;
  std::map<Variation, Count> by_variation_;
  std::map<std::string, int> confusions_;
};

// Adds those of a sequence. `pairs`: how many there were before, so that sequences share them out.
void add_cases(const Sequence& sequence, const std::vector<Fault>& faults, const Mode& mode,
               Variation variation, std::size_t& pairs, std::vector<Case>& cases) {
  std::vector<Break> fit;
  for (const Fault& fault : faults) {
    if (!(sequence.sky && fault.name.starts_with("sky")) && fault.name.find(mode.only) != std::string::npos)
      fit.push_back({&fault, is_idle(sequence, variation, fault)});
  }
  if (mode.pairs == 0) {
    cases.push_back({&sequence, variation, {}});
    for (const Break& one : fit)
      cases.push_back({&sequence, variation, {one}});
    return;
  }
  for (std::size_t i = 0; i < fit.size(); ++i) {
    for (std::size_t j = i + 1; j < fit.size(); ++j) {
      if (subject_of(fit[i].fault->name) != subject_of(fit[j].fault->name) && pairs++ % mode.pairs == 0)
        cases.push_back({&sequence, variation, {fit[i], fit[j]}});
    }
  }
}

int run(int argc, char** argv) {
  Mode mode;
  std::vector<std::string> patterns;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    mode.varied |= argument == "--varied";
    mode.every |= argument == "--every";
    if (argument == "--pairs" && i + 1 < argc) {
      mode.pairs = static_cast<std::size_t>(std::max(std::atoi(argv[++i]), 1));
    } else if (argument == "--only" && i + 1 < argc) {
      mode.only = argv[++i];
    } else if (argument == "--threads" && i + 1 < argc) {
      mode.threads = std::atoi(argv[++i]);
    } else if (!argument.starts_with("--")) {
      patterns.push_back(argument);
    }
  }
  std::vector<std::unique_ptr<Sequence>> sequences;
  std::vector<std::vector<Fault>> faults;
  std::vector<Case> cases;
  std::size_t pairs = 0;
  faults.reserve(patterns.size());
  for (const std::string& pattern : patterns) {
    auto sequence = read(pattern);
    if (!sequence.ok()) return fmt::print(stderr, "{}\n", sequence.status().message()), 1;
    sequences.push_back(std::make_unique<Sequence>(std::move(sequence).value()));
    faults.push_back(testing::faults(sequences.back()->input.near_plane));
    for (const Variation variation : {Variation::kAsDrawn, Variation::kNoise, Variation::kEightBits}) {
      if (mode.varied || variation == Variation::kAsDrawn)
        add_cases(*sequences.back(), faults.back(), mode, variation, pairs, cases);
    }
  }
  std::shuffle(cases.begin(), cases.end(),
               std::mt19937(1));  // of a run that is stopped, what is printed is a sample
  Proof(cases, mode).run();
  return 0;
}

}  // namespace
}  // namespace quincunx::tools

int main(int argc, char** argv) {
  return quincunx::tools::run(argc, argv);
}
