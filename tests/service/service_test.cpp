// SPDX-License-Identifier: MIT
// The service end to end, on host-made frames: identities, history, reset, refusal, counts.
#include "quincunx/resolve_service.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "service_fixture.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::Pixel;
using testing::ServiceRig;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

Pixel pattern(int x, int y) {
  const auto wave = [&](float a, float b) {
    return 0.5f + 0.5f * std::sin(a * static_cast<float>(x) + b * static_cast<float>(y));
  };
  return {wave(0.3f, 0.1f), 4 * wave(0.7f, 1.1f), wave(2.1f, 0.2f), 1};
}

bool same_bits(const std::vector<Pixel>& a, const std::vector<Pixel>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Pixel)) == 0;
}

TEST(Service, ScaleOneWithoutJitterIsTheIdentity) {
  for (const Method method : {Method::kPoint, Method::kBilinear, Method::kQuincunx}) {
    for (const Extent extent : {Extent{1, 1}, {7, 5}, {64, 64}, {257, 129}}) {
      ServiceRig rig({}, method, extent, extent);
      std::vector<Pixel> expected;
      for (int y = 0; y < extent.height; ++y) {
        for (int x = 0; x < extent.width; ++x)
          expected.push_back(pattern(x, y));
      }
      HostFrame frame = {.render = extent, .colour = pattern};
      EXPECT_TRUE(same_bits(rig.resolve(frame), expected)) << name_of(method) << ", first frame";
      EXPECT_TRUE(same_bits(rig.resolve(frame), expected)) << name_of(method) << ", second frame";
    }
  }
}

TEST(Service, AStillSceneIsBitStableFromFrameThree) {
  ServiceRig rig({}, Method::kQuincunx, {64, 48}, {64, 48});
  const auto frame = [&](int index) {
    const float j = index % 2 == 0 ? -0.25f : 0.25f;
    // The input as a renderer would give it: the pattern sampled at the jittered positions.
    return HostFrame{
        .render = {46, 34}, .jitter = {j, j}, .colour = [j](int x, int y) {
          return Pixel{std::sin(0.3f * (static_cast<float>(x) + j)), static_cast<float>(y) + j, 1, 1};
        }};
  };
  std::vector<std::vector<Pixel>> pictures;
  std::vector<std::vector<std::uint8_t>> presented;
  for (int index = 0; index < 8; ++index) {
    pictures.push_back(rig.resolve(frame(index)));
    presented.push_back(rig.presented());
  }
  // f is 1 and the two frames change places, so from the third on nothing may change but by the order of a
  // sum: (c0 + c1)/2 is commutative in IEEE arithmetic.
  for (std::size_t i = 3; i < pictures.size(); ++i) {
    EXPECT_TRUE(same_bits(pictures[i], pictures[2])) << "frame " << i;
    EXPECT_EQ(presented[i], presented[2]) << "frame " << i;
  }
  EXPECT_FALSE(same_bits(pictures[0], pictures[2])) << "history must have an effect";
}

TEST(Service, ResetShowsNothingOfThePast) {
  const Extent output = {32, 24};
  const HostFrame red = {.render = {20, 16}, .colour = [](int, int) { return Pixel{1, 0, 0, 1}; }};
  HostFrame blue = {.render = {24, 18}, .jitter = {0.25f, 0.25f}, .colour = pattern};
  ServiceRig used({}, Method::kQuincunx, output, output);
  ServiceRig fresh({}, Method::kQuincunx, output, output);
  used.resolve(red);
  blue.reset = true;
  EXPECT_TRUE(same_bits(used.resolve(blue), fresh.resolve(blue)));
  blue.reset = false;
  ServiceRig control({}, Method::kQuincunx, output, output);
  control.resolve(red);
  EXPECT_FALSE(same_bits(control.resolve(blue), fresh.resolved())) << "without reset the past must show";
}

