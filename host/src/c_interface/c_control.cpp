// SPDX-License-Identifier: MIT
// The functions of c/control.h.
#include "quincunx/c/control.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "c_interface/c_frame.h"
#include "c_interface/calls.h"
#include "c_interface/sized_struct.h"
#include "quincunx/control/cost_table.h"
#include "quincunx/control/detail_follower.h"
#include "quincunx/control/front_file.h"
#include "quincunx/control/output_follower.h"
#include "quincunx/control/quality_controller.h"

struct quincunx_controller {
  std::unique_ptr<quincunx::ResolutionController> controller;
  quincunx::QualityController* quality = nullptr;  // the same, where it is one
  std::string text;
};

struct quincunx_costs {
  quincunx::CostTable table;
  std::string text;
};

struct quincunx_front {
  quincunx::ErrorFront front;
  std::string text;
  std::string summary;
};

struct quincunx_output_follower {
  quincunx::OutputFollower follower;
};

struct quincunx_detail_follower {
  quincunx::DetailFollower follower;
};

namespace quincunx::c {

template <>
inline constexpr std::size_t kFirstSize<quincunx_controller_settings> = 192;
template <>
inline constexpr std::size_t kFirstSize<quincunx_timing> = 88;
template <>
inline constexpr std::size_t kFirstSize<quincunx_choice> = 48;
template <>
inline constexpr std::size_t kFirstSize<quincunx_output_settings> = 48;
template <>
inline constexpr std::size_t kFirstSize<quincunx_detail_settings> = 40;
static_assert(sizeof(void*) != 8 ||
              (sizeof(quincunx_controller_settings) == 192 && sizeof(quincunx_timing) == 88 &&
               sizeof(quincunx_choice) == 48 && sizeof(quincunx_output_settings) == 48 &&
               sizeof(quincunx_detail_settings) == 40));
static_assert(QUINCUNX_SCENE_CLASSES == kSceneClasses);

namespace {

enum class Kind { kProportional, kMinimumOfN, kPredictive, kQuality };

// Settings of every kind as the library's own; ladder and target are those of `quality.pacing`.
struct ControllerSettings {
  Kind kind = Kind::kPredictive;
  ProportionalSettings proportional;
  MinimumOfNSettings minimum;
  QualitySettings quality;  // pacing: the predictive controller's
};

// Pairs of fields, as ToC and Reader take them.
constexpr auto kControllerPairs = [](auto& c, auto& own, auto& pair) {
  auto& pacing = own.quality.pacing;
  auto& ladder = pacing.ladder;
  pair("kind", c.kind, own.kind, Kind::kQuality);
  pair("order", c.order, ladder.order, AxisOrder::kBoth);
  pair("cpu_bound", c.cpu_bound, pacing.cpu_bound, CpuBound::kFollow);
  pair("output_width", c.output_width, ladder.output_extent.width);
  pair("output_height", c.output_height, ladder.output_extent.height);
  pair("step", c.step, ladder.step);
  pair("min_width", c.min_width, ladder.min_extent.width);
  pair("min_height", c.min_height, ladder.min_extent.height);
  pair("min_scale", c.min_scale, ladder.min_scale);
  pair("max_scale", c.max_scale, ladder.max_scale);
  pair("target_ms", c.target_ms, pacing.target_ms);
  pair("buffers", c.buffers, pacing.buffers);
  pair("fixed_part", c.fixed_part, pacing.fixed_part);
  pair("blur_aware", c.blur_aware, pacing.blur_aware.enabled);
  pair("blur_start_px", c.blur_start_px, pacing.blur_aware.start_px);
  pair("blur_full_px", c.blur_full_px, pacing.blur_aware.full_px);
  pair("blur_min_scale", c.blur_min_scale, pacing.blur_aware.min_scale);
  pair("rate", c.rate, own.proportional.rate);
  pair("spike_ratio", c.spike_ratio, own.proportional.spike_ratio);
  pair("factor", c.factor, own.minimum.factor);
  pair("margin", c.margin, own.minimum.margin);
  pair("count", c.count, own.minimum.count);
  pair("hysteresis", c.hysteresis, own.quality.hysteresis);
  pair("rest_seconds", c.rest_seconds, own.quality.rest_seconds);
  pair("fade_frames", c.fade_frames, own.quality.fade_frames);
};

constexpr auto kOutputPairs = [](auto& c, auto& own, auto& pair) {
  pair("display_width", c.display_width, own.display.width);
  pair("display_height", c.display_height, own.display.height);
  pair("steps", c.steps, own.steps);
  pair("rest_frames", c.rest_frames, own.rest_frames);
  pair("min_scale", c.min_scale, own.min_scale);
  pair("max_filled", c.max_filled, own.max_filled);
  pair("hysteresis", c.hysteresis, own.hysteresis);
};

constexpr auto kDetailPairs = [](auto& c, auto& own, auto& pair) {
  pair("levels", c.levels, own.levels);
  pair("rest_frames", c.rest_frames, own.rest_frames);
  pair("full_area", c.full_area, own.full_area);
  pair("min_area", c.min_area, own.min_area);
  pair("hysteresis", c.hysteresis, own.hysteresis);
};

template <typename Struct, typename Own, typename Pairs>
quincunx_status init(Struct* settings, const Own& defaults, const Pairs& pairs) noexcept {
  return guarded([&]() -> Status {
    if (Status status = check_size(settings, "settings"); !status.ok()) return status;
    write_sized(to_c<Struct>(defaults, pairs), settings);
    return {};
  });
}

Status read_methods(const quincunx_controller_settings& from, std::vector<MethodVariant>& to) {
  if (from.method_count < 0) {
    return Status::invalid(
        fmt::format("settings.method_count is {}; it must be at least 0", from.method_count));
  }
  if (from.method_count > 0 && from.methods == nullptr) {
    return Status::invalid(
        fmt::format("settings.methods is NULL; it must point to {} names", from.method_count));
  }
  for (int i = 0; i < from.method_count; ++i) {
    if (from.methods[i] == nullptr)
      return Status::invalid(fmt::format("settings.methods[{}] is NULL; it must be a name", i));
    auto variant = parse_variant(from.methods[i]);
    if (!variant.ok())
      return Status::invalid(fmt::format("settings.methods[{}]: {}", i, variant.status().message()));
    to.push_back(*variant);
  }
  return {};
}

Result<ControllerSettings> read_controller(const quincunx_controller_settings* given) {
  quincunx_controller_settings from;
  ControllerSettings to;
  if (Status status = read_settings(given, from, to, kControllerPairs); !status.ok()) return status;
  const PredictiveSettings& pacing = to.quality.pacing;
  to.proportional.ladder = to.minimum.ladder = pacing.ladder;
  to.proportional.target_ms = to.minimum.target_ms = pacing.target_ms;
  if (from.calibration != nullptr) to.quality.pacing.calibration = from.calibration->table;
  if (from.front != nullptr) to.quality.front = from.front->front;
  if (Status status = read_methods(from, to.quality.methods); !status.ok()) return status;
  return to;
}

template <typename Controller>
Made<quincunx_controller> controller_of(Result<std::unique_ptr<Controller>> made) {
  if (!made.ok()) return made.status();
  auto to = std::make_unique<quincunx_controller>();
  if constexpr (std::is_same_v<Controller, QualityController>) to->quality = made->get();
  to->controller = std::move(made).value();
  return to;
}

Made<quincunx_controller> make_controller(const ControllerSettings& settings) {
  switch (settings.kind) {
    case Kind::kProportional:
      return controller_of(make_proportional_controller(settings.proportional));
    case Kind::kMinimumOfN:
      return controller_of(make_minimum_of_n_controller(settings.minimum));
    case Kind::kPredictive:
      return controller_of(make_predictive_controller(settings.quality.pacing));
    case Kind::kQuality:
      break;
  }
  return controller_of(make_quality_controller(settings.quality));
}

Result<QualityFrame> read_timing(const quincunx_timing* given) {
  quincunx_timing from = {};
  if (Status status = read_sized(given, "timing", from); !status.ok()) return status;
  QualityFrame to = {.timing = {.frame = from.frame,
                                .next_frame = from.next_frame,
                                .render_extent = {from.render_width, from.render_height},
                                .gpu_ms = from.gpu_ms,
                                .cpu_ms = from.cpu_ms,
                                .interval_ms = from.interval_ms,
                                .queued = from.queued != 0 ? from.queued : FrameTiming::kUnknownQueue,
                                .missed_vsyncs = from.missed_vsyncs,
                                .blur_px = from.blur_px},
                     .resolve_ms = from.resolve_ms};
  if (from.queued < 0) {
    return Status::invalid(
        fmt::format("timing.queued is {}; it must be at least 1, or 0 for unknown", from.queued));
  }
  if (from.content != nullptr) {
    auto content = content_of(from.content);
    if (!content.ok()) return content.status();
    to.content = *content;
  }
  return to;
}

// A name that lives for ever.
const char* static_name(const MethodVariant& variant) {
  for (const VariantInfo& info : all_variants())
    if (info.variant == variant) return info.name.c_str();
  return name_of(variant.method);
}

quincunx_choice choice_of(const quincunx_controller& from) {
  quincunx_choice to = {};
  const Extent next = from.controller->next();
  to.render_width = next.width;
  to.render_height = next.height;
  to.rung = from.controller->rung();
  to.weight = 1;
  if (from.quality == nullptr) return to;
  const QualityChoice choice = from.quality->choice();
  to.method = static_name(choice.method);
  if (choice.fading_from) to.fading_from = static_name(*choice.fading_from);
  to.weight = choice.weight;
  return to;
}

void write_extent(Extent extent, int32_t to[2]) {
  to[0] = extent.width;
  to[1] = extent.height;
}

// Copies `number` to `*to` if it has a value, and returns whether it has.
bool write_known(const std::optional<double>& number, double* to) {
  if (number) *to = *number;
  return number.has_value();
}

Made<quincunx_costs> costs_of(Result<CostTable> made) {
  if (!made.ok()) return made.status();
  return std::make_unique<quincunx_costs>(quincunx_costs{std::move(made).value(), {}});
}

Made<quincunx_front> front_of(ErrorFront front, std::string summary) {
  std::string text = front.to_json();
  return std::make_unique<quincunx_front>(
      quincunx_front{std::move(front), std::move(text), std::move(summary)});
}

SceneMix mix_from(const double* share) {
  SceneMix mix;
  std::copy(share, share + kSceneClasses, mix.share.begin());
  return mix;
}

// Checks the arguments of a question to a front, and answers it.
template <typename Ask>
quincunx_status ask_front(const quincunx_front* front, const char* method, const char* name, double* to,
                          const Ask& ask) noexcept {
  return guarded({{"front", front}, {"method", method}, {name, to}}, [&]() -> Status {
    const auto variant = parse_variant(method);
    if (!variant.ok()) return variant.status();
    if (write_known(ask(*variant), to)) return {};
    return Status::invalid(
        fmt::format("'{}' at this scale has no {} in the front; the scale must be above 0, a mix 1 together, "
                    "an output in (0, {:.1f}] megapixels, and the method one of the front's",
                    method, name, quincunx::ErrorFront::kMaxMegapixels));
  });
}

// Makes a follower of settings.
template <typename Follower, typename Own, typename Struct, typename Pairs>
quincunx_status create_follower(const Struct* settings, Follower** follower, const Pairs& pairs) noexcept {
  return create("follower", follower, [&]() -> Made<Follower> {
    Struct from;
    Own own;
    if (Status status = read_settings(settings, from, own, pairs); !status.ok()) return status;
    auto made = decltype(Follower::follower)::create(own);
    if (!made.ok()) return made.status();
    return std::make_unique<Follower>(Follower{std::move(made).value()});
  });
}

}  // namespace
}  // namespace quincunx::c

