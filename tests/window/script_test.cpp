// SPDX-License-Identifier: MIT
#include "window/script.h"

#include <gtest/gtest.h>

namespace quincunx::scenes {
namespace {

void expect_refused(const std::string& text, const std::string& part) {
  const auto script = Script::parse(text);
  ASSERT_FALSE(script.ok()) << text;
  EXPECT_EQ(script.status().code(), StatusCode::kInvalidArgument);
  EXPECT_NE(script.status().message().find(part), std::string::npos) << script.status().message();
}

TEST(Script, TakesEveryActionAndComments) {
  const auto script = Script::parse(
      "# a comment\n\n3 key shift+m # and one behind\n  1\tkey period\r\n4 resize 320x200\n5 minimise\n6 "
      "restore\n");
  EXPECT_TRUE(script.ok()) << script.status().message();
  EXPECT_TRUE(Script::parse("").ok());
}

TEST(Script, SaysWhichLineIsWrongAndWhy) {
  expect_refused("1 key m\n\nkey m\n", "line 3: write a turn");
  expect_refused("-1 key m", "line 1: write a turn");
  expect_refused("1", "line 1: write a turn");
  expect_refused("1 jump", "'jump' is no action");
  expect_refused("1 key", "no key is called ''");
  expect_refused("1 key xyz", "no key is called 'xyz'");
  expect_refused("1 key m n", "'n' is one word too many");
  expect_refused("1 resize 0x5", "'0x5' is no size");
  expect_refused("1 minimise now", "'now' is one word too many");
}

TEST(Script, NamesTheFileThatCannotBeRead) {
  const auto script = Script::read("/nowhere/keys");
  ASSERT_FALSE(script.ok());
  EXPECT_EQ(script.status().code(), StatusCode::kIoFailure);
  EXPECT_NE(script.status().message().find("/nowhere/keys"), std::string::npos);
}

}  // namespace
}  // namespace quincunx::scenes
