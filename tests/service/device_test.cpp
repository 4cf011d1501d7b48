// SPDX-License-Identifier: MIT
// A device: opening, images and transfers; its profile; the cache of its programs.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "../tools/own_cache.h"
#include "device/device_impl.h"
#include "device/program_cache.h"
#include "passes/pass.h"
#include "quincunx/advanced/device_profile.h"
#include "quincunx/device.h"
#include "quincunx/resolve_service.h"
#include "shipped_profile_files.h"

namespace quincunx {
namespace {

namespace fs = std::filesystem;

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

// A number is an index where there is such a device, and a part of a name elsewhere.
TEST(Device, NumbersAreIndicesOrPartsOfNames) {
  std::vector<DeviceInfo> infos;
  const auto add = [&](DeviceKind kind, const char* platform, const char* name) {
    DeviceInfo& info = infos.emplace_back();
    info.kind = kind;
    info.platform = platform;
    info.name = name;
  };
  add(DeviceKind::kGpu, "NVIDIA CUDA", "NVIDIA GeForce RTX 4090");
  add(DeviceKind::kGpu, "AMD", "AMD Radeon RX 7900 XTX");
  add(DeviceKind::kCpu, "Portable Computing Language", "pthread-Ryzen 9");
  const std::vector<std::pair<std::string, std::optional<std::size_t>>> cases = {
      {"", 0},
      {"0", 0},
      {"2", 2},
      {"002", 2},
      {"4090", 0},
      {"7900", 1},
      {"9", 0},
      {"cpu", 2},
      {"GPU", 0},
      {"radeon", 1},
      {"3", {}},
      {"770", {}},
      {"2x", {}},
      {"-1", {}},
      {"RTX 40", 0},
      {"language pthread", 2},
      {"18446744073709551616", {}}};
  for (const auto& [selector, at] : cases)
    EXPECT_EQ(choose_device(selector, infos), at) << selector;
  EXPECT_EQ(choose_device("", {}), std::nullopt);
}

TEST(Device, AnUnknownSelectorListsWhatThereIs) {
  const auto device = Device::open("no such device");
  ASSERT_FALSE(device.ok());
  EXPECT_EQ(device.status().code(), StatusCode::kInvalidArgument);
  EXPECT_NE(device.status().message().find("no such device"), std::string::npos);
  EXPECT_NE(device.status().message().find(Device::list()[0].name), std::string::npos);
}

TEST(Device, MakesEightPixelsAtOnceOnACpuOrAsTheEnvironmentSays) {
  ASSERT_EQ(getenv("QUINCUNX_LANES"), nullptr);
  const Device usual = Device::open().value();
  const bool is_pocl = usual.info().platform == "Portable Computing Language";
  EXPECT_EQ(usual.impl()->lanes, is_pocl && usual.info().kind == DeviceKind::kCpu ? 8 : 1);
  setenv("QUINCUNX_LANES", "1", 1);
  EXPECT_EQ(Device::open().value().impl()->lanes, 1);
  setenv("QUINCUNX_LANES", "4", 1);
  const auto refused = Device::open();
  unsetenv("QUINCUNX_LANES");
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.status().message(), "QUINCUNX_LANES is '4'; it must be 1 or 8");
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

// An assignment lets go what the image held, as its destructor does.
TEST(Image, AssignmentReleasesAtOnce) {
  auto device = Device::open();
  ASSERT_TRUE(device.ok());
  Image kept = device->allocate({4, 4}, PixelFormat::kR8).value();
  Image next = device->allocate({4, 4}, PixelFormat::kR8).value();
  const Image second = Image::borrow(kept.view());
  kept = std::move(next);
  cl_uint count = 0;
  ASSERT_EQ(clGetMemObjectInfo(second.view().memory, CL_MEM_REFERENCE_COUNT, sizeof(count), &count, nullptr),
            CL_SUCCESS);
  EXPECT_EQ(count, 1u);
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

// Some drivers take such rows for tight.
TEST(Device, CopiesAsManyRowsAsARowHasBytes) {
  auto device = Device::open();
  ASSERT_TRUE(device.ok());
  for (const Storage storage : {Storage::kBuffer, Storage::kImage}) {
    constexpr Extent kPart = {29, 64};
    constexpr std::size_t kRow = 64;
    auto image = device->allocate({64, 64}, PixelFormat::kR8, storage);
    ASSERT_TRUE(image.ok()) << image.status().message();
    const std::vector<std::uint8_t> before(kRow * 64, 7);
    ASSERT_TRUE(device->upload(image->view(), {64, 64}, before.data()).ok());
    std::vector<std::uint8_t> sent(kRow * kPart.height);
    for (std::size_t i = 0; i < sent.size(); ++i)
      sent[i] = static_cast<std::uint8_t>(i % 251);
    ASSERT_TRUE(device->upload(image->view(), kPart, sent.data(), kRow).ok());
    std::vector<std::uint8_t> whole(before.size()), part(before.size(), 9);
    ASSERT_TRUE(device->download(image->view(), {64, 64}, whole.data()).ok());
    ASSERT_TRUE(device->download(image->view(), kPart, part.data(), kRow).ok());
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const bool inside = static_cast<int>(i % kRow) < kPart.width;
      ASSERT_EQ(whole[i], inside ? sent[i] : 7) << i;
      ASSERT_EQ(part[i], inside ? sent[i] : 9) << i;
    }
  }
}

TEST(Device, CopiesFromAndToNowhereAreRefused) {
  const Device device = Device::open().value();
  const Image image = device.allocate({4, 2}, PixelFormat::kR32F).value();
  std::vector<float> texels(8);
  const std::string missing = "texels is null; it must point to 4x2 texels of R32F";
  EXPECT_EQ(device.upload(image.view(), {4, 2}, nullptr).message(), missing);
  EXPECT_EQ(device.download(image.view(), {4, 2}, nullptr).message(), missing);
  const std::string narrow = "row_bytes is 12; it must be 0 or at least the 16 of a row";
  EXPECT_EQ(device.upload(image.view(), {4, 2}, texels.data(), 12).message(), narrow);
  EXPECT_EQ(device.download(image.view(), {4, 2}, texels.data(), 12).message(), narrow);
}

TEST(Device, BadAllocationsAreRefused) {
  auto device = Device::open();
  ASSERT_TRUE(device.ok());
  const std::string rule = "; its sides must be at least 1, and its format must not be none";
  EXPECT_EQ(device->allocate({0, 4}, PixelFormat::kR8).status().message(),
            "the image to allocate is 0x4 of format R8" + rule);
  EXPECT_EQ(device->allocate({4, 4}, PixelFormat::kNone).status().message(),
            "the image to allocate is 4x4 of format none" + rule);
  EXPECT_FALSE(device->allocate({4, 4}, PixelFormat::kRGBA16F, Storage::kBuffer, 24).ok());
  EXPECT_FALSE(device->allocate({4, 4}, PixelFormat::kRGBA16F, Storage::kImage, 64).ok());
  auto image = device->allocate({4, 4}, PixelFormat::kR8);
  ASSERT_TRUE(image.ok());
  std::uint8_t texels[64] = {};
  EXPECT_FALSE(device->upload(image->view(), {5, 4}, texels).ok());
  EXPECT_FALSE(device->download({}, {1, 1}, texels).ok());
}

// Device profiles: as files, as what a device is opened with, and that no picture depends on them.

constexpr WorkShape kTile = {.group_width = 8, .group_height = 4, .pixels_per_item = 1};

// A cache of its own, and what is logged.
class DeviceProfiles : public ::testing::Test {
 protected:
  DeviceProfiles()
      : folder_(fs::temp_directory_path() / ("quincunx-profile-test-" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
  }
  ~DeviceProfiles() override { fs::remove_all(folder_); }

  static Device open() { return Device::open().value(); }

  static DeviceProfile tuned() {
    DeviceProfile profile;
    profile.source = ProfileSource::kTuned;
    profile.date = "2026-11-22 21:05 UTC";
    profile.driver = open().info().driver;
    profile.shape = {.group_width = 2, .group_height = 2, .pixels_per_item = 8};
    profile.passes["scale_point"] = kTile;
    return profile;
  }

  static std::string text_of(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  // Returns the warnings of opening the device.
  static std::string warnings_of_opening(DeviceProfile& used) {
    ::testing::internal::CaptureStderr();
    used = open().profile();
    return ::testing::internal::GetCapturedStderr();
  }

  fs::path folder_;
  testing::OwnCache cache_{folder_.string()};
};

TEST_F(DeviceProfiles, WhatWasKeptIsUsedFromThenOn) {
  const DeviceProfile before = open().profile();
  EXPECT_NE(before.source, ProfileSource::kTuned);
  const Status kept = keep_profile(open(), tuned());
  ASSERT_TRUE(kept.ok()) << kept.message();
  const Device device = open();
  EXPECT_EQ(device.profile(), tuned());
  EXPECT_EQ(device.profile().describe(), "tuned 2026-11-22 21:05 UTC");
  EXPECT_EQ(device.profile().shape_of("scale_point"), kTile);
  EXPECT_EQ(device.profile().shape_of("sharpen"), tuned().shape);
  const auto borrowed = Device::borrow(device.context(), device.id(), device.queue());
  ASSERT_TRUE(borrowed.ok());
  EXPECT_EQ(borrowed->profile(), tuned());
  fs::remove(*profile_path(device));
  EXPECT_EQ(open().profile(), before);
}

TEST_F(DeviceProfiles, WithoutACacheFolderNoneIsKept) {
  cache_.use("");
  EXPECT_FALSE(profile_path(open()).has_value());
  const Status kept = keep_profile(open(), tuned());
  EXPECT_EQ(kept.code(), StatusCode::kUnsupported);
  EXPECT_NE(kept.message().find("QUINCUNX_CACHE_DIR"), std::string::npos) << kept.message();
}

TEST_F(DeviceProfiles, AFileThatCannotBeWrittenIsNamed) {
  std::ofstream(folder_) << "a file where the folder would be";
  const Status kept = keep_profile(open(), tuned());
  EXPECT_EQ(kept.code(), StatusCode::kIoFailure);
  EXPECT_NE(kept.message().find(folder_.string()), std::string::npos) << kept.message();
}

TEST_F(DeviceProfiles, ABadFileIsOneSentenceAndPassedOver) {
  const DeviceProfile plain = open().profile();
  ASSERT_TRUE(keep_profile(open(), tuned()).ok());
  const fs::path path = *profile_path(open());
  const std::string good = text_of(path);
  const auto with = [&good](const std::string& what, const std::string& instead) {
    std::string text = good;
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), instead);
  };
  const std::string driver = "\"driver\": \"" + open().info().driver + "\"";
  const struct {
    std::string text, says;
  } bad[] = {{"", "no JSON"},
             {good.substr(0, good.size() / 2), "no JSON"},
             {"[]", "has no quincunx_device_profile"},
             {with("profile\": 1", "profile\": 2"), "reads 1"},
             {with(driver, "\"driver\": \"another\""), "driver 'another'"},
             {with("\"device\": \"", "\"device\": \"not "), "device 'not "},
             {with("\"date\"", "\"day\""), "has no date"},
             {with("\"pixels\": 8", "\"pixels\": -1"), "pixels of shape is -1"},
             {with("\"pixels\": 1", "\"pixels\": 1.5"), "pixels of scale_point is 1.5"},
             {with("\"group\"", "\"groups\""), "shape has no group"},
             {with("\"scale_point\": {", "\"scale_point\": 3, \"sharpen\": {"), "scale_point has no group"}};
  for (const auto& [text, says] : bad) {
    std::ofstream(path, std::ios::trunc) << text;
    DeviceProfile used;
    const std::string warning = warnings_of_opening(used);
    EXPECT_EQ(used, plain) << text;
    EXPECT_NE(warning.find(says), std::string::npos) << text << " -> " << warning;
    EXPECT_NE(warning.find(path.string()), std::string::npos) << warning;
    EXPECT_EQ(std::count(warning.begin(), warning.end(), '\n'), 1) << warning;
  }
}

TEST_F(DeviceProfiles, SidesOfAGroupHaveTheirRange) {
  for (const int side : {0, -3, WorkShape::kMostOfGroup + 1, 1, WorkShape::kMostOfGroup}) {
    DeviceProfile profile = tuned();
    profile.shape.group_width = side;
    const bool fits = side >= 1 && side <= WorkShape::kMostOfGroup;
    EXPECT_EQ(parse_profile(profile_text({owner_of(open().info()), profile})).ok(), fits) << side;
  }
}

TEST(WorkShapes, AGroupIsHalvedUntilItFits) {
  const auto halved = [](int width, int height, std::size_t most) {
    const WorkShape shape =
        with_smaller_group({.group_width = width, .group_height = height, .pixels_per_item = 3}, most);
    EXPECT_EQ(shape.pixels_per_item, 3);
    return std::pair(shape.group_width, shape.group_height);
  };
  EXPECT_EQ(halved(16, 8, 128), std::pair(16, 8));
  EXPECT_EQ(halved(16, 8, 127), std::pair(8, 8));
  EXPECT_EQ(halved(16, 8, 32), std::pair(8, 4));
  EXPECT_EQ(halved(1, 1024, 256), std::pair(1, 256));
  EXPECT_EQ(halved(3, 5, 1), std::pair(1, 1));
  EXPECT_EQ(halved(1, 1, 0), std::pair(1, 1));
}

TEST(ShippedProfiles, AreWholeAndOneForEachPlatformAndKind) {
  std::vector<std::string> seen;
  for (const EmbeddedFile& shipped : shipped_profile_files()) {
    const auto file = parse_profile(std::string(shipped.text));
    ASSERT_TRUE(file.ok()) << shipped.name << ": " << file.status().message();
    EXPECT_FALSE(file.value().profile.passes.empty()) << shipped.name;
    seen.push_back(file.value().owner.platform + "/" + file.value().owner.kind);
  }
  EXPECT_FALSE(seen.empty());
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(std::adjacent_find(seen.begin(), seen.end()), seen.end());
}

// Frames of a service that has most kinds of passes, as bits of the last presented picture and of the history.
std::vector<unsigned char> pictures_with(const Device& device, const DeviceProfile& profile, Method method) {
  constexpr Extent kRender = {83, 41}, kOutput = {131, 67};
  ResolveSettings settings{.method = method, .output_extent = kOutput, .target_extent = kRender};
  settings.quincunx.form = TwoFrameForm::kReprojected;
  settings.sharpness = 0.5f;
  settings.blur.shutter = 0.5f;
  settings.conventions.sky_motion = SkyMotion::kEvidence;
  const ResolvePlan plan = plan_for({.moving_objects = true, .transparents = true}, settings).value();
  const Device own = device.with_profile(profile);
  ResolveService service = ResolveService::create(own, plan).value();
  std::mt19937 random(1);
  const auto filled = [&](PixelFormat format, std::uint16_t least, std::uint16_t span) {
    Image image = own.allocate(kRender, format).value();
    std::vector<std::uint16_t> bits(static_cast<std::size_t>(kRender.area()) * bytes_per_pixel(format) / 2 +
                                    1);
    for (std::uint16_t& word : bits)
      word = static_cast<std::uint16_t>(least + random() % span);
    EXPECT_TRUE(own.upload(image.view(), kRender, bits.data()).ok());
    return image;
  };
  struct Frame {
    Image colour, velocity, depth, reactive;
  };
  std::vector<Frame> frames;  // kept: the next frame may read them
  for (int i = 0; i < 4; ++i) {
    frames.push_back({filled(settings.colour, 0x3400, 0x800), filled(settings.velocity, 0x1c00, 0x400),
                      filled(PixelFormat::kR32F, 0x3e00, 0x100), filled(PixelFormat::kR8, 0, 0x100)});
  }
  const Image linear = own.allocate(kOutput, settings.output.linear).value();
  const Image presented = own.allocate(kOutput, PixelFormat::kRGBA8).value();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FrameReport report = service.dispatch({.colour = frames[i].colour.view(),
                                                 .depth = frames[i].depth.view(),
                                                 .velocity = frames[i].velocity.view(),
                                                 .reactive = frames[i].reactive.view(),
                                                 .render_extent = kRender,
                                                 .jitter = {0.25f, i % 2 == 0 ? 0.25f : -0.25f},
                                                 .frame_index = i},
                                                {linear.view(), presented.view()});
    EXPECT_TRUE(report.ok()) << report.status.message();
  }
  std::vector<unsigned char> bytes(static_cast<std::size_t>(kOutput.area()) * 20);
  EXPECT_TRUE(own.download(linear.view(), kOutput, bytes.data()).ok());
  EXPECT_TRUE(own.download(presented.view(), kOutput, bytes.data() + kOutput.area() * 16).ok());
  return bytes;
}

TEST(WorkShapes, NoBitOfAPictureDependsOnThem) {
  const Device device = Device::open().value();
  std::vector<DeviceProfile> profiles(4);
  profiles[0].shape = {.group_width = 1, .group_height = 4, .pixels_per_item = 0};
  profiles[1].shape = {.group_width = 16, .group_height = 8, .pixels_per_item = 1};
  profiles[2].shape = {.group_width = 3, .group_height = 2, .pixels_per_item = 24};
  profiles[3].shape = {.group_width = 1, .group_height = 1, .pixels_per_item = 0};
  profiles[3].passes["present"] = kTile;
  profiles[3].passes["temporal_display"] = kTile;
  for (const Method method : {Method::kBilinear, Method::kLanczos2, Method::kQuincunx, Method::kTemporal}) {
    const auto expected = pictures_with(device, profiles[0], method);
    for (std::size_t i = 1; i < profiles.size(); ++i)
      EXPECT_EQ(pictures_with(device, profiles[i], method), expected) << name_of(method) << ", profile " << i;
  }
}

// The cache of compiled programs.

constexpr const char* kKernel = "scale_point";
constexpr const char* kOptions = "-D SOURCE_STORAGE=BUFFER -D SOURCE_FORMAT=HALF -D OUTPUT_FORMAT=FLOAT";

class ProgramCache : public ::testing::Test {
 protected:
  ProgramCache() : folder_(fs::temp_directory_path() / ("quincunx-cache-test-" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
  }
  ~ProgramCache() override { fs::remove_all(folder_); }

  std::vector<fs::path> entries() const {
    std::vector<fs::path> found;
    if (!fs::exists(folder_)) return found;
    for (const auto& entry : fs::directory_iterator(folder_))
      found.push_back(entry.path());
    return found;
  }

  // Returns the counts of one build on a device that has no programs yet: {compiled, loaded}.
  CacheCounts build(const std::string& options = kOptions) const {
    Device::Impl anew = impl_;
    anew.built = std::make_shared<BuiltPrograms>();
    return build_on(anew, options);
  }

  static CacheCounts build_on(const Device::Impl& impl, const std::string& options = kOptions) {
    const CacheCounts before = cache_counts();
    EXPECT_NE(build_kernel(impl, kKernel, options)(), nullptr);
    const CacheCounts after = cache_counts();
    return {after.compiled - before.compiled, after.loaded - before.loaded};
  }

  fs::path folder_;
  testing::OwnCache cache_{folder_.string()};
  Device device_ = Device::open().value();
  Device::Impl impl_ = keeping_no_programs();

 private:
  Device::Impl keeping_no_programs() const {
    Device::Impl impl = *device_.impl();
    impl.keeps_programs = false;
    return impl;
  }
};

TEST_F(ProgramCache, CompilesOnceThenLoads) {
  const CacheCounts first = build();
  EXPECT_EQ(first.compiled, 1);
  EXPECT_EQ(first.loaded, 0);
  ASSERT_EQ(entries().size(), 1u);
  const CacheCounts second = build();
  EXPECT_EQ(second.compiled, 0);
  EXPECT_EQ(second.loaded, 1);
}

TEST_F(ProgramCache, ADeviceBuildsAProgramOnce) {
  cache_.use("");
  EXPECT_EQ(build_on(impl_).compiled, 1);
  const CacheCounts again = build_on(impl_);
  EXPECT_EQ(again.compiled + again.loaded, 0);
  EXPECT_EQ(build_on(*device_.with_profile(device_.profile()).impl()).compiled, 0)
      << "its context is the same";
  EXPECT_NE(build_kernel(impl_, kKernel, kOptions)(), build_kernel(impl_, kKernel, kOptions)())
      << "own arguments";
}

TEST_F(ProgramCache, OtherOptionsAreAnotherEntry) {
  build();
  EXPECT_EQ(build("-D SOURCE_STORAGE=BUFFER -D SOURCE_FORMAT=FLOAT -D OUTPUT_FORMAT=FLOAT").compiled, 1);
  EXPECT_EQ(entries().size(), 2u);
}

TEST_F(ProgramCache, ADamagedEntryIsRebuiltAndReplaced) {
  build();
  const fs::path entry = entries().at(0);
  const auto size = fs::file_size(entry);
  for (const std::uintmax_t kept : {std::uintmax_t{0}, std::uintmax_t{10}, size / 2}) {
    fs::resize_file(entry, kept);
    EXPECT_EQ(build().compiled, 1) << "cut to " << kept;
    EXPECT_EQ(fs::file_size(entry), size);
    EXPECT_EQ(build().loaded, 1);
  }
  {
    std::fstream file(entry, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(size / 2));
    file.write("damage", 6);
  }
  EXPECT_EQ(build().compiled, 1);
}

TEST_F(ProgramCache, AFolderThatCannotBeWrittenOnlyCostsTime) {
  const fs::path file = folder_.string() + "-file";
  std::ofstream(file) << "not a folder";
  cache_.use((file / "below").string());
  EXPECT_EQ(build().compiled, 1);
  EXPECT_EQ(build().compiled, 1);
  fs::remove(file);
}

TEST_F(ProgramCache, AnEmptyNameTurnsItOff) {
  cache_.use("");
  EXPECT_EQ(build().compiled, 1);
  EXPECT_EQ(build().compiled, 1);
  EXPECT_TRUE(entries().empty());
}

TEST_F(ProgramCache, ADriverThatKeepsItsProgramsGetsTheSource) {
  impl_.keeps_programs = true;
  EXPECT_EQ(build().compiled, 1);
  EXPECT_EQ(build().compiled, 1);
  EXPECT_TRUE(entries().empty());
}

TEST_F(ProgramCache, ABuildFailureShowsKernelOptionsAndLog) {
  try {
    build("-D SOURCE_FORMAT=NONSENSE");
    FAIL() << "a misspelt option must not compile";
  } catch (const BuildError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find(kKernel), std::string::npos);
    EXPECT_NE(text.find("NONSENSE"), std::string::npos);
    EXPECT_NE(text.find("SOURCE_FORMAT must be"), std::string::npos) << text;
  }
}

TEST(KernelSource, ExpandsEachIncludeOnce) {
  const std::string source = kernel_source("resolve_quincunx");
  EXPECT_EQ(source.find("#include"), std::string::npos);
  const std::string guard = "typedef struct TexelLayout {";
  ASSERT_NE(source.find(guard), std::string::npos);
  EXPECT_EQ(source.find(guard), source.rfind(guard));
  EXPECT_THROW(kernel_source("no_such_kernel"), std::out_of_range);
}

}  // namespace

}  // namespace quincunx
