// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "builtin/architecture.h"
#include "builtin/courtyard.h"

namespace quincunx::scenes {

namespace {

constexpr float kQuarter = glm::half_pi<float>();
constexpr float kCell = 0.45f;
constexpr float kBay = 2.6f;

// A builder for a masonry of this repeat, standing at a place until the end of its life.
class Stand : public PenScope {
 public:
  Stand(MeshBuilder& builder, const glm::mat4& placement, float repeat, float cell = kCell)
      : PenScope(builder, {placement, builder.pen.colour, 1 / repeat, cell}) {}
};

constexpr float kBrickRepeat = 1.92f;
constexpr float kAshlarRepeat = 2.4f;
constexpr float kPlasterRepeat = 4.0f;
constexpr float kPavingRepeat = 2.4f;
constexpr float kStoneRepeat = 1.0f;

// The arcade on the left runs along -z and looks towards +x.
constexpr int kArcadeBays = 7;
constexpr float kArcadeStart = 10.4f;
constexpr float kArcadeX = -6.5f;
constexpr float kArcadeBack = -9.3f;
constexpr float kTerrace = 4.3f;

// The facade at the far end.
constexpr int kFacadeBays = 5;
constexpr float kFacadeX = -6.5f;
constexpr float kFacadeZ = -7.8f;
constexpr float kStorey = 5.0f;
constexpr float kEaves = 7.7f;
constexpr float kFacadeWidth = kFacadeBays * kBay;

void add_right_wall(SceneAssembly& assembly, const CourtyardMaterials& m) {
  constexpr float kX = 6.5f;
  constexpr float kHeight = 0.8f;
  constexpr float kPitch = 3.4f;
  const Stand wall(assembly.still(m.ashlar, kRightWall), glm::mat4(1), kAshlarRepeat);
  const Stand stone(assembly.still(m.limestone, kRightWall), glm::mat4(1), kStoneRepeat);
  for (int i = 0; i < 6; ++i) {
    const float z = kFacadeZ + 0.4f + kPitch * static_cast<float>(i);
    wall->box({kX - 0.28f, 0, z - 0.28f}, {kX + 0.28f, 2.15f, z + 0.28f});
    stone->box({kX - 0.36f, 2.15f, z - 0.36f}, {kX + 0.36f, 2.29f, z + 0.36f});
    stone->sphere({kX, 2.52f, z}, 0.24f, 20);
    if (i == 5) break;
    wall->box({kX - 0.2f, 0, z + 0.28f}, {kX + 0.2f, kHeight, z + kPitch - 0.28f});
    stone->box({kX - 0.26f, kHeight, z + 0.28f}, {kX + 0.26f, kHeight + 0.1f, z + kPitch - 0.28f});
    const Stand rail(assembly.still(m.iron, kRightWall),
                     moved_to({kX, kHeight + 0.1f, z + 0.28f}) * turned(-kQuarter, {0, 1, 0}), 1);
    add_railing(*rail, {kPitch - 0.56f, 1.15f, 0.125f, 0.009f});
  }
}

void add_terrace_house(SceneAssembly& assembly, const CourtyardMaterials& m, const glm::mat4& front) {
  const float length = kArcadeBays * kBay;
  const glm::mat4 back = front * moved_to({0, 0, kArcadeBack - kArcadeX});
  const Stand plaster(assembly.still(m.plaster, kArcade), back, kPlasterRepeat);
  plaster->patch({0, 0, 0}, {length, 0, 0}, {0, kTerrace, 0});
  const Stand trim(assembly.still(m.limestone, kArcade), back, kStoneRepeat);
  trim->box({0, 0, 0}, {length, 0.35f, 0.05f});
  const WindowWall shape{kArcadeBays, kBay, kTerrace, 7.4f, 0.55f, {1.0f, 1.75f}, 0.22f};
  add_window_wall(*plaster, *trim, shape);
  const Stand glass(assembly.still(m.window, kArcade), back, 1, 1e9f);
  const Stand frame(assembly.still(m.limestone, kArcade), back, 1, 1e9f);
  const Stand shutters(assembly.still(m.shutters, kArcade), back, 1, 1e9f);
  add_windows(*glass, *frame, *shutters, shape);
  const Stand cornice(assembly.still(m.limestone, kArcade), back * moved_to({0, 7.6f, 0}), kStoneRepeat);
  add_cornice(*cornice, length, 0.35f, 0.35f);
  const Stand roof(assembly.still(m.tiles, kArcade), back * moved_to({0, 7.62f, 0.45f}), 1);
  add_tile_roof(*roof, length, 2.6f, 1.0f);
}

void add_portico(SceneAssembly& assembly, const CourtyardMaterials& m, const glm::mat4& front) {
  const ArchWall arches{kFacadeBays, kBay, 3.14f, 3.14f, 1.05f, kStorey, 0.45f};
  const Stand wall(assembly.still(m.ashlar, kFacade), front, kAshlarRepeat);
  const Stand trim(assembly.still(m.limestone, kFacade), front, kStoneRepeat);
  add_arch_wall(*wall, *trim, arches);
  for (int i = 0; i <= kFacadeBays; ++i) {
    const Stand column(assembly.still(m.limestone, kFacade),
                       front * moved_to({kBay * static_cast<float>(i), kPorticoFloor, -0.225f}),
                       kStoneRepeat);
    add_column(*column, 0.19f, 2.5f);
  }
  // Floor, steps, ceiling, back wall with its door.
  const Stand floor(assembly.still(m.paving, kFacade), front, kPavingRepeat);
  floor->patch({0, kPorticoFloor, 0.5f}, {kFacadeWidth, 0, 0}, {0, 0, -3.0f});
  {
    const Stand steps(assembly.still(m.limestone, kFacade), front * moved_to({0, 0, 0.5f}), kStoneRepeat);
    add_steps(*steps, kFacadeWidth, 4, kPorticoFloor / 4, 0.34f);
  }
  const Stand planks(assembly.still(m.planks, kFacade), front, 1);
  planks->patch({0, kStorey - 0.3f, -2.5f}, {kFacadeWidth, 0, 0}, {0, 0, 2.2f});
  for (int i = 0; i < 2 * kFacadeBays; ++i) {
    const float x = kBay * (static_cast<float>(i) + 0.5f) / 2;
    planks->box({x - 0.07f, kStorey - 0.5f, -2.5f}, {x + 0.07f, kStorey - 0.3f, -0.4f});
  }
  const Stand plaster(assembly.still(m.plaster, kFacade), front, kPlasterRepeat);
  plaster->patch({0, 0, -2.4f}, {kFacadeWidth, 0, 0}, {0, kStorey, 0});
  plaster->patch({0, 0, -0.1f}, {0, 0, -2.3f}, {0, kStorey, 0});
  plaster->patch({kFacadeWidth, 0, -2.4f}, {0, 0, 2.3f}, {0, kStorey, 0});
  const float middle = kFacadeWidth / 2;
  trim->box({middle - 1.0f, kPorticoFloor, -2.4f}, {middle - 0.75f, 3.3f, -2.25f});
  trim->box({middle + 0.75f, kPorticoFloor, -2.4f}, {middle + 1.0f, 3.3f, -2.25f});
  trim->box({middle - 1.1f, 3.3f, -2.4f}, {middle + 1.1f, 3.6f, -2.2f});
  planks->box({middle - 0.75f, kPorticoFloor, -2.4f}, {middle + 0.75f, 3.3f, -2.32f});
}

void add_upper_storey(SceneAssembly& assembly, const CourtyardMaterials& m, const glm::mat4& front) {
  const WindowWall shape{kFacadeBays, kBay, kStorey, kEaves, 0.45f, {1.05f, 1.6f}, 0.22f};
  const Stand wall(assembly.still(m.brick, kFacade), front * moved_to({0, 0, -0.15f}), kBrickRepeat);
  const Stand trim(assembly.still(m.limestone, kFacade), front * moved_to({0, 0, -0.15f}), kStoneRepeat);
  add_window_wall(*wall, *trim, shape);
  wall->patch({kFacadeWidth, 0, 0}, {0, 0, -4}, {0, kEaves, 0});
  wall->patch({0, kStorey, -4}, {0, 0, 4}, {0, kEaves - kStorey, 0});
  const glm::mat4 flush = front * moved_to({0, 0, -0.15f});
  const Stand glass(assembly.still(m.window, kFacade), flush, 1, 1e9f);
  const Stand shutters(assembly.still(m.shutters, kFacade), flush, 1, 1e9f);
  const Stand frame(assembly.still(m.planks, kFacade), flush, 1, 1e9f);
  add_windows(*glass, *frame, *shutters, shape);
  const Stand band(assembly.still(m.limestone, kFacade), front * moved_to({0, kStorey + 0.1f, 0}),
                   kStoneRepeat);
  add_cornice(*band, kFacadeWidth, 0.26f, 0.24f);
  const Stand top(assembly.still(m.limestone, kFacade), flush * moved_to({0, kEaves + 0.22f, 0}),
                  kStoneRepeat);
  add_cornice(*top, kFacadeWidth, 0.5f, 0.5f);
  const Stand roof(assembly.still(m.tiles, kFacade), flush * moved_to({-0.2f, kEaves + 0.24f, 0.6f}), 1);
  add_tile_roof(*roof, kFacadeWidth + 0.4f, 3.4f, 1.9f);
}

void add_balcony(SceneAssembly& assembly, const CourtyardMaterials& m, const glm::mat4& front, int bay) {
  constexpr float kWidth = 2.2f;
  constexpr float kDepth = 0.75f;
  const glm::mat4 at =
      front * moved_to({(static_cast<float>(bay) + 0.5f) * kBay - kWidth / 2, kStorey + 0.1f, 0});
  const Stand slab(assembly.still(m.limestone, kFacade), at, kStoneRepeat);
  slab->box({-0.1f, 0, -0.1f}, {kWidth + 0.1f, 0.12f, kDepth + 0.08f});
  for (const float x : {0.25f, kWidth - 0.4f})
    slab->box({x, -0.32f, 0.05f}, {x + 0.15f, 0, kDepth - 0.2f});
  const Stand front_rail(assembly.still(m.iron, kFacade), at * moved_to({0, 0.12f, kDepth}), 1);
  add_railing(*front_rail, {kWidth, 1.0f, 0.11f, 0.008f});
  for (const float x : {0.0f, kWidth}) {
    const Stand side(assembly.still(m.iron, kFacade),
                     at * moved_to({x, 0.12f, kDepth}) * turned(kQuarter, {0, 1, 0}), 1);
    add_railing(*side, {kDepth, 1.0f, 0.11f, 0.008f});
  }
}

void add_inscription(SceneAssembly& assembly, const CourtyardMaterials& m, const glm::mat4& front) {
  const Stand letters(assembly.still(m.bronze, kFacade), front, 1);
  const auto write = [&](const char* text, float baseline, float height) {
    for (const Polyline& path :
         text_strokes(text, {kFacadeWidth / 2, baseline}, {height, 1.1f, Align::kCentre})) {
      letters->stroke(path, 0.15f * height, 0.012f);
    }
  };
  write("QUINCUNX", 4.53f, 0.34f);
}

}  // namespace

void add_courtyard_ground(SceneAssembly& assembly, const CourtyardMaterials& m) {
  struct Strip {
    int part;
    float left, right, near, far;
  };
  constexpr float kNear = 12.5f;
  constexpr float kWall = kArcadeX - 0.2f;
  constexpr std::array kStrips = std::to_array<Strip>({{kArcade, kArcadeBack, kWall, kNear, kFacadeZ},
                                                       {kProps, kWall, -1.0f, kNear, 1.0f},
                                                       {kFountainPart, kWall, 6.5f, 1.0f, -5.4f},
                                                       {kRightWall, -1.0f, 6.5f, kNear, 1.0f},
                                                       {kFacade, kWall, 6.5f, -5.4f, kFacadeZ}});
  for (const Strip& strip : kStrips) {
    const Stand paving(assembly.still(m.paving, strip.part), glm::mat4(1), kPavingRepeat, 0.4f);
    paving->patch({strip.left, 0, strip.near}, {strip.right - strip.left, 0, 0},
                  {0, 0, strip.far - strip.near});
  }
  add_right_wall(assembly, m);
}

void add_courtyard_arcade(SceneAssembly& assembly, const CourtyardMaterials& m) {
  const float length = kArcadeBays * kBay;
  const glm::mat4 front = moved_to({kArcadeX, 0, kArcadeStart}) * turned(kQuarter, {0, 1, 0});
  const ArchWall arches{kArcadeBays, kBay, 2.5f, 2.5f, 1.05f, kTerrace, 0.45f};
  const Stand wall(assembly.still(m.ashlar, kArcade), front, kAshlarRepeat);
  const Stand stone(assembly.still(m.limestone, kArcade), front, kStoneRepeat);
  add_arch_wall(*wall, *stone, arches);
  for (int i = 0; i <= kArcadeBays; ++i) {
    const Stand column(assembly.still(m.limestone, kArcade),
                       front * moved_to({kBay * static_cast<float>(i), 0, -0.225f}), kStoneRepeat);
    add_column(*column, 0.19f, 2.5f);
  }
  const Stand cornice(assembly.still(m.limestone, kArcade), front * moved_to({0, kTerrace + 0.05f, 0}),
                      kStoneRepeat);
  add_cornice(*cornice, length, 0.34f, 0.3f);
  const Stand balustrade(assembly.still(m.limestone, kArcade),
                         front * moved_to({0, kTerrace + 0.05f, -0.12f}), kStoneRepeat);
  add_balustrade(*balustrade, length, 0.95f);
  const float depth = kArcadeX - kArcadeBack;
  const Stand terrace(assembly.still(m.paving, kArcade), front, kPavingRepeat);
  terrace->patch({0, kTerrace, 0}, {length, 0, 0}, {0, 0, -depth});
  const Stand ceiling(assembly.still(m.planks, kArcade), front, 1);
  ceiling->patch({0, kTerrace - 0.25f, -depth}, {length, 0, 0}, {0, 0, depth - 0.45f});
  for (int i = 0; i <= 2 * kArcadeBays; ++i) {
    const float x = kBay * static_cast<float>(i) / 2;
    ceiling->box({x - 0.08f, kTerrace - 0.47f, -depth}, {x + 0.08f, kTerrace - 0.25f, -0.45f});
  }
  add_terrace_house(assembly, m, front);
  // Its far end is closed.
  const Stand end(assembly.still(m.plaster, kArcade), moved_to({kArcadeBack, 0, kFacadeZ + 0.02f}),
                  kPlasterRepeat);
  end->patch({0, 0, 0}, {depth, 0, 0}, {0, kTerrace, 0});
}

void add_courtyard_facade(SceneAssembly& assembly, const CourtyardMaterials& m) {
  const glm::mat4 front = moved_to({kFacadeX, 0, kFacadeZ});
  add_portico(assembly, m, front);
  add_upper_storey(assembly, m, front);
  for (const int bay : {0, kFacadeBays - 1})
    add_balcony(assembly, m, front, bay);
  add_inscription(assembly, m, front);
}

void add_courtyard_tower(SceneAssembly& assembly, const CourtyardMaterials& m) {
  constexpr float kWidth = 2.9f;
  constexpr float kClock = 14.3f;
  constexpr float kBelfry = 15.35f;
  constexpr float kTop = 17.7f;
  const glm::vec3 middle(3.6f, 0, -21);
  for (int side = 0; side < 4; ++side) {
    const glm::mat4 face = moved_to(middle) * turned(kQuarter * static_cast<float>(side), {0, 1, 0}) *
                           moved_to({-kWidth / 2, 0, kWidth / 2});
    const Stand brick(assembly.still(m.brick, kTower), face, kBrickRepeat, 0.8f);
    const Stand stone(assembly.still(m.limestone, kTower), face, kStoneRepeat, 0.8f);
    brick->patch({0, 6, 0}, {kWidth, 0, 0}, {0, kBelfry - 6, 0});
    add_arch_wall(*brick, *stone, {2, kWidth / 2, kBelfry, kBelfry + 1.2f, 0.46f, kTop, 0.4f});
    const Stand band(assembly.still(m.limestone, kTower), face * moved_to({0, kBelfry, 0}), kStoneRepeat);
    add_cornice(*band, kWidth, 0.35f, 0.28f);
    const Stand crown(assembly.still(m.limestone, kTower), face * moved_to({0, kTop + 0.2f, 0}),
                      kStoneRepeat);
    add_cornice(*crown, kWidth, 0.5f, 0.4f);
    MeshBuilder& roof = assembly.still(m.tiles, kTower);
    roof.pen.placement = face;
    const glm::vec3 apex(kWidth / 2, kTop + 2.0f, -kWidth / 2);
    const glm::vec3 low(-0.45f, kTop + 0.2f, 0.45f);
    const glm::vec3 right(kWidth + 0.9f, 0, 0);
    const glm::vec3 normal = glm::normalize(glm::cross(right, apex - low));
    const std::uint32_t a = roof.vertex(low, normal, {0, 0});
    roof.vertex(low + right, normal, {0, 0});
    roof.vertex(apex, normal, {0, 0});
    roof.triangle(a, a + 1, a + 2);
    roof.pen.placement = glm::mat4(1);
  }
  const Stand dial(assembly.still(m.limestone, kTower), moved_to(middle + glm::vec3(0, kClock, kWidth / 2)),
                   kStoneRepeat);
  dial->annulus({0, 0, 0.03f}, {0, 0, 1}, 0, 0.8f, 40);
  const Stand gilt(assembly.still(m.gilt, kTower), moved_to(middle + glm::vec3(0, kClock, kWidth / 2)), 1);
  gilt->ring({0, 0, 0.03f}, {0, 0, 1}, 0.82f, 0.045f, 40, 6);
  const Stand ink(assembly.still(m.iron, kTower), moved_to(middle + glm::vec3(0, kClock, kWidth / 2)), 1);
  for (int hour = 0; hour < 12; ++hour) {
    const float angle = glm::two_pi<float>() * static_cast<float>(hour) / 12;
    const glm::vec2 out(std::sin(angle), std::cos(angle));
    ink->stroke(std::array<glm::vec2, 2>{{0.60f * out, 0.72f * out}}, 0.06f, 0.035f);
  }
  ink->stroke(std::array<glm::vec2, 2>{{{0, 0}, {0.24f, -0.30f}}}, 0.07f, 0.04f);
  ink->stroke(std::array<glm::vec2, 2>{{{0, 0}, {0.52f, 0.25f}}}, 0.045f, 0.045f);
}

}  // namespace quincunx::scenes
