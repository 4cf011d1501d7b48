// SPDX-License-Identifier: MIT
// Random calls of c/control.h, the same ones each time.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "c_caller.h"
#include "quincunx/c/control.h"

namespace quincunx::testing {
namespace {

class ControlCaller : public Caller {
 public:
  explicit ControlCaller(std::uint64_t seed) : Caller(seed) {}

  void run();

 private:
  quincunx_content content();

  void make_controller();
  void use_controller();
  void observe();
  void use_costs();
  void use_front();
  void use_followers();

  Pool<quincunx_controller, quincunx_controller_destroy> controllers_{random_};
  Pool<quincunx_costs, quincunx_costs_destroy> costs_{random_};
  Pool<quincunx_front, quincunx_front_destroy> fronts_{random_};
  Pool<quincunx_output_follower, quincunx_output_follower_destroy> outputs_{random_};
  Pool<quincunx_detail_follower, quincunx_detail_follower_destroy> details_{random_};
};

quincunx_content ControlCaller::content() {
  quincunx_content of = {};
  for (double* share : {&of.moving, &of.apart, &of.thin, &of.light, &of.zoom})
    *share = one_in(12) ? wild(random_, 1) : static_cast<double>(random_.unit());
  of.speed_px = wild(random_, 5);
  of.cut = wild_int(random_, 1, 0);
  return of;
}

void ControlCaller::make_controller() {
  Sized<quincunx_controller_settings> from;
  writes(from.value, [&](auto*) { return quincunx_controller_settings_init(&from.value); });
  from.value.kind = one_in(20) ? wild_int(random_, 4) : random_.below(4);
  from.value.output_width = wild_int(random_, 4000);
  from.value.output_height = wild_int(random_, 2000);
  if (one_in(2))
    spoil(from.value, offsetof(quincunx_controller_settings, order),
          offsetof(quincunx_controller_settings, calibration));
  if (one_in(4)) from.value.target_ms = wild(random_, 16);
  if (one_in(4)) from.value.hysteresis = wild(random_, 0.03);
  if (one_in(2)) from.value.front = fronts_.any();
  if (one_in(2)) from.value.calibration = costs_.any();
  const std::array<std::string, 2> names = {word("temporal"), word("bilinear")};
  const char* const methods[] = {names[0].c_str(), or_null(names[1].c_str())};
  if (one_in(2)) {
    from.value.methods = or_null(methods);
    from.value.method_count = one_in(8) ? wild_int(random_, 1, -1) % 2 : random_.below(3);
  }
  makes(controllers_, [&](auto** to) { return quincunx_controller_create(sized(from), to); });
}

void ControlCaller::use_controller() {
  quincunx_controller* of = controllers_.any();
  Sized<quincunx_choice> choice;
  writes_sized(choice, [&](auto* given) { return quincunx_controller_choice(of, given); });
  EXPECT_EQ(quincunx_controller_name(of) != nullptr, of != nullptr);
  EXPECT_EQ(quincunx_controller_text(of) != nullptr, of != nullptr);
  worked(quincunx_controller_set_target_ms(of, wild(random_, 16)));
  EXPECT_EQ(quincunx_controller_target_ms(of) > 0, of != nullptr);
  EXPECT_EQ(quincunx_controller_rung_count(of) > 0, of != nullptr);
  std::array<int, 2> extent = {-7, -7};
  writes(extent, [&](auto* to) {
    return quincunx_controller_rung(of, wild_int(random_, 300), to != nullptr ? to->data() : nullptr);
  });
}

void ControlCaller::observe() {
  Sized<quincunx_content> shows(content());
  Sized<quincunx_timing> timing;
  timing.value.frame =
      one_in(8) ? random_.next() >> random_.below(64) : static_cast<std::uint64_t>(counts_[name_][0]);
  timing.value.render_width = wild_int(random_, 4000);
  timing.value.render_height = wild_int(random_, 2000);
  for (double* ms : {&timing.value.gpu_ms, &timing.value.cpu_ms, &timing.value.interval_ms,
                     &timing.value.blur_px, &timing.value.resolve_ms})
    *ms = one_in(6) ? wild(random_, 16) : 20 * static_cast<double>(random_.unit());
  timing.value.queued = wild_int(random_, 3, 0);
  if (one_in(2)) timing.value.content = sized(shows);
  worked(quincunx_controller_observe(controllers_.any(), sized(timing)));
  std::array<double, QUINCUNX_SCENE_CLASSES> mix = {-1};
  writes(mix, [&](auto* to) { return quincunx_mix_of(sized(shows), to != nullptr ? to->data() : nullptr); });
}

void ControlCaller::use_costs() {
  makes(costs_, [&](auto** to) { return quincunx_costs_create(wild(random_, 500), to); });
  quincunx_costs* of = costs_.any();
  worked(
      quincunx_costs_record(of, random_.next() >> random_.below(64), wild(random_, 0.5), wild(random_, 16)));
  const double confidence = quincunx_costs_confidence(of, wild(random_, 0.5));
  EXPECT_TRUE(confidence >= 0 && confidence <= 1) << confidence;
  double answer = -7;
  if (writes(answer, [&](auto* to) {
        return quincunx_costs_predict(of, wild(random_, 0.5), wild(random_, 0.3), to);
      })) {
    EXPECT_TRUE(std::isfinite(answer) && answer >= 0) << answer;
  }
  writes(answer, [&](auto* to) { return quincunx_costs_fixed_part(of, to); });
  const char* text = quincunx_costs_text(of);
  ASSERT_EQ(text != nullptr, of != nullptr);
  const std::string json = text != nullptr ? word(text) : "";
  makes(costs_, [&](auto** to) { return quincunx_costs_parse(or_null(json.c_str()), to); });
}

void ControlCaller::use_front() {
  quincunx_front* of = fronts_.any();
  const char* text = quincunx_front_text(of);
  ASSERT_EQ(text != nullptr, of != nullptr);
  EXPECT_EQ(quincunx_front_summary(of) != nullptr, of != nullptr);
  const std::string json = text != nullptr ? word(text) : "";
  std::array<double, QUINCUNX_SCENE_CLASSES> mix = {1};
  if (one_in(4)) mix[1] = wild(random_, 1);
  const std::string name = method();
  double answer = -7;
  if (writes(answer, [&](auto* to) {
        return quincunx_front_flip(of, or_null(mix.data()), or_null(name.c_str()), wild(random_, 0.7), to);
      })) {
    EXPECT_TRUE(answer >= 0 && answer <= 1) << answer;
  }
  if (writes(answer, [&](auto* to) {
        return quincunx_front_resolve_ms(of, name.c_str(), wild(random_, 0.7), wild(random_, 2), to);
      })) {
    EXPECT_TRUE(std::isfinite(answer) && answer >= 0) << answer;
  }
  makes(fronts_,
        [&](auto** to) { return quincunx_front_parse(text != nullptr ? json.c_str() : nullptr, to); });
}

void ControlCaller::use_followers() {
  Sized<quincunx_output_settings> output;
  writes_sized(output, [&](auto* given) { return quincunx_output_settings_init(given); });
  output.value.display_width = wild_int(random_, 4000);
  output.value.display_height = wild_int(random_, 2000);
  if (one_in(2)) spoil(output.value, offsetof(quincunx_output_settings, steps));
  makes(outputs_, [&](auto** to) { return quincunx_output_follower_create(sized(output), to); });
  quincunx_output_follower* of = outputs_.any();
  std::array<int, 2> extent = {-7, -7};
  const auto first = [](std::array<int, 2>* to) { return to != nullptr ? to->data() : nullptr; };
  if (writes(extent, [&](auto* to) {
        return quincunx_output_follower_observe(of, wild_int(random_, 4000), wild_int(random_, 2000),
                                                first(to));
      })) {
    EXPECT_TRUE(extent[0] >= 1 && extent[1] >= 1) << extent[0] << "x" << extent[1];
  }
  writes(extent, [&](auto* to) { return quincunx_output_follower_min_output(of, first(to)); });

  Sized<quincunx_detail_settings> detail;
  writes_sized(detail, [&](auto* given) { return quincunx_detail_settings_init(given); });
  if (one_in(2)) spoil(detail.value, offsetof(quincunx_detail_settings, levels));
  makes(details_, [&](auto** to) { return quincunx_detail_follower_create(sized(detail), to); });
  int level = -7;
  if (writes(level, [&](auto* to) {
        return quincunx_detail_follower_observe(details_.any(), wild(random_, 0.5), to);
      })) {
    EXPECT_TRUE(level >= 0 && level < 64) << level;
  }
}

void ControlCaller::run() {
  Caller::run({{"controller", 4, [this] { make_controller(); }},
               {"use_controller", 5, [this] { use_controller(); }},
               {"observe", 8, [this] { observe(); }},
               {"costs", 3, [this] { use_costs(); }},
               {"front", 2, [this] { use_front(); }},
               {"followers", 3, [this] { use_followers(); }}});
}

TEST(CFuzz, Control) {
  ControlCaller(32).run();
}

}  // namespace
}  // namespace quincunx::testing
