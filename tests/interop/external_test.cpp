// SPDX-License-Identifier: MIT
// Memory of Vulkan's between OpenGL and OpenCL. On a processor lavapipe allocates it, llvmpipe imports it, and PoCL
// uses the pointer at which it is mapped; a stand-in for PoCL's driver imports fds, too.
#include "external_memory.h"

#include <dirent.h>
#include <epoxy/egl.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <optional>

#include "cl_imports.h"
#include "cl_interposer.h"
#include "gl_call_counter.h"
#include "gl_semaphores.h"
#include "interop_fixture.h"
#include "quincunx/advanced/log.h"
#include "quincunx/resolve_service.h"
#include "skip.h"

namespace quincunx {
extern std::atomic<int> longest_wait_ms;  // device_impl.h
}

namespace quincunx::gl::testing {
namespace {

using Flaw = PretendImports::Flaw;

constexpr Extent kTarget = {96, 80};
constexpr Extent kOutput = {64, 48};

int open_fds() {
  int count = 0;
  DIR* const folder = opendir("/proc/self/fd");
  while (readdir(folder) != nullptr)
    ++count;
  closedir(folder);
  return count;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class External : public InteropTest {
 protected:
  // Whether this machine has what it takes; a driver that lies is no excuse.
  void SetUp() override {
    InteropTest::SetUp();
    try {
      vulkan_ = &VulkanDevice::open(gl_device_uuid());
    } catch (const InteropError& error) {
      QUINCUNX_SKIP(error.what());
    }
  }

  // A device as a stand-in has it.
  void reopen() {
    auto device = open_device(*context_, "", Interop::kCopy);
    ASSERT_TRUE(device.ok()) << device.status().message();
    device_ = std::make_unique<Device>(std::move(device).value());
  }

  static BridgeSettings settings(Interop interop) {
    BridgeSettings made = all_planes(kTarget, kOutput);
    made.interop = interop;
    return made;
  }

  std::unique_ptr<Bridge> bridge(const BridgeSettings& settings) {
    auto made = Bridge::create(*context_, *device_, settings);
    EXPECT_TRUE(made.ok()) << made.status().message();
    return made.ok() ? std::move(made).value() : nullptr;
  }

  std::vector<Bytes> pictures(const BridgeSettings& settings, int frames);

  const VulkanDevice* vulkan_ = nullptr;
};

// The pictures of frames of changing size, over all slots, each with a viewport of its own.
std::vector<Bytes> External::pictures(const BridgeSettings& settings, int frames) {
  const auto bridge = this->bridge(settings);
  std::vector<Bytes> made;
  if (bridge == nullptr) return made;
  EXPECT_EQ(bridge->kind(), settings.interop);
  const ResolvePlan plan = plan_for({}, {.method = Method::kQuincunx,
                                         .output_extent = kOutput,
                                         .target_extent = kTarget,
                                         .colour = settings.colour,
                                         .targets = {.placement = settings.targets}})
                               .value();
  ResolveService service = ResolveService::create(*device_, plan).value();
  for (int frame = 0; frame < frames; ++frame) {
    const int slot = frame % bridge->slots();
    const Extent render = {kTarget.width - 5 * (frame % 9), 20 + 7 * (frame % 8)};
    auto targets = bridge->begin_draw(slot, render);
    EXPECT_TRUE(targets.ok()) << targets.status().message();
    for (const Plane& plane : planes_of(settings)) {
      const auto seed = static_cast<std::uint32_t>(10 * frame + static_cast<int>(plane.kind));
      fill_plane(*targets.value(), plane, finite_texels(plane.format, targets.value()->extent(), seed));
    }
    EXPECT_TRUE(bridge->submit(slot).ok());
    const auto inputs = bridge->acquire(slot);
    EXPECT_TRUE(inputs.ok()) << inputs.status().message();
    const auto presented = bridge->begin_present();
    EXPECT_TRUE(presented.ok()) << presented.status().message();
    const FrameReport report = service.dispatch(inputs_of(*inputs, render), {.presented = presented.value()});
    EXPECT_TRUE(report.ok()) << report.status.message();
    const Status status = bridge->present();
    EXPECT_TRUE(status.ok()) << status.message();
    const std::uint8_t* const pixels = bridge->presented_pixels();
    made.emplace_back(pixels, pixels + kOutput.area() * 4);
    Bytes texture(made.back().size());
    glGetTextureImage(bridge->presented_texture(), 0, GL_RGBA, GL_UNSIGNED_BYTE,
                      static_cast<GLsizei>(texture.size()), texture.data());
    EXPECT_TRUE(texture == made.back()) << "OpenGL's picture is the caller's";
  }
  return made;
}

constexpr int kFrames = 24;

TEST_F(External, FramesHaveTheBitsOfCopies) {
  const std::vector<Bytes> copied = pictures(settings(Interop::kCopy), kFrames);
  EXPECT_FALSE(copied[1] == copied[2]) << "the frames differ";
  EXPECT_TRUE(pictures(settings(Interop::kExternal), kFrames) == copied);
}

TEST_F(External, PlacedFramesHaveTheBitsOfCopies) {
  BridgeSettings placed = settings(Interop::kCopy);
  placed.targets = Targets::kPlaced;
  const std::vector<Bytes> copied = pictures(placed, kFrames);
  placed.interop = Interop::kExternal;
  EXPECT_TRUE(pictures(placed, kFrames) == copied);
}

TEST_F(External, EncodedFramesHaveTheBitsOfCopies) {
  BridgeSettings encoded = settings(Interop::kCopy);
  encoded.colour = PixelFormat::kRGBA8;
  const std::vector<Bytes> copied = pictures(encoded, kFrames);
  encoded.interop = Interop::kExternal;
  EXPECT_TRUE(pictures(encoded, kFrames) == copied);
}

TEST_F(External, NothingIsLeftOpen) {
  bridge(settings(Interop::kExternal)).reset();  // drivers keep some files from their first use on
  const int before = open_fds();
  for (int i = 0; i < 3; ++i)
    bridge(settings(Interop::kExternal)).reset();
  EXPECT_EQ(open_fds(), before);
}

// With an instance of Vulkan's, or its device, NVIDIA's driver ends EGL's display; the stand-in does so, too.
TEST_F(External, TheContextOutlivesTheBridge) {
  for (int i = 0; i < 2; ++i)
    bridge(settings(Interop::kExternal)).reset();
  EXPECT_EQ(eglGetCurrentContext(), context_->context());
}

// A CPU's copies are in place already.
TEST_F(External, AutoTakesItWhereItGains) {
  BridgeSettings any = settings(Interop::kAuto);
  EXPECT_EQ(bridge(any)->kind(), device_->info().imports_opaque_fds ? Interop::kExternal : Interop::kCopy);
}

// The same by fds, on a driver of its own memory.
class ExternalFds : public External {
 protected:
  void SetUp() override {
    External::SetUp();
    if (device_ != nullptr && device_->info().kind != DeviceKind::kCpu)
      QUINCUNX_SKIP("the stand-in is a processor's OpenCL");
  }

  // What an import by a driver of this flaw says.
  Status refusal(Flaw flaw, ExternalMemory external) {
    const PretendImports driver(flaw);
    reopen();
    auto imported = device_->import_memory(external);
    EXPECT_FALSE(imported.ok());
    return imported.status();
  }
};

TEST_F(ExternalFds, FramesHaveTheBitsOfCopies) {
  const std::vector<Bytes> copied = pictures(settings(Interop::kCopy), kFrames);
  const PretendSeparateMemory separate;
  const PretendImports driver;
  reopen();
  ASSERT_TRUE(device_->info().imports_opaque_fds);
  EXPECT_EQ(bridge(settings(Interop::kAuto))->kind(), Interop::kExternal);
  EXPECT_TRUE(pictures(settings(Interop::kExternal), kFrames) == copied);
  BridgeSettings encoded = settings(Interop::kCopy);
  encoded.colour = PixelFormat::kRGBA8;
  const std::vector<Bytes> codes = pictures(encoded, kFrames);
  encoded.interop = Interop::kExternal;
  EXPECT_TRUE(pictures(encoded, kFrames) == codes);
  const int before = open_fds();
  bridge(settings(Interop::kExternal)).reset();
  EXPECT_EQ(open_fds(), before);
}

// A texture of the caller's. Depth has no denormals, which a shader may flush.
Texture texture_with(const Plane& plane, GLenum internal, bool immutable, Bytes* texels) {
  const bool is_depth = plane.kind == PlaneKind::kDepth;
  for (std::size_t i = 0; is_depth && i < texels->size(); i += 4) {
    if ((*texels)[i + 3] == 0) std::memset(&(*texels)[i], 0, 4);
  }
  const GlFormat names = gl_format(plane.format);
  const GLenum format = is_depth ? GLenum{GL_DEPTH_COMPONENT} : names.format;
  Texture made = Texture::create();
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  if (immutable) {
    texture_storage(made.get(), 1, internal, kTarget);
    texture_write(made.get(), 0, kTarget, format, names.type, texels->data());
  } else {
    const BindingScope bound = BindingScope::texture(made.get());
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal), kTarget.width, kTarget.height, 0, format,
                 names.type, texels->data());
  }
  return made;
}

// Shaders copy immutable textures of the caller's, pixel transfers all others: to the same bits.
TEST_F(ExternalFds, ImportedTexturesArriveByteForByte) {
  const PretendSeparateMemory separate;
  const PretendImports driver;
  reopen();
  using enum PixelFormat;
  struct Case {
    PixelFormat colour, velocity;
    GLenum internal;
    bool immutable;
  };
  for (const Case& c :
       {Case{kRGBA16F, kRG16F, GL_RGBA16F, true}, Case{kRGBA32F, kRG32F, GL_RGBA32F, true},
        Case{kRGBA8, kRG16F, GL_SRGB8_ALPHA8, true}, Case{kRGBA16F, kRG16F, GL_RGBA16F, false}}) {
    BridgeSettings wanted = settings(Interop::kExternal);
    wanted.imports = true;
    wanted.colour = c.colour;
    wanted.velocity_format = c.velocity;
    const auto bridge = this->bridge(wanted);
    ASSERT_NE(bridge, nullptr);
    const std::vector<Plane> planes = planes_of(wanted);
    std::vector<Texture> textures;
    std::vector<Bytes> texels;
    for (const Plane& plane : planes) {
      texels.push_back(finite_texels(plane.format, kTarget, static_cast<std::uint32_t>(textures.size()) + 5));
      const GLenum internal = plane.kind == PlaneKind::kColour  ? c.internal
                              : plane.kind == PlaneKind::kDepth ? GLenum{GL_DEPTH_COMPONENT32F}
                                                                : gl_format(plane.format).internal;
      textures.push_back(texture_with(plane, internal, c.immutable, &texels.back()));
    }
    Bytes made = finite_texels(wanted.picture, kTarget, 3);
    const Texture picture = texture_with({.format = wanted.picture}, GL_RGBA8, c.immutable, &made);
    made.resize(static_cast<std::size_t>(kOutput.area()) * bytes_per_pixel(wanted.picture));
    const FrameTextures names = {textures[0].get(), textures[1].get(), textures[2].get(), textures[3].get()};
    ASSERT_TRUE(bridge->import(names, kTarget).ok());  // libepoxy fills its pointers in
    const CallCounter<&epoxy_glDispatchCompute> shaders;
    for (int frame = 0; frame < 4; ++frame) {
      const Extent render = {kTarget.width - 5 * frame, kTarget.height - frame};
      auto inputs = bridge->import(names, render);
      ASSERT_TRUE(inputs.ok()) << inputs.status().message();
      for (std::size_t i = 0; i < planes.size(); ++i) {
        EXPECT_TRUE(download(view_of(*inputs, planes[i].kind), render) ==
                    crop(texels[i], kTarget, render, bytes_per_pixel(planes[i].format)))
            << "frame " << frame << ", plane " << i;
      }
      upload(bridge->begin_present().value(), made);
      ASSERT_TRUE(bridge->present(picture.get()).ok());
    }
    EXPECT_EQ(shaders.count(), c.immutable ? 4 * 5 : 0);
    Bytes seen(static_cast<std::size_t>(kTarget.area()) * bytes_per_pixel(wanted.picture));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(picture.get(), 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(seen.size()),
                      seen.data());
    EXPECT_TRUE(crop(seen, kTarget, kOutput, bytes_per_pixel(wanted.picture)) == made);
  }
}

// A driver that cannot be trusted ends in one sentence, and frames are copied.
TEST_F(ExternalFds, ADriverThatLiesMeansCopying) {
  const std::array flaws = {std::pair{Flaw::kWrongBytes, "other bytes than OpenGL wrote"},
                            std::pair{Flaw::kRefuses, "clCreateBufferWithProperties"},
                            std::pair{Flaw::kWrongUuid, "OpenGL draws on the device"},
                            std::pair{Flaw::kNoFunctions, "has no clEnqueueAcquireExternalMemObjectsKHR"}};
  const PretendSeparateMemory separate;
  for (const auto& [flaw, clue] : flaws) {
    const PretendImports driver(flaw);
    reopen();
    const int before = open_fds();
    const auto refused = Bridge::create(*context_, *device_, settings(Interop::kExternal));
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.status().code(), StatusCode::kUnsupported);
    EXPECT_TRUE(contains(refused.status().message(), clue)) << refused.status().message();
    EXPECT_TRUE(contains(refused.status().message(), "use 'copy' or 'auto'"));
    EXPECT_EQ(refused.status().message().find('\n'), std::string::npos) << refused.status().message();
    EXPECT_EQ(open_fds(), before) << clue;
    const auto fallen_back = bridge(settings(Interop::kAuto));
    EXPECT_EQ(fallen_back->kind(), Interop::kCopy);
    EXPECT_TRUE(contains(fallen_back->reason(), clue)) << fallen_back->reason();
  }
}

