// SPDX-License-Identifier: MIT
// Keys and what follows from them, without a window.
#include "window/key_bindings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "window/frame_graph.h"
#include "window/screen.h"

namespace quincunx::scenes {
namespace {

void press(WindowSettings& settings, const std::string& name) {
  const auto key = key_named(name);
  ASSERT_TRUE(key) << name;
  act_on(*key, settings);
}

WindowSettings usual() {
  WindowSettings settings;
  settings.look.scene = "courtyard";
  settings.look.method = "quincunx:velocity";
  return settings;
}

TEST(KeyBindings, NamesAndKeysAreDifferent) {
  std::set<std::string> names;
  std::set<int> keys;
  for (const KeyBinding& binding : key_bindings()) {
    EXPECT_TRUE(names.insert(binding.name).second) << binding.name;
    EXPECT_TRUE(keys.insert(binding.key).second) << binding.name;
    const auto shifted = key_named(std::string("shift+") + binding.name);
    ASSERT_TRUE(shifted);
    EXPECT_EQ(shifted->key, binding.key);
    EXPECT_TRUE(shifted->shift);
  }
  EXPECT_FALSE(key_named("nothing"));
}

TEST(KeyBindings, PartsGoThroughTheirScalesAndBack) {
  WindowSettings settings = usual();
  const LookSettings before = settings.look;
  std::set<std::string> shadows, particles;
  for (std::size_t i = 0; i < kShadowScales.size(); ++i) {
    press(settings, "l");
    shadows.insert(settings.look.shadow_scale);
  }
  for (std::size_t i = 0; i < kParticleScales.size(); ++i) {
    press(settings, "q");
    particles.insert(settings.look.particle_scale);
  }
  EXPECT_EQ(shadows.size(), kShadowScales.size());
  EXPECT_EQ(particles.size(), kParticleScales.size());
  EXPECT_EQ(settings.look, before);
  press(settings, "q");
  press(settings, "shift+q");
  EXPECT_EQ(settings.look, before);
}

// Every method of the table, once around, and back again by Shift.
TEST(KeyBindings, FilterAndResolveReachEveryMethod) {
  std::set<std::string> reached;
  for (const std::string key : {"f", "r"}) {
    WindowSettings settings = usual();
    for (std::size_t i = 0; i < all_variants().size(); ++i) {
      press(settings, key);
      reached.insert(settings.look.method);
    }
    const std::string before = settings.look.method;
    press(settings, key);
    press(settings, "shift+" + key);
    EXPECT_EQ(settings.look.method, before);
  }
  EXPECT_EQ(reached.size(), all_variants().size());
}

TEST(KeyBindings, RoundTheWholeOfModesAndBack) {
  WindowSettings settings = usual();
  std::set<ResolutionMode> modes;
  for (int i = 0; i < kResolutionModes; ++i) {
    press(settings, "m");
    modes.insert(settings.resolution.mode);
  }
  EXPECT_EQ(modes.size(), static_cast<std::size_t>(kResolutionModes));
  EXPECT_EQ(settings.resolution.mode, ResolutionMode::kFixed);
  press(settings, "shift+c");
  EXPECT_NE(settings.rate.controller, ControllerKind::kFixed) << "fixed is a mode, not a controller";
  EXPECT_NE(settings.rate.controller, ControllerKind::kPredictive);
}

TEST(KeyBindings, ValuesStayWithinTheirBounds) {
  WindowSettings settings = usual();
  for (int i = 0; i < 100; ++i) {
    for (const std::string key : {"up", "right", "b", "z"})
      press(settings, key);
    EXPECT_LE(settings.resolution.scale, kLargestScale);
    EXPECT_LE(settings.split, 1);
    EXPECT_LE(settings.look.shutter, 2);
    EXPECT_LE(settings.zoom.factor, kLargestZoom);
  }
  for (int i = 0; i < 100; ++i) {
    for (const std::string key : {"down", "left", "shift+b", "shift+z"})
      press(settings, key);
    EXPECT_GE(settings.resolution.scale, kSmallestScale);
    EXPECT_GE(settings.split, 0);
    EXPECT_GE(settings.look.shutter, 0);
  }
  EXPECT_EQ(settings.zoom.factor, 1);
}

TEST(ZoomOrigin, ShowsTheMiddleAndNeverMoreThanThePicture) {
  const Extent picture = {101, 50};
  for (int factor = 1; factor <= kLargestZoom; factor *= 2) {
    for (const float centre : {-1.0f, 0.0f, 0.5f, 1.0f, 2.0f}) {
      const ZoomOrigin origin = zoom_origin({factor, {centre, centre}}, picture);
      EXPECT_GE(origin.x, 0);
      EXPECT_GE(origin.y, 0);
      EXPECT_LE(origin.x + std::max(picture.width / factor, 1), picture.width);
      EXPECT_LE(origin.y + std::max(picture.height / factor, 1), picture.height);
    }
  }
  EXPECT_EQ(zoom_origin({2, {.5f, .5f}}, {100, 60}).x, 25);
  EXPECT_EQ(zoom_origin({2, {.5f, .5f}}, {100, 60}).y, 15);
}

TEST(FrameTrace, KeepsTheLastFramesAndCountsDroppedOnes) {
  FrameTrace trace;
  FrameTimes times;
  times.draw_ms = 4;
  times.report.render_extent = {50, 50};
  times.report.passes.push_back({.kernel = "resolve_quincunx", .ms = 2});
  times.report.passes.push_back({.kernel = "present", .ms = -1});  // not known
  for (std::size_t i = 0; i < FrameTrace::kLength + 5; ++i)
    trace.add(times, {100, 100}, 16, i % 5 == 0 ? 2 : 0);
  EXPECT_EQ(trace.points().size(), FrameTrace::kLength);
  EXPECT_EQ(trace.dropped(), 2 * static_cast<int>(FrameTrace::kLength + 5) / 5);
  EXPECT_DOUBLE_EQ(trace.points().back().area, .25);
  EXPECT_DOUBLE_EQ(trace.points().back().opencl_ms, 2);
  ASSERT_EQ(trace.passes().size(), 2u);
  EXPECT_DOUBLE_EQ(trace.passes()[0].ms, 2) << "the mean of equal values is that value";
  EXPECT_DOUBLE_EQ(trace.mean().draw_ms, 4);
}

void expect_refused(const std::string& text, const std::string& part) {
  const auto script = Script::parse(text);
  ASSERT_FALSE(script.ok()) << text;
  EXPECT_EQ(script.status().code(), StatusCode::kInvalidArgument);
  EXPECT_NE(script.status().message().find(part), std::string::npos) << script.status().message();
}

TEST(Script, TakesEveryActionAndComments) {
  const auto script = Script::parse(
      "# a comment\n\n3 key shift+m # and one behind\n  1\tkey period\r\n4 resize 320x200\n5 minimise\n6 "
      "restore\n");
  EXPECT_TRUE(script.ok()) << script.status().message();
  EXPECT_TRUE(Script::parse("").ok());
}

TEST(Script, SaysWhichLineIsWrongAndWhy) {
  expect_refused("1 key m\n\nkey m\n", "line 3: write a turn");
  expect_refused("-1 key m", "line 1: write a turn");
  expect_refused("1", "line 1: write a turn");
  expect_refused("1 jump", "'jump' is no action");
  expect_refused("1 key", "no key is called ''");
  expect_refused("1 key xyz", "no key is called 'xyz'");
  expect_refused("1 key m n", "'n' is one word too many");
  expect_refused("1 resize 0x5", "'0x5' is no size");
  expect_refused("1 minimise now", "'now' is one word too many");
}

TEST(Script, NamesTheFileThatCannotBeRead) {
  const auto script = Script::read("/nowhere/keys");
  ASSERT_FALSE(script.ok());
  EXPECT_EQ(script.status().code(), StatusCode::kIoFailure);
  EXPECT_NE(script.status().message().find("/nowhere/keys"), std::string::npos);
}

}  // namespace
}  // namespace quincunx::scenes