namespace c = quincunx::c;
using c::null;
using quincunx::Status;

quincunx_status quincunx_controller_settings_init(quincunx_controller_settings* settings) {
  return c::init(settings, c::ControllerSettings(), c::kControllerPairs);
}

quincunx_status quincunx_controller_create(const quincunx_controller_settings* settings,
                                           quincunx_controller** controller) {
  return c::create("controller", controller, [&]() -> c::Made<quincunx_controller> {
    const auto read = c::read_controller(settings);
    return read.ok() ? c::make_controller(*read) : read.status();
  });
}

void quincunx_controller_destroy(quincunx_controller* controller) {
  delete controller;
}

const char* quincunx_controller_name(const quincunx_controller* controller) {
  return controller != nullptr ? controller->controller->name() : nullptr;
}

quincunx_status quincunx_controller_observe(quincunx_controller* controller, const quincunx_timing* timing) {
  return c::guarded({{"controller", controller}}, [&]() -> Status {
    const auto frame = c::read_timing(timing);
    if (!frame.ok()) return frame.status();
    if (controller->quality != nullptr) return controller->quality->observe(*frame);
    return controller->controller->observe(frame->timing);
  });
}

quincunx_status quincunx_controller_choice(const quincunx_controller* controller, quincunx_choice* choice) {
  return c::guarded({{"controller", controller}}, [&]() -> Status {
    if (Status status = c::check_size(choice, "choice"); !status.ok()) return status;
    c::write_sized(c::choice_of(*controller), choice);
    return {};
  });
}