// The seed's formula by hand: constant frames, K = 1, velocity in uv, f = 1/(1 + |v0|^2 + |v1|^2), each v in
// render pixels of its own frame.
TEST(Service, VelocityWeighsThePreviousFrame) {
  const Extent output = {40, 20};
  ServiceRig rig({}, Method::kQuincunx, output, output);
  const Vec2 v0 = {1.5f / 40, -0.5f / 20};
  const Vec2 v1 = {0, 2.0f / 20};
  rig.resolve({.render = {20, 10},
               .colour =
                   [](int, int) {
                     return Pixel{0, 8, 0, 1};
                   },
               .velocity = [v1](int, int) { return v1; }});
  const auto picture = rig.resolve({.render = {30, 14},
                                    .colour =
                                        [](int, int) {
                                          return Pixel{4, 0, 0, 1};
                                        },
                                    .velocity = [v0](int, int) { return v0; }});
  const double x0 = 1.5 * 30 / 40;
  const double y0 = 0.5 * 14 / 20;
  const double y1 = 2.0 * 10 / 20;
  const double f = 1 / (1 + x0 * x0 + y0 * y0 + y1 * y1);
  for (const Pixel& pixel : picture) {
    EXPECT_NEAR(pixel[0], 4 / (1 + f), 1e-5);
    EXPECT_NEAR(pixel[1], f * 8 / (1 + f), 1e-5);
  }
}

TEST(Service, ReactiveDropsThePreviousFrame) {
  const Extent output = {16, 16};
  ServiceRig rig({}, Method::kQuincunx, output, output);
  const HostFrame past = {.render = output, .colour = [](int, int) { return Pixel{8, 8, 8, 1}; }};
  HostFrame now = {.render = output, .colour = [](int, int) { return Pixel{1, 1, 1, 1}; }};
  now.reactive = [](int x, int) { return static_cast<std::uint8_t>(x < 8 ? 255 : 0); };
  rig.resolve(past);
  const auto picture = rig.resolve(now);
  EXPECT_FLOAT_EQ(picture[0][0], 1);
  EXPECT_FLOAT_EQ(picture[15][0], 4.5f);
}

// A plane at constant depth and a camera that shifts it by a known uv must give the weight of that velocity.
TEST(Service, CameraVelocityComesFromDepth) {
  const Extent output = {50, 50};
  ServiceRig rig({.moving_objects = false}, Method::kQuincunx, output, output);
  HostFrame frame = {.render = {30, 30}, .colour = [](int, int) { return Pixel{0, 0, 0, 1}; }};
  // previous ndc.x = ndc.x - 2 * (2/50): everything moved by +2 output pixels in x; previous ndc.y = ndc.y +
  // 2/50: by +1 downwards.
  frame.camera.clip_to_previous_clip[12] = -2 * 2.0f / 50;
  frame.camera.clip_to_previous_clip[13] = 2 * 1.0f / 50;
  rig.resolve(frame);
  frame.colour = [](int, int) { return Pixel{1, 1, 1, 1}; };
  const auto picture = rig.resolve(frame);
  const double x = 2.0 * 30 / 50;
  const double y = 1.0 * 30 / 50;
  const double f = 1 / (1 + 2 * (x * x + y * y));
  for (const Pixel& pixel : picture)
    ASSERT_NEAR(pixel[0], 1 / (1 + f), 1e-5);
}

TEST(Service, NonFinitePixelsAreCountedAndGoneInTheNextFrame) {
  const Extent output = {48, 32};
  ServiceRig rig({}, Method::kQuincunx, output, output);
  ServiceRig clean({}, Method::kQuincunx, output, output);
  const HostFrame good = {.render = {33, 21}, .colour = pattern};
  HostFrame bad = good;
  bad.colour = [](int x, int y) {
    if (x == 10 && y == 10) return Pixel{kNan, kInf, -kInf, 1};
    return pattern(x, y);
  };
  bad.velocity = [](int x, int y) { return x == 20 && y == 15 ? Vec2{kNan, kInf} : Vec2{}; };
  clean.resolve(good);
  const auto first = rig.resolve(bad);
  for (const Pixel& pixel : first) {
    for (const float value : pixel)
      ASSERT_TRUE(std::isfinite(value));
  }
  clean.resolve(good);
  const auto second = rig.resolve(good);
  const auto expected = clean.resolved();
  int differing = 0;
  for (std::size_t i = 0; i < second.size(); ++i) {
    for (int c = 0; c < 4; ++c) {
      ASSERT_TRUE(std::isfinite(second[i][c]));
      // Where the bad texel lay the previous frame is dropped; the still picture is then this frame alone,
      // the same.
      ASSERT_NEAR(second[i][c], expected[i][c], 1e-5) << "pixel " << i;
    }
    differing += second[i] != expected[i] ? 1 : 0;
  }
  EXPECT_LE(differing, 16) << "no more than the footprint";
  ASSERT_TRUE(rig.service().finish().ok());
  const auto report = rig.service().next_completed();
  ASSERT_TRUE(report.has_value());
  EXPECT_GE(report->non_finite_pixels, 1);
  EXPECT_LE(report->non_finite_pixels, 16);
}

