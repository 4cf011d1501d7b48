// SPDX-License-Identifier: MIT
#include "bench/traces/load_trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <numbers>
#include <sstream>
#include <vector>

#include "random.h"

namespace quincunx::traces {
namespace {

using scenes::Random;

constexpr double kQuietNoise = 0.005;  // relative noise of a timer on an idle machine

double normal(Random& random) {  // Box and Muller, 1958
  const double radius = std::sqrt(-2 * std::log(1 - static_cast<double>(random.unit())));
  return radius * std::cos(2 * std::numbers::pi * random.unit());
}

double turn(int frame, double period) {
  return std::sin(2 * std::numbers::pi * frame / period);
}

// A load whose fixed part is a constant share of it.
FrameLoad shared(double level, double fixed_part, double exponent = 1) {
  return {.fixed = level * fixed_part, .scaling = level * (1 - fixed_part), .exponent = exponent};
}

class Builder {
 public:
  explicit Builder(std::uint64_t seed) : seed_(seed) {}

  // `load` is asked once per frame, in order, with a stream of random numbers of this trace alone.
  LoadTrace& add(const std::string& name, const std::function<FrameLoad(int, Random&)>& load,
                 double noise = kQuietNoise) {
    Random random(seed_, list_.size() + 1);
    LoadTrace trace{.name = name, .frames = {}};
    for (int frame = 0; frame < kFrames; ++frame) {
      FrameLoad at = load(frame, random);
      at.noise = std::exp(noise * std::clamp(normal(random), -4.0, 4.0));
      trace.frames.push_back(at);
    }
    list_.push_back(trace);
    return list_.back();
  }
  std::vector<LoadTrace> take() { return std::move(list_); }

 private:
  std::uint64_t seed_;
  std::vector<LoadTrace> list_;
};

// A level that wanders between two bounds.
class Walk {
 public:
  Walk(double level, double step, double low, double high)
      : level_(level), step_(step), low_(low), high_(high) {}
  double next(Random& random) {
    level_ = std::clamp(level_ * std::exp(step_ * normal(random)), low_, high_);
    return level_;
  }

 private:
  double level_, step_, low_, high_;
};

// Heavy moments of random length, with a quiet pause before the next.
class Bursts {
 public:
  Bursts(int shortest, int longest, int pause) : shortest_(shortest), longest_(longest), pause_(pause) {}
  bool next(Random& random) {
    if (left_-- == 0) {
      heavy_ = !heavy_;
      left_ = heavy_ ? shortest_ + random.below(longest_ - shortest_) : pause_ + random.below(pause_);
    }
    return heavy_;
  }

