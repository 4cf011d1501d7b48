// SPDX-License-Identifier: MIT
// The C interface answers bad input with a code and a sentence.
#include <gtest/gtest.h>

#include <string>
#include <thread>

#include "c_interface_fixture.h"

namespace quincunx {
namespace {

using testing::c_plan;

constexpr Extent kOutput{48, 27};
constexpr Extent kTarget{64, 36};

bool tells(const char* words) {
  return std::string(quincunx_last_error()).find(words) != std::string::npos;
}

TEST(CErrors, ValidateNamesTheField) {
  const auto plan = c_plan({}, {.method = Method::kBilinear, .output = kOutput, .target = kTarget});
  float texels[4] = {};
  quincunx_image colour = {sizeof(colour), QUINCUNX_HOST, QUINCUNX_RGBA16F, 64, 36, 0, 0, texels};
  quincunx_image picture = {sizeof(picture), QUINCUNX_HOST, QUINCUNX_RGBA32F, 48, 27, 0, 0, texels};
  quincunx_inputs inputs = {};
  inputs.struct_size = sizeof(inputs);
  inputs.colour = &colour;
  inputs.render_width = 64;
  inputs.render_height = 36;
  quincunx_outputs outputs = {sizeof(outputs), &picture, nullptr, nullptr};
  const auto check = [&] { return quincunx_validate(plan.get(), &inputs, &outputs); };
  ASSERT_EQ(check(), QUINCUNX_OK) << quincunx_last_error();  // and no texel was read
  const auto refuses = [&](const char* words) {
    return check() == QUINCUNX_INVALID_ARGUMENT && tells(words);
  };
  colour.pitch = 511;
  EXPECT_TRUE(refuses("colour.pitch is 511; a row of 64 texels of RGBA16F takes 512"))
      << quincunx_last_error();
  colour.pitch = 0;
  colour.offset = 16;
  EXPECT_TRUE(refuses("colour.offset is 16; in host memory it must be 0")) << quincunx_last_error();
  colour.offset = 0;
  colour.place = 3;
  EXPECT_TRUE(refuses("colour.place is 3; it must lie in [0, 2]")) << quincunx_last_error();
  colour.place = QUINCUNX_HOST;
  colour.format = QUINCUNX_RGBA8;
  EXPECT_TRUE(refuses("colour.format is RGBA8; the plan has RGBA16F")) << quincunx_last_error();
  colour.format = 0;
  EXPECT_TRUE(refuses("colour.format is 0; it must lie in [1, 7]")) << quincunx_last_error();
  colour.format = QUINCUNX_RGBA16F;
  colour.memory = nullptr;
  EXPECT_TRUE(refuses("colour.memory is NULL")) << quincunx_last_error();
  inputs.colour = nullptr;
  EXPECT_TRUE(refuses("colour is missing; the plan needs it as RGBA16F")) << quincunx_last_error();
}

TEST(CErrors, NullPointersAreErrors) {
  EXPECT_EQ(quincunx_settings_init(nullptr), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_TRUE(tells("settings is NULL")) << quincunx_last_error();
  EXPECT_EQ(quincunx_plan_create(nullptr, nullptr), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_EQ(quincunx_device_open("", nullptr), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_EQ(quincunx_dispatch(nullptr, nullptr, nullptr, nullptr), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_TRUE(tells("service is NULL")) << quincunx_last_error();
  quincunx_service* service = reinterpret_cast<quincunx_service*>(16);
  EXPECT_EQ(quincunx_service_create(nullptr, nullptr, &service), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_EQ(service, nullptr);
  quincunx_service_destroy(nullptr);
  quincunx_plan_destroy(nullptr);
  quincunx_device_destroy(nullptr);
  EXPECT_EQ(quincunx_plan_text(nullptr), nullptr);
}

TEST(CErrors, ADeviceThatIsNotThereIsNamed) {
  quincunx_device* device = nullptr;
  EXPECT_EQ(quincunx_device_open("no such device", &device), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_EQ(device, nullptr);
  EXPECT_TRUE(tells("no OpenCL device matches 'no such device'")) << quincunx_last_error();
}

TEST(CErrors, EachThreadHasItsOwnSentence) {
  EXPECT_EQ(quincunx_finish(nullptr), QUINCUNX_INVALID_ARGUMENT);
  std::string other = "not asked";
  std::thread([&other] { other = quincunx_last_error(); }).join();
  EXPECT_EQ(other, "");
  EXPECT_TRUE(tells("service is NULL"));
}

}  // namespace
}  // namespace quincunx
