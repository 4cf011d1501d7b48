// SPDX-License-Identifier: MIT
// The chart is geometry throughout, so that its edges are exact at every resolution. Lengths are given in
// pixels of a 1280 x 720 picture, from its top left corner.
#include <array>
#include <cmath>

#include "builtin/scene_assembly.h"
#include "builtin/scenes.h"

namespace quincunx::scenes {

namespace {

constexpr glm::vec2 kPicture{1280, 720};
constexpr float kMetresPerPixel = 0.01f;
constexpr float kLayer = 0.002f;  // metres between what lies on top of each other
constexpr glm::vec3 kBlack(0.005f);
constexpr glm::vec3 kWhite(0.8f);
constexpr glm::vec3 kPaper(0.30f);

glm::vec2 place(glm::vec2 pixel) {
  return glm::vec2(pixel.x - kPicture.x / 2, kPicture.y / 2 - pixel.y) * kMetresPerPixel;
}

glm::vec3 linear_of(glm::vec3 srgb) {
  return glm::pow(srgb, glm::vec3(2.2f));
}

class ChartPen {
 public:
  explicit ChartPen(MeshBuilder& builder) : builder_(builder) {}

  void quad(std::array<glm::vec2, 4> corners, glm::vec3 colour, int layer = 1) {  // clockwise as seen, y down
    builder_.pen.colour = glm::vec4(colour, 1);
    std::array<std::uint32_t, 4> index{};
    for (std::size_t i = 0; i < 4; ++i)
      index[i] = corner(corners[i], layer);
    builder_.triangle(index[0], index[2], index[1]);
    builder_.triangle(index[0], index[3], index[2]);
  }
  void rectangle(glm::vec2 low, glm::vec2 high, glm::vec3 colour, int layer = 1) {
    quad({low, {high.x, low.y}, high, {low.x, high.y}}, colour, layer);
  }
  void ring(glm::vec2 centre, float inner, float outer, glm::vec3 colour, int layer = 1) {
    builder_.pen.colour = glm::vec4(colour, 1);
    constexpr int kSegments = 160;
    builder_.annulus(glm::vec3(place(centre), depth(layer)), {0, 0, 1}, inner * kMetresPerPixel,
                     outer * kMetresPerPixel, kSegments);
  }
  void sector(glm::vec2 centre, float radius, float from, float to, glm::vec3 colour, int layer = 1) {
    builder_.pen.colour = glm::vec4(colour, 1);
    constexpr int kPieces = 4;
    const std::uint32_t middle = corner(centre, layer);
    std::uint32_t before = 0;
    for (int i = 0; i <= kPieces; ++i) {
      const float angle = glm::mix(from, to, static_cast<float>(i) / kPieces);
      const std::uint32_t rim = corner(centre + radius * glm::vec2(std::cos(angle), -std::sin(angle)), layer);
      if (i > 0) builder_.triangle(middle, before, rim);
      before = rim;
    }
  }
  void text(std::string_view text, glm::vec2 baseline, float cap_height, glm::vec3 colour,
            float weight = 0.14f, Align align = Align::kLeft) {
    builder_.pen.colour = glm::vec4(colour, 1);
    const float size = cap_height * kMetresPerPixel;
    for (const Polyline& path : text_strokes(text, place(baseline), {size, 0, align})) {
      builder_.stroke(path, weight * size, depth(2));
    }
  }

 private:
  static float depth(int layer) { return static_cast<float>(layer) * kLayer; }
  std::uint32_t corner(glm::vec2 pixel, int layer) {
    return builder_.vertex(glm::vec3(place(pixel), depth(layer)), {0, 0, 1}, {0, 0});
  }

