// SPDX-License-Identifier: MIT
// The error front: its values, its file, and the scene mix that it is asked with.
#include "quincunx/control/error_front.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <string>

#include "../tools/own_cache.h"
#include "../tools/temporary_folder.h"
#include "quincunx/advanced/cache_folder.h"
#include "quincunx/advanced/content_statistics.h"
#include "quincunx/control/front_file.h"

namespace quincunx {
namespace {

const MethodVariant kBilinear = {.method = Method::kBilinear};
const MethodVariant kFast = {.method = Method::kTemporal, .preset = TemporalPreset::kFast};

const FrontSource kSource = {.device = "platform device",
                             .driver = "1.2",
                             .scene = "",
                             .date = "2026-11-22 20:00 UTC",
                             .command = "quincunx-bench --front \"front.json\"",
                             .truth = "64 samples a pixel",
                             .output_extent = {640, 360}};

FrontPoint point(SceneClass scene_class, const MethodVariant& method, double scale, double flip, double ms) {
  return {.scene_class = scene_class,
          .method = method,
          .scale = scale,
          .flip = flip,
          .flip_spread = flip / 10,
          .psnr_db = 30,
          .psnr_spread = 1,
          .ms_per_megapixel = ms,
          .ms_spread = ms / 20};
}

// Returns points of each class; errors and times grow with the class's number, so that no two are alike.
std::vector<FrontPoint> points() {
  std::vector<FrontPoint> all;
  for (std::size_t i = 0; i < kSceneClasses; ++i) {
    const auto scene_class = static_cast<SceneClass>(i);
    const double worse = 1 + 0.1 * static_cast<double>(i);
    all.push_back(point(scene_class, kFast, 1, 0.04 * worse, 16));
    all.push_back(point(scene_class, kFast, 0.5, 0.08 * worse, 10));
    all.push_back(point(scene_class, kBilinear, 0.5, 0.2 * worse, 1 * worse));
    all.push_back(point(scene_class, kBilinear, 1, 0.1 * worse, 3 * worse));
  }
  return all;
}

ErrorFront make() {
  auto front = ErrorFront::create(kSource, points());
  EXPECT_TRUE(front.ok()) << front.status().message();
  return std::move(front).value();
}

TEST(ErrorFront, JsonKeepsEverything) {
  const ErrorFront front = make();
  const auto read = ErrorFront::from_json(front.to_json());
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(read->source(), kSource);
  ASSERT_EQ(read->points().size(), front.points().size());
  for (std::size_t i = 0; i < front.points().size(); ++i) {
    const FrontPoint &now = read->points()[i], &before = front.points()[i];
    EXPECT_EQ(now.scene_class, before.scene_class);
    EXPECT_EQ(now.method, before.method);
    for (const auto field :
         {&FrontPoint::scale, &FrontPoint::flip, &FrontPoint::flip_spread, &FrontPoint::psnr_db,
          &FrontPoint::psnr_spread, &FrontPoint::ms_per_megapixel, &FrontPoint::ms_spread})
      EXPECT_NEAR(now.*field, before.*field, 5e-6 * before.*field);  // six significant digits
  }
  EXPECT_EQ(read->to_json(), front.to_json());
  EXPECT_FALSE(read->is_built_in());
}

// Drivers name themselves as they like.
TEST(ErrorFront, JsonTakesNamesThatAreNoText) {
  FrontSource source = kSource;
  source.driver = "Vendor\xae 1.2";
  const ErrorFront front = ErrorFront::create(source, points()).value();
  const auto read = ErrorFront::from_json(front.to_json());
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(read->source().driver, "Vendor\xef\xbf\xbd 1.2");
}

TEST(ErrorFront, HasEachMethodOnceByEffort) {
  const ErrorFront front = make();
  ASSERT_EQ(front.methods().size(), 2u);
  EXPECT_EQ(front.methods()[0], kBilinear);
  EXPECT_EQ(front.methods()[1], kFast);
}

TEST(ErrorFront, GivesMeasuredPointsBack) {
  const ErrorFront front = make();
  for (const FrontPoint& at : points())
    EXPECT_DOUBLE_EQ(front.flip(SceneMix::only(at.scene_class), at.method, at.scale).value(), at.flip);
}

TEST(ErrorFront, InterpolatesBetweenScalesAndClampsBeyond) {
  const ErrorFront front = make();
  const SceneMix still = SceneMix::only(SceneClass::kStill);
  EXPECT_DOUBLE_EQ(front.flip(still, kBilinear, 0.75).value(), 0.15);
  EXPECT_DOUBLE_EQ(front.flip(still, kBilinear, 0.6).value(), 0.18);
  EXPECT_DOUBLE_EQ(front.flip(still, kBilinear, 0.01).value(), 0.2);
  EXPECT_DOUBLE_EQ(front.flip(still, kBilinear, 2).value(), 0.1);
  // Between two points the figures lie between theirs and never turn round.
  double last = 1;
  for (double scale = 0.4; scale < 1.1; scale += 0.003) {
    const double flip = front.flip(still, kFast, scale).value();
    EXPECT_LE(flip, last) << scale;
    EXPECT_GE(flip, 0.04);
    EXPECT_LE(flip, 0.08);
    last = flip;
  }
}

TEST(ErrorFront, MixesClassesByTheirShares) {
  const ErrorFront front = make();
  SceneMix mix;
  mix.share = {0.5, 0, 0.25, 0, 0, 0.25};
  EXPECT_NEAR(front.flip(mix, kBilinear, 1).value(), 0.1 * (0.5 + 0.25 * 1.2 + 0.25 * 1.5), 1e-12);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> part(0, 1);
  for (int i = 0; i < 100; ++i) {
    double sum = 0;
    for (double& share : mix.share)
      sum += share = part(random);
    for (double& share : mix.share)
      share /= sum;
    const double flip = front.flip(mix, kFast, 0.7).value();
    EXPECT_GE(flip, front.flip(SceneMix::only(SceneClass::kStill), kFast, 0.7).value());
    EXPECT_LE(flip, front.flip(SceneMix::only(SceneClass::kZoom), kFast, 0.7).value());
  }
}

TEST(ErrorFront, TimesFollowTheOutput) {
  const ErrorFront front = make();
  EXPECT_DOUBLE_EQ(front.resolve_ms(kFast, 0.75, 2).value(), 26);
  // The mean over the classes: 3 ms times 1, 1.1, ... 1.5.
  EXPECT_DOUBLE_EQ(front.resolve_ms(kBilinear, 1, 1).value(), 3 * 1.25);
}

TEST(ErrorFront, HasNoAnswerToWhatCannotBe) {
  const ErrorFront front = make();
  const SceneMix still = SceneMix::only(SceneClass::kStill);
  EXPECT_FALSE(front.flip(still, {.method = Method::kLanczos3}, 0.7));
  EXPECT_FALSE(front.resolve_ms({.method = Method::kLanczos3}, 0.7, 1));
  EXPECT_FALSE(front.flip({}, kBilinear, 0.7)) << "shares that sum to 0";
  SceneMix mix = still;
  mix.share[1] = 0.1;
  EXPECT_FALSE(front.flip(mix, kBilinear, 0.7)) << "shares that sum to 1.1";
  mix.share[1] = -0.5;
  mix.share[2] = 0.5;
  EXPECT_FALSE(front.flip(mix, kBilinear, 0.7)) << "a negative share";
  for (const double bad : {0.0, -1.0, std::nan("")}) {
    EXPECT_FALSE(front.flip(still, kBilinear, bad)) << bad;
    EXPECT_FALSE(front.resolve_ms(kBilinear, bad, 1)) << bad;
    EXPECT_FALSE(front.resolve_ms(kBilinear, 1, bad)) << bad;
  }
  EXPECT_FALSE(front.resolve_ms(kBilinear, 1, 1.0 / 0.0));
}

TEST(ErrorFront, TheFrontIsWhatNothingDominates) {
  std::vector<FrontPoint> all = points();
  // Points with more milliseconds and more error than bilinear at the same scale, and then with fewer milliseconds.
  for (std::size_t i = 0; i < kSceneClasses; ++i)
    all.push_back(point(static_cast<SceneClass>(i), {.method = Method::kBSpline}, 1, 0.31, 8));
  all.back().ms_per_megapixel = 2;
  const auto front = ErrorFront::create(kSource, all);
  ASSERT_TRUE(front.ok()) << front.status().message();
  EXPECT_EQ(front->front(SceneClass::kStill).size(), 4u);
  for (const FrontPoint& at : front->front(SceneClass::kStill))
    EXPECT_NE(at.method.method, Method::kBSpline);
  // Dear and wrong, but no other is as cheap at that scale or a lower one, bilinear at 0.5 apart.
  EXPECT_EQ(front->front(SceneClass::kZoom).size(), 4u);
  all.back().ms_per_megapixel = 1;
  EXPECT_EQ(ErrorFront::create(kSource, all)->front(SceneClass::kZoom).size(), 5u);
}

TEST(ErrorFront, WhatDoesNotCountForAMethodIsNoDifference) {
  MethodVariant other = kBilinear;
  other.preset = TemporalPreset::kQuality;
  other.form = TwoFrameForm::kMean;
  EXPECT_EQ(other, kBilinear);
  EXPECT_TRUE(make().resolve_ms(other, 1, 1));
  MethodVariant quality = kFast;
  quality.preset = TemporalPreset::kQuality;
  EXPECT_FALSE(quality == kFast);
}

TEST(ErrorFront, BadPointsAreRefusedByName) {
  const auto message = [](auto change) {
    std::vector<FrontPoint> all = points();
    change(all);
    const auto front = ErrorFront::create(kSource, std::move(all));
    EXPECT_EQ(front.status().code(), StatusCode::kInvalidArgument);
    return front.status().message();
  };
  const auto has = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  for (const double bad : {-0.1, std::nan(""), 1.5}) {
    has(message([&](auto& all) { all[0].flip = bad; }), "temporal:fast of still at scale 1: flip is");
    has(message([&](auto& all) { all[0].scale = bad; }), "the scale is");
  }
  has(message([](auto& all) { all[0].ms_per_megapixel = 0; }), "ms_per_megapixel is 0");
  has(message([](auto& all) { all[0].psnr_db = 1.0 / 0.0; }), "psnr_db is inf");
  has(message([](auto& all) { all.push_back(all[3]); }), "bilinear of still at scale 1 is there twice");
  has(message([](auto& all) { all.clear(); }), "there is no point");
  has(message([](auto& all) { all.erase(all.begin(), all.begin() + 2); }),
      "temporal:fast has no point of still");
}

TEST(ErrorFront, BadFilesAreRefusedInOneSentence) {
  const std::string good = make().to_json();
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  for (const auto& [text, part] : std::vector<std::pair<std::string, std::string>>{
           {"", "parse error"},
           {"[]", "cannot use at() with array"},
           {"{}", "quincunx_error_front"},
           {changed("\"quincunx_error_front\": 1", "\"quincunx_error_front\": 2"),
            "version 2 cannot be read, only 1"},
           {changed("\"flip_spread\"", "\"flop_spread\""), "the columns are"},
           {changed("\"driver\"", "\"drover\""), "driver"},
           {changed("[\"still\",", "[\"stiff\","), "there is no class 'stiff'"},
           {changed("\"bilinear\"", "\"billinear\""), "there is no method 'billinear'"},
           {changed("\"bilinear\",0.5", "\"bilinear\",\"half\""), "must be number"},
           {changed("\"bilinear\",0.5", "\"bilinear\",1.5"), "it must lie in (0, 1]"},
           {changed("\"bilinear\",0.5,", "\"bilinear\","), "is no row of 9 cells"},
           {changed("\"bilinear\"", "\"temporal\""), "must be 'temporal:balanced'"},
           {good.substr(0, good.size() / 2), "parse error"},
       }) {
    const auto front = ErrorFront::from_json(text);
    ASSERT_FALSE(front.ok()) << text;
    EXPECT_EQ(front.status().code(), StatusCode::kInvalidArgument);
    EXPECT_EQ(front.status().message().rfind("error front: ", 0), 0u) << front.status().message();
    EXPECT_NE(front.status().message().find(part), std::string::npos) << front.status().message();
    EXPECT_EQ(front.status().message().find('\n'), std::string::npos) << front.status().message();
    EXPECT_EQ(front.status().message().find("json.exception"), std::string::npos) << front.status().message();
  }
}

TEST(ErrorFront, TheBuiltInOneSaysSo) {
  const ErrorFront& front = ErrorFront::built_in();
  EXPECT_TRUE(front.is_built_in());
  EXPECT_EQ(front.summary().rfind("built in", 0), 0u) << front.summary();
  EXPECT_TRUE(front.source().scene.empty());
  // A controller has a choice: at least a filter and a method that accumulates, and more pixels are better. From half
  // on that need not hold for a still picture, which an accumulating method already knows completely.
  EXPECT_TRUE(front.resolve_ms(kBilinear, 0.7, 0.9));
  EXPECT_TRUE(front.resolve_ms(kFast, 0.7, 0.9));
  for (const MethodVariant& method : front.methods()) {
    for (std::size_t i = 0; i < kSceneClasses; ++i) {
      const auto only = static_cast<SceneClass>(i);
      const SceneMix mix = SceneMix::only(only);
      const double lower = only == SceneClass::kStill ? .35 : .5;
      EXPECT_LT(front.flip(mix, method, 1).value(), front.flip(mix, method, lower).value())
          << name_of(method) << " of " << name_of(static_cast<SceneClass>(i));
    }
  }
}

namespace fs = std::filesystem;

// A cache folder of its own.
class FrontFile : public ::testing::Test {
 protected:
  // The figures that are built in, as if measured for `source` and written where those of `place` are looked for.
  static void write(const FrontKey& place, const FrontKey& source) {
    const auto points = ErrorFront::built_in().points();
    const auto front = ErrorFront::create({.device = source.device,
                                           .driver = source.driver,
                                           .scene = source.scene,
                                           .date = "now",
                                           .command = {},
                                           .truth = {},
                                           .output_extent = {640, 360}},
                                          {points.begin(), points.end()});
    ASSERT_TRUE(front.ok()) << front.status().message();
    std::ofstream(*front_path(place)) << front->to_json();
  }

