// SPDX-License-Identifier: MIT
#include "window/frame_graph.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

namespace quincunx::scenes {
namespace {

constexpr double kNew = 0.1;  // weight of the newest frame in a running mean

// The first value stands for all before it.
void follow(double& mean, double value) {
  mean = mean == 0 ? value : mean + kNew * (value - mean);
}

constexpr float kAreaHeight = 38;
constexpr float kTimeHeight = 68;
constexpr float kGap = 6;
constexpr float kMarkHeight = 7;  // height of a dropped frame's mark
constexpr ImU32 kBackground = IM_COL32(255, 255, 255, 14);
constexpr ImU32 kGrid = IM_COL32(255, 255, 255, 30);
constexpr ImU32 kAreaColour = IM_COL32(232, 163, 61, 255);
constexpr ImU32 kDrawColour = IM_COL32(90, 160, 235, 255);
constexpr ImU32 kOpenclColour = IM_COL32(120, 205, 140, 255);
constexpr ImU32 kCpuColour = IM_COL32(225, 225, 230, 255);
constexpr ImU32 kTargetColour = IM_COL32(255, 255, 255, 110);
constexpr ImU32 kDroppedColour = IM_COL32(235, 80, 80, 255);
constexpr ImU32 kTextColour = IM_COL32(190, 192, 198, 255);

// The colours of methods, by name.
constexpr float kBandHeight = 5;
constexpr ImU32 kMethodColours[] = {IM_COL32(232, 163, 61, 255),  IM_COL32(90, 160, 235, 255),
                                    IM_COL32(120, 205, 140, 255), IM_COL32(200, 120, 215, 255),
                                    IM_COL32(235, 120, 110, 255), IM_COL32(95, 205, 205, 255),
                                    IM_COL32(205, 205, 110, 255), IM_COL32(160, 160, 170, 255)};

struct Plot {
  ImVec2 corner;
  ImVec2 size;
  double top;  // value at the upper edge

  float x(std::size_t index) const {
    return corner.x + size.x * static_cast<float>(index) / static_cast<float>(FrameTrace::kLength - 1);
  }
  float y(double value) const {
    return corner.y + size.y * (1 - static_cast<float>(std::clamp(value / top, 0.0, 1.0)));
  }
};

ImU32 method_colour(std::size_t index) {
  return kMethodColours[index % std::size(kMethodColours)];
}

void draw_frame(const Plot& plot) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 end(plot.corner.x + plot.size.x, plot.corner.y + plot.size.y);
  list->AddRectFilled(plot.corner, end, kBackground, 4);
  const float middle = plot.corner.y + plot.size.y / 2;
  list->AddLine({plot.corner.x, middle}, {end.x, middle}, kGrid);
}

// Writes the value of the upper edge, `below` it.
void draw_label(const Plot& plot, float below, const std::string& text) {
  ImGui::GetWindowDrawList()->AddText({plot.corner.x + 5, plot.corner.y + below}, kTextColour, text.c_str());
}

template <typename Value>
void draw_line(const Plot& plot, const FrameTrace& trace, ImU32 colour, const Value& value) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const std::vector<TracePoint>& points = trace.points();
  for (std::size_t i = 0; i < points.size(); ++i)
    list->PathLineTo({plot.x(i), plot.y(value(points[i]))});
  list->PathStroke(colour, 0, 1.5f);
}

// The methods of the frames that are shown, each once, by name, so that a colour stays with a method as long as the
// others do.
std::vector<std::string> methods_of(const FrameTrace& trace) {
  std::vector<std::string> methods;
  for (const TracePoint& point : trace.points()) {
    if (!point.method.empty() && std::find(methods.begin(), methods.end(), point.method) == methods.end())
      methods.push_back(point.method);
  }
  std::sort(methods.begin(), methods.end());
  return methods;
}

// A band along the lower edge, in the colour of each frame's method.
void draw_methods(const Plot& plot, const FrameTrace& trace, const std::vector<std::string>& methods) {
  const std::vector<TracePoint>& points = trace.points();
  const float bottom = plot.corner.y + plot.size.y;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].method.empty()) continue;
    const auto index = std::find(methods.begin(), methods.end(), points[i].method) - methods.begin();
    const float left = i == 0 ? plot.x(0) : plot.x(i - 1);
    ImGui::GetWindowDrawList()->AddRectFilled({left, bottom - kBandHeight}, {plot.x(i) + 1, bottom},
                                              method_colour(static_cast<std::size_t>(index)));
  }
}

// Columns, because the two add up.
void draw_times(const Plot& plot, const FrameTrace& trace) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const std::vector<TracePoint>& points = trace.points();
  const float width = std::max(plot.size.x / static_cast<float>(FrameTrace::kLength), 1.0f);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float x = plot.x(i);
    const float drawn = plot.y(points[i].draw_ms);
    const float both = plot.y(points[i].draw_ms + points[i].opencl_ms);
    const float left = std::max(x - width, plot.corner.x);
    list->AddRectFilled({left, drawn}, {x, plot.y(0)}, kDrawColour);
    list->AddRectFilled({left, both}, {x, drawn}, kOpenclColour);
    if (points[i].dropped > 0) {
      list->AddTriangleFilled({x - 4, plot.corner.y}, {x + 4, plot.corner.y},
                              {x, plot.corner.y + kMarkHeight}, kDroppedColour);
    }
  }
}