 private:
  int shortest_, longest_, pause_;
  int left_ = 60;
  bool heavy_ = false;
};

std::vector<std::string> cells(std::string line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::vector<std::string> list;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');)
    list.push_back(cell);
  return list;
}

// Returns a positive finite number; 0 for anything else.
double positive(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return end == text.c_str() + text.size() && std::isfinite(value) && value > 0 ? value : 0;
}

}  // namespace

double FrameLoad::gpu(double area_fraction) const {
  return (fixed + scaling * std::pow(area_fraction, exponent)) * noise;
}

std::vector<LoadTrace> development_traces(std::uint64_t seed) {
  Builder list(seed);
  list.add("constant", [](int, Random&) { return shared(1.5, 0.25); });
  list.add("light", [](int, Random&) { return shared(0.8, 0.25); });
  const auto step = [](double before, double after) {
    return [=](int frame, Random&) { return shared(frame < 900 ? before : after, 0.25); };
  };
  list.add("step up 30 %", step(1.2, 1.56)).steps_up = {900};
  list.add("step up 100 %", step(0.95, 1.9)).steps_up = {900};
  list.add("step down", step(1.9, 1.2)).steps_down = {900};
  list.add("ramp", [](int frame, Random&) { return shared(1.1 + 0.8 * std::abs(turn(frame, 2400)), 0.2); });
  list.add("spike", [](int frame, Random&) { return shared(frame % 120 == 119 ? 2.1 : 1.4, 0.25); });
  list.add("periodic sky 1/30", [](int frame, Random&) {
    return FrameLoad{.fixed = frame % 30 == 29 ? 0.65 : 0.35, .scaling = 1.0};
  });
  list.add("periodic sky 1/4", [](int frame, Random&) {
    return FrameLoad{.fixed = frame % 4 == 3 ? 0.45 : 0.3, .scaling = 1.05};
  });
  list.add(
      "noise 5 %", [](int, Random&) { return shared(1.4, 0.25); }, 0.05);
  list.add("sine", [](int frame, Random&) { return shared(1.5 + 0.35 * turn(frame, 480), 0.25); });
  list.add("fast sine", [](int frame, Random&) { return shared(1.4 + 0.15 * turn(frame, 90), 0.25); });
  {
    LoadTrace& trace = list.add("fixed-cost step", [](int frame, Random&) {
      return FrameLoad{.fixed = frame % 600 < 300 ? 0.2 : 0.45, .scaling = 1.1};
    });
    trace.steps_up = {300, 900, 1500};
    trace.steps_down = {600, 1200};
  }
  list.add("moving fixed cost",
           [](int frame, Random&) { return shared(1.45, 0.35 + 0.2 * turn(frame, 700)); });
  list.add("bursts", [bursts = Bursts(30, 90, 90)](int, Random& random) mutable {
    return shared(bursts.next(random) ? 1.75 : 1.25, 0.25);
  });
  list.add("random walk", [walk = Walk(1.4, 0.012, 1.05, 2.1)](int, Random& random) mutable {
    return shared(walk.next(random), 0.25);
  });
  list.add("infeasible",
           [](int frame, Random&) { return shared(frame >= 600 && frame < 1000 ? 3.4 : 1.3, 0.3); })
      .kind = TraceKind::kInfeasible;
  list.add("CPU-bound",
           [](int frame, Random&) {
             FrameLoad load = shared(1.4, 0.25);
             if (frame >= 600 && frame < 1100) load.cpu = 1.3;
             return load;
           })
      .kind = TraceKind::kCpuBound;
  return list.take();
}

std::vector<LoadTrace> held_out_traces(std::uint64_t seed) {
  Builder list(seed + 7919);
  list.add("constant, half fixed", [](int, Random&) { return shared(1.25, 0.5); });
  list.add("near the top", [](int, Random&) { return shared(1.02, 0.15); });
  const auto step = [](double before, double after, double fixed_part, double exponent) {
    return [=](int frame, Random&) { return shared(frame < 700 ? before : after, fixed_part, exponent); };
  };
  list.add("step up 60 %, sublinear", step(1.05, 1.68, 0.15, 0.85)).steps_up = {700};
  list.add("step up 100 %, mostly scaling", step(1.1, 2.2, 0.1, 1)).steps_up = {700};
  list.add("step down 45 %", step(2.0, 1.1, 0.2, 1)).steps_down = {700};
  list.add("sawtooth", [](int frame, Random&) { return shared(1.1 + 0.7 * (frame % 450) / 450, 0.3); });
  list.add("random spikes", [](int, Random& random) {
    return shared(random.below(150) == 0 ? 1.3 * (1.3 + 0.4 * random.unit()) : 1.3, 0.2);
  });
  list.add("sky 1/20 and shadow 1/7", [](int frame, Random&) {
    return FrameLoad{.fixed = 0.3 + (frame % 20 == 3 ? 0.25 : 0) + (frame % 7 == 5 ? 0.08 : 0),
                     .scaling = 0.95};
  });
  list.add("alternating frames",
           [](int frame, Random&) { return shared(frame % 2 == 0 ? 1.3 : 1.45, 0.25); });
  list.add(
      "noise 3 %, rare 15 %",
      [](int, Random& random) { return shared(1.35 * (random.below(40) == 0 ? 1.15 : 1), 0.3); }, 0.03);
  list.add("two sines", [](int frame, Random&) {
    return shared(1.5 + 0.2 * turn(frame, 370) + 0.12 * turn(frame, 53), 0.2);
  });
  list.add("triangle, sublinear", [](int frame, Random&) {
    return shared(1.1 + 0.7 * std::abs(frame % 600 - 300) / 300.0, 0.2, 0.85);
  });
  {
    LoadTrace& trace = list.add("fixed cost in stairs", [](int frame, Random&) {
      return FrameLoad{.fixed = 0.15 + 0.1 * (frame / 360), .scaling = 1.2};
    });
    trace.steps_up = {360, 720, 1080, 1440};
  }
  list.add("fixed cost against pixels", [](int frame, Random&) {
    return shared(1.2 + 0.15 * turn(frame, 500), 0.4 - 0.2 * turn(frame, 900));
  });
  list.add("short bursts", [bursts = Bursts(10, 40, 70)](int, Random& random) mutable {
    return shared(bursts.next(random) ? 1.7 : 1.3, 0.2);
  });
  list.add("camera cuts", [level = 1.4](int frame, Random& random) mutable {
    if (frame % 200 == 199) level = 1.1 + 0.8 * random.unit();
    return shared(level, 0.25);
  });
  list.add(
          "infeasible, twice",
          [](int frame, Random&) { return shared(frame % 900 >= 500 && frame % 900 < 650 ? 3.8 : 1.2, 0.3); })
      .kind = TraceKind::kInfeasible;
  list.add("CPU-bound in bursts",
           [bursts = Bursts(60, 120, 120)](int, Random& random) mutable {
             FrameLoad load = shared(1.3, 0.25);
             if (bursts.next(random)) load.cpu = 1.2;
             return load;
           })
      .kind = TraceKind::kCpuBound;
  return list.take();
}

std::vector<LoadTrace> traces_of(Split split, std::uint64_t seed) {
  return split == Split::kDevelopment ? development_traces(seed) : held_out_traces(seed);
}

Result<LoadTrace> recorded_trace(const std::string& name, const std::string& csv,
                                 const Recording& recording) {
  if (!(recording.target_ms > 0) || !(recording.fixed_part >= 0 && recording.fixed_part <= 0.9)) {
    return Status::invalid(
        fmt::format("target_ms is {} and fixed_part {}; the first must be above 0, the second in [0, 0.9]",
                    recording.target_ms, recording.fixed_part));
  }
  std::stringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> header = cells(line);
  const auto has = [&header](const char* name) { return std::ranges::count(header, name) > 0; };
  if (!has("gpu_ms") || !has("area_fraction")) {
    return Status::invalid(name + ": line 1 must name the columns gpu_ms and area_fraction");
  }
  LoadTrace trace{.name = name, .frames = {}};
  for (int number = 2; std::getline(lines, line); ++number) {
    if (line.empty()) continue;
    const std::vector<std::string> row = cells(line);
    std::map<std::string, double> figures;  // by column, where the row has it
    for (std::size_t i = 0; i < std::min(row.size(), header.size()); ++i)
      figures.try_emplace(header[i], positive(row[i]));
    const double gpu = figures["gpu_ms"] / recording.target_ms;
    const double area = figures["area_fraction"];
    if (gpu <= 0 || area <= 0) {
      return Status::invalid(
          fmt::format("{}: line {} needs a positive gpu_ms and area_fraction", name, number));
    }
    const double level = gpu / (recording.fixed_part + (1 - recording.fixed_part) * area);
    trace.frames.push_back({.fixed = level * recording.fixed_part,
                            .scaling = level * (1 - recording.fixed_part),
                            .cpu = figures["cpu_ms"] / recording.target_ms});
  }
  if (trace.frames.empty()) return Status::invalid(name + ": no frames after the header");
  return trace;
}

}  // namespace quincunx::traces
