// SPDX-License-Identifier: MIT
// A focus from scene to picture: where it lies, and what it does to the error inside and outside.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "frames/focus_path.h"
#include "frames/frame_source.h"
#include "frames/method_resolves.h"
#include "frames/picture_options.h"
#include "render/truth.h"

namespace quincunx::scenes {
namespace {

constexpr Extent kOutput = {192, 108};
constexpr Rectangle kShown = {60, 30, 72, 48};

TEST(FocusTarget, ARectangleThePointerOrAnObject) {
  const auto target = FocusTarget::parse("60,30,72,48", kOutput);
  ASSERT_TRUE(target.ok());
  EXPECT_EQ(target->rectangle, kShown);
  EXPECT_TRUE(FocusTarget::parse("pointer", kOutput)->pointer);
  for (const char* name : {"lamp", "1,2,3", "1,2,3,4,5", "1,2,3,4x", "", "a,b,c,d"})
    EXPECT_EQ(FocusTarget::parse(name, kOutput)->object, name);
  for (const char* bad : {"-1,0,5,5", "0,0,0,5", "190,0,3,5", "0,100,5,9", "2147483647,0,2147483647,1"}) {
    const auto refused = FocusTarget::parse(bad, kOutput);
    ASSERT_FALSE(refused.ok()) << bad;
    EXPECT_EQ(refused.status().message(),
              std::string("--focus ") + bad +
                  " is no rectangle within the picture of 192x108; write X,Y,W,H in its pixels");
  }
}

TEST(FocusPath, ARectangleHasAGuardWithinThePicture) {
  const Scene scene;
  const auto at = [&](const Rectangle& wanted) {
    const FocusTarget target{.rectangle = wanted, .object = {}};
    return *FocusPath::create(target, scene, kOutput, {}).value().at(0);
  };
  EXPECT_EQ(at(kShown).shown, kShown);
  EXPECT_EQ(at(kShown).region, (Rectangle{52, 22, 88, 64}));
  EXPECT_EQ(at({0, 100, 20, 8}).region, (Rectangle{0, 84, 36, 24}));
  EXPECT_EQ(at({0, 0, 192, 108}).region, (Rectangle{0, 0, 192, 108}));
}

TEST(FocusPath, ThePointersSurroundingsAreCutAtThePicturesEdge) {
  const Scene scene;
  const FocusPath path =
      FocusPath::create({.rectangle = {}, .pointer = true, .object = {}}, scene, kOutput, {}).value();
  EXPECT_EQ(path.region(), (Extent{64, 43}));
  EXPECT_FALSE(path.at(0).has_value());
  EXPECT_EQ(path.at(0, Vec2{100, 50})->shown, (Rectangle{76, 37, 48, 26}));
  EXPECT_EQ(path.at(0, Vec2{1, 2})->shown, (Rectangle{0, 0, 25, 15}));
  EXPECT_EQ(path.at(0, Vec2{1, 2})->region, (Rectangle{0, 0, 64, 43}));
  EXPECT_FALSE(path.at(0, Vec2{-300, 0}).has_value());
}

// A cube of one metre, 10 metres ahead of a camera that sees 10 metres there, and another that passes it by.
Scene cubes() {
  Scene scene;
  scene.name = "cubes";
  scene.materials.resize(1);
  Mesh cube;
  for (int i = 0; i < 8; ++i) {
    Vertex vertex;
    vertex.position = {i & 1 ? .5f : -.5f, i & 2 ? .5f : -.5f, i & 4 ? .5f : -.5f};
    cube.vertices.push_back(vertex);
  }
  cube.indices = {0, 1, 2};
  scene.meshes.push_back(cube);
  const auto at = [](glm::vec3 place) {
    glm::mat4 matrix(1);
    matrix[3] = glm::vec4(place, 1);
    return matrix;
  };
  scene.instances.push_back({0, at({0, 0, -10.5f}), {}, "near"});
  scene.instances.push_back({0, at({0, 0, 5}),
                             [at](double seconds) {
                               return at({0, 0, 5 - 10 * seconds});
                             },
                             "passes"});
  scene.camera = [](double) { return Camera{.vertical_fov = static_cast<float>(2 * std::atan(.5))}; };
  return scene;
}

TEST(FocusPath, AnObjectIsWhereItsBoxIs) {
  const Scene scene = cubes();
  const auto path = [&](const char* name, const FocusTimes& times) {
    return FocusPath::create({.rectangle = {}, .object = name}, scene, kOutput, times);
  };
  // Its face is 10.8 pixels wide, about the middle; the margin has 16.
  const Rectangle shown = path("near", {})->at(0)->shown;
  EXPECT_EQ(shown, (Rectangle{74, 32, 44, 44}));
  const auto passes = path("passes", {0, .25, 9});
  ASSERT_TRUE(passes.ok()) << passes.status().message();
  EXPECT_FALSE(passes->at(0).has_value()) << "it is behind the camera";
  EXPECT_EQ(passes->at(.5)->shown, (Rectangle{0, 0, 192, 108})) << "the camera is within it";
  EXPECT_EQ(passes->at(1.55)->shown, (Rectangle{74, 32, 44, 44}));
  EXPECT_EQ(passes->region(), kOutput);
  EXPECT_EQ(path("passes", {0, .1, 2}).status().message(),
            "--focus: the object 'passes' is never in the picture in these frames");
  EXPECT_EQ(path("other", {}).status().message(),
            "--focus: the scene 'cubes' has no object 'other'; it has near, passes");
}

struct Pictures {
  std::vector<std::vector<float>> frames;
  std::vector<double> seconds;
};

class Focused : public ::testing::Test {
 protected:
  PictureOptions options(const char* scene, Method method, const char* scale) const {
    PictureOptions made;
    made.scene = scene;
    made.output = kOutput;
    made.scale = scale;
    made.resolve.method = method;
    made.frames = 24;
    made.interop = gl::Interop::kCopy;
    return made;
  }