// The next of 5, 10, 20, 50 ... that leaves room above the longest.
double rounded_top(const FrameTrace& trace, double target_ms) {
  double longest = target_ms * 1.1;
  for (const TracePoint& point : trace.points())
    longest = std::max({longest, point.draw_ms + point.opencl_ms, point.cpu_ms});
  for (double top = 5;; top *= 10) {
    for (const double factor : {1.0, 2.0, 4.0, 6.0}) {
      if (top * factor >= longest) return top * factor;
    }
  }
}

void legend(const char* name, ImU32 colour, const std::string& value) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = ImGui::GetTextLineHeight();
  ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + 4}, {at.x + 9, at.y + height - 3}, colour, 2);
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 15);
  ImGui::TextUnformatted(name);
  ImGui::SameLine();
  ImGui::TextDisabled("%s", value.c_str());
}

// How much of the frames that are shown each method had.
void draw_method_legend(const FrameTrace& trace, const std::vector<std::string>& methods) {
  const std::vector<TracePoint>& points = trace.points();
  for (std::size_t i = 0; i < methods.size(); ++i) {
    const auto frames = std::count_if(points.begin(), points.end(),
                                      [&](const TracePoint& point) { return point.method == methods[i]; });
    const double share = static_cast<double>(frames) / static_cast<double>(points.size());
    legend(methods[i].c_str(), method_colour(i), fmt::format("{:.0f} %", 100 * share));
  }
}

}  // namespace

void FrameTrace::add(const FrameTimes& times, Extent output, double interval_ms, int dropped,
                     const std::string& method) {
  const FrameReport& report = times.report;
  TracePoint point = {
      .area = static_cast<double>(report.render_extent.area()) / static_cast<double>(output.area()),
      .draw_ms = times.draw_ms,
      .cpu_ms = times.cpu_ms,
      .interval_ms = interval_ms,
      .dropped = dropped,
      .method = method};
  std::vector<PassTime> passes;
  for (const PassReport& pass : report.passes) {
    const double ms = std::max(pass.ms, 0.0);
    point.opencl_ms += ms;
    const std::string name = name_of(pass);
    const auto known = std::find_if(passes_.begin(), passes_.end(),
                                    [&](const PassTime& time) { return time.kernel == name; });
    passes.push_back({name, known == passes_.end() ? 0 : known->ms});
    follow(passes.back().ms, ms);
  }
  passes_ = std::move(passes);
  follow(mean_.area, point.area);
  follow(mean_.draw_ms, point.draw_ms);
  follow(mean_.opencl_ms, point.opencl_ms);
  follow(mean_.cpu_ms, point.cpu_ms);
  follow(mean_.interval_ms, point.interval_ms);
  dropped_ += dropped;
  if (points_.size() == kLength) points_.erase(points_.begin());
  points_.push_back(point);
}

void draw_frame_graph(const FrameTrace& trace, double target_ms) {
  const float width = ImGui::GetContentRegionAvail().x;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  double largest = 1;
  for (const TracePoint& point : trace.points())
    largest = std::max(largest, point.area);
  const Plot area = {corner, {width, kAreaHeight}, largest};
  const Plot time = {
      {corner.x, corner.y + kAreaHeight + kGap}, {width, kTimeHeight}, rounded_top(trace, target_ms)};
  draw_frame(area);
  draw_line(area, trace, kAreaColour, [](const TracePoint& point) { return point.area; });
  const std::vector<std::string> methods = methods_of(trace);
  draw_methods(area, trace, methods);
  draw_label(area, 2, fmt::format("{:.0f} % of the pixels", 100 * largest));
  draw_frame(time);
  draw_times(time, trace);
  draw_line(time, trace, kCpuColour, [](const TracePoint& point) { return point.cpu_ms; });
  draw_label(time, kMarkHeight + 1, fmt::format("{:.0f} ms", time.top));
  if (target_ms > 0) {
    const float y = time.y(target_ms);
    ImGui::GetWindowDrawList()->AddLine({corner.x, y}, {corner.x + width, y}, kTargetColour);
  }
  ImGui::Dummy({width, kAreaHeight + kGap + kTimeHeight});

  const TracePoint& mean = trace.mean();
  const float column = width / 2;
  const float left = ImGui::GetCursorPosX();
  legend("resolution", kAreaColour, fmt::format("{:.0f} %", 100 * mean.area));
  ImGui::SameLine(left + column);
  legend("dropped", kDroppedColour, fmt::format("{}", trace.dropped()));
  legend("OpenGL", kDrawColour, fmt::format("{:.1f} ms", mean.draw_ms));
  ImGui::SameLine(left + column);
  legend("OpenCL", kOpenclColour, fmt::format("{:.1f} ms", mean.opencl_ms));
  legend("processor", kCpuColour, fmt::format("{:.1f} ms", mean.cpu_ms));
  ImGui::SameLine(left + column);
  ImGui::SetCursorPosX(left + column + 15);
  ImGui::TextUnformatted("frame");
  ImGui::SameLine();
  ImGui::TextDisabled("%.1f ms", mean.interval_ms);
  draw_method_legend(trace, methods);
}

}  // namespace quincunx::scenes