TEST_F(ExternalFds, BadImportsAreNamed) {
  const auto memory = vulkan_->allocate(4096, VulkanDevice::Place::kDevice);
  const Fd good = memory->fd();
  EXPECT_TRUE(contains(
      device_->import_memory({.handle = MemoryHandle::kDmaBuf, .fd = good.get(), .bytes = 4096}).error(),
      "does not offer cl_khr_external_memory_dma_buf"));
  const int closed = fcntl(good.get(), F_DUPFD_CLOEXEC, 1000);  // a number that nobody takes meanwhile
  close(closed);
  const Fd foreign(open("/proc/self/exe", O_RDONLY | O_CLOEXEC));
  const int before = open_fds();
  const auto expect = [&](const ExternalMemory& external, StatusCode code, const std::string& clue) {
    const Status status = refusal(Flaw::kNone, external);
    EXPECT_EQ(status.code(), code) << status.message();
    EXPECT_TRUE(contains(status.message(), clue)) << status.message();
  };
  using enum StatusCode;
  expect({.fd = good.get()}, kInvalidArgument, "bytes is 0");
  expect({.fd = closed, .bytes = 4096}, kInvalidArgument, "no open file descriptor");
  expect({.fd = -1, .bytes = 4096}, kInvalidArgument, "fd is -1");
  expect({.fd = foreign.get(), .bytes = 4096}, kDeviceFailure, "clCreateBufferWithProperties");
  expect({.fd = good.get(), .bytes = 1 << 24}, kDeviceFailure, "import_memory of 16777216 bytes");
  expect({.fd = good.get(), .bytes = 4096, .device = {1}}, kInvalidArgument,
         "import it where it was allocated");
  expect({.handle = MemoryHandle::kMapped, .bytes = 4096}, kInvalidArgument, "mapped is 0x0");
  EXPECT_TRUE(
      contains(refusal(Flaw::kRefuses, {.fd = good.get(), .bytes = 4096}).message(), "CL_INVALID_VALUE"));
  EXPECT_EQ(open_fds(), before);
  EXPECT_TRUE(fcntl(good.get(), F_GETFD) >= 0) << "the caller's stays open";
}