  static constexpr const char* kScene = "courtyard";
  const FrontKey any_ = {"platform device", "1.2", ""};
  const FrontKey scene_ = {"platform device", "1.2", kScene};

 private:
  testing::TemporaryFolder folder_;
  testing::OwnCache cache_{folder_.file(".")};
};

TEST_F(FrontFile, LiesInTheCacheFolderByDeviceDriverAndScene) {
  EXPECT_EQ(front_path(any_)->parent_path(), *cache_folder());
  EXPECT_NE(*front_path(any_), *front_path(scene_));
  EXPECT_NE(*front_path(any_), *front_path({"platform device", "1.3", ""}));
  EXPECT_NE(*front_path(any_), *front_path({"another device", "1.2", ""}));
  const testing::OwnCache none("");
  EXPECT_FALSE(front_path(any_));
  EXPECT_TRUE(find_front(any_).front.is_built_in());
}

TEST_F(FrontFile, TheScenesGoesBeforeTheDevicesGoesBeforeTheBuiltIn) {
  EXPECT_TRUE(find_front(scene_).front.is_built_in());
  EXPECT_EQ(find_front(scene_).explanation.rfind("built in", 0), 0u);
  write(any_, any_);
  EXPECT_FALSE(find_front(scene_).front.is_built_in());
  EXPECT_EQ(find_front(scene_).front.source().scene, "");
  write(scene_, scene_);
  EXPECT_EQ(find_front(scene_).front.source().scene, kScene);
  EXPECT_EQ(
      find_front(scene_).explanation,
      "measured on platform device, driver 1.2, now, for scene courtyard; " + front_path(scene_)->string());
  EXPECT_EQ(find_front(any_).front.source().scene, "");
}

TEST_F(FrontFile, WhatIsDamagedOrOfSomethingElseIsPassedOverAndSaidSo) {
  write(any_, any_);
  std::ofstream(*front_path(scene_)) << "{";
  const FoundFront device = find_front(scene_);
  EXPECT_EQ(device.front.source().scene, "");
  EXPECT_FALSE(device.front.is_built_in());
  EXPECT_NE(device.explanation.find(front_path(scene_)->string() + "' was not taken: error front: "),
            std::string::npos)
      << device.explanation;
  write(any_, {"another device", "1.2", ""});
  const FoundFront built_in = find_front(any_);
  EXPECT_TRUE(built_in.front.is_built_in());
  EXPECT_NE(built_in.explanation.find("was not taken: it is of 'another device'"), std::string::npos)
      << built_in.explanation;
}

double share(const SceneMix& mix, SceneClass scene_class) {
  return mix.share[static_cast<std::size_t>(scene_class)];
}

TEST(ContentStatistics, NothingMovesIsStill) {
  EXPECT_EQ(share(mix_of({}), SceneClass::kStill), 1);
}

TEST(ContentStatistics, EachPlaceCountsOnce) {
  const SceneMix mix = mix_of({.moving = 0.7, .apart = 0.3, .thin = 0.1, .light = 0.2, .zoom = 0.15});
  EXPECT_NEAR(share(mix, SceneClass::kLight), 0.2, 1e-12);
  EXPECT_NEAR(share(mix, SceneClass::kThin), 0.1, 1e-12);
  EXPECT_NEAR(share(mix, SceneClass::kObjects), 0.2, 1e-12);
  EXPECT_NEAR(share(mix, SceneClass::kZoom), 0.15, 1e-12);
  EXPECT_NEAR(share(mix, SceneClass::kPan), 0.25, 1e-12);
  EXPECT_NEAR(share(mix, SceneClass::kStill), 0.1, 1e-12);
}

TEST(ContentStatistics, EveryMixIsValid) {
  for (int code = 0; code < 243; ++code) {
    int rest = code;
    const auto third = [&rest] {
      const double value = (rest % 3) * 0.5;
      rest /= 3;
      return value;
    };
    const ContentStatistics content = {
        .moving = third(), .apart = third(), .thin = third(), .light = third(), .zoom = third()};
    const SceneMix mix = mix_of(content);
    ASSERT_TRUE(mix.valid()) << code;
    if (content.moving == 0) {
      ASSERT_EQ(share(mix, SceneClass::kPan), 0);
      ASSERT_EQ(share(mix, SceneClass::kZoom), 0);
    }
  }
}

TEST(ContentStatistics, BadFieldsAreNamed) {
  const double nan = std::nan("");
  const auto message = [](const ContentStatistics& content) { return check(content).message(); };
  for (const double bad : {nan, -0.1, 1.1}) {
    EXPECT_EQ(message({.moving = bad}).rfind("content.moving", 0), 0u);
    EXPECT_EQ(message({.apart = bad}).rfind("content.apart", 0), 0u);
    EXPECT_EQ(message({.thin = bad}).rfind("content.thin", 0), 0u);
    EXPECT_EQ(message({.light = bad}).rfind("content.light", 0), 0u);
    EXPECT_EQ(message({.zoom = bad}).rfind("content.zoom", 0), 0u);
  }
  for (const double bad : {nan, -1.0, std::numeric_limits<double>::infinity()})
    EXPECT_EQ(message({.speed_px = bad}).rfind("content.speed_px", 0), 0u);
  EXPECT_TRUE(check(ContentStatistics{.moving = 1, .speed_px = 300, .apart = 1}).ok());
}

}  // namespace

}  // namespace quincunx