const char* quincunx_controller_text(quincunx_controller* controller) {
  if (controller == nullptr) return nullptr;
  c::guarded([&]() -> Status {
    if (controller->quality != nullptr) controller->text = explain(controller->quality->reasons());
    return {};
  });
  return controller->text.c_str();
}

quincunx_status quincunx_controller_set_target_ms(quincunx_controller* controller, double target_ms) {
  return c::guarded({{"controller", controller}},
                    [&] { return controller->controller->set_target_ms(target_ms); });
}

double quincunx_controller_target_ms(const quincunx_controller* controller) {
  return controller != nullptr ? controller->controller->target_ms() : 0;
}

int32_t quincunx_controller_rung_count(const quincunx_controller* controller) {
  return controller != nullptr ? controller->controller->ladder().size() : 0;
}

quincunx_status quincunx_controller_rung(const quincunx_controller* controller, int32_t rung,
                                         int32_t extent[2]) {
  return c::guarded({{"controller", controller}, {"extent", extent}}, [&]() -> Status {
    const auto& ladder = controller->controller->ladder();
    if (rung < 0 || rung > ladder.top())
      return Status::invalid(fmt::format("rung is {}; it must lie in [0, {}]", rung, ladder.top()));
    c::write_extent(ladder[rung], extent);
    return {};
  });
}