TEST(Service, PoisonOutsideTheViewportChangesNoBit) {
  const Extent output = {60, 44};
  const Extent target = {80, 60};
  std::mt19937 random(3);
  ServiceRig clean({}, Method::kQuincunx, output, target);
  ServiceRig poisoned({}, Method::kQuincunx, output, target);
  const float poisons[] = {kNan, kInf, -kInf, 1e30f};
  for (int index = 0; index < 40; ++index) {
    const Extent render = {static_cast<int>(random() % 80) + 1, static_cast<int>(random() % 60) + 1};
    const float poison = poisons[index % 4];
    // The whole target of the slot holds poison before the frame is put in.
    const HostFrame flood = {.render = target,
                             .colour =
                                 [poison](int, int) {
                                   return Pixel{poison, poison, poison, poison};
                                 },
                             .velocity =
                                 [poison](int, int) {
                                   return Vec2{poison, poison};
                                 },
                             .depth = [poison](int, int) { return poison; },
                             .reactive = [](int, int) { return std::uint8_t{255}; }};
    const HostFrame frame = {
        .render = render,
        .jitter = {0.25f * static_cast<float>(index % 2 * 2 - 1), -0.25f},
        .colour = pattern,
        .velocity = [](int x, int y) {
          return Vec2{1e-3f * static_cast<float>(x % 3), 1e-3f * static_cast<float>(y % 5)};
        }};
    poisoned.flood(flood);
    ASSERT_TRUE(same_bits(poisoned.resolve(frame), clean.resolve(frame)))
        << render.width << "x" << render.height;
    ASSERT_EQ(poisoned.presented(), clean.presented());
  }
}

TEST(Service, ResolutionMayChangeEveryFrameAndRunsRepeatBitForBit) {
  const auto run = [] {
    ServiceRig rig({}, Method::kQuincunx, {61, 43}, {122, 86});
    std::mt19937 random(7);
    std::vector<Pixel> all;
    for (int index = 0; index < 30; ++index) {
      const Extent render = {static_cast<int>(random() % 122) + 1, static_cast<int>(random() % 86) + 1};
      const auto picture = rig.resolve({.render = render, .jitter = {0.25f, -0.25f}, .colour = pattern});
      all.insert(all.end(), picture.begin(), picture.end());
    }
    return all;
  };
  const auto first = run();
  for (const Pixel& pixel : first) {
    for (const float value : pixel)
      ASSERT_TRUE(std::isfinite(value));
  }
  EXPECT_TRUE(same_bits(first, run()));
}

TEST(Service, ABadFrameIsRefusedWholeAndHistoryStays) {
  const Extent output = {32, 32};
  ServiceRig rig({}, Method::kQuincunx, output, output);
  ServiceRig control({}, Method::kQuincunx, output, output);
  const HostFrame one = {.render = output, .colour = [](int, int) { return Pixel{2, 0, 0, 1}; }};
  const HostFrame two = {.render = output, .colour = pattern};
  rig.resolve(one);
  control.resolve(one);
  const auto before = rig.resolved();
  FrameInputs bad = rig.upload(two);
  bad.jitter.x = kNan;
  const FrameReport refused = rig.dispatch(bad);
  EXPECT_FALSE(refused.ok());
  EXPECT_NE(refused.status.message().find("jitter.x"), std::string::npos);
  EXPECT_TRUE(refused.passes.empty());
  EXPECT_TRUE(same_bits(rig.resolved(), before)) << "no output is touched";
  EXPECT_TRUE(same_bits(rig.resolve(two), control.resolve(two)));
}

// Kernels would read and write beyond its end.
TEST(Service, BuffersReachAsFarAsTheirImages) {
  ServiceRig rig({}, Method::kQuincunx, {16, 16}, {16, 16});
  FrameInputs inputs = rig.upload({.render = {16, 16}});
  inputs.velocity.offset = 16;  // 16 x 16 texels of 8 bytes fill it
  const FrameReport refused = rig.dispatch(inputs);
  EXPECT_NE(refused.status.message().find("velocity.memory has 2048 bytes"), std::string::npos)
      << refused.status.message();
  EXPECT_NE(refused.status.message().find("need 2064"), std::string::npos) << refused.status.message();
  inputs.velocity.offset = 0;
  EXPECT_TRUE(rig.dispatch(inputs).ok());
}