  // The last `kept` frames.
  Pictures render(const PictureOptions& options, int kept) {
    const auto settings = source_settings_for(options);
    EXPECT_TRUE(settings.ok()) << settings.status().message();
    auto source = stage_ ? stage_->another(settings->sequence, {}, settings->focus)
                         : FrameSource::create(settings.value());
    EXPECT_TRUE(source.ok()) << source.status().message();
    FrameSource& frames = *source.value();
    const auto plan = frames.connect(options.resolve);
    EXPECT_TRUE(plan.ok()) << plan.status().message();
    auto service = ResolveService::create(frames.device(), plan.value());
    EXPECT_TRUE(service.ok()) << service.status().message();
    const Image resolved = frames.device().allocate(kOutput, PixelFormat::kRGBA32F).value();
    Pictures pictures;
    for (std::int64_t i = 0; i < options.frames; ++i) {
      EXPECT_TRUE(frames.draw(i).ok());
      const auto inputs = frames.acquire();
      EXPECT_TRUE(inputs.ok());
      const FrameReport report =
          dispatch(service.value(), inputs.value(), frames.focus(), {.linear = resolved.view()});
      EXPECT_TRUE(report.ok()) << report.status.message();
      EXPECT_EQ(report.focused, !options.focus.empty());
      if (i >= options.frames - kept) {
        std::vector<float>& rgba = pictures.frames.emplace_back(static_cast<std::size_t>(kOutput.area()) * 4);
        EXPECT_TRUE(frames.device().download(resolved.view(), kOutput, rgba.data()).ok());
        pictures.seconds.push_back(frames.oldest().view.seconds);
      }
      frames.release();
    }
    if (!stage_) stage_ = std::move(source).value();
    return pictures;
  }

