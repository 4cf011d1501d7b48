// SPDX-License-Identifier: MIT
// The rows of variants.txt are what plans ask for, each kernel has one, and they build on the device.
#include <gtest/gtest.h>

#include <algorithm>
#include <compare>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "device/program_cache.h"
#include "embedded_kernel_files.h"
#include "kernel_fixture.h"
#include "plan/pass_spec.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {
namespace {

struct Row {
  std::string kernel;
  std::string options;

  friend auto operator<=>(const Row&, const Row&) = default;
};

std::set<Row> listed_rows() {
  std::ifstream file(QUINCUNX_VARIANTS);
  if (!file) file.open("kernels/variants.txt");  // built elsewhere, run from the root of a copy
  std::set<Row> found;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    const std::size_t space = line.find(' ');
    found.insert({line.substr(0, space), space == std::string::npos ? "" : line.substr(space + 1)});
  }
  return found;
}

class KernelVariants : public ::testing::TestWithParam<std::string> {};

// Returns some rows of a kernel, in which each option and every two stand that stand together in any. The others differ
// in nothing that a device's compiler could refuse and clang's front end accept, which checks all rows when the tests
// are built (kernels/cmake/check_kernels.cmake).
std::vector<Row> covering_rows(const std::string& kernel) {
  using Pairs = std::set<std::pair<std::string, std::string>>;
  std::vector<std::pair<Row, Pairs>> rows;
  Pairs open;
  for (const Row& row : listed_rows()) {
    if (row.kernel != kernel) continue;
    std::istringstream words(row.options);
    const std::vector<std::string> options{std::istream_iterator<std::string>(words), {}};
    Pairs pairs{Pairs::value_type()};  // a row may have none
    for (const std::string& first : options) {
      for (const std::string& second : options)
        pairs.emplace(first, second);
    }
    open.insert(pairs.begin(), pairs.end());
    rows.emplace_back(row, std::move(pairs));
  }
  std::vector<Row> covering;
  while (!open.empty()) {
    const auto news = [&open](const auto& row) {
      return std::count_if(row.second.begin(), row.second.end(),
                           [&open](const auto& pair) { return open.contains(pair); });
    };
    const auto& [row, pairs] = *std::ranges::max_element(rows, {}, news);
    covering.push_back(row);
    for (const auto& pair : pairs)
      open.erase(pair);
  }
  return covering;
}

TEST_P(KernelVariants, EveryTwoOptionsBuild) {
  const std::vector<Row> rows = covering_rows(GetParam());
  EXPECT_FALSE(rows.empty()) << "variants.txt has no row of " << GetParam();
  for (const Row& row : rows) {
    try {
      build_kernel(testing::impl(), row.kernel, row.options);
    } catch (const std::exception& error) {
      ADD_FAILURE() << row.kernel << " " << row.options << ": " << error.what();
    }
  }
}

