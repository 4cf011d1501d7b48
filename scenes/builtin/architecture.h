// SPDX-License-Identifier: MIT
// Building parts for the procedural scenes. Each is added where the builder's pen stands: local x runs along
// the part, y up, and it faces +z; lengths in metres.
#pragma once

#include <glm/glm.hpp>

#include "builtin/mesh_builder.h"

namespace quincunx::scenes {

// A wall with round arches, from x = 0, front face at z = 0, back face at z = -thickness.
struct ArchWall {
  int bays = 1;
  float bay_width = 2.6f;
  float base = 0;          // where the wall begins: 0 for piers, the springing for columns
  float springing = 2.4f;  // where the arches begin
  float radius = 1.0f;     // radius of the arches; less than half the bay's width
  float top = 4.2f;
  float thickness = 0.45f;
};
void add_arch_wall(MeshBuilder& wall, MeshBuilder& trim, const ArchWall& shape);

// A wall with rectangular openings, one a bay, with a reveal; what fills them is added apart.
struct WindowWall {
  int bays = 1;
  float bay_width = 2.6f;
  float low = 0;
  float high = 3;
  float sill = 0.8f;  // above low
  glm::vec2 opening{1.0f, 1.6f};
  float reveal = 0.25f;
};
void add_window_wall(MeshBuilder& wall, MeshBuilder& trim, const WindowWall& shape);
// Panes, a frame with glazing bars, and open shutters, for each opening.
void add_windows(MeshBuilder& glass, MeshBuilder& frame, MeshBuilder& shutters, const WindowWall& shape);

// Stands on the origin.
void add_column(MeshBuilder& stone, float radius, float height);

// A band that juts out at the front, from x = 0 to length, its top at the origin's height.
void add_cornice(MeshBuilder& stone, float length, float height, float depth);

// Turned balusters between two rails, from x = 0 to length, standing at z = 0.
void add_balustrade(MeshBuilder& stone, float length, float height);

// Thin upright bars with spear points between two flat rails.
struct Railing {
  float length = 4;
  float height = 1.1f;
  float spacing = 0.12f;
  float bar_radius = 0.007f;
};
void add_railing(MeshBuilder& iron, const Railing& shape);

// A lattice of diamonds from crossing wires, a frame of posts and rails around it; along x from 0.
void add_wire_fence(MeshBuilder& wire, float length, float height);

// Steps that rise towards -z; the top step's front edge lies at z = 0.
void add_steps(MeshBuilder& stone, float length, int count, float rise, float tread);

// Barrel tiles on a slope that rises towards -z from the eaves on the x axis.
void add_tile_roof(MeshBuilder& tiles, float length, float depth, float rise);

}  // namespace quincunx::scenes