  MeshBuilder& builder_;
};

// Fresnel's zones: all have the same area, so the n-th radius grows with the root of n; the outermost zones
// are narrower than a pixel.
void add_zone_plate(ChartPen& pen, glm::vec2 centre, float radius) {
  constexpr int kZones = 88;
  pen.ring(centre, 0, radius + 2, kWhite, 1);
  for (int zone = 0; zone < kZones; zone += 2) {
    const float inner = radius * std::sqrt(static_cast<float>(zone) / kZones);
    const float outer = radius * std::sqrt(static_cast<float>(zone + 1) / kZones);
    pen.ring(centre, inner, outer, kBlack, 2);
  }
}

void add_star(ChartPen& pen, glm::vec2 centre, float radius) {
  constexpr int kSpokes = 48;
  pen.ring(centre, 0, radius + 2, kWhite, 1);
  for (int i = 0; i < kSpokes; ++i) {
    const float from = kTau * static_cast<float>(i) / kSpokes;
    pen.sector(centre, radius, from, from + kTau / (2 * kSpokes), kBlack, 2);
  }
}

void add_slanted_square(ChartPen& pen, glm::vec2 centre, float half, float degrees, glm::vec3 colour) {
  const float angle = glm::radians(degrees);
  const glm::vec2 x = half * glm::vec2(std::cos(angle), std::sin(angle));
  const glm::vec2 y(-x.y, x.x);
  pen.quad({centre - x - y, centre + x - y, centre + x + y, centre - x + y}, colour, 2);
}

// Groups of five bars, each with the width of a bar in pixels beside it.
void add_line_pairs(ChartPen& pen, glm::vec2 corner, bool upright) {
  struct Group {
    float width;
    const char* label;
  };
  constexpr std::array kGroups = std::to_array<Group>({{8, "8"},
                                                       {6, "6"},
                                                       {4, "4"},
                                                       {3, "3"},
                                                       {2.5f, "2.5"},
                                                       {2, "2"},
                                                       {1.5f, "1.5"},
                                                       {1.25f, "1.25"},
                                                       {1, "1"},
                                                       {0.75f, "0.75"}});
  constexpr float kLength = 58;
  constexpr std::size_t kSkippedAcross = 1;  // the widest does not fit one above the other
  float at = 0;
  for (std::size_t i = upright ? 0 : kSkippedAcross; i < kGroups.size(); ++i) {
    const float width = kGroups[i].width;
    for (int bar = 0; bar < 5; ++bar) {
      const float low = at + 2 * width * static_cast<float>(bar);
      if (upright) {
        pen.rectangle(corner + glm::vec2(low, 0), corner + glm::vec2(low + width, kLength), kBlack, 2);
      } else {
        pen.rectangle(corner + glm::vec2(0, low), corner + glm::vec2(kLength, low + width), kBlack, 2);
      }
    }
    const float middle = at + 4.5f * width;
    if (upright) {
      pen.text(kGroups[i].label, corner + glm::vec2(middle, kLength + 14), 7, kBlack, 0.18f, Align::kCentre);
    } else {
      pen.text(kGroups[i].label, corner + glm::vec2(-8, middle + 3), 6, kBlack, 0.18f, Align::kRight);
    }
    at += 9 * width + (upright ? 24 : 7);
  }
}

void add_text_block(ChartPen& pen, glm::vec2 corner) {
  struct Line {
    float size;
    const char* text;
  };
  constexpr std::array kLines =
      std::to_array<Line>({{34, "QUINCUNX"},
                           {22, "Five of a die 0123456789"},
                           {15, "ABCDEFGHIJKLMNOPQRSTUVWXYZ"},
                           {12, "abcdefghijklmnopqrstuvwxyz 12 px"},
                           {9, "render extent, output extent, velocity, jitter: 9 px"},
                           {7, "history, reactive, viewport, resolve, present: 7 px capitals"},
                           {5, "small print at five pixels: (a + b) / 2 = 0.71 * [x, y] & 100%"}});
  float y = corner.y;
  for (const Line& line : kLines) {
    y += line.size;
    pen.text(line.text, {corner.x, y}, line.size, kBlack);
    y += 0.75f * line.size + 3;
  }
}

void add_patches(ChartPen& pen, glm::vec2 corner) {
  constexpr std::array<glm::vec3, 12> kColours{{{0.45f, 0.32f, 0.26f},
                                                {0.76f, 0.59f, 0.51f},
                                                {0.36f, 0.48f, 0.61f},
                                                {0.34f, 0.42f, 0.25f},
                                                {0.84f, 0.49f, 0.17f},
                                                {0.29f, 0.36f, 0.65f},
                                                {0.76f, 0.33f, 0.38f},
                                                {0.62f, 0.74f, 0.25f},
                                                {0.88f, 0.64f, 0.18f},
                                                {0.16f, 0.24f, 0.59f},
                                                {0.27f, 0.58f, 0.29f},
                                                {0.69f, 0.19f, 0.22f}}};
  constexpr float kSize = 44;
  for (std::size_t i = 0; i < kColours.size(); ++i) {
    const glm::vec2 low = corner + kSize * glm::vec2(i % 6, i / 6);
    pen.rectangle(low, low + kSize - 3.0f, linear_of(kColours[i]));
  }
  constexpr int kGreys = 16;
  for (int i = 0; i < kGreys; ++i) {
    const float width = 6 * kSize / kGreys;
    const glm::vec2 low = corner + glm::vec2(static_cast<float>(i) * width, 2 * kSize + 4);
    pen.rectangle(low, low + glm::vec2(width, 34),
                  linear_of(glm::vec3(static_cast<float>(i) / (kGreys - 1))));
  }
}

// Light sixteen times white against black, down to a line and dots of a pixel.
void add_bright_patches(ChartPen& pen, glm::vec2 corner) {
  constexpr glm::vec3 kLight(16, 14, 11);
  pen.rectangle(corner, corner + glm::vec2(264, 96), kBlack);
  pen.rectangle(corner + glm::vec2(10, 10), corner + glm::vec2(76, 86), kLight, 2);
  pen.rectangle(corner + glm::vec2(84, 10), corner + glm::vec2(85, 86), kLight, 2);
  pen.quad({corner + glm::vec2(100, 10), corner + glm::vec2(101.5f, 10), corner + glm::vec2(131.5f, 86),
            corner + glm::vec2(130, 86)},
           kLight, 2);
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 5; ++column) {
      const float size = 0.75f + 0.75f * static_cast<float>(column);
      pen.ring(
          corner + glm::vec2(154.5f + 24 * static_cast<float>(column), 20.5f + 19 * static_cast<float>(row)),
          0, size / 2, kLight / std::pow(4.0f, static_cast<float>(row)), 2);
    }
  }
}

