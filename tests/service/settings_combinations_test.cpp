// SPDX-License-Identifier: MIT
// Settings in combination: whatever plan_for() accepts makes a picture of a good frame, and answers a bad one with a
// sentence that names the field. Refusals need no device and are tried for every combination of all that decides which
// images a frame has; frames run for a set of combinations in which every two choices meet.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "quincunx/resolve_service.h"

namespace quincunx {
namespace {

// What takes a pass wherever it can.
constexpr InputConventions kGiven = {
    .depth = DepthConvention::kForward, .velocity_jittered = true, .origin = Origin::kBottom};
constexpr Extent kOutput{16, 12}, kParticleTarget{8, 6}, kRegion{8, 6};

struct Combination {
  SceneNeeds needs;
  ResolveSettings settings = {.output_extent = kOutput, .target_extent = kOutput};
};

struct Choice {
  const char* name;
  std::function<void(Combination&)> make;
};
using Axis = std::vector<Choice>;

Choice method(const char* name, Method method, QuincunxSettings quincunx = {},
              TemporalPreset preset = TemporalPreset::kBalanced) {
  return {name, [=](Combination& made) {
            made.settings.method = method;
            made.settings.quincunx = quincunx;
            made.settings.temporal.preset = preset;
          }};
}
Choice needs(const char* name, bool objects, bool camera, bool transparents) {
  return {name, [=](Combination& made) {
            made.needs.moving_objects = objects;
            made.needs.camera_motion = camera;
            made.needs.transparents = transparents;
          }};
}
template <typename T>
Choice setting(const char* name, T ResolveSettings::*field, T value) {
  return {name, [=](Combination& made) { made.settings.*field = value; }};
}
template <typename Group, typename T>
Choice setting(const char* name, Group ResolveSettings::*group, T Group::*field, T value) {
  return {name, [=](Combination& made) { made.settings.*group.*field = value; }};
}
Choice view(const char* name, TemporalView view) {
  return {name, [=](Combination& made) { made.settings.temporal.view = view; }};
}
Choice targets(const char* name, Storage storage, Targets targets) {
  return {name, [=](Combination& made) {
            made.settings.targets.storage = storage;
            made.settings.targets.placement = targets;
          }};
}

// The settings that decide which images a frame has.
const std::vector<Axis>& axes_of_inputs() {
  static const std::vector<Axis> axes = {
      {method("bilinear", Method::kBilinear), method("lanczos3", Method::kLanczos3),
       method("noise_offset", Method::kNoiseOffset),
       method("mean", Method::kQuincunx, {.form = TwoFrameForm::kMean, .sampling = Sampling::kPoint}),
       method("velocity", Method::kQuincunx),
       method("reprojected", Method::kQuincunx, {.form = TwoFrameForm::kReprojected, .residual_weight = 1}),
       method("fast", Method::kTemporal, {}, TemporalPreset::kFast), method("balanced", Method::kTemporal),
       method("quality", Method::kTemporal, {}, TemporalPreset::kQuality)},
      {needs("anything", true, true, true), needs("opaque", true, true, false),
       needs("camera", false, true, true), needs("still camera", true, false, false),
       needs("still", false, false, true)},
      {setting("full", &ResolveSettings::targets, &TargetSettings::shading, Shading::kFull),
       setting("checkerboard", &ResolveSettings::targets, &TargetSettings::shading, Shading::kCheckerboard)},
      {setting("together", &ResolveSettings::targets, &TargetSettings::particle_extent, Extent{}),
       setting("particles", &ResolveSettings::targets, &TargetSettings::particle_extent, kParticleTarget)},
      // Before what are single fields of theirs.
      {setting("native", &ResolveSettings::conventions, InputConventions{}),
       setting("given", &ResolveSettings::conventions, kGiven)},
      {setting("own", &ResolveSettings::conventions, &InputConventions::drawn_velocity, DrawnVelocity::kOwn),
       setting("dilated", &ResolveSettings::conventions, &InputConventions::drawn_velocity,
               DrawnVelocity::kDilated)},
      {setting("far as drawn", &ResolveSettings::conventions, &InputConventions::sky_motion,
               SkyMotion::kAsDrawn),
       setting("far camera", &ResolveSettings::conventions, &InputConventions::sky_motion,
               SkyMotion::kCamera),
       setting("far evidence", &ResolveSettings::conventions, &InputConventions::sky_motion,
               SkyMotion::kEvidence)},
      {setting("sharp", &ResolveSettings::blur, MotionBlurSettings{}),
       setting("blurred", &ResolveSettings::blur, MotionBlurSettings{.shutter = .5f})},
      {setting("uncounted", &ResolveSettings::control, &ControlSettings::measures_content, false),
       setting("content", &ResolveSettings::control, &ControlSettings::measures_content, true)},
      {setting("fixed", &ResolveSettings::output, &PictureSettings::min_extent, Extent{}),
       setting("dual", &ResolveSettings::output, &PictureSettings::min_extent, Extent{8, 6})}};
  return axes;
}

// All axes. Kernels take long to compile: choices that bring no pass of their own are left to the refusals above.
std::vector<Axis> axes_of_frames() {
  std::vector<Axis> axes = axes_of_inputs();
  for (const std::string left_out : {"bilinear", "mean", "still camera"}) {
    for (Axis& axis : axes)
      std::erase_if(axis, [&left_out](const Choice& choice) { return choice.name == left_out; });
  }
  const auto focus = [](const char* name, FocusSettings settings) {
    return setting(name, &ResolveSettings::focus, settings);
  };
  axes.insert(axes.end(),
              {{targets("buffers", Storage::kBuffer, Targets::kViewport),
                targets("images", Storage::kImage, Targets::kViewport),
                targets("placed buffers", Storage::kBuffer, Targets::kPlaced),
                targets("placed images", Storage::kImage, Targets::kPlaced)},
               {{"covered", [](Combination& made) { made.needs.background = true; }},
                {"alpha", [](Combination& made) { made.needs.background = false; }},
                {"cleared",
                 [](Combination& made) { made.settings.targets.clear = !(made.needs.background = false); }}},
               {setting("unchecked", &ResolveSettings::checks_motion, false),
                setting("checked", &ResolveSettings::checks_motion, true)},
               {view("picture", TemporalView::kPicture), view("rejection", TemporalView::kRejection),
                view("near", TemporalView::kNear)},
               {focus("no focus", {}), focus("focus", {.extent = kRegion}),
                focus("masked focus", {.extent = kRegion, .mask = true})},
               {setting("as resolved", &ResolveSettings::sharpness, 0.f),
                {"sharpened",
                 [](Combination& made) { made.settings.sharpness = made.settings.temporal.noise = .5f; }}},
               {setting("unfaded", &ResolveSettings::control, &ControlSettings::fades, false),
                setting("fades", &ResolveSettings::control, &ControlSettings::fades, true)},
               {setting("presented", &ResolveSettings::output, &PictureSettings::present, true),
                setting("linear", &ResolveSettings::output, &PictureSettings::present, false)}});
  return axes;
}

// The choice on each axis.
using Row = std::vector<std::size_t>;

Combination combine(const std::vector<Axis>& axes, const Row& row) {
  Combination made;
  for (std::size_t axis = 0; axis < row.size(); ++axis)
    axes[axis][row[axis]].make(made);
  return made;
}

std::string names_of(const std::vector<Axis>& axes, const Row& row) {
  std::string names;
  for (std::size_t axis = 0; axis < row.size(); ++axis)
    names += fmt::format("{}{}", axis == 0 ? "" : ", ", axes[axis][row[axis]].name);
  return names;
}

// Choices on two axes.
struct Pair {
  std::size_t first_axis, first, second_axis, second;
  friend auto operator<=>(const Pair&, const Pair&) = default;
};

// Rows in which all pairs meet that any plan may have, each a plan that plan_for() accepts; the other pairs are left in
// `apart`. Always the same ones.
struct Covering {
  std::vector<Row> rows;
  std::set<Pair> apart;
};

class Cover {
 public:
  explicit Cover(std::vector<Axis> axes) : axes_(std::move(axes)) {
    for (std::size_t a = 0; a < axes_.size(); ++a) {
      for (std::size_t b = a + 1; b < axes_.size(); ++b) {
        for (std::size_t i = 0; i < axes_[a].size(); ++i) {
          for (std::size_t j = 0; j < axes_[b].size(); ++j)
            open_.insert({a, i, b, j});
        }
      }
    }
  }