quincunx_status quincunx_mix_of(const quincunx_content* content, double share[QUINCUNX_SCENE_CLASSES]) {
  return c::guarded({{"share", share}}, [&]() -> Status {
    const auto read = c::content_of(content);
    if (!read.ok()) return read.status();
    const quincunx::SceneMix mix = quincunx::mix_of(*read);
    std::copy(mix.share.begin(), mix.share.end(), share);
    return {};
  });
}

quincunx_status quincunx_costs_create(double half_life_frames, quincunx_costs** costs) {
  return c::create("costs", costs,
                   [&] { return c::costs_of(quincunx::CostTable::create(half_life_frames)); });
}

quincunx_status quincunx_costs_parse(const char* json, quincunx_costs** costs) {
  return c::create("costs", costs, [&]() -> c::Made<quincunx_costs> {
    if (json == nullptr) return null("json");
    return c::costs_of(quincunx::CostTable::from_json(json));
  });
}

void quincunx_costs_destroy(quincunx_costs* costs) {
  delete costs;
}

quincunx_status quincunx_costs_record(quincunx_costs* costs, uint64_t frame, double area_fraction,
                                      double gpu_ms) {
  return c::guarded({{"costs", costs}}, [&] { return costs->table.record(frame, area_fraction, gpu_ms); });
}

double quincunx_costs_confidence(const quincunx_costs* costs, double area_fraction) {
  return costs != nullptr ? costs->table.confidence(area_fraction) : 0;
}

quincunx_status quincunx_costs_predict(const quincunx_costs* costs, double area_fraction, double fixed_part,
                                       double* gpu_ms) {
  bool known = true;
  const quincunx_status status = c::guarded({{"costs", costs}, {"gpu_ms", gpu_ms}}, [&]() -> Status {
    if (!(area_fraction > 0 && area_fraction <= quincunx::CostTable::kMaxArea)) {
      return Status::invalid(fmt::format("area_fraction is {}; it must lie in (0, {}]", area_fraction,
                                         quincunx::CostTable::kMaxArea));
    }
    if (!(fixed_part >= 0 && fixed_part <= 0.9))
      return Status::invalid(fmt::format("fixed_part is {}; it must lie in [0, 0.9]", fixed_part));
    known = c::write_known(costs->table.predict(area_fraction, fixed_part), gpu_ms);
    return {};
  });
  return known ? status : QUINCUNX_NOT_READY;
}

quincunx_status quincunx_costs_fixed_part(const quincunx_costs* costs, double* fixed_part) {
  bool known = true;
  const quincunx_status status = c::guarded({{"costs", costs}, {"fixed_part", fixed_part}}, [&]() -> Status {
    known = c::write_known(costs->table.fixed_part(), fixed_part);
    return {};
  });
  return known ? status : QUINCUNX_NOT_READY;
}

