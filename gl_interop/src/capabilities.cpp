// SPDX-License-Identifier: MIT
#include "quincunx_gl/capabilities.h"

#include <epoxy/gl.h>

#include <array>

#include "state_scope.h"

namespace quincunx::gl {
namespace {

bool has_any(std::initializer_list<const char*> extensions) {
  for (const char* extension : extensions) {
    if (epoxy_has_gl_extension(extension)) return true;
  }
  return false;
}

// Features that OpenGL ES 3.2 has and 3.1 may have.
std::string missing_in_es(int version) {
  if (version >= 32) return {};
  struct Need {
    std::initializer_list<const char*> names;
    const char* first;
  };
  const std::array<Need, 3> needs = {
      Need{{"GL_EXT_draw_buffers_indexed", "GL_OES_draw_buffers_indexed"}, "GL_EXT_draw_buffers_indexed"},
      Need{{"GL_EXT_texture_border_clamp", "GL_OES_texture_border_clamp"}, "GL_EXT_texture_border_clamp"},
      Need{{"GL_EXT_color_buffer_float"}, "GL_EXT_color_buffer_float"}};
  std::string missing;
  for (const Need& need : needs) {
    if (!has_any(need.names)) missing += (missing.empty() ? "" : ", ") + std::string(need.first);
  }
  return missing;
}

Capabilities find_capabilities() {
  Capabilities found;
  found.api = epoxy_is_desktop_gl() ? Api::kGl45 : Api::kEs3;
  found.version = epoxy_gl_version();
  const bool desktop = found.api == Api::kGl45;
  found.clip_control = desktop || has_any({"GL_EXT_clip_control"});
  found.depth_clamp = desktop || has_any({"GL_EXT_depth_clamp"});
  found.persistent_map = desktop || has_any({"GL_EXT_buffer_storage"});
  found.reads_depth = desktop;
  found.encodes_on_demand = desktop;
  found.time_queries = desktop || has_any({"GL_EXT_disjoint_timer_query"});
  if (!desktop) found.missing = missing_in_es(found.version);
  return found;
}

struct Known {
  CurrentContext context;
  Capabilities found;
};
thread_local Known known;

}  // namespace

const char* name_of(Api api) {
  return api == Api::kGl45 ? "4.5" : "es3";
}

const Capabilities& capabilities() {
  return known.context == current_context() ? known.found : renewed_capabilities();
}

const Capabilities& renewed_capabilities() {
  known = {current_context(), find_capabilities()};
  return known.found;
}

}  // namespace quincunx::gl