  Covering rows() {
    Covering made;
    while (!open_.empty()) {
      const Pair seed = *open_.begin();
      const std::optional<Row> row = row_with(seed);
      if (!row) {
        open_.erase(seed);
        made.apart.insert(seed);
        continue;
      }
      for (std::size_t a = 0; a < row->size(); ++a) {
        for (std::size_t b = a + 1; b < row->size(); ++b)
          open_.erase({a, (*row)[a], b, (*row)[b]});
      }
      made.rows.push_back(*row);
    }
    return made;
  }

 private:
  static constexpr int kGreedyTries = 40, kTries = 100;
  static constexpr std::size_t kFree = ~std::size_t{0};

  // Returns the accepted one of a few tries that holds most pairs which no row holds yet.
  std::optional<Row> row_with(const Pair& seed) {
    std::optional<Row> best;
    std::size_t most = 0;
    for (int i = 0; i < kTries; ++i) {
      const Row row = fill(seed, i < kGreedyTries);
      std::size_t count = 0;
      for (std::size_t axis = 0; axis < row.size(); ++axis)
        count += news(row, axis, row[axis]);
      if (count <= most) continue;
      const Combination made = combine(axes_, row);
      if (!plan_for(made.needs, made.settings).ok()) continue;
      most = count;
      best = row;
    }
    return best;
  }

