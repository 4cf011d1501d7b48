// SPDX-License-Identifier: MIT
#include "window/panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "frames/focus_path.h"
#include "window/frame_graph.h"
#include "window/key_bindings.h"

namespace quincunx::scenes {
namespace {

constexpr float kMargin = 12;
constexpr float kWidth = 340;
constexpr float kLabelColumn = 104;

// A label; what is called next fills the rest of the row.
void label(const char* text) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled("%s", text);
  ImGui::SameLine(kLabelColumn);
  ImGui::SetNextItemWidth(-1);
}

void choose_text(const char* text, const std::vector<std::string>& names, std::string& value,
                 const char* nothing = "") {
  label(text);
  const auto shown = [&](const std::string& name) { return name.empty() ? nothing : name.c_str(); };
  if (!ImGui::BeginCombo(fmt::format("##{}", text).c_str(), shown(value), ImGuiComboFlags_HeightLarge))
    return;
  for (const std::string& name : names) {
    if (ImGui::Selectable(shown(name), name == value)) value = name;
  }
  ImGui::EndCombo();
}

template <typename Value>
void choose_value(const char* text, int count, Value& value) {
  label(text);
  if (!ImGui::BeginCombo(fmt::format("##{}", text).c_str(), name_of(value))) return;
  for (int i = 0; i < count; ++i) {
    const auto candidate = static_cast<Value>(i);
    if (ImGui::Selectable(name_of(candidate), candidate == value)) value = candidate;
  }
  ImGui::EndCombo();
}

// At the right end of the row, `margin` before it.
void at_right(const std::string& text, float margin = 0) {
  ImGui::SameLine();
  const float left = ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(text.c_str()).x - margin;
  ImGui::SetCursorPosX(left);
  ImGui::TextUnformatted(text.c_str());
}

void section(const char* title) {
  ImGui::Spacing();
  ImGui::Separator();
  ImGui::TextColored(ImGui::GetStyleColorVec4(ImGuiCol_CheckMark), "%s", title);
}

void draw_head(const FrameTrace& trace, const PanelFacts& facts, bool frozen) {
  const double interval = trace.mean().interval_ms;
  ImGui::TextUnformatted("Quincunx");
  ImGui::SameLine();
  ImGui::TextDisabled("frame %lld%s", static_cast<long long>(facts.frame), frozen ? ", frozen" : "");
  const std::string rate = interval > 0 ? fmt::format("{:.1f} fps", 1000 / interval) : "";
  at_right(rate);
  std::string sizes = fmt::format("{}×{} → ", facts.render.width, facts.render.height);
  if (facts.made != facts.output) sizes += fmt::format("{}×{} → ", facts.made.width, facts.made.height);
  sizes += fmt::format("{}×{}", facts.output.width, facts.output.height);
  ImGui::TextDisabled("%s", sizes.c_str());
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const VariantInfo& info : all_variants())
    names.push_back(info.name);
  return names;
}

std::vector<std::string> focus_choices(const LookSettings& look) {
  std::vector<std::string> choices = {"", kFocusPointer};
  if (!look.focus.empty() && look.focus != kFocusPointer) choices.push_back(look.focus);
  return choices;
}

// Chosen here, or for each frame by the controller, which then tells why.
void draw_method(LookSettings& look, const PanelFacts& facts) {
  if (facts.method.empty()) {
    choose_text("method", method_names(), look.method);
    for (const VariantInfo& info : all_variants()) {
      if (info.name == look.method && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", info.summary.c_str());
    }
    return;
  }
  label("method");
  ImGui::TextUnformatted(facts.method.c_str());
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", facts.reasons.c_str());
}

void draw_motion(const PanelFacts& facts) {
  if (facts.motion.empty()) return;
  label("motion");
  ImGui::TextWrapped("%s", facts.motion.c_str());
}

void draw_picture_settings(WindowSettings& settings, const PanelFacts& facts) {
  LookSettings& look = settings.look;
  const std::string scene = look.scene;
  choose_text("scene", facts.scenes, look.scene);
  if (look.scene != scene && look.focus != kFocusPointer) look.focus.clear();  // that was in the other scene
  draw_method(look, facts);
  draw_motion(facts);
  choose_value("targets", kTargetKinds, look.targets);
  choose_text("shadow map", kShadowScales, look.shadow_scale);
  choose_text("particles", kParticleScales, look.particle_scale, "in the frame");
  choose_text("focus", focus_choices(look), look.focus, "none");
  bool dual = !look.dual.empty();
  label("output");
  if (ImGui::Checkbox("dynamic", &dual)) switch_dual(look);
  choose_value("resolution", kResolutionModes, settings.resolution.mode);
  label("scale");
  float scale = settings.resolution.scale;
  if (ImGui::SliderFloat("##scale", &scale, kSmallestScale, kLargestScale, "%.2f",
                         ImGuiSliderFlags_AlwaysClamp)) {
    settings.resolution.mode = ResolutionMode::kFixed;
    settings.resolution.scale = scale;
  }
  label("target");
  auto target = static_cast<float>(settings.rate.target_fps);
  if (ImGui::SliderFloat("##target", &target, 10, 144, "%.0f fps", ImGuiSliderFlags_AlwaysClamp))
    settings.rate.target_fps = std::round(target);
  choose_value("controller", kControllers, settings.rate.controller);
  label("blur");
  ImGui::SliderFloat("##blur", &look.shutter, 0, 2, look.shutter > 0 ? "shutter %.2f" : "off",
                     ImGuiSliderFlags_AlwaysClamp);
}

void draw_view_settings(WindowSettings& settings) {
  std::vector<std::string> names = method_names();
  names.insert(names.begin(), {kCompareNothing, kCompareTruth});
  choose_text("compare", names, settings.look.compared, "nothing");
  if (settings.look.compared != kCompareNothing) {
    label("split");
    ImGui::SliderFloat("##split", &settings.split, 0, 1, "%.2f", ImGuiSliderFlags_AlwaysClamp);
  }
  label("zoom");
  int power = static_cast<int>(std::lround(std::log2(settings.zoom.factor)));
  if (ImGui::SliderInt("##zoom", &power, 0, 5, fmt::format("{}×", settings.zoom.factor).c_str()))
    settings.zoom.factor = 1 << std::clamp(power, 0, 5);
  label("frame");
  ImGui::Checkbox("real time", &settings.real_time);
  ImGui::SameLine();
  ImGui::Checkbox("frozen", &settings.frozen);
  if (settings.frozen) {
    ImGui::SameLine();
    if (ImGui::Button(" < ")) --settings.step;
    ImGui::SameLine();
    if (ImGui::Button(" > ")) ++settings.step;
  }
}

void draw_pass_times(const FrameTrace& trace) {
  double longest = 1e-9;
  for (const PassTime& pass : trace.passes())
    longest = std::max(longest, pass.ms);
  for (const PassTime& pass : trace.passes()) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    const float height = ImGui::GetTextLineHeight();
    const float filled = width * static_cast<float>(pass.ms / longest);
    ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + filled, at.y + height + 2},
                                              IM_COL32(120, 205, 140, 60), 3);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 5);
    ImGui::TextUnformatted(pass.kernel.c_str());
    const std::string time = fmt::format("{:.2f} ms", pass.ms);
    at_right(time, 5);
  }
}

