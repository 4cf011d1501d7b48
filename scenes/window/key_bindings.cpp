// SPDX-License-Identifier: MIT
#include "window/key_bindings.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "catalog/scene_catalog.h"
#include "frames/focus_path.h"
#include "tools/program/atomic_file.h"
#include "tools/program/program.h"

namespace quincunx::scenes {
namespace {

constexpr float kScaleStep = 0.05f;
constexpr float kSplitStep = 0.05f;
constexpr float kShutterStep = 0.25f;
constexpr float kLongestShutter = 2;
constexpr const char* kShift = "shift+";

// The one after `value`, or before it; the first where it is none of them.
template <typename Value>
Value neighbour(const std::vector<Value>& values, const Value& value, bool back) {
  const auto found = std::find(values.begin(), values.end(), value);
  if (found == values.end()) return values.front();
  const auto at = static_cast<std::size_t>(found - values.begin());
  return values[(at + (back ? values.size() - 1 : 1)) % values.size()];
}

template <typename Value>
Value neighbour(Value value, int count, bool back) {
  return static_cast<Value>((static_cast<int>(value) + (back ? count - 1 : 1)) % count);
}

// The next method of one frame, or of those that use earlier ones.
template <bool of_one_frame>
void next_method(WindowSettings& settings, bool back) {
  std::vector<std::string> names;
  for (const VariantInfo& info : all_variants()) {
    if (uses_earlier_frames(info.variant.method) != of_one_frame) names.push_back(info.name);
  }
  settings.look.method = neighbour(names, settings.look.method, back);
}

void next_scene(WindowSettings& settings, bool back) {
  std::vector<std::string> names;
  for (const SceneEntry& entry : list_scenes())
    names.push_back(entry.name);
  settings.look.scene = neighbour(names, settings.look.scene, back);
  if (settings.look.focus != kFocusPointer) settings.look.focus.clear();  // that was in the other scene
}

void next_comparison(WindowSettings& settings, bool back) {
  std::vector<std::string> names = {kCompareNothing, kCompareTruth};
  for (const VariantInfo& info : all_variants())
    names.push_back(info.name);
  settings.look.compared = neighbour(names, settings.look.compared, back);
}

// On steps, whatever the value was before.
void step_scale(WindowSettings& settings, float steps) {
  const float scale = kScaleStep * (std::round(settings.resolution.scale / kScaleStep) + steps);
  settings.resolution.mode = ResolutionMode::kFixed;
  settings.resolution.scale = std::clamp(scale, kSmallestScale, kLargestScale);
}

void step_zoom(WindowSettings& settings, bool out) {
  int& factor = settings.zoom.factor;
  factor = out ? std::max(factor / 2, 1) : factor == kLargestZoom ? 1 : factor * 2;
}

void step_shutter(WindowSettings& settings, bool back) {
  float& shutter = settings.look.shutter;
  shutter += back ? -kShutterStep : kShutterStep;
  if (shutter > kLongestShutter) shutter = 0;
  if (shutter < 0) shutter = kLongestShutter;
}

void next_rate(WindowSettings& settings, bool back) {
  settings.rate.target_fps = neighbour<double>({15.0, 24.0, 30.0, 48.0, 60.0, 75.0, 90.0, 120.0, 144.0},
                                               settings.rate.target_fps, back);
}

void step_split(WindowSettings& settings, float step) {
  settings.split = std::clamp(settings.split + step, 0.0f, 1.0f);
}

// What many keys do: turn a setting over, or wish for something.
template <auto Member>
void turn_over(WindowSettings& settings, bool) {
  settings.*Member = !(settings.*Member);
}
template <auto Member>
void wish(WindowSettings& settings, bool) {
  settings.*Member = true;
}

constexpr KeyBinding kBindings[] = {
    {GLFW_KEY_N, "n", "N", "next scene", next_scene},
    {GLFW_KEY_UP, "up", "Up", "scale up", [](WindowSettings& settings, bool) { step_scale(settings, 1); }},
    {GLFW_KEY_DOWN, "down", "Down", "scale down",
     [](WindowSettings& settings, bool) { step_scale(settings, -1); }},
    {GLFW_KEY_M, "m", "M", "resolution: fixed, controller, sweep, random, lowest",
     [](WindowSettings& settings, bool back) {
       settings.resolution.mode = neighbour(settings.resolution.mode, kResolutionModes, back);
     }},
    {GLFW_KEY_C, "c", "C", "next controller",
     [](WindowSettings& settings, bool back) {
       settings.rate.controller = neighbour(settings.rate.controller, kControllers, back);
     }},
    {GLFW_KEY_P, "p", "P", "target: more pictures a second", next_rate},
    {GLFW_KEY_T, "t", "T", "time: equal steps or by the clock", turn_over<&WindowSettings::real_time>},
    {GLFW_KEY_F, "f", "F", "next filter of one frame", next_method<true>},
    {GLFW_KEY_R, "r", "R", "next resolve over frames", next_method<false>},
    {GLFW_KEY_X, "x", "X", "shading: full or checkerboard",
     [](WindowSettings& settings, bool) {
       Shading& shading = settings.look.shading;
       shading = shading == Shading::kFull ? Shading::kCheckerboard : Shading::kFull;
     }},
    {GLFW_KEY_L, "l", "L", "scale of the sun's shadow map",
     [](WindowSettings& settings, bool back) {
       settings.look.shadow_scale = neighbour(kShadowScales, settings.look.shadow_scale, back);
     }},
    {GLFW_KEY_Q, "q", "Q", "particles: in the frame, or at a scale of their own",
     [](WindowSettings& settings, bool back) {
       settings.look.particle_scale = neighbour(kParticleScales, settings.look.particle_scale, back);
     }},
    {GLFW_KEY_G, "g", "G", "gaze: a focus on what the pointer is on",
     [](WindowSettings& settings, bool) {
       std::string& focus = settings.look.focus;
       focus = focus == kFocusPointer ? "" : kFocusPointer;
     }},
    {GLFW_KEY_B, "b", "B", "motion blur: longer shutter", step_shutter},
    {GLFW_KEY_V, "v", "V", "split view: truth, other methods", next_comparison},
    {GLFW_KEY_LEFT, "left", "Left", "split to the left",
     [](WindowSettings& settings, bool) { step_split(settings, -kSplitStep); }},
    {GLFW_KEY_RIGHT, "right", "Right", "split to the right",
     [](WindowSettings& settings, bool) { step_split(settings, kSplitStep); }},
    {GLFW_KEY_SPACE, "space", "Space", "freeze the frame", turn_over<&WindowSettings::frozen>},
    {GLFW_KEY_PERIOD, "period", ".", "one frame on, while frozen",
     [](WindowSettings& settings, bool) { ++settings.step; }},
    {GLFW_KEY_COMMA, "comma", ",", "one frame back, while frozen",
     [](WindowSettings& settings, bool) { --settings.step; }},
    {GLFW_KEY_Z, "z", "Z", "zoom to pixels: 2, 4 ... 32 times", step_zoom},
    {GLFW_KEY_A, "a", "A", "allocation of targets: viewport or placed",
     [](WindowSettings& settings, bool back) {
       settings.look.targets = neighbour(settings.look.targets, kTargetKinds, back);
     }},
    {GLFW_KEY_U, "u", "U", "output: the window's size, or one that follows the viewport",
     [](WindowSettings& settings, bool) { switch_dual(settings.look); }},
    {GLFW_KEY_S, "s", "S", "screenshot (PNG)", wish<&WindowSettings::screenshot>},
    {GLFW_KEY_D, "d", "D", "dump targets and picture (EXR)", wish<&WindowSettings::dump>},
    {GLFW_KEY_O, "o", "O", "how this interface is drawn",
     [](WindowSettings& settings, bool back) {
       settings.drawing = neighbour(settings.drawing, kUiDrawings, back);
     }},
    {GLFW_KEY_TAB, "tab", "Tab", "hide or show the interface", turn_over<&WindowSettings::show_ui>},
    {GLFW_KEY_H, "h", "H", "this help", turn_over<&WindowSettings::show_help>},
    {GLFW_KEY_ESCAPE, "escape", "Esc", "close the window", wish<&WindowSettings::close>},
};

}  // namespace

std::span<const KeyBinding> key_bindings() {
  return kBindings;
}

void act_on(const KeyPress& press, WindowSettings& settings) {
  for (const KeyBinding& binding : kBindings) {
    if (binding.key == press.key) binding.act(settings, press.shift);
  }
}

std::optional<KeyPress> key_named(const std::string& name) {
  const bool shift = name.starts_with(kShift);
  const std::string plain = shift ? name.substr(std::string(kShift).size()) : name;
  for (const KeyBinding& binding : kBindings) {
    if (plain == binding.name) return KeyPress{binding.key, shift};
  }
  return std::nullopt;
}

Result<Script::Step> Script::parse_line(const std::string& line) {
  std::istringstream words(line);
  Step step;
  std::string action;
  std::string value;
  std::string more;
  if (!(words >> step.turn >> action) || step.turn < 0) {
    return Status::invalid("write a turn, from 0, and an action: 10 key m");
  }
  words >> value;
  if (words >> more) return Status::invalid(fmt::format("'{}' is one word too many", more));
  if (action == "key") {
    const auto key = key_named(value);
    if (!key) return Status::invalid(fmt::format("no key is called '{}'", value));
    step.key = *key;
  } else if (action == "resize") {
    step.action = Action::kResize;
    if (const std::string error = tools::parse_extent(value, step.extent); !error.empty())
      return Status::invalid(error);
  } else if (action == "minimise" || action == "restore") {
    step.action = action == "restore" ? Action::kRestore : Action::kMinimise;
    if (!value.empty()) return Status::invalid(fmt::format("'{}' is one word too many", value));
  } else {
    return Status::invalid(
        fmt::format("'{}' is no action; there are key, resize, minimise and restore", action));
  }
  return step;
}

Result<Script> Script::parse(const std::string& text) {
  Script script;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    line.resize(std::min(line.find('#'), line.size()));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    auto step = parse_line(line);
    if (!step.ok()) return Status::invalid(fmt::format("line {}: {}", number, step.status().message()));
    script.steps_.push_back(step.value());
  }
  std::stable_sort(script.steps_.begin(), script.steps_.end(),
                   [](const Step& a, const Step& b) { return a.turn < b.turn; });
  return script;
}

Result<Script> Script::read(const std::string& path) {
  const auto text = tools::read_text(path);
  if (!text.ok()) return Status::io("script " + text.error());
  auto script = parse(text.value());
  if (!script.ok()) return Status::invalid(fmt::format("script '{}', {}", path, script.status().message()));
  return script;
}

void Script::play(std::int64_t turn, Window& window) {
  for (; next_ < steps_.size() && steps_[next_].turn <= turn; ++next_) {
    const Step& step = steps_[next_];
    switch (step.action) {
      case Action::kKey:
        window.press(step.key);
        break;
      case Action::kResize:
        window.resize(step.extent);
        break;
      case Action::kMinimise:
        window.minimise();
        break;
      case Action::kRestore:
        window.restore();
        break;
    }
  }
}

}  // namespace quincunx::scenes
