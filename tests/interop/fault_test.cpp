// SPDX-License-Identifier: MIT
// A device that fails under the copying bridge or the service: a Status in words, no exception. Each call of OpenCL
// that may fail does so in turn.
#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cl_faults.h"
#include "cl_imports.h"
#include "cl_interposer.h"
#include "gl_semaphores.h"
#include "host_copy.h"
#include "interop_fixture.h"
#include "quincunx/advanced/extent.h"
#include "quincunx/advanced/log.h"
#include "quincunx/quincunx.h"
#include "quincunx/resolve_service.h"
#include "quincunx/status.h"
#include "skip.h"

namespace quincunx::gl::testing {
namespace {

constexpr Extent kOutput = {24, 16};
constexpr Extent kRender = {17, 11};
constexpr int kMoreThanAnyCalls = 2000;

// One sentence: what was called, on which device, what it said.
void expect_told(const Status& status, const char* code) {
  EXPECT_EQ(status.code(), StatusCode::kDeviceFailure) << status.message();
  EXPECT_NE(status.message().find(code), std::string::npos) << status.message();
  EXPECT_EQ(status.message().find('\n'), std::string::npos) << status.message();
}

// A cache of its own: what a failing device answers must not stay in the user's.
class DeviceFault : public ::testing::Test {
 protected:
  DeviceFault()
      : folder_(std::filesystem::temp_directory_path() /
                ("quincunx-fault-test-" + std::to_string(getpid()))) {
    if (const char* before = std::getenv("QUINCUNX_CACHE_DIR")) before_ = before;
    setenv("QUINCUNX_CACHE_DIR", folder_.c_str(), 1);
  }
  ~DeviceFault() override {
    clear_cache();
    if (before_) {
      setenv("QUINCUNX_CACHE_DIR", before_->c_str(), 1);
    } else {
      unsetenv("QUINCUNX_CACHE_DIR");
    }
  }

  bool cache_is_empty() const { return !std::filesystem::exists(folder_); }