  // Mean squared tone-mapped error against truth, of the pixels more than `within` inside of kShown.
  double error_inside(const Pictures& pictures, int within) {
    double sum = 0;
    double count = 0;
    for (std::size_t i = 0; i < pictures.frames.size(); ++i) {
      const auto truth =
          render_truth(stage_->renderer(), {.output = kOutput, .samples = 6}, pictures.seconds[i]);
      EXPECT_TRUE(truth.ok());
      for (int y = kShown.y + within; y < kShown.y + kShown.height - within; ++y) {
        for (int x = kShown.x + within; x < kShown.x + kShown.width - within; ++x) {
          for (int c = 0; c < 3; ++c) {
            const auto at = static_cast<std::size_t>((y * kOutput.width + x) * 4 + c);
            const auto shown = [](float light) { return light / (1 + light); };
            sum += std::pow(shown(pictures.frames[i][at]) - shown(truth.value()[at]), 2);
            ++count;
          }
        }
      }
    }
    return sum / count;
  }

  static void expect_same_outside(const Pictures& plain, const Pictures& focused) {
    for (std::size_t i = 0; i < plain.frames.size(); ++i) {
      for (int y = 0; y < kOutput.height; ++y) {
        for (int x = 0; x < kOutput.width; ++x) {
          if (x >= kShown.x && x < kShown.x + kShown.width && y >= kShown.y && y < kShown.y + kShown.height)
            continue;
          const auto at = static_cast<std::size_t>((y * kOutput.width + x) * 4);
          ASSERT_EQ(std::memcmp(&plain.frames[i][at], &focused.frames[i][at], 4 * sizeof(float)), 0)
              << x << ", " << y;
        }
      }
    }
  }

  std::unique_ptr<FrameSource> stage_;
};

// A focus at scale 1 in a picture at scale .35 has, but for its feather, the error that a whole picture at scale 1 has
// there, and the rest of the picture has every bit that it has without.
struct Measured {
  double plain, focused, whole;
};
constexpr int kFeather = 12;  // a quarter of the height

TEST_F(Focused, TheErrorInsideIsThatOfTheLargerScale) {
  const auto measure = [this](const char* scene, Method method) {
    stage_.reset();
    PictureOptions small = options(scene, method, "0.35");
    const Pictures plain = render(small, 4);
    small.focus = "60,30,72,48";
    const Pictures focused = render(small, 4);
    const Pictures whole = render(options(scene, method, "1"), 4);
    expect_same_outside(plain, focused);
    return Measured{error_inside(plain, kFeather), error_inside(focused, kFeather),
                    error_inside(whole, kFeather)};
  };
  for (const auto& [scene, method] :
       {std::pair{"pan", Method::kBilinear}, {"pan", Method::kQuincunx}, {"still", Method::kTemporal}}) {
    const Measured error = measure(scene, method);
    EXPECT_LT(error.focused, .9 * error.plain) << scene << ", " << name_of(method);
    EXPECT_NEAR(error.focused / error.whole, 1, .05) << scene << ", " << name_of(method);
  }
  // Pixels that a pan brings into the region have another history there than in a whole picture.
  const Measured pan = measure("pan", Method::kTemporal);
  EXPECT_LT(pan.focused, .75 * pan.plain);
  EXPECT_NEAR(pan.focused / pan.whole, 1, .1);
}

TEST_F(Focused, AnObjectIsFollowed) {
  PictureOptions wanted = options("occluders", Method::kTemporal, "0.5");
  const Pictures plain = render(wanted, 2);
  std::string name;
  for (const Instance& instance : stage_->scene().instances) {
    if (instance.motion) name = instance.name;
  }
  ASSERT_FALSE(name.empty());
  wanted.focus = name;
  const Pictures focused = render(wanted, 2);
  EXPECT_NE(plain.frames.back(), focused.frames.back());
}

}  // namespace
}  // namespace quincunx::scenes