TEST_F(ExternalFds, MemoryChangesSidesOnce) {
  const auto memory = vulkan_->allocate(4096, VulkanDevice::Place::kDevice);
  const Fd fd = memory->fd();
  const PretendImports driver;
  reopen();
  const auto dma_buf =
      device_->import_memory({.handle = MemoryHandle::kDmaBuf, .fd = fd.get(), .bytes = 4096}).value();
  EXPECT_EQ(driver.dma_bufs(), 1);
  SharedMemory shared = device_->import_memory({.fd = fd.get(), .bytes = 4096}).value();
  EXPECT_FALSE(shared.acquired());
  EXPECT_TRUE(shared.release().ok()) << "it is the other's already";
  for (int i = 0; i < 2; ++i) {
    EXPECT_TRUE(shared.acquire().ok());
    EXPECT_TRUE(shared.acquire().ok()) << "it is OpenCL's already";
    EXPECT_EQ(driver.acquired(), 1);
    cl_event done = nullptr;
    EXPECT_TRUE(shared.release(&done).ok());
    ASSERT_NE(done, nullptr);
    EXPECT_EQ(clReleaseEvent(done), CL_SUCCESS);
    EXPECT_EQ(driver.acquired(), 0);
  }
}

// Semaphores order OpenGL and OpenCL, and nothing waits on the host.
TEST_F(ExternalFds, FramesOrderedByTheDeviceHaveTheBitsOfCopies) {
  if (!PretendSemaphores::works()) QUINCUNX_SKIP("this build has no stand-in for Vulkan's loader");
  const std::vector<Bytes> copied = pictures(settings(Interop::kCopy), kFrames);
  const PretendSeparateMemory separate;
  const PretendImports driver;
  const PretendSemaphores semaphores;
  reopen();
  EXPECT_TRUE(contains(bridge(settings(Interop::kExternal))->reason(), "ordered by semaphores"));
  const int before = open_fds();
  const int uses = semaphores.uses();
  EXPECT_TRUE(pictures(settings(Interop::kExternal), kFrames) == copied);
  EXPECT_GE(semaphores.uses() - uses, 4 * (kFrames - 3)) << "each frame's planes and picture, both ways";
  EXPECT_EQ(semaphores.faults(), 0);
  EXPECT_EQ(open_fds(), before);
  // A frame that was handed over, and that nobody took.
  const auto bridge = this->bridge(settings(Interop::kExternal));
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(bridge->begin_draw(0, kTarget).ok());
    ASSERT_TRUE(bridge->submit(0).ok());
  }
  ASSERT_TRUE(bridge->acquire(0).ok());
  EXPECT_EQ(semaphores.faults(), 0);
}