  // The axes in any order, each with any choice or, if `greedy`, with the one that makes most new pairs with those
  // before it. Greed alone would always choose what no plan accepts, whose pairs stay new.
  Row fill(const Pair& seed, bool greedy) {
    Row row(axes_.size(), kFree);
    row[seed.first_axis] = seed.first;
    row[seed.second_axis] = seed.second;
    std::vector<std::size_t> order;
    for (std::size_t axis = 0; axis < row.size(); ++axis)
      order.insert(order.begin() + static_cast<std::ptrdiff_t>(random_() % (order.size() + 1)), axis);
    for (const std::size_t axis : order) {
      if (row[axis] != kFree) continue;
      const std::size_t start = random_() % axes_[axis].size();
      std::size_t best = start, most = 0;
      for (std::size_t k = 0; greedy && k < axes_[axis].size(); ++k) {
        const std::size_t choice = (start + k) % axes_[axis].size();
        const std::size_t count = news(row, axis, choice);
        if (count <= most) continue;
        most = count;
        best = choice;
      }
      row[axis] = best;
    }
    return row;
  }

  std::size_t news(const Row& row, std::size_t axis, std::size_t choice) const {
    std::size_t count = 0;
    for (std::size_t other = 0; other < row.size(); ++other) {
      if (other == axis || row[other] == kFree) continue;
      const Pair pair =
          other < axis ? Pair{other, row[other], axis, choice} : Pair{axis, choice, other, row[other]};
      count += open_.count(pair);
    }
    return count;
  }

