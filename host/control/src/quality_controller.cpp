// SPDX-License-Identifier: MIT
#include "quincunx/control/quality_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "method_choice.h"
#include "predictive_model.h"
#include "ranges.h"

namespace quincunx {
namespace {

Status check_methods(const QualitySettings& settings) {
  const auto known = settings.front.methods();
  for (const MethodVariant& method : settings.methods) {
    if (std::find(known.begin(), known.end(), method) == known.end()) {
      return Status::invalid(
          fmt::format("methods has {}, of which the front has no points", name_of(method)));
    }
  }
  return {};
}

// Errors: kInvalidArgument for a field outside its range, but for the ladder and the target.
Status check_settings(const QualitySettings& settings) {
  if (Status status = check(settings.pacing); !status.ok()) return status;
  if (Status status = check_methods(settings); !status.ok()) return status;
  Ranges ranges;
  ranges.lies_in("hysteresis", settings.hysteresis, 0, 1, Ends::kOpenHigh);
  ranges.lies_in("rest_seconds", settings.rest_seconds, 0, 60);
  ranges.lies_in("fade_frames", settings.fade_frames, 0, 60);
  return ranges.status();
}

constexpr double kNamedShare = 0.005;  // part of the picture: less is not told

std::string text_of(const SceneMix& mix) {
  std::string text;
  for (std::size_t i = 0; i < kSceneClasses; ++i) {
    if (mix.share[i] < kNamedShare) continue;
    text += fmt::format("{}{} {:.0f} %", text.empty() ? "" : ", ", name_of(static_cast<SceneClass>(i)),
                        100 * mix.share[i]);
  }
  return text;
}

std::string text_of(const QualityPair& pair) {
  return fmt::format("{} at scale {:.2f}: expected FLIP {:.4f}, {:.2f} ms", name_of(pair.method), pair.scale,
                     pair.flip, pair.ms);
}

constexpr double kMostApart =
    0.5;  // part of a frame's time that passes are believed to take where that is not known
constexpr double kFastPx =
    24;  // mean speed, output pixels a frame, from which a change of method is not seen
constexpr int kUntimedFrames = 4;    // after a change, whose times tell what an untimed method takes
constexpr double kUntimedRange = 4;  // by which that may differ from what was expected

class Quality final : public QualityController {
 public:
  static Result<std::unique_ptr<QualityController>> create(const QualitySettings& settings) {
    if (Status status = check_target(settings.pacing.target_ms); !status.ok()) return status;
    if (Status status = check_settings(settings); !status.ok()) return status;
    Result<ResolutionLadder> ladder = ResolutionLadder::create(settings.pacing.ladder);
    if (!ladder.ok()) return ladder.status();
    return std::unique_ptr<QualityController>(new Quality(std::move(ladder).value(), settings));
  }

  const char* name() const override { return "quality"; }
  using QualityController::observe;
  Status observe(const QualityFrame& frame) override;
  QualityChoice choice() const override;
  QualityReasons reasons() const override { return pairs_.reasons(model_, rung(), choice_.method()); }

 private:
  static constexpr std::uint64_t kRemembered = 16;
  // The methods of a frame.
  struct Methods {
    std::size_t method = 0;
    std::optional<std::size_t> from;
    friend bool operator==(const Methods&, const Methods&) = default;
  };

  Quality(ResolutionLadder steps, const QualitySettings& settings)
      : QualityController(std::move(steps), settings.pacing.target_ms),
        settings_(settings),
        model_(ladder(), settings_.pacing),
        pairs_(settings_, ladder()),
        choice_({.hysteresis = settings.hysteresis,
                 .rest_ms = settings.rest_seconds * 1000,
                 .fade_frames = settings.fade_frames},
                pairs_.least_error_at_top()) {
    drawn_.fill(now());
    last_seen_ = now();
  }

  Methods now() const { return {choice_.method(), choice_.fading_from()}; }
  double passes_ms(const Methods& methods, double scale) const {
    return pairs_.passes_ms(methods.method, scale) +
           (methods.from ? pairs_.passes_ms(*methods.from, scale) : 0);
  }
  double scale_of(Extent render) const { return std::sqrt(ladder().area_fraction(render)); }

  int choose(const FrameTiming& timing) override;
  double apart_ms(const FrameTiming& timing, const Methods& drawn);
  void learn_untimed(const FrameTiming& timing, std::size_t method);
  void choose_method();