TEST_F(ExternalFds, SemaphoresThatNeverArriveAreLeftOut) {
  if (!PretendSemaphores::works()) QUINCUNX_SKIP("this build has no stand-in for Vulkan's loader");
  const std::vector<Bytes> copied = pictures(settings(Interop::kCopy), 4);
  const PretendSeparateMemory separate;
  const PretendImports driver;
  const PretendSemaphores semaphores(PretendSemaphores::Flaw::kNeverSignalled);
  reopen();
  std::vector<std::string> lines;
  set_log([&](LogLevel level, const std::string& line) {
    if (level == LogLevel::kWarning) lines.push_back(line);
  });
  EXPECT_TRUE(pictures(settings(Interop::kExternal), 4) == copied);
  set_log({});
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(
      contains(lines[0], "semaphores are left out: a semaphore that OpenGL signalled did not reach OpenCL"))
      << lines[0];
}

// Semaphores in and out of a dispatch.
class ExternalSemaphores : public ExternalFds {
 protected:
  static bool raised(const Fd& fd, int wait_ms) {
    pollfd ready = {.fd = fd.get(), .events = POLLIN, .revents = 0};
    return poll(&ready, 1, wait_ms) == 1;
  }
  static void raise(const Fd& fd) {
    const std::uint64_t one = 1;
    ASSERT_EQ(write(fd.get(), &one, sizeof(one)), static_cast<ssize_t>(sizeof(one)));
  }
};

