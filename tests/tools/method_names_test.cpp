// SPDX-License-Identifier: MIT
#include "tools/program/method_names.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace quincunx::tools {
namespace {

TEST(MethodNames, EachNameSaysWhatItChooses) {
  for (const auto& [name, choice] : method_choices()) {
    ResolveSettings settings;
    choose(settings, choice);
    const std::string longest = method_name(settings);
    ASSERT_TRUE(method_choices().contains(longest)) << longest;
    EXPECT_EQ(method_choices().at(longest), choice) << name << " is reported as " << longest;
    EXPECT_EQ(longest.rfind(quincunx::name_of(choice.method), 0), 0u);
    EXPECT_FALSE(choice.summary.empty()) << name;
  }
}

TEST(MethodNames, EveryMethodHasOne) {
  for (const Method method : {Method::kPoint, Method::kBilinear, Method::kBSpline, Method::kCatmullRom,
                              Method::kLanczos2, Method::kNoise, Method::kNoiseOffset, Method::kQuincunx}) {
    EXPECT_TRUE(method_choices().contains(quincunx::name_of(method)));
  }
}

TEST(MethodNames, FormsAreTold) {
  ResolveSettings settings;
  choose(settings, method_choices().at("quincunx:mean"));
  EXPECT_EQ(method_name(settings), "quincunx:mean");
  choose(settings, method_choices().at("bilinear"));
  EXPECT_EQ(method_name(settings), "bilinear");
}

}  // namespace
}  // namespace quincunx::tools