TEST(Service, TheMemoryOfThePreviousFrameIsRefused) {
  ServiceRig rig({}, Method::kQuincunx, {16, 16}, {16, 16});
  FrameInputs inputs = rig.upload({.render = {16, 16}});
  ASSERT_TRUE(rig.dispatch(inputs).ok());
  const FrameReport refused = rig.dispatch(inputs);
  EXPECT_FALSE(refused.ok());
  EXPECT_NE(refused.status.message().find("colour"), std::string::npos) << refused.status.message();
  inputs.reset = true;
  EXPECT_TRUE(rig.dispatch(inputs).ok()) << "after a reset nothing of the past is read";
}

TEST(Service, EveryImageThatIsReadAgainNeedsMemoryOfItsOwn) {
  struct Case {
    const char* method;
    std::string kept;  // what the next frame reads
    float residual_weight = 0;
    SkyMotion sky = SkyMotion::kAsDrawn;
  };
  const std::pair<const char*, ImageView FrameInputs::*> images[] = {{"colour", &FrameInputs::colour},
                                                                     {"velocity", &FrameInputs::velocity},
                                                                     {"depth", &FrameInputs::depth},
                                                                     {"reactive", &FrameInputs::reactive}};
  for (const Case& some :
       {Case{"bilinear", ""}, Case{"quincunx:mean", "colour reactive "},
        Case{"quincunx:velocity", "colour velocity reactive "},
        Case{"quincunx:point", "colour velocity reactive "},
        Case{"quincunx:reprojected", "colour depth reactive "},
        Case{"quincunx:reprojected", "colour velocity depth reactive ", 1},
        Case{"temporal:fast", "depth reactive "}, Case{"temporal:balanced", "depth reactive "},
        Case{"temporal:quality", "depth reactive "},
        Case{"temporal:balanced", "colour depth reactive ", 0, SkyMotion::kEvidence}}) {
    SCOPED_TRACE(some.method);
    ResolveSettings settings;
    apply(parse_variant(some.method).value(), settings);
    settings.quincunx.residual_weight = some.residual_weight;
    settings.conventions.sky_motion = some.sky;
    ServiceRig rig({}, settings, {16, 16}, {16, 16});
    std::string kept;
    for (const auto& [name, image] : images) {
      const FrameInputs first = rig.upload({.render = {16, 16}, .reset = true});
      ASSERT_TRUE(rig.dispatch(first).ok());
      FrameInputs next = rig.upload({.render = {16, 16}});
      next.*image = first.*image;
      const FrameReport report = rig.dispatch(next);
      if (report.ok()) continue;
      kept += std::string(name) + " ";
      EXPECT_TRUE(
          report.status.message().starts_with(std::string(name) + " is the memory of the previous frame"))
          << report.status.message();
    }
    EXPECT_EQ(kept, some.kept);
  }
}

TEST(Service, ReportsComeInOrderWithTimesAndBytes) {
  ServiceRig rig({}, Method::kQuincunx, {64, 64}, {64, 64});
  rig.service().allow_timing_waits(true);  // matters where the device's events are not believed
  for (int index = 0; index < 5; ++index)
    rig.resolve({.render = {32 + 2 * index, 40}});
  ASSERT_TRUE(rig.service().finish().ok());
  for (std::uint64_t index = 0; index < 5; ++index) {
    const auto report = rig.service().next_completed();
    ASSERT_TRUE(report.has_value());
    EXPECT_EQ(report->frame_index, index);
    EXPECT_EQ(report->used_previous, index > 0);
    EXPECT_EQ(report->render_extent, (Extent{32 + 2 * static_cast<int>(index), 40}));
    EXPECT_FLOAT_EQ(report->ratio.y, 40.0f / 64);
    ASSERT_EQ(report->passes.size(), 2u);
    EXPECT_STREQ(report->passes[0].kernel, index > 0 ? "resolve_quincunx" : "scale_bilinear");
    EXPECT_STREQ(report->passes[1].kernel, "present");
    for (int i = 0; i < 2; ++i) {
      EXPECT_GT(report->passes[i].ms, 0);
      EXPECT_GT(report->passes[i].bytes, 0u);
    }
    EXPECT_EQ(report->non_finite_pixels, 0);
  }
  EXPECT_FALSE(rig.service().next_completed().has_value());
}

