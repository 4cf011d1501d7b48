// SPDX-License-Identifier: MIT
#include "quincunx/device.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <vector>

namespace quincunx {
namespace {

TEST(Device, ListsAndOpens) {
  const std::vector<DeviceInfo> devices = Device::list();
  ASSERT_FALSE(devices.empty());
  EXPECT_EQ(devices[0].index, 0);
  EXPECT_FALSE(devices[0].name.empty());
  EXPECT_FALSE(devices[0].driver.empty());
  for (const std::string& selector : {std::string(), std::string("0"), devices[0].name.substr(0, 8)}) {
    auto device = Device::open(selector);
    ASSERT_TRUE(device.ok()) << selector << ": " << device.status().message();
    EXPECT_EQ(device->info().name, devices[0].name);
  }
}

TEST(Device, AnUnknownSelectorListsWhatThereIs) {
  const auto device = Device::open("no such device");
  ASSERT_FALSE(device.ok());
  EXPECT_EQ(device.status().code(), StatusCode::kInvalidArgument);
  EXPECT_NE(device.status().message().find("no such device"), std::string::npos);
  EXPECT_NE(device.status().message().find(Device::list()[0].name), std::string::npos);
}

TEST(Device, BorrowsACallersQueue) {
  auto owner = Device::open();
  ASSERT_TRUE(owner.ok());
  auto borrowed = Device::borrow(owner->context(), owner->id(), owner->queue());
  ASSERT_TRUE(borrowed.ok()) << borrowed.status().message();
  EXPECT_EQ(borrowed->queue(), owner->queue());
  EXPECT_FALSE(Device::borrow(nullptr, owner->id(), owner->queue()).ok());

  cl_int error = CL_SUCCESS;
  cl_command_queue unordered =
      clCreateCommandQueue(owner->context(), owner->id(), CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE, &error);
  if (error == CL_SUCCESS) {
    const auto refused = Device::borrow(owner->context(), owner->id(), unordered);
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.status().message().find("out-of-order"), std::string::npos);
    clReleaseCommandQueue(unordered);
  }
}

class Transfer : public ::testing::TestWithParam<std::tuple<PixelFormat, Storage>> {};

TEST_P(Transfer, RoundTripIsBitExact) {
  const auto [format, storage] = GetParam();
  auto device = Device::open();
  ASSERT_TRUE(device.ok());
  const Extent extent = {37, 21};
  auto image = device->allocate(extent, format, storage);
  ASSERT_TRUE(image.ok()) << image.status().message();
  const std::size_t row = extent.width * bytes_per_pixel(format);
  std::vector<std::uint8_t> sent(row * extent.height);
  for (std::size_t i = 0; i < sent.size(); ++i)
    sent[i] = static_cast<std::uint8_t>((i * 37 + 11) & 0x3b);
  ASSERT_TRUE(device->upload(image->view(), extent, sent.data()).ok());
  std::vector<std::uint8_t> back(sent.size());
  ASSERT_TRUE(device->download(image->view(), extent, back.data()).ok());
  EXPECT_EQ(back, sent);
}

INSTANTIATE_TEST_SUITE_P(Formats, Transfer,
                         ::testing::Combine(::testing::Values(PixelFormat::kR8, PixelFormat::kR32F,
                                                              PixelFormat::kRG16F, PixelFormat::kRG32F,
                                                              PixelFormat::kRGBA8, PixelFormat::kRGBA16F,
                                                              PixelFormat::kRGBA32F),
                                            ::testing::Values(Storage::kBuffer, Storage::kImage)),
                         [](const auto& test) {
                           return std::string(name_of(std::get<0>(test.param))) +
                                  (std::get<1>(test.param) == Storage::kImage ? "Image" : "Buffer");
                         });

TEST(Device, CopiesAPartOfAPitchedImageAndNothingElse) {
  auto device = Device::open();
  ASSERT_TRUE(device.ok());
  auto image = device->allocate({8, 4}, PixelFormat::kR8, Storage::kBuffer, 16);
  ASSERT_TRUE(image.ok());
  const std::vector<std::uint8_t> before(8 * 4, 7);
  ASSERT_TRUE(device->upload(image->view(), {8, 4}, before.data()).ok());
  const std::vector<std::uint8_t> part = {1, 2, 3, 4};
  ASSERT_TRUE(device->upload(image->view(), {2, 2}, part.data()).ok());
  std::vector<std::uint8_t> after(8 * 4);
  ASSERT_TRUE(device->download(image->view(), {8, 4}, after.data()).ok());
  std::vector<std::uint8_t> expected = before;
  expected[0] = 1;
  expected[1] = 2;
  expected[8] = 3;
  expected[9] = 4;
  EXPECT_EQ(after, expected);
}

TEST(Device, BadAllocationsAreRefused) {
  auto device = Device::open();
  ASSERT_TRUE(device.ok());
  EXPECT_FALSE(device->allocate({0, 4}, PixelFormat::kR8).ok());
  EXPECT_FALSE(device->allocate({4, 4}, PixelFormat::kNone).ok());
  EXPECT_FALSE(device->allocate({4, 4}, PixelFormat::kRGBA16F, Storage::kBuffer, 24).ok());
  EXPECT_FALSE(device->allocate({4, 4}, PixelFormat::kRGBA16F, Storage::kImage, 64).ok());
  auto image = device->allocate({4, 4}, PixelFormat::kR8);
  ASSERT_TRUE(image.ok());
  std::uint8_t texels[64] = {};
  EXPECT_FALSE(device->upload(image->view(), {5, 4}, texels).ok());
  EXPECT_FALSE(device->download({}, {1, 1}, texels).ok());
}

}  // namespace
}  // namespace quincunx