  std::vector<Axis> axes_;
  std::set<Pair> open_;
  std::mt19937 random_{2012};
};

// An image of a frame, and whether a plan needs it, by what its fields say.
struct InputCase {
  const char* field;
  ImageView FrameInputs::*image;
  Extent FrameInputs::*viewport;
  PixelFormat (*format)(const ResolvePlan& plan);
  bool (*needed)(const ResolvePlan& plan);
  const char* remedy = "";  // how to plan without
};

bool has_particles(const ResolvePlan& plan) {
  return plan.settings.targets.particle_extent != Extent{};
}

constexpr const char* kNoTransparents = ", or plan with transparents = false";

const InputCase kInputs[] = {
    {"colour", &FrameInputs::colour, &FrameInputs::render_extent,
     [](const ResolvePlan& plan) { return plan.settings.colour; }, [](const ResolvePlan&) { return true; }},
    {"velocity", &FrameInputs::velocity, &FrameInputs::render_extent,
     [](const ResolvePlan& plan) { return plan.settings.velocity; },
     [](const ResolvePlan& plan) { return plan.velocity == VelocitySource::kTarget; },
     ", or plan with moving_objects = false"},
    {"depth", &FrameInputs::depth, &FrameInputs::render_extent,
     [](const ResolvePlan&) { return PixelFormat::kR32F; },
     [](const ResolvePlan& plan) { return plan.reads_depth; }},
    {"reactive", &FrameInputs::reactive, &FrameInputs::render_extent,
     [](const ResolvePlan&) { return PixelFormat::kR8; },
     [](const ResolvePlan& plan) { return plan.reads_reactive; }, kNoTransparents},
    {"particle_colour", &FrameInputs::particle_colour, &FrameInputs::particle_render_extent,
     [](const ResolvePlan& plan) { return plan.settings.colour; }, has_particles},
    {"particle_depth", &FrameInputs::particle_depth, &FrameInputs::particle_render_extent,
     [](const ResolvePlan&) { return PixelFormat::kR32F; }, has_particles},
    {"particle_reactive", &FrameInputs::particle_reactive, &FrameInputs::particle_render_extent,
     [](const ResolvePlan&) { return PixelFormat::kR8; },
     [](const ResolvePlan& plan) { return has_particles(plan) && plan.reads_reactive; }, kNoTransparents},
};

// Expects that the plan needs its images whole: each one left out once and too small once is refused by one sentence.
// `check` validates a frame.
void expect_refusals(const ResolvePlan& plan, const FrameInputs& good,
                     const std::function<Status(const FrameInputs&)>& check) {
  const Status fine = check(good);
  ASSERT_TRUE(fine.ok()) << fine.message();
  for (const InputCase& input : kInputs) {
    if (!input.needed(plan)) continue;
    FrameInputs inputs = good;
    inputs.*input.image = {};
    Status status = check(inputs);
    ASSERT_EQ(status.code(), StatusCode::kInvalidArgument) << input.field << " is left out";
    const std::string missing = fmt::format("{} is missing; the plan needs it as {}{}", input.field,
                                            name_of(input.format(plan)), input.remedy);
    ASSERT_TRUE(status.message().ends_with(missing)) << status.message() << ", not " << missing;
    inputs = good;
    (inputs.*input.image).extent.width = (inputs.*input.viewport).width - 1;
    status = check(inputs);
    ASSERT_EQ(status.code(), StatusCode::kInvalidArgument) << input.field << " is too small";
    ASSERT_NE(status.message().find(fmt::format("{}.extent is ", input.field)), std::string::npos)
        << status.message();
  }
}

TEST(SettingsCombinations, RefuseEachImageThatIsMissingOrTooSmall) {
  const std::vector<Axis>& axes = axes_of_inputs();
  Row row(axes.size(), 0);
  const auto next = [&] {
    for (std::size_t axis = 0; axis < row.size(); ++axis) {
      if (++row[axis] < axes[axis].size()) return true;
      row[axis] = 0;
    }
    return false;
  };
  const cl_mem made_up = reinterpret_cast<cl_mem>(0x10);
  int plans = 0;
  do {
    const Combination made = combine(axes, row);
    const Result<ResolvePlan> plan = plan_for(made.needs, made.settings);
    ASSERT_TRUE(plan.ok()) << names_of(axes, row) << ": " << plan.status().message();
    FrameInputs inputs{
        .render_extent = {13, 8}, .near_plane = .5f, .far_plane = 100, .particle_render_extent = {5, 4}};
    for (const InputCase& input : kInputs) {
      if (input.needed(plan.value()))
        inputs.*input.image = {
            .memory = made_up, .format = input.format(plan.value()), .extent = inputs.*input.viewport};
    }
    const FrameOutputs outputs{
        .linear = {.memory = made_up, .format = PixelFormat::kRGBA32F, .extent = kOutput}};
    expect_refusals(plan.value(), inputs,
                    [&](const FrameInputs& frame) { return validate(plan.value(), frame, outputs); });
    if (HasFatalFailure()) FAIL() << names_of(axes, row);
    ++plans;
  } while (next());
  EXPECT_EQ(plans, 17280);
}

// Runs frames of a plan over images of its own.
class Runner {
 public:
  Runner(const Device& device, const ResolvePlan& plan) : device_(device), plan_(plan) {}

  void run() {
    Result<ResolveService> made = ResolveService::create(device_, plan_);
    ASSERT_TRUE(made.ok()) << made.status().message();
    ResolveService& service = made.value();
    const std::optional<ResolvePlan> region = plan_.focus_plan();
    const Extent renders[] = {{11, 9}, {13, 8}, {13, 8}};
    const Extent outputs_of_dual[] = {kOutput, {10, 8}, {12, 9}};
    for (std::size_t i = 0; i < std::size(renders); ++i) {
      FrameInputs inputs = frame_of(plan_, renders[i], i);
      if (plan_.is_dual()) inputs.output_extent = outputs_of_dual[i];
      if (plan_.settings.control.fades) {
        inputs.fading_from = image(kOutput, plan_.settings.output.linear, Storage::kBuffer);
        inputs.fade_weight = .5f;
      }
      std::optional<FocusInputs> focus;
      if (region) {
        focus = FocusInputs{.frame = frame_of(*region, {7, 5}, i), .x = 3, .y = 2};
        if (plan_.settings.focus.mask) focus->mask = image(kRegion, PixelFormat::kR8, Storage::kBuffer);
      }
      const FrameOutputs outputs{image(kOutput, plan_.settings.output.linear, Storage::kBuffer),
                                 plan_.settings.output.present
                                     ? image(kOutput, PixelFormat::kRGBA8, plan_.presented_storage())
                                     : ImageView{}};
      if (i == 1) expect_dispatch_refuses(service, inputs, focus, region, outputs);
      const FrameReport report =
          focus ? service.dispatch(inputs, *focus, outputs) : service.dispatch(inputs, outputs);
      ASSERT_TRUE(report.ok()) << "frame " << i << ": " << report.status.message();
      ASSERT_TRUE(service.finish().ok());
      const std::optional<FrameReport> done = service.next_completed();
      ASSERT_TRUE(done && done->ok()) << "frame " << i;
      ASSERT_EQ(done->non_finite_pixels, 0) << "frame " << i;
    }
  }