  void clear_cache() const {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

 private:
  std::filesystem::path folder_;
  std::optional<std::string> before_;
};

// A broken driver beside good ones: they are found as ever, and no call throws.
TEST_F(DeviceFault, ABrokenDriverLeavesTheOthers) {
  using Flaw = PretendBrokenDriver::Flaw;
  const std::vector<DeviceInfo> sound = Device::list();
  for (const Flaw flaw : {Flaw::kNoDevices, Flaw::kMuteDevice, Flaw::kMuteButForItsKind}) {
    std::vector<std::string> lines;
    set_log([&](LogLevel level, const std::string& line) {
      if (level == LogLevel::kWarning) lines.push_back(line);
    });
    const PretendBrokenDriver driver(flaw);
    const std::vector<DeviceInfo> found = Device::list();
    ASSERT_EQ(found.size(), sound.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].index, static_cast<int>(i));
      EXPECT_EQ(found[i].name, sound[i].name);
    }
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_NE(lines.front().find("is left out"), std::string::npos) << lines.front();
    EXPECT_NE(lines.front().find("CL_OUT_OF_HOST_MEMORY"), std::string::npos) << lines.front();
    const auto opened = Device::open();
    ASSERT_TRUE(opened.ok()) << opened.status().message();
    EXPECT_EQ(opened->info().name, sound.front().name);
    quincunx_device* device = nullptr;
    EXPECT_EQ(quincunx_device_open(nullptr, &device), QUINCUNX_OK) << quincunx_last_error();
    quincunx_device_destroy(device);
    EXPECT_FALSE(Device::open("no such device").ok());
    set_log({});
  }
}

TEST_F(DeviceFault, ALoaderThatFailsMeansNoDevice) {
  set_log([](LogLevel, const std::string&) {});
  const PretendBrokenDriver driver(PretendBrokenDriver::Flaw::kNoPlatforms);
  EXPECT_TRUE(Device::list().empty());
  EXPECT_EQ(Device::open().status().code(), StatusCode::kUnsupported);
  set_log({});
}

// The copying bridge, in both of its forms.
class FaultyBridge : public InteropTest {};

TEST_F(FaultyBridge, CreationFailsInWords) {
  BridgeSettings settings = all_planes(kRender, kOutput);
  settings.interop = Interop::kCopy;
  for (int at = 0; at < kMoreThanAnyCalls; ++at) {
    const PretendFault fault(at, CL_OUT_OF_RESOURCES);
    const auto bridge = Bridge::create(*context_, *device_, settings);
    if (!fault.struck()) {
      EXPECT_TRUE(bridge.ok()) << bridge.status().message();
      EXPECT_GT(at, 3) << "the calls of a creation are seen";
      return;
    }
    ASSERT_FALSE(bridge.ok()) << at;
    expect_told(bridge.status(), "CL_OUT_OF_RESOURCES");
  }
  FAIL() << "every bridge met the fault";
}

// The first call of a frame's life that fails.
Status carry(Bridge& bridge) {
  if (auto targets = bridge.begin_draw(0, kRender); !targets.ok()) return targets.status();
  if (Status status = bridge.submit(0); !status.ok()) return status;
  if (auto frame = bridge.acquire(0); !frame.ok()) return frame.status();
  if (auto picture = bridge.begin_present(); !picture.ok()) return picture.status();
  return bridge.present();
}

TEST_F(FaultyBridge, AFrameFailsInWordsInBothForms) {
  for (const Transfer transfer : transfers()) {
    int at = 0;
    for (bool struck = true; struck; ++at) {
      ASSERT_LT(at, kMoreThanAnyCalls);
      HostCopy bridge(*device_, all_planes(kRender, kOutput), "a test", transfer);
      ASSERT_TRUE(carry(bridge).ok());
      const PretendFault fault(at, CL_OUT_OF_RESOURCES);
      const Status status = carry(bridge);
      struck = fault.struck();
      if (struck) expect_told(status, "CL_OUT_OF_RESOURCES");
      if (!struck) {
        EXPECT_TRUE(status.ok()) << status.message();
      }
    }
    EXPECT_GT(at, 3) << "the calls of a frame are seen";
  }
}

// The same by memory that a stand-in imports, ordered by the device and by the host.
TEST_F(FaultyBridge, ExternalMemoryFailsInWords) {
  if (!has_vulkan() || !PretendSemaphores::works()) QUINCUNX_SKIP("there is no stand-in without lavapipe");
  set_log([](LogLevel, const std::string&) {});  // semaphores that are left out
  const PretendImports driver;
  const PretendSemaphores semaphores;
  device_ = std::make_unique<Device>(open_device(*context_, "", Interop::kCopy).value());
  BridgeSettings settings = all_planes(kRender, kOutput);
  settings.interop = Interop::kExternal;
  int at = 0;
  for (bool struck = true; struck; ++at) {
    ASSERT_LT(at, kMoreThanAnyCalls);
    const PretendFault fault(at, CL_OUT_OF_RESOURCES);
    const auto bridge = Bridge::create(*context_, *device_, settings);
    struck = fault.struck();
    if (bridge.ok()) continue;  // without semaphores, where those failed
    EXPECT_NE(bridge.status().message().find("CL_OUT_OF_RESOURCES"), std::string::npos)
        << bridge.status().message();
  }
  EXPECT_GT(at, 20) << "the calls of a creation are seen";
  at = 0;
  for (bool struck = true; struck; ++at) {
    ASSERT_LT(at, kMoreThanAnyCalls);
    const auto bridge = Bridge::create(*context_, *device_, settings);
    ASSERT_TRUE(bridge.ok()) << bridge.status().message();
    ASSERT_TRUE(carry(*bridge.value()).ok());
    const PretendFault fault(at, CL_OUT_OF_RESOURCES);
    const Status status = carry(*bridge.value());
    struck = fault.struck();
    if (struck) expect_told(status, "CL_OUT_OF_RESOURCES");
    if (!struck) {
      EXPECT_TRUE(status.ok()) << status.message();
    }
  }
  EXPECT_GT(at, 3) << "the calls of a frame are seen";
  set_log({});
}

// A device that fails under the service: a Status in words, no exception, and later frames are right.

constexpr cl_int kLost = CL_DEVICE_NOT_AVAILABLE;
constexpr auto kForGood = PretendFault::Lasts::kForGood;

// A service with two frames of its own and somewhere to put the picture.
class FaultyService : public DeviceFault {
 protected:
  FaultyService() : device_(Device::open().value()) {
    ResolveSettings settings{.method = Method::kQuincunx, .output_extent = kOutput, .target_extent = kRender};
    settings.quincunx.form = TwoFrameForm::kReprojected;
    settings.blur.shutter = 0.5f;
    settings.sharpness = 0.5f;
    plan_ = plan_for({.moving_objects = true, .transparents = false}, settings).value();
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      frames_[i].colour = filled(settings.colour, static_cast<std::uint32_t>(i + 1));
      frames_[i].velocity = filled(settings.velocity, static_cast<std::uint32_t>(i + 3));
      frames_[i].depth = filled(PixelFormat::kR32F, static_cast<std::uint32_t>(i + 5));
    }
    linear_ = device_.allocate(kOutput, settings.output.linear).value();
    presented_ = device_.allocate(kOutput, PixelFormat::kRGBA8).value();
  }