TEST(Service, OldReportsAreDroppedNotWaitedFor) {
  ServiceRig rig({}, Method::kBilinear, {8, 8}, {8, 8});
  for (int index = 0; index < 100; ++index)
    rig.resolve({.render = {8, 8}});
  ASSERT_TRUE(rig.service().finish().ok());
  int count = 0;
  std::uint64_t last = 0;
  while (const auto report = rig.service().next_completed()) {
    last = report->frame_index;
    ++count;
  }
  EXPECT_EQ(count, 64);
  EXPECT_EQ(last, 99u);
}

// On the device, in either storage; one that is no exposure counts as 1.
TEST(Service, ExposureMayBeAnImage) {
  constexpr Extent kSize = {40, 3};
  ServiceRig rig({}, Method::kPoint, kSize, kSize);
  const HostFrame frame = {.render = kSize, .colour = pattern};
  const auto shown = [&](float number, const ImageView& image) {
    FrameInputs inputs = rig.upload(frame);
    inputs.exposure = number;
    inputs.exposure_image = image;
    const FrameReport report = rig.dispatch(inputs);
    EXPECT_TRUE(report.ok()) << report.status.message();
    return rig.presented();
  };
  const auto plain = shown(0, {});
  const auto bright = shown(3, {});
  EXPECT_NE(plain, bright);
  for (const Storage storage : {Storage::kBuffer, Storage::kImage}) {
    const Image image = rig.device().allocate({1, 1}, PixelFormat::kR32F, storage).value();
    const auto factor = [&](float value) {
      EXPECT_TRUE(rig.device().upload(image.view(), {1, 1}, &value).ok());
      return image.view();
    };
    EXPECT_EQ(shown(0, factor(3)), bright);
    EXPECT_EQ(shown(6, factor(0.5f)), bright);
    for (const float none : {0.0f, -2.0f, kNan, kInf})
      EXPECT_EQ(shown(3, factor(none)), bright) << none;
    EXPECT_EQ(shown(0, {}), plain) << "a frame without the image";
  }
  FrameInputs inputs = rig.upload(frame);
  const Image wrong = rig.device().allocate({2, 1}, PixelFormat::kRG16F).value();
  inputs.exposure_image = wrong.view();
  EXPECT_EQ(rig.dispatch(inputs).status.message(),
            "exposure_image.format is RG16F; the plan has R32F; exposure_image.extent is 2x1; it must be the "
            "exposure's 1x1");
}

TEST(Service, ClearFillsTheRectangleOnly) {
  Device device = Device::open().value();
  ResolveSettings settings;
  settings.output_extent = settings.target_extent = {16, 12};
  settings.colour = PixelFormat::kRGBA32F;
  settings.targets.clear = true;
  auto service = ResolveService::create(device, plan_for({.background = false}, settings).value());
  ASSERT_TRUE(service.ok()) << service.status().message();
  auto image = device.allocate({16, 12}, PixelFormat::kRGBA32F);
  const std::vector<Pixel> before(16 * 12, Pixel{9, 9, 9, 9});
  ASSERT_TRUE(device.upload(image->view(), {16, 12}, before.data()).ok());
  const float value[4] = {1, 2, 3, 4};
  ASSERT_TRUE(service->clear(image->view(), {5, 7}, value).ok());
  std::vector<Pixel> after(16 * 12);
  ASSERT_TRUE(device.download(image->view(), {16, 12}, after.data()).ok());
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 16; ++x) {
      const Pixel expected = x < 5 && y < 7 ? Pixel{1, 2, 3, 4} : Pixel{9, 9, 9, 9};
      EXPECT_EQ(after[y * 16 + x], expected) << x << "," << y;
    }
  }
  EXPECT_FALSE(service->clear(image->view(), {17, 7}, value).ok());
  EXPECT_FALSE(service->clear(image->view(), {0, 7}, value).ok());
  EXPECT_FALSE(service->clear({}, {1, 1}, value).ok());
  ImageView far = image->view();  // by numbers alone: kernels count in 32 bits
  far.offset = std::size_t{1} << 40;
  const Status refused = service->clear(far, {5, 7}, value);
  EXPECT_NE(refused.message().find("image.offset"), std::string::npos) << refused.message();
  far.offset = 16;
  EXPECT_NE(service->clear(far, {5, 7}, value).message().find("image.memory has"), std::string::npos);
}

TEST(Service, ClearThatWasNotPlannedIsRefused) {
  ServiceRig rig({}, Method::kBilinear, {8, 8}, {8, 8});
  const float value[4] = {};
  const Status status = rig.service().clear(rig.resolved_view(), {8, 8}, value);
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(status.message().find("clear"), std::string::npos);
}

}  // namespace
}  // namespace quincunx
