// SPDX-License-Identifier: MIT
// Breaks whole sequences in every way that diagnose() knows and counts what it says of them. No test: run by hand with
// patterns of whole frames, as quincunx-dump --sequence writes them.
//
//   diagnose_proof [--pairs] [--noise] [--8-bit-velocity] [--only TEXT] [--threads N] [+]PATTERN ...
//
// +: the sky rests as drawn, and that is said. --only: faults whose names hold TEXT. What was not named and not left
// open is printed with all findings; then come counts by fault, and what was mistaken for what.
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

struct Mode {
  bool pairs = false;      // two faults at a time, in place of none and one
  bool noise = false;      // of a twentieth of the middle luminance
  bool eight_bit = false;  // velocity in steps of a quarter pixel, 8 bits from -32 to 32
  std::string only;        // faults whose names hold this
  int threads = 1;
};

struct Sequence {
  std::string pattern;
  bool sky = false;
  Frames frames = {};
  DiagnosedInput input = {};
};

struct Case {
  const Sequence* sequence;
  std::vector<const Fault*> faults;
};

struct Count {
  int named = 0, nearly = 0, partly = 0, open = 0, missed = 0;

  int all() const { return named + nearly + partly + open + missed; }
};

void add_noise(Frames& frames) {
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0, .1f / light_scale(frames));
  for (DiagnosedFrame& frame : frames) {
    for (std::size_t i = 0; i < frame.luminance.size(); ++i) {
      const float more = noise(random);
      frame.luminance[i] += more;
      for (std::size_t k = 0; k < 3 && !frame.colour.empty(); ++k)
        frame.colour[i][k] = std::max(frame.colour[i][k] + more, 0.0f);
    }
  }
}

void round_velocity(Frames& frames) {
  for (DiagnosedFrame& frame : frames) {
    for (Vec2& v : frame.velocity)
      v = {std::round(v.x * 4) / 4, std::round(v.y * 4) / 4};
  }
}

Result<Sequence> read(const std::string& argument, const Mode& mode) {
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
  if (mode.noise) add_noise(sequence.frames);
  if (mode.eight_bit) round_velocity(sequence.frames);
  return sequence;
}

std::string subject_of(const std::string& fault) {
  return fault.substr(0, fault.find(':'));
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
  Proof(const std::vector<Case>& cases, int threads) : cases_(cases), threads_(threads) {}

  void run() {
    std::vector<std::thread> helpers;
    for (int i = 1; i < threads_; ++i)
      helpers.emplace_back([this] { work(); });
    work();
    for (std::thread& helper : helpers)
      helper.join();
    Count sum;
    for (const auto& [name, count] : counts_) {
      print(name, count);
      sum.named += count.named, sum.nearly += count.nearly, sum.partly += count.partly;
      sum.open += count.open, sum.missed += count.missed;
    }
    print("all", sum);
    for (const auto& [confusion, times] : confusions_)
      fmt::print("{:4} times {}\n", times, confusion);
  }

 private:
  static void print(const std::string& name, const Count& count) {
    fmt::print("{:50} {:5} cases: named {:5}  nearly {:3}  partly {:3}  cannot tell {:4}  missed {:3}\n",
               name, count.all(), count.named, count.nearly, count.partly, count.open, count.missed);
  }

  void work() {
    for (std::size_t i; (i = next_.fetch_add(1)) < cases_.size();)
      prove(cases_[i]);
  }

  void prove(const Case& one) {
    Frames frames = one.sequence->frames;
    DiagnosedInput input = one.sequence->input;
    std::set<std::string> expected, subjects;
    for (const Fault* fault : one.faults) {
      fault->apply(frames);
      fault->say(input);
      expected.insert(fault->name);
      subjects.insert(subject_of(fault->name));
    }
    const auto start = std::chrono::steady_clock::now();
    const Diagnosis diagnosis = diagnose(frames, input);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    const std::string broken = expected.empty() ? "whole" : fmt::format("{}", fmt::join(expected, " + "));
    const std::string row = one.faults.size() < 2 ? broken : fmt::format("{}", fmt::join(subjects, " and "));
    const std::lock_guard lock(mutex_);
    const std::string outcome = judge(expected, diagnosis, counts_[row]);
    if (outcome == "ok" || outcome == "open") return;
    const std::string said = testing::named(diagnosis);
    ++confusions_[broken + " -> " + said];
    fmt::print("{:4} {} {} -> {} {:.2f}s", outcome, one.sequence->pattern, broken, said, took.count());
    for (const Finding& finding : diagnosis.findings)
      fmt::print(" | {} {} {:.1f} dB {:.0f}% {}", finding.subject, name_of(finding.verdict),
                 finding.margin_db, 100 * finding.share, fmt::join(finding.open, ","));
    fmt::print("\n");
    std::fflush(stdout);
  }

  const std::vector<Case>& cases_;
  int threads_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;
  std::map<std::string, Count> counts_;
  std::map<std::string, int> confusions_;
};

std::vector<Case> cases_of(const Sequence& sequence, const std::vector<Fault>& faults, const Mode& mode) {
  std::vector<const Fault*> fit;
  for (const Fault& fault : faults) {
    if (!(sequence.sky && fault.name.starts_with("sky")) && fault.name.find(mode.only) != std::string::npos)
      fit.push_back(&fault);
  }
  std::vector<Case> cases;
  if (!mode.pairs) {
    cases.push_back({&sequence, {}});
    for (const Fault* fault : fit)
      cases.push_back({&sequence, {fault}});
    return cases;
  }
  for (std::size_t i = 0; i < fit.size(); ++i) {
    for (std::size_t j = i + 1; j < fit.size(); ++j) {
      if (subject_of(fit[i]->name) != subject_of(fit[j]->name))
        cases.push_back({&sequence, {fit[i], fit[j]}});
    }
  }
  return cases;
}

int run(int argc, char** argv) {
  Mode mode;
  std::vector<std::string> patterns;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    mode.pairs |= argument == "--pairs";
    mode.noise |= argument == "--noise";
    mode.eight_bit |= argument == "--8-bit-velocity";
    if (argument == "--only" && i + 1 < argc) {
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
  faults.reserve(patterns.size());
  for (const std::string& pattern : patterns) {
    auto sequence = read(pattern, mode);
    if (!sequence.ok()) return fmt::print(stderr, "{}\n", sequence.status().message()), 1;
    sequences.push_back(std::make_unique<Sequence>(std::move(sequence).value()));
    faults.push_back(testing::faults(sequences.back()->input.near_plane));
    for (const Case& one : cases_of(*sequences.back(), faults.back(), mode))
      cases.push_back(one);
  }
  Proof(cases, mode.threads).run();
  return 0;
}

}  // namespace
}  // namespace quincunx::tools

int main(int argc, char** argv) {
  return quincunx::tools::run(argc, argv);
}