const char* quincunx_costs_text(quincunx_costs* costs) {
  if (costs == nullptr) return nullptr;
  c::guarded([&]() -> Status {
    costs->text = costs->table.to_json();
    return {};
  });
  return costs->text.c_str();
}

quincunx_status quincunx_front_parse(const char* json, quincunx_front** front) {
  return c::create("front", front, [&]() -> c::Made<quincunx_front> {
    auto made = json != nullptr ? quincunx::ErrorFront::from_json(json) : quincunx::ErrorFront::built_in();
    if (!made.ok()) return made.status();
    std::string summary = made->summary();
    return c::front_of(std::move(made).value(), std::move(summary));
  });
}

quincunx_status quincunx_front_find(const quincunx_device* device, const char* scene,
                                    quincunx_front** front) {
  return c::create("front", front, [&]() -> c::Made<quincunx_front> {
    if (device == nullptr) return null("device");
    auto found =
        quincunx::find_front(quincunx::front_key(device->device.info(), scene != nullptr ? scene : ""));
    return c::front_of(std::move(found.front), std::move(found.explanation));
  });
}

void quincunx_front_destroy(quincunx_front* front) {
  delete front;
}

const char* quincunx_front_text(const quincunx_front* front) {
  return front != nullptr ? front->text.c_str() : nullptr;
}

const char* quincunx_front_summary(const quincunx_front* front) {
  return front != nullptr ? front->summary.c_str() : nullptr;
}

quincunx_status quincunx_front_flip(const quincunx_front* front, const double share[QUINCUNX_SCENE_CLASSES],
                                    const char* method, double scale, double* flip) {
  if (share == nullptr) return c::guarded([] { return null("share"); });
  return c::ask_front(front, method, "flip", flip, [&](const quincunx::MethodVariant& variant) {
    return front->front.flip(c::mix_from(share), variant, scale);
  });
}

quincunx_status quincunx_front_resolve_ms(const quincunx_front* front, const char* method, double scale,
                                          double output_megapixels, double* ms) {
  return c::ask_front(front, method, "ms", ms, [&](const quincunx::MethodVariant& variant) {
    return front->front.resolve_ms(variant, scale, output_megapixels);
  });
}

quincunx_status quincunx_output_settings_init(quincunx_output_settings* settings) {
  return c::init(settings, quincunx::OutputSettings(), c::kOutputPairs);
}

quincunx_status quincunx_output_follower_create(const quincunx_output_settings* settings,
                                                quincunx_output_follower** follower) {
  return c::create_follower<quincunx_output_follower, quincunx::OutputSettings>(settings, follower,
                                                                                c::kOutputPairs);
}

void quincunx_output_follower_destroy(quincunx_output_follower* follower) {
  delete follower;
}

quincunx_status quincunx_output_follower_observe(quincunx_output_follower* follower, int32_t render_width,
                                                 int32_t render_height, int32_t output[2]) {
  return c::guarded({{"follower", follower}, {"output", output}}, [&]() -> Status {
    c::write_extent(follower->follower.observe({render_width, render_height}), output);
    return {};
  });
}

quincunx_status quincunx_output_follower_min_output(const quincunx_output_follower* follower,
                                                    int32_t output[2]) {
  return c::guarded({{"follower", follower}, {"output", output}}, [&]() -> Status {
    c::write_extent(follower->follower.min_output(), output);
    return {};
  });
}

quincunx_status quincunx_detail_settings_init(quincunx_detail_settings* settings) {
  return c::init(settings, quincunx::DetailSettings(), c::kDetailPairs);
}

quincunx_status quincunx_detail_follower_create(const quincunx_detail_settings* settings,
                                                quincunx_detail_follower** follower) {
  return c::create_follower<quincunx_detail_follower, quincunx::DetailSettings>(settings, follower,
                                                                                c::kDetailPairs);
}

void quincunx_detail_follower_destroy(quincunx_detail_follower* follower) {
  delete follower;
}

quincunx_status quincunx_detail_follower_observe(quincunx_detail_follower* follower, double area_fraction,
                                                 int32_t* level) {
  return c::guarded({{"follower", follower}, {"level", level}}, [&]() -> Status {
    *level = follower->follower.observe(area_fraction);
    return {};
  });
}