// A fan of lines that come together, from six pixels wide to one and a half.
void add_wedge(ChartPen& pen, glm::vec2 corner) {
  constexpr int kLines = 9;
  constexpr float kHeight = 210;
  for (int i = 0; i < kLines; ++i) {
    const float offset = static_cast<float>(i) - (kLines - 1) / 2.0f;
    const auto at = [&](float y, float pitch) { return corner + glm::vec2(60 + offset * pitch, y); };
    const float wide = 6.0f;
    const float narrow = 1.5f;
    pen.quad({at(0, 2 * wide) - glm::vec2(wide / 2, 0), at(0, 2 * wide) + glm::vec2(wide / 2, 0),
              at(kHeight, 2 * narrow) + glm::vec2(narrow / 2, 0),
              at(kHeight, 2 * narrow) - glm::vec2(narrow / 2, 0)},
             kBlack, 2);
  }
}

void add_frame(ChartPen& pen) {
  pen.rectangle({-400, -200}, kPicture + glm::vec2(400, 200), kPaper, 0);
  for (const float inset : {8.0f, 12.0f}) {
    const glm::vec2 low(inset);
    const glm::vec2 high = kPicture - inset;
    pen.rectangle(low, {high.x, low.y + 1}, kBlack);
    pen.rectangle({low.x, high.y - 1}, high, kBlack);
    pen.rectangle(low, {low.x + 1, high.y}, kBlack);
    pen.rectangle({high.x - 1, low.y}, high, kBlack);
  }
}

}  // namespace

Scene make_chart(std::uint64_t) {
  SceneAssembly assembly;
  MeshBuilder& builder = assembly.still(assembly.add(unlit_material("ink", glm::vec3(1))));
  ChartPen pen(builder);
  add_frame(pen);
  add_zone_plate(pen, {175, 185}, 145);
  add_star(pen, {495, 185}, 145);
  pen.rectangle({665, 40}, {905, 330}, kWhite);
  add_slanted_square(pen, {785, 112}, 54, 5, kBlack);
  add_slanted_square(pen, {785, 248}, 54, 30, glm::vec3(0.18f));
  pen.rectangle({930, 40}, {1050, 330}, kWhite);
  pen.rectangle({1070, 40}, {1250, 330}, kWhite);
  add_wedge(pen, {930, 80});
  add_line_pairs(pen, {1140, 52}, false);
  pen.rectangle({30, 360}, {600, 450}, kWhite);
  add_line_pairs(pen, {50, 370}, true);
  add_text_block(pen, {40, 470});
  add_patches(pen, {665, 366});
  add_bright_patches(pen, {665, 530});
  pen.text("QUINCUNX", {1095, 600}, 30, kBlack, 0.16f, Align::kCentre);
  pen.text("resolution chart for 1280 x 720", {1095, 628}, 11, kBlack, 0.14f, Align::kCentre);
  for (const glm::vec2 pip : {glm::vec2(-1, -1), {1, -1}, {0, 0}, {-1, 1}, {1, 1}}) {
    pen.ring(glm::vec2(1095, 465) + 52.0f * pip, 0, 17, kBlack, 2);
  }
  pen.rectangle({995, 366}, {1195, 564}, kWhite);

  Scene& scene = assembly.scene;
  scene.sky.background = Background::kPlain;
  scene.sky.zenith = kPaper;
  scene.sun.casts_shadows = false;
  Camera camera;
  camera.vertical_fov = 0.8f;
  const float distance = kPicture.y / 2 * kMetresPerPixel / std::tan(camera.vertical_fov / 2);
  camera.world_from_camera = moved_to({0, 0, distance});
  scene.camera = [camera](double) { return camera; };
  return assembly.finish();
}

}  // namespace quincunx::scenes
