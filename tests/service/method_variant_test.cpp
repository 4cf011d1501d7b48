// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "quincunx/advanced/method.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {
namespace {

constexpr MethodVariant kMeanOfNearest = {
    .method = Method::kQuincunx, .form = TwoFrameForm::kMean, .sampling = Sampling::kPoint};

TEST(MethodVariant, NamesGoBothWays) {
  std::set<std::string> names;
  for (const VariantInfo& info : all_variants()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name << " is there twice";
    EXPECT_EQ(name_of(info.variant), info.name);
    EXPECT_EQ(info.name.rfind(name_of(info.variant.method), 0), 0u) << info.name;
    EXPECT_FALSE(info.summary.empty()) << info.name;
    const auto again = parse_variant(info.name);
    ASSERT_TRUE(again.ok()) << again.status().message();
    EXPECT_EQ(again.value(), info.variant);
  }
  for (const char* name : {"bilinear", "quincunx:mean", "quincunx:velocity", "quincunx:point",
                           "quincunx:reprojected", "temporal:fast", "temporal:balanced", "temporal:quality"})
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST(MethodVariant, EveryMethodHasSomeInTheOrderOfEffort) {
  const auto all = all_variants();
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end(), [](const VariantInfo& a, const VariantInfo& b) {
    return a.variant < b.variant;
  }));
  std::set<Method> known;
  for (const VariantInfo& info : all)
    known.insert(info.variant.method);
  EXPECT_EQ(known.size(), methods().size());
}

TEST(MethodVariant, AMethodsNameStandsForItsDefaults) {
  for (const MethodInfo& info : methods()) {
    const auto variant = parse_variant(info.name);
    ASSERT_TRUE(variant.ok()) << variant.status().message();
    EXPECT_EQ(variant.value(), variant_of({.method = info.method})) << info.name;
  }
  EXPECT_EQ(name_of(parse_variant("quincunx").value()), "quincunx:velocity");
  EXPECT_EQ(name_of(parse_variant("temporal").value()), "temporal:balanced");
}

TEST(MethodVariant, OtherNamesAreRefusedInOneSentence) {
  for (const char* name : {"", "Bilinear", "bilinear ", "bilinear:fast", "quincunx:fast", "temporal:mean",
                           "quincunx:", "quincunx:mean:point", "unknown"}) {
    const auto variant = parse_variant(name);
    ASSERT_FALSE(variant.ok()) << name;
    EXPECT_EQ(variant.status().code(), StatusCode::kInvalidArgument);
    const std::string message = variant.status().message();
    EXPECT_EQ(message.rfind("there is no method '" + std::string(name) + "'; there are point, bilinear, ", 0),
              0u)
        << message;
    EXPECT_NE(message.find("temporal:balanced"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(MethodVariant, SettingsTakeItAndTellIt) {
  for (const VariantInfo& info : all_variants()) {
    ResolveSettings settings;
    settings.sharpness = 0.5f;
    apply(info.variant, settings);
    EXPECT_EQ(variant_of(settings), info.variant) << info.name;
    EXPECT_EQ(settings.sharpness, 0.5f);
  }
  ResolveSettings settings;
  apply({.method = Method::kTemporal, .preset = TemporalPreset::kQuality}, settings);
  apply({.method = Method::kBilinear}, settings);
  EXPECT_EQ(settings.temporal.preset, TemporalPreset::kQuality) << "a filter has no say in it";
}

TEST(MethodVariant, FieldsThatDoNotCountMakeNoDifference) {
  const MethodVariant other = {.method = Method::kBilinear,
                               .form = TwoFrameForm::kMean,
                               .sampling = Sampling::kPoint,
                               .preset = TemporalPreset::kQuality};
  EXPECT_EQ(other, MethodVariant{.method = Method::kBilinear});
  EXPECT_EQ(name_of(other), "bilinear");
  MethodVariant reprojected = {.method = Method::kQuincunx, .form = TwoFrameForm::kReprojected};
  const MethodVariant before = reprojected;
  reprojected.sampling = Sampling::kPoint;
  EXPECT_EQ(reprojected, before);
  EXPECT_NE(kMeanOfNearest, parse_variant("quincunx:mean").value());
  EXPECT_NE(parse_variant("temporal:fast").value(), parse_variant("temporal:quality").value());
}

TEST(MethodVariant, OneWithoutANameHasItsMethods) {
  EXPECT_EQ(name_of(kMeanOfNearest), "quincunx");
}

}  // namespace
}  // namespace quincunx
