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
  for (const MethodInfo& info : methods()) {
    ASSERT_TRUE(method_choices().contains(info.name)) << info.name;
    EXPECT_EQ(method_choices().at(info.name).method, info.method);
    EXPECT_STREQ(name_of(info.method), info.name);
  }
}

TEST(MethodNames, TheListHoldsEachOne) {
  const std::string list = method_list();
  EXPECT_EQ(list.rfind("point, bilinear, ", 0), 0u) << list;
  for (const auto& [name, choice] : method_choices()) {
    const std::string ending = name.find(':') == std::string::npos ? name : name.substr(name.find(':'));
    EXPECT_NE(list.find(ending), std::string::npos) << name << " in " << list;
  }
  const std::string last = " or temporal[:fast|:balanced|:quality]";
  ASSERT_GT(list.size(), last.size());
  EXPECT_EQ(list.substr(list.size() - last.size()), last);
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