  ResolveService service() const { return ResolveService::create(device_, plan_).value(); }

  FrameReport dispatch(ResolveService& service, std::size_t frame) const {
    const Frame& images = frames_[frame];
    return service.dispatch({.colour = images.colour.view(),
                             .depth = images.depth.view(),
                             .velocity = images.velocity.view(),
                             .render_extent = kRender},
                            {linear_.view(), presented_.view()});
  }

  Bytes picture() const {
    Bytes bytes(static_cast<std::size_t>(kOutput.area()) * bytes_per_pixel(PixelFormat::kRGBA8));
    EXPECT_TRUE(device_.download(presented_.view(), kOutput, bytes.data()).ok());
    return bytes;
  }

  const Device& device() const { return device_; }
  const ResolvePlan& plan() const { return plan_; }

 private:
  struct Frame {
    Image colour, velocity, depth;
  };

  Image filled(PixelFormat format, std::uint32_t seed) const {
    Image image = device_.allocate(kRender, format).value();
    EXPECT_TRUE(device_.upload(image.view(), kRender, finite_texels(format, kRender, seed).data()).ok());
    return image;
  }

  Device device_;
  ResolvePlan plan_;
  std::array<Frame, 2> frames_;
  Image linear_, presented_;
};

TEST_F(FaultyService, CreationFailsInWordsOrFindsAnotherWay) {
  (void)service();  // kernels are in the cache from here on
  for (int at = 0; at < kMoreThanAnyCalls; ++at) {
    const PretendFault fault(at, CL_MEM_OBJECT_ALLOCATION_FAILURE);
    const auto created = ResolveService::create(device(), plan());
    if (!created.ok()) expect_told(created.status(), "CL_MEM_OBJECT_ALLOCATION_FAILURE");
    if (fault.struck()) continue;
    EXPECT_TRUE(created.ok()) << created.status().message();
    EXPECT_GT(at, 50) << "the calls of a creation are seen";
    return;
  }
  FAIL() << "every creation met the fault";
}

// Tables are copied from host memory, and a service that is lost while it is created frees its own at once.
TEST_F(FaultyService, ALostDeviceStillFindsTheTablesOfACreationThatFailed) {
  (void)service();           // kernels are in the cache from here on
  mallopt(M_PERTURB, 0xa5);  // memory that is freed holds something else
  bool had_copies = false;
  for (int at = 0; at < kMoreThanAnyCalls; ++at) {
    const PretendLateCopies late;
    bool struck = false;
    {
      const PretendFault fault(at, kLost, kForGood);
      (void)ResolveService::create(device(), plan());
      struck = fault.struck();
    }
    had_copies |= late.count() > 0;
    ASSERT_TRUE(late.copied_what_was_given()) << "after call " << at;
    if (!struck) break;
  }
  mallopt(M_PERTURB, 0);
  EXPECT_TRUE(had_copies);
}