 private:
  static void expect_dispatch_refuses(ResolveService& service, const FrameInputs& good,
                                      const std::optional<FocusInputs>& focus,
                                      const std::optional<ResolvePlan>& region, const FrameOutputs& outputs) {
    const ResolvePlan& plan = service.plan();
    // validate() first: where it lets a bad frame through, dispatch() would read what is not there.
    expect_refusals(plan, good, [&](const FrameInputs& inputs) {
      const Status status = validate(plan, inputs, outputs);
      if (!status.ok()) {
        EXPECT_EQ(service.dispatch(inputs, outputs).status.message(), status.message());
      }
      return status;
    });
    if (!focus) return;
    expect_refusals(*region, focus->frame, [&](const FrameInputs& inputs) {
      FocusInputs bad = *focus;
      bad.frame = inputs;
      const Status status = validate(plan, good, bad, outputs);
      if (!status.ok()) {
        EXPECT_EQ(service.dispatch(good, bad, outputs).status.message(), status.message());
      }
      return status;
    });
    if (!plan.settings.focus.mask) return;
    FocusInputs bad = *focus;
    bad.mask = {};
    EXPECT_NE(service.dispatch(good, bad, outputs).status.message().find("focus.mask is missing"),
              std::string::npos);
  }

  // With the images that the plan needs, and no others.
  FrameInputs frame_of(const ResolvePlan& plan, Extent render, std::size_t index) {
    FrameInputs inputs{.render_extent = render,
                       .jitter = {.25f, -.125f},
                       .near_plane = .5f,
                       .far_plane = 100,
                       .frame_index = index};
    inputs.parity = static_cast<int>(index % 2);
    if (has_particles(plan)) inputs.particle_render_extent = {5, 4};
    inputs.camera.clip_to_previous_clip[8] = .01f;
    const bool placed = plan.settings.targets.placement == Targets::kPlaced;
    for (const InputCase& input : kInputs) {
      if (!input.needed(plan)) continue;
      const bool is_particles = input.viewport == &FrameInputs::particle_render_extent;
      const Extent target =
          is_particles ? plan.settings.targets.particle_extent : plan.settings.target_extent;
      inputs.*input.image =
          image(placed ? inputs.*input.viewport : target, input.format(plan), plan.settings.targets.storage,
                input.image == &FrameInputs::velocity ? 0x18 : 0x30);
    }
    return inputs;
  }

  // Returns an image of bytes from `low` on, which are small positive numbers in every format; every seventh texel is
  // zero.
  ImageView image(Extent extent, PixelFormat format, Storage storage, unsigned low = 0x30) {
    const std::size_t texel = bytes_per_pixel(format);
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(extent.area()) * texel);
    for (std::size_t i = 0; i < bytes.size(); ++i)
      bytes[i] = i / texel % 7 == 3 ? 0 : static_cast<std::uint8_t>(low + random_() % 12);
    images_.push_back(device_.allocate(extent, format, storage).value());
    EXPECT_TRUE(device_.upload(images_.back().view(), extent, bytes.data()).ok());
    return images_.back().view();
  }

  Device device_;
  const ResolvePlan& plan_;
  std::vector<Image> images_;
  std::mt19937 random_{5};
};

TEST(SettingsCombinations, OfEveryTwoMakeAPicture) {
  const std::vector<Axis> axes = axes_of_frames();
  const Covering covering = Cover(axes).rows();
  // A view of the second layer of history is refused where there is none; all else goes together.
  for (const Pair& pair : covering.apart) {
    const std::string first = axes[pair.first_axis][pair.first].name;
    const std::string second = axes[pair.second_axis][pair.second].name;
    EXPECT_TRUE(first == "near" || second == "near") << first << ", " << second;
  }
  const Device device = Device::open().value();
  for (const Row& row : covering.rows) {
    const Combination made = combine(axes, row);
    const ResolvePlan plan = plan_for(made.needs, made.settings).value();
    SCOPED_TRACE(names_of(axes, row));
    Runner(device, plan).run();
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace quincunx