std::vector<std::string> embedded_kernels() {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : embedded_kernel_files()) {
    if (!file.name.ends_with(".cl")) continue;
    const std::size_t folder = file.name.rfind('/') + 1;  // 0 where there is none
    names.emplace_back(file.name.substr(folder, file.name.size() - folder - 3));
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(Kernels, KernelVariants, ::testing::ValuesIn(embedded_kernels()),
                         [](const auto& instance) { return instance.param; });

struct PlanInputs {
  SceneNeeds needs;
  ResolveSettings settings;
};

// One value of one field: puts it into a plan's inputs.
using PlanChange = std::function<void(PlanInputs&)>;

using PlanAxis = std::vector<PlanChange>;

// The defaults, with sizes; two frames, from whose plans single changes lead to every variant.
PlanInputs first_plan(Extent output = {64, 64}) {
  return {.needs = {},
          .settings = {.method = Method::kQuincunx,
                       .output_extent = output,
                       .target_extent = {2 * output.width, 2 * output.height}}};
}

// Returns all values of all fields. Not each combination is accepted by plan_for().
std::vector<PlanAxis> plan_axes(Extent output = {64, 64}) {
  // A field that is added to the settings stops this line from compiling: give it an axis, too.
  [[maybe_unused]] const auto& [f01, f02, f03, f04, f05, f06, f07, targets, picture, filter, f11, f12, f13,
                                f14, control, checks] = ResolveSettings();
  [[maybe_unused]] const auto& [t1, t2, t3, t4, t5] = targets;
  [[maybe_unused]] const auto& [p1, p2, p3, p4, p5] = picture;
  [[maybe_unused]] const auto& [l1, l2, l3] = filter;
  [[maybe_unused]] const auto& [c1, c2] = control;

  std::vector<PlanAxis> axes;
  const auto add = [&axes]<typename Value, typename Set>(std::initializer_list<Value> values, Set set) {
    PlanAxis axis;
    for (const Value& value : values)
      axis.push_back([value, set](PlanInputs& inputs) { set(inputs, value); });
    axes.push_back(std::move(axis));
  };
  const auto need = [&](bool SceneNeeds::*field) {
    add({false, true}, [field](PlanInputs& inputs, bool value) { inputs.needs.*field = value; });
  };
  const auto setting = [&]<typename Value>(Value ResolveSettings::*field,
                                           std::initializer_list<Value> values) {
    add(values, [field](PlanInputs& inputs, const Value& value) { inputs.settings.*field = value; });
  };
  const auto within = [&]<typename Group, typename Value>(Group ResolveSettings::*group, Value Group::*field,
                                                          std::initializer_list<Value> values) {
    add(values,
        [group, field](PlanInputs& inputs, const Value& value) { inputs.settings.*group.*field = value; });
  };
  const Extent small = {(output.width + 1) / 2, (output.height + 1) / 2};
  const Extent large = {2 * output.width, 2 * output.height};

  using Settings = ResolveSettings;
  using enum PixelFormat;
  PlanAxis all_methods;
  for (const MethodInfo& info : methods())
    all_methods.push_back([&info](PlanInputs& inputs) { inputs.settings.method = info.method; });
  axes.push_back(std::move(all_methods));
  need(&SceneNeeds::moving_objects);
  need(&SceneNeeds::camera_motion);
  need(&SceneNeeds::transparents);
  need(&SceneNeeds::background);
  within(&Settings::output, &PictureSettings::min_extent, {Extent{}, Extent{1, 1}});
  setting(&Settings::target_extent, {large, small});
  within(&Settings::targets, &TargetSettings::particle_extent, {Extent{}, small});
  setting(&Settings::colour, {kRGBA16F, kRGBA32F, kRGBA8});
  setting(&Settings::velocity, {kRG16F, kRG32F});
  within(&Settings::output, &PictureSettings::linear, {kRGBA32F, kRGBA16F});
  add({InputConventions{}, InputConventions{.depth = DepthConvention::kLinear, .velocity_jittered = true},
       InputConventions{
           .depth = DepthConvention::kLinear, .velocity_jittered = true, .origin = Origin::kBottom}},
      [](PlanInputs& inputs, const InputConventions& value) {
        auto& [depth, clip, unit, backward, up, jittered, origin, drawn, sky] = inputs.settings.conventions;
        depth = value.depth;
        jittered = value.velocity_jittered;
        origin = value.origin;
      });
  within(&Settings::targets, &TargetSettings::storage, {Storage::kBuffer, Storage::kImage});
  within(&Settings::targets, &TargetSettings::placement, {Targets::kViewport, Targets::kPlaced});
  within(&Settings::targets, &TargetSettings::shading, {Shading::kFull, Shading::kCheckerboard});
  within(&Settings::output, &PictureSettings::present, {false, true});
  within(&Settings::targets, &TargetSettings::clear, {false, true});
  within(&Settings::output, &PictureSettings::tone_map,
         {ToneMap::kClamp, ToneMap::kReinhard, ToneMap::kAces});
  within(&Settings::output, &PictureSettings::dither, {false, true});
  within(&Settings::filter, &FilterSettings::clamp_ringing, {false, true});
  within(&Settings::conventions, &InputConventions::drawn_velocity,
         {DrawnVelocity::kOwn, DrawnVelocity::kDilated});
  within(&Settings::conventions, &InputConventions::sky_motion,
         {SkyMotion::kAsDrawn, SkyMotion::kCamera, SkyMotion::kEvidence});
  setting(&Settings::sharpness, {0.0f, .5f});
  within(&Settings::control, &ControlSettings::measures_content, {false, true});
  setting(&Settings::checks_motion, {false, true});
  within(&Settings::control, &ControlSettings::fades, {false, true});
  setting(&Settings::focus,
          {FocusSettings{}, FocusSettings{.extent = small}, FocusSettings{.extent = small, .mask = true}});
  within(&Settings::quincunx, &QuincunxSettings::form,
         {TwoFrameForm::kMean, TwoFrameForm::kVelocity, TwoFrameForm::kReprojected});
  within(&Settings::quincunx, &QuincunxSettings::sampling, {Sampling::kPoint, Sampling::kBilinear});
  within(&Settings::quincunx, &QuincunxSettings::residual_weight, {0.0f, 1.0f});
  within(&Settings::temporal, &TemporalSettings::preset,
         {TemporalPreset::kFast, TemporalPreset::kBalanced, TemporalPreset::kQuality});
  within(&Settings::temporal, &TemporalSettings::history, {kRGBA16F, kRGBA32F});
  within(&Settings::temporal, &TemporalSettings::view,
         {TemporalView::kPicture, TemporalView::kConfidence, TemporalView::kRejection, TemporalView::kPhase,
          TemporalView::kLayers, TemporalView::kCoverage, TemporalView::kNear, TemporalView::kFar});
  within(&Settings::temporal, &TemporalSettings::noise, {0.0f, .5f});
  add({0.0f, .5f}, [](PlanInputs& inputs, float value) { inputs.settings.blur.shutter = value; });
  // Neither grain, nor whether the noise moves, nor the other parameters of blur and forms choose passes.
  return axes;
}

// The debug views of resolve_temporal, to which formats mean nothing, are listed with one storage and one format of
// each kind only.
bool is_listed(const ResolveSettings& settings) {
  const ResolveSettings first = first_plan().settings;
  return settings.temporal.view == TemporalView::kPicture ||
         (settings.targets.storage == first.targets.storage && settings.colour == first.colour &&
          settings.velocity == first.velocity && settings.output.linear == first.output.linear &&
          settings.temporal.history == first.temporal.history);
}

// Calls visit(inputs) with the inputs of all plans that differ from `from` in one field.
template <typename Visit>
void visit_neighbours(const PlanInputs& from, const Visit& visit) {
  static const std::vector<PlanAxis> axes = plan_axes();
  for (const PlanAxis& axis : axes) {
    for (const PlanChange& change : axis) {
      PlanInputs inputs = from;
      change(inputs);
      visit(inputs);
    }
  }
}

// Returns every variant that a plan asks for. A variant depends on a few settings, so it is found by changing one
// setting of a plan that asks for a similar one: this begins with the defaults and goes on from each plan that asks for
// a new variant.
std::set<Row> planned_rows() {
  std::set<Row> all;
  std::deque<PlanInputs> left;
  const auto visit = [&](const PlanInputs& inputs) {
    const Result<ResolvePlan> plan = plan_for(inputs.needs, inputs.settings);
    if (!plan.ok() || !is_listed(inputs.settings)) return;
    bool is_new = false;
    for (const PlannedPass& pass : plan->passes)
      is_new |= all.insert({pass.kernel, pass.options}).second;
    PlanFacts facts(inputs.needs, inputs.settings);
    facts.two_way = facts.displays_history() && facts.shows_picture() && !facts.is_dual();  // two_way.h
    for (const PassSpec& pass : list_passes(facts).passes)
      is_new |= all.insert({pass.kernel, pass.options}).second;
    if (is_new) left.push_back(inputs);
  };
  for (visit(first_plan()); !left.empty(); left.pop_front())
    visit_neighbours(left.front(), visit);
  return all;
}

constexpr char kHead[] =
    "# Every variant that a plan asks for: kernel, then its -D options. Made by the test "
    "Variants.TheListIsThatOfAllPlans;\n"
    "# the build compiles each row with clang, a test builds every two options on the device.\n";

TEST(Variants, TheListIsThatOfAllPlans) {
  const std::set<Row> listed = listed_rows();
  const std::set<Row> planned = planned_rows();
  if (std::getenv("QUINCUNX_WRITE_VARIANTS") != nullptr) {
    std::ofstream file(QUINCUNX_VARIANTS);
    file << kHead;
    for (const Row& row : planned)
      file << row.kernel << (row.options.empty() ? "" : " ") << row.options << '\n';
    return;
  }
  const auto tell = [](const char* what, const std::vector<Row>& of) {
    for (const Row& row : of)
      ADD_FAILURE() << what << ' ' << row.kernel << ' ' << row.options
                    << "\nto make kernels/variants.txt anew: ninja -C build/release variants";
  };
  std::vector<Row> missing;
  std::set_difference(planned.begin(), planned.end(), listed.begin(), listed.end(),
                      std::back_inserter(missing));
  tell("variants.txt lacks", missing);
  std::vector<Row> extra;
  std::set_difference(listed.begin(), listed.end(), planned.begin(), planned.end(),
                      std::back_inserter(extra));
  tell("no plan asks for", extra);
}

// A frame's report has a fixed number of places, for the picture's passes and those of its focus.
TEST(Variants, NoPlanHasMorePassesThanAReport) {
  PlanInputs largest = first_plan();
  largest.settings.method = Method::kTemporal;
  std::size_t most = 0;
  for (bool grows = true; grows;) {
    grows = false;
    visit_neighbours(PlanInputs(largest), [&](const PlanInputs& inputs) {
      const Result<ResolvePlan> plan = plan_for(inputs.needs, inputs.settings);
      if (!plan.ok()) return;
      const std::optional<ResolvePlan> focus = plan->focus_plan();
      const std::size_t passes = plan->passes.size() + (focus ? focus->passes.size() : 0);
      if (passes <= most) return;
      most = passes;
      largest = inputs;
      grows = true;
    });
  }
  EXPECT_LE(most, PassReports::max_size());
  EXPECT_GE(most, 50u) << "the temporal upscaler with all that goes with it";
}

}  // namespace
}  // namespace quincunx
