// SPDX-License-Identifier: MIT
// c/control.h: its controllers choose what those of C++ do, and each wrong field is named.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>

#include "all_controllers.h"
#include "quincunx/c/control.h"
#include "quincunx/control/cost_table.h"
#include "quincunx/control/detail_follower.h"
#include "quincunx/control/output_follower.h"

namespace quincunx {
namespace {

struct Destroy {
  void operator()(quincunx_controller* made) const { quincunx_controller_destroy(made); }
  void operator()(quincunx_costs* made) const { quincunx_costs_destroy(made); }
  void operator()(quincunx_front* made) const { quincunx_front_destroy(made); }
  void operator()(quincunx_output_follower* made) const { quincunx_output_follower_destroy(made); }
  void operator()(quincunx_detail_follower* made) const { quincunx_detail_follower_destroy(made); }
};
template <typename Object>
using Owner = std::unique_ptr<Object, Destroy>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr Extent kOutput{1920, 1080};

template <typename Struct>
Struct sized() {
  Struct made = {};
  made.struct_size = sizeof(made);
  return made;
}

quincunx_controller_settings settings_of(int kind) {
  auto settings = sized<quincunx_controller_settings>();
  EXPECT_EQ(quincunx_controller_settings_init(&settings), QUINCUNX_OK) << quincunx_last_error();
  settings.kind = kind;
  settings.output_width = kOutput.width;
  settings.output_height = kOutput.height;
  return settings;
}

Owner<quincunx_controller> controller_of(const quincunx_controller_settings& settings) {
  quincunx_controller* made = nullptr;
  EXPECT_EQ(quincunx_controller_create(&settings, &made), QUINCUNX_OK) << quincunx_last_error();
  return Owner<quincunx_controller>(made);
}

quincunx_choice choice_of(const quincunx_controller* controller) {
  auto choice = sized<quincunx_choice>();
  EXPECT_EQ(quincunx_controller_choice(controller, &choice), QUINCUNX_OK) << quincunx_last_error();
  return choice;
}

struct Pair {
  const char* name;
  std::function<void(quincunx_controller_settings&)> set;
  std::function<std::unique_ptr<ResolutionController>()> make;
};

class CControllers : public ::testing::TestWithParam<Pair> {};

// Frames of any load, with and without what may be unknown, and some that are refused.
TEST_P(CControllers, ChooseAsThoseOfCpp) {
  auto settings = settings_of(QUINCUNX_CONTROL_PREDICTIVE);
  GetParam().set(settings);
  const auto controller = controller_of(settings);
  const auto expected = GetParam().make();
  auto* quality = dynamic_cast<QualityController*>(expected.get());
  EXPECT_STREQ(quincunx_controller_name(controller.get()), expected->name());
  ASSERT_EQ(quincunx_controller_rung_count(controller.get()), expected->ladder().size());
  for (int i = 0; i < expected->ladder().size(); ++i) {
    int extent[2] = {};
    ASSERT_EQ(quincunx_controller_rung(controller.get(), i, extent), QUINCUNX_OK);
    ASSERT_EQ((Extent{extent[0], extent[1]}), expected->ladder()[i]);
  }
  std::mt19937 random(3);
  const auto below = [&](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
  int faded = 0, refused = 0;
  double load = 20;
  for (std::uint64_t n = 1; n < 600; ++n) {
    if (n % 97 == 0) load = 8 + below(30);
    const Extent at = expected->next();
    const double area = static_cast<double>(at.area()) / static_cast<double>(kOutput.area());
    QualityFrame frame = {.timing = {.frame = n,
                                     .render_extent = at,
                                     .gpu_ms = load * (0.25 + 0.75 * area) + 0.01 * below(100),
                                     .cpu_ms = 0.1 * below(180),
                                     .interval_ms = n % 3 == 0 ? 0 : 16 + 0.1 * below(50),
                                     .queued = below(4) == 0 ? FrameTiming::kUnknownQueue : 1 + below(2),
                                     .missed_vsyncs = below(20) == 0,
                                     .blur_px = 0.5 * below(40)},
                          .resolve_ms = 1};
    if (n % 5 == 0) {
      frame.content = {.moving = 0.01 * below(100), .speed_px = 4, .cut = below(20) == 0};
      if (n / 150 % 2 == 1) frame.content = {.light = n % 3 == 0 ? 1.0 : 0.0, .judged = n % 3 == 0};
    }
    if (below(30) == 0) frame.timing.gpu_ms = -1;
    auto timing = sized<quincunx_timing>();
    auto content = sized<quincunx_content>();
    timing.frame = n;
    timing.render_width = at.width;
    timing.render_height = at.height;
    timing.gpu_ms = frame.timing.gpu_ms;
    timing.cpu_ms = frame.timing.cpu_ms;
    timing.interval_ms = frame.timing.interval_ms;
    timing.queued = frame.timing.queued == FrameTiming::kUnknownQueue ? 0 : frame.timing.queued;
    timing.missed_vsyncs = frame.timing.missed_vsyncs;
    timing.blur_px = frame.timing.blur_px;
    timing.resolve_ms = frame.resolve_ms;
    if (frame.content) {
      content.moving = frame.content->moving;
      content.speed_px = frame.content->speed_px;
      content.light = frame.content->light;
      content.cut = frame.content->cut;
      content.judged = frame.content->judged;
      timing.content = &content;
    }
    const Status told = quality != nullptr ? quality->observe(frame) : expected->observe(frame.timing);
    const quincunx_status status = quincunx_controller_observe(controller.get(), &timing);
    ASSERT_EQ(status == QUINCUNX_OK, told.ok()) << told.message();
    if (!told.ok()) {
      ++refused;
      ASSERT_EQ(quincunx_last_error(), told.message());
    }
    if (n == 300) {
      ASSERT_TRUE(expected->set_target_ms(33).ok());
      ASSERT_EQ(quincunx_controller_set_target_ms(controller.get(), 33), QUINCUNX_OK);
      EXPECT_EQ(quincunx_controller_target_ms(controller.get()), 33);
    }
    const quincunx_choice choice = choice_of(controller.get());
    ASSERT_EQ((Extent{choice.render_width, choice.render_height}), expected->next()) << "frame " << n;
    ASSERT_EQ(choice.rung, expected->rung());
    if (quality == nullptr) {
      ASSERT_EQ(choice.method, nullptr);
      continue;
    }
    const QualityChoice other = quality->choice();
    ASSERT_EQ(choice.method, name_of(other.method));
    ASSERT_EQ(choice.weight, other.weight);
    ASSERT_EQ(choice.fading_from != nullptr, other.fading_from.has_value());
    if (other.fading_from) {
      ++faded;
      ASSERT_EQ(choice.fading_from, name_of(*other.fading_from));
    }
    ASSERT_EQ(quincunx_controller_text(controller.get()), explain(quality->reasons()));
  }
  EXPECT_GT(refused, 0);
  EXPECT_EQ(faded > 0, quality != nullptr);
}

const char* const kMethods[] = {"quincunx:reprojected", "temporal"};
constexpr LadderSettings kLadder = {.output_extent = kOutput};
constexpr LadderSettings kOtherLadder = {.output_extent = kOutput,
                                         .min_scale = 0.4,
                                         .max_scale = 1.2,
                                         .order = AxisOrder::kBoth,
                                         .step = 8,
                                         .min_extent = {800, 600}};

const Pair kPairs[] = {
    {"proportional",
     [](quincunx_controller_settings& to) {
       to.kind = QUINCUNX_CONTROL_PROPORTIONAL;
       to.rate = 0.1;
       to.spike_ratio = 2;
       to.target_ms = 20;
     },
     [] {
       return make_proportional_controller(
                  {.ladder = kLadder, .target_ms = 20, .rate = 0.1, .spike_ratio = 2})
           .value();
     }},
    {"minimum_of_n",
     [](quincunx_controller_settings& to) {
       to.kind = QUINCUNX_CONTROL_MINIMUM_OF_N;
       to.count = 3;
       to.factor = 0.3;
       to.margin = 0.9;
     },
     [] {
       return make_minimum_of_n_controller({.ladder = kLadder, .count = 3, .factor = 0.3, .margin = 0.9})
           .value();
     }},
    {"predictive", [](quincunx_controller_settings&) {},
     [] { return make_predictive_controller({.ladder = kLadder}).value(); }},
    {"predictive_with_all",
     [](quincunx_controller_settings& to) {
       to.min_scale = 0.4;
       to.max_scale = 1.2;
       to.order = QUINCUNX_BOTH_AXES;
       to.step = 8;
       to.min_width = 800;
       to.min_height = 600;
       to.buffers = 2;
       to.fixed_part = 0.5;
       to.cpu_bound = QUINCUNX_FOLLOW;
       to.blur_aware = 1;
       to.blur_start_px = 2;
       to.blur_full_px = 12;
       to.blur_min_scale = 0.6;
     },
     [] {
       return make_predictive_controller(
                  {.ladder = kOtherLadder,
                   .buffers = 2,
                   .fixed_part = 0.5,
                   .cpu_bound = CpuBound::kFollow,
                   .blur_aware = {.enabled = true, .start_px = 2, .full_px = 12, .min_scale = 0.6}})
           .value();
     }},
    {"quality", [](quincunx_controller_settings& to) { to.kind = QUINCUNX_CONTROL_QUALITY; },
     [] { return make_quality_controller({.pacing = {.ladder = kLadder}}).value(); }},
    {"quality_with_all",
     [](quincunx_controller_settings& to) {
       to.kind = QUINCUNX_CONTROL_QUALITY;
       to.methods = kMethods;
       to.method_count = 2;
       to.hysteresis = 0.01;
       to.rest_seconds = 0.25;
       to.fade_frames = 3;
     },
     [] {
       return make_quality_controller(
                  {.pacing = {.ladder = kLadder},
                   .methods = {{.method = Method::kQuincunx, .form = TwoFrameForm::kReprojected},
                               {.method = Method::kTemporal}},
                   .hysteresis = 0.01,
                   .rest_seconds = 0.25,
                   .fade_frames = 3})
           .value();
     }},
};
INSTANTIATE_TEST_SUITE_P(Kinds, CControllers, ::testing::ValuesIn(kPairs),
                         [](const auto& instance) { return instance.param.name; });

TEST(CControl, CostsAreThoseOfCpp) {
  quincunx_costs* raw = nullptr;
  ASSERT_EQ(quincunx_costs_create(100, &raw), QUINCUNX_OK);
  const Owner<quincunx_costs> costs(raw);
  CostTable table = CostTable::create(100).value();
  double ms = 0, fixed = 0;
  EXPECT_EQ(quincunx_costs_predict(raw, 0.5, 0.25, &ms), QUINCUNX_NOT_READY);
  EXPECT_EQ(quincunx_costs_fixed_part(raw, &fixed), QUINCUNX_NOT_READY);
  for (std::uint64_t n = 0; n < 40; ++n) {
    const double area = 0.25 + 0.02 * static_cast<double>(n);
    ASSERT_TRUE(table.record(n, area, 4 + 9 * area).ok());
    ASSERT_EQ(quincunx_costs_record(raw, n, area, 4 + 9 * area), QUINCUNX_OK);
  }
  ASSERT_EQ(quincunx_costs_predict(raw, 0.5, 0.25, &ms), QUINCUNX_OK);
  EXPECT_EQ(ms, table.predict(0.5));
  ASSERT_EQ(quincunx_costs_fixed_part(raw, &fixed), QUINCUNX_OK);
  EXPECT_EQ(fixed, table.fixed_part());
  EXPECT_EQ(quincunx_costs_confidence(raw, 0.5), table.confidence(0.5));
  EXPECT_EQ(quincunx_costs_text(raw), table.to_json());
  quincunx_costs* again = nullptr;
  ASSERT_EQ(quincunx_costs_parse(quincunx_costs_text(raw), &again), QUINCUNX_OK) << quincunx_last_error();
  const Owner<quincunx_costs> copy(again);
  auto settings = settings_of(QUINCUNX_CONTROL_PREDICTIVE);
  settings.calibration = again;
  const auto controller = controller_of(settings);
  const auto expected = make_predictive_controller({.ladder = kLadder, .calibration = table}).value();
  for (std::uint64_t n = 1; n < 50; ++n) {
    auto timing = sized<quincunx_timing>();
    timing.frame = n;
    timing.render_width = expected->next().width;
    timing.render_height = expected->next().height;
    timing.gpu_ms = 25;
    ASSERT_EQ(quincunx_controller_observe(controller.get(), &timing), QUINCUNX_OK);
    ASSERT_TRUE(expected->observe({.frame = n, .render_extent = expected->next(), .gpu_ms = 25}).ok());
    ASSERT_EQ(choice_of(controller.get()).rung, expected->rung()) << n;
  }
}

TEST(CControl, TheFrontIsThatOfCpp) {
  quincunx_front* raw = nullptr;
  ASSERT_EQ(quincunx_front_parse(nullptr, &raw), QUINCUNX_OK) << quincunx_last_error();
  const Owner<quincunx_front> front(raw);
  const ErrorFront& expected = ErrorFront::built_in();
  EXPECT_EQ(quincunx_front_text(raw), expected.to_json());
  EXPECT_EQ(quincunx_front_summary(raw), expected.summary());
  auto content = sized<quincunx_content>();
  content.moving = 0.75;
  content.apart = 0.25;
  double share[QUINCUNX_SCENE_CLASSES] = {}, flip = 0, ms = 0;
  ASSERT_EQ(quincunx_mix_of(&content, share), QUINCUNX_OK) << quincunx_last_error();
  const SceneMix mix = mix_of({.moving = 0.75, .apart = 0.25});
  for (std::size_t i = 0; i < kSceneClasses; ++i)
    EXPECT_EQ(share[i], mix.share[i]);
  const MethodVariant temporal = {.method = Method::kTemporal};
  ASSERT_EQ(quincunx_front_flip(raw, share, "temporal", 0.6, &flip), QUINCUNX_OK) << quincunx_last_error();
  EXPECT_EQ(flip, expected.flip(mix, temporal, 0.6));
  ASSERT_EQ(quincunx_front_resolve_ms(raw, "temporal", 0.6, 2, &ms), QUINCUNX_OK) << quincunx_last_error();
  EXPECT_EQ(ms, expected.resolve_ms(temporal, 0.6, 2));
  quincunx_front* copy = nullptr;
  ASSERT_EQ(quincunx_front_parse(quincunx_front_text(raw), &copy), QUINCUNX_OK) << quincunx_last_error();
  const Owner<quincunx_front> owner(copy);
  auto settings = settings_of(QUINCUNX_CONTROL_QUALITY);
  settings.front = copy;
  EXPECT_STREQ(quincunx_controller_name(controller_of(settings).get()), "quality");
}

TEST(CControl, FollowersFollowAsThoseOfCpp) {
  auto output = sized<quincunx_output_settings>();
  ASSERT_EQ(quincunx_output_settings_init(&output), QUINCUNX_OK);
  output.display_width = kOutput.width;
  output.display_height = kOutput.height;
  quincunx_output_follower* raw_output = nullptr;
  ASSERT_EQ(quincunx_output_follower_create(&output, &raw_output), QUINCUNX_OK) << quincunx_last_error();
  const Owner<quincunx_output_follower> output_owner(raw_output);
  auto detail = sized<quincunx_detail_settings>();
  ASSERT_EQ(quincunx_detail_settings_init(&detail), QUINCUNX_OK);
  quincunx_detail_follower* raw_detail = nullptr;
  ASSERT_EQ(quincunx_detail_follower_create(&detail, &raw_detail), QUINCUNX_OK) << quincunx_last_error();
  const Owner<quincunx_detail_follower> detail_owner(raw_detail);
  OutputFollower outputs = OutputFollower::create({.display = kOutput}).value();
  DetailFollower details = DetailFollower::create().value();
  int extent[2] = {};
  ASSERT_EQ(quincunx_output_follower_min_output(raw_output, extent), QUINCUNX_OK);
  EXPECT_EQ((Extent{extent[0], extent[1]}), outputs.min_output());
  int changes = 0;
  for (int n = 0; n < 400; ++n) {
    const double scale = 0.7 + 0.4 * std::sin(n / 40.0);
    const Extent render = {static_cast<int>(1920 * scale), static_cast<int>(1080 * scale)};
    int level = -1;
    const int before = details.level();
    ASSERT_EQ(quincunx_output_follower_observe(raw_output, render.width, render.height, extent), QUINCUNX_OK);
    ASSERT_EQ((Extent{extent[0], extent[1]}), outputs.observe(render));
    ASSERT_EQ(quincunx_detail_follower_observe(raw_detail, scale * scale, &level), QUINCUNX_OK);
    ASSERT_EQ(level, details.observe(scale * scale));
    changes += level != before;
  }
  EXPECT_GT(changes, 2);
}

// A wrong field of a struct, and the words of its sentence.
template <typename Struct>
struct Wrong {
  const char* field;
  std::function<void(Struct&)> set;
  const char* words = nullptr;  // null: the field's name
  int kind = QUINCUNX_CONTROL_QUALITY;
};

TEST(CControl, EachWrongSettingIsNamed) {
  using S = quincunx_controller_settings;
  static const char* const unknown[] = {"bicubic"};
  static const char* const missing[] = {nullptr};
  const Wrong<S> table[] = {
      {"struct_size", [](S& s) { s.struct_size = 191; }},
      {"kind", [](S& s) { s.kind = 4; }},
      {"kind", [](S& s) { s.kind = -1; }},
      {"output", [](S& s) { s.output_width = 0; }},
      {"output", [](S& s) { s.output_height = 40000; }},
      {"order", [](S& s) { s.order = 3; }},
      {"step", [](S& s) { s.step = 0; }},
      {"min_extent", [](S& s) { s.min_width = 0; }},
      {"min_extent", [](S& s) { s.min_height = -8; }},
      {"buffers", [](S& s) { s.buffers = 1; }},
      {"min_scale", [](S& s) { s.min_scale = kNaN; }},
      {"max_scale", [](S& s) { s.max_scale = 0.25; }},
      {"max_scale", [](S& s) { s.max_scale = HUGE_VAL; }},
      {"target", [](S& s) { s.target_ms = kNaN; }},
      {"rate", [](S& s) { s.rate = 2; }, nullptr, QUINCUNX_CONTROL_PROPORTIONAL},
      {"spike_ratio", [](S& s) { s.spike_ratio = kNaN; }, nullptr, QUINCUNX_CONTROL_PROPORTIONAL},
      {"count", [](S& s) { s.count = 0; }, nullptr, QUINCUNX_CONTROL_MINIMUM_OF_N},
      {"factor", [](S& s) { s.factor = kNaN; }, nullptr, QUINCUNX_CONTROL_MINIMUM_OF_N},
      {"margin", [](S& s) { s.margin = 0; }, nullptr, QUINCUNX_CONTROL_MINIMUM_OF_N},
      {"cpu_bound", [](S& s) { s.cpu_bound = 2; }},
      {"fixed_part", [](S& s) { s.fixed_part = kNaN; }},
      {"start_px", [](S& s) { s.blur_aware = 1, s.blur_start_px = kNaN; }},
      {"full_px", [](S& s) { s.blur_aware = 1, s.blur_full_px = 0; }},
      {"min_scale", [](S& s) { s.blur_aware = 1, s.blur_min_scale = 2; }},
      {"fade_frames", [](S& s) { s.fade_frames = -1; }},
      {"methods", [](S& s) { s.method_count = 1; }, "settings.methods is NULL; it must point to 1 names"},
      {"method_count", [](S& s) { s.method_count = -1; }},
      {"methods[0]", [](S& s) { s.methods = unknown, s.method_count = 1; }},
      {"methods[0] is NULL", [](S& s) { s.methods = missing, s.method_count = 1; }},
      {"hysteresis", [](S& s) { s.hysteresis = kNaN; }},
      {"rest_seconds", [](S& s) { s.rest_seconds = 61; }},
  };
  for (const Wrong<S>& wrong : table) {
    S settings = settings_of(wrong.kind);
    wrong.set(settings);
    auto* made = reinterpret_cast<quincunx_controller*>(&settings);
    EXPECT_EQ(quincunx_controller_create(&settings, &made), QUINCUNX_INVALID_ARGUMENT) << wrong.field;
    EXPECT_EQ(made, nullptr) << wrong.field;
    const std::string words = wrong.words != nullptr ? wrong.words : wrong.field;
    EXPECT_NE(std::string(quincunx_last_error()).find(words), std::string::npos)
        << wrong.field << ": " << quincunx_last_error();
  }
}

TEST(CControl, EachWrongTimingIsNamed) {
  using T = quincunx_timing;
  static quincunx_content bad = [] {
    auto content = sized<quincunx_content>();
    content.thin = kNaN;
    return content;
  }();
  static quincunx_content unsized = {};
  const Wrong<T> table[] = {
      {"struct_size", [](T& t) { t.struct_size = 8; }},
      {"frame", [](T& t) { t.frame = 0; }},
      {"extent", [](T& t) { t.render_width = 0; }},
      {"gpu_ms", [](T& t) { t.gpu_ms = kNaN; }},
      {"gpu_ms", [](T& t) { t.gpu_ms = 0; }},
      {"cpu_ms", [](T& t) { t.cpu_ms = -1; }},
      {"interval_ms", [](T& t) { t.interval_ms = HUGE_VAL; }},
      {"queued", [](T& t) { t.queued = -1; }},
      {"missed_vsyncs", [](T& t) { t.missed_vsyncs = -2; }},
      {"blur_px", [](T& t) { t.blur_px = kNaN; }},
      {"resolve_ms", [](T& t) { t.resolve_ms = kNaN; }},
      {"thin", [](T& t) { t.content = &bad; }},
      {"content.struct_size", [](T& t) { t.content = &unsized; }},
  };
  const auto controller = controller_of(settings_of(QUINCUNX_CONTROL_QUALITY));
  auto good = sized<T>();
  good.frame = 1;
  good.render_width = good.render_height = 500;
  good.gpu_ms = 10;
  ASSERT_EQ(quincunx_controller_observe(controller.get(), &good), QUINCUNX_OK) << quincunx_last_error();
  const int rung = choice_of(controller.get()).rung;
  good.frame = 2;
  for (const Wrong<T>& wrong : table) {
    T timing = good;
    wrong.set(timing);
    EXPECT_EQ(quincunx_controller_observe(controller.get(), &timing), QUINCUNX_INVALID_ARGUMENT)
        << wrong.field;
    EXPECT_NE(std::string(quincunx_last_error()).find(wrong.field), std::string::npos)
        << wrong.field << ": " << quincunx_last_error();
    EXPECT_EQ(choice_of(controller.get()).rung, rung);
  }
}

TEST(CControl, NullAndNonsenseAreErrors) {
  double number = 0, share[QUINCUNX_SCENE_CLASSES] = {};
  int32_t pair[2] = {};
  quincunx_costs* costs = nullptr;
  quincunx_front* front = nullptr;
  ASSERT_EQ(quincunx_costs_create(10, &costs), QUINCUNX_OK);
  const Owner<quincunx_costs> costs_owner(costs);
  ASSERT_EQ(quincunx_front_parse(nullptr, &front), QUINCUNX_OK);
  const Owner<quincunx_front> front_owner(front);
  const auto controller = controller_of(settings_of(QUINCUNX_CONTROL_PREDICTIVE));
  quincunx_costs* no_costs = nullptr;
  quincunx_front* no_front = nullptr;
  struct Call {
    std::function<quincunx_status()> call;
    const char* words;
  };
  const Call table[] = {
      {[] { return quincunx_controller_settings_init(nullptr); }, "settings is NULL"},
      {[] { return quincunx_controller_create(nullptr, nullptr); }, "controller is NULL"},
      {[] { return quincunx_controller_observe(nullptr, nullptr); }, "controller is NULL"},
      {[&] { return quincunx_controller_observe(controller.get(), nullptr); }, "timing is NULL"},
      {[] { return quincunx_controller_choice(nullptr, nullptr); }, "controller is NULL"},
      {[&] { return quincunx_controller_choice(controller.get(), nullptr); }, "choice is NULL"},
      {[] { return quincunx_controller_set_target_ms(nullptr, 1); }, "controller is NULL"},
      {[&] { return quincunx_controller_set_target_ms(controller.get(), kNaN); }, "target"},
      {[&] { return quincunx_controller_rung(controller.get(), -1, pair); },
       "rung is -1; it must lie in [0,"},
      {[&] { return quincunx_controller_rung(controller.get(), 0, nullptr); }, "extent is NULL"},
      {[&] { return quincunx_mix_of(nullptr, share); }, "content is NULL"},
      {[] { return quincunx_mix_of(nullptr, nullptr); }, "share is NULL"},
      {[&] { return quincunx_costs_create(kNaN, &no_costs); }, "half_life"},
      {[&] { return quincunx_costs_parse(nullptr, &no_costs); }, "json is NULL"},
      {[&] { return quincunx_costs_parse("{\"x\": [", &no_costs); }, ""},
      {[&] { return quincunx_costs_record(costs, 1, kNaN, 1); }, "area"},
      {[&] { return quincunx_costs_record(costs, 1, 1, -1); }, "gpu_ms"},
      {[] { return quincunx_costs_record(nullptr, 1, 1, 1); }, "costs is NULL"},
      {[&] { return quincunx_costs_predict(costs, kNaN, 0.25, &number); }, "area_fraction"},
      {[&] { return quincunx_costs_predict(costs, 1, kNaN, &number); }, "fixed_part"},
      {[&] { return quincunx_costs_predict(costs, 1, 0.25, nullptr); }, "gpu_ms is NULL"},
      {[] { return quincunx_costs_fixed_part(nullptr, nullptr); }, "costs is NULL"},
      {[&] { return quincunx_front_parse("[]", &no_front); }, "error front"},
      {[&] { return quincunx_front_find(nullptr, "", &no_front); }, "device is NULL"},
      {[&] { return quincunx_front_flip(front, share, "temporal", 1, &number); }, "a mix 1 together"},
      {[&] { return quincunx_front_flip(front, nullptr, "temporal", 1, &number); }, "share is NULL"},
      {[&] { return quincunx_front_flip(front, share, "best", 1, &number); }, "best"},
      {[&] { return quincunx_front_resolve_ms(front, "temporal", kNaN, 1, &number); }, "scale"},
      {[&] { return quincunx_front_resolve_ms(front, "temporal", 1, kNaN, &number); }, "megapixels"},
      {[&] { return quincunx_front_resolve_ms(front, "temporal", 1, 1e308, &number); },
       "(0, 1073.7] megapixels"},
      {[&] { return quincunx_front_resolve_ms(front, nullptr, 1, 1, &number); }, "method is NULL"},
      {[] { return quincunx_output_settings_init(nullptr); }, "settings is NULL"},
      {[] { return quincunx_output_follower_create(nullptr, nullptr); }, "follower is NULL"},
      {[&] { return quincunx_output_follower_observe(nullptr, 1, 1, pair); }, "follower is NULL"},
      {[&] { return quincunx_output_follower_min_output(nullptr, pair); }, "follower is NULL"},
      {[] { return quincunx_detail_settings_init(nullptr); }, "settings is NULL"},
      {[] { return quincunx_detail_follower_create(nullptr, nullptr); }, "follower is NULL"},
      {[] { return quincunx_detail_follower_observe(nullptr, 1, nullptr); }, "follower is NULL"},
  };
  for (const Call& each : table) {
    EXPECT_EQ(each.call(), QUINCUNX_INVALID_ARGUMENT) << each.words;
    EXPECT_NE(std::string(quincunx_last_error()).find(each.words), std::string::npos)
        << each.words << ": " << quincunx_last_error();
  }
  EXPECT_EQ(quincunx_controller_name(nullptr), nullptr);
  EXPECT_EQ(quincunx_controller_text(nullptr), nullptr);
  EXPECT_EQ(quincunx_controller_target_ms(nullptr), 0);
  EXPECT_EQ(quincunx_controller_rung_count(nullptr), 0);
  EXPECT_EQ(quincunx_costs_text(nullptr), nullptr);
  EXPECT_EQ(quincunx_costs_confidence(nullptr, 1), 0);
  EXPECT_EQ(quincunx_front_text(nullptr), nullptr);
  EXPECT_EQ(quincunx_front_summary(nullptr), nullptr);
}

}  // namespace
}  // namespace quincunx