  const QualitySettings settings_;
  PredictiveModel model_;
  MethodPairs pairs_;
  MethodChoice choice_;
  std::array<Methods, kRemembered> drawn_;  // each frame's, by its number
  std::uint64_t next_ = 0;                  // frames below it are in drawn_
  Methods last_seen_;                       // the last observed frame's
  int untimed_ = 0;                         // frames whose times still tell what the method takes
  double resolve_ms_ = 0;                   // time of the passes in the frame that is being observed
  ContentStatistics content_;               // the last that was told
  bool has_content_ = false;                // the frame that is being observed
};

Status Quality::observe(const QualityFrame& frame) {
  if (!(frame.resolve_ms == 0 || (frame.resolve_ms > 0 && frame.resolve_ms < frame.timing.gpu_ms))) {
    return Status::invalid(fmt::format("resolve_ms is {}; it must lie in [0, gpu_ms), and gpu_ms is {}",
                                       frame.resolve_ms, frame.timing.gpu_ms));
  }
  if (frame.content) {
    if (Status status = quincunx::check(*frame.content); !status.ok()) return status;
  }
  const ContentStatistics before = content_;
  resolve_ms_ = frame.resolve_ms;
  has_content_ = frame.content.has_value();
  content_ = frame.content.value_or(content_);
  content_.cut = has_content_ && content_.cut;
  const Status status = ResolutionController::observe(frame.timing);
  if (!status.ok()) content_ = before;
  resolve_ms_ = 0;
  has_content_ = false;
  return status;
}

QualityChoice Quality::choice() const {
  QualityChoice choice = {.render_extent = next(), .method = pairs_[choice_.method()]};
  if (const auto from = choice_.fading_from()) choice.fading_from = pairs_[*from];
  choice.weight = choice_.weight();
  return choice;
}

// Where passes are not timed, the whole tells: after a change, what drawing does not explain is the method's.
void Quality::learn_untimed(const FrameTiming& timing, std::size_t method) {
  const double scale = scale_of(timing.render_extent);
  const double expected = pairs_.passes_ms(method, scale);
  const double rest = timing.gpu_ms - model_.draw_ms(scale * scale);
  pairs_.learn(method, scale, std::clamp(rest, expected / kUntimedRange, expected * kUntimedRange));
}

// Returns the part of a frame that was not drawing.
double Quality::apart_ms(const FrameTiming& timing, const Methods& drawn) {
  const double scale = scale_of(timing.render_extent);
  const bool changed = !(drawn == last_seen_);
  last_seen_ = drawn;
  if (resolve_ms_ > 0) {
    if (!drawn.from) pairs_.learn(drawn.method, scale, resolve_ms_);
    untimed_ = 0;
    return resolve_ms_;
  }
  if (changed) {
    model_.part_from_frames_before();
    untimed_ = drawn.from || content_.cut ? 0 : kUntimedFrames;
  }
  if (untimed_ > 0) {
    --untimed_;
    learn_untimed(timing, drawn.method);
  }
  // Times of another machine may be longer than the whole frame.
  const double most = kMostApart * timing.gpu_ms;
  if (!drawn.from && passes_ms(drawn, scale) > most) pairs_.learn(drawn.method, scale, most);
  return std::min(passes_ms(drawn, scale), most);
}

void Quality::choose_method() {
  const auto all = pairs_.evaluate(model_, rung());
  const auto& best = *std::min_element(all.begin(), all.end(), better);
  const auto& present = all[choice_.method()];
  choice_.advance({.next_frame = model_.next_frame(),
                   .frame_ms = target_ms(),
                   .best = best.method,
                   .gain = present.flip > 0 ? 1 - best.flip / present.flip : 0,
                   .must = !present.fits,
                   .held = model_.has_outlier() || model_.held_by_cpu(),
                   .masked = content_.moving * content_.speed_px >= kFastPx,
                   .both_fit = pairs_.both_fit(model_, best.method, present.method),
                   .cut = content_.cut});
}

int Quality::choose(const FrameTiming& timing) {
  if (has_content_) pairs_.follow(content_);
  model_.observe(timing, apart_ms(timing, drawn_[timing.frame % kRemembered]), target_ms());
  const Methods before = now();
  const std::uint64_t next_frame = model_.next_frame();
  const std::uint64_t remembered = next_frame > kRemembered ? next_frame - kRemembered : 0;
  for (std::uint64_t frame = std::max(next_, remembered); frame < next_frame; ++frame)
    drawn_[frame % kRemembered] = before;
  choose_method();
  drawn_[next_frame % kRemembered] = now();
  next_ = next_frame + 1;

  using Bands = PredictiveModel::Bands;
  const double apart = passes_ms(now(), scale_of(next()));
  const int result = model_.wanted_rung(rung(), apart, now() == before ? Bands::kKeep : Bands::kNone);
  model_.choose(rung(), result, apart);
  return result;
}

}  // namespace

std::string explain(const QualityReasons& reasons) {
  std::string text = fmt::format("Picture        {}\n", text_of(reasons.mix));
  text += fmt::format("Chosen         {} of {:.2f}\n", text_of(reasons.chosen), reasons.budget_ms);
  if (!reasons.others.empty()) text += fmt::format("Next method    {}\n", text_of(reasons.others.front()));
  if (!reasons.next_better) return text + "Next better    none: no pair errs less\n";
  const double more = reasons.next_better->ms - reasons.budget_ms;
  return text + fmt::format("Next better    {}, {:.2f} {} than there is\n", text_of(*reasons.next_better),
                            more > 0 ? more : -more, more > 0 ? "more" : "less");
}

Result<std::unique_ptr<QualityController>> make_quality_controller(const QualitySettings& settings) {
  return Quality::create(settings);
}

}  // namespace quincunx