// A table that did not reach the device is not taken for one that is there.
TEST_F(FaultyService, AFirstFrameThatFailsLeavesNoTablesBehind) {
  const auto first_picture = [this](ResolveService& service) {
    const FrameReport report = dispatch(service, 1);
    EXPECT_TRUE(report.ok()) << report.status.message();
    return picture();
  };
  ResolveService good = service();
  const Bytes expected = first_picture(good);
  for (int at = 0; at < kMoreThanAnyCalls; ++at) {
    ResolveService service = this->service();
    bool struck = false;
    {
      const PretendFault fault(at, CL_OUT_OF_RESOURCES);
      (void)dispatch(service, 1);
      struck = fault.struck();
    }
    if (!struck) {
      EXPECT_GT(at, 20) << "the calls of a frame are seen";
      return;
    }
    ASSERT_EQ(first_picture(service), expected) << "after call " << at;
  }
  FAIL() << "every frame met the fault";
}

TEST_F(FaultyService, AFrameThatFailsLeavesNothingToTheNext) {
  ResolveService good = service();
  const FrameReport first = dispatch(good, 1);
  ASSERT_TRUE(first.ok()) << first.status.message();
  const Bytes expected = picture();

  ResolveService service = this->service();
  for (int at = 0; at < kMoreThanAnyCalls; ++at) {
    ASSERT_TRUE(dispatch(service, 0).ok()) << at;
    bool struck = false;
    {
      const PretendFault fault(at, CL_OUT_OF_RESOURCES);
      const FrameReport report = dispatch(service, 1);
      struck = fault.struck();
      if (struck) expect_told(report.status, "CL_OUT_OF_RESOURCES");
    }
    if (!struck) {
      EXPECT_GT(at, 20) << "the calls of a frame are seen";
      return;
    }
    const FrameReport next = dispatch(service, 1);
    ASSERT_TRUE(next.ok()) << next.status.message();
    EXPECT_FALSE(next.used_previous);
    ASSERT_EQ(picture(), expected) << "after call " << at;
    while (service.next_completed()) {
    }
  }
  FAIL() << "every frame met the fault";
}

TEST_F(FaultyService, ReportsThatCannotBeAskedForSayWhy) {
  ResolveService service = this->service();
  for (const std::size_t frame : {0, 1, 0})
    ASSERT_TRUE(dispatch(service, frame).ok());
  const PretendFault fault(0, kLost, kForGood);
  for (int i = 0; i < 3; ++i) {
    const auto report = service.next_completed();
    ASSERT_TRUE(report.has_value());
    expect_told(report->status, "CL_DEVICE_NOT_AVAILABLE");
  }
  EXPECT_FALSE(service.next_completed().has_value());
}

TEST_F(FaultyService, ALostDeviceIsToldByEveryCall) {
  ResolveService service = this->service();
  ASSERT_TRUE(dispatch(service, 0).ok());
  const PretendFault fault(0, kLost, kForGood);
  for (std::size_t frame = 0; frame < 100; ++frame)  // more than the service keeps reports of
    expect_told(dispatch(service, (frame + 1) % 2).status, "CL_DEVICE_NOT_AVAILABLE");
  expect_told(service.finish(), "CL_DEVICE_NOT_AVAILABLE");
  expect_told(ResolveService::create(device(), plan()).status(), "CL_DEVICE_NOT_AVAILABLE");
  expect_told(device().allocate(kOutput, PixelFormat::kRGBA16F).status(), "CL_DEVICE_NOT_AVAILABLE");
}  // the service is destroyed while the device is gone

TEST_F(DeviceFault, OpeningFailsInWordsAndKeepsNoAnswerOfAFailure) {
  for (int at = 0; at < kMoreThanAnyCalls; ++at) {
    const PretendFault fault(at, CL_OUT_OF_HOST_MEMORY);
    const auto opened = Device::open();
    if (!opened.ok()) expect_told(opened.status(), "CL_OUT_OF_HOST_MEMORY");
    if (!fault.struck()) {
      EXPECT_GT(at, 8) << "the calls of an opening are seen";
      EXPECT_FALSE(cache_is_empty()) << "which clock to use is kept";
      return;
    }
    ASSERT_TRUE(cache_is_empty()) << "what the device answered after call " << at << " failed was kept";
  }
  FAIL() << "every device met the fault";
}

}  // namespace

}  // namespace quincunx::gl::testing