TEST_F(ExternalSemaphores, AFrameWaitsForThemAndSignalsItsEnd) {
  const PretendImports driver;
  reopen();
  const Fd drawn_fd(eventfd(0, EFD_CLOEXEC)), resolved_fd(eventfd(0, EFD_CLOEXEC));
  const int before = open_fds();
  {
    Semaphore drawn = device_->import_semaphore(drawn_fd.get()).value();
    Semaphore resolved = device_->import_semaphore(resolved_fd.get()).value();
    const ResolvePlan plan =
        plan_for({}, {.method = Method::kPoint, .output_extent = kOutput, .target_extent = kOutput}).value();
    ResolveService service = ResolveService::create(*device_, plan).value();
    const Image colour = device_->allocate(kOutput, plan.settings.colour).value();
    const Image picture = device_->allocate(kOutput, PixelFormat::kRGBA8).value();
    const FrameInputs inputs = {.colour = colour.view(), .render_extent = kOutput};
    Semaphore* const waits = &drawn;
    Semaphore* const signals = &resolved;
    const FrameSync sync = {.wait_semaphores = {&waits, 1}, .signal_semaphores = {&signals, 1}};
    for (int frame = 0; frame < 3; ++frame) {
      const FrameReport report = service.dispatch(inputs, {.presented = picture.view()}, sync);
      ASSERT_TRUE(report.ok()) << report.status.message();
      EXPECT_FALSE(raised(resolved_fd, 50)) << "the frame waits";
      raise(drawn_fd);
      EXPECT_TRUE(raised(resolved_fd, 10'000)) << "its end is signalled";
      std::uint64_t count = 0;
      EXPECT_EQ(read(resolved_fd.get(), &count, sizeof(count)), static_cast<ssize_t>(sizeof(count)));
      EXPECT_EQ(count, 1u);
    }
    Semaphore* const none = nullptr;
    EXPECT_EQ(service.dispatch(inputs, {.presented = picture.view()}, {.wait_semaphores = {&none, 1}})
                  .status.message(),
              "wait_semaphores[0] is null; leave it out");
    reopen();
    Semaphore others = device_->import_semaphore(drawn_fd.get()).value();
    Semaphore* const foreign = &others;
    EXPECT_EQ(service.dispatch(inputs, {.presented = picture.view()}, {.signal_semaphores = {&foreign, 1}})
                  .status.message(),
              "signal_semaphores[0] is of another device; import it by the service's own");
    EXPECT_FALSE(raised(resolved_fd, 0)) << "a refused frame signals nothing";
  }
  EXPECT_EQ(open_fds(), before);
}

TEST_F(ExternalSemaphores, OneThatIsNeverSignalledEndsInWords) {
  const PretendImports driver;
  reopen();
  const int before = longest_wait_ms.exchange(200);
  const Fd drawn_fd(eventfd(0, EFD_CLOEXEC));
  Semaphore drawn = device_->import_semaphore(drawn_fd.get()).value();
  const ResolvePlan plan =
      plan_for({}, {.method = Method::kPoint, .output_extent = kOutput, .target_extent = kOutput}).value();
  ResolveService service = ResolveService::create(*device_, plan).value();
  const Image colour = device_->allocate(kOutput, plan.settings.colour).value();
  const Image picture = device_->allocate(kOutput, PixelFormat::kRGBA8).value();
  const FrameInputs inputs = {.colour = colour.view(), .render_extent = kOutput};
  constexpr const char* kWords =
      "OpenCL did not finish within 200 ms; a semaphore that it waits for may never have been signalled";
  Semaphore* const waits = &drawn;
  ASSERT_TRUE(service.dispatch(inputs, {.presented = picture.view()}, {.wait_semaphores = {&waits, 1}}).ok());
  EXPECT_EQ(service.finish().message(), kWords);
  Status status;
  for (int frame = 0; frame < 100 && status.ok(); ++frame)
    status = service.dispatch(inputs, {.presented = picture.view()}).status;
  EXPECT_EQ(status.message(), kWords);
  raise(drawn_fd);
  longest_wait_ms = 30'000;
  EXPECT_TRUE(service.finish().ok()) << "it arrived after all";
  longest_wait_ms = before;
}

TEST_F(ExternalSemaphores, BadOnesAreNamed) {
  EXPECT_TRUE(contains(device_->import_semaphore(0).error(), "cl_khr_external_semaphore_opaque_fd"));
  const PretendImports driver;
  reopen();
  EXPECT_EQ(device_->import_semaphore(-1).error(),
            "import_semaphore: fd is -1, which is no open file descriptor");
}

}  // namespace
}  // namespace quincunx::gl::testing