void draw_files(WindowSettings& settings, const PanelFacts& facts) {
  const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  if (ImGui::Button("screenshot", {half, 0})) settings.screenshot = true;
  ImGui::SameLine();
  if (ImGui::Button("dump", {half, 0})) settings.dump = true;
  if (!facts.message.empty()) ImGui::TextWrapped("%s", facts.message.c_str());
  choose_value("interface", kUiDrawings, settings.drawing);
  ImGui::TextDisabled("H help, Tab hides all this");
}

// A text on a dark plate, in front of everything; x and y are where its middle top lies.
void plate(float x, float y, const std::string& text) {
  ImDrawList* list = ImGui::GetForegroundDrawList();
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const ImVec2 corner(std::round(x - size.x / 2), std::round(y));
  list->AddRectFilled({corner.x - 8, corner.y - 4}, {corner.x + size.x + 8, corner.y + size.y + 4},
                      IM_COL32(18, 19, 23, 215), 6);
  list->AddText(corner, IM_COL32(235, 235, 237, 255), text.c_str());
}

void draw_split_labels(const WindowSettings& settings, const PanelFacts& facts, const ImVec2& size) {
  if (settings.look.compared == kCompareNothing) return;
  const float x = std::round(settings.split * size.x);
  ImGui::GetBackgroundDrawList()->AddLine({x, 0}, {x, size.y}, IM_COL32(232, 163, 61, 255), 2);
  const std::string& method = facts.method.empty() ? settings.look.method : facts.method;
  const float left = ImGui::CalcTextSize(method.c_str()).x / 2 + 18;
  const float right = ImGui::CalcTextSize(settings.look.compared.c_str()).x / 2 + 18;
  plate(x - left, size.y - 40, method);
  plate(x + right, size.y - 40, settings.look.compared);
}

void draw_pixel(const WindowSettings& settings, const PanelFacts& facts, const ImVec2& size) {
  if (settings.zoom.factor == 1) return;
  std::string text = fmt::format("{}×", settings.zoom.factor);
  if (facts.pixel) {
    text += fmt::format("   pixel {}, {}   {} {} {}", facts.pixel->x, facts.pixel->y, facts.pixel->rgba[0],
                        facts.pixel->rgba[1], facts.pixel->rgba[2]);
  }
  plate((size.x - kWidth) / 2, 14, text);
}

void draw_help(const ImVec2& size) {
  ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {.5f, .5f});
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                                      ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoMove;
  if (ImGui::Begin("help", nullptr, kFlags)) {
    for (const KeyBinding& binding : key_bindings()) {
      ImGui::TextColored(ImGui::GetStyleColorVec4(ImGuiCol_CheckMark), "%s", binding.shown);
      ImGui::SameLine(70);
      ImGui::TextUnformatted(binding.does);
    }
    ImGui::Spacing();
    ImGui::TextDisabled("Shift goes the other way. The wheel zooms, dragging moves the part that is shown.");
  }
  ImGui::End();
}

}  // namespace

void draw_panel(WindowSettings& settings, const FrameTrace& trace, const PanelFacts& facts) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  draw_split_labels(settings, facts, size);
  draw_pixel(settings, facts, size);
  const float width = std::min(kWidth, size.x - 2 * kMargin);
  ImGui::SetNextWindowPos({size.x - width - kMargin, kMargin});
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, std::max(size.y - 2 * kMargin, 40.0f)});
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_AlwaysAutoResize |
                                      ImGuiWindowFlags_NoNav;
  if (ImGui::Begin("panel", nullptr, kFlags)) {
    draw_head(trace, facts, settings.frozen);
    section("Picture");
    draw_picture_settings(settings, facts);
    section("View");
    draw_view_settings(settings);
    section("Cost");
    draw_frame_graph(trace, facts.target_ms);
    ImGui::TextWrapped("%s", facts.crossing.c_str());
    draw_pass_times(trace);
    section("Files");
    draw_files(settings, facts);
  }
  ImGui::End();
  if (settings.show_help) draw_help(size);
}

}  // namespace quincunx::scenes
