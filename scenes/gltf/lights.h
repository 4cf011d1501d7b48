// SPDX-License-Identifier: MIT
// KHR_lights_punctual as the lights of a Scene. Private to the glTF loader.
#pragma once

#include "gltf/animation.h"
#include "gltf/document.h"
#include "scene.h"

namespace quincunx::scenes {

// Lights of the given nodes where they stand at time 0. The first directional light becomes the sun, further
// ones and spot lights are left out with a warning, as are point lights beyond Scene::kMaxPointLights. A file
// without lights gets a sun and a sky. Lights in photometric units (thousands of lux or candela) lower
// Scene::exposure so that a white surface in the middle of `bounds` is not burnt out; the sky follows.
void read_lights(GltfDocument& document, const NodeTree& tree, const std::vector<int>& nodes,
                 const Bounds& bounds, Scene& scene);

}  // namespace quincunx::scenes
